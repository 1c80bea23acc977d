"""What other readers find in the sample recordings, for tests/formats/samples.rs.

    python -m venv venv && venv/bin/pip install pyulog==1.3.0 pyomeca rosbags==0.11.9 pandas
    venv/bin/python reference.py ../../../../shared/data/recordings > reference.json

ULog is read by pyulog, TRC and Vicon by pyomeca, Motive by pandas, MCAP by rosbags. Of each group: samples, first and last
time, number of columns; of some columns: how many values are finite, and their sum and sum of squares.
"""

import json
import sys
import warnings
from pathlib import Path

import numpy as np
import pandas as pd

warnings.simplefilter("ignore")


def column(name, values):
    values = np.asarray(values, dtype=float)
    finite = values[np.isfinite(values)]
    return {"name": name, "finite": int(finite.size), "sum": float(finite.sum()), "squares": float((finite**2).sum())}


def ulog(path):
    from pyulog import ULog

    groups = []
    for data in ULog(str(path)).data_list:
        name = data.name if data.multi_id == 0 else f"{data.name}[{data.multi_id}]"
        fields = [field for field in data.data if field != "timestamp" and "_padding" not in field]
        time = data.data["timestamp"]
        some = sorted(fields)[:: max(1, len(fields) // 2)][:2]
        columns = [column(f"{name}.{field}", data.data[field]) for field in some]
        span = [float(time[0]) / 1e6, float(time[-1]) / 1e6]
        groups.append({"name": name, "samples": len(time), "span": span, "width": len(fields), "columns": columns})
    return groups


def markers(array, name, prefix=""):
    """pyomeca keeps positions as [4 × markers × times], the fourth row is ones."""
    values = array.values
    names = [str(channel) for channel in array.channel.values]
    time = array.time.values
    columns = [
        column(f"{prefix}{names[i]}.{axis}", values[k, i])
        for i in range(0, len(names), 12)
        for k, axis in enumerate("XYZ")
    ]
    span = [float(time[0]), float(time[-1])]
    return [{"name": name, "samples": len(time), "span": span, "width": 3 * len(names), "columns": columns}]


def vicon(path):
    from pyomeca import Markers

    array = Markers.from_csv(path, header=2, first_row=5, first_column=2, prefix_delimiter=":")
    array["time"] = np.arange(array.time.size) / 100.0
    # pyomeca leaves the subject out of the names
    header = next(line for line in open(path) if ":" in line)
    subjects = [cell.split(":")[0] for cell in header.split(",") if ":" in cell]
    array["channel"] = [f"{subject}.{name}" for subject, name in zip(subjects, array.channel.values)]
    return markers(array, "Trajectories")


def trc(path):
    from pyomeca import Markers

    array = Markers.from_trc(path)
    return markers(array, "")


def motive(path):
    head = pd.read_csv(path, header=None, skiprows=2, nrows=5, dtype=str, keep_default_na=False)
    table = pd.read_csv(path, skiprows=6)
    kinds, names, _, quantities, axes = (head.iloc[i] for i in range(5))
    columns = []
    for at in range(2, table.shape[1], 5):
        solved = ".solved" if kinds[at] == "Rigid Body Marker" else ""
        marker = kinds[at].endswith("Marker")
        end = f".{axes[at]}" if marker and axes[at] else f".{quantities[at]}" + (f".{axes[at]}" if axes[at] else "")
        columns.append(column(names[at].replace(":", ".") + solved + end, table.iloc[:, at]))
    frames = table.iloc[:, 0].to_numpy() / 120.0
    span = [float(frames[0]), float(frames[-1])]
    return [{"name": "", "samples": len(table), "span": span, "width": table.shape[1] - 2, "columns": columns}]


def numbers(message, prefix=""):
    """Every number of a ROS message by its path, as pairs."""
    from dataclasses import fields, is_dataclass

    if is_dataclass(message):
        for field in fields(message):
            if not field.name.startswith("__"):
                yield from numbers(getattr(message, field.name), f"{prefix}.{field.name}")
    elif isinstance(message, (bool, int, float, np.number, np.bool_)):
        yield prefix, float(message)
    elif isinstance(message, (list, np.ndarray)):
        for i, value in enumerate(message):
            yield from numbers(value, f"{prefix}[{i}]")


def is_field(name):
    """Not a constant of the type, and not the byte that stands in the place of no fields."""
    last = name.rsplit(".", 1)[-1]
    return not last.isupper() and last != "structure_needs_at_least_one_member"


def mcap(path):
    from rosbags.highlevel import AnyReader

    groups = []
    with AnyReader([path]) as reader:
        for connection in reader.connections:
            rows, times = [], []
            for _, time, raw in reader.messages([connection]):
                message = reader.deserialize(raw, connection.msgtype)
                found = numbers(message)
                rows.append({name: value for name, value in found if is_field(name)})
                header = getattr(message, "header", None)
                stamp = (header.stamp.sec + header.stamp.nanosec / 1e9) if header is not None else 0
                times.append(stamp or time / 1e9)
            if not rows:
                continue
            start = [f"{connection.topic}{name}" for name in rows[0]][:2]
            columns = [column(name, [row.get(name.removeprefix(connection.topic), np.nan) for row in rows]) for name in start]
            span = [times[0], times[-1]]
            group = {"name": connection.topic, "samples": len(rows), "span": span, "columns": columns}
            group["type"] = connection.msgtype
            groups.append(group)
    return groups


READERS = {
    "esc_status_log.ulg": ulog,
    "sample_log_small.ulg": ulog,
    "markers.trc": trc,
    "vicon-markers.csv": vicon,
    "motive-1.21.csv": motive,
    "test_bag.mcap": mcap,
    "talker.mcap": mcap,
}

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    found = {name: sorted(read(folder / name), key=lambda group: group["name"]) for name, read in READERS.items()}
    lines = [
        f'"{name}": [\n' + ",\n".join(json.dumps(group) for group in groups) + "\n]" for name, groups in found.items()
    ]
    print("{\n" + ",\n".join(lines) + "\n}")
