"""The loop: what was planted is named, and every number is that of the command line."""

import numpy as np
import polars as pl
import pytest

import acm
from conftest import COLUMNS, DELAY, late_frame, loaded, program


def timeless(found):
    """Without what differs between two runs: time, and where the data lay."""
    found = dict(found, seconds=None)
    found["configuration"] = dict(found["configuration"], data=None)
    return found


def test_a_planted_dead_time_is_named(finding):
    assert finding.verdict == "named" and finding.confirmation == "confirmed"
    effects = finding.effects.to_polars()
    assert effects["effect"].to_list() == ["dead_time"] and effects["unit"].to_list() == ["s"]
    assert abs(effects["value"][0] - DELAY) < 0.01
    assert effects["low"][0] < effects["value"][0] < effects["high"][0]
    assert "dead time" in finding.sentence and "dead_time" in repr(finding)


def test_every_number_is_that_of_the_command_line(finding, saved, tmp_path):
    done = program("acm-eval", "close-loop", saved.folder, "--out", tmp_path / "loop")
    assert done.returncode == 0, done.stderr
    told = loaded(tmp_path / "loop" / "loop.json")
    assert timeless(finding.to_dict()) == timeless(told)
    value = told["effects"][0]["parameters"][0]
    row = finding.effects
    assert [row[name][0] for name in ("value", "low", "high")] == [value["value"], *value["interval"]]
    errors = [told["errors"]["baselines"][name]["value"] for name in ("nominal", "static_map", "recalibrated")]
    table = finding.table
    assert list(table["Error [m]"])[:4] == errors + [told["errors"]["after"]["value"]]
    own = finding.save(tmp_path / "own")
    assert own.name == "loop.html"
    assert (tmp_path / "own" / "model.json").read_bytes() == (tmp_path / "loop" / "model.json").read_bytes()
    finding.model.save(tmp_path / "alone.json")
    assert (tmp_path / "alone.json").read_bytes() == (tmp_path / "loop" / "model.json").read_bytes()
    assert finding.model.to_dict() == {k: v for k, v in loaded(tmp_path / "alone.json").items() if k != "sha256"}


def test_twelve_lines_from_a_frame_to_a_finding(tmp_path):
    late_frame().to_parquet(tmp_path / "recordings.parquet")
    script = f"""
import acm, pandas as pd
frame = pd.read_parquet({str(tmp_path / "recordings.parquet")!r})
robot = acm.Recordings.from_frame(
    frame, time="t", trial="trial",
    actuators={{"q": "rad"}}, outputs={{"x": "m"}},
    calibration=["c1"], held_out=["h1", "h2"],
)
finding = acm.close_loop(robot, progress=False)
print(finding.sentence)
print(finding.effects.to_pandas())
""".strip()
    assert len(script.splitlines()) <= 12
    names = {}
    exec(script, names)
    assert names["finding"].effects["effect"] == ["dead_time"]


def test_settings_are_those_of_a_configuration(recordings):
    lines = []
    settings = {"effects": {"without": ["dead_time"]}, "search": {"max_effects": 1}}
    found = acm.close_loop(recordings, settings, set={"search.seed": 3}, progress=lines.append)
    told = found.to_dict()
    assert told["configuration"]["effects"]["without"] == ["dead_time"]
    assert told["configuration"]["search"] == {"max_effects": 1, "samples": 3000, "seed": 3}
    assert all(effect["name"] != "dead_time" for effect in told["effects"])
    assert lines and all(isinstance(line, str) for line in lines)


def test_frames_of_pandas_and_polars_give_the_same_finding(finding, frame):
    other = acm.Recordings.from_frame(pl.from_pandas(frame), **COLUMNS)
    again = acm.close_loop(other, progress=False)
    np.testing.assert_array_equal(again.effects["value"], finding.effects["value"])


def test_a_notebook_shows_head_and_figures(finding):
    shown = finding._repr_html_()
    assert shown.startswith("<iframe") and shown.count("&lt;svg") >= 3 and "dead time" in shown
    assert "\"" not in shown.split('srcdoc="')[1].split('" style=')[0]


def test_the_model_predicts_alone(finding, recordings):
    estimator = finding.model.estimator()
    assert estimator.inputs == ["q"] and estimator.outputs == ["x"] and estimator.units == {"q": "rad", "t": "s", "x": "m"}
    trial = recordings["h1"]
    predicted = estimator.predict(trial["q"][:, None], trial["time"])
    after = np.sqrt(np.mean((predicted[20:, 0] - trial["x"][20:]) ** 2))
    assert after < 7e-4, "the noise is 0.5 mm"


def test_separability_is_that_of_the_command_line(saved, tmp_path):
    found = acm.separability(saved, progress=False)
    done = program("acm-eval", "separability", saved.folder, "--out", tmp_path / "apart")
    assert done.returncode == 0, done.stderr
    told = loaded(tmp_path / "apart" / "separability.json")
    own = found.to_dict()
    for found_in in (told, own):
        found_in.pop("seconds", None)
        found_in.pop("configuration", None)
    assert own == told
    assert found.effects == told["effects"] and "dead_time" in found.effects
    assert len(found.tables["pairs"]) == len(found.effects) * (len(found.effects) - 1)
    assert "&lt;svg" in found._repr_html_()
