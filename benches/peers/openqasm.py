#!/usr/bin/env python3
"""Has other people's importers read what `qrt export` writes, and other people's simulators run it.

    cargo build --release
    benches/peers/openqasm.py --venv FOLDER [--qrt target/release/qrt]

Of a small scene (examples/lit-wall.yaml):

* every importer reads the oracle, and the quick ones the iterate and the counting circuit too, in each
  language that it knows, and finds as many gates of each kind as qrt says it wrote;
* the oracle, as Qiskit has read it, runs on every id: its sign is turned for as many as
  `qrt render --counts` calls good, and every other qubit is zero again;
* Q#'s sparse simulator runs the whole counting circuit, shot by shot: its outcomes are compared with
  the distribution of `qrt count` by their chi-square;
* Q#'s resource estimator counts the oracle's Toffolis, and `qrt inspect` says the same.

It takes ten minutes, most of them Q#'s, and exits with 1 if anything disagrees. The tools are installed
from PyPI, at the versions in openqasm.txt, into a virtual environment of their own, once.
"""

import argparse
import collections
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

from environment import inside

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = [
    "sampling.path_bits=3",
    "precision.fraction=6",
    "comparator.bits=2",
    "counting.phase_bits=3",
]
# A shot takes a quarter of a second.
SHOTS = 200
# Q# gives shot i the seed SEED + i: neighbouring seeds have most of their shots in common.
SEED = 31415
# A chi-square of up to 4 degrees of freedom exceeds this with probability 10^-6.
MOST_CHI_SQUARE = 33.4


class Qrt:
    """The command, in a folder of its own."""

    def __init__(self, command, folder):
        self.command = str(pathlib.Path(command).resolve())
        self.folder = pathlib.Path(folder)

    def run(self, *words, sets=()):
        sets = [word for key in sets for word in ("--set", key)]
        words = [self.command, *map(str, words), *sets]
        done = subprocess.run(words, cwd=self.folder, check=True, capture_output=True, text=True)
        return done.stdout

    def export(self, scene, language, part, sets=(), more=()):
        """The text, and its figures."""
        file = self.folder / "circuit.qasm"
        words = ("export", scene, "--json", "-o", file, "--format", language, "--part", part)
        answer = self.run(*words, *more, sets=sets)
        return file.read_text(), json.loads(answer)


# Key for an importer that counts Toffolis alone.
TOFFOLIS = "Toffolis"

# Importers: each returns the number of gates by their names in OpenQASM.


def of_qiskit(circuit):
    counts = {name: n for name, n in circuit.count_ops().items() if name != "measure"}
    return collections.Counter(counts)


def qiskit(text):
    from qiskit import qasm3

    return of_qiskit(qasm3.loads(text))


def qiskit_experimental(text):
    from qiskit import qasm3

    return of_qiskit(qasm3.loads_experimental(text))


def qiskit2(text):
    from qiskit import qasm2

    return of_qiskit(qasm2.loads(text))


def cirq(text):
    from cirq.contrib.qasm_import import circuit_from_qasm

    names = {
        "X": "x", "CNOT": "cx", "TOFFOLI": "ccx", "H": "h", "Z": "z", "CZ": "cz",
        "Ry": "ry",
    }  # fmt: skip
    found = collections.Counter()
    for operation in circuit_from_qasm(text).all_operations():
        gate = operation.gate
        word = str(gate).split("(")[0]
        if "Measurement" not in type(gate).__name__:
            found[names.get(word, word)] += 1
    return found


def pennylane(text):
    import pennylane

    # PennyLane supports neither `measure` nor `include`.
    lines = [line for line in text.splitlines() if "measure" not in line and "include" not in line]
    with pennylane.queuing.AnnotatedQueue() as queue:
        pennylane.from_qasm3("\n".join(lines), {})()
    names = {
        "PauliX": "x", "CNOT": "cx", "Toffoli": "ccx", "Hadamard": "h", "PauliZ": "z", "CZ": "cz",
        "RY": "ry", "ControlledPhaseShift": "cp", "PhaseShift": "p",
    }  # fmt: skip
    tape = pennylane.tape.QuantumScript.from_queue(queue)
    return collections.Counter(names.get(gate.name, gate.name) for gate in tape.operations)


