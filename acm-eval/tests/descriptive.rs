//! The descriptive studies of the embedded campaign as tables and figures.

use std::path::{Path, PathBuf};

use acm_datasets::files::table::read_parquet;
use acm_eval::{
    chapter::{nominal, residual},
    figures::Drawing,
    tables::Table,
};
use acm_train::{
    config::{Source, kind},
    run::{progress::Progress, stop::Stop},
    schedule::{request::Request, study::conduct},
};

/// Conducts `experiments/<name>.toml` into `<root>/<name>`.
fn conducted(name: &str, root: &Path) -> PathBuf {
    let file = std::path::absolute("../experiments").unwrap().join(format!("{name}.toml"));
    let source = Source::read(&file, &[]).unwrap();
    let kind = kind(&source).unwrap().unwrap();
    let out = root.join(name);
    let (progress, stop) = (Progress::Quiet, Stop::default());
    let request = Request::new(&out, &progress, &stop);
    conduct(kind, source, &request).unwrap();
    out
}

/// Draws everything; `KEEP_FIGURES=folder` keeps the pictures for the eye.
fn check(figures: &[(&str, &str, Drawing)], series: &[(&str, usize)]) {
    let drawn: Vec<(&str, usize)> = figures.iter().map(|(name, _, drawing)| (*name, drawing.series)).collect();
    assert_eq!(drawn, series);
    for (name, question, drawing) in figures {
        let svg = drawing.svg(name, question, "command");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>") && svg.contains("SYNTHETIC DATA"), "{name}");
        assert!(question.ends_with('?') && svg.contains(question) && drawing.explanation.ends_with('.'), "{name}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name} has a coordinate that is no number");
        let png = drawing.png(name).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let channels = pixels.len() / (info.width * info.height) as usize;
        let inked = pixels.chunks(channels).filter(|pixel| pixel[..3] != [255; 3]).count();
        assert!(info.width > 1000 && inked > 5_000, "{name}: {} × {}, {inked} inked", info.width, info.height);
        if let Ok(folder) = std::env::var("KEEP_FIGURES") {
            std::fs::write(Path::new(&folder).join(format!("{name}.png")), &png).unwrap();
            std::fs::write(Path::new(&folder).join(format!("{name}.svg")), svg).unwrap();
        }
    }
}

/// A cell of a table's CSV, by the text that its row begins with and its column's heading.
fn cell(tables: &[Table], table: &str, row: &str, column: &str) -> f64 {
    let csv = tables.iter().find(|t| t.name == table).unwrap().csv();
    let mut lines = csv.lines();
    let heading = lines.next().unwrap().replace("\"", "");
    // Headings may have commas of their own, so columns are counted from the right.
    let from_right = heading[heading.find(column).unwrap()..].split(',').count();
    let line = lines.find(|line| line.starts_with(row)).unwrap_or_else(|| panic!("no row {row} in\n{csv}"));
    line.rsplit(',').nth(from_right - 1).unwrap().parse().unwrap()
}

/// Oracle for the tables: root mean squares in mm, computed from the Parquet tables by loops of this test.
fn rms(path: &Path, a: &str, b: &str, outputs: &[&str]) -> f64 {
    let table = read_parquet(path).unwrap();
    let column = |name: String| table.iter().find(|(known, _)| *known == name).unwrap().1.numbers().unwrap().to_vec();
    let mut sum = 0.0;
    let mut rows = 0;
    for output in outputs {
        let (a, b) = (column(format!("{a}_{output}")), column(format!("{b}_{output}")));
        rows = a.len();
        sum += a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    }
    1000.0 * (sum / rows as f64).sqrt()
}

#[test]
fn the_nominal_study() {
    let root = tempfile::tempdir().unwrap();
    let out = conducted("nominal", root.path());
    let study = nominal::read(&out).unwrap();
    // Orders × bars; models × (x, y, z, 3D and trials); 3 coordinates × trials × (measured, two models); orders above
    // the lowest × (two of the lowest, itself, measured); bars × (trials and all).
    let series =
        [("orders", 4 * 4), ("models", 3 * (4 + 5)), ("tip", 3 * 5 * 3), ("plane", 3 * 4), ("left-out", 4 * 6)];
    check(&nominal::figures(&study), &series);
    let tables = nominal::tables(&study);
    let near = |shown: f64, computed: f64| assert!((shown - computed).abs() < 1e-9, "{shown} is shown for {computed}");
    let (bins, samples) = (out.join("predictions/calibration.parquet"), out.join("predictions/bins.parquet"));
    near(
        cell(&tables, "models", "\"Polynomial, degree 3\",fitted", "3-D"),
        rms(&bins, "measured", "polynomial", &["x", "y", "z"]),
    );
    near(
        cell(&tables, "models", "\"Strain, joint polish\",left out", "y [mm]"),
        rms(&bins, "measured", "left_out_strain_joint", &["y"]),
    );
    let frozen = rms(&samples, "measured", "order1_frozen", &["x", "z"]);
    let orders = tables.iter().find(|table| table.name == "orders").unwrap();
    near(1e3 * orders.rows[1].cells[2].spread().unwrap().mean, frozen);
    assert_eq!(tables.iter().find(|table| table.name == "trials").unwrap().rows.len(), 5 * 3);
}

#[test]
fn the_residual_study() {
    let root = tempfile::tempdir().unwrap();
    let out = conducted("residual", root.path());
    let study = residual::read(&out).unwrap();
    // Four bars over all and at each of four altitudes, twelve trials and a line; coordinates × slices; arms and arrows.
    let series = [("size", 4 + 4 * 4 + 12 + 1), ("curves", 3 * 3), ("arm", 2 * 3 * 5)];
    check(&residual::figures(&study), &series);
    let tables = residual::tables(&study);
    let overall = rms(&out.join("predictions/residual.parquet"), "measured", "nominal", &["x", "y", "z"]);
    assert!((cell(&tables, "groups", "all", "3-D") - overall).abs() < 1e-9);
    assert_eq!(tables.iter().find(|table| table.name == "trials").unwrap().rows.len(), 12);
    assert!(tables[0].note.contains("Held-out trials are among"), "{}", tables[0].note);
}

#[test]
fn a_folder_of_another_study_and_a_damaged_one_are_told() {
    let root = tempfile::tempdir().unwrap();
    let out = conducted("residual", root.path());
    let refused = nominal::read(&out).unwrap_err().to_string();
    assert!(refused.contains("another kind") && refused.contains("experiments/nominal.toml"), "{refused}");
    let missing = residual::read(root.path()).unwrap_err().to_string();
    assert!(missing.contains("study.json"), "{missing}");
    let text = std::fs::read_to_string(out.join("study.json")).unwrap();
    std::fs::write(out.join("study.json"), &text[..text.len() / 2]).unwrap();
    let damaged = residual::read(&out).unwrap_err().to_string();
    assert!(damaged.contains("study.json:") && damaged.contains("damaged"), "{damaged}");
    let folder = conducted("nominal", root.path());
    std::fs::remove_file(folder.join("predictions/bins.parquet")).unwrap();
    let without = nominal::read(&folder).unwrap_err().to_string();
    assert!(without.contains("bins.parquet") && without.contains("--resume"), "{without}");
}
