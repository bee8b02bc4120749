"""The options of renders, by name, for those who check types."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Literal, TypedDict


class PictureOptions(TypedDict, total=False):
    """The options that decide a picture, and its resources: see `Scene.render`."""

    model: Literal["real", "fixed", "gates"]
    estimator: str | None
    seed: int
    crop: tuple[int, int, int, int] | None
    colour: Literal["three-runs", "one-run"]
    noise: str | None
    visibility: Literal["classical", "exhaustive", "grover"]
    search_failure: float | None
    first_guess: Literal["random", "coherent"] | None
    max_memory: int | None


class RenderOptions(PictureOptions, total=False):
    """All options of `Scene.render`."""

    threads: int | None
    progress: bool | Callable[[int, int], object] | None
    checkpoint: str | os.PathLike[str] | None
    resume: bool
