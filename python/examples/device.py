"""An amplitude estimator of one's own: maximum likelihood over growing depths."""

import sys

import numpy

import qrt

oracle = qrt.load(sys.argv[1], set={"sampling.path_bits": 8}).oracle("r")
device = oracle.device(seed=1)
shots = 100

grid = numpy.linspace(0, numpy.pi / 2, 100_001)[1:-1]
likelihood = numpy.zeros_like(grid)
for k in (0, 1, 2, 4, 8, 16, 32):
    good = device.shots(k, shots)
    found = numpy.sin((2 * k + 1) * grid) ** 2
    likelihood += good * numpy.log(found + 1e-300) + (shots - good) * numpy.log(1 - found + 1e-300)
amplitude = numpy.sin(grid[likelihood.argmax()]) ** 2

print(f"S/N is {oracle.amplitude:.5f}, estimated {amplitude:.5f} with {device.queries} queries")
assert abs(amplitude - oracle.amplitude) < 0.02
