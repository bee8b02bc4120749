#!/usr/bin/env python3
"""Measures how a picture's time falls with the number of processes that render its parts.

    python3 benches/peers/scaling.py SCENE [--set KEY=VALUE ...] [--command target/release/qrt]

Needs the Python package (`pip install ./python`), and a command of the same build. For n = 1, 2 and 4
it renders the scene twice: by n processes `qrt render --portion k/n --threads 1` at once, which `qrt merge`
puts together; and by `qrt.distributed.render` with a ProcessPoolExecutor of n workers that are started
already. Each picture must have the bytes of the others.

It prints a Markdown table, and what the work of many workers takes beside tracing: the bytes of a pickled
scene and of a pixel in a part, the time in which a worker starts, and the time and memory of one part of
a large film and of merging all of them. Wall time is from the first start to the last end, without the merge, and
depends on what else the machine does: its load is printed, too. Processor time does so much less, and
shows whether parts take equally long.
"""

import argparse
import concurrent.futures
import json
import multiprocessing
import os
import pathlib
import pickle
import platform
import subprocess
import sys
import tempfile
import time

WORKERS = (1, 2, 4)


def timed(function, *arguments):
    """Returns the result of a worker's function, and its processor time in seconds."""
    began = time.process_time()
    made = function(*arguments)
    return made, time.process_time() - began


class Timed:
    """A pool whose tasks are timed."""

    def __init__(self, pool):
        self.pool = pool
        self.seconds = []
        self.bytes = []

    def submit(self, function, *arguments):
        return Future(self, self.pool.submit(timed, function, *arguments))


class Future:
    """A task that is timed."""

    def __init__(self, pool, future):
        self.pool, self.future = pool, future
        self.done, self.cancel = future.done, future.cancel

    def result(self):
        made, seconds = self.future.result()
        self.pool.seconds.append(seconds)
        self.pool.bytes.append(len(made))
        return made


def by_pool(scene, workers, folder, seed):
    """A row of `qrt.distributed.render`, and the picture's bytes."""
    import qrt

    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(workers, mp_context=context) as pool:
        # All workers have started and imported the package before the first portion.
        list(pool.map(warm, range(4 * workers)))
        counted = Timed(pool)
        merging = []
        merge = qrt._portions.merge

        def merged(parts):
            began = time.monotonic()
            picture = merge(parts)
            merging.append(time.monotonic() - began)
            return picture

        qrt._portions.merge = merged
        began = time.monotonic()
        try:
            picture = qrt.distributed.render(scene, counted, seed=seed)
        finally:
            qrt._portions.merge = merge
        wall = time.monotonic() - began - merging[0]
    picture.save(folder / "pool.exr")
    row = (wall, counted.seconds, counted.bytes, merging[0])
    return row, (folder / "pool.exr").read_bytes()


def warm(number):
    """Loads the package into a worker."""
    import qrt

    time.sleep(0.2)
    return number + len(qrt.__version__)


def by_command(command, words, workers, folder, seed):
    """A row of `qrt render --portion`, and the picture's bytes."""
    names = [folder / f"part.{k}" for k in range(workers)]
    began = time.monotonic()
    running = {}
    for k, name in enumerate(names):
        own = ["--portion", f"{k}/{workers}", "-o", name, "--threads", "1", "--seed", seed, "-q"]
        child = subprocess.Popen([command, "render", *words, *map(str, own)])
        running[child.pid] = child
    seconds = []
    while running:
        pid, status, usage = os.wait4(-1, 0)
        if running.pop(pid, None) is not None:
            assert status == 0, status
            seconds.append(usage.ru_utime + usage.ru_stime)
    wall = time.monotonic() - began
    began = time.monotonic()
    picture = folder / "merged.exr"
    subprocess.run([command, "merge", *names, "-o", picture, "-q"], check=True)
    merging = time.monotonic() - began
    return (wall, seconds, [name.stat().st_size for name in names], merging), picture.read_bytes()


