"""Counting circuits as a benchmark of MQT Bench, on a gate set and on a device: mqt_bench.py [QUBITS].

The benchmark `qrt` has a size for each scene of scenes-yaml/small, the number of qubits of its complete counting
circuit: 16, 20 or 23. Benchpress reads the OpenQASM 2 files of `qrt export --part counting`.
"""

import pathlib
import sys

from mqt.bench import BenchmarkLevel, get_benchmark
from mqt.bench.benchmarks import register_benchmark
from mqt.bench.targets import get_device, get_target_for_gateset

import qrt

SMALL = pathlib.Path(__file__).resolve().parents[2] / "scenes-yaml/small"
SCENES = {16: "lit-wall", 20: "mirror", 23: "slanted"}


@register_benchmark("qrt", description="Quantum counting of the light paths of a pixel")
def create_circuit(num_qubits):
    """The complete counting circuit of a pixel, with its measurement."""
    if num_qubits not in SCENES:
        raise ValueError(f"{num_qubits} qubits: there are scenes of {', '.join(map(str, SCENES))}")
    scene = qrt.load(SMALL / f"{SCENES[num_qubits]}.yaml")
    return scene.oracle(pixel=(1, 0)).to_qiskit("counting")


def main(qubits=20):
    targets = {
        BenchmarkLevel.INDEP: None,
        BenchmarkLevel.NATIVEGATES: get_target_for_gateset("ibm_falcon", qubits),
        BenchmarkLevel.MAPPED: get_device("ibm_falcon_27"),
    }
    for level, target in targets.items():
        circuit = get_benchmark("qrt", level, circuit_size=qubits, target=target)
        print(f"{level.name:<12} {circuit.num_qubits:>3} qubits  {circuit.size():>6} gates, {circuit.num_nonlocal_gates():>6} of more than one qubit, depth {circuit.depth():>6}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
