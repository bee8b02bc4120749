#!/usr/bin/env python3
"""Runs a counting circuit, gate by gate, on other people's state-vector simulators.

    counting.py --venv FOLDER --tool lightning|qsim < circuit.json

The circuit is what `cargo bench --bench machines -- statevector` writes: `qubits`, the `counter` register (bit 0
first), and the gates of its preparation, of one query under each counting qubit, and of the inverse
Fourier transform. A query under counting qubit j is repeated 2^j times. Gates are lists:

    ["x", t]  ["cx", a, t]  ["ccx", a, b, t]  ["h", t]  ["ry", angle, t]  ["p", turns, [qubits]]

Prints one line of JSON: the seconds of simulation alone (building the list of gates is not counted),
and the probabilities of the counter's values. The tools are installed from PyPI, at the versions in
requirements.txt, into a virtual environment of their own, once.
"""

import argparse
import json
import math
import os
import sys
import time

from environment import inside


def expanded(circuit):
    """All gates in the order in which they run."""
    yield from circuit["prepare"]
    for bit, query in enumerate(circuit["queries"]):
        for _ in range(1 << bit):
            yield from query
    yield from circuit["fourier"]


def lightning(circuit):
    """PennyLane's lightning.qubit, in double precision."""
    import numpy
    import pennylane
    from pennylane_lightning.lightning_qubit._state_vector import LightningStateVector

    def operation(gate):
        match gate:
            case ["x", t]:
                return pennylane.PauliX(t)
            case ["cx", a, t]:
                return pennylane.CNOT([a, t])
            case ["ccx", a, b, t]:
                return pennylane.Toffoli([a, b, t])
            case ["h", t]:
                return pennylane.Hadamard(t)
            case ["ry", angle, t]:
                return pennylane.RY(angle, t)
            case ["p", turns, [q]]:
                if turns == 0.5:
                    return pennylane.PauliZ(q)
                return pennylane.PhaseShift(2 * math.pi * turns, q)
            case ["p", turns, [a, b]]:
                if turns == 0.5:
                    return pennylane.CZ([a, b])
                return pennylane.ControlledPhaseShift(2 * math.pi * turns, [a, b])
            case ["p", turns, [*controls, q]]:
                if turns == 0.5:
                    return pennylane.ctrl(pennylane.PauliZ(q), controls)
                return pennylane.ctrl(pennylane.PhaseShift(2 * math.pi * turns, q), controls)
        raise ValueError(gate)

    known = {}

    def made(gate):
        key = json.dumps(gate)
        if key not in known:
            known[key] = operation(gate)
        return known[key]

    operations = [made(gate) for gate in expanded(circuit)]
    qubits = circuit["qubits"]
    state = LightningStateVector(qubits)
    start = time.perf_counter()
    state.apply_operations(operations)
    seconds = time.perf_counter() - start
    # Wire 0 of lightning.qubit is the highest bit of an index.
    amplitudes = numpy.asarray(state.state).reshape([2] * qubits)
    return seconds, numpy.abs(amplitudes) ** 2, list(range(qubits))


def qsim(circuit):
    """Google's qsim, in single precision, with its own fusion of gates."""
    import cirq
    import numpy
    import qsimcirq

    line = cirq.LineQubit.range(circuit["qubits"])

    def operation(gate):
        match gate:
            case ["x", t]:
                return cirq.X(line[t])
            case ["cx", a, t]:
                return cirq.CNOT(line[a], line[t])
            case ["ccx", a, b, t]:
                return cirq.TOFFOLI(line[a], line[b], line[t])
            case ["h", t]:
                return cirq.H(line[t])
            case ["ry", angle, t]:
                return cirq.ry(angle)(line[t])
            case ["p", turns, [q]]:
                return (cirq.Z if turns == 0.5 else cirq.ZPowGate(exponent=2 * turns))(line[q])
            case ["p", turns, [a, b]]:
                gate = cirq.CZ if turns == 0.5 else cirq.CZPowGate(exponent=2 * turns)
                return gate(line[a], line[b])
            case ["p", turns, [*controls, q]]:
                gate = cirq.Z if turns == 0.5 else cirq.ZPowGate(exponent=2 * turns)
                return gate(line[q]).controlled_by(*(line[c] for c in controls))
        raise ValueError(gate)

    known = {}

    def made(gate):
        key = json.dumps(gate)
        if key not in known:
            known[key] = operation(gate)
        return known[key]

    whole = cirq.Circuit(strategy=cirq.InsertStrategy.EARLIEST)
    whole.append(made(gate) for gate in expanded(circuit))
    options = qsimcirq.QSimOptions(cpu_threads=os.cpu_count(), max_fused_gate_size=4)
    simulator = qsimcirq.QSimSimulator(options, circuit_memoization_size=1)
    seconds = math.inf
    # The first run converts cirq's objects, which is not the simulator's work; the second finds them converted.
    for _ in range(2):
        start = time.perf_counter()
        found = simulator.simulate(whole, qubit_order=line)
        seconds = min(seconds, time.perf_counter() - start)
    amplitudes = numpy.asarray(found.final_state_vector).reshape([2] * circuit["qubits"])
    return seconds, numpy.abs(amplitudes.astype(complex)) ** 2, list(range(circuit["qubits"]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--venv", required=True)
    parser.add_argument("--tool", choices=["lightning", "qsim"], required=True)
    arguments = parser.parse_args()
    inside(arguments.venv, "requirements.txt")
    circuit = json.load(sys.stdin)
    seconds, probabilities, axes = {"lightning": lightning, "qsim": qsim}[arguments.tool](circuit)
    import numpy

    counter = circuit["counter"]
    others = tuple(axis for axis in axes if axis not in counter)
    # The axes ascend with the counter's qubits. They are reversed, so that the last bit varies slowest in print.
    marginal = numpy.sum(probabilities, axis=others)
    order = sorted(counter)
    marginal = numpy.transpose(marginal, [order.index(q) for q in reversed(counter)])
    print(json.dumps({"seconds": seconds, "outcomes": marginal.reshape(-1).tolist()}))


if __name__ == "__main__":
    main()
