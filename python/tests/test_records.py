"""Studies of a scene are the records that the command prints."""

import json
import pickle

import pytest

import qrt


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
