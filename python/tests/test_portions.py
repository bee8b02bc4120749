"""Pictures in parts, and by pools of workers."""

import concurrent.futures
import multiprocessing

import numpy
import pytest

import qrt


def test_parts_merge_to_the_picture_in_any_order(box, tmp_path):
    whole = box.render(seed=3)
    parts = [qrt.render_portion(box, k, 5, seed=3, threads=1 + k % 2) for k in (3, 0, 4, 1, 2)]
    merged = qrt.merge(parts)
    for name in ("pixels", "queries", "widths", "strata"):
        assert numpy.array_equal(getattr(merged, name), getattr(whole, name)), name
    for picture, name in ((whole, "whole.png"), (merged, "merged.png")):
        picture.save(tmp_path / name)
    assert (tmp_path / "whole.png").read_bytes() == (tmp_path / "merged.png").read_bytes()


def test_parts_are_those_of_the_command(command, box, tmp_path):
    (tmp_path / "one").write_bytes(qrt.render_portion(box, 1, 2))
    command("render", "box.yaml", "--portion", "0/2", "-o", "other")
    command("render", "box.yaml", "-o", "whole.exr")
    command("merge", "one", "other", "-o", "merged.exr")
    qrt.merge([tmp_path / "one", (tmp_path / "other").read_bytes()]).save(tmp_path / "own.exr")
    whole = (tmp_path / "whole.exr").read_bytes()
    assert (tmp_path / "merged.exr").read_bytes() == whole
    assert (tmp_path / "own.exr").read_bytes() == whole


def test_there_is_no_picture_of_parts_that_make_none(box):
    parts = [qrt.render_portion(box, k, 3) for k in range(3)]
    damaged = bytearray(parts[1])
    damaged[len(damaged) // 2] ^= 1
    for wrong, reason in (
        ([], "no parts"),
        (parts[:2], "1 of 3 parts is missing: 2/3"),
        ([*parts, parts[0]], r"`parts\[3\]` and `parts\[0\]` are both part 0/3"),
        ([parts[0], damaged, parts[2]], r"`parts\[1\]` is damaged"),
        ([parts[0], b"part", parts[2]], r"`parts\[1\]` is no part"),
        (
            [parts[0], qrt.render_portion(box, 1, 3, seed=1), parts[2]],
            r"`parts\[1\]` and `parts\[0\]` are parts of different pictures\n  seed: 1 and 0",
        ),
    ):
        with pytest.raises(qrt.MergeError, match=reason):
            qrt.merge(wrong)
    for k, n in ((3, 3), (0, 0), (0, 144)):
        with pytest.raises(qrt.RequestError):
            qrt.render_portion(box, k, n)


def test_processes_render_the_picture(box):
    whole = box.render(estimator="exact")
    # A process that is forked from one with threads may wait for a lock that no thread will release.
    context = multiprocessing.get_context("spawn")
    told = []
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        picture = qrt.distributed.render(
            box, pool, portions=7, estimator="exact", progress=lambda *far: told.append(far)
        )
        with pytest.raises(qrt.RequestError, match="best"):
            qrt.distributed.render(box, pool, portions=2, estimator="best")
        for option in ("checkpoint", "resume"):
            with pytest.raises(qrt.RequestError, match=f"{option}= keeps the work of one process"):
                qrt.distributed.render(box, pool, **{option: True})
    assert numpy.array_equal(picture.pixels, whole.pixels)
    assert told[-1] == (7, 7)


class Unreliable:
    """A pool whose tasks fail the first few times."""

    def __init__(self, failures):
        self.failures = failures
        self.submitted = 0

    def submit(self, function, *arguments):
        self.submitted += 1
        future = concurrent.futures.Future()
        if self.submitted <= self.failures:
            future.set_exception(ConnectionError("lost"))
        else:
            future.set_result(function(*arguments))
        return future


def test_a_wrong_option_is_no_lost_task(box):
    pool = Unreliable(0)
    with pytest.raises(TypeError, match="modell"):
        qrt.distributed.render(box, pool, portions=1, modell="real")
    assert pool.submitted == 1


def test_a_pool_that_breaks_with_a_worker_says_so(box):
    """A process that dies breaks a ProcessPoolExecutor, all of whose tasks are then lost."""
    slow = qrt.parse(box.to_yaml(), {"sampling.path_bits": 15})
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:

        def told(done, total):
            if done:
                for process in list((pool._processes or {}).values()):
                    process.kill()

        with pytest.raises(concurrent.futures.process.BrokenProcessPool):
            qrt.distributed.render(slow, pool, portions=40, estimator="exact", progress=told)


def test_parts_make_the_layers_of_one_render(command, box, tmp_path):
    sets = ("--set", "film={ width: 9, height: 7 }")
    box = qrt.parse(box.to_yaml(), {"film": {"width": 9, "height": 7}})
    command("render", "box.yaml", *sets, "--layers", "-o", "whole.exr")
    for k in range(2):
        command("render", "box.yaml", *sets, "--portion", f"{k}/2", "-o", f"part{k}")
    command("merge", "part1", "part0", "--layers", "box.yaml", *sets, "-o", "merged.exr")
    merged = qrt.merge([tmp_path / "part0", tmp_path / "part1"])
    merged.save(tmp_path / "own.exr", layers=box)
    box.render().save(tmp_path / "once.exr", layers=box)
    whole = (tmp_path / "whole.exr").read_bytes()
    for name in ("merged", "own", "once"):
        assert (tmp_path / f"{name}.exr").read_bytes() == whole, name
    box.render().save(tmp_path / "plain.exr")
    assert len((tmp_path / "plain.exr").read_bytes()) < len(whole)
    with pytest.raises(qrt.RequestError, match="only .exr keeps layers"):
        merged.save(tmp_path / "own.png", layers=box)
    other = qrt.parse(box.to_yaml(), {"materials.red.lambertian.albedo": [0.1, 0.1, 0.1]})
    with pytest.raises(qrt.RequestError, match="not the scene that the picture was rendered of"):
        merged.save(tmp_path / "own.exr", layers=other)


def test_lost_tasks_are_done_again_so_often(box):
    pool = Unreliable(3)
    picture = qrt.distributed.render(box, pool, portions=4, crop=(0, 0, 4, 4))
    assert pool.submitted == 7
    assert numpy.array_equal(picture.pixels, box.render(crop=(0, 0, 4, 4)).pixels)
    with pytest.raises(ConnectionError):
        qrt.distributed.render(box, Unreliable(99), portions=1, retries=2, crop=(0, 0, 4, 4))
