//! Whatever is wrong with a run folder: a message that names it and says what to do, an exit code, no panic.

mod fixture;

use std::path::Path;

use acm_train::store::hashed;
use assert_cmd::cargo::cargo_bin_cmd;
use fixture::{Fixture, write};

/// One way to spoil a run, and what must be said.
struct Case {
    name: &'static str,
    /// Given a good run folder.
    spoil: fn(&Path),
    code: i32,
    said: &'static [&'static str],
}

const RECORD: &str = "records/final-seed1.json";
const TABLE: &str = "predictions/final-seed1.parquet";

fn edit(path: &Path, change: impl Fn(String) -> String) {
    let text = std::fs::read_to_string(path).unwrap();
    let changed = change(text.clone());
    assert_ne!(text, changed, "the case spoils nothing");
    std::fs::write(path, changed).unwrap();
}

/// Another content, with a hash that fits.
fn change(path: &Path, change: impl Fn(&mut serde_json::Value)) {
    let mut value = serde_json::from_str(&hashed::verify(&std::fs::read(path).unwrap()).unwrap()).unwrap();
    change(&mut value);
    hashed::write(path, &value).unwrap();
}

const CASES: &[Case] = &[
    Case {
        name: "no such folder",
        spoil: |run| std::fs::remove_dir_all(run).unwrap(),
        code: 4,
        said: &["there is no such folder", "acm-train --config"],
    },
    Case {
        name: "not a run",
        spoil: |run| std::fs::remove_dir_all(run.join("records")).unwrap(),
        code: 2,
        said: &["is not a run folder", "records/", "acm-train"],
    },
    Case {
        name: "nothing finished",
        spoil: |run| {
            std::fs::remove_dir_all(run.join("records")).unwrap();
            std::fs::create_dir(run.join("records")).unwrap();
        },
        code: 2,
        said: &["no finished record yet", "--resume"],
    },
    Case {
        name: "truncated record",
        spoil: |run| edit(&run.join(RECORD), |text| text[..text.len() / 2].to_string()),
        code: 3,
        said: &["final-seed1.json:", "EOF", "--resume"],
    },
    Case {
        name: "a digit that changed",
        spoil: |run| edit(&run.join(RECORD), |text| text.replacen("12.5", "13.5", 1)),
        code: 3,
        said: &["final-seed1.json: ", "does not fit its SHA-256", "--resume"],
    },
    Case {
        name: "a record without its hash",
        spoil: |run| edit(&run.join(RECORD), |text| text.lines().filter(|l| !l.contains("\"sha256\"")).collect()),
        code: 3,
        said: &["final-seed1.json: ", "does not begin with its SHA-256", "--resume"],
    },
    Case {
        name: "a nominal model that changed",
        spoil: |run| edit(&run.join("nominal.json"), |text| text.replacen("1.23456", "1.33456", 1)),
        code: 3,
        said: &["nominal.json: ", "does not fit its SHA-256", "--resume"],
    },
    Case {
        name: "a word where a number belongs",
        spoil: |run| change(&run.join(RECORD), |record| record["seed"] = "one".into()),
        code: 3,
        said: &["final-seed1.json:", "invalid type: string \"one\""],
    },
    Case {
        name: "an error too few",
        spoil: |run| {
            change(&run.join(RECORD), |record| {
                record["held_out"]["trials"]["10"]["nominal"]["rmse"].as_array_mut().unwrap().pop();
            });
        },
        code: 3,
        said: &["final-seed1.json", "nominal has 2 errors", "3 outputs", "--resume"],
    },
    Case {
        name: "a record under another name",
        spoil: |run| {
            std::fs::copy(run.join("records/final-seed2.json"), run.join(RECORD)).unwrap();
        },
        code: 3,
        said: &["final-seed1.json", "the record of final-seed2, under another name", "--resume"],
    },
    Case {
        name: "later format",
        spoil: |run| edit(&run.join(RECORD), |_| "{\"format\": 99, \"all\": \"is new\"}".into()),
        code: 3,
        said: &["final-seed1.json", "format 99", "reads format 2", "newer acm-eval"],
    },
    Case {
        name: "former format, which had no hash",
        spoil: |run| edit(&run.join(RECORD), |_| "{\"format\": 1, \"id\": \"final-seed1\"}".into()),
        code: 3,
        said: &["final-seed1.json", "format 1", "train again"],
    },
    Case {
        name: "no nominal model",
        spoil: |run| std::fs::remove_file(run.join("nominal.json")).unwrap(),
        code: 4,
        said: &["nominal.json", "cannot read"],
    },
    Case {
        name: "no prediction table",
        spoil: |run| std::fs::remove_file(run.join(TABLE)).unwrap(),
        code: 3,
        said: &["final-seed1.parquet", "prediction table is missing", "--resume"],
    },
    Case {
        name: "a prediction that changed",
        spoil: |run| {
            let mut bytes = std::fs::read(run.join(TABLE)).unwrap();
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            std::fs::write(run.join(TABLE), bytes).unwrap();
        },
        code: 3,
        said: &["final-seed1.parquet", "not the table whose SHA-256", "--resume"],
    },
    Case {
        name: "truncated prediction table",
        spoil: |run| {
            let bytes = std::fs::read(run.join(TABLE)).unwrap();
            std::fs::write(run.join(TABLE), &bytes[..bytes.len() / 2]).unwrap();
        },
        code: 3,
        said: &["final-seed1.parquet", "delete the table and its record", "--resume"],
    },
    Case {
        name: "prediction table of another seed",
        spoil: |run| {
            std::fs::copy(run.join("predictions/final-seed2.parquet"), run.join(TABLE)).unwrap();
        },
        code: 3,
        said: &["final-seed1.parquet", "not the table whose SHA-256", "--resume"],
    },
    Case {
        name: "prediction table of another seed, with its hash",
        spoil: |run| {
            std::fs::copy(run.join("predictions/final-seed2.parquet"), run.join(TABLE)).unwrap();
            let hash = hashed::of_file(&run.join(TABLE)).unwrap();
            change(&run.join(RECORD), |record| record["predictions_sha256"] = hash.clone().into());
        },
        code: 3,
        said: &["final-seed1.parquet", "do not belong together", "--resume"],
    },
    Case {
        name: "records of two data sets",
        spoil: |run| change(&run.join(RECORD), |record| record["data"]["hash"] = "11ee".into()),
        code: 3,
        said: &["hash of the data", "must not be mixed"],
    },
    Case {
        name: "records of two trainings",
        spoil: |run| change(&run.join(RECORD), |record| record["experiment"]["training"]["batch"] = 7.into()),
        code: 3,
        said: &["differ in the settings of the experiment", "must not be mixed"],
    },
];

