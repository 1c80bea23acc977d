//! Tables of sequences: what they say, and what cannot be.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use acm_datasets::DataError;
use acm_datasets::files::table::{Column, write_parquet};
use acm_datasets::sequences::table::{Rules, Tables, Windows, read, whole};
use acm_datasets::sequences::{Asked, Sequence, SequenceSet};

const TABLE: &str = "\
name,part,t,u,y
a,training,0.0,1.0,0
a,training,0.5,2.0,1
a,training,2.0,3.0,0
b,test,7.0,4.0,1
b,test,7.1,5.0,1
c,validation,0.0,6.0,0
c,validation,1.0,7.0,1
";

const LABELS: Rules = Rules { asked: Asked::Last, labels: true };
const EVERY: Rules = Rules { asked: Asked::Every, labels: false };

fn asked() -> Tables {
    Tables {
        sequence: Some("name".into()),
        part: Some("part".into()),
        time: Some("t".into()),
        inputs: vec!["u".into()],
        targets: vec!["y".into()],
        ..Tables::default()
    }
}

fn read_text(text: &str, asked: &Tables, rules: Rules) -> Result<SequenceSet, DataError> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("runs.csv"), text).expect("a file");
    read(asked, folder.path(), rules)
}

/// Oracle: the table itself. The first elapsed time is the median step, of two the smaller.
#[test]
fn labels_after_the_last_step() -> Result<(), DataError> {
    let set = read_text(TABLE, &asked(), LABELS)?;
    let [a, b, c] = [&set.training[0], &set.test[0], &set.validation[0]];
    assert_eq!([&a.name, &b.name, &c.name], ["a", "b", "c"]);
    assert_eq!((a.inputs.as_slice(), a.elapsed.as_slice()), (&[1.0, 2.0, 3.0][..], &[0.5, 0.5, 1.5][..]));
    assert_eq!(
        (a.targets.as_slice(), b.targets.as_slice(), c.targets.as_slice()),
        (&[0.0][..], &[1.0][..], &[1.0][..])
    );
    Ok(())
}

/// Expected values: the same table in s.
#[test]
fn times_have_a_unit() -> Result<(), DataError> {
    let rows = TABLE.lines().map(|row| {
        let mut cells: Vec<String> = row.split(',').map(String::from).collect();
        cells[2] = cells[2].parse::<f64>().map_or(cells[2].clone(), |t| (1000.0 * t).round().to_string());
        cells.join(",") + "\n"
    });
    let (text, wrong) = (rows.collect::<String>(), asked());
    let right = Tables { time_unit: Some("ms".into()), ..asked() };
    let (in_ms, in_s) = (read_text(&text, &right, LABELS)?, read_text(TABLE, &asked(), LABELS)?);
    assert_eq!(in_ms, in_s);
    assert_eq!(right.implausible_step(&in_ms), None);
    let warning = wrong.implausible_step(&read_text(&text, &wrong, LABELS)?).expect("steps of 500 s");
    for part in ["`t` has 500.0000 s from sample to sample", "did you mean ms?", "time_unit"] {
        assert!(warning.contains(part), "{part} in {warning}");
    }
    Ok(())
}

/// Oracle: the table itself. The next row's value, and the time until then.
#[test]
fn numbers_one_step_later() -> Result<(), DataError> {
    let next = Tables { ahead: 1, targets: vec!["u".into()], ..asked() };
    let set = read_text(TABLE, &next, EVERY)?;
    let a = &set.training[0];
    assert_eq!((a.inputs.as_slice(), a.targets.as_slice()), (&[1.0, 2.0][..], &[2.0, 3.0][..]));
    assert_eq!(a.elapsed, [0.5, 1.5]);
    let last = read_text(TABLE, &next, Rules { asked: Asked::Last, labels: false })?;
    assert_eq!(
        (last.training[0].inputs.as_slice(), last.training[0].targets.as_slice()),
        (&[1.0, 2.0][..], &[3.0][..])
    );
    Ok(())
}

