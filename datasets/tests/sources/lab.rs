//! A small campaign as a laboratory has it, in a folder that disappears with the value.

use std::fmt::Write;
use std::path::PathBuf;

use crate::ulog_file::Log;

/// Frames without the marker in each take.
pub const OCCLUDED: usize = 24;

/// Seconds of a take.
const SECONDS: f64 = 30.0;

pub struct Lab(tempfile::TempDir);

const MANIFEST: &str = r#"
provenance = "made by a test"

[[source]]
name   = "mocap"
files  = ["*_mocap.csv"]
format = "motive"
trial  = { file = "(.*)_mocap" }
clock  = "reference"

[[source]]
name   = "motors"
files  = ["*_motors.csv"]
trial  = { file = "(.*)_motors" }
time   = { column = "t", unit = "s" }
offset = "estimate"
drift  = { ppm = 0.0 }
resample = "linear"

[[source]]
name   = "log"
files  = ["flight.ulg"]
shared = true
offset = { estimate = "estimate", by = ["mocap.Tip.Position.X", "log.pose.p[0]"] }
gap    = { value = 0.3, unit = "s" }

[[actuator]]
column = "motors.q1"
unit   = "rad"

[[context]]
column = "log.power.volt"
unit   = "V"
name   = "battery"

[[measured]]
column = "mocap.Tip.Position.X"
unit   = "mm"
name   = "tip"

[roles]
development = ["a", "b", "c"]
"#;

/// The motion of take `k`, rad; the tip moves by 0.1 m per rad.
pub fn motion(k: usize, t: f64) -> f64 {
    let s = t + 100.0 * k as f64;
    let turned = |rate: f64, size: f64, slow: f64| rate * s + size * (slow * s).sin();
    0.5 * turned(1.7, 2.0, 0.23).sin() + 0.4 * turned(0.83, 3.0, 0.11).cos() + 0.2 * turned(2.9, 2.5, 0.31).sin()
}

/// What is added to the clock of the commands.
pub fn motors_offset(k: usize) -> f64 {
    [0.7, 0.713, -0.4][k]
}

/// What is added to the clock of the flight log, which runs since boot.
pub fn log_offset(k: usize) -> f64 {
    -(50.0 + 40.0 * k as f64)
}

/// Of the battery: it falls, on the log's clock.
pub fn volt(k: usize, t: f64) -> f64 {
    16.0 - 0.01 * (t - log_offset(k))
}

impl Lab {
    pub fn new() -> Lab {
        Lab::of(3, SECONDS)
    }

    /// So many takes of so many seconds.
    pub fn of(takes: usize, seconds: f64) -> Lab {
        let (lab, names) = (Lab(tempfile::tempdir().expect("a folder")), &["a", "b", "c"][..takes]);
        lab.write("manifest.toml", &MANIFEST.replace("[\"a\", \"b\", \"c\"]", &format!("{names:?}")));
        for (k, name) in names.iter().enumerate() {
            lab.write(&format!("{name}_mocap.csv"), &mocap(k, seconds));
            lab.write(&format!("{name}_motors.csv"), &motors(k, seconds));
        }
        std::fs::write(lab.path().join("flight.ulg"), flight(takes, seconds)).expect("written");
        lab
    }

    pub fn path(&self) -> PathBuf {
        self.0.path().to_path_buf()
    }

    pub fn manifest() -> String {
        MANIFEST.to_string()
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).expect("written");
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).expect("read")
    }
}

/// A body at 120 Hz, in millimetres, with an occlusion.
fn mocap(k: usize, seconds: f64) -> String {
    let mut text = String::from(
        "Format Version,1.23,Take Name,x,Capture Frame Rate,120,Export Frame Rate,120,Rotation Type,XYZ,Length Units,Millimeters\n\n\
         ,Type,Rigid Body,Rigid Body\n,Name,Tip,Tip\n,ID,\"1\",\"1\"\n,,Position,Position\nFrame,Time (Seconds),X,Y\n",
    );
    for frame in 0..(seconds * 120.0) as usize {
        let t = frame as f64 / 120.0;
        let cell = if (1000..1000 + OCCLUDED).contains(&frame) {
            String::new()
        } else {
            format!("{:.5}", 100.0 * motion(k, t))
        };
        let _ = writeln!(text, "{frame},{t:.3},{cell},{:.5}", 3.0 * t);
    }
    text
}

/// Commands at 50 Hz: they begin before the take, pause for half a second, and end two seconds before it.
fn motors(k: usize, seconds: f64) -> String {
    let mut text = String::from("t,q1,q2\n");
    for i in 0..(50.0 * seconds) as usize {
        let t = -2.0 + i as f64 / 50.0;
        if (20.0..20.5).contains(&t) {
            continue;
        }
        let _ = writeln!(text, "{:.4},{:.6},0", t - motors_offset(k), motion(k, t));
    }
    text
}

/// One log of all takes at 100 Hz, with still stretches between them.
fn flight(takes: usize, seconds: f64) -> Vec<u8> {
    let mut log = Log::new();
    for i in 0..(100.0 * (seconds - log_offset(takes - 1) - 10.0)) as usize {
        let u = 45.0 + i as f64 / 100.0;
        let k = (0..takes).rev().find(|k| u + log_offset(*k) >= -2.0).unwrap_or(0);
        let t = (u + log_offset(k)).clamp(-2.0, seconds + 2.0);
        log.pose(3, (u * 1e6).round() as u64, motion(k, t) as f32);
        if i % 10 == 0 {
            log.power((u * 1e6).round() as u64, 16.0 - 0.01 * u);
        }
    }
    log.0
}
