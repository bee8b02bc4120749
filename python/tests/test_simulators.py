"""Complete counting circuits on simulators that nobody here wrote, and on one of a few lines."""

import cmath
import math
import pathlib
import re
import subprocess
import sys

import numpy
import pytest

import qrt

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = ROOT / "scenes-yaml/small"
EXAMPLES = ROOT / "python/examples"


class Amplitudes:
    """A state vector without the basis states whose amplitude is zero; it knows the gates by their matrices alone."""

    def __init__(self):
        self.states = numpy.zeros(1, dtype=numpy.uint64)
        self.values = numpy.ones(1, dtype=complex)

    def bit(self, place):
        return (self.states >> numpy.uint64(place)) & numpy.uint64(1)

    def flip(self, place, controls):
        on = numpy.ones(len(self.states), dtype=bool)
        for control in controls:
            on &= self.bit(control) == 1
        self.states[on] ^= numpy.uint64(1 << place)

    def turn(self, places, phase):
        on = numpy.ones(len(self.states), dtype=bool)
        for place in places:
            on &= self.bit(place) == 1
        self.values[on] *= phase

    def mix(self, place, matrix):
        one = self.bit(place).astype(int)
        zero = self.states & ~numpy.uint64(1 << place)
        states = numpy.concatenate([zero, zero | numpy.uint64(1 << place)])
        matrix = numpy.asarray(matrix)
        values = numpy.concatenate([self.values * matrix[0, one], self.values * matrix[1, one]])
        self.states, places = numpy.unique(states, return_inverse=True)
        self.values = numpy.zeros(len(self.states), dtype=complex)
        numpy.add.at(self.values, places, values)
        kept = abs(self.values) > 1e-14
        self.states, self.values = self.states[kept], self.values[kept]


def run(text):
    """Runs OpenQASM 2, and returns the probabilities of what is measured, with the number of qubits."""
    first, qubits, measured = {}, 0, {}
    state = Amplitudes()
    for line in text.splitlines():
        line = line.partition("//")[0].strip()
        if not line or line.startswith(("OPENQASM", "include", "creg")):
            continue
        if found := re.fullmatch(r"qreg (\w+)\[(\d+)\];", line):
            first[found[1]] = qubits
            qubits += int(found[2])
            continue
        name, angle = re.match(r"(\w+)(?:\(([^)]*)\))?", line).groups()
        places = [first[name] + int(at) for name, at in re.findall(r"(\w+)\[(\d+)\]", line) if name in first]
        if name == "measure":
            measured[places[0]] = int(re.search(r"-> \w+\[(\d+)\]", line)[1])
        elif name in ("x", "cx", "ccx"):
            state.flip(places[-1], places[:-1])
        elif name in ("z", "cz"):
            state.turn(places, -1)
        elif name in ("u1", "cu1"):
            state.turn(places, cmath.exp(1j * float(angle)))
        elif name == "h":
            state.mix(places[0], numpy.array([[1, 1], [1, -1]]) / math.sqrt(2))
        elif name == "ry":
            c, s = math.cos(float(angle) / 2), math.sin(float(angle) / 2)
            state.mix(places[0], [[c, -s], [s, c]])
        else:
            raise AssertionError(f"no such gate here: {line}")
    outcomes = sum(state.bit(place) << numpy.uint64(bit) for place, bit in measured.items())
    weights = abs(state.values) ** 2
    return numpy.bincount(outcomes.astype(int), weights, 1 << len(measured)), qubits


def folded(probabilities):
    """y and T - y are one outcome."""
    half = len(probabilities) // 2
    mirrored = probabilities[half + 1 :][::-1]
    return probabilities[: half + 1] + numpy.concatenate([[0], mirrored, [0]])


@pytest.mark.parametrize("name", ["edge", "lit-wall", "mirror", "corner", "slanted"])
def test_a_small_scene_is_counted_as_an_independent_simulator_says(name):
    scene = qrt.load(SMALL / f"{name}.yaml")
    oracle = scene.oracle(pixel=(1, 0))
    probabilities, qubits = run(oracle.qasm(2, "counting"))
    assert qubits == scene.inspect(pixel=(1, 0)).complete_qubits[str(oracle.phase_bits)]
    simulated = scene.simulate(pixel=(1, 0))
    assert 0 < simulated.good / simulated.total < 1
    theory = scene.count(pixel=(1, 0))
    found = folded(probabilities)
    for outcome, theoretical, other in zip(simulated.outcomes, theory.outcomes, found):
        assert outcome.simulated == pytest.approx(other, abs=1e-10)
        assert theoretical.probability == pytest.approx(other, abs=1e-10)
    assert found.sum() == pytest.approx(1, abs=1e-10)


MODULES = {"aer": "qiskit_aer", "aer-single": "qiskit_aer", "cirq": "cirq", "pennylane": "pennylane", "qdk": "qdk"}


# Aer runs all five. `shadow` has up to 470 qubits: no dense state vector holds its amplitudes.
RUNS = [
    *((simulator, name) for simulator in MODULES for name in ("edge", "lit-wall")),
    *((simulator, name) for simulator in ("aer", "aer-single") for name in ("mirror", "corner")),
    # 23 qubits, in place of 20.
    *(pytest.param(simulator, "slanted", marks=pytest.mark.long) for simulator in ("aer", "aer-single")),
]


@pytest.mark.parametrize("simulator, name", RUNS)
def test_other_simulators_agree_with_theory(simulator, name):
    pytest.importorskip(MODULES[simulator])
    if simulator == "pennylane":
        pytest.importorskip("openqasm3")
    words = [sys.executable, EXAMPLES / "simulators.py", simulator, SMALL / f"{name}.yaml", "1", "0"]
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=1800)
    assert done.returncode == 0, done.stderr
    assert "largest difference" in done.stdout


def test_estimation_under_noise_says_what_it_finds():
    pytest.importorskip("qiskit_aer")
    words = [sys.executable, EXAMPLES / "noisy_estimation.py"]
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert "without noise" in done.stdout and "with noise" in done.stdout


@pytest.mark.parametrize(
    "module, extra, method",
    [
        ("cirq", "cirq", "to_cirq"),
        ("pennylane", "pennylane", "to_pennylane"),
        ("openqasm3", "pennylane", "to_pennylane"),
        ("qiskit", "qiskit", "to_qiskit"),
        ("qiskit", "qiskit", "estimation_problem"),
        ("qiskit_algorithms", "qiskit", "estimation_problem"),
    ],
)
def test_a_missing_library_names_the_extra_that_has_it(dot, monkeypatch, module, extra, method):
    if module == "openqasm3":
        pytest.importorskip("pennylane")
    if module == "qiskit_algorithms":
        pytest.importorskip("qiskit")
    # Python refuses to import a module that is None here, and then its submodules, whether installed or not.
    for name in list(sys.modules):
        if name == module or name.startswith(f"{module}."):
            monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=rf"pip install './python\[{extra}\]'"):
        getattr(dot.oracle("r", (1, 0)), method)()
