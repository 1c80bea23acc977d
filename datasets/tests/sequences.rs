//! Tables of sequences: what they say, and what cannot be.

use std::fs;
use std::path::Path;

use acm_datasets::DataError;
use acm_datasets::sequences::table::{Rules, Tables, read};
use acm_datasets::sequences::{Asked, SequenceSet};
use acm_datasets::table::{Column, write_parquet};

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
        ("b,test,7.1,5.0,1", "b,test,7.0,5.0,1", &["row 6", "`t`", "stands still at 7 s"]),
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
    let none = read(&asked(), Path::new("no/such/folder"), LABELS).expect_err("nothing").to_string();
    assert!(none.contains("no/such/folder") && none.contains("*.csv"), "{none}");
}