def mqt(text):
    from mqt.core import load

    circuit = load(text)
    found = collections.Counter()
    for gate in circuit:
        name = str(gate.type_).rsplit(".", 1)[-1]
        if name != "measure":
            found["c" * len(gate.controls) + name] += 1
    return found


def pytket(text):
    from pytket import OpType
    from pytket.qasm import circuit_from_qasm_str

    names = {
        "X": "x", "CX": "cx", "CCX": "ccx", "H": "h", "Z": "z", "CZ": "cz", "Ry": "ry",
        "U1": "u1", "CU1": "cu1",
    }  # fmt: skip
    circuit = circuit_from_qasm_str(text, maxwidth=64)
    counts = {name: circuit.n_gates_of_type(getattr(OpType, op)) for op, name in names.items()}
    return collections.Counter(counts)


def qsharp(text):
    """Only its estimator tells gates apart: Toffolis."""
    from qdk import openqasm

    counts = openqasm.estimate(text)["logicalCounts"]
    return collections.Counter({TOFFOLIS: counts["cczCount"] + counts["ccixCount"]})


THREE = {
    "Qiskit": qiskit,
    "Qiskit, experimental": qiskit_experimental,
    "Q#": qsharp,
    "Cirq": cirq,
    "PennyLane": pennylane,
    "MQT Core": mqt,
}
TWO = {"Qiskit": qiskit2, "Q#": qsharp, "Cirq": cirq, "MQT Core": mqt, "pytket": pytket}
LANGUAGES = {"openqasm3": THREE, "openqasm2": TWO}
# These importers take minutes for 200,000 gates, so they read oracles alone.
SHORT = {"pytket", "Q#"}


def agrees(found, said):
    """As many gates of each kind; importers that rename phases have as many in all."""
    said = collections.Counter(said)
    if TOFFOLIS in found:
        return found[TOFFOLIS] == said["ccx"]
    if sum(found.values()) != sum(said.values()):
        return False
    return all(found[name] == said[name] for name in ("x", "cx", "ccx", "h", "z", "cz", "ry"))


def signs(text):
    """Runs an oracle, as Qiskit has read it, on every id: how many signs are turned."""
    from qiskit import qasm3

    circuit = qasm3.loads(text)
    place = {qubit: at for at, qubit in enumerate(circuit.qubits)}
    gates = [
        (step.operation.name, [place[qubit] for qubit in step.qubits]) for step in circuit.data
    ]
    ids = [place[q] for register in circuit.qregs if register.name != "work" for q in register]
    turned = 0
    for value in range(1 << len(ids)):
        start = [0] * len(place)
        for bit, at in enumerate(ids):
            start[at] = value >> bit & 1
        state, sign = list(start), 0
        for name, on in gates:
            if name == "z":
                sign ^= state[on[0]]
            elif name in ("x", "cx", "ccx"):
                state[on[-1]] ^= all(state[at] for at in on[:-1])
            else:
                raise ValueError(f"{name} in an oracle")
        if state != start:
            raise ValueError(f"id {value} is not what it was, or an ancilla is not zero")
        turned += sign
    return turned


def shots(text):
    """Outcomes of the counting circuit on Q#'s sparse simulator."""
    from qdk import openqasm

    found = collections.Counter()
    for outcome in openqasm.run(text, shots=SHOTS, seed=SEED):
        bits = [str(bit).endswith("One") for bit in outcome]
        found[sum(bit << place for place, bit in enumerate(bits))] += 1
    return found


