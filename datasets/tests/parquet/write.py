"""Writes the Parquet files of this folder: every type that a laboratory writes, by a program that shares no code with the reader.

    pip install pyarrow==26.0.1 && python write.py

Row i of 60, the first 30 of trial `a`, the rest of `b`:
    numbers     i, i/4 where there are fractions, and negative ones where there is a sign; `truth` is i odd
    time        i steps of 10 ms and 1 ns (as far as the unit goes), from 2023-11-14T22:13:20 or from 1 s
    y           sin(i/7) metres, q the same as a 64-bit float of degrees
"""
import math
from decimal import Decimal

import pyarrow as pa
import pyarrow.parquet as pq

ROWS = range(60)
START = 1_700_000_000

columns = {
    "y": pa.array([math.sin(i / 7) for i in ROWS], pa.float64()),
    "q": pa.array([math.cos(i / 5) * 10 for i in ROWS], pa.float64()),
    "run_text": pa.array(["a" if i < 30 else "b" for i in ROWS], pa.string()),
}

for kind in [pa.int8(), pa.int16(), pa.int32(), pa.int64(), pa.float32()]:
    columns[str(kind)] = pa.array([-i for i in ROWS], kind)
for kind in [pa.uint8(), pa.uint16(), pa.uint32(), pa.uint64()]:
    columns[str(kind)] = pa.array([i for i in ROWS], kind)
columns["halffloat"] = pa.array([i / 4 for i in ROWS], pa.float32()).cast(pa.float16())
columns["truth"] = pa.array([i % 2 == 1 for i in ROWS], pa.bool_())
columns["decimal"] = pa.array([Decimal(-i) / 100 for i in ROWS], pa.decimal128(12, 2))
columns["decimal32"] = pa.array([Decimal(i) / 4 for i in ROWS], pa.decimal128(9, 2))
columns["decimal_long"] = pa.array([Decimal(-i) / 100 for i in ROWS], pa.decimal128(38, 20))
columns["gaps"] = pa.array([None if i % 10 == 3 else i for i in ROWS], pa.int16())

# names of trials, and numbers as text
columns["run_category"] = columns["run_text"].dictionary_encode()
columns["run_large"] = columns["run_text"].cast(pa.large_string())
columns["run_view"] = columns["run_text"].cast(pa.string_view())
columns["run_int64"] = pa.array([9_007_199_254_740_993 + (i >= 30) for i in ROWS], pa.int64())
columns["run_int8"] = pa.array([1 + (i >= 30) for i in ROWS], pa.int8())
columns["text"] = pa.array([str(i / 4) for i in ROWS]).dictionary_encode()
columns["words"] = pa.array(["high" if i % 2 else "low" for i in ROWS]).dictionary_encode()
columns["category_int"] = pa.array([i % 7 for i in ROWS], pa.int64()).dictionary_encode()


def ticks(unit):
    per_second = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}[unit]
    step = {"s": 1, "ms": 10, "us": 10_000, "ns": 10_000_001}[unit]
    return per_second, step


for unit in ["s", "ms", "us", "ns"]:
    per_second, step = ticks(unit)
    stamps = [START * per_second + i * step for i in ROWS]
    columns[f"timestamp_{unit}"] = pa.array(stamps, pa.timestamp(unit))
    columns[f"timestamp_{unit}_utc"] = pa.array(stamps, pa.timestamp(unit, "Europe/Berlin"))
    columns[f"duration_{unit}"] = pa.array([per_second + i * step for i in ROWS], pa.duration(unit))
    of_day = pa.time32(unit) if unit in ["s", "ms"] else pa.time64(unit)
    columns[f"time_{unit}"] = pa.array([3600 * per_second + i * step for i in ROWS], of_day)
columns["date32"] = pa.array([19_675 + i for i in ROWS], pa.date32())
columns["date64"] = pa.array([(19_675 + i) * 86_400_000 for i in ROWS], pa.date64())
columns["timestamp_gap"] = pa.array([None if i == 5 else i * 10 for i in ROWS], pa.timestamp("ms"))

# not read
columns["list"] = pa.array([[i, i] for i in ROWS], pa.list_(pa.float64()))
columns["struct"] = pa.array([{"x": i} for i in ROWS], pa.struct([("x", pa.float64())]))
columns["map"] = pa.array([[("x", i)] for i in ROWS], pa.map_(pa.string(), pa.float64()))
columns["binary"] = pa.array([bytes([i]) for i in ROWS], pa.binary())
columns["fixed"] = pa.array([bytes([i] * 4) for i in ROWS], pa.binary(4))
columns["decimal256"] = pa.array([Decimal(i) for i in ROWS], pa.decimal256(50, 2))

table = pa.table(columns)
pq.write_table(table, "types.parquet", compression="zstd", write_statistics=False, use_dictionary=["run_category", "words", "text"])

# without the Arrow schema, as other writers leave it out; instants as the 96 bits of Spark and Impala
few = table.select(["y", "q", "run_category", "int8", "uint16", "truth", "decimal", "timestamp_us", "timestamp_ms_utc", "time_ms"])
pq.write_table(few, "plain.parquet", compression="snappy", row_group_size=40, store_schema=False, write_statistics=False)
pq.write_table(table.select(["y", "q", "run_text", "timestamp_ns"]), "int96.parquet", use_deprecated_int96_timestamps=True, store_schema=False)
