//! How fast recordings are read on one core, beside the crates that know the formats.
//!
//! ```text
//! cargo run -p acm-datasets --features mcap --example recording_speed -- [MEGABYTES]
//! ```
//!
//! Each file is made here, read once before it is timed, and then the fastest of five readings counts. `some` keeps three
//! columns, as a manifest asks for them; `all` keeps every one. The other readers decode every message (`px4-ulog`: a callback for
//! each; `mcap`: payloads, not their fields), or every cell (polars, one thread).

#![allow(missing_docs)]

#[path = "../tests/formats/ulog_file.rs"]
#[allow(dead_code)] // its samples are those of a test
mod ulog_file;

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use acm_datasets::formats::{self, Format, Keep};
use polars_io::prelude::{CsvReadOptions, SerReader};
use ulog_file::Log;

fn main() -> Result<(), Box<dyn Error>> {
    let megabytes: usize = std::env::args().nth(1).map_or(Ok(60), |text| text.parse())?;
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name);
    let (ulg, csv) = (path("log.ulg"), path("take.csv"));
    std::fs::write(&ulg, ulog(megabytes << 20))?;
    ours(&ulg, Format::Ulog, &["pose.p[0]", "pose.p[1]", "power.volt"])?;
    report(&ulg, "px4-ulog", || by_px4_ulog(&ulg))?;
    std::fs::write(&csv, motive(megabytes << 20)?)?;
    ours(&csv, Format::Motive, &["B0.Position.X", "B0.Position.Y", "B7.Position.Z"])?;
    report(&csv, "polars", || by_polars(&csv))?;
    #[cfg(feature = "mcap")]
    {
        for (name, compression) in [("plain.mcap", None), ("lz4.mcap", Some(mcap::Compression::Lz4))] {
            let file = path(name);
            std::fs::write(&file, ros(megabytes << 20, compression)?)?;
            ours(&file, Format::Mcap, &["/joints.position[0]", "/joints.position[1]", "/joints.velocity[2]"])?;
            report(&file, "mcap", || by_mcap(&file))?;
        }
    }
    Ok(())
}

fn ours(path: &Path, format: Format, some: &[&str]) -> Result<(), Box<dyn Error>> {
    let names: BTreeSet<String> = some.iter().map(ToString::to_string).collect();
    let count = |keep: Keep| -> Result<usize, Box<dyn Error>> {
        let take = formats::read(path, format, keep)?;
        Ok(take.groups.iter().map(|group| group.samples).sum())
    };
    report(path, "ours, some", || count(Keep::Named(&names)))?;
    report(path, "ours, all", || count(Keep::All))
}

/// The fastest of five.
fn report(path: &Path, who: &str, read: impl Fn() -> Result<usize, Box<dyn Error>>) -> Result<(), Box<dyn Error>> {
    let samples = read()?;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let begun = Instant::now();
        std::hint::black_box(read()?);
        best = best.min(begun.elapsed().as_secs_f64());
    }
    let megabytes = std::fs::metadata(path)?.len() as f64 / 1e6;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    println!("{name:<12} {who:<12} {:>7.1} MB/s   {best:.3} s, {samples} samples", megabytes / best);
    Ok(())
}

/// Poses of two instances, and a tenth as many voltages.
fn ulog(bytes: usize) -> Vec<u8> {
    let samples = bytes / 60;
    Log::of(samples as u64).0
}

fn by_px4_ulog(path: &Path) -> Result<usize, Box<dyn Error>> {
    use px4_ulog::stream_parser::LogParser;
    let bytes = std::fs::read(path)?;
    let mut samples = 0;
    let mut on_data = |_: &px4_ulog::stream_parser::model::DataMessage| samples += 1;
    let mut parser = LogParser::default();
    parser.set_data_message_callback(&mut on_data);
    for chunk in bytes.chunks(1 << 18) {
        parser.consume_bytes(chunk).map_err(|e| e.description)?;
    }
    drop(parser);
    Ok(samples)
}

/// Eight bodies at 120 Hz.
fn motive(bytes: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::from(
        "Format Version,1.23,Take Name,a,Capture Frame Rate,120,Export Frame Rate,120,Rotation Type,Quaternion,Length Units,Meters\n\n",
    );
    let mut line = |label: &str, of: &dyn Fn(usize, usize) -> String| -> std::fmt::Result {
        text += label;
        (0..8).try_for_each(|body| (0..7).try_for_each(|k| write!(text, ",{}", of(body, k))))?;
        text.push('\n');
        Ok(())
    };
    line(",Type", &|_, _| "Rigid Body".into())?;
    line(",Name", &|body, _| format!("B{body}"))?;
    line(",ID", &|body, _| format!("{body}"))?;
    line(",", &|_, k| if k < 4 { "Rotation" } else { "Position" }.into())?;
    line("Frame,Time (Seconds)", &|_, k| ["X", "Y", "Z", "W", "X", "Y", "Z"][k].into())?;
    for frame in 0.. {
        if text.len() >= bytes {
            break;
        }
        write!(text, "{frame},{:.6}", f64::from(frame) / 120.0)?;
        for column in 0..56 {
            write!(text, ",{:.6}", (f64::from(frame) * 0.01 + f64::from(column)).sin())?;
        }
        text.push('\n');
    }
    Ok(text)
}

fn by_polars(path: &Path) -> Result<usize, Box<dyn Error>> {
    let options = CsvReadOptions::default().with_n_threads(Some(1)).with_skip_lines(6);
    Ok(options.try_into_reader_with_file_path(Some(path.to_path_buf()))?.finish()?.height())
}

/// Twelve joints with position, velocity and effort.
#[cfg(feature = "mcap")]
fn ros(bytes: usize, compression: Option<mcap::Compression>) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut file = std::io::Cursor::new(Vec::new());
    let mut writer = mcap::WriteOptions::new().compression(compression).create(&mut file)?;
    let schema = b"std_msgs/Header header\nfloat64[12] position\nfloat64[12] velocity\nfloat64[12] effort\n====\nMSG: std_msgs/Header\n\
                   builtin_interfaces/Time stamp\nstring frame_id\n====\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
    let schema = writer.add_schema("a_msgs/msg/Joints", "ros2msg", schema)?;
    let channel_id = writer.add_channel(schema, "/joints", "cdr", &Default::default())?;
    for k in 0..(bytes / 340) as u32 {
        let mut data = vec![0, 1, 0, 0];
        [k / 1000, 1_000_000 * (k % 1000), 1].iter().for_each(|v| data.extend(v.to_le_bytes()));
        data.extend([0; 4]); // an empty name, and the padding of numbers of eight bytes
        (0..36).for_each(|j| data.extend((f64::from(k) * 0.001 + f64::from(j)).sin().to_le_bytes()));
        let (log_time, publish_time) = (u64::from(k) * 1_000_000, 0);
        writer.write_to_known_channel(
            &mcap::records::MessageHeader { channel_id, sequence: k, log_time, publish_time },
            &data,
        )?;
    }
    writer.finish()?;
    drop(writer);
    Ok(file.into_inner())
}

#[cfg(feature = "mcap")]
fn by_mcap(path: &Path) -> Result<usize, Box<dyn Error>> {
    let mut samples = 0;
    for message in mcap::MessageStream::new(&std::fs::read(path)?)? {
        samples += usize::from(!message?.data.is_empty());
    }
    Ok(samples)
}
