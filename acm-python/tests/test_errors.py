"""What is refused, with the text of the programs, and Ctrl-C."""

import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest

import acm
from conftest import COLUMNS, EXPERIMENT, late_frame, program


def test_errors_are_one_family():
    for error in (acm.ConfigError, acm.DataError, acm.FileError, acm.BusyError):
        assert issubclass(error, acm.AcmError) and issubclass(error, Exception)


def refused(arguments, call, error, code):
    done = program(*arguments)
    assert done.returncode == code, done.stderr
    with pytest.raises(error) as raised:
        call()
    told = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
    text = "\n".join(told).removeprefix("error: ").strip()
    assert str(raised.value) == text


def test_texts_are_those_of_the_programs(saved, tmp_path):
    missing = tmp_path / "missing"
    refused(["acm-data", "check", missing], lambda: acm.read(missing), acm.FileError, 4)
    bad = "search.max_effects=99"
    close = ["acm-eval", "close-loop", saved.folder, "--set", bad, "--out", tmp_path / "loop"]
    refused(close, lambda: acm.close_loop(saved, {"search": {"max_effects": 99}}), acm.ConfigError, 2)
    key = ["acm-eval", "close-loop", saved.folder, "--set", "serach.seed=1", "--out", tmp_path / "loop"]
    refused(key, lambda: acm.close_loop(saved, set={"serach.seed": 1}), acm.ConfigError, 2)
    run = ["acm-eval", "stream", tmp_path]
    refused(run, lambda: acm.Estimator.load(tmp_path), acm.ConfigError, 2)
    (tmp_path / "bad.toml").write_text("[network]\nkind = 'gro'\n")
    train = ["acm-train", "--config", tmp_path / "bad.toml", "--out", tmp_path / "run"]
    refused(train, lambda: acm.train(tmp_path / "bad.toml", out=tmp_path / "run"), acm.ConfigError, 2)


def test_a_frame_is_checked_as_a_file_is(frame):
    with pytest.raises(acm.DataError, match="column `qq`"):
        acm.Recordings.from_frame(frame, **{**COLUMNS, "actuators": {"qq": "rad"}})
    with pytest.raises(acm.DataError, match="run9"):
        acm.Recordings.from_frame(frame, **{**COLUMNS, "held_out": ["run9"]})
    with pytest.raises(acm.AcmError, match="furlong"):
        acm.Recordings.from_frame(frame, **{**COLUMNS, "units": {"x": "furlong"}})
    with pytest.raises(acm.ConfigError, match="unknown field `colour`"):
        acm.Recordings.from_frame(frame, **{**COLUMNS, "manifest": {"colour": "red"}})
    backwards = frame.copy()
    backwards.loc[450, "t"] = 0.0
    with pytest.raises(acm.DataError, match="goes back"):
        acm.Recordings.from_frame(backwards, **COLUMNS)
    texts = frame.assign(q=frame["q"].map(str))
    texts.loc[3, "q"] = "fast"
    with pytest.raises(acm.DataError, match="fast"):
        acm.Recordings.from_frame(texts, **COLUMNS)
    lists = frame.assign(q=[[1.0, 2.0]] * len(frame))
    with pytest.raises(acm.DataError, match=r"several numbers each.*action\[0\]"):
        acm.Recordings.from_frame(lists, **COLUMNS)
    with pytest.raises(acm.ConfigError, match="no frame"):
        acm.Recordings.from_frame([1, 2], **COLUMNS)
    with pytest.raises(acm.ConfigError, match="from_frame"):
        acm.close_loop(frame)


def test_samples_that_are_none_are_named(run, frame):
    estimator = run.estimator()
    with pytest.raises(acm.DataError, match="input `q` is NaN"):
        estimator.step([float("nan")], 0.05)
    with pytest.raises(acm.DataError, match="2 inputs where 1 are needed"):
        estimator.step([0.1, 0.2], 0.05)
    with pytest.raises(acm.DataError, match="row 3: .*time must pass"):
        estimator.predict(np.zeros((5, 1)), np.array([0.0, 0.1, 0.2, 0.2, 0.3]))
    with pytest.raises(acm.ConfigError, match="give the times"):
        estimator.predict(np.zeros((5, 1)))
    with pytest.raises(acm.ConfigError, match="4 times and 5 rows"):
        estimator.predict(np.zeros((5, 1)), np.zeros(4))
    with pytest.raises(acm.DataError, match="no column `q`"):
        estimator.predict(frame.drop(columns="q"))
    with pytest.raises(TypeError):
        estimator.step(["a"], 0.05)
    before = estimator.history
    estimator.restart()
    estimator.step([0.1], 0.0)
    assert estimator.history == 1 or before == 0


