"""Pictures and costs in notebooks, and pictures as arrays."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from typing import Any

import numpy


def _png(picture: Any, exposure: float | None = None) -> bytes:
    """The bytes of `picture.save` with a name in .png; `exposure` is in stops."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        picture.save(path, exposure=exposure)
        with open(path, "rb") as file:
            return file.read()


def _picture_html(picture: Any) -> str:
    data = base64.b64encode(_png(picture)).decode("ascii")
    # Small pictures are shown larger, pixel by pixel.
    width = picture.width * max(1, 256 // picture.width)
    style = f"width: {width}px; image-rendering: pixelated"
    return (
        f'<figure><img src="data:image/png;base64,{data}" style="{style}">'
        f"<figcaption>{html.escape(repr(picture))}</figcaption></figure>"
    )


def _array(picture: Any, dtype: Any = None, copy: bool | None = None) -> numpy.ndarray:
    """The pixels, so that numpy takes a picture for an array."""
    pixels = picture.pixels
    if dtype is not None and numpy.dtype(dtype) != pixels.dtype:
        return pixels.astype(dtype)
    return pixels.copy() if copy else pixels


def _amplitudes(picture: Any) -> numpy.ndarray:
    """Amplitudes S/N that were estimated: rows, columns, RGB; pixels over scales, and 0 where a channel
    is proven black."""
    scales = picture.scales
    return numpy.divide(picture.pixels, scales, out=numpy.zeros_like(scales), where=scales > 0)


def _oracle_html(oracle: Any) -> str:
    rows = [
        ("qubits", oracle.qubits),
        ("Toffoli", oracle.toffoli),
        ("AND, if they are undone by measurement", oracle.and_measured),
        ("Toffoli depth", oracle.toffoli_depth),
        ("CNOT", oracle.cnot),
        ("X", oracle.x),
        ("indices N", oracle.total),
    ]
    cells = "".join(
        f'<tr><td style="text-align: left">{name}</td><td>{value:,}</td></tr>'
        for name, value in rows
    )
    return f"<table><caption>{html.escape(repr(oracle))}</caption>{cells}</table>"


def extend(picture: type, oracle: type) -> None:
    """Gives the native classes what Python says more shortly."""
    picture._repr_html_ = _picture_html
    picture.png = _png
    picture.__array__ = _array
    picture.amplitudes = property(_amplitudes)
    oracle._repr_html_ = _oracle_html
