"""Effects whose equations are Python functions: found, saved and streamed as those of an effect file."""

import math

import numpy as np
import pandas as pd
import pytest

import acm
from conftest import loaded, program

GAIN, TAU = -0.3, 2.0

HEATING = """
[[effect]]
name    = "self_heating"
meaning = "The gain of an actuator changes with the heat of its own load"
place   = "actuators"
unit    = "rad"
rate    = { heat = "((q/full)^2 - heat)/tau" }
output  = "q*(1 + g*heat)"
[effect.constants]
full = { value = 1, unit = "rad" }
[effect.parameters]
g   = { silent = 0, bounds = [-0.9, 0.9], guesses = [-0.3, -0.1, 0.1, 0.3] }
tau = { unit = "s", bounds = [0.1, 20], guesses = [0.5, 1.5, 5] }
"""


@acm.effect(
    place="actuators",
    form="rate",
    unit="rad",
    constants={"full": {"value": 1, "unit": "rad"}},
    parameters={
        "g": {"silent": 0, "bounds": [-0.9, 0.9], "guesses": [-0.3, -0.1, 0.1, 0.3]},
        "tau": {"unit": "s", "bounds": [0.1, 20], "guesses": [0.5, 1.5, 5]},
    },
    output=lambda q, heat, g: q * (1 + g * heat),
)
def self_heating(q, heat, tau, full):
    """The gain of an actuator changes with the heat of its own load."""
    return ((q / full) ** 2 - heat) / tau


@pytest.fixture(scope="module")
def heated():
    """Six trials, simulated in steps of a millisecond, with noise of 0.3 mm."""
    noise, trials = np.random.default_rng(3), []
    t = np.arange(0.0, 25.0, 1e-3)
    for number, name in enumerate(["d1", "d2", "d3", "d4", "h1", "h2"]):
        q = 0.7 * np.sin(0.9 * t + 1.7 * number) + 0.4 * np.sin(2.3 * t + 3.57 * number)
        heat = np.zeros_like(t)
        for k in range(1, t.size):
            heat[k] = heat[k - 1] + 1e-3 * (q[k - 1] ** 2 - heat[k - 1]) / TAU
        p = q * (1 + GAIN * heat)
        x = 0.1 * p + 0.02 * p**2
        rows = slice(None, None, 50)
        x = x[rows] + 3e-4 * noise.standard_normal(x[rows].size)
        trials.append(pd.DataFrame({"trial": name, "t": t[rows], "q": q[rows], "x": x}))
    return acm.Recordings.from_frame(
        pd.concat(trials, ignore_index=True), time="t", trial="trial", actuators={"q": "rad"}, outputs={"x": "m"}, held_out=["h1", "h2"]
    )


def test_an_effect_of_a_function_is_found_as_that_of_a_file(heated, tmp_path):
    """Oracle: the planted values, and the program with the equation as text."""
    finding = acm.close_loop(heated, effects=[self_heating], progress=False)
    found = dict(zip(finding.effects["parameter"], finding.effects["value"]))
    assert set(finding.effects["effect"]) == {"self_heating"}
    assert found["g"] == pytest.approx(GAIN, rel=0.15) and found["tau"] == pytest.approx(TAU, rel=0.15)
    assert finding.effects["meaning"][0] == "The gain of an actuator changes with the heat of its own load"
    (tmp_path / "heating.toml").write_text(HEATING)
    self_heating.save(tmp_path / "saved.toml")
    folder = heated.save(tmp_path / "data").folder
    for file in ("heating.toml", "saved.toml"):
        done = program("acm-eval", "close-loop", folder, "--effects", tmp_path / file, "--out", tmp_path / file[:-5])
        assert done.returncode == 0, done.stderr
        told = loaded(tmp_path / file[:-5] / "loop.json")
        for own, theirs in zip(finding.to_dict()["effects"], told["effects"], strict=True):
            assert own["parameters"] == theirs["parameters"]
    by_file = acm.close_loop(heated, effects=tmp_path / "heating.toml", progress=False)
    assert by_file.effects.to_dict()["value"].tolist() == finding.effects.to_dict()["value"].tolist()
    trial = heated["h1"]
    predicted = finding.model.estimator().predict(trial["q"][:, None], trial["time"])
    assert np.sqrt(np.mean((predicted[:, 0] - trial["x"]) ** 2)) < 4.5e-4, "the noise is 0.3 mm"