def costs(scene, command, words, folder, film, parts):
    """Costs besides tracing, as lines of text. `film` is of one path a pixel, in `parts` parts."""
    width, height = film
    pixels = width * height
    yield f"a pickled scene: {len(pickle.dumps(scene)) / 1000:.1f} kB"
    start = "import pickle, sys, qrt; pickle.load(open(sys.argv[1], 'rb'))"
    (folder / "scene").write_bytes(pickle.dumps(scene))
    seconds, _ = spent([sys.executable, "-c", start, folder / "scene"])
    yield f"a worker of Python that has started and has the scene: {seconds:.2f} s of a processor"
    sets = [f"film={{ width: {width}, height: {height} }}", "sampling.path_bits=0"]
    large = [*words, *(word for one in sets for word in ("--set", one)), "--estimator", "exact"]
    names = [folder / f"large.{k}" for k in range(parts)]
    first = None
    for k, name in enumerate(names):
        portion = ["--portion", f"{k}/{parts}", "-o", name, "--threads", "1", "-q"]
        first = first or spent([command, "render", *large, *portion])
        if k:
            subprocess.run([command, "render", *map(str, [*large, *portion])], check=True)
    yield (
        f"one of {parts} parts of {width} x {height} pixels, of one path each: {first[0]:.2f} s of a "
        f"processor, {first[1] / 1e6:.0f} MB at the most"
    )
    total = sum(name.stat().st_size for name in names)
    yield f"all of them: {total / 1e6:.0f} MB, {total / pixels:.1f} bytes a pixel"
    seconds, most = spent([command, "merge", *names, "-o", folder / "large.exr", "-q"])
    yield f"merged and written: {seconds:.2f} s of a processor, {most / 1e6:.0f} MB at the most"


def spent(words):
    """The processor time of a program in seconds, and the most memory that it had in bytes."""
    child = subprocess.Popen([*map(str, words)])
    _, status, usage = os.wait4(child.pid, 0)
    assert status == 0, (words, status)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def processor():
    """Returns the machine's processor and number of cores."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    return f"{(names or [platform.processor()])[0]}, {len(os.sched_getaffinity(0))} cores"


def main():
    import qrt

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--command", default="target/release/qrt")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--parts", type=int, default=100, help="of the large film [100]")
    asked = parser.parse_args()
    sets = dict(one.split("=", 1) for one in asked.set)
    scene = qrt.load(asked.scene, set=sets)
    words = [asked.scene, *(word for one in asked.set for word in ("--set", one))]
    load = os.getloadavg()[0]
    print(f"{processor()}; load {load:.1f} before, by others; qrt {qrt.__version__}")
    print(f"{scene.name}: {scene.width} x {scene.height} pixels; {json.dumps(sets)}\n")
    print("| by | processes | wall | processor, all | longest part | shortest part | part | merge |")
    print("|---|---|---|---|---|---|---|---|")
    pictures = set()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for way in ("`--portion k/n`", "`qrt.distributed`"):
            for workers in WORKERS:
                if way == "`--portion k/n`":
                    row, picture = by_command(asked.command, words, workers, folder, asked.seed)
                else:
                    row, picture = by_pool(scene, workers, folder, asked.seed)
                pictures.add(picture)
                wall, seconds, sizes, merging = row
                print(
                    f"| {way} | {workers} | {wall:.1f} s | {sum(seconds):.1f} s | {max(seconds):.2f} s "
                    f"| {min(seconds):.2f} s | {sum(sizes) / len(sizes) / 1000:.1f} kB "
                    f"| {1000 * merging:.0f} ms |",
                    flush=True,
                )
        assert len(pictures) == 1, "the pictures differ"
        print()
        for line in costs(scene, asked.command, words, folder, (1920, 1080), asked.parts):
            print(f"- {line}", flush=True)


if __name__ == "__main__":
    main()
