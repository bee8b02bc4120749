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
from conftest import ROOT
from qrt._options import RenderOptions

CASES = [
    ({}, []),
    ({"estimator": "exact", "seed": 2**64 - 1}, ["--estimator", "exact", "--seed", str(2**64 - 1)]),
    ({"model": "fixed", "crop": (2, 3, 5, 4)}, ["--model", "fixed", "--crop", "2,3,5,4"]),
    ({"estimator": "auto"}, ["--estimator", "auto"]),
    ({"estimator": "phase-mean"}, ["--estimator", "phase-mean"]),
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
    for name in ("pixels", "good", "widths", "strata", "queries", "scales", "amplitudes"):
        one, other = getattr(picture, name), getattr(picture, name)
        assert numpy.shares_memory(one, other), name
        with pytest.raises(ValueError):
            one[0, 0] = 1
    assert numpy.array_equal(picture.pixels, picture.scales * picture.good / picture.total)
    assert numpy.allclose(picture.amplitudes, picture.good / picture.total, rtol=1e-12)
    assert numpy.shares_memory(numpy.asarray(picture), picture.pixels)
    assert numpy.asarray(picture, dtype="float32").dtype == "float32"
    assert picture.__array__(numpy.float64, copy=False) is not None
    assert not numpy.shares_memory(picture.__array__(copy=True), picture.pixels)
    with pytest.raises(ValueError, match="takes a copy"):
        picture.__array__(numpy.float32, copy=False)
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
    box.render(progress=True)
    assert "path" in capsys.readouterr().err
    box.render()
    assert capsys.readouterr().err == ""


@pytest.mark.skipif(os.name != "posix", reason="terminals are those of POSIX")
def test_a_terminal_gets_a_bar_and_a_pipe_none(box_file):
    import fcntl
    import pty
    import struct
    import termios

    script = (
        "import qrt, sys\n"
        "qrt.load(sys.argv[1], {'sampling.path_bits': 12}).render(progress=eval(sys.argv[2]))\n"
    )

    def shown(progress, terminal):
        words = [sys.executable, "-c", script, box_file, progress]
        if not terminal:
            done = subprocess.run(words, stderr=subprocess.PIPE, check=True)
            return done.stderr.decode()
        own, childs = pty.openpty()
        # 24 lines of 80 columns.
        fcntl.ioctl(childs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        child = subprocess.Popen(words, stderr=childs)
        os.close(childs)
        text = b""
        # At the end of the output, Linux reports an error.
        try:
            while more := os.read(own, 4096):
                text += more
        except OSError:
            pass
        os.close(own)
        assert child.wait(60) == 0
        return text.decode()

    assert "path" in shown("None", True) and "%" in shown("True", True)
    assert shown("False", True) == ""
    assert shown("None", False) == ""


def test_a_notebook_gets_a_bar(box, monkeypatch):
    """A kernel's IPython, as far as qrt looks at it, and a bar that keeps its values."""
    import types

    import tqdm.auto

    bars = []

    class Bar:
        def __init__(self, total, **words):
            self.total, self.n, self.closed = total, 0, False
            bars.append(self)

        def update(self, more):
            self.n += more

        def close(self):
            self.closed = True

    shell = types.SimpleNamespace(kernel=object(), config={"IPKernelApp": {}})
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setattr(tqdm.auto, "tqdm", Bar)
    box.render()
    (bar,) = bars
    assert (bar.total, bar.n, bar.closed) == (143 << 10, 143 << 10, True)
    # IPython without a kernel runs in a terminal, but standard error is not a terminal here.
    monkeypatch.delattr(shell, "kernel")
    box.render()
    assert len(bars) == 1


def test_what_ended_a_render_is_told_though_its_bar_cannot_be_closed(box, monkeypatch):
    import qrt._progress

    class Broken:
        def __call__(self, done, total):
            raise LookupError("first")

        def close(self):
            raise KeyError("second")

    monkeypatch.setattr(qrt._progress, "listener", lambda progress: Broken())
    with pytest.raises(LookupError, match="first"):
        box.render()


def while_others_run(work):
    """Returns how often another thread got to run while `work` did, and the seconds that it took."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    began = time.monotonic()
    before = counted[0]
    work()
    after, took = counted[0], time.monotonic() - began
    stop.set()
    thread.join()
    return after - before, took


def test_other_threads_run_meanwhile(box):
    slow = qrt.parse(box.to_yaml(), {"sampling.path_bits": 15})
    large = {"film": {"width": 1024, "height": 1024}, "sampling.path_bits": 1}
    large = qrt.parse(box.to_yaml(), large)
    parts = [qrt.render_portion(large, k, 2, estimator="exact") for k in range(2)]
    device = box.oracle("r", (4, 5)).device(seed=1)
    for work in (
        lambda: slow.render(estimator="exact", threads=1),
        lambda: qrt.merge(parts),
        lambda: device.phases(24, 2_000_000),
    ):
        # A thread that waits for the interpreter gets to run every 5 ms at the most.
        turns, took = while_others_run(work)
        assert took > 0.05, took
        assert turns > 5, (turns, took)


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


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
@pytest.mark.parametrize(
    "work",
    [
        "scene.paths(model='real')",
        "scene.paths(model='fixed')",
        "scene.oracle('r').good",
        "scene.oracle('r').qasm(3, 'counting', max_gates=2**60)",
    ],
)
def test_ctrl_c_ends_what_takes_long(box_file, work):
    script = (
        "import qrt, sys\n"
        "more = {'sampling.path_bits': 27, 'counting.phase_bits': 30}\n"
        "scene = qrt.load(sys.argv[1], more)\n"
        "print('begun', flush=True)\n"
        "try:\n"
        f"    {work}\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(42)\n"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", script, box_file], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout.readline() == "begun\n"
    time.sleep(1.5)
    assert child.poll() is None, "all of it takes minutes"
    child.send_signal(signal.SIGINT)
    try:
        assert child.wait(20) == 42
    finally:
        child.kill()


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
    for error in (qrt.RequestError("x"), qrt.JobError("x"), qrt.MergeError("x")):
        assert error.problems == ()


def test_a_budget_is_kept_by_every_render(box):
    tight = qrt.parse(box.to_yaml(), {"budget": {"toffoli": 10}})
    whole = box.render(crop=(0, 0, 1, 1))
    assert numpy.array_equal(tight.render(crop=(0, 0, 1, 1)).pixels, whole.pixels)
    for model in ("fixed", "gates"):
        for work in (
            lambda: tight.render(model=model),
            lambda: qrt.render_portion(tight, 0, 2, model=model),
            lambda: tight.paths(model=model),
        ):
            with pytest.raises(qrt.SceneError, match="budget") as raised:
                work()
            assert [problem.code for problem in raised.value.problems] == ["QRT0602"]


def test_what_would_not_fit_into_memory_is_refused_before_it_begins(box):
    huge = qrt.parse(box.to_yaml(), {"film": {"width": 65536, "height": 65536}})
    for options in ({"max_memory": 2**30}, {"max_memory": 2**30, "model": "gates"}):
        words = "65536 x 65536 pixels would take about 447 GB .* allow more with max_memory"
        with pytest.raises(qrt.RequestError, match=words):
            huge.render(**options)
    knot = qrt.load(ROOT / "scenes-yaml/knot.yaml", {"film": {"width": 4, "height": 4}})
    words = "the circuit of a scene of 1538 faces and paths of 3 rays would take about .* coarser mesh"
    with pytest.raises(qrt.RequestError, match=words):
        knot.render(model="fixed", max_memory=2**20)


def test_signatures_name_every_option(box):
    import inspect

    render = inspect.signature(qrt.Scene.render).parameters
    defaults = {name: one.default for name, one in render.items() if name != "self"}
    assert set(defaults) == set(RenderOptions.__annotations__)
    portion = inspect.signature(qrt.Scene.render_portion).parameters
    assert list(portion)[:3] == ["self", "k", "n"]
    assert {name: one.default for name, one in list(portion.items())[3:]} == defaults
    # The defaults in the signature are the values used for missing options.
    given = box.render(crop=(0, 0, 3, 3)).pixels
    named = box.render(**(defaults | {"crop": (0, 0, 3, 3)})).pixels
    assert numpy.array_equal(given, named)


def test_everything_public_says_what_it_is():
    import inspect

    bare = [name for name in qrt.__all__ if name != "__version__" and not getattr(qrt, name).__doc__]
    for kind in (qrt.Scene, qrt.Picture, qrt.Oracle, qrt.Device):
        for name, member in vars(kind).items():
            if not name.startswith("_") and not inspect.getdoc(member):
                bare.append(f"{kind.__name__}.{name}")
    assert bare == []


def test_pictures_say_how_they_were_made(box):
    picture = box.render(seed=5, crop=(0, 0, 2, 2))
    metadata = picture.metadata
    assert metadata["seed"] == "5" and metadata["scene_hash"] == box.fingerprint
    assert (picture.width, picture.height, picture.crop) == (2, 2, (0, 0, 2, 2))
    assert picture.paths == 4 << 10 and picture.seconds > 0


def test_pickled_scenes_are_the_same_scenes(box):
    again = pickle.loads(pickle.dumps(box))
    assert again.fingerprint == box.fingerprint and again.name == box.name
