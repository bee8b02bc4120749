"""Studies of a scene are the records that the command prints."""

import inspect
import json
import pickle
import re

import pytest

import qrt
from conftest import ROOT
from qrt import _records


# A lamp whose slanted edge crosses the film, with an accuracy in place of its parameters.
ACCURATE = """
name: plan
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 4 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - triangle: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0]], material: lamp }
sampling: { depths: [{ bits: [6, 6] }] }
accuracy: { error: 0.2, confidence: 0.9 }
"""


EDGE = """
name: edge
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 1, height: 1 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [-0.5, -1, 0], [-0.5, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 4, depths: [{ bits: [3, 3] }] }
comparator: { bits: 1 }
"""


def told(command, *words):
    return json.loads(command(*words, "--json"))


def without_time(record):
    return {key: value for key, value in record.items() if key != "seconds"}


def test_inspect_is_what_the_command_prints(command, box):
    assert box.inspect() == told(command, "inspect", "box.yaml")
    assert box.inspect("g") == told(command, "inspect", "box.yaml", "--channel", "g")
    words = ["--channel", "b", "--pixel", "3,4", "--seed", "7"]
    one = box.inspect("b", (3, 4), seed=7)
    assert one == told(command, "inspect", "box.yaml", *words)
    assert one.gates.toffoli == one["gates"]["toffoli"] == box.oracle("b", (3, 4), seed=7).toffoli
    with pytest.raises(qrt.RequestError, match="no pixel"):
        box.inspect(pixel=(13, 0))
    with pytest.raises(qrt.RequestError, match="r, g, b"):
        box.inspect("red")


def test_an_oracle_compares_its_count_with_real_numbers(box, dot):
    oracle = dot.oracle("r", (1, 0))
    assert oracle.counts == dot.inspect("r", (1, 0)).counts
    assert oracle.counts is not None and isinstance(oracle.counts, qrt.Record)
    assert (oracle.counts.good, oracle.counts.total) == (oracle.good, oracle.total)
    shifted = box.oracle("g", (3, 4), seed=7)
    assert shifted.counts == box.inspect("g", (3, 4), seed=7).counts
    assert shifted.counts.paths == 2**10
    many = dot.with_({"sampling.path_bits": 17}).oracle("r", (1, 0))
    assert many.counts is None and "real numbers" not in many._repr_html_()


def test_too_few_fraction_bits_are_told_of():
    # The lamp covers a quarter of the pixel; the centres of cells are at odd multiples of 1/16.
    edge = {"precision": {"fraction": 4}, "sampling.path_bits": 4}
    scene = qrt.parse(EDGE).with_(edge)
    counts = scene.oracle("r", (0, 0)).counts
    assert (counts.good, counts.good_in_real, counts.differing) == (12, 8, 2)
    page = scene.oracle("r", (0, 0))._repr_html_()
    assert "paths that count differently" in page and "precision.fraction with which none does" in page
    finer = scene.with_({"precision.fraction": counts.agrees_at}).oracle("r", (0, 0))
    assert (finer.counts.good, finer.counts.differing, finer.counts.agrees_at) == (8, 0, None)
    assert "with which none does" not in finer._repr_html_()


def test_the_front_is_what_the_command_prints(command, dot, tmp_path):
    (tmp_path / "dot.yaml").write_text(dot.to_yaml(), encoding="utf-8")
    assert dot.pareto() == told(command, "inspect", "dot.yaml", "--pareto")
    one = dot.pareto("r", (1, 0), threads=1)
    words = ["--pareto", "--channel", "r", "--pixel", "1,0"]
    assert one == told(command, "inspect", "dot.yaml", *words)
    qubits = [layout.qubits for layout in one.front]
    assert qubits == sorted(qubits, reverse=True)


def test_verify_is_what_the_command_prints(command, dot, tmp_path):
    (tmp_path / "dot.yaml").write_text(dot.to_yaml(), encoding="utf-8")
    found = dot.verify(pixels=2, seed=3, progress=False)
    assert found.holds and found.paths == 2 * 2**3
    words = ["verify", "dot.yaml", "--pixels", "2", "--seed", "3"]
    assert without_time(found) == without_time(told(command, *words))
    with pytest.raises(qrt.RequestError, match="pixels=0"):
        dot.verify(pixels=0)


def test_a_plan_is_that_of_the_accuracy(command, box, tmp_path):
    with pytest.raises(qrt.RequestError, match="asks for no accuracy"):
        box.plan()
    (tmp_path / "plan.yaml").write_text(ACCURATE, encoding="utf-8")
    plan = qrt.load(tmp_path / "plan.yaml").plan()
    assert plan == told(command, "inspect", "plan.yaml")["plan"]
    assert plan.error == 0.2 and plan.within >= 0.9


def test_trade_has_the_rows_of_its_table(dot, tmp_path):
    few = dot.with_({"counting.phase_bits": 4})
    measured = few.trade(tmp_path / "trade", quick=True, pixels=2, progress=False)
    lines = (tmp_path / "trade" / "trade.csv").read_text(encoding="utf-8").splitlines()
    names = lines[1].split(",")
    assert len(measured.rows) == len(lines) - 2
    for row, line in zip(measured.rows, lines[2:]):
        values = dict(zip(names, line.split(",")))
        assert set(row) == set(names[:-1])
        assert row.sweep == values["sweep"]
        assert row.e_total == float(values["e_total"])
    assert (tmp_path / "trade" / "index.html").exists()
    again = few.trade(tmp_path / "trade", quick=True, pixels=2, progress=False)
    assert again == measured


