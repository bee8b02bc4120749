"""Qiskit's iterative amplitude estimation runs a pixel's whole circuit."""

from qiskit.primitives import StatevectorSampler
from qiskit_algorithms import IterativeAmplitudeEstimation

import qrt

scene = qrt.parse("""
name: edge
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 2, height: 2 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [0.25, -1, 0], [0.25, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 2, depths: [{ bits: [2, 2] }] }
precision: { fraction: 4 }
comparator: { bits: 1 }
circuit: { uncompute: scoped }
""")
oracle = scene.oracle("r", (1, 0))
sampler = StatevectorSampler(default_shots=100, seed=5)
estimator = IterativeAmplitudeEstimation(0.1, 0.05, sampler=sampler)
found = estimator.estimate(oracle.estimation_problem())

print(f"{oracle.qubits} qubits, {oracle.toffoli} Toffolis a query")
print(f"estimated {found.estimation:.3f}, S/N is {oracle.amplitude:.3f}")
