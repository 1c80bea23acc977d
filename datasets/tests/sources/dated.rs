//! Two files stamped by one clock that begin at different instants: with dates, or with seconds since 1970.

use acm_datasets::{Recordings, recordings::Options};

const MANIFEST: &str = r#"
provenance = "made by a test"

[[source]]
name  = "camera"
files = ["run_camera.csv"]
trial = { file = "(.*)_camera" }
time  = { column = "stamp" }
clock = "reference"

[[source]]
name  = "motor"
files = ["run_motor.csv"]
trial = { file = "(.*)_motor" }
time  = { column = "stamp" }
clock = "same"

[[actuator]]
column = "motor.q"
unit   = "rad"

[[measured]]
column = "camera.x"
unit   = "m"

[roles]
development = ["run"]
"#;

/// 2026-03-03, 12:00 UTC, s since 1970.
const NOON: f64 = 1772539200.0;

/// A date in March 2026 at a time after 12:00, s.
fn date(day: u32, at: f64) -> String {
    format!("2026-03-{day:02}T12:{:02}:{:06.3}Z", at as u32 / 60, at % 60.0)
}

/// A table of 20 Hz from an instant after 12:00 on; the value is the instant itself, in s.
fn table(column: &str, start: f64, stamp: &dyn Fn(f64) -> String) -> String {
    let row = |i: u32| start + f64::from(i) / 20.0;
    (0..400).map(row).fold(format!("stamp,{column}\n"), |text, at| text + &format!("{},{at:.2}\n", stamp(at)))
}

fn open(manifest: &str, of_motor: &dyn Fn(f64) -> String) -> Result<Recordings, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("manifest.toml", manifest);
    write("run_camera.csv", &table("x", 5.0, &|at| date(3, at)));
    write("run_motor.csv", &table("q", 2.75, of_motor));
    Recordings::open(folder.path(), None, &Options::default()).map_err(|error| error.to_string())
}

/// Oracle: both columns hold the instant of their sample.
#[test]
fn dates_of_one_clock_are_compared() {
    let seconds = MANIFEST.replace(
        "time  = { column = \"stamp\" }\nclock = \"same\"",
        "time = { column = \"stamp\", unit = \"s\" }\nclock = \"same\"",
    );
    assert_ne!(seconds, MANIFEST);
    let number = |at: f64| format!("{:.3}", NOON + at);
    for data in [open(MANIFEST, &|at| date(3, at)), open(&seconds, &number)] {
        let trial = data.expect("opened").all().next().expect("a trial").expect("read").into_owned();
        assert!(trial.samples() > 300, "{}", trial.samples());
        for i in 0..trial.samples() {
            assert!((trial.actuators[(i, 0)] - trial.measured[(i, 0)]).abs() < 1e-5, "sample {i}");
        }
    }
}

#[test]
fn dates_of_two_days_do_not_overlap() {
    let message = open(MANIFEST, &|at| date(4, at)).map(|_| ()).expect_err("refused");
    assert!(message.contains("does not overlap with the reference; correct the offset"), "{message}");
}
