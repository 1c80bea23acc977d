"""Calibration and error tracing for robots. Arrays are numpy arrays of 64-bit floats; ``[T, I]`` is a row a sample, a column an input."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Protocol, TypeAlias, overload

import numpy as np
import numpy.typing as npt

__version__: str

class ArrowFrame(Protocol):
    """A DataFrame of pandas or polars, a table of pyarrow, a :class:`Frame`."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

_Path: TypeAlias = str | PathLike[str]
_Data: TypeAlias = "Recordings | _Path"
_Settings: TypeAlias = Mapping[str, Any]
_Progress: TypeAlias = Callable[[str], object] | bool | None
_Signals: TypeAlias = Sequence[str | Mapping[str, str]] | Mapping[str, str]
_Effects: TypeAlias = "_Path | Effect | Sequence[_Path | Effect | Mapping[str, Any]]"
_Array: TypeAlias = npt.NDArray[np.float64]

class AcmError(Exception):
    """What acm refuses, and why: the text of the programs."""

class ConfigError(AcmError):
    """What was asked cannot be done: a value, a key or a combination of them (exit code 2)."""

class DataError(AcmError):
    """Recordings or records that cannot be used; the text names file, row and column (exit code 3)."""

class FileError(AcmError):
    """A file or folder that cannot be read or written (exit code 4)."""

class BusyError(AcmError):
    """Another process works in the folder (exit code 5)."""

class Frame:
    """A table of results. ``polars.DataFrame(frame)`` and ``pandas.DataFrame.from_arrow(frame)`` take it."""

    @property
    def columns(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, name: str) -> _Array | list[str | None]:
        """A column: numbers ``[rows]``, nan where a cell is empty, or words, None where one is."""
    def to_dict(self) -> dict[str, _Array | list[str | None]]: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

class Text:
    """What a program prints."""

    def __contains__(self, part: str) -> bool: ...

class Recordings:
    """Recordings of a robot, checked, in SI units."""

    @classmethod
    def from_frame(
        cls,
        frame: ArrowFrame,
        *,
        time: str | Mapping[str, Any],
        actuators: _Signals,
        outputs: _Signals,
        trial: str | None = None,
        context: _Signals | None = None,
        predicted: _Signals | None = None,
        units: Mapping[str, str] | None = None,
        calibration: Sequence[str] | None = None,
        development: Sequence[str] | None = None,
        held_out: Sequence[str] | None = None,
        excluded: Sequence[str] | None = None,
        manifest: _Settings | None = None,
    ) -> Recordings:
        """Recordings in a frame, in the words of a manifest.

        ``time`` is a column (unit of ``units``, else s) or ``{"rate_hz": 100.0}``; ``trial`` is the column of the trials' names, and without it all
        rows are one trial. Signals are lists of columns (units of ``units``, else 1), dictionaries of columns and units, or lists of
        dictionaries as in ``[[actuator]]``. Trials without another role develop. ``manifest`` has further keys: ``{"arm": {...}}``.
        """
    @property
    def name(self) -> str: ...
    @property
    def folder(self) -> Path: ...
    @property
    def hash(self) -> str:
        """SHA-256 of manifest and tables."""
    @property
    def warnings(self) -> list[str]: ...
    @property
    def manifest(self) -> dict[str, Any]: ...
    @property
    def trials(self) -> Frame:
        """trial, role, samples, duration (s), left_out (samples)."""
    @property
    def signals(self) -> Frame:
        """signal, kind, unit (SI)."""
    def __getitem__(self, trial: str) -> dict[str, _Array]:
        """``time`` (s) and each signal (SI) of a trial, ``[T]``: views that cannot be written."""
    def __len__(self) -> int: ...
    def __contains__(self, trial: str) -> bool: ...
    def with_nominal(self, model: Callable[[dict[str, _Array]], Any]) -> Recordings:
        """The same recordings with the predictions of a nominal model of one's own.

        ``model`` is called with each trial: a dictionary of arrays ``[T]``, ``time`` in s, then actuators, contexts and conditions in the units of the
        manifest. It gives an array ``[T, O]``, ``[T]`` of one output, or a dictionary of arrays by output, in the units of the outputs.
        """
    def save(self, folder: _Path) -> Recordings:
        """Keeps a frame's recordings in a folder that the programs read."""

