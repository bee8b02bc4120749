"""Scenes from files, texts and dictionaries, and what is wrong with them."""

import pickle
import subprocess

import numpy
import pytest

import qrt
from conftest import BOX, ROOT, _command

SKY = {
    "name": "sky",
    "camera": {"orthographic": {"eye": [0, 0, 2], "target": [0, 0, 0], "height": 1}},
    "film": {"width": 4, "height": numpy.int64(2)},
    "materials": {"sky": {"emitter": {"radiance": numpy.array([0.25, 0.5, 1.0])}}},
    "geometry": [
        {"quad": {"vertices": [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], "material": "sky"}}
    ],
    "counting": {"estimator": "exact"},
}


def test_a_scene_is_the_same_from_file_text_and_dictionary(box):
    assert qrt.parse(BOX).fingerprint == box.fingerprint
    assert qrt.parse(box.to_yaml()).fingerprint == box.fingerprint
    sky = qrt.from_dict(SKY)
    assert (sky.name, sky.width, sky.height) == ("sky", 4, 2)
    assert numpy.array_equal(sky.render().pixels, numpy.broadcast_to([0.25, 0.5, 1], (2, 4, 3)))


def test_overrides_are_those_of_the_command_line(box_file):
    scene = qrt.load(
        box_file,
        set={
            "film": {"width": 3, "height": 2},
            "sampling.path_bits": 4,
            "counting.estimator": "exact",
            "materials.lamp.emitter.radiance": numpy.array([1.0, 2.0, 3.0]),
        },
    )
    assert (scene.width, scene.height) == (3, 2)
    picture = scene.render()
    assert (picture.estimator, picture.paths) == ("exact", 6 << 4)
    with pytest.raises(qrt.SceneError) as wrong:
        qrt.load(box_file, set={"film.width": "wide"})
    assert wrong.value.problems[0].file == "<--set>"


def test_errors_are_the_commands_text_with_each_problem_apart(tmp_path):
    wrong = BOX.replace("material: red", "material: rde").replace("width: 13", "width: -1")
    path = tmp_path / "box.yaml"
    path.write_text(wrong, encoding="utf-8")
    with pytest.raises(qrt.SceneError) as raised:
        qrt.load(path)
    error = raised.value
    assert [problem.line for problem in error.problems] == [4, 14]
    for problem in error.problems:
        assert problem.code.startswith("QRT") and problem.code in str(error)
        assert problem.message in str(error)
        assert f"box.yaml:{problem.line}:{problem.column}" in str(error)
    assert "red" in error.problems[1].help
    assert pickle.loads(pickle.dumps(error)).problems == error.problems
    command = _command()
    if command:
        said = subprocess.run([command, "render", path], capture_output=True, text=True)
        assert said.returncode == 2
        assert str(error) in said.stderr
    with pytest.raises(qrt.SceneError, match="none.yaml"):
        qrt.load(tmp_path / "none.yaml")


def test_meshes_travel_with_their_scene(tmp_path, monkeypatch):
    knot = qrt.load(ROOT / "scenes-yaml/knot.yaml", {"film": {"width": 4, "height": 4}})
    bytes_ = pickle.dumps(knot)
    monkeypatch.chdir(tmp_path)
    again = pickle.loads(bytes_)
    assert again.fingerprint == knot.fingerprint
    options = {"estimator": "exact", "crop": (1, 1, 2, 2)}
    assert numpy.array_equal(again.render(**options).pixels, knot.render(**options).pixels)
    assert pickle.loads(pickle.dumps(again)).fingerprint == knot.fingerprint


def test_what_is_hardly_meant_is_warned_of():
    lamp = "materials: { lamp: { emitter: { radiance: [0, 0, 0] } } }"
    dark = f"""
name: dark
camera: {{ perspective: {{ eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 2, height: 2 }}
{lamp}
geometry: []
sampling: {{ path_bits: 2, depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4], light: [2, 2] }}] }}
"""
    with pytest.warns(qrt.SceneWarning, match="QRT"):
        qrt.parse(dark)
