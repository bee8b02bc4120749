"""The renderer Mitsuba 3 has qrt's pictures as its expected values."""

import pathlib

import numpy
import pytest

import qrt

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Numbers of independent renderings by each, so that the errors of their means are known without a model.
# Mitsuba's errors are the larger ones.
OWN_RUNS, THEIR_RUNS = 8, 16


@pytest.fixture(scope="module")
def mitsuba():
    mitsuba = pytest.importorskip("mitsuba", reason="pip install mitsuba")
    mitsuba.set_variant("scalar_rgb")
    return mitsuba


def _mesh(folder):
    """A roof of four triangles over the floor, from a file."""
    (folder / "roof.obj").write_text(
        "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.5 0\n"
        "f 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n"
    )
    return """
name: roof
camera: { orthographic: { eye: [3, 4, 5], target: [0, 0.5, 0], height: 4 } }
film: { width: 16, height: 12 }
materials:
  white: { lambertian: { albedo: [0.8, 0.6, 0.4] } }
  lamp: { emitter: { radiance: [5, 5, 4], albedo: [0.2, 0.2, 0.2] } }
  metal: { mirror: { reflectance: [0.9, 0.8, 0.7] } }
geometry:
  - quad: { vertices: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: white }
  - quad: { vertices: [[-2, 3, -2], [2, 3, -2], [2, 3, 1], [-2, 3, 1]], material: lamp }
  - quad: { vertices: [[-3, 0, -3], [3, 0, -3], [3, 3, -3], [-3, 2, -3]], material: metal }
  - mesh: { obj: roof.obj, material: white, scale: 0.9, rotate: [0, 30, 0], translate: [0, 0.1, 0] }
"""


@pytest.mark.parametrize("name", ["cornell", "cornell_glass", "cornell_ggx", "roof"])
def test_mitsuba_agrees_within_its_standard_errors(name, mitsuba, tmp_path):
    path = tmp_path / f"{name}.yaml"
    if name == "roof":
        path.write_text(_mesh(tmp_path))
    else:
        path.write_text((ROOT / f"tests/references/{name}.yaml").read_text())
    bounce = {"bits": [10, 10], "light": [10, 10]}
    settings = {"sampling.depths": [{"bits": [16, 16]}, bounce, bounce], "sampling.path_bits": 11}
    if name != "roof":
        settings |= {"film.width": 16, "film.height": 16}
    ours = qrt.load(path, set=settings)
    text, meshes = ours.mitsuba()
    (tmp_path / "scene.xml").write_text(text)
    for file, content in meshes.items():
        (tmp_path / file).write_bytes(content)
    scene = mitsuba.load_file(str(tmp_path / "scene.xml"), spp=1024)
    theirs = [numpy.array(mitsuba.render(scene, seed=seed)) for seed in range(THEIR_RUNS)]
    own = [ours.render(estimator="exact", seed=seed).pixels for seed in range(OWN_RUNS)]
    assert theirs[0].shape == own[0].shape

    # Compares the film's mean. A standard error of sixteen runs is itself a guess: with fifteen degrees of
    # freedom, Student's t is within 4.5 but for once in 2,400.
    films = [[numpy.mean(run, axis=(0, 1)) for run in runs] for runs in (theirs, own)]
    difference, error = compared(*films)
    assert (abs(difference) < 4.5 * error).all(), (difference, error)
    # The errors are small enough that a deviation of a few percent would be seen.
    assert (0 < error).all() and (error < 0.006 * numpy.mean(films[0], axis=0)).all(), error
    # Compares pixels: within 3.5 but for 3 in 1,000. Where neither has an error, Mitsuba's numbers have 24 bits.
    difference, error = compared(theirs, own)
    off = abs(difference) > 3.5 * error + 1e-6 * numpy.mean(theirs, axis=0)
    assert off.mean() < 0.015, off.mean()


def compared(*both):
    """The difference of the means of two series of runs, and its standard error."""
    theirs, own = (numpy.mean(runs, axis=0) for runs in both)
    squares = (numpy.var(runs, axis=0, ddof=1) / len(runs) for runs in both)
    return own - theirs, numpy.sqrt(sum(squares))


def test_what_mitsuba_lacks_is_named_at_its_place():
    shiny = {"diffuse": [0.1, 0.1, 0.1], "specular": [0.5, 0.5, 0.5], "exponent": 9}
    scene = qrt.from_dict(
        {
            "name": "shiny",
            "camera": {"perspective": {"eye": [0, 0, 3], "target": [0, 0, 0], "vfov": 40}},
            "film": {"width": 2, "height": 2},
            "materials": {"m": {"phong": shiny}},
            "geometry": [
                {"triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "material": "m"}}
            ],
        }
    )
    with pytest.raises(qrt.SceneError, match="no counterpart of the `phong` of `m`") as raised:
        scene.mitsuba()
    assert [problem.code for problem in raised.value.problems] == ["QRT0903"]
