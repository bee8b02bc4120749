"""The examples that the book shows run."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

from conftest import _command

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize(
    "name, says", [("picture", "(24, 24, 3) float64"), ("device", "estimated")]
)
def test_an_example_runs(box_file, tmp_path, name, says):
    assert says in run(tmp_path, [sys.executable, EXAMPLES / f"{name}.py", box_file])


def test_the_example_of_qiskit_runs(command, tmp_path):
    pytest.importorskip("qiskit_algorithms")
    words = [sys.executable, EXAMPLES / "qiskit_estimation.py", _command()]
    assert "both intervals hold S/N" in run(tmp_path, words)


def test_one_pixel_in_numpy_prints_what_the_program_in_rust_prints(tmp_path):
    page = (EXAMPLES.parents[1] / "book/src/one-pixel.md").read_text(encoding="utf-8")
    # A test of the book compares this listing with the program in Rust.
    expected = page.partition("```text\n")[2].partition("```")[0].splitlines()
    # The program in numpy has no gates.
    gates = [line for line in expected if " gates on " in line]
    assert len(gates) == 1 and len(expected) == 10
    printed = run(tmp_path, [sys.executable, EXAMPLES / "one_pixel.py"])
    assert printed.splitlines() == [line for line in expected if line not in gates]


@pytest.mark.parametrize(
    "name, needs, more",
    [
        ("processes", (), ()),
        ("dask_cluster", ("distributed",), ()),
        # Without Slurm, submitit runs the jobs of an array as processes of this machine.
        ("slurm", ("submitit",), ("3",)),
        ("ray_cluster", ("ray",), ()),
    ],
)
def test_a_pools_example_makes_the_picture(box, box_file, tmp_path, name, needs, more):
    for module in needs:
        pytest.importorskip(module)
    run(tmp_path, [sys.executable, EXAMPLES / f"{name}.py", box_file, *more])
    is_the_picture(box, tmp_path)


def as_text(notebook):
    """A notebook's cells and what they showed, as a script whose cells begin with `# %%`."""
    lines = []
    for cell in notebook.cells:
        source = cell.source.splitlines()
        if cell.cell_type == "markdown":
            lines += ["# %% [markdown]", *(f"# {line}".rstrip() for line in source), ""]
            continue
        lines += ["# %%", *source]
        shown = ""
        for output in cell.outputs:
            if output.output_type == "stream":
                # A kernel may send one line in two messages.
                shown += output.text
            elif text := output.get("data", {}).get("text/plain"):
                shown += f"{text}\n"
        lines += [f"#> {line}" for line in shown.splitlines()]
        lines.append("")
    return "\n".join(lines)


NOTEBOOKS = {"counting_light": ("ipykernel",), "mirror_on_aer": ("ipykernel", "qiskit_aer")}


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs_to_its_end_and_shows_what_the_book_says(tmp_path, name):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    for module in NOTEBOOKS[name]:
        pytest.importorskip(module)
    notebook = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    nbformat.validate(notebook)
    assert all(not cell.get("outputs") for cell in notebook.cells), "committed without outputs"
    nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": tmp_path}}
    ).execute()
    for cell in notebook.cells:
        # Bars of tqdm are left out: they are gone at the end.
        if cell.cell_type == "code":
            cell.outputs = [one for one in cell.outputs if not is_a_bar(one)]
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    pages = [output["data"].get("text/html", "") for output in shown if "data" in output]
    if name == "counting_light":
        assert any("data:image/png;base64," in page for page in pages)
    assert any("Toffoli" in page for page in pages)
    text = as_text(notebook)
    told = EXAMPLES / f"{name}.py"
    if os.environ.get("QRT_BLESS"):
        told.write_text(text, encoding="utf-8")
    assert told.read_text(encoding="utf-8") == text


def is_a_bar(output):
    widget = "application/vnd.jupyter.widget-view+json"
    return output.get("name") == "stderr" or widget in output.get("data", {})


@pytest.mark.parametrize("qubits", [16, 20, 23])
def test_mqt_bench_takes_the_circuits(tmp_path, qubits):
    pytest.importorskip("mqt.bench")
    said = run(tmp_path, [sys.executable, EXAMPLES / "mqt_bench.py", str(qubits)])
    assert "MAPPED        27 qubits" in said and f"INDEP         {qubits} qubits" in said


def test_the_example_of_mpi_runs(box, box_file, tmp_path):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("there is no mpirun: Debian's is in openmpi-bin")
    words = [mpirun, "-n", "3", "--oversubscribe", "--allow-run-as-root", sys.executable]
    run(tmp_path, [*words, "-m", "mpi4py.futures", EXAMPLES / "mpi.py", box_file])
    is_the_picture(box, tmp_path)


def is_the_picture(scene, folder):
    scene.render(seed=1).save(folder / "own.png")
    assert (folder / "picture.png").read_bytes() == (folder / "own.png").read_bytes()


def run(folder, words):
    done = subprocess.run(
        [*map(str, words)], cwd=folder, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