def test_a_folder_in_use_is_busy(saved, tmp_path):
    finding_folder = tmp_path / "loop"
    acm.close_loop(saved, {"search": {"max_effects": 1}}, out=finding_folder, progress=False)
    held = subprocess.Popen([sys.executable, "-c", textwrap.dedent(f"""
        import fcntl, sys, time
        lock = open({str(finding_folder / ".lock")!r}, "r+")
        fcntl.flock(lock, fcntl.LOCK_EX)
        print("held", flush=True)
        time.sleep(60)
    """)], stdout=subprocess.PIPE, text=True)
    try:
        assert held.stdout.readline() == "held\n"
        with pytest.raises(acm.BusyError, match="in use"):
            acm.close_loop(saved, {"search": {"max_effects": 1}}, out=finding_folder, progress=False)
    finally:
        held.kill()
        held.wait()


def interrupted(script, folder, after):
    """Runs a script in a child and sends it SIGINT once it has printed ``after``."""
    environment = dict(os.environ, PYTHONPATH=str(pathlib.Path(__file__).parent))
    child = subprocess.Popen(
        [sys.executable, "-u", "-c", textwrap.dedent(script)], cwd=folder, env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )
    told = []
    for line in child.stdout:
        told.append(line)
        if after in line:
            break
    child.send_signal(signal.SIGINT)
    sent = time.monotonic()
    rest, _ = child.communicate(timeout=120)
    return "".join(told) + rest, time.monotonic() - sent, child.returncode


def test_ctrl_c_stops_a_training_which_goes_on_with_the_same_bits(saved, tmp_path):
    long = {**EXPERIMENT, "training": {"epochs": 60, "batch": 32}, "protocol": {"seeds": [1], "cross_validation": False}}
    script = f"""
        import acm
        try:
            acm.train({long!r}, data={str(saved.folder)!r}, out="run")
        except KeyboardInterrupt:
            print("interrupted")
            raise SystemExit(7)
    """
    told, took, code = interrupted(script, tmp_path, "epoch 6/60")
    assert code == 7 and "interrupted" in told and "stopping after this epoch" in told, told
    assert took < 60 and not list((tmp_path / "run" / "records").glob("*.json"))
    resumed = acm.train(long, data=saved, out=tmp_path / "run", resume=True, progress=False)
    whole = acm.train(long, data=saved, out=tmp_path / "whole", progress=False)
    for name in ("epochs", "held_out", "best_epoch"):
        assert resumed.records[0][name] == whole.records[0][name]


def test_ctrl_c_leaves_a_search_at_once(saved, tmp_path):
    script = f"""
        import acm
        try:
            acm.close_loop({str(saved.folder)!r})
        except KeyboardInterrupt:
            print("interrupted")
            raise SystemExit(7)
    """
    told, took, code = interrupted(script, tmp_path, "error")
    assert code == 7 and "interrupted" in told, told
    assert took < 20


def test_the_interpreter_is_released(saved):
    import threading

    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.monotonic()
    acm.close_loop(saved, {"search": {"max_effects": 1}}, progress=False)
    took = time.monotonic() - began
    done.set()
    thread.join()
    assert len(ticks) > 10 * took, f"{len(ticks)} ticks in {took:.1f} s"


def test_an_exception_of_progress_comes_through(saved):
    def broken(line):
        raise RuntimeError("no more lines")

    with pytest.raises(RuntimeError, match="no more lines"):
        acm.close_loop(saved, progress=broken)
    with pytest.raises(acm.ConfigError, match="no callable"):
        acm.close_loop(saved, progress=3)


def test_late_frames_differ():
    """The rig of these tests has what it says."""
    assert not np.array_equal(late_frame(0.0)["x"], late_frame(0.3)["x"])
