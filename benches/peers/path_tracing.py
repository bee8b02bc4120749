#!/usr/bin/env python3
"""Renders a scene of qrt with Mitsuba 3, and says how far its pictures are from the truth for what time.

    path_tracing.py --venv FOLDER --cache FOLDER --errors 0.03,0.01 --seeds 8 SCENE.xml
    path_tracing.py --venv FOLDER --reference tests/references/cornell_D3_16 SCENE.xml
    path_tracing.py --venv FOLDER --speed 64 SCENE.xml

The scenes are what `qrt export --format mitsuba` writes. The first renders with `path`, which samples lights, under each of Mitsuba's samplers, from few
samples a pixel to as many as bring the error below the least of `--errors`. It prints one line of JSON:

    mitsuba, variant    what was run; `scalar_rgb` where the LLVM variant cannot be
    truth               the mean of many renders of many samples, row by row, red, green, blue
    truth_error         its own standard error, as a fraction of its mean
    judged              the pixels that count: those that see no lamp, nor are beside one that does
    curves              by sampler: [samples a pixel, error, seconds], ...

An error is the root mean square over the judged pixels, three channels and all seeds, divided by the
truth's mean there; what the truth's own noise adds is subtracted. Seconds are the processor's, over
all threads, of rendering alone: the least of all seeds, since the first compiles the code. Many samples
are rendered under fewer seeds than `--seeds`, at least two. The truth is kept in `--cache`.

The second compares Mitsuba's picture of a scene of the reference data, as qrt exports it, with the
data: it prints the root mean square of their difference in standard errors, which is about 1.

The third renders with 64 independent samples a pixel, and prints the paths that each variant traces in a
second of the processor: the most of three renders.

Mitsuba is installed from PyPI, at the version in path_tracing.txt, into a virtual environment of its
own, once. Its fast variant needs LLVM as a shared library: on Linux that is installed beside it;
elsewhere Mitsuba looks for one, or DRJIT_LIBLLVM_PATH names it.
"""

import argparse
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from environment import inside

VARIANTS = ["llvm_ad_rgb", "scalar_rgb"]
# Exit status for a variant that this machine does not have.
NOT_HERE = 3

# The reference picture: number of renders, and samples per pixel of each.
TRUTH = (16, 4096)
TRUTH_SAMPLER = "multijitter"
# Samples of a pixel, over all seeds, that suffice to measure an error.
ENOUGH = 8192

# Samples per pixel that the benchmark tries. Most samplers permute a pixel's samples at random, which is
# quickest where they are a power of two, or little less: these take squares, or squares of primes.
POWERS = [4**k for k in range(2, 8)]
SAMPLES = {
    "independent": POWERS,
    "stratified": POWERS,
    "multijitter": POWERS,
    "orthogonal": [prime**2 for prime in (3, 7, 13, 31, 61)],
    "ldsampler": POWERS,
}


class Renderer:
    """Mitsuba with a scene, a file."""

    def __init__(self, mi, file):
        self.mi, self.file = mi, pathlib.Path(file)

    def key(self):
        """Everything that a picture depends on, as bytes."""
        meshes = sorted(self.file.parent.glob(f"{self.file.stem}.*.ply"))
        return b"".join(path.read_bytes() for path in [self.file, *meshes])

    def render(self, sampler, samples, seed, **settings):
        """A picture, and the processor's seconds that it took."""
        import numpy

        mi = self.mi
        settings = {"sampler": sampler, "spp": str(samples)} | settings
        loaded = mi.load_file(str(self.file), **settings)
        if loaded.sensors()[0].sampler().sample_count() != samples:
            sys.exit(f"{sampler} does not take {samples} samples")
        start = time.process_time()
        picture = mi.render(loaded, spp=samples, seed=seed)
        picture = numpy.array(picture)
        return picture.astype(float), time.process_time() - start


