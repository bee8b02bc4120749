"""Scenes from files, texts and dictionaries."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _qrt


def _plain(value: Any) -> Any:
    """The plain value of arrays and numbers of numpy, which JSON does not know."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in a scene")


def _sets(overrides: Mapping[str, Any] | None) -> list[str]:
    """Overrides as the command line has them. Text is YAML, and everything else is itself."""

    def text(value: Any) -> str:
        return value if isinstance(value, str) else json.dumps(value, default=_plain)

    return [f"{key}={text(value)}" for key, value in (overrides or {}).items()]


def load(
    path: str | os.PathLike[str],
    set: Mapping[str, Any] | None = None,
    *,
    allow_files: Sequence[str | os.PathLike[str]] = (),
) -> _qrt.Scene:
    """Read the scene of a YAML file and check it.

    `set` overrides keys by their paths, as `--set` does: `{"film.width": 64, "sampling.path_bits": 8}`.
    A text is YAML, so that `"auto"` is a word; numbers, lists and dictionaries are themselves. The scene
    reads files of its own folder, and of the folders `allow_files`.

    Raises SceneError with everything that is wrong; warns with SceneWarning of what is hardly meant.
    """
    return _qrt.load(path, _sets(set), list(allow_files))


def parse(
    text: str,
    set: Mapping[str, Any] | None = None,
    *,
    name: str = "scene.yaml",
    folder: str | os.PathLike[str] = ".",
    allow_files: Sequence[str | os.PathLike[str]] = (),
) -> _qrt.Scene:
    """Read the scene of a YAML text; errors call it `name`, and its meshes are below `folder`.

    Otherwise as `load`.
    """
    return _qrt.parse(text, name, _sets(set), folder, list(allow_files))


def from_dict(
    scene: Mapping[str, Any],
    set: Mapping[str, Any] | None = None,
    *,
    folder: str | os.PathLike[str] = ".",
    allow_files: Sequence[str | os.PathLike[str]] = (),
) -> _qrt.Scene:
    """Read a scene of dictionaries, lists, numbers and texts, with the keys of a YAML file.

    Values may be numpy arrays. Errors have their places in the scene as JSON, indented by one.
    Otherwise as `load`.
    """
    text = json.dumps(scene, indent=1, default=_plain, ensure_ascii=False)
    return parse(text, set, name="<dict>", folder=folder, allow_files=allow_files)
