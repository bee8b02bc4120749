"""One pixel from a routine of ten lines to a count, in numpy: the program of examples/one_pixel.rs.

It has no gates. A state is an array with an amplitude for each of the 32 indices, 8 paths under 4 thresholds.
"""

import numpy

# ANCHOR: trace
PATHS, THRESHOLDS = 8, 4


def trace(path):
    """The light of the ray into cell `path` of the ceiling: 0 to 3. The lamp fills the cells 3 to 6."""
    return {3: 3, 4: 3, 5: 2, 6: 1}.get(path, 0)


def colours():
    return [trace(path) for path in range(PATHS)]


# ANCHOR_END: trace
# ANCHOR: mark
def good():
    """For each of the 32 indices, True if it is good: first all paths for threshold 0, and so on."""
    return numpy.array([y < colour for y in range(THRESHOLDS) for colour in colours()])


# ANCHOR_END: mark
# ANCHOR: oracle
def oracle(state):
    """The phase oracle: the signs of good indices are flipped."""
    return numpy.where(good(), -state, state)


# ANCHOR_END: oracle
# ANCHOR: grover
START = numpy.full(PATHS * THRESHOLDS, (PATHS * THRESHOLDS) ** -0.5)


def iterate(state):
    """Grover's iterate: the phase flip, and the reflection about the mean."""
    flipped = oracle(state)
    return 2 * flipped.mean() - flipped


def amplified(iterates):
    state = START
    for _ in range(iterates):
        state = iterate(state)
    return state


# ANCHOR_END: grover
# ANCHOR: count
T = 32  # five qubits in the phase register
WINDOW = numpy.sqrt(2 / (T + 1)) * numpy.sin(numpy.pi * (numpy.arange(T) + 1) / (T + 1))


def distribution():
    """The probability of each value y of the phase register: in the branch with the value j, j iterates run."""
    branches = numpy.array([weight * amplified(j) for j, weight in enumerate(WINDOW)])
    # The inverse Fourier transform of the register, whose signs numpy calls forward.
    return (abs(numpy.fft.fft(branches, axis=0, norm="ortho")) ** 2).sum(axis=1)


def theory(s):
    """The same distribution for `s` good indices, from the angle alone."""
    theta = numpy.arcsin(numpy.sqrt(s / 32)) / numpy.pi
    phases = numpy.exp(2j * numpy.pi * theta * numpy.arange(T))
    parts = [numpy.fft.fft(WINDOW * part, norm="ortho") for part in (phases, phases.conj())]
    return sum(abs(part) ** 2 for part in parts) / 2


def uniform(seed):
    """The first number of qrt's generator under `seed`, Philox 4x32 with ten rounds: 0 to 1."""
    a, b, c, d, key = 0, 0, 0, 0, [seed, 0]
    for _ in range(10):
        first, second = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, b = second >> 32 ^ b ^ key[0], second & 0xFFFFFFFF
        c, d = first >> 32 ^ d ^ key[1], first & 0xFFFFFFFF
        key = [key[0] + 0x9E3779B9 & 0xFFFFFFFF, key[1] + 0xBB67AE85 & 0xFFFFFFFF]
    return ((a | b << 32) >> 11) / 2**53


def count(seed):
    """Runs the circuit once, and returns the outcome y, from 0 to 16."""
    y = int(numpy.searchsorted(numpy.cumsum(distribution()), uniform(seed), side="right"))
    return min(y, T - y)


# ANCHOR_END: count
# ANCHOR: report
def plain(value):
    """A number without a fraction of zeros, as Rust writes it."""
    return f"{value:g}"


def main():
    print(f"colours {colours()}, mean {plain(numpy.mean(colours()))}")
    s = good().sum()
    print(f"{s} of 32 indices are good: the pixel is {plain(4 * s / 32)}")
    assert ((oracle(START) < 0) == good()).all()
    for iterates in range(4):
        percent = 100 * (amplified(iterates)[good()] ** 2).sum()
        print(f"after {iterates} iterates a good index is read with {percent:.1f} %")
    assert numpy.allclose(distribution(), theory(s))
    for seed in (1, 2, 3):
        y = count(seed)
        # The number of good indices for which the outcome y, which T - y repeats, is most probable.
        likeliest = max(range(33), key=lambda s: theory(s)[y])
        print(f"31 queries read {y}: likeliest {likeliest} good, pixel {plain(4 * likeliest / 32)}")


if __name__ == "__main__":
    main()
# ANCHOR_END: report