#[test]
fn each_is_named_with_a_remedy_and_an_exit_code() {
    for case in CASES {
        let root = tempfile::tempdir().unwrap();
        let run = write(&Fixture::default(), root.path(), "cfc");
        (case.spoil)(&run);
        let out = root.path().join("report");
        let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg("--out").arg(&out).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(case.code), "{}: {said}", case.name);
        for words in case.said {
            assert!(said.contains(words), "{}: `{words}` is not in: {said}", case.name);
        }
        assert!(said.contains("cfc") && !said.contains("panicked"), "{}: {said}", case.name);
        assert!(!out.exists(), "{}: a report was begun", case.name);
    }
}

#[test]
fn the_same_run_twice_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let run = write(&Fixture::default(), root.path(), "cfc");
    let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg(run.join(".")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("given twice"));
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let root = tempfile::tempdir().unwrap();
    let run = write(&Fixture::default(), root.path(), "cfc");
    let file = root.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let out = file.join("report");
    let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg("--out").arg(&out).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains("file/report") && said.contains("--out"), "{said}");
}

/// Errors at other time stamps are other errors: the first difference is named.
#[test]
fn runs_with_other_targets_are_not_compared() {
    let root = tempfile::tempdir().unwrap();
    let late = Fixture { kind: "gru", delay: 0.05, ..Fixture::default() };
    let (cfc, gru) = (write(&Fixture::default(), root.path(), "cfc"), write(&late, root.path(), "gru"));
    let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&cfc).arg(&gru).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    for words in ["cfc and ", "gru cannot be compared", "trial 11, target 1 is at 5 s", "5.05 s", "reach"] {
        assert!(said.contains(words), "`{words}` is not in: {said}");
    }
}