def test_a_function_is_still_one():
    assert self_heating(q=2.0, heat=1.0, tau=3.0, full=1.0) == 1.0
    assert self_heating.name == "self_heating" and "rate" in repr(self_heating)


def value(text, names):
    """Oracle: Python's own reading of an expression; its `**` binds as `^`, and `&`, `|` are within brackets there."""
    known = {"abs": abs, "sign": np.sign, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "tanh": np.tanh, "sin": np.sin, "cos": np.cos}
    known |= {"tan": np.tan, "atan": np.arctan, "atan2": np.arctan2, "min": min, "max": max, "choose": lambda c, a, b: a if c else b}
    text = text.replace("^", "**").replace("if(", "choose(").replace("&&", " and ").replace("||", " or ").replace("!", " not ").replace(" not =", "!=")
    return eval(text, known | names)


@pytest.mark.parametrize(
    "function",
    [
        lambda y, f: y - (f - 2) - (y + f) * 3 / (y * f),
        lambda y, f: -(y**2) + (-y) ** 2 + 2 ** (y - f) + abs(y) ** -f + (abs(y) ** f) ** 2,
        lambda y, f: np.where((y > 0) & (f <= 0.5) | ~(y != f), -y, y / -f),
        lambda y, f: np.clip(y, -f, f) + np.clip(y, None, 0.1) + np.minimum(y, f) * np.maximum(f, 0.3),
        lambda y, f: np.tanh(y / f) + np.sqrt(abs(y)) * np.sign(f) - np.arctan2(y, f) + np.exp(-(y**2)) + np.log(f) + np.square(y),
        lambda y, f: np.float64(1.5) * y - 1e-30 * f + 3e20 * y / (f / (y / f)) + np.int64(2),
        lambda y, f: ((y < f) == (f < 2)) * y + True * f,
    ],
)
def test_what_is_recorded_is_what_is_computed(function):
    recorded = acm._effects._outputs(function, function(**acm._effects._symbols(function)))
    for y, f in [(0.7, 0.3), (-0.7, 0.3), (0.2, 1.9), (-2.5, 0.5), (0.3, 0.3)]:
        told, done = value(recorded, {"y": y, "f": f}), function(np.float64(y), np.float64(f))
        assert np.isclose(told, done, rtol=1e-14, atol=0, equal_nan=True), recorded


@pytest.mark.parametrize(
    ("function", "why"),
    [
        (lambda y, f: y if y > 0 else f, "numpy.where"),
        (lambda y, f: y + f * math.tanh(y), "functions of numpy"),
        (lambda y, f: y + np.cumsum(f), "numpy.cumsum has no counterpart"),
        (lambda y, f: y + np.sinh(f), "numpy.sinh has no counterpart"),
        (lambda y, f: y + f * np.array([1.0, 2.0]), "one value at a time"),
        (lambda y, f: y + f * math.inf, "no finite number"),
        (lambda y, f: None, "returns nothing"),
        (lambda y, f, gone: y + f * gone, "`gone` is no column"),
        (lambda *all: all[0], "give each argument a name"),
    ],
)
def test_what_cannot_be_recorded_is_refused(function, why):
    function.__name__ = "wrong"
    with pytest.raises(TypeError, match=why):
        acm.effect(function, place="outputs", parameters={"f": {"unit": "y", "silent": 0, "bounds": [-1, 1], "guesses": [0.1]}})


def test_what_the_program_refuses_is_refused_at_once():
    parameters = {"f": {"unit": "y", "silent": 0, "bounds": [-1, 1], "guesses": [0.1]}}
    with pytest.raises(acm.ConfigError, match="units|unit"):

        @acm.effect(place="outputs", parameters=parameters)
        def wrong_unit(y, f):
            return y + f**2

    with pytest.raises(acm.ConfigError, match="bounds"):

        @acm.effect(place="outputs", parameters={"f": {"unit": "y", "silent": 0, "bounds": [1, -1], "guesses": [0.1]}})
        def wrong_bounds(y, f):
            return y + f

    with pytest.raises(TypeError, match="a value for each state"):

        @acm.effect(place="actuators", form="update", parameters={"w": {}})
        def wrong_states(q, p, w):
            return {"other": q}

    with pytest.raises(TypeError, match="give `output`"):

        @acm.effect(place="actuators", form="rate", parameters={"w": {}})
        def no_output(q, z, v, w):
            return {"z": v, "v": q - z - v / w}
