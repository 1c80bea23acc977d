"""Recordings from frames and folders."""

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest

import acm
from conftest import COLUMNS, TRIALS, program


def test_a_frame_becomes_trials_in_si_units(frame):
    millimetres = frame.assign(x=1e3 * frame["x"])
    found = acm.Recordings.from_frame(millimetres, **{**COLUMNS, "units": {"x": "mm"}})
    assert list(found.trials["trial"]) == TRIALS and len(found) == 7 and "d2" in found
    assert found.trials["role"] == ["calibration"] + 4 * ["development"] + 2 * ["held_out"]
    rows = frame[frame["trial"] == "d2"]
    arrays = found["d2"]
    assert list(arrays) == ["time", "q", "x"]
    np.testing.assert_array_equal(arrays["time"], rows["t"])
    np.testing.assert_array_equal(arrays["q"], rows["q"])
    np.testing.assert_array_equal(arrays["x"], 1e3 * rows["x"] / 1e3)
    assert found.signals["unit"] == ["rad", "m"] and found.name == "late"
    assert "7 trials (1 calibration, 4 development, 2 held out), 2800 samples" in repr(found)


def test_each_signal_has_its_own_column(frame):
    more = frame.assign(r=frame["q"] ** 2, y=-frame["x"], temperature=20.0 + frame["t"], z=frame["x"] + 0.01)
    found = acm.Recordings.from_frame(
        more, time="t", trial="trial", actuators={"q": "rad", "r": "rad"}, outputs={"x": "m", "y": "m"}, context={"temperature": "K"},
        predicted=["z", "x"], units={"z": "m", "x": "m"}, calibration=["c1"], held_out=["h1", "h2"],
    )
    rows = more[more["trial"] == "h2"]
    arrays = found["h2"]
    assert list(arrays) == ["time", "q", "r", "temperature", "predicted_z", "predicted_x", "x", "y"]
    for name in ("q", "r", "temperature", "x", "y"):
        np.testing.assert_array_equal(arrays[name], rows[name])
    np.testing.assert_array_equal(arrays["predicted_z"], rows["z"])
    np.testing.assert_array_equal(arrays["predicted_x"], rows["x"])


def test_arrays_are_views_that_outlive_the_recordings_and_cannot_be_written(frame):
    arrays = acm.Recordings.from_frame(frame, **COLUMNS)["d1"]
    x = arrays["x"]
    assert not x.flags.owndata and not x.flags.writeable
    np.testing.assert_array_equal(x, frame[frame["trial"] == "d1"]["x"])
    with pytest.raises(ValueError):
        x[0] = 1.0


def test_pandas_polars_and_pyarrow_give_the_same_bits(frame):
    categories = frame.assign(trial=frame["trial"].astype("category"))
    forms = [frame, categories, pl.from_pandas(frame), pl.from_pandas(categories), pa.Table.from_pandas(frame)]
    forms.append(pl.concat([pl.from_pandas(frame[:1000]), pl.from_pandas(frame[1000:])], rechunk=False))
    first, *others = [acm.Recordings.from_frame(form, **COLUMNS) for form in forms]
    for other in others:
        assert other.trials["trial"] == TRIALS and other.trials["role"] == first.trials["role"]
        for trial in TRIALS:
            for name, values in first[trial].items():
                np.testing.assert_array_equal(other[trial][name], values)


def test_types_of_time_need_no_unit(frame):
    stamps = frame.assign(t=pd.Timestamp("2026-01-01") + pd.to_timedelta(frame["t"], unit="s"))
    found = acm.Recordings.from_frame(stamps, **COLUMNS)
    np.testing.assert_allclose(found["d1"]["time"], frame[frame["trial"] == "d1"]["t"], atol=1e-9)


def test_a_missing_cell_of_an_output_is_a_lost_marker(frame):
    holes = frame.copy()
    holes.loc[900:904, "x"] = np.nan
    found = acm.Recordings.from_frame(holes, **COLUMNS)
    assert found.trials["left_out"][2] == 5 and found.trials["samples"][2] == 395


def test_without_a_column_of_trials_all_rows_are_one(frame):
    one = frame[frame["trial"] == "d1"].drop(columns="trial")
    found = acm.Recordings.from_frame(one, time="t", actuators={"q": "rad"}, outputs={"x": "m"})
    assert found.trials["trial"] == ["frame"] and found.trials["role"] == ["development"]


def test_a_saved_frame_is_what_the_programs_read(saved, recordings):
    done = program("acm-data", "check", saved.folder)
    assert done.returncode == 0, done.stderr
    said = "\n".join(line for line in done.stdout.splitlines() if not line.startswith("next:"))
    assert str(acm.check(saved)) == said.strip() == str(acm.check(recordings))
    described = program("acm-data", "describe", saved.folder)
    assert str(acm.describe(saved)) == described.stdout.strip()
    assert saved.hash == recordings.hash and acm.read(saved.folder).hash == saved.hash
    assert "<pre>" in acm.check(saved)._repr_html_()


def test_results_are_frames(recordings):
    trials = recordings.trials
    table = pl.DataFrame(trials)
    assert table["trial"].to_list() == TRIALS and table["samples"].sum() == 2800.0
    assert pa.table(trials).num_rows == 7
    assert trials.to_polars().equals(table)
    assert trials.to_pandas()["duration"].tolist() == table["duration"].to_list()
    assert list(pd.DataFrame.from_arrow(trials)["trial"]) == TRIALS
    with pytest.raises(KeyError, match="there are trial, role"):
        trials["rolle"]