#[test]
fn elapsed_times_and_files_of_one_sequence_each() -> Result<(), DataError> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, first) in [("p", 1.0), ("q", 2.0)] {
        let column = |name: &str, values: &[f64]| (name.to_string(), Column::Number(values.to_vec()));
        let columns = [column("dt", &[0.0, 0.25]), column("u", &[first, 3.0])];
        write_parquet(&folder.path().join(format!("{name}.parquet")), &columns)?;
    }
    let asked = Tables {
        files: vec!["*.parquet".into()],
        elapsed: Some("dt".into()),
        inputs: vec!["u".into()],
        targets: vec!["u".into()],
        validation: 0.0,
        test: 0.5,
        ..Tables::default()
    };
    let set = read(&asked, folder.path(), EVERY)?;
    let mut names: Vec<&str> = set.training.iter().chain(&set.test).map(|one| one.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!((names, set.training.len()), (vec!["p", "q"], 1));
    assert_eq!(set.test[0].elapsed, [0.0, 0.25]);
    assert_eq!(set.hash(), read(&asked, folder.path(), EVERY)?.hash());
    Ok(())
}

const WALK: &str = "\
name,part,t,u,seen
a,training,0,10,1
a,training,1,11,0
a,training,3,12,1
a,training,4,13,1
a,training,5,14,0
a,training,6,15,1
a,training,7,16,0
b,validation,0,20,1
b,validation,1,21,1
";

fn walk() -> Tables {
    let windows = Some(Windows { length: 2, stride: 1, spare: 1 });
    Tables { ahead: 1, keep: Some("seen".into()), windows, targets: vec!["u".into()], ..asked() }
}

/// Oracle: by hand. Rows 1, 3, 4 and 6 of `a` are seen, and rows 2, 4, 5 and 7 are asked for, dropped or not. The median step is 1. Of
/// four steps, windows of two that leave one behind begin at the first and the second; `b` has one step.
#[test]
fn dropped_rows_are_not_seen_and_windows_are_cut() -> Result<(), DataError> {
    let set = read_text(WALK, &walk(), EVERY)?;
    let found: Vec<(&str, &[f64], &[f64], &[f64])> = (set.training.iter().chain(&set.validation))
        .map(|one| (one.name.as_str(), one.inputs.as_slice(), one.targets.as_slice(), one.elapsed.as_slice()))
        .collect();
    let expected: [(&str, &[f64], &[f64], &[f64]); 3] = [
        ("a from step 1", &[10.0, 12.0], &[11.0, 13.0], &[1.0, 3.0]),
        ("a from step 2", &[12.0, 13.0], &[13.0, 14.0], &[3.0, 1.0]),
        ("b", &[20.0], &[21.0], &[1.0]),
    ];
    assert_eq!(found, expected);
    assert_eq!(found.iter().map(|one| whole(one.0)).collect::<Vec<_>>(), ["a", "a", "b"]);
    let last = read_text(WALK, &walk(), Rules { asked: Asked::Last, labels: false })?;
    assert_eq!(last.training.iter().map(|one| one.targets[0]).collect::<Vec<_>>(), [13.0, 14.0]);
    let shorter = read_text(WALK, &Tables { windows: None, ..walk() }, EVERY)?;
    assert_eq!(
        (shorter.training[0].name.as_str(), shorter.training[0].elapsed.as_slice()),
        ("a", &[1.0, 3.0, 1.0, 2.0][..])
    );
    Ok(())
}

/// Windows overlap, so a part that is drawn takes all of a sequence.
#[test]
fn windows_of_a_sequence_are_in_one_part() -> Result<(), DataError> {
    let row = |i: usize, k: usize| format!("s{i},{k},{i},1\n");
    let text: String = (0..10).flat_map(|i| (0..8).map(move |k| row(i, k))).collect();
    let set = read_text(&format!("name,t,u,seen\n{text}"), &Tables { part: None, ..walk() }, EVERY)?;
    let names = |part: &[Sequence]| part.iter().map(|one| whole(&one.name).to_string()).collect::<BTreeSet<_>>();
    let [training, validation, test] = [names(&set.training), names(&set.validation), names(&set.test)];
    assert_eq!((training.len(), validation.len(), test.len(), set.training.len()), (6, 2, 2, 30));
    assert!(training.is_disjoint(&validation) && training.is_disjoint(&test) && validation.is_disjoint(&test));
    Ok(())
}

