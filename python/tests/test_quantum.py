"""Oracles in other quantum libraries, and devices."""

import collections
import json
import math
import pathlib
import re

import pytest

import qrt

PIXEL = (1, 0)
ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_an_oracle_costs_what_the_command_says(command, box):
    oracle = box.oracle("g", (3, 4))
    words = ["--json", "--channel", "g", "--pixel", "3,4"]
    inspected = json.loads(command("inspect", "box.yaml", *words))
    assert oracle.toffoli == inspected["gates"]["toffoli"]
    assert oracle.and_measured == inspected["gates"]["and_measured"]
    assert (oracle.channel, oracle.pixel, oracle.path_bits) == ("g", (3, 4), 10)
    assert box.oracle().channel in "rgb"
    with pytest.raises(qrt.RequestError, match="no pixel"):
        box.oracle("r", (13, 0))
    with pytest.raises(qrt.RequestError, match="r, g, b"):
        box.oracle("red")
    with pytest.raises(qrt.SceneError, match="budget"):
        qrt.parse(box.to_yaml(), {"budget": {"toffoli": 10}}).oracle("r")


# The class of a pixel's oracle depends on whether the pixel sees the lamp of the lit box.
@pytest.mark.parametrize(
    "scene, pixel, pixel_class",
    [
        ("lit-box", (4, 1), "may-see-lamp"),
        ("lit-box", (4, 4), "sees-no-lamp"),
        ("cornell-box", (3, 4), "all"),
        ("room", (5, 6), "all"),
    ],
)
def test_an_oracle_costs_what_every_command_says_of_it(
    command, tmp_path, scene, pixel, pixel_class
):
    if scene == "room":
        command("new", "room")
        path = tmp_path / "room.yaml"
    else:
        path = ROOT / "scenes-yaml" / f"{scene}.yaml"
    few = {"sampling.path_bits": 2, "film": {"width": 8, "height": 8}}
    oracle = qrt.load(path, few).oracle("g", pixel, seed=5)
    sets = ["--set", "sampling.path_bits=2", "--set", "film={ width: 8, height: 8 }", "--json"]
    asked = ["--pixel", f"{pixel[0]},{pixel[1]}", "--channel", "g", "--seed", "5", *sets]
    inspected = json.loads(command("inspect", str(path), *asked))
    exported = json.loads(command("export", str(path), "-o", "one.qasm", *asked))
    verified = command("verify", str(path), "--pixels", "64", *sets)
    assert oracle.pixel_class == pixel_class == inspected["class"] == exported["class"]
    assert oracle.qubits == inspected["qubits"]["peak"] == exported["qubits"]
    gates = {
        "toffoli": oracle.toffoli,
        "and_measured": oracle.and_measured,
        "cnot": oracle.cnot,
        "x": oracle.x,
        "toffoli_depth": oracle.toffoli_depth,
    }
    assert gates == inspected["gates"] == exported["oracle"]["gates"]
    assert exported["gates"]["ccx"] == oracle.toffoli
    assert exported["gates"]["x"] == oracle.x
    # Both commands list the oracles of all pixels of a class, which have no pixel built in.
    assert json.loads(verified)["oracles"] == inspected["oracles"]
    listed = [one for one in inspected["oracles"] if one["channel"] == "g"]
    listed = next(one for one in listed if one["class"] == pixel_class)
    assert listed["toffoli"] >= oracle.toffoli and listed["qubits"] >= oracle.qubits
    text = oracle.qasm()
    assert text.count("\nccx ") == oracle.toffoli
    assert f"{oracle.qubits:,} qubits, {oracle.toffoli:,} Toffolis" in text


def test_good_indices_are_those_of_the_picture(box):
    picture = box.render(model="fixed", estimator="exact", crop=(4, 5, 1, 1), seed=2)
    for number, channel in enumerate("rgb"):
        oracle = box.oracle(channel, (4, 5), seed=2)
        assert oracle.good == picture.good[0, 0, number]
        assert oracle.total == picture.total
        assert oracle.thresholds.sum() == oracle.good
        assert oracle.scale == picture.scales[0, 0, number]
        assert oracle.amplitude == oracle.good / oracle.total


