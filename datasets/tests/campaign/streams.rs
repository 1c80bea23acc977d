//! Files of many pieces: the same trials as from memory, wherever their rows lie, and no more held than a few.

use acm_datasets::files::table::{Column, write_parquet_groups};
use acm_datasets::recordings::{Options, Recordings};
use acm_datasets::{DataError, Trial};

use super::set::{MANIFEST, Set};

/// Rows of one group: two of them are more than one piece.
const GROUP: usize = 40_000;

/// A value that no other row has.
fn value(row: usize) -> f64 {
    (row as f64 / 7.0).sin()
}

/// One table of `groups` groups; `trial` names the trial of each row, and `cell` gives the outputs.
fn table(set: &Set, groups: usize, trial: impl Fn(usize) -> String, cell: impl Fn(usize) -> f64) {
    let rows = |group: usize| {
        let rows = group * GROUP..(group + 1) * GROUP;
        let number = |of: &dyn Fn(usize) -> f64| Column::Number(rows.clone().map(of).collect());
        Ok(vec![
            ("trial".into(), Column::Text(rows.clone().map(&trial).collect())),
            ("t".into(), number(&|row| 100.0 * row as f64)),
            ("q".into(), number(&|row| value(row + 1))),
            ("h".into(), number(&|row| value(row + 2))),
            ("y".into(), number(&|row| cell(row))),
        ])
    };
    write_parquet_groups(&set.file("all.parquet"), (0..groups).map(rows)).expect("written");
}

fn set(roles: &str) -> Set {
    let set = Set::new();
    let manifest =
        MANIFEST.replace("run_*.csv", "all.parquet").replace("{ file = \"run_(.*)\" }", "{ column = \"trial\" }");
    let (head, _) = manifest.split_once("[roles]").expect("roles");
    set.write("manifest.toml", &format!("{head}[roles]\n{roles}\n"));
    set
}

fn open(set: &Set, hold: usize) -> Result<Recordings, DataError> {
    Recordings::open(set.path(), None, &Options { hold, ..Options::default() })
}

fn trials(data: &Recordings, order: &[usize]) -> Vec<Trial> {
    data.trials(order.iter().copied()).map(|trial| trial.expect("read").into_owned()).collect()
}

/// Oracle: the same set held in memory, in one piece of work. Trial `b` lies at both ends of the file, `c` and `d` take
/// turns row by row, and `a` goes over a border.
#[test]
fn trials_read_from_a_stream_are_those_read_at_once_wherever_their_rows_lie() {
    let set = set("calibration = [\"d\"]\ndevelopment = [\"a\", \"b\"]\nheld_out = [\"c\"]");
    let name = |row: usize| match row {
        0..1_000 | 199_000.. => "b",
        1_000..90_000 => "a",
        row if row % 3 == 0 => "c",
        _ => "d",
    };
    table(&set, 5, |row| name(row).into(), value);
    let (held, streamed) = (open(&set, usize::MAX).expect("held"), open(&set, 0).expect("streamed"));
    assert!(held.is_held() && !streamed.is_held());
    assert_eq!((&held.entries, &held.hash), (&streamed.entries, &streamed.hash));
    for order in [vec![0, 1, 2, 3], vec![3, 1, 0], vec![2, 2, 1, 3, 0, 2]] {
        assert!(trials(&held, &order) == trials(&streamed, &order), "{order:?}");
    }
    let b = &trials(&streamed, &[1])[0];
    assert_eq!((b.name.as_str(), b.samples()), ("b", 2_000));
    assert_eq!(b.measured[(1_999, 0)], 1e-3 * value(199_999));
}

#[test]
fn a_bad_cell_is_found_in_its_row_however_far_down() {
    let set = set("calibration = []\ndevelopment = [\"a\"]\nheld_out = []");
    table(&set, 4, |_| "a".into(), |row| if row == 150_000 { f64::INFINITY } else { value(row) });
    let said = open(&set, 0).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(said.contains("all.parquet, row 150001") && said.contains("`y`"), "{said}");
}

#[test]
fn a_file_that_is_exchanged_while_it_is_read_is_named() {
    let set = set("calibration = []\ndevelopment = [\"a\", \"b\"]\nheld_out = []");
    let name = |row: usize| if row < GROUP { "a" } else { "b" };
    table(&set, 2, |row| name(row).into(), value);
    let data = open(&set, 0).expect("opened");
    table(&set, 2, |_| "a".into(), value);
    let said = data.all().find_map(Result::err).map(|e| (e.exit_code(), e.to_string()));
    assert!(said.as_ref().is_some_and(|(code, said)| *code == 3 && said.contains("was changed")), "{said:?}");
}

/// A thousand trials and as many roles for others: each problem once, and none names all trials.
#[test]
fn many_problems_are_a_message_that_can_be_read() {
    let roles: Vec<String> = (0..1_000).map(|k| format!("\"other-{k}\"")).collect();
    let set = set(&format!("calibration = []\ndevelopment = [{}]\nheld_out = []", roles.join(", ")));
    table(&set, 1, |row| format!("trial-{}", row / 40), value);
    let said = open(&set, 0).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(said.starts_with("2000 problems") && said.contains(" more; mend these first"), "{}", said.len());
    assert!(said.len() < 20_000, "{} bytes", said.len());
}

/// Peak of what is held at a time while all trials of a set go by, in bytes.
fn peak(groups: usize) -> u64 {
    let names: Vec<String> = (0..4 * groups).map(|trial| format!("{trial:?}")).collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    let set = set(&format!("calibration = []\ndevelopment = [{}]\nheld_out = []", quoted.join(", ")));
    table(&set, groups, |row| names[4 * row / GROUP].clone(), value);
    let data = open(&set, 0).expect("opened");
    let read = || assert_eq!(data.all().map(|trial| trial.expect("read").samples()).sum::<usize>(), groups * GROUP);
    allocation_counter::measure(read).bytes_max
}

#[test]
fn what_is_held_does_not_grow_with_the_number_of_trials() {
    let (few, many) = (peak(4), peak(16));
    assert!((many as f64) < 1.1 * few as f64, "{few} bytes for 4 groups of rows, {many} for 16");
}
