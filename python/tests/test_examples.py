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


def test_the_notebook_runs_to_its_end_and_shows_pictures_and_costs(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "counting_light.ipynb", as_version=4)
    nbformat.validate(notebook)
    assert all(not cell.get("outputs") for cell in notebook.cells), "committed without outputs"
    nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": tmp_path}}
    ).execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    pages = [output["data"].get("text/html", "") for output in shown if "data" in output]
    assert any("data:image/png;base64," in page for page in pages)
    assert any("Toffoli" in page for page in pages)
    texts = "".join(output.get("text", "") for output in shown)
    assert texts.count("queries a pixel") == 3 and "S/N is" in texts


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
