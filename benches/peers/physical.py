#!/usr/bin/env python3
"""Asks Microsoft's resource estimator what a picture takes on machines with physical qubits.

    qrt inspect SCENE --logical-counts counts.json
    python3 benches/peers/physical.py --venv FOLDER counts.json...

prints a Markdown table: a row for each file and machine, with the physical qubits and the time of a
pixel, and of the film on one machine. Each may fail with probability `--error`: the film's qubits are
better protected than a pixel's, because it runs for longer. A film is asked for as a pixel that may fail
so much less often, one after another: the estimator's own time, in ns, begins again at zero after 584
years, without a word.

Machines are the estimator's own qubits: gates of 50 ns or 100 us, with errors of 10^-3 and 10^-4, on
the surface code; and Majorana qubits, with errors of 10^-4 and 10^-6, on the Floquet code.

`--engine qre` asks the engine that replaces the estimator in qdk. It has the gate-based qubits and the
surface code, too, but rounds of error correction that are an eighth shorter, and it is not told of Majorana
qubits here. qdk is installed from PyPI, at the version in physical.txt, into a virtual environment of
its own, once.
"""

import argparse
import json
import pathlib
import warnings

from environment import inside

# By the estimator's name: the table's label, gate time and measurement time in ns, physical error rate.
GATES = {
    "qubit_gate_ns_e3": ("ns, $10^{-3}$", 50, 100, 1e-3),
    "qubit_gate_ns_e4": ("ns, $10^{-4}$", 50, 100, 1e-4),
    "qubit_gate_us_e3": ("µs, $10^{-3}$", 100_000, 100_000, 1e-3),
    "qubit_gate_us_e4": ("µs, $10^{-4}$", 100_000, 100_000, 1e-4),
}
MAJORANA = {
    "qubit_maj_ns_e4": "Majorana, $10^{-4}$",
    "qubit_maj_ns_e6": "Majorana, $10^{-6}$",
}
# The new engine's own domain ends at distance 25, too little for a run of hours.
DISTANCES = list(range(3, 70, 2))


def estimator(counts, name, error):
    """Physical qubits and seconds."""
    from qdk.estimator import LogicalCounts

    params = {"qubitParams": {"name": name}, "errorBudget": error}
    if name in MAJORANA:
        params["qecScheme"] = {"name": "floquet_code"}
    found = LogicalCounts(counts).estimate(params)["physicalCounts"]
    return found["physicalQubits"], found["runtime"] / 1e9


def qre(counts, name, error):
    """Physical qubits and seconds, of the way with the fewest qubits that the engine finds."""
    from qdk.estimator import LogicalCounts
    from qdk.qre import estimate
    from qdk.qre.application import QSharpApplication
    from qdk.qre.models import GateBased, Litinski19Factory, SurfaceCode

    _, gate, measurement, rate = GATES[name]
    machine = GateBased(error_rate=rate, gate_time=gate, measurement_time=measurement)
    ways = SurfaceCode.q(distance=DISTANCES) * Litinski19Factory.q()
    application = QSharpApplication(LogicalCounts(counts))
    found = estimate(application, machine, ways, max_error=error)
    return min((way.qubits, way.runtime / 1e9) for way in found)


ENGINES = {
    "estimator": (estimator, {name: row[0] for name, row in GATES.items()} | MAJORANA),
    "qre": (qre, {name: row[0] for name, row in GATES.items()}),
}


def grouped(value):
    return f"{value:,.0f}" if value >= 9.95 else f"{value:.1f}"


def qubits(count):
    return f"{grouped(count / 1e6)} million"


def time(seconds):
    units = [("year", 31_557_600), ("day", 86_400), ("hour", 3600), ("minute", 60)]
    for unit, length in units:
        if seconds >= length:
            return f"{grouped(seconds / length)} {unit}s"
    return f"{grouped(seconds)} seconds"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("counts", nargs="+", type=pathlib.Path, help="what --logical-counts wrote")
    parser.add_argument("--venv", required=True, help="folder of the virtual environment")
    parser.add_argument("--undone", choices=("unitary", "measured"), default="unitary")
    parser.add_argument("--engine", choices=ENGINES, default="estimator")
    parser.add_argument("--error", type=float, default=0.01, help="the probability that a run fails")
    arguments = parser.parse_args()
    inside(arguments.venv, "physical.txt")
    # Ignore the estimator's warning of its own deprecation.
    warnings.simplefilter("ignore")
    engine, machines = ENGINES[arguments.engine]
    print("| circuit | machine | qubits for a pixel | a pixel | qubits for the film | the film |")
    print("|---|---|---|---|---|---|")
    for file in arguments.counts:
        answer = json.loads(file.read_text())
        for name, words in machines.items():
            cells = [answer["strategy"], words]
            for pixels in (1, answer["pixels"]):
                counts = answer[arguments.undone]["pixel"]
                needed, seconds = engine(counts, name, arguments.error / pixels)
                cells += [qubits(needed), time(pixels * seconds)]
            print("|", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
