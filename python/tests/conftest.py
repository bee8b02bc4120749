"""Scenes, and the command that pictures are compared with."""

import os
import pathlib
import shutil
import subprocess

import pytest

import qrt

ROOT = pathlib.Path(__file__).resolve().parents[2]
BOX = (ROOT / "tests/scenes/box.yaml").read_text()
# A lamp that covers half of some pixels, on 22 qubits.
DOT = """
name: dot
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 2, height: 2 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [0.25, -1, 0], [0.25, 1, 0], [-1, 1, 0]], material: lamp }
sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
precision: { fraction: 4 }
comparator: { bits: 2 }
circuit: { uncompute: scoped }
counting: { phase_bits: 6 }
"""


def _command():
    named = os.environ.get("QRT_COMMAND")
    built = [ROOT / "target" / profile / "qrt" for profile in ("release", "debug")]
    found = [named, *map(str, built), shutil.which("qrt")]
    return next((path for path in found if path and pathlib.Path(path).is_file()), None)


@pytest.fixture
def command(tmp_path):
    """Runs `qrt` in a folder of its own: the command of QRT_COMMAND, or the one that cargo has built."""
    path = _command()
    if path is None:
        pytest.skip("there is no command to compare with: cargo build, or set QRT_COMMAND")

    def run(*arguments):
        done = subprocess.run(
            [path, *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture
def box_file(tmp_path):
    path = tmp_path / "box.yaml"
    path.write_text(BOX, encoding="utf-8")
    return path


@pytest.fixture
def box(box_file):
    return qrt.load(box_file)


@pytest.fixture
def dot():
    return qrt.parse(DOT)
