//! Every type of Parquet that a laboratory writes is read, or named with what to do. The files are pyarrow's
//! (`tests/parquet/write.py`), which shares no code with the reader; the oracle is what that script says of row i.

use acm_datasets::{Campaign, DataError};

use super::set::Set;

const MANIFEST: &str = r#"
name = "types"
[table]
files = ["FILE.parquet"]
trial = { column = "TRIAL" }
time = TIME
[[actuator]]
column = "q"
unit = "deg"
[[measured]]
column = "OUTPUT"
unit = "UNIT"
[roles]
development = ["a", "b"]
"#;

struct Asked {
    file: &'static str,
    trial: &'static str,
    time: &'static str,
    output: &'static str,
}

const USUAL: Asked = Asked { file: "types", trial: "run_text", time: "{ rate_hz = 100.0 }", output: "y" };

impl Asked {
    fn set(&self) -> Set {
        let set = Set::new();
        let name = format!("{}.parquet", self.file);
        let written = std::path::absolute("tests/parquet").unwrap().join(&name);
        std::fs::copy(written, set.file(&name)).expect("copied");
        for name in ["a", "b", "c", "d"] {
            std::fs::remove_file(set.file(&format!("run_{name}.csv"))).expect("removed");
        }
        let text = MANIFEST.replace("FILE", self.file).replace("TRIAL", self.trial).replace("TIME", self.time);
        set.write("manifest.toml", &text.replace("OUTPUT", self.output).replace("UNIT", "1"));
        set
    }

    fn read(&self) -> Result<Campaign, DataError> {
        self.set().read()
    }

    /// The values of the output, of both trials after one another.
    #[track_caller]
    fn output(&self) -> Vec<f64> {
        let campaign = self.read().unwrap_or_else(|e| panic!("{}: {e}", self.output));
        campaign.trials.iter().flat_map(|trial| trial.measured.column(0).iter().copied().collect::<Vec<_>>()).collect()
    }

    /// The times of the trials after one another.
    #[track_caller]
    fn times(&self) -> Vec<Vec<f64>> {
        let campaign = self.read().unwrap_or_else(|e| panic!("{}: {e}", self.time));
        campaign.trials.into_iter().map(|trial| trial.time).collect()
    }

    /// Code 3, and a message with these words.
    #[track_caller]
    fn refused(&self, words: &[&str]) {
        let error = self.read().expect_err("it was read");
        let message = error.to_string();
        assert!(error.exit_code() == 3 && !message.contains("damaged"), "{message}");
        assert!(words.iter().all(|part| message.contains(part)), "{words:?} in {message}");
    }
}

#[test]
fn numbers_of_every_type_are_read() {
    let column = |file, output, of: fn(f64) -> f64| {
        let expected: Vec<f64> = (0..60).map(|i| of(f64::from(i))).collect();
        assert_eq!(Asked { file, output, ..USUAL }.output(), expected, "{file}, {output}");
    };
    for output in ["int8", "int16", "int32", "int64", "float"] {
        column("types", output, |i| -i);
    }
    for output in ["uint8", "uint16", "uint32", "uint64"] {
        column("types", output, |i| i);
    }
    column("types", "halffloat", |i| i / 4.0);
    column("types", "truth", |i| i % 2.0);
    column("types", "decimal", |i| -i / 100.0);
    column("types", "decimal32", |i| i / 4.0);
    column("types", "decimal_long", |i| -i / 100.0);
    column("types", "text", |i| i / 4.0);
    column("types", "category_int", |i| i % 7.0);
}

#[test]
fn numbers_are_read_from_files_of_other_writers_too() {
    let of = |output| Asked { file: "plain", trial: "run_category", output, ..USUAL }.output();
    assert_eq!(of("int8"), (0..60).map(|i| f64::from(-i)).collect::<Vec<_>>());
    assert_eq!(of("uint16"), (0..60).map(f64::from).collect::<Vec<_>>());
    assert_eq!(of("truth"), (0..60).map(|i| f64::from(i % 2)).collect::<Vec<_>>());
    assert_eq!(of("decimal"), (0..60).map(|i| -f64::from(i) / 100.0).collect::<Vec<_>>());
}

#[test]
fn an_empty_cell_of_a_small_integer_is_a_lost_marker() {
    let values = Asked { output: "gaps", ..USUAL }.output();
    assert_eq!(values, (0..60).filter(|i| i % 10 != 3).map(f64::from).collect::<Vec<_>>());
}

#[test]
fn names_of_trials_may_have_any_type_of_text_or_integers() {
    for trial in ["run_category", "run_large", "run_view"] {
        let campaign = Asked { trial, ..USUAL }.read().unwrap_or_else(|e| panic!("{trial}: {e}"));
        assert_eq!(
            campaign.trials.iter().map(|t| (t.name.as_str(), t.samples())).collect::<Vec<_>>(),
            [("a", 30), ("b", 30)]
        );
    }
    // two integers that are one float
    for (trial, names) in [("run_int8", ["1", "2"]), ("run_int64", ["9007199254740993", "9007199254740994"])] {
        let set = Asked { trial, ..USUAL }.set();
        set.edit("manifest.toml", "\"a\", \"b\"", &format!("{:?}, {:?}", names[0], names[1]));
        assert_eq!(set.campaign().trials.iter().map(|t| t.name.clone()).collect::<Vec<_>>(), names);
    }
}