/// Runs on other data are shown, but never in one table.
#[test]
fn runs_on_other_data_get_a_section_each() {
    let root = tempfile::tempdir().unwrap();
    let other = Fixture { data: "other", hash: "beef", synthetic: false, delay: 0.05, ..Fixture::default() };
    let runs = [write(&Fixture::default(), root.path(), "cfc"), write(&other, root.path(), "other")];
    cargo_bin_cmd!("acm-eval").arg("report").args(&runs).assert().success();
    let page = std::fs::read_to_string(root.path().join("report/report.html")).unwrap();
    assert!(page.contains("<section id=\"made-up\">") && page.contains("<section id=\"other\">"));
    assert!(root.path().join("report/tables/other-errors.csv").is_file());
}

/// `acm-eval report runs/*` meets the report of last time, too.
#[test]
fn a_former_report_among_the_runs_is_passed_over() {
    let root = tempfile::tempdir().unwrap();
    let run = write(&Fixture::default(), root.path(), "cfc");
    let out = root.path().join("report");
    cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg("--out").arg(&out).assert().success();
    let second = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg(&out).output().unwrap();
    assert!(second.status.success(), "{}", String::from_utf8_lossy(&second.stderr));
    assert!(String::from_utf8_lossy(&second.stderr).contains("passed over"));
}

/// Every file below a folder, with its bytes.
fn all_below(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut all = vec![];
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true => all.extend(all_below(&path)),
            false => all.push((path.clone(), std::fs::read(&path).unwrap())),
        }
    }
    all.sort();
    all
}

/// A report takes the place of a report, and of nothing else.
#[test]
fn a_folder_of_something_else_is_left_alone() {
    let cases: [(&[&str], &str, &[&str]); 8] = [
        (&["out/report.html"], "out", &["its report.html is none of this program"]),
        (&["out/tables/errors.csv", "out/tables/mine.xlsx"], "out", &["it holds tables/mine.xlsx"]),
        (&["out/thesis.tex"], "out", &["it holds thesis.tex"]),
        (&["out/report.json"], "out", &["it holds report.json"]),
        (&["out/records/final-seed1.json"], "out", &["it holds records"]),
        (&["set/manifest.toml", "set/a.csv"], "set", &["set is a data set"]),
        (&["set/manifest.toml", "set/a.csv"], "set/report", &["set/report is no folder", "set is a data set"]),
        (&["set/manifest.toml", "set/deep/a.csv"], "set/deep/er", &["set is a data set"]),
    ];
    for (files, out, parts) in cases {
        let root = tempfile::tempdir().unwrap();
        let run = write(&Fixture::default(), root.path(), "cfc");
        for file in files {
            let path = root.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "somebody's").unwrap();
        }
        let (before, out) = (all_below(root.path()), root.path().join(out));
        let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).arg("--out").arg(&out).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{files:?}: {said}");
        for part in parts.iter().chain(&["give this one a folder of its own with `--out DIR`"]) {
            assert!(said.contains(part), "{files:?}: no {part:?} in {said}");
        }
        assert!(all_below(root.path()) == before, "{files:?}: something was written");
    }
}

/// As do the default places, where a run of that name may lie.
#[test]
fn a_run_in_the_default_place_is_left_alone() {
    let root = tempfile::tempdir().unwrap();
    let runs = [write(&Fixture::default(), root.path(), "cfc"), write(&Fixture::default(), root.path(), "report")];
    let before = all_below(&runs[1]);
    let output = cargo_bin_cmd!("acm-eval").arg("report").args(&runs).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(all_below(&runs[1]) == before);
}

/// Reports of former versions have no list of their files; they are replaced, and nothing of them stays.
#[test]
fn an_earlier_report_is_replaced() {
    let root = tempfile::tempdir().unwrap();
    let runs = [
        write(&Fixture::default(), root.path(), "cfc"),
        write(&Fixture { data: "other", hash: "beef", ..Fixture::default() }, root.path(), "other"),
    ];
    let out = root.path().join("page");
    let report = |runs: &[std::path::PathBuf]| {
        cargo_bin_cmd!("acm-eval").arg("report").args(runs).arg("--out").arg(&out).assert().success();
    };
    let of_other = || all_below(&out).iter().any(|(path, _)| path.to_string_lossy().contains("other-"));
    for has_list in [true, false] {
        report(&runs);
        assert!(of_other());
        if !has_list {
            std::fs::remove_file(out.join("report.json")).unwrap();
        }
        report(&runs[..1]);
        assert!(!of_other(), "figures and tables of the earlier report are left, list: {has_list}");
        assert!(out.join("report.json").exists() && out.join("tables/made-up-errors.csv").exists());
    }
}