class Finding:
    """What the loop found."""

    @property
    def sentence(self) -> str: ...
    @property
    def verdict(self) -> str: ...
    @property
    def confirmation(self) -> Literal["confirmed", "open", "refuted", "not_tested"]: ...
    @property
    def effects(self) -> Frame:
        """effect, meaning, carrier, parameter, value, low, high, unit (SI; low and high: 95 %), size (SI), share, confidence."""
    @property
    def table(self) -> Frame | None:
        """Errors on held-out trials before and after, SI."""
    @property
    def tables(self) -> dict[str, Frame]: ...
    @property
    def cautions(self) -> list[str]: ...
    @property
    def model(self) -> Model: ...
    @property
    def folder(self) -> Path | None: ...
    @property
    def page(self) -> Path | None: ...
    def to_dict(self) -> dict[str, Any]:
        """Everything, as in ``loop.json``."""
    def save(self, folder: _Path) -> Path:
        """Writes page, figures, tables, ``loop.json`` and ``model.json``; returns the page's path."""
    def _repr_html_(self) -> str: ...

class Model:
    """The nominal model with what it lacked."""

    def save(self, path: _Path) -> None: ...
    def estimator(self) -> Estimator: ...
    def to_dict(self) -> dict[str, Any]: ...

class Separability:
    """What these trials can tell apart."""

    @property
    def effects(self) -> list[str]: ...
    @property
    def groups(self) -> list[dict[str, Any]]: ...
    @property
    def tables(self) -> dict[str, Frame]: ...
    def to_dict(self) -> dict[str, Any]: ...
    def save(self, folder: _Path) -> Path: ...
    def _repr_html_(self) -> str: ...

class Run:
    """A run folder of acm-train."""

    def __init__(self, folder: _Path) -> None: ...
    @property
    def folder(self) -> Path: ...
    @property
    def records(self) -> list[dict[str, Any]]:
        """As in ``records/*.json``."""
    @property
    def scores(self) -> Frame:
        """run, stage, seed, part, estimator, rmse (SI), samples."""
    def estimator(
        self, *, network: str | None = None, windows: bool = False, everywhere: bool = False, tables: _Path | None = None
    ) -> Estimator: ...
    def report(self, out: _Path | None = None) -> Report: ...
    def __fspath__(self) -> str: ...

class Report:
    """Runs and studies on one page."""

    @property
    def page(self) -> Path: ...
    @property
    def tables(self) -> dict[str, dict[str, Frame]]:
        """By chapter and name."""
    def _repr_html_(self) -> str: ...

