"""FLIP by its authors' own program, of pictures that the tests of qrt make by the same formulas.

    pip install flip-evaluator==1.7 numpy
    python benches/peers/flip.py

prints the figures that `qrt-lab/src/compare/tests.rs` holds.
"""

import flip_evaluator
import numpy

WIDTH, HEIGHT = 48, 32


def shown():
    """Discs on a gradient; the test is one column to the right, and a corner of it is noisy."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]

    def picture(x):
        disc = (x - 20) ** 2 + (y - 15) ** 2 < 81
        red = numpy.where(disc, 220, 4 * x % 256)
        green = numpy.where(disc, 40, 6 * y % 256)
        blue = numpy.where((x // 6 + y // 6) % 2 == 0, 200, 30)
        return numpy.stack([red, green, blue], axis=-1)

    reference, test = picture(x), picture(x - 1)
    noise = (x * 7919 + y * 104729) % 97
    corner = (x > 36) & (y > 22)
    test = numpy.where(corner[..., None], (test + noise[..., None]) % 256, test)
    return reference / 255, test / 255


def radiance():
    """The same as linear radiance, with a lamp that is a thousand times as bright."""
    reference, test = shown()
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    lamp = (x < 8) & (y < 5)
    light = numpy.where(lamp, 1000.0, 0.5)[..., None]
    return reference**2 * light, test**2 * light


def main():
    for name, kind, (reference, test) in [
        ("shown", "LDR", shown()),
        ("radiance", "HDR", radiance()),
    ]:
        for density in [67.0206432765, 20.0]:
            found, mean, parameters = flip_evaluator.evaluate(
                reference.astype(numpy.float32),
                test.astype(numpy.float32),
                kind,
                inputsRGB=kind == "LDR",
                applyMagma=False,
                parameters={"ppd": density},
            )
            found = numpy.asarray(found)
            probes = [float(found[y, x].item()) for x, y in [(0, 0), (11, 15), (30, 8), (40, 27)]]
            print(name, density, f"{mean:.7f}", [f"{value:.7f}" for value in probes], parameters)


if __name__ == "__main__":
    main()
