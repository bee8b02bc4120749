#!/usr/bin/env python3
"""Holds qrt's iterative and maximum likelihood estimation against Qiskit's.

    cargo bench --bench estimators -- errors --csv estimators.csv
    benches/peers/amplitude_estimation.py --venv FOLDER --csv estimators.csv

Qiskit's estimators run on amplitudes spread evenly over [0, 1], each a rotation of one qubit, which is
all that they see of a problem. Queries are Grover iterations, and one for a shot without any, as qrt
counts them. Prints queries, the error that 95 % of the runs keep, and their product, beside qrt's
at the nearest number of queries; exits with 1 where qrt's product is larger by more than a fifth.
Qiskit is installed from PyPI, at the versions in amplitude_estimation.txt, into a virtual
environment of its own, once.
"""

import argparse
import csv
import math
import sys

from environment import inside

CONFIDENCE = 0.95


def problem(amplitude):
    """An estimation problem whose amplitude is that of one rotation."""
    from qiskit import QuantumCircuit
    from qiskit_algorithms import EstimationProblem

    angle = 2 * math.asin(math.sqrt(amplitude))

    class Iterate(QuantumCircuit):
        """Iterates of the Grover operator are rotations, too."""

        def __init__(self, times=1):
            super().__init__(1)
            self.times = times
            self.ry(2 * angle * times, 0)

        def power(self, power, matrix_power=False, annotated=False):
            return Iterate(self.times * power)

    prepare = QuantumCircuit(1)
    prepare.ry(angle, 0)
    return EstimationProblem(prepare, objective_qubits=[0], grover_operator=Iterate())


def sampler(shots, seed):
    """Draws on from one circuit to the next: with a number as its seed it would repeat itself."""
    import numpy
    from qiskit.primitives import StatevectorSampler

    return StatevectorSampler(default_shots=shots, seed=numpy.random.default_rng(seed))


def iterative(error, shots, seed):
    from qiskit_algorithms import IterativeAmplitudeEstimation

    method = IterativeAmplitudeEstimation(
        error, 1 - CONFIDENCE, confint_method="beta", sampler=sampler(shots, seed)
    )

    def run(amplitude):
        found = method.estimate(problem(amplitude))
        # Qiskit counts iterations only, so its shots without an iteration are added here.
        bare = shots * sum(1 for k in found.powers[1:] if k == 0)
        return found.estimation, found.num_oracle_queries + bare

    return run


def maximum_likelihood(levels, shots, seed):
    from qiskit_algorithms import MaximumLikelihoodAmplitudeEstimation

    method = MaximumLikelihoodAmplitudeEstimation(levels, sampler=sampler(shots, seed))

    def run(amplitude):
        return method.estimate(problem(amplitude)).estimation, shots * 2**levels

    return run


def measured(run, runs):
    """The mean of the queries, and the error that 95 % of the runs keep."""
    errors, queries = [], 0
    for i in range(runs):
        amplitude = (i + 0.5) / runs
        estimate, spent = run(amplitude)
        errors.append(abs(estimate - amplitude))
        queries += spent / runs
    return queries, sorted(errors)[math.ceil(CONFIDENCE * runs) - 1]


def ours(path, name, queries):
    """Queries and error of qrt's, nearest to a number of queries."""
    with open(path, newline="") as file:
        rows = [
            (float(row["queries"]), float(row["q95"]))
            for row in csv.DictReader(file)
            if row["estimator"] == name and row["amplitudes"] == "even"
        ]
    return min(rows, key=lambda row: abs(math.log(row[0] / queries)))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--venv", required=True, help="folder of the virtual environment")
    arguments.add_argument("--csv", required=True, help="what the bench `estimators` has written")
    arguments.add_argument("--runs", type=int, default=200)
    asked = arguments.parse_args()
    inside(asked.venv, "amplitude_estimation.txt")

    peers = [
        ("iqae", f"error {error}, {shots} shots", iterative(error, shots, seed))
        for seed, (error, shots) in enumerate([(1e-2, 100), (1e-2, 20), (1e-3, 100), (1e-3, 20)])
    ] + [
        ("mlae", f"{levels} levels, {shots} shots", maximum_likelihood(levels, shots, levels))
        for levels, shots in [(5, 16), (7, 16), (5, 100)]
    ]
    print("| estimator | Qiskit's settings | queries | q95 | product | qrt: queries | q95 | product |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    behind = 0
    for name, settings, run in peers:
        theirs = measured(run, asked.runs)
        here = ours(asked.csv, name, theirs[0])
        cells = [f"{q:.0f} | {e:.2e} | {q * e:.2f}" for q, e in (theirs, here)]
        print(f"| {name} | {settings} | {cells[0]} | {cells[1]} |", flush=True)
        behind += here[0] * here[1] > 1.2 * theirs[0] * theirs[1]
    sys.exit(1 if behind else 0)


if __name__ == "__main__":
    main()