class Estimator:
    """A nominal model, with a network or without one, under way through a trial, in the units of the manifest."""

    @staticmethod
    def load(
        run: _Path,
        *,
        network: str | None = None,
        windows: bool = False,
        everywhere: bool = False,
        tables: _Path | None = None,
    ) -> Estimator:
        """Of a run folder, of a study of the best model, or of a file that ``acm-eval stream --save`` wrote (SI units)."""
    @property
    def inputs(self) -> list[str]: ...
    @property
    def outputs(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    def step(self, x: Sequence[float] | _Array, dt: float = 0.0) -> _Array:
        """Outputs ``[O]`` at the next sample: ``x`` is ``[I]``, ``dt`` the time since the sample before, s."""
    def predict(
        self, x: npt.ArrayLike | ArrowFrame, time: npt.ArrayLike | None = None, *, trial: str | None = None
    ) -> _Array | Frame:
        """Outputs of a whole trial: ``[T, O]`` of inputs ``[T, I]`` and times ``[T]``, or a frame of a frame with columns by name."""
    @property
    def nominal(self) -> _Array:
        """Of the last sample, ``[O]``."""
    @property
    def in_range(self) -> bool | None: ...
    @property
    def history(self) -> int: ...
    @property
    def interval(self) -> list[tuple[float, float]] | None: ...
    def restart(self) -> None: ...

class Effect:
    """An effect of one's own. Called, it is the function that it was made of."""

    name: str
    definition: dict[str, Any]
    function: Callable[..., Any]
    def __init__(self, function: Callable[..., Any], definition: dict[str, Any]) -> None: ...
    def __call__(self, *arguments: Any, **options: Any) -> Any: ...
    @property
    def text(self) -> str:
        """As it stands in an effect file."""
    def save(self, path: _Path) -> None:
        """Writes an effect file, which ``acm-eval close-loop --effects`` reads."""

@overload
def effect(
    function: Callable[..., Any],
    *,
    place: Literal["actuators", "outputs", "frame"],
    form: Literal["static", "update", "rate"] = "static",
    parameters: Mapping[str, Mapping[str, Any]],
    inputs: Mapping[str, Mapping[str, Any]] | None = None,
    constants: Mapping[str, Mapping[str, Any]] | None = None,
    output: str | Callable[..., Any] | None = None,
    start: Any = None,
    **more: Any,
) -> Effect: ...
@overload
def effect(
    function: None = None,
    *,
    place: Literal["actuators", "outputs", "frame"],
    form: Literal["static", "update", "rate"] = "static",
    parameters: Mapping[str, Mapping[str, Any]],
    inputs: Mapping[str, Mapping[str, Any]] | None = None,
    constants: Mapping[str, Mapping[str, Any]] | None = None,
    output: str | Callable[..., Any] | None = None,
    start: Any = None,
    **more: Any,
) -> Callable[[Callable[..., Any]], Effect]:
    """Makes an effect of a function whose arguments are named as in an effect file.

    ``place`` is ``"actuators"``, ``"outputs"`` or ``"frame"``. The function is called once, with symbols: it uses operators and functions of numpy. It
    returns the column as it leaves (``form="static"``), or a dictionary of each state: its next value (``form="update"``) or its time derivative
    (``form="rate"``); a function of one state may return its value alone. ``output`` is a function of the column as it leaves, from the states; left
    out, it is the one state. ``start`` holds the states at the first sample. ``parameters``, ``inputs``, ``constants`` and further keys are those of
    an effect file.
    """

def read(folder: _Path, *, tables: _Path | None = None) -> Recordings:
    """Reads a folder with ``manifest.toml``, and checks everything."""

def check(data: _Data, *, tables: _Path | None = None, window: int = 50, max_gap: float | None = None) -> Text:
    """What ``acm-data check`` says; ``window`` in samples, ``max_gap`` in s (default: five usual steps of the trial, at least 0.5 s)."""

def describe(data: _Data, *, tables: _Path | None = None, max_gap: float | None = None) -> Text:
    """What ``acm-data describe`` prints; ``max_gap`` as of :func:`check`."""

def close_loop(
    data: _Data | None = None,
    config: _Settings | _Path | None = None,
    *,
    effects: _Effects | None = None,
    set: _Settings | None = None,
    tables: _Path | None = None,
    out: _Path | None = None,
    progress: _Progress = None,
) -> Finding:
    """Finds the physical effect that a nominal model lacks, as ``acm-eval close-loop``.

    ``effects`` are tried beside those of the library: an effect file, an :class:`Effect`, or a list of them.
    """

def separability(
    data: _Data | None = None,
    config: _Settings | _Path | None = None,
    *,
    effects: _Effects | None = None,
    set: _Settings | None = None,
    tables: _Path | None = None,
    out: _Path | None = None,
    progress: _Progress = None,
) -> Separability:
    """Says which effects the trials could tell apart, as ``acm-eval separability``."""

def train(
    config: _Settings | _Path | None = None,
    *,
    data: _Data | None = None,
    out: _Path | None = None,
    nominal: Model | _Path | None = None,
    set: _Settings | None = None,
    tables: _Path | None = None,
    resume: bool = False,
    jobs: int | None = None,
    threads: int | None = None,
    progress: _Progress = None,
) -> Run:
    """Trains as ``acm-train --config``; Ctrl-C stops after the epoch, and ``resume=True`` goes on with the same bits."""

def report(runs: Run | _Path | Sequence[Run | _Path], *, out: _Path | None = None) -> Report:
    """Runs and studies on one page, as ``acm-eval report``."""