class Truth:
    """The mean of many renders, and which of its pixels are judged."""

    def __init__(self, renderer, cache):
        import numpy

        key = hashlib.sha256(repr((renderer.mi.__version__, TRUTH, TRUTH_SAMPLER)).encode())
        key.update(renderer.key())
        file = pathlib.Path(cache) / f"{key.hexdigest()[:32]}.npz"
        if file.exists():
            kept = numpy.load(file)
            self.picture, variance, seen = kept["picture"], kept["variance"], kept["seen"]
        else:
            runs, samples = TRUTH
            seeds = range(1000, 1000 + runs)
            renders = [renderer.render(TRUTH_SAMPLER, samples, seed)[0] for seed in seeds]
            self.picture = numpy.mean(renders, axis=0)
            variance = numpy.var(renders, axis=0, ddof=1) / runs
            emission, _ = renderer.render(TRUTH_SAMPLER, 1024, 1, max_depth="1")
            seen = emission.max(axis=2) > 0
            file.parent.mkdir(parents=True, exist_ok=True)
            part = file.with_suffix(f".{os.getpid()}.npz")
            numpy.savez(part, picture=self.picture, variance=variance, seen=seen)
            part.replace(file)
        # A lamp's rim may touch a pixel that no sample found.
        padded = numpy.pad(seen, 1)
        height, width = seen.shape
        near = [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
        self.judged = ~numpy.any(near, axis=0)
        self.mean = self.picture[self.judged].mean()
        self.variance = variance[self.judged].mean()

    def squared_error(self, picture):
        difference = (picture - self.picture)[self.judged]
        return (difference**2).mean() - self.variance


def curve(renderer, truth, sampler, least, seeds):
    """Samples, errors and seconds, until the error is below the least."""
    points = []
    for samples in SAMPLES[sampler]:
        # At least two runs: the first also compiles the code, which is not rendering.
        runs = max(2, min(seeds, ENOUGH // samples))
        renders = [renderer.render(sampler, samples, seed) for seed in range(1, 1 + runs)]
        squares = [truth.squared_error(picture) for picture, _ in renders]
        error = math.sqrt(max(sum(squares) / runs, 0)) / truth.mean
        points.append([samples, error, min(seconds for _, seconds in renders)])
        if error < least:
            break
    return points


def measure(mi, arguments):
    renderer = Renderer(mi, arguments.scene)
    truth = Truth(renderer, arguments.cache)
    least = min(float(error) for error in arguments.errors.split(","))
    return {
        "truth": truth.picture.reshape(-1).tolist(),
        "truth_error": math.sqrt(truth.variance) / truth.mean,
        "judged": truth.judged.reshape(-1).nonzero()[0].tolist(),
        "curves": {
            sampler: curve(renderer, truth, sampler, least, arguments.seeds) for sampler in SAMPLES
        },
    }


def compare(mi, reference, scene):
    """Returns the distance of a picture from one of the reference data, in standard errors."""
    import numpy

    reference = pathlib.Path(reference)
    theirs = numpy.load(reference.with_name(f"{reference.name}.npy")).astype(float)
    error = numpy.load(reference.with_name(f"{reference.name}_se.npy")).astype(float)
    renderer = Renderer(mi, scene)
    renders = [renderer.render("independent", 1024, seed)[0] for seed in range(16)]
    ours = numpy.mean(renders, axis=0)
    # Rare paths make the estimated error of a pixel too small.
    squares = error**2 + numpy.var(renders, axis=0, ddof=1) / 16 + (1e-4 * theirs.mean()) ** 2
    return {"standard_errors": math.sqrt(((ours - theirs) ** 2 / squares).mean())}


def speed(mi, samples, scene):
    """Returns the paths that are traced in a second of the processor."""
    renderer = Renderer(mi, scene)
    renders = [renderer.render("independent", samples, seed) for seed in range(3)]
    height, width, _ = renders[0][0].shape
    return width * height * samples / min(seconds for _, seconds in renders)


def load_mitsuba(variant):
    """Mitsuba in a variant, or the exit status that says that it isn't here."""
    libraries = sorted(pathlib.Path(sys.prefix).glob("lib/libLLVM.so.*"))
    if libraries:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(libraries[0]))
    import mitsuba

    try:
        mitsuba.set_variant(variant)
        mitsuba.load_dict({"type": "sphere"})
    except (ImportError, RuntimeError) as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_HERE)
    name = variant
    if variant.startswith("llvm"):
        import drjit

        name += f", LLVM {'.'.join(map(str, drjit.detail.llvm_version()))}"
    return mitsuba, {"mitsuba": mitsuba.__version__, "variant": name}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--venv", required=True)
    parser.add_argument("--variant", choices=VARIANTS)
    parser.add_argument("--cache", default=tempfile.gettempdir())
    parser.add_argument("--errors", default="0.03,0.01")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--reference")
    parser.add_argument("--speed", type=int)
    parser.add_argument("scene")
    arguments = parser.parse_args()
    inside(arguments.venv, "path_tracing.txt")
    if arguments.variant:
        mi, said = load_mitsuba(arguments.variant)
        if arguments.reference:
            found = compare(mi, arguments.reference, arguments.scene)
        elif arguments.speed:
            said, found = {}, {said["variant"]: speed(mi, arguments.speed, arguments.scene)}
        else:
            found = measure(mi, arguments)
        print(json.dumps(said | found))
        return
    # An LLVM that does not suit Mitsuba ends its process, so each variant runs in a process of its own.
    if arguments.speed:
        speeds = {}
        for variant in VARIANTS:
            command = [sys.executable, *sys.argv, "--variant", variant]
            done = subprocess.run(command, stdout=subprocess.PIPE)
            if done.returncode == 0:
                speeds |= json.loads(done.stdout)
        print(json.dumps(speeds))
        return
    for variant in VARIANTS:
        command = [sys.executable, *sys.argv, "--variant", variant]
        status = subprocess.run(command).returncode
        if status != NOT_HERE and status >= 0:
            sys.exit(status)
    sys.exit("no variant of Mitsuba runs here")


if __name__ == "__main__":
    main()
