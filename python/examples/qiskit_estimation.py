"""Qiskit's iterative amplitude estimation runs a pixel's whole circuit: qiskit_estimation.py [COMMAND]."""

import json
import subprocess
import sys

from qiskit.primitives import StatevectorSampler
from qiskit_algorithms import IterativeAmplitudeEstimation

import qrt

scene = qrt.parse("""
name: edge
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 1, height: 1 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [-0.5, -1, 0], [-0.5, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
precision: { fraction: 5 }
comparator: { bits: 1 }
circuit: { uncompute: scoped }
""")
oracle = scene.oracle("r", (0, 0))
# A quarter of the pixel is lit, and each path counts as in real numbers. With 4 fraction bits, S/N would be 0.375.
assert oracle.amplitude == 0.25 and oracle.counts.differing == 0
print(f"{oracle.qubits} qubits, {oracle.toffoli} Toffolis a query; S/N is {oracle.amplitude}")

sampler = StatevectorSampler(default_shots=100, seed=5)
estimator = IterativeAmplitudeEstimation(0.03, 0.05, sampler=sampler)
found = estimator.estimate(oracle.estimation_problem())
low, high = found.confidence_interval
print(f"Qiskit: {low:.3f} to {high:.3f}, by up to {max(found.powers)} iterates")

numbers = ["--good", oracle.good, "--total", oracle.total, "--phase-bits", 7, "--shots", 20]
command = [sys.argv[1] if sys.argv[1:] else "qrt", "count", *map(str, numbers), "--json"]
told = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
lower, higher = told["estimate"]["interval"]
print(f"qrt count: {lower:.3f} to {higher:.3f}")

for left, right in ((low, high), (lower, higher)):
    assert left <= oracle.amplitude <= right and right - left < 0.06
print("both intervals hold S/N")
