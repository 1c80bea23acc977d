//! Writes the recordings of the tutorial: takes of motion capture, commands and one flight log, each with a clock of its own.
//!
//! ```text
//! cargo run -p acm-datasets --example three_clocks -- datasets/three-clocks
//! ```
//!
//! A tip that two motors move, in five trials of 20 s:
//!
//! ```text
//! p₁ = play(q₁, 0.06 rad)
//! x  = (80 + 3·(V − 15.5))·p₁ + 8·p₁·q₂        y = 60·q₂ − 12·p₁²        z = 20·p₁ + 5·q₂        mm, with noise of 0.05 mm
//! V  = 16.5 − 0.012·u                           V, u the time of the log
//! ```
//!
//! | file | format | rate | its clock |
//! | --- | --- | --- | --- |
//! | `<trial>_mocap.csv` | Motive 1.23 | 50 Hz | 0 at the take's start |
//! | `<trial>_motors.csv` | a table | 30 Hz | 0.2 to 0.9 s behind, another in each trial |
//! | `flight.ulg` | ULog | 10 Hz | since boot, all trials |

#![allow(missing_docs)]

#[path = "../tests/formats/ulog_file.rs"]
#[allow(dead_code)] // its topics are those of a test
mod ulog_file;

use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use ulog_file::Log;

/// Names of the trials, and how fast they are.
const TRIALS: [(&str, f64); 5] = [("slow", 0.4), ("run1", 1.0), ("run2", 1.0), ("run3", 1.0), ("run4", 1.0)];

/// Length of a take, s.
const SECONDS: f64 = 20.0;

/// Recorded before and after each take by the others, s.
const AROUND: f64 = 1.0;

/// Half of the play, rad.
const PLAY: f64 = 0.06;

/// Commands of trial `k`, rad.
fn commands(k: usize, t: f64) -> [f64; 2] {
    let s = TRIALS[k].1 * t + 40.0 * k as f64;
    let turned = |rate: f64, size: f64, slow: f64| (rate * s + size * (slow * s).sin()).sin();
    let q1 = 0.45 * turned(1.7, 2.0, 0.23) + 0.3 * turned(0.83, 3.0, 0.11) + 0.15 * turned(2.9, 2.5, 0.31);
    let q2 = 0.45 * turned(1.3, 2.3, 0.19) + 0.3 * turned(0.67, 2.7, 0.13) + 0.15 * turned(2.3, 2.1, 0.37);
    [q1, q2]
}

/// Added to the clock of the commands, s.
fn motors_offset(k: usize) -> f64 {
    [0.31, 0.742, 0.208, 0.883, 0.555][k]
}

/// Time of the log at which take `k` begins, s.
fn begins(k: usize) -> f64 {
    14.3 + 24.7 * k as f64
}

fn volt(u: f64) -> f64 {
    16.5 - 0.012 * u
}

/// Positions of the tip in steps of 1 ms from `AROUND` before the take, mm, without noise.
fn tip(k: usize) -> Vec<[f64; 3]> {
    let mut p1 = commands(k, -AROUND)[0];
    let step = |i: usize| {
        let t = i as f64 / 1000.0 - AROUND;
        let [q1, q2] = commands(k, t);
        p1 = p1.clamp(q1 - PLAY, q1 + PLAY);
        let gain = 80.0 + 3.0 * (volt(begins(k) + t) - 15.5);
        [gain * p1 + 8.0 * p1 * q2, 60.0 * q2 - 12.0 * p1 * p1, 20.0 * p1 + 5.0 * q2]
    };
    (0..=((SECONDS + 2.0 * AROUND) * 1000.0) as usize).map(step).collect()
}

fn at(tip: &[[f64; 3]], t: f64) -> [f64; 3] {
    tip[((t + AROUND) * 1000.0).round() as usize]
}

fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (a, b): (f64, f64) = (random.random_range(1e-12..1.0), random.random_range(0.0..1.0));
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// A body at 50 Hz; in `run2` it is occluded for 0.4 s.
fn mocap(k: usize, tip: &[[f64; 3]], random: &mut ChaCha8Rng) -> Result<String, std::fmt::Error> {
    let frames = (SECONDS * 50.0) as usize;
    let mut text = format!(
        "Format Version,1.23,Take Name,{},Capture Frame Rate,50.000000,Export Frame Rate,50.000000,Total Exported \
         Frames,{frames},Rotation Type,XYZ,Length Units,Millimeters,Coordinate Space,Global\r\n\r\n,Type,Rigid Body,Rigid \
         Body,Rigid Body\r\n,Name,Tip,Tip,Tip\r\n,ID,\"1\",\"1\",\"1\"\r\n,,Position,Position,Position\r\nFrame,Time \
         (Seconds),X,Y,Z\r\n",
        TRIALS[k].0
    );
    for frame in 0..frames {
        let t = frame as f64 / 50.0;
        let mut measured = || at(tip, t).map(|value| value + 0.05 * normal(random));
        match (k, frame) {
            (2, 300..320) => write!(text, "{frame},{t:.2},,,\r\n")?,
            _ => {
                let [x, y, z] = measured();
                write!(text, "{frame},{t:.2},{x:.2},{y:.2},{z:.2}\r\n")?;
            }
        }
    }
    Ok(text)
}

/// Commands at 30 Hz.
fn motors(k: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::from("t,q1,q2\n");
    for i in 0..((SECONDS + 2.0 * AROUND) * 30.0) as usize {
        let t = i as f64 / 30.0 - AROUND;
        let [q1, q2] = commands(k, t);
        writeln!(text, "{:.3},{q1:.4},{q2:.4}", t - motors_offset(k))?;
    }
    Ok(text)
}

/// The log: the tip's position as it is sent to the vehicle, and the battery.
fn flight(tips: &[Vec<[f64; 3]>]) -> Vec<u8> {
    let mut log = Log(b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec());
    log.record(b'B', &[0; 40]);
    log.record(b'F', b"vehicle_visual_odometry:uint64_t timestamp;float[3] position;");
    log.record(b'F', b"battery_status:uint64_t timestamp;float voltage_v;");
    log.record(b'A', b"\0\x01\0vehicle_visual_odometry");
    log.record(b'A', b"\0\x02\0battery_status");
    let end = begins(TRIALS.len() - 1) + SECONDS + AROUND;
    for i in 0..=((end - 10.0) * 10.0) as usize {
        let u = 10.0 + i as f64 / 10.0;
        let k = (0..TRIALS.len()).rev().find(|k| u >= begins(*k) - AROUND).unwrap_or(0);
        let t = (u - begins(k)).clamp(-AROUND, SECONDS + AROUND);
        let micros = ((u * 1e6).round() as u64).to_le_bytes();
        let metres = at(&tips[k], t).map(|value| ((value * 100.0).round() / 1e5) as f32);
        let position: Vec<u8> = metres.iter().flat_map(|value| value.to_le_bytes()).collect();
        log.record(b'D', &[[1, 0].as_slice(), &micros, &position].concat());
        if i % 5 == 0 {
            let volt = ((volt(u) * 1e3).round() / 1e3) as f32;
            log.record(b'D', &[[2, 0].as_slice(), &micros, &volt.to_le_bytes()].concat());
        }
    }
    log.0
}

/// Name and content of each file.
///
/// # Errors
/// Text cannot be written to memory.
pub fn files() -> Result<Vec<(String, Vec<u8>)>, std::fmt::Error> {
    let tips: Vec<Vec<[f64; 3]>> = (0..TRIALS.len()).map(tip).collect();
    let mut files = vec![("flight.ulg".to_string(), flight(&tips))];
    for (k, (name, _)) in TRIALS.iter().enumerate() {
        let mut random = ChaCha8Rng::seed_from_u64(18);
        random.set_stream(k as u64);
        files.push((format!("{name}_mocap.csv"), mocap(k, &tips[k], &mut random)?.into_bytes()));
        files.push((format!("{name}_motors.csv"), motors(k)?.into_bytes()));
    }
    Ok(files)
}

#[allow(dead_code)] // a test has the files alone
fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder")?);
    std::fs::create_dir_all(&folder)?;
    for (name, bytes) in files()? {
        println!("{name}: {} bytes", bytes.len());
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}
