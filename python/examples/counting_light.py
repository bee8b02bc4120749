# %% [markdown]
# # Counting light
#
# A scene is written, rendered by quantum counting, and compared with the exact sum over all of its paths.

# %%
import numpy
import qrt

text = """
name: lamp
camera: { perspective: { eye: [0, 1.2, 3], target: [0, 0.7, 0], vfov: 45 } }
film: { width: 24, height: 18 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.7, 0.6] } }
  wall: { lambertian: { albedo: [0.3, 0.5, 0.7] } }
  lamp: { emitter: { radiance: [6, 5, 4] } }
geometry:
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -1], [-2, 0, -1]], material: floor }
  - quad: { vertices: [[-2, 0, -1], [2, 0, -1], [2, 3, -1], [-2, 3, -1]], material: wall }
  - quad: { vertices: [[-0.6, 1.9, -0.3], [0.6, 1.9, -0.3], [0.6, 1.9, 0.5], [-0.6, 1.9, 0.5]], material: lamp }
sampling: { path_bits: 8, depths: [{ bits: [6, 6] }, { bits: [6, 6], light: [5, 5] }] }
comparator: { bits: 8 }
"""
scene = qrt.parse(text)
counted = scene.render(seed=1)
counted
#> <qrt.Picture of "lamp", 24 x 18 pixels, real, auto>

# %% [markdown]
# The same, with all paths added up, is what counting estimates. The difference is its error, which more
# queries make smaller:

# %%
exact = scene.render(estimator="exact", seed=1)
mean = exact.pixels.mean()
for bits in (5, 7, 9):
    picture = qrt.parse(text, set={"counting.estimator": "sine", "counting.phase_bits": bits}).render(seed=1)
    error = numpy.sqrt(numpy.mean((picture.pixels - exact.pixels) ** 2)) / mean
    print(f"{picture.queries.mean():8.0f} queries a pixel: {error:.2%} of the mean")
#>       93 queries a pixel: 26.61% of the mean
#>      381 queries a pixel: 6.64% of the mean
#>     1533 queries a pixel: 1.32% of the mean

# %% [markdown]
# What is counted is a circuit, and this is what one call of it costs:

# %%
oracle = scene.oracle("g", (12, 9))
oracle
#> <qrt.Oracle of "lamp", channel g, pixel (12, 9): 3036 Toffolis on 1827 qubits>

# %% [markdown]
# Its device answers as a quantum computer would, with the exact probability of every outcome. So any code
# that estimates amplitudes can be tried on it, such as this maximum likelihood over a few depths:

# %%
device = oracle.device(seed=3)
grid = numpy.linspace(1e-4, numpy.pi / 2 - 1e-4, 20_001)
likelihood = numpy.zeros_like(grid)
queries = 0
for k in (0, 1, 2, 4, 8, 16):
    for _ in range(30):
        good = device.shot(k)
        p = numpy.sin((2 * k + 1) * grid) ** 2
        likelihood += numpy.log(numpy.clip(p if good else 1 - p, 1e-12, None))
        queries += 2 * k + 1
estimate = numpy.sin(grid[likelihood.argmax()]) ** 2
print(f"{estimate:.4f} by {queries} queries; S/N is {oracle.good / oracle.total:.4f}")
assert abs(estimate - oracle.good / oracle.total) < 0.02
#> 0.1908 by 2040 queries; S/N is 0.1930
