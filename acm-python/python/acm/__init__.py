"""Calibration and error tracing for robots: from recordings to the physical effect that a model lacks.

>>> robot = acm.Recordings.from_frame(frame, time="t", trial="trial", actuators=["q1"], outputs=["x"], held_out=["run4"])
>>> finding = acm.close_loop(robot)
>>> run = acm.train({"network": {"kind": "gru"}}, data=robot, nominal=finding.model, out="runs/first")
>>> run.estimator().predict(frame)

Quantities are 64-bit floats in SI units unless a docstring says otherwise. Errors are :class:`AcmError` and its subclasses, with the text of
the programs.
"""

from ._acm import (
    AcmError,
    BusyError,
    ConfigError,
    DataError,
    Estimator,
    FileError,
    Finding,
    Frame,
    Model,
    Recordings,
    Report,
    Run,
    Separability,
    Text,
    __version__,
    check,
    close_loop,
    describe,
    read,
    report,
    separability,
    train,
)
from ._effects import Effect, effect

__all__ = [
    "AcmError",
    "BusyError",
    "ConfigError",
    "DataError",
    "Effect",
    "Estimator",
    "FileError",
    "Finding",
    "Frame",
    "Model",
    "Recordings",
    "Report",
    "Run",
    "Separability",
    "Text",
    "__version__",
    "check",
    "close_loop",
    "describe",
    "effect",
    "read",
    "report",
    "separability",
    "train",
]
