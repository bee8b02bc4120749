"""Oracles for other quantum libraries."""

from __future__ import annotations

import importlib
from typing import Any


def _library(module: str, extra: str) -> Any:
    """Imports a module of a library that qrt does without; says how it is installed if it is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        message = f"{error}; qrt's extra has all that this needs: pip install './python[{extra}]'"
        raise ImportError(message, name=error.name) from error


def to_qiskit(self: Any, part: str = "oracle") -> Any:
    """The circuit as a qiskit.QuantumCircuit; `part` is "oracle", "grover" or "counting".

    The qubits of an index are the registers `path` and `comparator`, bit 0 first; all others begin and
    end at zero. The index is to be prepared by whoever runs an oracle or an iterate: with Hadamards, for
    all paths in superposition.
    """
    qasm2 = _library("qiskit.qasm2", "qiskit")
    instructions = qasm2.LEGACY_CUSTOM_INSTRUCTIONS
    circuit = qasm2.loads(self.qasm(2, part), custom_instructions=instructions)
    circuit.name = f"{self.scene.name}_{part}"
    return circuit


def estimation_problem(self: Any) -> Any:
    """The pixel as a qiskit_algorithms.EstimationProblem, for all of its amplitude estimators.

    The state preparation puts a Hadamard on each qubit of the index, the Grover operator is qrt's
    iterate, and what is measured is the index: it is good if its path's colour exceeds its threshold,
    which is looked up in the path's own colour. `post_processing` makes a radiance of the amplitude.
    """
    QuantumCircuit = _library("qiskit", "qiskit").QuantumCircuit
    EstimationProblem = _library("qiskit_algorithms", "qiskit").EstimationProblem
    grover = to_qiskit(self, "grover")
    index = [
        grover.find_bit(qubit).index
        for name in ("path", "comparator")
        for register in grover.qregs
        if register.name == name
        for qubit in register
    ]
    prepare = QuantumCircuit(grover.num_qubits)
    prepare.h(index)
    thresholds = self.thresholds
    mask = len(thresholds) - 1

    def is_good_state(bits: str) -> bool:
        number = int(bits, 2)
        return bool(number >> self.path_bits < thresholds[number & mask])

    return EstimationProblem(
        prepare,
        objective_qubits=index,
        grover_operator=grover,
        post_processing=lambda amplitude: amplitude * self.scale,
        is_good_state=is_good_state,
    )


def to_pennylane(self: Any, part: str = "oracle") -> Any:
    """The circuit as a quantum function of PennyLane, through OpenQASM 3: call it in a QNode. Its wires
    are called `path[0]` and so on, and nothing is measured. PennyLane needs `openqasm3[parser]` for it.
    """
    pennylane = _library("pennylane", "pennylane")
    # Its parser of OpenQASM 3 is a library of its own.
    _library("openqasm3", "pennylane")
    # PennyLane supports neither `measure` nor `include`.
    lines = self.qasm(3, part).splitlines()
    lines = [line for line in lines if "measure" not in line and "include" not in line]
    return pennylane.from_qasm3("\n".join(lines), {})


def to_cirq(self: Any, part: str = "oracle") -> Any:
    """The circuit as a cirq.Circuit, through OpenQASM 2; its qubits are called `path_0` and so on."""
    imported = _library("cirq.contrib.qasm_import", "cirq")
    return imported.circuit_from_qasm(self.qasm(2, part))


def extend(oracle: Any) -> None:
    """Gives the native class these as methods."""
    for method in (to_qiskit, estimation_problem, to_pennylane, to_cirq):
        setattr(oracle, method.__name__, method)
