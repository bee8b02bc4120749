"""A pixel's complete counting circuit on somebody else's simulator: simulators.py SIMULATOR [SCENE X Y].

SIMULATOR is one of: aer, aer-single, cirq, pennylane, qdk. The probabilities of the phase register are compared
with those that theory predicts. A simulator that returns amplitudes must agree; qdk draws shots.
"""

import sys

import numpy

import qrt

# Qubits of the largest state vector: 2^26 complex numbers of 16 bytes are 1 GB.
DENSE = 26


def phase_qubits(circuit):
    """Places of the phase register's qubits in a circuit of Qiskit, bit 0 first."""
    return [circuit.find_bit(qubit).index for register in circuit.qregs if register.name == "phase_register" for qubit in register]


def aer(oracle, precision="double"):
    """Qiskit Aer's state vector: exact probabilities, whose sum is 1."""
    from qiskit import transpile
    from qiskit_aer import AerSimulator

    circuit = oracle.to_qiskit("counting")
    circuit.remove_final_measurements()
    circuit.save_probabilities(phase_qubits(circuit), label="phase")
    simulator = AerSimulator(method="statevector", precision=precision)
    result = simulator.run(transpile(circuit, simulator, optimization_level=0)).result()
    probabilities = result.data()["phase"]
    # In single precision, rounding makes the state vector shorter: by 1.2e-6 with the gates of `slanted`.
    return probabilities / probabilities.sum()


def cirq(oracle):
    """Cirq's state vector, in double precision: exact probabilities."""
    import cirq

    circuit = oracle.to_cirq("counting")
    circuit = cirq.drop_terminal_measurements(circuit)
    qubits = sorted(circuit.all_qubits())
    register = [qubit for qubit in qubits if str(qubit).startswith("phase_register_")]
    register.sort(key=lambda qubit: int(str(qubit).removeprefix("phase_register_")))
    state = cirq.Simulator(dtype=numpy.complex128).simulate(circuit, qubit_order=qubits)
    # Cirq's first qubit is the highest bit of an index.
    places = [qubits.index(qubit) for qubit in reversed(register)]
    amplitudes = state.final_state_vector.reshape((2,) * len(qubits))
    others = tuple(place for place in range(len(qubits)) if place not in places)
    probabilities = (abs(amplitudes) ** 2).sum(axis=others)
    order = numpy.argsort(numpy.argsort(places))
    return probabilities.transpose(order).reshape(-1)


def pennylane(oracle):
    """PennyLane's lightning.qubit, in double precision: exact probabilities."""
    import pennylane

    function = oracle.to_pennylane("counting")
    with pennylane.queuing.AnnotatedQueue() as queue:
        function()
    tape = pennylane.tape.QuantumScript.from_queue(queue)
    bits = sorted((wire for wire in tape.wires if str(wire).startswith("phase_register[")), key=lambda wire: int(str(wire)[15:-1]))
    device = pennylane.device("lightning.qubit", wires=tape.wires)
    measured = pennylane.probs(wires=bits[::-1])
    script = pennylane.tape.QuantumScript(tape.operations, [measured])
    return numpy.asarray(pennylane.execute([script], device)[0])


def qdk(oracle, shots=2000):
    """The sparse simulator of the Quantum Development Kit: the frequencies of shots."""
    from qdk import openqasm

    outcomes = openqasm.run(oracle.qasm(3, "counting"), shots=shots, seed=5)
    return frequencies(outcomes, oracle.phase_bits)


def frequencies(outcomes, phase_bits):
    found = numpy.zeros(1 << phase_bits)
    for outcome in outcomes:
        # Results are those of the bits of the phase register, bit 0 first.
        bits = [str(bit) in ("One", "1") for bit in outcome]
        found[sum(bit << place for place, bit in enumerate(bits))] += 1 / len(outcomes)
    return found


def folded(probabilities):
    """The probabilities of outcomes 0 to T/2: y and T - y are one outcome."""
    size = len(probabilities)
    return [
        probabilities[y] + (probabilities[size - y] if 0 < y < size // 2 else 0)
        for y in range(size // 2 + 1)
    ]


SIMULATORS = {
    # Each with the largest difference of a probability from theory that is no fault.
    "aer": (aer, 1e-9),
    "aer-single": (lambda oracle: aer(oracle, "single"), 1e-6),
    "cirq": (cirq, 1e-9),
    "pennylane": (pennylane, 1e-9),
    "qdk": (qdk, 5 * 0.5 / 2000**0.5),
}


def main(name="aer", path="scenes-yaml/small/edge.yaml", x="1", y="0"):
    scene = qrt.load(path)
    oracle = scene.oracle(pixel=(int(x), int(y)))
    run, most = SIMULATORS[name]
    theory = scene.count(pixel=(int(x), int(y)))
    found = folded(run(oracle))
    print(f"{scene.name} on {name}: {scene.inspect(pixel=(int(x), int(y))).complete_qubits[str(oracle.phase_bits)]} qubits")
    print("  y  simulator   theory")
    for outcome, probability in zip(theory.outcomes, found):
        print(f"{outcome.y:>3}  {probability:.8f}  {outcome.probability:.8f}")
    difference = max(abs(one.probability - other) for one, other in zip(theory.outcomes, found))
    print(f"largest difference: {difference:.1e}")
    assert difference < most, f"more than {most:.1e}"


if __name__ == "__main__":
    main(*sys.argv[1:])