def test_a_device_measures_with_exact_probabilities(box):
    oracle = box.oracle("r", (4, 5))
    theta = math.asin(math.sqrt(oracle.amplitude))
    device = oracle.device(seed=1)
    shots = 200_000
    for k in (0, 1, 5, 1000):
        expected = math.sin((2 * k + 1) * theta) ** 2
        found = device.shots(k, shots) / shots
        # Six standard errors.
        assert abs(found - expected) < 6 * math.sqrt(expected * (1 - expected) / shots) + 1e-9, k
    assert device.queries == shots * (1 + 1 + 5 + 1000) and device.measured == 4 * shots
    assert isinstance(device.shot(3), bool)
    same = [oracle.device(seed=7).shots(2, 100) for _ in range(2)]
    assert same[0] == same[1]
    outcomes = oracle.device(seed=1).phases(8, 5, window="sine")
    assert len(outcomes) == 5 and all(0 <= y <= 128 for y in outcomes)


def test_a_noisy_device_forgets(box):
    oracle = box.oracle("r", (4, 5))
    found = oracle.device(seed=1, noise="depolarising=1").shots(9, 100_000) / 100_000
    assert abs(found - oracle.amplitude) < 0.01


def test_the_command_counts_the_same_numbers(command, dot):
    """S and N of an oracle are what `qrt count` takes; its outcome is likeliest where S/N is."""
    oracle = dot.oracle("r", PIXEL)
    assert (oracle.good, oracle.total) == (12, 32)
    numbers = ("--good", oracle.good, "--total", oracle.total, "--phase-bits", 6)
    told = json.loads(command("count", *numbers, "--json"))["outcomes"]
    likeliest = max(told, key=lambda outcome: outcome["probability"])
    theta = math.asin(math.sqrt(oracle.amplitude)) / math.pi
    assert abs(likeliest["theta"] - theta) <= 0.5 / 2**6


# A lamp in front of some of the paths of one pixel: S/N is 3/8, on 16 qubits. Every tested power of the
# iterate changes that probability, so that no other operator passes the test.
EDGE = """
name: edge
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 1, height: 1 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [-0.25, -1, 0], [-0.25, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
precision: { fraction: 5 }
comparator: { bits: 1 }
circuit: { uncompute: scoped }
"""


def test_qiskits_iterative_estimation_agrees(command):
    """The whole circuit, every gate on a statevector, measured by Qiskit's own estimator; `qrt count` of the
    same oracle; and every path, counted."""
    pytest.importorskip("qiskit_algorithms")
    from qiskit.primitives import StatevectorSampler
    from qiskit_algorithms import IterativeAmplitudeEstimation

    scene = qrt.parse(EDGE)
    oracle = scene.oracle("r", (0, 0))
    lit = int((scene.paths((0, 0), model="fixed")[:, 0] > 0).sum())
    assert (lit, oracle.good, oracle.total) == (3, 6, 16)
    assert (oracle.qubits, oracle.counts.differing) == (16, 0)
    problem = oracle.estimation_problem()
    sampler = StatevectorSampler(default_shots=100, seed=5)
    estimator = IterativeAmplitudeEstimation(0.03, 0.05, sampler=sampler)
    found = estimator.estimate(problem)
    theta = math.asin(math.sqrt(lit / 8))
    tried = [math.sin((2 * k + 1) * theta) ** 2 for k in found.powers if k]
    assert tried and all(abs(probability - lit / 8) > 0.1 for probability in tried), found.powers
    low, high = found.confidence_interval
    assert high - low < 0.06
    numbers = ("--good", oracle.good, "--total", oracle.total, "--phase-bits", 7)
    told = json.loads(command("count", *numbers, "--shots", 20, "--seed", 1, "--json"))
    lower, higher = told["estimate"]["interval"]
    assert higher - lower < 0.06
    for left, right in ((low, high), (lower, higher)):
        assert left <= lit / 8 <= right
    scaled = [end * oracle.scale for end in (low, high)]
    assert found.confidence_interval_processed == pytest.approx(scaled)


