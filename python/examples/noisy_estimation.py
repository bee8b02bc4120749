"""Amplitude estimation without phase estimation, on Qiskit Aer with and without noise: noisy_estimation.py [SHOTS].

Maximum-likelihood amplitude estimation (Suzuki et al. 2020) runs the Grover iterate k = 0, 1 and 2 times and
measures the index. The likeliest amplitude is found from how often the index was good. The noise depolarises the
qubits of every gate with probability 1e-3.
"""

import sys

import numpy
from qiskit import QuantumCircuit, transpile
from qiskit_aer import AerSimulator
from qiskit_aer.noise import NoiseModel, depolarizing_error

import qrt

SCENE = """
name: edge
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 2, height: 2 }
materials: { lamp: { emitter: { radiance: [1, 1, 1] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [0.25, -1, 0], [0.25, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 4, depths: [{ bits: [2, 2] }] }
precision: { fraction: 5 }
comparator: { bits: 1 }
"""
ITERATES = (0, 1, 2)
PROBABILITY = 1e-3
GATES = {1: ["x", "h", "z"], 2: ["cx", "cz"], 3: ["ccx"]}


def noise():
    model = NoiseModel()
    for qubits, names in GATES.items():
        model.add_all_qubit_quantum_error(depolarizing_error(PROBABILITY, qubits), names)
    return model


def hits(oracle, iterates, shots, simulator):
    """How many of `shots` measurements of the index are good after so many iterates."""
    grover = oracle.to_qiskit("grover")
    index = [
        grover.find_bit(qubit).index
        for name in ("path", "comparator")
        for register in grover.qregs
        if register.name == name
        for qubit in register
    ]
    circuit = QuantumCircuit(grover.num_qubits, len(index))
    circuit.h(index)
    for _ in range(iterates):
        circuit.compose(grover, inplace=True)
    circuit.measure(index, range(len(index)))
    circuit = transpile(circuit, basis_gates=sum(GATES.values(), []), optimization_level=0)
    counts = simulator.run(circuit, shots=shots, seed_simulator=7).result().get_counts()
    good = 0
    for bits, times in counts.items():
        number = int(bits, 2)
        path = number & (len(oracle.thresholds) - 1)
        good += times * bool(number >> oracle.path_bits < oracle.thresholds[path])
    return good


def likeliest(found, shots):
    """The amplitude that maximises the likelihood of the hits, and its standard error by Fisher's information."""
    theta = numpy.linspace(1e-6, numpy.pi / 2 - 1e-6, 200_001)
    likelihood = numpy.zeros_like(theta)
    for k, good in zip(ITERATES, found):
        probability = numpy.sin((2 * k + 1) * theta) ** 2
        probability = numpy.clip(probability, 1e-12, 1 - 1e-12)
        likelihood += good * numpy.log(probability) + (shots - good) * numpy.log(1 - probability)
    amplitude = numpy.sin(theta[likelihood.argmax()]) ** 2
    information = shots * sum((2 * k + 1) ** 2 for k in ITERATES) / (amplitude * (1 - amplitude))
    return amplitude, information**-0.5


def main(shots=200):
    oracle = qrt.parse(SCENE).oracle(pixel=(1, 0))
    grover = oracle.to_qiskit("grover")
    gates = grover.count_ops()
    print(f"S/N is {oracle.amplitude}; an iterate has {sum(gates.values())} gates, {gates['ccx']} of them Toffolis")
    queries = shots * sum(2 * k + 1 for k in ITERATES)
    for name, model in (("without noise", None), ("with noise", noise())):
        simulator = AerSimulator(method="statevector", noise_model=model)
        found = [hits(oracle, k, shots, simulator) for k in ITERATES]
        amplitude, error = likeliest(found, shots)
        shown = ", ".join(f"{good}/{shots}" for good in found)
        off = abs(amplitude - oracle.amplitude) / error
        print(f"{name:>13}: good after 0, 1, 2 iterates {shown}; S/N = {amplitude:.4f} +- {error:.4f}, off by {off:.1f} of these")
    classical = (oracle.amplitude * (1 - oracle.amplitude) / queries) ** 0.5
    print(f"sampling with the same queries: +- {classical:.4f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