/// Shares are rounded, every sequence is somewhere, and another seed draws others.
#[test]
fn shares_are_drawn() -> Result<(), DataError> {
    let text: String = (0..10).map(|i| format!("s{i},0.0,{i},0\ns{i},1.0,{i},0\n")).collect();
    let drawn = |seed| {
        let asked = Tables { part: None, validation: 0.2, test: 0.3, seed, ..asked() };
        read_text(&format!("name,t,u,y\n{text}"), &asked, LABELS)
    };
    let set = drawn(1)?;
    assert_eq!((set.training.len(), set.validation.len(), set.test.len()), (5, 2, 3));
    let mut all: Vec<&str> =
        set.parts().iter().flat_map(|(_, part)| part.iter()).map(|one| one.name.as_str()).collect();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), 10);
    assert!((2..6).any(|seed| drawn(seed).is_ok_and(|other| other.test != set.test)));
    Ok(())
}

/// Each case: what is replaced, by what, and what the message must say.
#[test]
fn what_cannot_be_is_named_with_its_place() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("name,part,t,u,y", "name,part,t,w,y", &["runs.csv", "`u`", "missing", "`w`"]),
        ("a,training,0.5,2.0,1", "a,training,0.5,inf,1", &["runs.csv, row 3", "`u`", "inf", "not finite"]),
        ("a,training,0.5,2.0,1", "a,training,0.5,two,1", &["row 3", "`u`", "two", "not a number"]),
        ("a,training,0.5,2.0,1", "a,training,0.5,,1", &["row 3", "`u`", "empty"]),
        ("b,test,7.1,5.0,1", "b,test,7.1,5.0,0.5", &["row 6", "`y`", "0.5", "no label", "write 0 or 1"]),
        ("b,test,7.1,5.0,1", "b,test,6.9,5.0,1", &["row 6", "`t`", "goes back from 7 s to 6.9 s", "sort"]),
        ("b,test,7.1,5.0,1", "b,test,7.0,5.0,1", &["row 6", "`t`", "stands still, duplicate time stamp 7 s"]),
        ("b,test,7.1,5.0,1", "b,training,7.1,5.0,1", &["row 6", "`part`", "`b`", "test", "training", "one part"]),
        ("c,validation,0.0", "c,exam,0.0", &["row 7", "`part`", "exam", "training, validation or test"]),
        ("c,validation,1.0,7.0,1", "a,training,3.0,7.0,1", &["row 8", "`a`", "another one", "sort"]),
        ("c,validation,1.0,7.0,1", "c,validation,1.0,7.0", &["row 8", "4 cells under 5 columns"]),
    ];
    for (from, to, parts) in cases {
        assert!(TABLE.contains(from), "{from}");
        let error = read_text(&TABLE.replace(from, to), &asked(), LABELS).expect_err(to);
        let message = error.to_string();
        assert_eq!(error.exit_code(), 3, "{message}");
        for part in *parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    }
}

#[test]
fn short_sequences_negative_times_and_missing_files() {
    let next = Tables { ahead: 1, ..asked() };
    let short = read_text(&TABLE.replace("b,test,7.1,5.0,1\n", ""), &next, EVERY).expect_err("short").to_string();
    assert!(short.contains("row 5") && short.contains("`b` has 1 rows, and 2 are needed"), "{short}");
    let told = Tables { time: None, elapsed: Some("u".into()), inputs: vec!["y".into()], ..asked() };
    let back = read_text(&TABLE.replace("2.0,1", "-2.0,1"), &told, EVERY).expect_err("negative").to_string();
    assert!(back.contains("row 3") && back.contains("`u`") && back.contains("-2 s"), "{back}");
    let half = read_text(&WALK.replace("3,12,1", "3,12,0.5"), &walk(), EVERY).expect_err("half").to_string();
    assert!(half.contains("row 4") && half.contains("`seen`") && half.contains("write 0 or 1"), "{half}");
    let unseen = read_text(&WALK.replace("0,20,1", "0,20,0"), &walk(), EVERY).expect_err("unseen").to_string();
    assert!(unseen.contains("row 9") && unseen.contains("`b`"), "{unseen}");
    let none = read(&asked(), Path::new("no/such/folder"), LABELS).expect_err("nothing").to_string();
    assert!(none.contains("no/such/folder") && none.contains("*.csv"), "{none}");
}