def test_qiskit_reads_every_part(dot):
    pytest.importorskip("qiskit")
    oracle = dot.oracle("r", PIXEL)
    circuit = oracle.to_qiskit()
    assert circuit.num_qubits == oracle.qubits
    assert circuit.count_ops()["ccx"] == oracle.toffoli
    assert oracle.to_qiskit("grover").count_ops()["ccx"] >= oracle.toffoli
    with pytest.raises(qrt.RequestError, match="oracle, grover, counting"):
        oracle.to_qiskit("all")


PARTS = ("oracle", "grover", "counting")


def gates_of(oracle, part):
    """Counts the gates in the OpenQASM 2 of a part by name; controls count as part of a name."""
    names = re.findall(r"^([a-z0-9]+)(?:\([^)]*\))? \w+\[", oracle.qasm(2, part), re.MULTILINE)
    return collections.Counter(name for name in names if name not in ("qreg", "creg", "measure"))


@pytest.mark.parametrize("part", PARTS)
def test_pennylane_reads_every_part(part):
    pennylane = pytest.importorskip("pennylane")
    pytest.importorskip("openqasm3")
    oracle = qrt.parse(EDGE, {"counting.phase_bits": 3}).oracle("r")
    tape = pennylane.tape.make_qscript(oracle.to_pennylane(part))()
    found = collections.Counter(operation.name for operation in tape.operations)
    expected = gates_of(oracle, part)
    assert expected["ccx"] > 0 and expected["cx"] > 0
    assert found["Toffoli"] == expected["ccx"] and found["CNOT"] == expected["cx"]
    assert sum(found.values()) == sum(expected.values())
    with pytest.raises(qrt.RequestError, match="oracle, grover, counting"):
        oracle.to_pennylane("all")


@pytest.mark.parametrize("part", PARTS)
def test_cirq_reads_every_part(part):
    pytest.importorskip("cirq")
    pytest.importorskip("ply")
    oracle = qrt.parse(EDGE, {"counting.phase_bits": 3}).oracle("r")
    operations = list(oracle.to_cirq(part).all_operations())
    gates = [str(operation.gate) for operation in operations]
    expected = gates_of(oracle, part)
    assert gates.count("TOFFOLI") == expected["ccx"] > 0
    assert gates.count("CNOT") == expected["cx"] > 0
    measured = sum("measure" in line for line in oracle.qasm(2, part).splitlines())
    assert len(operations) - sum(expected.values()) in (0, measured)


def test_openqasm_says_what_it_is(dot):
    oracle = dot.oracle("r", PIXEL)
    assert oracle.qasm().startswith("OPENQASM 3")
    assert oracle.qasm(2, "counting").startswith("OPENQASM 2")
    gates = len(re.findall(r"^ccx ", oracle.qasm(2), re.MULTILINE))
    assert gates == oracle.toffoli
    with pytest.raises(qrt.RequestError, match="max_gates"):
        oracle.qasm(3, "oracle", max_gates=10)
    with pytest.raises(qrt.RequestError, match="OpenQASM 1"):
        oracle.qasm(1)


def test_logical_counts_are_what_qdk_takes(command, dot, tmp_path):
    oracle = dot.oracle("r", PIXEL)
    (tmp_path / "dot.yaml").write_text(dot.to_yaml(), encoding="utf-8")
    words = ("inspect", "dot.yaml", "--channel", "r", "--logical-counts", "counts.json")
    command(*words)
    told = json.loads((tmp_path / "counts.json").read_text())
    for of in ("oracle", "channel", "pixel", "film"):
        assert oracle.logical_counts(of) == told["measured"][of]
        assert oracle.logical_counts(of, measured=False) == told["unitary"][of]
    pytest.importorskip("qdk")
    from qdk.estimator import LogicalCounts

    counts = oracle.logical_counts()
    estimated = LogicalCounts(counts).estimate()
    assert estimated["physicalCounts"]["physicalQubits"] > 0
