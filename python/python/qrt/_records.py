"""Studies of a scene, as records: costs, checks, measurements and simulations.

Each returns the record that the command prints with `--json`.
"""

from __future__ import annotations

import html
import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from . import _qrt
from ._scenes import _sets


class Record(dict[str, Any]):
    """A dictionary whose values are attributes too: `record["gates"]["toffoli"]` is `record.gates.toffoli`.

    Notebooks show it as a table. It pickles and is written by `json.dumps` as the dictionary that it is.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"the record has no {name!r}: it has {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

    def _repr_html_(self) -> str:
        return _table(self)


# Rows of a list that notebooks show; the record has all of them.
_ROWS = 20


def _table(value: Any) -> str:
    """A value as HTML: records as tables, lists of records as tables with a column for each key."""
    if isinstance(value, Mapping):
        rows = "".join(
            f'<tr><th style="text-align: left">{html.escape(str(key))}</th><td>{_table(item)}</td></tr>'
            for key, item in value.items()
        )
        return f"<table>{rows}</table>"
    if isinstance(value, list) and value and all(isinstance(item, Mapping) for item in value):
        keys = list(dict.fromkeys(key for item in value for key in item))
        head = "".join(f"<th>{html.escape(str(key))}</th>" for key in keys)
        rows = "".join(
            "<tr>" + "".join(f"<td>{_table(item.get(key))}</td>" for key in keys) + "</tr>"
            for item in value[:_ROWS]
        )
        more = f"<caption>{_ROWS} of {len(value)} rows</caption>" if len(value) > _ROWS else ""
        return f"<table>{more}<tr>{head}</tr>{rows}</table>"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, int) and not isinstance(value, bool):
        return f"{value:,}"
    return html.escape("" if value is None else str(value))


def _record(text: str) -> Any:
    return json.loads(text, object_hook=Record)


def _with(self: _qrt.Scene, set: Mapping[str, Any]) -> _qrt.Scene:
    """The scene with other values: `scene.with_({"sampling.path_bits": 4})`, keys and values as in `load`.

    The scene itself stays as it is. Raises SceneError with everything that is wrong.
    """
    return self._with(_sets(set))


def _inspect(
    self: _qrt.Scene,
    channel: Literal["r", "g", "b"] | None = None,
    pixel: tuple[int, int] | None = None,
    *,
    seed: int = 0,
) -> Record:
    """The costs of an oracle and its parts: the record of `qrt inspect --json`.

    With `pixel` it is the oracle of that pixel, which `oracle` returns and `qrt export` writes. Without it, it is
    the oracle of all pixels of a class with the most Toffolis, of `channel` if there is one.

    >>> scene.inspect(pixel=(1, 0)).complete_qubits["4"]    # all of counting with t = 4
    >>> [(block.name, block.total.toffoli) for block in scene.inspect().blocks]
    """
    return _record(_qrt.inspect(self, channel, pixel, seed))


def _pareto(
    self: _qrt.Scene,
    channel: Literal["r", "g", "b"] | None = None,
    pixel: tuple[int, int] | None = None,
    *,
    threads: int | None = None,
    progress: Any = None,
) -> Record:
    """Qubits against Toffolis of an oracle under every strategy of `circuit.uncompute`: those that no other beats,
    the record of `qrt inspect --pareto --json`.

    >>> [(layout.qubits, layout.toffoli, layout.strategy) for layout in scene.pareto().front]
    """
    return _record(_qrt.pareto(self, channel, pixel, threads, progress))


def _verify(
    self: _qrt.Scene,
    *,
    pixels: int = 16,
    seed: int = 0,
    threads: int | None = None,
    progress: Any = None,
) -> Record:
    """Run the same paths on the models real, fixed and gates, and compare them: the record of `qrt verify --json`.

    `holds` says whether fixed and gates agree bit for bit and every ancilla returns to zero. It does not raise
    where they differ.

    >>> assert scene.verify(pixels=4).holds
    """
    return _record(_qrt.verify(self, pixels, seed, threads, progress))


def _plan(self: _qrt.Scene) -> Record:
    """The parameters that are chosen for the scene's `accuracy`, and the errors that are expected of them.

    Raises RequestError for a scene that asks for no accuracy, or whose accuracy cannot be kept.

    >>> scene.plan().path_bits      # of a scene with accuracy: { error: 0.1, confidence: 0.9 }
    """
    return _record(_qrt.plan(self))


def _trade(
    self: _qrt.Scene,
    folder: str | os.PathLike[str] | None = None,
    *,
    quick: bool = False,
    pixels: int | None = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Any = None,
) -> Record:
    """Measure what the scene's accuracy costs, parameter by parameter, as `qrt trade` does.

    `rows` has a record for each setting, by the columns of `trade.csv`. The table, plots and a page are written to
    `folder`, if there is one; called again after an interruption, it goes on from there.

    >>> min((row.e_total, row.sweep) for row in scene.trade(quick=True).rows)
    """
    if folder is not None:
        return _record(_qrt.trade_in(self, folder, quick, pixels, seed, threads, progress))
    with tempfile.TemporaryDirectory() as other:
        return _record(_qrt.trade_in(self, other, quick, pixels, seed, threads, progress))


def _simulate(
    self: _qrt.Scene,
    channel: Literal["r", "g", "b"] | None = None,
    pixel: tuple[int, int] | None = None,
    *,
    phase_bits: int | None = None,
    window: Literal["rect", "sine"] | None = None,
    shots: int | None = None,
    seed: int = 0,
) -> Record:
    """Run a pixel's complete counting circuit as amplitudes: the record of `qrt simulate --json`.

    The circuit is that of `oracle(channel, pixel).qasm(part="counting")`. `outcomes` has the probability of each
    outcome beside that of theory. Path index, comparator and phase register together have at most 24 qubits.

    >>> scene.simulate(pixel=(1, 0), phase_bits=3).largest_difference < 1e-12
    """
    return _record(_qrt.simulate_pixel(self, channel, pixel, phase_bits, window, shots, seed))


def _count(
    self: _qrt.Scene,
    channel: Literal["r", "g", "b"] | None = None,
    pixel: tuple[int, int] | None = None,
    *,
    phase_bits: int | None = None,
    window: Literal["rect", "sine"] | None = None,
    outcomes: Sequence[int] = (),
    shots: int | None = None,
    seed: int = 0,
) -> Record:
    """The distribution of the phase register's outcomes for a pixel, by theory: `qrt.count` of the pixel's S and N.

    S is counted path by path. Draws use `seed`, which is the key of the paths' shifts too.

    >>> scene.count(pixel=(1, 0), phase_bits=6).outcomes[0].probability
    """
    oracle = self.oracle(channel, pixel, seed=seed)
    return count(
        oracle.good,
        oracle.total,
        oracle.phase_bits if phase_bits is None else phase_bits,
        window=oracle.window if window is None else window,
        outcomes=outcomes,
        shots=shots,
        seed=seed,
    )


def count(
    good: int,
    total: int,
    phase_bits: int,
    *,
    window: Literal["rect", "sine"] = "rect",
    outcomes: Sequence[int] = (),
    shots: int | None = None,
    seed: int = 0,
) -> Record:
    """The distribution of quantum counting's outcomes for S = `good` of N = `total`: the record of
    `qrt count --json`.

    A phase register of `phase_bits` qubits (1 to 40) is read as y in 0..2**(phase_bits - 1). `window` is "rect" or
    "sine". Only `outcomes` are listed if there are any; otherwise all, or above 16 phase bits those about the peak.
    With `shots`, as many outcomes are drawn with `seed`, and S is estimated from them.

    >>> qrt.count(300, 1000, 6, shots=5, seed=1).estimate.good
    """
    return _record(_qrt.count(good, total, phase_bits, window, list(outcomes), shots, seed))


def _counts(self: _qrt.Oracle) -> Record | None:
    """S by the oracle's program beside S of the same paths in real numbers: `inspect(pixel=...).counts`.

    `differing` is the number of paths that count differently: for these the circuit has too few fraction bits.
    `agrees_at` is the least number, of at most eight more, with which no path differs, or None. There is no record
    if there are more than 2**16 paths, if tracing them takes too long, or for a channel that is not a colour.

    >>> assert oracle.counts.differing == 0     # each path counts as in real numbers
    """
    text = self._counts()
    return None if text is None else _record(text)


def extend(scene: Any, oracle: Any) -> None:
    """Gives the native classes these as methods, and `counts` as a property."""
    oracle.counts = property(_counts)
    _with.__name__ = "with_"
    scene.with_ = _with
    for method in (_inspect, _pareto, _verify, _plan, _trade, _simulate, _count):
        method.__name__ = method.__name__.removeprefix("_")
        setattr(scene, method.__name__, method)