def test_counting_is_what_the_command_prints(command, dot):
    numbers = ["--good", "300", "--total", "1000", "--phase-bits", "6"]
    assert qrt.count(300, 1000, 6) == told(command, "count", *numbers)
    found = qrt.count(300, 1000, 20, window="sine", outcomes=[5, 9], shots=7, seed=2)
    words = ["--good", "300", "--total", "1000", "--phase-bits", "20", "--window", "sine"]
    words += ["--outcomes", "5,9", "--shots", "7", "--seed", "2"]
    assert found == told(command, "count", *words)
    oracle = dot.oracle("r", (1, 0))
    counted = dot.count("r", (1, 0))
    assert (counted.good, counted.total) == (oracle.good, oracle.total)
    assert (counted.phase_bits, counted.window) == (oracle.phase_bits, oracle.window)
    assert sum(outcome.probability for outcome in counted.outcomes) == pytest.approx(1, abs=1e-12)
    for wrong in (
        dict(good=3, total=2, phase_bits=4),
        dict(good=1, total=2, phase_bits=0),
        dict(good=1, total=2, phase_bits=41),
        dict(good=1, total=2, phase_bits=4, window="round"),
        dict(good=1, total=2, phase_bits=4, shots=0),
        dict(good=1, total=2, phase_bits=4, outcomes=[9]),
    ):
        with pytest.raises(qrt.RequestError):
            qrt.count(**wrong)


def test_a_simulation_is_what_the_command_prints(command, dot, tmp_path):
    (tmp_path / "dot.yaml").write_text(dot.to_yaml(), encoding="utf-8")
    found = dot.simulate("r", (1, 0), phase_bits=3, shots=9)
    words = ["--channel", "r", "--pixel", "1,0", "--phase-bits", "3", "--shots", "9"]
    assert found == told(command, "simulate", "dot.yaml", *words)
    assert found.largest_difference < 1e-12
    theory = dot.count("r", (1, 0), phase_bits=3).outcomes
    assert [one.theory for one in found.outcomes] == [one.probability for one in theory]
    with pytest.raises(qrt.RequestError, match="at most 24"):
        dot.simulate("r", (1, 0), phase_bits=23)


def test_a_scene_with_other_values_leaves_the_scene_as_it_is(box, dot):
    other = dot.with_({"sampling.path_bits": 2})
    assert other.oracle("r", (1, 0)).path_bits == 2
    assert dot.oracle("r", (1, 0)).path_bits == 3
    # Overrides add up, and travel with a pickled scene.
    both = pickle.loads(pickle.dumps(other)).with_({"film.width": 3})
    assert (both.width, both.oracle("r", (1, 0)).path_bits) == (3, 2)
    with pytest.raises(qrt.SceneError, match="fraction"):
        dot.with_({"precision.fraction": 99})


def test_a_mesh_stays_with_a_scene_that_is_changed(tmp_path):
    (tmp_path / "lamp.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n", encoding="utf-8")
    scene = qrt.parse(
        """
name: mesh
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 2, height: 2 }
materials: { lamp: { emitter: { radiance: [1, 1, 1] } } }
geometry:
  - mesh: { obj: lamp.obj, material: lamp }
sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
""",
        folder=tmp_path,
    )
    assert scene.with_({"film.width": 3}).width == 3
    moved = pickle.loads(pickle.dumps(scene))
    (tmp_path / "lamp.obj").unlink()
    assert moved.with_({"film.width": 3}).width == 3


def test_a_record_is_a_dictionary_with_attributes_and_a_table():
    record = qrt.count(1, 4, 3, shots=2)
    assert json.loads(json.dumps(record)) == record
    assert pickle.loads(pickle.dumps(record)) == record
    assert "estimate" in dir(record)
    with pytest.raises(AttributeError, match="has no 'gates'"):
        record.gates
    page = record._repr_html_()
    assert page.startswith("<table>") and "posterior" in page
    assert "<script>" not in qrt.Record(name="<script>")._repr_html_()
    many = qrt.count(1, 4, 8)._repr_html_()
    assert "20 of 129 rows" in many


def documented():
    """The examples of the module, and those of the book's table of studies."""
    examples = re.findall(r"^ +>>> (.+)$", inspect.getsource(_records), re.MULTILINE)
    assert len(examples) >= 10
    page = (ROOT / "book/src/python.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(?:scene|qrt|oracle)\..+\| `(.+)` \|$", page, re.MULTILINE)
    assert len(rows) >= 8
    return [*examples, *rows]


@pytest.mark.parametrize("example", documented())
def test_a_documented_example_runs(example):
    # Only a scene with an accuracy has a plan.
    accurate = ".plan()" in example
    scene = qrt.parse(ACCURATE) if accurate else qrt.load(ROOT / "scenes-yaml/small/edge.yaml")
    names = {"qrt": qrt, "scene": scene, "oracle": None if accurate else scene.oracle(pixel=(1, 0))}
    if example.startswith("assert "):
        exec(example, names)
        return
    found = eval(example, names)
    assert found is not None
    # A comparison is an example of what holds.
    assert found is not False
