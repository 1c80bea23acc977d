#!/usr/bin/env python3
"""Makes the tables of this data set from a clone of https://github.com/StanfordASL/trunk-stack (MIT licence).

    python3 import.py trunk-stack DIR

The repository keeps what was measured and what was commanded in two files per run. Their rows are joined (the `ID`s must agree),
rounded to what the sensors can tell (1e-3 deg, 1e-6 m), and written at 100 Hz and, every fifth row, at 20 Hz.
"""

import csv
import shutil
import sys
from pathlib import Path

ARCHIVE = "stack/main/data/trajectories/dynamic/servo_motor_archive"
RUNS = [
    ("run1_0g", "observations_controlled_1.csv", "control_inputs_controlled_1.csv"),
    ("run1_200g", "observations_controlled_1_200g.csv", "control_inputs_controlled_1.csv"),
    ("run2_0g", "observations_controlled_2.csv", "control_inputs_controlled_2.csv"),
]
COMMANDED = [f"u{i}" for i in range(1, 7)]
ANGLES = [f"phi{i}" for i in range(1, 7)]
DISKS = [f"{axis}{i}" for i in range(1, 4) for axis in "xyz"]


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def rounded(cell, digits):
    text = f"{float(cell):.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def joined(path, measured, commanded):
    if [row["ID"] for row in measured] != [row["ID"] for row in commanded]:
        sys.exit(f"{path}: its IDs are not those of the commands; clone the repository again")
    for seen, asked in zip(measured, commanded):
        cells = [rounded(asked[name], 3) for name in COMMANDED] + [rounded(seen[name], 3) for name in ANGLES]
        yield [seen["ID"], *cells, *(rounded(seen[name], 6) for name in DISKS)]


def main(clone, out):
    folder = clone / ARCHIVE if (clone / ARCHIVE).is_dir() else clone
    if not (folder / RUNS[0][1]).is_file():
        sys.exit(f"{folder}: no {RUNS[0][1]}; git clone https://github.com/StanfordASL/trunk-stack")
    out.mkdir(parents=True, exist_ok=True)
    manifest = Path(__file__).with_name("manifest.toml")
    if out.resolve() != manifest.parent and not (out / manifest.name).exists():
        shutil.copy(manifest, out)
    for run, measured, commanded in RUNS:
        if not (folder / measured).is_file():
            print(f"{folder / measured}: not there, skipped")
            continue
        rows = list(joined(folder / measured, read(folder / measured), read(folder / commanded)))
        for rate, stride in [("100hz", 1), ("20hz", 5)]:
            path = out / f"trunk_{run}_{rate}.csv"
            with open(path, "w", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerows([["k", *COMMANDED, *ANGLES, *DISKS], *rows[::stride]])
            print(f"{path}: {len(rows[::stride])} rows")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
