"""How fast an estimator answers from Python, beside Rust on the same file and the same inputs.

The network is the GRU of the synthetic campaign's size (32 units), trained for one epoch: the time of a step does not depend on its weights.
The goals are 3 us a step and half the rate of Rust. A goal that is missed is printed, and fails nothing: the rate of Rust is taken in other
processes at other moments, so that a busy machine moves the ratio. The best of five rounds counts.
"""

import pathlib
import tempfile
import time

import numpy as np
import pandas as pd

import acm
from conftest import COLUMNS, late_frame, program

ROWS = 100_000
EXPERIMENT = {
    "network": {"kind": "gru", "units": 32},
    "windows": {"length": 10, "reach": 10},
    "training": {"epochs": 1},
    "protocol": {"seeds": [1], "cross_validation": False},
}


def best(measured, rounds=5):
    return min(measured() for _ in range(rounds))


def goal(met):
    return "met:" if met else "MISSED:"


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        data = acm.Recordings.from_frame(late_frame(), **COLUMNS).save(folder / "data")
        run = acm.train(EXPERIMENT, data=data, out=folder / "run", progress=False)
        file = folder / "robot.json"
        saved = program("acm-eval", "stream", run.folder, "--save", file)
        assert saved.returncode == 0, saved.stderr
        rates = [float(program("examples/rate", file, ROWS).stdout) for _ in range(5)]
        t = 0.05 * np.arange(ROWS)
        # The inputs of the example, in SI units.
        x = (0.4 * np.sin(0.7 * t))[:, None]
        estimator = run.estimator(everywhere=True)

        def step():
            estimator.restart()
            row, dt, count = x[0], 0.05, 20_000
            began = time.perf_counter()
            for _ in range(count):
                estimator.step(row, dt)
            return (time.perf_counter() - began) / count

        def step_of_list():
            estimator.restart()
            row, count = [0.1], 20_000
            began = time.perf_counter()
            for _ in range(count):
                estimator.step(row, 0.05)
            return (time.perf_counter() - began) / count

        def predict():
            began = time.perf_counter()
            estimator.predict(x, t)
            return time.perf_counter() - began

        table = pd.DataFrame({"t": t, "q": x[:, 0]})

        def of_frame():
            began = time.perf_counter()
            estimator.predict(table)
            return time.perf_counter() - began

        array, listed, rust = 1e6 * best(step), 1e6 * best(step_of_list), max(rates)
        rate, framed = ROWS / best(predict), ROWS / best(of_frame)
        print(f"Estimator.step, an array            {array:8.2f} us a sample ({goal(array <= 3.0)} 3 us at most)")
        print(f"Estimator.step, a list              {listed:8.2f} us a sample ({goal(listed <= 3.0)} 3 us at most)")
        print(f"Rust, 100,000 rows                  {rust / 1e6:8.2f} million rows a second")
        print(f"Estimator.predict, an array         {rate / 1e6:8.2f} million rows a second, {rate / rust:.2f} x Rust ({goal(rate >= 0.5 * rust)} 0.5 x at least)")
        print(f"Estimator.predict, a DataFrame      {framed / 1e6:8.2f} million rows a second, {framed / rust:.2f} x Rust")


if __name__ == "__main__":
    main()
