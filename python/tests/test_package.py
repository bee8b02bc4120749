"""The package that pip has installed: one wheel for every Python, with its licences."""

import importlib.metadata

import pytest

import qrt
from conftest import ROOT


def test_one_wheel_serves_every_python_of_a_platform():
    wheel = importlib.metadata.distribution("qrt").read_text("WHEEL")
    tags = [line.split(": ")[1] for line in wheel.splitlines() if line.startswith("Tag: ")]
    assert tags and all(tag.startswith("cp310-abi3-") for tag in tags), wheel


def test_its_licences_are_in_the_wheel():
    distribution = importlib.metadata.distribution("qrt")
    if not distribution.files:
        pytest.skip("installed without a list of its files")
    found = {file.name: file for file in distribution.files if "licenses" in file.parts}
    for name in ("LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY"):
        assert found[name].read_text() == (ROOT / name).read_text(), name
    assert distribution.metadata["License-Expression"] == "MIT OR Apache-2.0"
    assert distribution.version == qrt.__version__