/// Steps of one tick and 10 ms, from the first sample of each trial: all exact, the nanoseconds too.
#[test]
fn instants_and_times_of_day_count_from_the_trials_first_sample() {
    let steps = |k: i64, per_second: i64| (0..30).map(|i| (i * k) as f64 / per_second as f64).collect::<Vec<_>>();
    let units = [("s", 1, 1), ("ms", 10, 1000), ("us", 10_000, 1_000_000), ("ns", 10_000_001, 1_000_000_000)];
    for (unit, step, per_second) in units {
        for kind in ["timestamp_UNIT", "timestamp_UNIT_utc", "time_UNIT"] {
            let column = kind.replace("UNIT", unit);
            let time = format!("{{ column = {column:?} }}").leak();
            let expected = steps(step, per_second);
            assert_eq!(Asked { time, ..USUAL }.times(), [expected.clone(), expected], "{column}");
        }
    }
    let days: Vec<f64> = (0..30).map(|i| 86_400.0 * f64::from(i)).collect();
    for time in ["{ column = \"date32\" }", "{ column = \"date64\" }"] {
        assert_eq!(Asked { time, ..USUAL }.times(), [days.clone(), days.clone()], "{time}");
    }
    let time = "{ column = \"timestamp_ns\" }";
    assert_eq!(Asked { file: "int96", time, ..USUAL }.times()[1], steps(10_000_001, 1_000_000_000));
    let time = "{ column = \"timestamp_us\" }";
    assert_eq!(Asked { file: "plain", trial: "run_category", time, ..USUAL }.times()[1], steps(10_000, 1_000_000));
    let time = "{ column = \"time_ms\" }";
    assert_eq!(Asked { file: "plain", trial: "run_category", time, ..USUAL }.times()[1], steps(10, 1000));
}

#[test]
fn durations_are_as_they_stand() {
    let units = [("s", 1, 1), ("ms", 10, 1000), ("us", 10_000, 1_000_000), ("ns", 10_000_001, 1_000_000_000i64)];
    for (unit, step, per_second) in units {
        let time = format!("{{ column = \"duration_{unit}\" }}").leak();
        let at = |i: i64| (per_second + i * step) as f64 / per_second as f64;
        let expected = [(0..30).map(at).collect::<Vec<_>>(), (30..60).map(at).collect()];
        assert_eq!(Asked { time, ..USUAL }.times(), expected, "{unit}");
    }
}

#[test]
fn a_unit_beside_a_type_of_time_is_not_used_and_named() {
    let asked = |time| Asked { time, ..USUAL };
    let same = asked("{ column = \"timestamp_ms\", unit = \"ms\" }").set().campaign();
    assert_eq!(same.warnings, [""; 0]);
    let other = asked("{ column = \"timestamp_ms\", unit = \"ns\" }").set().campaign();
    assert_eq!(other.trials[0].time, same.trials[0].time);
    let [warning] = other.warnings.as_slice() else { panic!("{:?}", other.warnings) };
    for part in [
        "manifest.toml:6:",
        "column `timestamp_ms` is of type timestamp[ms]",
        "unit = \"ns\" is not used",
        "leave it out",
    ] {
        assert!(warning.contains(part), "{part} in {warning}");
    }
    let no_numbers = ["timestamp[ms] are no sample numbers; leave `unit` and `rate_hz` out"];
    asked("{ column = \"timestamp_ms\", unit = \"sample\", rate_hz = 100.0 }").refused(&no_numbers);
    asked("{ column = \"int64\" }").refused(&["column `int64`: its values are plain numbers", "add unit = \"s\""]);
    let empty = "types.parquet, row 6, column `timestamp_gap`: the cell is empty";
    asked("{ column = \"timestamp_gap\" }").refused(&[empty]);
}

#[test]
fn what_is_not_read_is_named_by_type_and_column() {
    let (numbers, times) = ("are not numbers; write the column", "are times and not numbers; name another");
    for (output, kind, remedy) in [
        ("struct", "struct", numbers),
        ("map", "map", numbers),
        ("binary", "binary", numbers),
        ("fixed", "fixed_size_binary[4]", numbers),
        ("decimal256", "decimal(50, 2)", numbers),
        ("timestamp_us", "timestamp[us]", times),
        ("duration_ms", "duration[ms]", times),
        ("date32", "date32[day]", times),
    ] {
        let expected = format!("types.parquet, column `{output}`: values of type {kind} {remedy}");
        Asked { output, ..USUAL }.refused(&[&expected]);
    }
    let low = "row 1, column `words`: \"low\" is not a number, likewise 59 more (rows 2 to 60)";
    Asked { output: "words", ..USUAL }.refused(&[low]);
}

/// Two columns with a problem are two problems.
#[test]
fn all_columns_are_named_at_once() {
    let set = Asked { output: "list", ..USUAL }.set();
    set.edit(
        "manifest.toml",
        "[roles]",
        "[[measured]]\ncolumn = \"binary\"\nunit = \"1\"\n[[measured]]\ncolumn = \"lost\"\nunit = \"1\"\n[roles]",
    );
    let message = set.error();
    assert!(message.contains("`binary`") && message.contains("column `lost` is missing"), "{message}");
}
