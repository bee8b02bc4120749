"""Pictures are the command's, as arrays and as files."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest

import qrt

CASES = [
    ({}, []),
    ({"estimator": "exact", "seed": 2**64 - 1}, ["--estimator", "exact", "--seed", str(2**64 - 1)]),
    ({"model": "fixed", "crop": (2, 3, 5, 4)}, ["--model", "fixed", "--crop", "2,3,5,4"]),
    (
        {"colour": "one-run", "noise": "depolarising=0.001,readout=0.01"},
        ["--colour", "one-run", "--noise", "depolarising=0.001,readout=0.01"],
    ),
]


@pytest.mark.parametrize("options, words", CASES)
def test_files_are_the_commands_byte_for_byte(command, box, tmp_path, options, words):
    picture = box.render(**options)
    picture.save_counts(tmp_path / "own.csv")
    for ending, exposure in (("png", -1.0), ("exr", None)):
        own = ["--exposure", "-1"] if exposure else []
        command("render", "box.yaml", "-o", f"c.{ending}", "--counts", "c.csv", *words, *own)
        picture.save(tmp_path / f"own.{ending}", exposure=exposure)
        read = [(tmp_path / f"{name}.{ending}").read_bytes() for name in ("c", "own")]
        assert read[0] == read[1]
        assert (tmp_path / "c.csv").read_bytes() == (tmp_path / "own.csv").read_bytes()


def test_arrays_have_the_documented_shapes_and_share_the_pictures_memory(box):
    picture = box.render(model="fixed", estimator="exact", crop=(1, 2, 7, 3))
    for name, shape, kind in (
        ("pixels", (3, 7, 3), "float64"),
        ("good", (3, 7, 3), "uint64"),
        ("widths", (3, 7, 3), "float64"),
        ("strata", (3, 7, 3), "uint8"),
        ("queries", (3, 7), "uint64"),
        ("scales", (3, 7, 3), "float64"),
        ("amplitudes", (3, 7, 3), "float64"),
    ):
        array = getattr(picture, name)
        assert (array.shape, array.dtype) == (shape, kind), name
    for name in ("pixels", "good", "widths", "strata", "queries"):
        one, other = getattr(picture, name), getattr(picture, name)
        assert numpy.shares_memory(one, other), name
        with pytest.raises(ValueError):
            one[0, 0] = 1
    assert numpy.array_equal(picture.pixels, picture.scales * picture.good / picture.total)
    assert numpy.allclose(picture.amplitudes, picture.good / picture.total, rtol=1e-12)
    assert numpy.shares_memory(numpy.asarray(picture), picture.pixels)
    pixels = picture.pixels
    expected = pixels.copy()
    del picture
    assert numpy.array_equal(pixels, expected)
    assert box.render(estimator="exact").good is None


@pytest.mark.parametrize("model", ["real", "fixed", "gates"])
def test_the_mean_of_a_pixels_paths_is_the_pixel(box, model):
    colours = box.paths((4, 5), model=model, seed=3)
    assert colours.shape == (1024, 3) and colours.dtype == numpy.float64
    picture = box.render(model="real", estimator="exact", seed=3, crop=(4, 5, 1, 1))
    # The circuit's numbers have 16 fraction bits of a scale.
    exact = {"rtol": 1e-12} if model == "real" else {"rtol": 0.02}
    assert numpy.allclose(colours.mean(axis=0), picture.pixels[0, 0], **exact)


def test_progress_ends_at_all_paths_and_what_it_raises_ends_the_render(box):
    told = []
    box.render(progress=lambda *far: told.append(far))
    assert told[-1] == (143 << 10, 143 << 10)
    assert all(one[0] <= other[0] for one, other in zip(told, told[1:]))

    def stop(done, total):
        raise LookupError("enough")

    slow = qrt.parse(box.to_yaml(), {"sampling.path_bits": 24})
    began = time.monotonic()
    with pytest.raises(LookupError, match="enough"):
        slow.render(estimator="exact", progress=stop)
    assert time.monotonic() - began < 30
    with pytest.raises(TypeError):
        box.render(progres=stop)


def test_a_bar_of_tqdm_is_shown_where_it_is_asked_for(box, capsys):
    pytest.importorskip("tqdm")
    box.render(progress=True)
    assert "path" in capsys.readouterr().err
    box.render()
    assert capsys.readouterr().err == ""


def test_other_threads_run_meanwhile(box):
    slow = qrt.parse(box.to_yaml(), {"sampling.path_bits": 15})
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    slow.render(estimator="exact", threads=1)
    stop.set()
    thread.join()
    assert counted[0] > 5


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
def test_ctrl_c_ends_a_render_and_keeps_what_is_finished(box, box_file, tmp_path):
    script = (
        "import qrt, sys\n"
        "scene = qrt.load(sys.argv[1], {'sampling.path_bits': 22})\n"
        "print('begun', flush=True)\n"
        "try:\n"
        "    scene.render(estimator='exact', checkpoint=sys.argv[2])\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(42)\n"
    )
    kept = tmp_path / "kept"
    child = subprocess.Popen(
        [sys.executable, "-c", script, box_file, kept], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout.readline() == "begun\n"
    time.sleep(1.5)
    child.send_signal(signal.SIGINT)
    assert child.wait(60) == 42
    assert kept.stat().st_size > 100


def test_a_render_goes_on_from_its_checkpoint(box, tmp_path):
    kept = tmp_path / "kept"
    first = box.render(checkpoint=kept)
    again = box.render(checkpoint=kept, resume=True)
    assert numpy.array_equal(first.pixels, again.pixels)
    with pytest.raises(qrt.RequestError, match="belongs to another render"):
        box.render(checkpoint=kept, resume=True, seed=1)


def test_notebooks_show_pictures_and_costs(box):
    picture = box.render(crop=(0, 0, 4, 4))
    shown = picture._repr_html_()
    assert 'src="data:image/png;base64,' in shown and "<qrt" not in shown
    assert picture.png()[:4] == b"\x89PNG"
    oracle = box.oracle("r")
    assert f"{oracle.toffoli:,}" in oracle._repr_html_()


def test_what_cannot_be_asked_for_is_refused(box, tmp_path):
    for options, reason in (
        ({"model": "exact"}, "real, fixed, gates"),
        ({"estimator": "best"}, "adaptive-bayes"),
        ({"crop": (12, 0, 2, 1)}, "does not lie within the film"),
        ({"threads": 0}, "1..=4096"),
        ({"noise": "much"}, "noise"),
        ({"first_guess": "random"}, "grover"),
        ({"estimator": "exact", "noise": "readout=0.1"}, "noise"),
    ):
        with pytest.raises(qrt.RequestError, match=reason):
            box.render(**options)
    picture = box.render(crop=(0, 0, 1, 1))
    with pytest.raises(qrt.RequestError, match=".png"):
        picture.save(tmp_path / "p.jpg")
    with pytest.raises(OSError):
        picture.save(tmp_path / "none" / "p.png")
    assert issubclass(qrt.RequestError, ValueError) and issubclass(qrt.JobError, RuntimeError)


def test_pictures_say_how_they_were_made(box):
    picture = box.render(seed=5, crop=(0, 0, 2, 2))
    metadata = picture.metadata
    assert metadata["seed"] == "5" and metadata["scene_hash"] == box.fingerprint
    assert (picture.width, picture.height, picture.crop) == (2, 2, (0, 0, 2, 2))
    assert picture.paths == 4 << 10 and picture.seconds > 0


def test_pickled_scenes_are_the_same_scenes(box):
    again = pickle.loads(pickle.dumps(box))
    assert again.fingerprint == box.fingerprint and again.name == box.name
