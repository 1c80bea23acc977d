//! Two files with dates, stamped by one clock, that begin at different instants.

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

/// A table of 20 Hz from an instant after 12:00 on; the value is the instant itself, in s.
fn table(column: &str, start: f64, day: u32) -> String {
    let row = |i: u32| {
        let (at, whole) = (start + f64::from(i) / 20.0, (start + f64::from(i) / 20.0) as u32);
        format!("2026-03-{day:02}T12:{:02}:{:06.3}Z,{at:.2}\n", whole / 60, at % 60.0)
    };
    (0..400).map(row).fold(format!("stamp,{column}\n"), |text, row| text + &row)
}

fn open(motor_day: u32) -> Result<Recordings, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("manifest.toml", MANIFEST);
    write("run_camera.csv", &table("x", 5.0, 3));
    write("run_motor.csv", &table("q", 2.75, motor_day));
    Recordings::open(folder.path(), None, &Options::default()).map_err(|error| error.to_string())
}

/// Oracle: both columns hold the instant of their sample.
#[test]
fn dates_of_one_clock_are_compared() {
    let data = open(3).expect("opened");
    let trial = data.all().next().expect("a trial").expect("read").into_owned();
    assert!(trial.samples() > 300, "{}", trial.samples());
    for i in 0..trial.samples() {
        assert!((trial.actuators[(i, 0)] - trial.measured[(i, 0)]).abs() < 1e-9, "sample {i}");
    }
}

#[test]
fn dates_of_two_days_do_not_overlap() {
    let message = open(4).map(|_| ()).expect_err("refused");
    assert!(message.contains("does not overlap with the reference; correct the offset"), "{message}");
}
