"""Listeners for the progress of a render."""

from __future__ import annotations

import sys
from typing import Any


class _Function:
    """Calls a function of the paths that are done, and all paths."""

    def __init__(self, function: Any):
        self._function = function

    def __call__(self, done: int, total: int) -> None:
        self._function(done, total)

    def close(self) -> None:
        pass


class _Bar:
    """A bar of tqdm: of the terminal, or of the notebook."""

    def __init__(self) -> None:
        self._bar: Any = None

    def __call__(self, done: int, total: int) -> None:
        if self._bar is None:
            from tqdm.auto import tqdm

            self._bar = tqdm(total=total, unit="path", unit_scale=True, leave=False)
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def _is_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return shell is not None and hasattr(shell, "kernel")


def listener(progress: Any) -> Any:
    """A listener for paths done and all paths, closed at the end; None if there is no listener.

    `progress` is a function of the two, False for nobody, True for a bar of tqdm, and None for a bar in a
    terminal or a notebook.
    """
    if callable(progress):
        return _Function(progress)
    if progress is False:
        return None
    if progress is True or _is_notebook() or (sys.stderr and sys.stderr.isatty()):
        return _Bar()
    return None
