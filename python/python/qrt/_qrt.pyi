import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, final

import cirq
import numpy
import numpy.typing as npt
from qiskit import QuantumCircuit
from qiskit_algorithms import EstimationProblem
from typing_extensions import Unpack

from ._options import RenderOptions
from ._records import Record

__all__ = [
    "Device",
    "Oracle",
    "Picture",
    "Scene",
    "__version__",
    "count",
    "inspect",
    "load",
    "merge",
    "pareto",
    "parse",
    "plan",
    "restore",
    "simulate_pixel",
    "trade_in",
    "verify",
]

__version__: str

_Path = str | os.PathLike[str]
_Progress = bool | Callable[[int, int], object] | None
_Channel = Literal["r", "g", "b"]
_Model = Literal["real", "fixed", "gates"]
_Window = Literal["rect", "sine"]
_Part = Literal["oracle", "grover", "counting"]

@final
class Scene:
    @property
    def name(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fingerprint(self) -> str: ...
    def to_yaml(self) -> str: ...
    def render(
        self,
        *,
        model: _Model = "real",
        estimator: str | None = None,
        seed: int = 0,
        crop: tuple[int, int, int, int] | None = None,
        colour: Literal["three-runs", "one-run"] = "three-runs",
        noise: str | None = None,
        visibility: Literal["classical", "exhaustive", "grover"] = "classical",
        search_failure: float | None = None,
        first_guess: Literal["random", "coherent"] | None = None,
        threads: int | None = None,
        max_memory: int | None = None,
        progress: _Progress = None,
        checkpoint: _Path | None = None,
        resume: bool = False,
    ) -> Picture: ...
    def render_portion(self, k: int, n: int, **options: Unpack[RenderOptions]) -> bytes: ...
    def paths(
        self,
        pixel: tuple[int, int] | None = None,
        *,
        model: _Model = "real",
        seed: int = 0,
    ) -> npt.NDArray[numpy.float64]: ...
    def oracle(
        self,
        channel: _Channel | None = None,
        pixel: tuple[int, int] | None = None,
        *,
        seed: int = 0,
    ) -> Oracle: ...
    def with_(self, set: Mapping[str, Any]) -> Scene: ...
    def _with(self, sets: Sequence[str]) -> Scene: ...
    def inspect(
        self,
        channel: _Channel | None = None,
        pixel: tuple[int, int] | None = None,
        *,
        seed: int = 0,
    ) -> Record: ...
    def pareto(
        self,
        channel: _Channel | None = None,
        pixel: tuple[int, int] | None = None,
        *,
        threads: int | None = None,
        progress: _Progress = None,
    ) -> Record: ...
    def verify(
        self,
        *,
        pixels: int = 16,
        seed: int = 0,
        threads: int | None = None,
        progress: _Progress = None,
    ) -> Record: ...
    def plan(self) -> Record: ...
    def trade(
        self,
        folder: _Path | None = None,
        *,
        quick: bool = False,
        pixels: int | None = None,
        seed: int = 0,
        threads: int | None = None,
        progress: _Progress = None,
    ) -> Record: ...
    def simulate(
        self,
        channel: _Channel | None = None,
        pixel: tuple[int, int] | None = None,
        *,
        phase_bits: int | None = None,
        window: _Window | None = None,
        shots: int | None = None,
        seed: int = 0,
    ) -> Record: ...
    def count(
        self,
        channel: _Channel | None = None,
        pixel: tuple[int, int] | None = None,
        *,
        phase_bits: int | None = None,
        window: _Window | None = None,
        outcomes: Sequence[int] = (),
        shots: int | None = None,
        seed: int = 0,
    ) -> Record: ...
    def mitsuba(self, stem: str = "scene") -> tuple[str, dict[str, bytes]]: ...

@final
class Picture:
    @property
    def pixels(self) -> npt.NDArray[numpy.float64]: ...
    @property
    def amplitudes(self) -> npt.NDArray[numpy.float64]: ...
    @property
    def good(self) -> npt.NDArray[numpy.uint64] | None: ...
    @property
    def widths(self) -> npt.NDArray[numpy.float64]: ...
    @property
    def strata(self) -> npt.NDArray[numpy.uint8]: ...
    @property
    def queries(self) -> npt.NDArray[numpy.uint64]: ...
    @property
    def scales(self) -> npt.NDArray[numpy.float64]: ...
    @property
    def total(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def crop(self) -> tuple[int, int, int, int]: ...
    @property
    def seed(self) -> int: ...
    @property
    def model(self) -> _Model: ...
    @property
    def estimator(self) -> str: ...
    @property
    def seconds(self) -> float: ...
    @property
    def paths(self) -> int: ...
    @property
    def mean(self) -> tuple[float, float, float]: ...
    @property
    def metadata(self) -> dict[str, str]: ...
    def save(
        self, path: _Path, *, exposure: float | None = None, layers: Scene | None = None
    ) -> int: ...
    def save_counts(self, path: _Path) -> None: ...
    def png(self, exposure: float | None = None) -> bytes: ...
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> numpy.ndarray: ...
    def _repr_html_(self) -> str: ...

@final
class Oracle:
    @property
    def scene(self) -> Scene: ...
    @property
    def channel(self) -> _Channel: ...
    @property
    def pixel_class(self) -> Literal["all", "may-see-lamp", "sees-no-lamp"]: ...
    @property
    def pixel(self) -> tuple[int, int]: ...
    @property
    def seed(self) -> int: ...
    @property
    def qubits(self) -> int: ...
    @property
    def toffoli(self) -> int: ...
    @property
    def and_measured(self) -> int: ...
    @property
    def cnot(self) -> int: ...
    @property
    def x(self) -> int: ...
    @property
    def toffoli_depth(self) -> int: ...
    @property
    def path_bits(self) -> int: ...
    @property
    def comparator_bits(self) -> int: ...
    @property
    def phase_bits(self) -> int: ...
    @property
    def window(self) -> _Window: ...
    @property
    def scale(self) -> float: ...
    @property
    def total(self) -> int: ...
    @property
    def good(self) -> int: ...
    @property
    def amplitude(self) -> float: ...
    @property
    def counts(self) -> Record | None: ...
    def _counts(self) -> str | None: ...
    @property
    def thresholds(self) -> npt.NDArray[numpy.int64]: ...
    def device(self, seed: int = 0, *, noise: str | None = None) -> Device: ...
    def qasm(
        self,
        version: Literal[2, 3] = 3,
        part: _Part = "oracle",
        *,
        max_gates: int = 50_000_000,
    ) -> str: ...
    def logical_counts(
        self,
        of: Literal["oracle", "channel", "pixel", "film"] = "oracle",
        *,
        measured: bool = True,
    ) -> dict[str, int]: ...
    def to_qiskit(self, part: _Part = "oracle") -> QuantumCircuit: ...
    def to_pennylane(self, part: _Part = "oracle") -> Callable[..., Any]: ...
    def to_cirq(self, part: _Part = "oracle") -> cirq.Circuit: ...
    def estimation_problem(self) -> EstimationProblem: ...
    def _repr_html_(self) -> str: ...

@final
class Device:
    def shot(self, k: int = 0) -> bool: ...
    def shots(self, k: int, shots: int) -> int: ...
    def phases(
        self, phase_bits: int, shots: int = 1, *, window: _Window = "rect"
    ) -> list[int]: ...
    @property
    def total(self) -> int: ...
    @property
    def queries(self) -> int: ...
    @property
    def measured(self) -> int: ...

def load(path: _Path, sets: Sequence[str], allow_files: Sequence[_Path]) -> Scene: ...
def parse(
    text: str, name: str, sets: Sequence[str], folder: _Path, allow_files: Sequence[_Path]
) -> Scene: ...
def restore(
    text: str, name: str, sets: list[str], files: list[tuple[str, bytes]], fingerprint: str
) -> Scene: ...
def merge(parts: Iterable[tuple[str, bytes]]) -> Picture: ...
def inspect(
    scene: Scene, channel: str | None, pixel: tuple[int, int] | None, seed: int
) -> str: ...
def pareto(
    scene: Scene,
    channel: str | None,
    pixel: tuple[int, int] | None,
    threads: int | None,
    progress: Any,
) -> str: ...
def verify(
    scene: Scene, pixels: int, seed: int, threads: int | None, progress: Any
) -> str: ...
def plan(scene: Scene) -> str: ...
def trade_in(
    scene: Scene,
    folder: _Path,
    quick: bool,
    pixels: int | None,
    seed: int,
    threads: int | None,
    progress: Any,
) -> str: ...
def simulate_pixel(
    scene: Scene,
    channel: str | None,
    pixel: tuple[int, int] | None,
    phase_bits: int | None,
    window: str | None,
    shots: int | None,
    seed: int,
) -> str: ...
def count(
    good: int,
    total: int,
    phase_bits: int,
    window: str,
    outcomes: Sequence[int],
    shots: int | None,
    seed: int,
) -> str: ...