def chi_square(found, expected):
    """Of folded outcomes, y and T - y together, against their probabilities; and its degrees of freedom.

    Outcomes of which fewer than five are expected are one."""
    size = 2 * (len(expected) - 1)
    folded = collections.Counter()
    for y, n in found.items():
        folded[min(y, size - y)] += n
    cells, rare = [], [0, 0.0]
    for y, probability in enumerate(expected):
        if probability < 1e-12 and folded[y]:
            return math.inf, len(expected) - 1
        if probability * SHOTS < 5:
            rare[0] += folded[y]
            rare[1] += probability * SHOTS
        else:
            cells.append((folded[y], probability * SHOTS))
    if rare[1] > 0:
        cells.append(tuple(rare))
    return sum((n - mean) ** 2 / mean for n, mean in cells), len(cells) - 1


def read(importer, text, figures):
    """Returns whether an importer finds the gates that were written; if not, its answer."""
    try:
        found = importer(text)
    except Exception as error:  # an importer that refuses is an answer, too
        return False, f": {type(error).__name__}: {error}"[:300]
    holds = agrees(found, figures["gates"])
    return holds, "" if holds else f": {dict(found)}, not {figures['gates']}"


class Checks:
    """The comparisons, and the number that failed."""

    def __init__(self):
        self.failed = 0

    def say(self, holds, text):
        self.failed += not holds
        print(f"{'ok  ' if holds else 'FAIL'} {text}", flush=True)


def compare(qrt, checks):
    scene = ROOT / "examples" / "lit-wall.yaml"
    for language, importers in LANGUAGES.items():
        for part in ("oracle", "grover", "counting"):
            text, figures = qrt.export(scene, language, part, SMALL)
            for name, importer in importers.items():
                if name in SHORT and part != "oracle":
                    continue
                holds, said = read(importer, text, figures)
                gates = sum(figures["gates"].values())
                checks.say(holds, f"{language} {part}, {gates:,} gates: {name}{said}")

    text, figures = qrt.export(scene, "openqasm3", "oracle", SMALL, ["--channel", "g"])
    x, y = figures["pixel"]
    qrt.run(
        *("render", scene, "--model", "fixed", "--estimator", "exact", "-q"),
        *("--crop", f"{x},{y},1,1", "-o", "pixel.exr", "--counts", "pixel.csv"),
        sets=SMALL,
    )
    with open(qrt.folder / "pixel.csv", newline="") as file:
        row = next(row for row in csv.DictReader(file) if row["channel"] == "g")
    good, total = int(row["good"]), int(row["total"])
    turned = signs(text)
    checks.say(
        turned == good,
        f"signs turned by the oracle, run by Qiskit's gates: {turned} of {total}; {good} are good",
    )

    pixel = ["--pixel", f"{x},{y}"]
    answer = qrt.run("inspect", scene, "--json", "--channel", "g", *pixel, sets=SMALL)
    inspected = json.loads(answer)["gates"]["toffoli"]
    toffoli = qsharp(text)[TOFFOLIS]
    checks.say(
        toffoli == inspected,
        f"Toffolis by Q#'s estimator: {toffoli:,}; by qrt inspect: {inspected:,}",
    )

    for window in ("sine", "rect"):
        sets = [*SMALL, f"counting.window={window}"]
        text, figures = qrt.export(scene, "openqasm3", "counting", sets, ["--channel", "g"])
        start = time.time()
        found = shots(text)
        seconds = time.time() - start
        count = ("count", "--good", good, "--total", total, "--phase-bits", 3)
        answer = json.loads(qrt.run(*count, "--window", window, "--json"))
        expected = [row["probability"] for row in answer["outcomes"]]
        square, freedom = chi_square(found, expected)
        checks.say(
            square < MOST_CHI_SQUARE,
            f"{window} window, {SHOTS} shots of {figures['qubits']:,} qubits on Q#'s sparse "
            f"simulator in {seconds:.0f} s: chi-square {square:.1f} with {freedom} degrees of freedom",
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--venv", required=True, help="folder of the virtual environment")
    parser.add_argument("--qrt", default=ROOT / "target" / "release" / "qrt", help="the command")
    arguments = parser.parse_args()
    inside(arguments.venv, "openqasm.txt")
    warnings.simplefilter("ignore")
    checks = Checks()
    with tempfile.TemporaryDirectory() as folder:
        qrt = Qrt(arguments.qrt, folder)
        compare(qrt, checks)
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
