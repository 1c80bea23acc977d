"""A nominal model of one's own as a callable: what it says is the prediction, as if a program had said it."""

import sys

import numpy as np
import pytest

import acm
from conftest import DELAY, program

MODEL = """
import sys
print_ = lambda x: print(repr(x), flush=True)
next(sys.stdin)
for line in sys.stdin:
    time, q = map(float, line.split(","))
    print_(0.1 * q + 0.02 * (q * q))
"""


def model(trial):
    assert list(trial) == ["time", "q"]
    return 0.1 * trial["q"] + 0.02 * (trial["q"] * trial["q"])


@pytest.fixture(scope="module")
def predicted(recordings):
    return recordings.with_nominal(model)


def test_predictions_are_those_of_the_model(recordings, predicted):
    assert len(predicted) == len(recordings) and predicted.name == recordings.name
    for name in ("c1", "d3", "h2"):
        before, after = recordings[name], predicted[name]
        for signal in ("time", "q", "x"):
            np.testing.assert_array_equal(before[signal], after[signal])
        np.testing.assert_array_equal(after["predicted_x"], model({"time": 0, "q": before["q"]}))
    assert "model" in predicted.manifest["source"]


def test_the_loop_finds_what_the_model_lacks(predicted):
    finding = acm.close_loop(predicted, progress=False)
    assert finding.effects["effect"] == ["dead_time"]
    assert abs(finding.effects["value"][0] - DELAY) < 0.01


def test_a_program_says_the_same(recordings, predicted, saved, tmp_path):
    (tmp_path / "model.py").write_text(MODEL)
    done = program("acm-data", "predict", saved.folder, "--out", tmp_path / "out", "--", sys.executable, tmp_path / "model.py")
    assert done.returncode == 0, done.stderr
    theirs, kept = acm.read(tmp_path / "out"), predicted.save(tmp_path / "kept")
    for name in ("c1", "h1"):
        np.testing.assert_array_equal(theirs[name]["predicted_x"], kept[name]["predicted_x"])


def test_answers_by_name_and_of_one_column(recordings, predicted):
    for other in (lambda t: {"x": model(t)}, lambda t: model(t)[:, None], lambda t: list(model(t))):
        np.testing.assert_array_equal(recordings.with_nominal(other)["d1"]["predicted_x"], predicted["d1"]["predicted_x"])


@pytest.mark.parametrize(
    ("wrong", "error", "why"),
    [
        (lambda t: model(t)[1:], acm.DataError, "trial `c1`.*399×1 numbers for 400 samples of 1 outputs"),
        (lambda t: model(t) / 0.0, acm.DataError, "sample 1"),
        (lambda t: {"y": model(t)}, acm.ConfigError, "gives no `x`"),
        (lambda t: np.zeros((2, 2, 2)), acm.ConfigError, "shape"),
        (lambda t: t["gone"], KeyError, "gone"),
        ("model", acm.ConfigError, "no callable"),
    ],
)
@pytest.mark.filterwarnings("ignore:divide by zero")
@pytest.mark.filterwarnings("ignore:invalid value")
def test_a_model_that_fails_is_told(recordings, wrong, error, why):
    with pytest.raises(error, match=why):
        recordings.with_nominal(wrong)
