"""The examples that the book shows run."""

import pathlib
import shutil
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize(
    "name, needs, says",
    [
        ("picture", (), "(24, 24, 3) float64"),
        ("device", (), "estimated"),
        ("qiskit_estimation", ("qiskit_algorithms",), "S/N is"),
        ("processes", (), ""),
        ("dask_cluster", ("distributed",), ""),
    ],
)
def test_an_example_runs(box_file, tmp_path, name, needs, says):
    for module in needs:
        pytest.importorskip(module)
    run(tmp_path, [sys.executable, EXAMPLES / f"{name}.py", box_file], says)


def test_the_example_of_mpi_runs(box_file, tmp_path):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("there is no mpirun: Debian's is in openmpi-bin")
    words = [mpirun, "-n", "3", "--oversubscribe", "--allow-run-as-root", sys.executable]
    run(tmp_path, [*words, "-m", "mpi4py.futures", EXAMPLES / "mpi.py", box_file], "")
    assert (tmp_path / "picture.png").exists()


def run(folder, words, says):
    done = subprocess.run(
        [*map(str, words)], cwd=folder, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    assert says in done.stdout
