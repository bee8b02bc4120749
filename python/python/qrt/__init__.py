"""Quantum ray tracing: scenes as countable sets of paths, pictures by quantum counting.

    >>> import qrt
    >>> scene = qrt.load("box.yaml", set={"film.width": 64, "film.height": 64})
    >>> picture = scene.render(seed=1)
    >>> picture.pixels.shape                    # rows, columns, RGB: linear radiance
    (64, 64, 3)
    >>> picture.save("box.png")

The bytes of what is saved are those that the command `qrt render` writes for the same scene, options
and seed.
"""

from ._errors import (
    Error,
    JobError,
    MergeError,
    Problem,
    RequestError,
    SceneError,
    SceneWarning,
)
from ._qrt import Device, Oracle, Picture, Scene, __version__
from ._records import Record, count
from ._scenes import from_dict, load, parse
from ._portions import merge, render_portion
from . import _display, _quantum, _records, distributed

_display.extend(Picture, Oracle)
_quantum.extend(Oracle)
_records.extend(Scene, Oracle)

__all__ = [
    "Device",
    "Error",
    "JobError",
    "MergeError",
    "Oracle",
    "Picture",
    "Problem",
    "Record",
    "RequestError",
    "Scene",
    "SceneError",
    "SceneWarning",
    "__version__",
    "count",
    "distributed",
    "from_dict",
    "load",
    "merge",
    "parse",
    "render_portion",
]
