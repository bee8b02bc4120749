#!/usr/bin/env python3
"""Has other people's importers read what `qrt export` writes, and other people's simulators run it.

    cargo build --release
    benches/peers/openqasm.py --venv FOLDER [--qrt target/release/qrt]

Of a small scene (examples/lit-wall.yaml):

* every importer reads the oracle, the iterate and the counting circuit in each language that it
  knows, and finds as many gates of each kind as qrt says it wrote;
* the oracle, as Qiskit has read it, runs on every id: its sign is turned for as many as
  `qrt render --counts` calls good, and every other qubit is zero again;
* Q#'s sparse simulator runs the whole counting circuit, shot by shot: its outcomes are compared with
  the distribution of `qrt count` by their chi-square;
* Q#'s resource estimator counts the oracle's Toffolis, and `qrt inspect` says the same.

Then the Cornell box's oracle, and how long each importer takes to read it. Exits with 1 if anything
disagrees. The tools are installed from PyPI, at the versions in openqasm.txt, into a virtual
environment of their own, once.
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
SMALL = ["sampling.path_bits=3", "comparator.bits=2", "counting.phase_bits=3"]
SHOTS = 2000
# The chi-square of as many shots exceeds this with probability 10^-6 at 7 degrees of freedom.
MOST_CHI_SQUARE = 40.5


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

    def export(self, scene, language, part, sets=()):
        """The text, and its figures."""
        file = self.folder / "circuit.qasm"
        answer = self.run(
            "export", scene, "--json", "-o", file, "--format", language, "--part", part, sets=sets
        )
        return file.read_text(), json.loads(answer)


# Importers: each gives the number of gates by their names in OpenQASM.


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

    # It takes neither of these.
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
    return collections.Counter({"ccx": counts["cczCount"] + counts["ccixCount"]})


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
# What takes minutes for a million gates, by its speed as measured here.
SLOW = {"PennyLane", "Qiskit", "Cirq", "pytket"}
# What takes a minute for 30,000.
SHORT = {"pytket"}


def agrees(found, said):
    """As many gates of each kind; importers that rename phases have as many in all."""
    said = collections.Counter(said)
    if set(found) == {"ccx"}:
        return found["ccx"] == said["ccx"]
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
    for outcome in openqasm.run(text, shots=SHOTS, seed=1):
        bits = [1 if str(bit).endswith("One") else 0 for bit in outcome]
        # Bit 0 of `outcome` is the last in Q#'s order of bit registers.
        found[int("".join(map(str, bits)), 2)] += 1
    return found


def chi_square(found, expected):
    """Of folded outcomes, y and T - y together, against their probabilities."""
    size = 2 * (len(expected) - 1)
    folded = collections.Counter()
    for y, n in found.items():
        folded[min(y, size - y)] += n
    total = 0.0
    for y, probability in enumerate(expected):
        if probability * SHOTS < 1e-9:
            total += math.inf if folded[y] else 0
        else:
            total += (folded[y] - SHOTS * probability) ** 2 / (SHOTS * probability)
    return total


class Checks:
    """What was compared."""

    def __init__(self):
        self.failed = 0

    def say(self, holds, text):
        self.failed += not holds
        print(f"{'ok  ' if holds else 'FAIL'} {text}", flush=True)


def small(qrt, checks):
    scene = ROOT / "examples" / "lit-wall.yaml"
    for language, importers in LANGUAGES.items():
        for part in ("oracle", "grover", "counting"):
            text, figures = qrt.export(scene, language, part, SMALL)
            for name, importer in importers.items():
                if name in SHORT and part != "oracle":
                    continue
                try:
                    found = importer(text)
                    holds = agrees(found, figures["gates"])
                    said = "" if holds else f": {dict(found)}, not {figures['gates']}"
                except Exception as error:  # an importer that refuses is an answer, too
                    holds, said = False, f": {type(error).__name__}: {error}"[:300]
                gates = sum(figures["gates"].values())
                checks.say(holds, f"{language} {part}, {gates:,} gates: {name}{said}")

    text, figures = qrt.export(scene, "openqasm3", "oracle", SMALL)
    x, y = figures["pixel"]
    qrt.run(
        *("render", scene, "--model", "fixed", "--estimator", "exact", "-q"),
        *("--crop", f"{x},{y},1,1", "-o", "pixel.exr", "--counts", "pixel.csv"),
        sets=SMALL,
    )
    with open(qrt.folder / "pixel.csv", newline="") as file:
        row = next(row for row in csv.DictReader(file) if row["channel"] == figures["channel"])
    good, total = int(row["good"]), int(row["total"])
    turned = signs(text)
    checks.say(turned == good, f"signs turned by the oracle, run by Qiskit's gates: {turned} of {total}, {good} good")

    inspected = json.loads(qrt.run("inspect", scene, "--json", sets=SMALL))
    toffoli = qsharp(text)["ccx"]
    checks.say(
        toffoli == inspected["gates"]["toffoli"],
        f"Toffolis by Q#'s estimator: {toffoli:,}, by qrt inspect {inspected['gates']['toffoli']:,}",
    )

    for window in ("sine", "rect"):
        sets = [*SMALL, f"counting.window={window}"]
        text, figures = qrt.export(scene, "openqasm3", "counting", sets)
        start = time.time()
        found = shots(text)
        seconds = time.time() - start
        answer = json.loads(
            qrt.run(
                *("count", "--good", good, "--total", total, "--phase-bits", 3),
                *("--window", window, "--json"),
            )
        )
        expected = [row["probability"] for row in answer["outcomes"]]
        square = chi_square(found, expected)
        checks.say(
            square < MOST_CHI_SQUARE,
            f"{window} window, {SHOTS} shots of {figures['qubits']} qubits on Q#'s sparse simulator "
            f"in {seconds:.0f} s: chi-square {square:.1f}, expected about {len(expected) - 1}",
        )


def large(qrt, checks, slow):
    scene = ROOT / "scenes-yaml" / "cornell-box.yaml"
    start = time.time()
    text, figures = qrt.export(scene, "openqasm3", "oracle")
    gates = sum(figures["gates"].values())
    print(
        f"\nthe Cornell box's oracle: {figures['qubits']:,} qubits, {gates:,} gates, "
        f"{figures['bytes'] / 1e6:.1f} MB, written in {time.time() - start:.2f} s"
    )
    other, _ = qrt.export(scene, "openqasm2", "oracle")
    for language, importers, text in (("openqasm3", THREE, text), ("openqasm2", TWO, other)):
        for name, importer in importers.items():
            if not slow and language == "openqasm3" and name in SLOW:
                print(f"     {language}: {name} left out; --slow waits for it")
                continue
            start = time.time()
            try:
                found = importer(text)
                holds, said = agrees(found, figures["gates"]), ""
            except Exception as error:
                holds, said = False, f": {type(error).__name__}: {error}"[:300]
            checks.say(holds, f"{language}: {name} in {time.time() - start:.1f} s{said}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--venv", required=True, help="folder of the virtual environment")
    parser.add_argument("--qrt", default=ROOT / "target" / "release" / "qrt", help="the command")
    parser.add_argument("--small", action="store_true", help="only the small scene")
    parser.add_argument("--slow", action="store_true", help="wait for the slowest importers, too")
    arguments = parser.parse_args()
    inside(arguments.venv, "openqasm.txt")
    warnings.simplefilter("ignore")
    checks = Checks()
    with tempfile.TemporaryDirectory() as folder:
        qrt = Qrt(arguments.qrt, folder)
        small(qrt, checks)
        if not arguments.small:
            large(qrt, checks, arguments.slow)
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
