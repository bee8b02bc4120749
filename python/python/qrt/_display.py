"""Pictures and costs in notebooks, and pictures as arrays."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from typing import Any

import numpy


def _png(self: Any, exposure: float | None = None) -> bytes:
    """The bytes of `save` with a name in .png; `exposure` is in stops."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        self.save(path, exposure=exposure)
        with open(path, "rb") as file:
            return file.read()


def _picture_html(self: Any) -> str:
    """The picture and what it is, as notebooks show them."""
    data = base64.b64encode(_png(self)).decode("ascii")
    # Small pictures are shown larger, pixel by pixel.
    width = self.width * max(1, 256 // self.width)
    style = f"width: {width}px; image-rendering: pixelated"
    return (
        f'<figure><img src="data:image/png;base64,{data}" style="{style}">'
        f"<figcaption>{html.escape(repr(self))}</figcaption></figure>"
    )


def _array(self: Any, dtype: Any = None, copy: bool | None = None) -> numpy.ndarray:
    """The pixels, so that numpy takes a picture for an array. They are the picture's own memory, unless
    `copy` is True or `dtype` is another than float64; then copy=False is a ValueError."""
    pixels: numpy.ndarray = self.pixels
    if dtype is not None and numpy.dtype(dtype) != pixels.dtype:
        if copy is False:
            raise ValueError(f"pixels are {pixels.dtype}, and {numpy.dtype(dtype)} takes a copy")
        return pixels.astype(dtype)
    return pixels.copy() if copy else pixels


# Most path bits of an oracle whose counts a notebook shows.
_COMPARED_BITS = 10


def _oracle_html(self: Any) -> str:
    """The cost of a call of the oracle and its counts, as a table."""
    rows = [
        ("qubits", self.qubits),
        ("Toffoli", self.toffoli),
        ("AND, if they are undone by measurement", self.and_measured),
        ("Toffoli depth", self.toffoli_depth),
        ("CNOT", self.cnot),
        ("X", self.x),
        ("indices N", self.total),
    ]
    # To compare more paths would take seconds.
    counts = self.counts if self.path_bits <= _COMPARED_BITS else None
    if counts is not None:
        rows += [
            ("good indices S", counts.good),
            ("S in real numbers", counts.good_in_real),
            ("paths that count differently", counts.differing),
        ]
        if counts.agrees_at is not None:
            rows.append(("precision.fraction with which none does", counts.agrees_at))
    cells = "".join(
        f'<tr><td style="text-align: left">{name}</td><td>{value:,}</td></tr>'
        for name, value in rows
    )
    return f"<table><caption>{html.escape(repr(self))}</caption>{cells}</table>"


def extend(picture: Any, oracle: Any) -> None:
    """Gives the native classes what Python says more shortly."""
    picture._repr_html_ = _picture_html
    picture.png = _png
    picture.__array__ = _array
    oracle._repr_html_ = _oracle_html
