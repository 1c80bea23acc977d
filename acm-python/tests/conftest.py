"""A robot whose output is late, as a frame; a network that is trained on another; and the programs to compare with.

The late rig: x(t) = 0.1 q(t - 0.3 s) + 0.02 q(t - 0.3 s)^2 + noise of 0.5 mm, with q(t) = sum of sines. Trial c1 is ten times slower, so that a
delay hardly shows in it.
"""

import json
import os
import pathlib
import subprocess

import numpy as np
import pandas as pd
import pytest

import acm

DELAY = 0.3
TRIALS = ["c1", "d1", "d2", "d3", "d4", "h1", "h2"]
COLUMNS = dict(
    time="t",
    trial="trial",
    actuators={"q": "rad"},
    outputs=["x"],
    units={"x": "m"},
    calibration=["c1"],
    held_out=["h1", "h2"],
    manifest={"name": "late", "synthetic": True},
)
EXPERIMENT = {
    "network": {"kind": "gru", "units": 6},
    "windows": {"length": 8, "reach": 8, "max_gap": 0.5},
    "training": {"epochs": 4, "batch": 32},
    "inputs": {"domain_filter": "box"},
    "protocol": {"seeds": [1, 2], "cross_validation": False},
}


def position(trial, t):
    """The actuator at times ``t``, rad."""
    phase, slow = 1.7 * trial, 0.1 if trial == 0 else 1.0
    parts = [(0.6, 0.9, 1.0), (0.35, 2.3, 2.1), (0.2, 5.1, 0.6)]
    return sum(size * np.sin(omega * slow * t + shift * phase) for size, omega, shift in parts)


def late_frame(delay=DELAY, samples=400, rate=20.0):
    """Seven trials on top of each other."""
    noise = np.random.default_rng(7)
    t = np.arange(samples) / rate
    trials = []
    for number, name in enumerate(TRIALS):
        late = position(number, t - delay)
        x = 0.1 * late + 0.02 * late**2 + 5e-4 * noise.standard_normal(samples)
        trials.append(pd.DataFrame({"trial": name, "t": t, "q": position(number, t), "x": x, "unused": [object()] * samples}))
    frame = pd.concat(trials, ignore_index=True)
    return frame.drop(columns="unused")


def program(name, *arguments, text=None, cwd=None):
    """What a program of the workspace does."""
    folder = pathlib.Path(os.environ["ACM_PROGRAMS"])
    return subprocess.run([folder / name, *map(str, arguments)], input=text, cwd=cwd, capture_output=True, text=True)


@pytest.fixture(scope="session")
def frame():
    return late_frame()


@pytest.fixture(scope="session")
def recordings(frame):
    return acm.Recordings.from_frame(frame, **COLUMNS)


@pytest.fixture(scope="session")
def finding(recordings):
    return acm.close_loop(recordings, progress=False)


@pytest.fixture(scope="session")
def saved(recordings, tmp_path_factory):
    """The same recordings in a folder that the programs read."""
    folder = tmp_path_factory.mktemp("data") / "late"
    return recordings.save(folder)


@pytest.fixture(scope="session")
def run(saved, tmp_path_factory):
    return acm.train(EXPERIMENT, data=saved, out=tmp_path_factory.mktemp("runs") / "gru", progress=False)


def loaded(path):
    return json.loads(pathlib.Path(path).read_text())
