#!/usr/bin/env python3
"""Writes what cirq makes of small circuits: tests hold qrt's machines against it.

    pip install -r requirements.txt
    amplitudes.py > ../../qrt-machines/src/statevector/tests/cirq.txt

Two circuits of random gates, gate by gate, and their amplitudes (bit q of an index is qubit q). Then
counting, built from other parts than qrt's: the Grover iterate as a matrix, its controlled powers as
powers of that matrix, cirq's own inverse Fourier transform; and the probabilities of the counter's
values.
"""

import math
import random

import cirq
import numpy


def random_gate(draw, qubits):
    kind = draw.choice(["x", "cx", "ccx", "h", "h", "h", "ry", "p", "p", "p"])
    q = draw.sample(range(qubits), qubits)
    match kind:
        case "x" | "h":
            return [kind, q[0]]
        case "cx":
            return [kind, q[0], q[1]]
        case "ccx":
            return [kind, q[0], q[1], q[2]]
        case "ry":
            return [kind, draw.uniform(-7, 7), q[0]]
        case "p":
            bits = draw.randrange(1, 6)
            return [kind, draw.randrange(1, 1 << bits), bits, *q[: draw.randrange(1, 5)]]


def operation(gate, line):
    match gate:
        case ["x", t]:
            return cirq.X(line[t])
        case ["h", t]:
            return cirq.H(line[t])
        case ["cx", a, t]:
            return cirq.CNOT(line[a], line[t])
        case ["ccx", a, b, t]:
            return cirq.TOFFOLI(line[a], line[b], line[t])
        case ["ry", angle, t]:
            return cirq.ry(angle)(line[t])
        case ["p", numerator, bits, *controls, t]:
            phase = cirq.ZPowGate(exponent=2 * numerator / 2**bits)(line[t])
            return phase.controlled_by(*(line[c] for c in controls)) if controls else phase


def circuit(seed, qubits, gates):
    draw = random.Random(seed)
    line = cirq.LineQubit.range(qubits)
    print(f"circuit {qubits}")
    simulated = cirq.Circuit(cirq.I(q) for q in line)
    for _ in range(gates):
        gate = random_gate(draw, qubits)
        print(*gate)
        simulated.append(operation(gate, line))
    simulator = cirq.Simulator(dtype=numpy.complex128)
    # cirq's first qubit is the highest bit of an index.
    final = simulator.simulate(simulated, qubit_order=line[::-1]).final_state_vector
    for amplitude in final:
        print("amplitude", repr(float(amplitude.real)), repr(float(amplitude.imag)))


def counting(good, phase_bits):
    total = len(good)
    bits = total.bit_length() - 1
    oracle = numpy.diag([-1.0 if g else 1.0 for g in good])
    diffusion = 2.0 / total * numpy.ones((total, total)) - numpy.eye(total)
    iterate = diffusion @ oracle
    ids = cirq.LineQubit.range(bits)
    counter = cirq.LineQubit.range(bits, bits + phase_bits)
    simulated = cirq.Circuit(cirq.H(q) for q in ids + counter)
    for j, control in enumerate(counter):
        power = numpy.linalg.matrix_power(iterate, 2**j)
        # The first qubit of a matrix is its index's highest bit.
        simulated.append(cirq.MatrixGate(power)(*ids[::-1]).controlled_by(control))
    simulated.append(cirq.qft(*counter[::-1], inverse=True))
    simulator = cirq.Simulator(dtype=numpy.complex128)
    order = counter[::-1] + ids[::-1]
    final = simulator.simulate(simulated, qubit_order=order).final_state_vector
    outcomes = (numpy.abs(final) ** 2).reshape(2**phase_bits, total).sum(axis=1)
    print("counting", phase_bits, "".join("1" if g else "0" for g in good))
    for probability in outcomes:
        print("probability", repr(float(probability)))


circuit(1, 5, 60)
circuit(2, 6, 90)
counting([i in (1, 4, 6) for i in range(8)], 4)
counting([math.isqrt(i) ** 2 == i for i in range(16)], 3)
