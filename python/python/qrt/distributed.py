"""Pictures by pools of processes and clusters.

A pool is whatever has `submit(function, *arguments)` and returns futures with `result()` and
`cancel()`: `concurrent.futures`, `mpi4py.futures.MPIPoolExecutor`, a `distributed.Client`, an executor
of `submitit` or `parsl`. What a worker does is a function of its arguments alone, so that a pool may do a
lost part again, anywhere.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from . import _portions, _qrt
from ._errors import RequestError
from ._progress import listener

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import PictureOptions

__all__ = ["render"]

_TICK = 0.05


def _work(scene: _qrt.Scene, number: int, portions: int, attempt: int, options: dict[str, Any]) -> bytes:
    """A part. A pool that takes equal calls for one, as Dask does, sees that another attempt is
    another call."""
    del attempt
    return _portions.render_portion(scene, number, portions, **options)


def render(
    scene: _qrt.Scene,
    executor: Any,
    *,
    portions: int | None = None,
    retries: int = 2,
    threads: int | None = 1,
    progress: Any = None,
    **options: Unpack[PictureOptions],
) -> _qrt.Picture:
    """Render a scene on the workers of `executor`: the picture of `scene.render(**options)`, bit for
    bit.

    `portions` is the number of portions of the picture, by default 64, or its number of pixels; each is a task
    that takes `threads` threads. A task that fails is submitted again, up to `retries` times; a request
    that can't be met, such as a wrong option, is not. `progress` is told of portions as `Scene.render` is of
    paths. All portions are awaited: there is a whole picture, or the exception of the task that failed last.

    `options` are those of `Scene.render` but for `checkpoint` and `resume`: what is lost of a pool's work
    are single portions, and the pool does them again. A pool that breaks when a worker dies, such as
    ProcessPoolExecutor or MPI's, raises its own exception here (BrokenProcessPool).
    """
    for name in ("checkpoint", "resume"):
        if name in options:
            message = f"{name}= keeps the work of one process: a pool does lost portions again"
            raise RequestError(message)
    if portions is None:
        crop = options.get("crop")
        width, height = crop[2:] if crop else (scene.width, scene.height)
        portions = max(1, min(64, width * height))
    every: dict[str, Any] = dict(options, threads=threads, progress=False)
    parts: dict[int, bytes] = {}
    failures = [0] * portions

    def submit(number: int) -> Any:
        return executor.submit(_work, scene, number, portions, failures[number], every)

    running: dict[int, Any] = {}
    told = listener(progress)
    try:
        running.update((number, submit(number)) for number in range(portions))
        while running:
            finished = [number for number, future in running.items() if future.done()]
            for number in finished:
                future = running.pop(number)
                try:
                    parts[number] = future.result()
                except (TypeError, ValueError):
                    raise
                except Exception:
                    failures[number] += 1
                    if failures[number] > retries:
                        raise
                    running[number] = submit(number)
            if told is not None:
                told(len(parts), portions)
            if not finished:
                time.sleep(_TICK)
    finally:
        for future in running.values():
            future.cancel()
        if told is not None:
            told.close()
    return _portions.merge(parts[number] for number in range(portions))
