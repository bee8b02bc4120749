"""Pictures in parts."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from . import _qrt

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import RenderOptions


def render_portion(scene: _qrt.Scene, k: int, n: int, **options: Unpack[RenderOptions]) -> bytes:
    """Render portion `k`, from 0, of `n` of a picture, and return it as the bytes of a part.

    `options` are those of `Scene.render`. The portion's pixels lie in small rectangles all over the
    picture, so that all portions take about as long. The bytes are those of a file of `qrt render
    --portion K/N`, and `merge` or `qrt merge` takes them. A function of its arguments alone, for pools of
    processes: scenes travel with their meshes.

    Raises what `Scene.render` raises, and RequestError for more portions than pixels.
    """
    return scene.render_portion(k, n, **options)


def merge(parts: Iterable[bytes | str | os.PathLike[str]]) -> _qrt.Picture:
    """Put together all parts of a picture, in any order: bytes, or paths of files.

    The picture is that of one `Scene.render`, bit for bit. Its `seconds` are those of all parts together.

    Raises MergeError that names a part which is missing, there twice, damaged or of another picture:
    parts that are bytes are called by their place in `parts`, from 0.
    """

    def read() -> Iterator[tuple[str, bytes]]:
        for number, part in enumerate(parts):
            if isinstance(part, (bytes, bytearray, memoryview)):
                yield f"parts[{number}]", bytes(part)
            else:
                with open(part, "rb") as file:
                    yield os.fspath(part), file.read()

    return _qrt.merge(read())
