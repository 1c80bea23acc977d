"""Training and what it leaves, beside the command line."""

import csv
import io

import numpy as np
import pytest

import acm
from conftest import EXPERIMENT, loaded, program


def lines_of(frame, trial):
    rows = frame[frame["trial"] == trial]
    return rows, rows.to_csv(index=False, float_format=None)


def test_scores_are_those_of_the_records(run, saved, tmp_path):
    (tmp_path / "gru.toml").write_text(
        f"data = {str(saved.folder)!r}\n[network]\nkind = 'gru'\nunits = 6\n[windows]\nlength = 8\nreach = 8\nmax_gap = 0.5\n"
        "[training]\nepochs = 4\nbatch = 32\n[inputs]\ndomain_filter = 'box'\n"
        "[protocol]\nseeds = [1, 2]\ncross_validation = false\n"
    )
    done = program("acm-train", "--config", tmp_path / "gru.toml", "--out", tmp_path / "run", "--quiet")
    assert done.returncode == 0, done.stderr
    own = {record["id"]: record for record in run.records}
    assert sorted(own) == ["final-seed1", "final-seed2"]
    for name, record in own.items():
        told = loaded(tmp_path / "run" / "records" / f"{name}.json")
        assert record["held_out"] == told["held_out"] and record["epochs"] == told["epochs"]
    scores = run.scores.to_pandas()
    nominal = scores[(scores["part"] == "held_out") & (scores["estimator"] == "nominal")]
    assert nominal["rmse"].tolist() == [own[name]["held_out"]["estimators"]["nominal"]["rmse_total"] for name in sorted(own)]
    assert "held out" in str(run) or "held-out" in str(run)


def test_an_estimator_answers_as_the_stream(run, frame):
    for windows in (False, True):
        rows, text = lines_of(frame, "h1")
        done = program("acm-eval", "stream", run.folder, *(["--windows"] if windows else []), text=text)
        assert done.returncode == 0, done.stderr
        told = list(csv.DictReader(io.StringIO(done.stdout)))
        assert len(told) == 400
        estimator = run.estimator(windows=windows)
        answers = estimator.predict(rows)
        assert answers.columns == list(told[0])
        for name in answers.columns:
            cells = {"true": "1", "false": "0", "": "nan"}
            expected = np.array([float(cells.get(row[name], row[name])) for row in told])
            np.testing.assert_array_equal(answers[name], expected, err_msg=name)
        assert (answers["x"] != answers["nominal_x"]).any(), "the network says something"
        outputs = estimator.predict(rows[["q"]].to_numpy(), rows["t"].to_numpy())
        np.testing.assert_array_equal(outputs[:, 0], answers["x"])
        estimator.restart()
        times = rows["t"].to_numpy()
        steps = [estimator.step([q], dt) for q, dt in zip(rows["q"], np.diff(times, prepend=times[0]))]
        np.testing.assert_array_equal(np.concatenate(steps), answers["x"])
        assert estimator.history == answers["history"][-1] and estimator.in_range in (True, False)


def test_trials_of_a_frame_are_answered_one_by_one(run, frame):
    two = frame[frame["trial"].isin(["h1", "h2"])]
    together = run.estimator().predict(two, trial="trial")
    alone = [run.estimator().predict(two[two["trial"] == name])["x"] for name in ("h1", "h2")]
    np.testing.assert_array_equal(together["x"], np.concatenate(alone))


def test_arrays_of_any_layout_give_the_same_bits(run, frame):
    rows = frame[frame["trial"] == "h1"]
    columns, time = rows[["q"]].to_numpy(), rows["t"].to_numpy()
    first = run.estimator().predict(columns, time)
    strided = np.zeros((800, 3))[::2, 1:2]
    strided[:] = columns
    for form in (strided, np.asfortranarray(columns), columns.tolist()):
        np.testing.assert_array_equal(run.estimator().predict(form, time), first)
    x = np.array([0.1])
    np.testing.assert_array_equal(run.estimator().step(x), run.estimator().step((0.1,)))


def test_a_saved_estimator_answers_alike(run, frame, tmp_path):
    done = program("acm-eval", "stream", run.folder, "--save", tmp_path / "robot.json")
    assert done.returncode == 0, done.stderr
    rows = frame[frame["trial"] == "h1"]
    columns, time = rows[["q"]].to_numpy(), rows["t"].to_numpy()
    file = acm.Estimator.load(tmp_path / "robot.json")
    everywhere = acm.Estimator.load(run.folder, everywhere=True)
    np.testing.assert_array_equal(file.predict(columns, time), everywhere.predict(columns, time))


def test_the_model_of_a_finding_is_trained_on(finding, recordings, tmp_path):
    run = acm.train(EXPERIMENT, data=recordings, nominal=finding.model, out=tmp_path / "both", progress=False)
    scores = run.scores.to_pandas()
    nominal = scores[(scores["part"] == "held_out") & (scores["estimator"] == "nominal")]["rmse"]
    assert (nominal < 7e-4).all(), "the delay is in the model"
    assert run.records[0]["experiment"]["nominal"]["augmented"] == str(tmp_path / "both-model.json")
    assert (tmp_path / "both-recordings" / "manifest.toml").is_file()
    run.estimator().predict(np.zeros((5, 1)), 0.05 * np.arange(5))


def test_a_report_has_the_tables_of_its_page(run, tmp_path):
    report = acm.report([run.folder], out=tmp_path / "page")
    assert report.page == tmp_path / "page" / "report.html"
    assert report.page.is_file()
    (tables,) = report.tables.values()
    assert "errors" in tables and len(tables["errors"]) >= 3
    assert report._repr_html_().startswith("<iframe") and "report.html" in repr(report)


def test_a_network_that_is_not_worth_it_warns(finding, recordings, tmp_path):
    run = acm.train(EXPERIMENT, data=recordings, nominal=finding.model, out=tmp_path / "run", progress=False)
    with pytest.warns(UserWarning, match="No network is worth it"):
        run.estimator()
