#!/usr/bin/env python3
"""Makes rollouts.parquet from a clone of https://github.com/raminmh/CfC (Apache-2.0), at commit 59f6e01f.

    python3 import.py CfC [DIR]            needs numpy, pandas and pyarrow

The repository has a file `rollout_<number>.npy` of states [T×17] each. Its program deals the files out to three parts and drops
steps at random, with numpy's RandomState and fixed seeds (facts.toml); the same is done here.

rollout     number of the file
part        training, validation, test
k           step
kept        1 for what is seen; the last step has no successor and is not
s0 … s16    state
"""

import sys
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd


def rollouts(folder, facts):
    """Training rollouts first, in the order in which the files were dealt."""
    split, drop, count = facts["split"], facts["drop"], facts["rollouts"]
    order = list(range(count))
    np.random.RandomState(split["seed"]).shuffle(order)
    tested, both = int(split["test"] * count), int((split["test"] + split["validation"]) * count)
    generator = np.random.RandomState(drop["seed"])
    for part, places in [("training", order[both:]), ("validation", order[tested:both]), ("test", order[:tested])]:
        for place in places:
            states = np.load(folder / f"rollout_{place:03}.npy").astype(np.float32)
            kept = [generator.rand() < drop["kept"] for _ in range(len(states) - 1)] + [False]
            table = pd.DataFrame({f"s{i}": states[:, i].astype(np.float64) for i in range(facts["states"])})
            head = {"rollout": f"{place:03}", "part": part, "k": np.arange(len(states), dtype=float)}
            yield table.assign(**head, kept=np.array(kept, dtype=float))


def main(clone, out):
    facts = tomllib.loads(Path(__file__).with_name("facts.toml").read_text())
    folder = clone / "data/walker" if (clone / "data/walker").is_dir() else clone
    table = pd.concat(list(rollouts(folder, facts)), ignore_index=True)
    for part, wanted in facts["counts"].items():
        rows = table[table["part"] == part]
        found = {"rollouts": rows["rollout"].nunique(), "rows": len(rows), "kept": int(rows["kept"].sum())}
        if found != wanted:
            sys.exit(f"the {part} part has {found}, and that of the benchmark {wanted}: take the rollouts of commit 59f6e01f")
    states = [f"s{i}" for i in range(facts["states"])]
    path = out / "rollouts.parquet"
    table[["rollout", "part", "k", "kept", *states]].to_parquet(path, index=False)
    print(f"{path}: {len(table)} rows")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) == 3 else Path(__file__).parent)
