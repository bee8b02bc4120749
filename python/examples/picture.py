"""A scene becomes a picture, and the picture numbers."""

import sys

import numpy

import qrt

scene = qrt.load(sys.argv[1], set={"film": {"width": 24, "height": 24}, "sampling.path_bits": 10})
counted = scene.render(seed=1)
exact = scene.render(estimator="exact", seed=1)

print(counted.pixels.shape, counted.pixels.dtype)
error = numpy.sqrt(numpy.mean((counted.pixels - exact.pixels) ** 2))
print(f"error of counting: {error / exact.pixels.mean():.1%} of the mean")
print(f"queries a pixel: {counted.queries.mean():.0f}")
counted.save("counted.png")

paths = scene.paths((12, 12), seed=1)
print(f"{len(paths)} paths, of which {numpy.count_nonzero(paths.any(axis=1))} carry light")

try:
    qrt.load(sys.argv[1], set={"film.width": "wide"})
except qrt.SceneError as error:
    for problem in error.problems:
        print(problem.code, problem.file, problem.line, problem.column, problem.message)
