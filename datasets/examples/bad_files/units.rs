//! Sets that can be read and cannot be meant: units that are off, columns that never change, clocks that jump. Each is a
//! warning with file and column, and the unit that was meant.

use super::case::{Case, Said};
use super::good::{COLUMNS, MANIFEST, Set, csv, rows};

/// Every case.
pub fn all() -> Vec<Case> {
    [units(), constants(), clocks(), outliers()].into_iter().flatten().collect()
}

fn case(name: &str, column: &str, words: &[&str], spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
    Case::new(format!("warning: {name}"), Said::of(0, "run_", words).column(column), spoil)
}

const FILE: &str = "data/manifest.toml";

/// The four trials in CSV, each row changed; `change` gets the number of the trial.
fn all_rows(change: impl Fn(usize, &mut [f64; 4]) + 'static) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            let mut rows = rows(i);
            rows.iter_mut().for_each(|row| change(i, row));
            set.write(&format!("data/run_{name}.csv"), csv(&rows))?;
        }
        Ok(())
    }
}

/// Column `j` by a factor, and a text of the manifest replaced.
fn scaled(j: usize, factor: f64, from: &'static str, to: &'static str) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        all_rows(move |_, row| row[j] *= factor)(set)?;
        set.edit(FILE, from, to)
    }
}

/// An arm whose three markers are `scale` times the usual output.
fn arm(scale: f64) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        let marker = |axis: &str| format!("[[measured]]\ncolumn = \"{axis}\"\nunit = \"m\"\n");
        let length = "[arm]\nlength = { value = 0.4, unit = \"m\" }\n[roles]";
        let output = "[[measured]]\ncolumn = \"y\"\nunit = \"mm\"\n";
        let text = MANIFEST.replace(output, &["x", "y", "z"].map(marker).concat()).replace("[roles]", length);
        set.write(FILE, text)?;
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            let line = |r: [f64; 4]| {
                let [x, y, z] = [0.2, 1.0, -2.0].map(|part| part * scale * r[3]);
                format!("{},{},{},{x},{y},{z}\n", r[0], r[1], r[2])
            };
            let text: String = rows(i).into_iter().map(line).collect();
            set.write(&format!("data/run_{name}.csv"), format!("t,q,h,x,y,z\n{text}"))?;
        }
        Ok(())
    }
}

/// What is written in one unit and declared in another.
fn units() -> Vec<Case> {
    let (deg, cm, mm) = ("unit = \"deg\"", "unit = \"cm\"", "unit = \"mm\"");
    let (rad, metres) = ("unit = \"rad\"", "unit = \"m\"");
    let in_metres = ["reaches 300.0000", "m; unit is m; did you mean mm? (factor 0.001)"];
    let markers = Said::of(0, "run_", &["no marker of trial", "did you mean km? (factor 1000)"]);
    vec![
        case("degrees as radians", "q", &["reaches 10000.0000", "unit is rad"], scaled(1, 1000.0, deg, rad)),
        case("45 degrees as radians", "q", &["45.0000", "did you mean deg? (factor 0.01745"], scaled(1, 4.5, deg, rad)),
        case("radians as degrees", "q", &["below", "did you mean rad? (factor 57.29"], scaled(1, 0.15, deg, deg)),
        case("millimetres as metres", "y", &in_metres, scaled(3, 3.0, mm, metres)),
        case("metres as millimetres", "y", &["below", "did you mean m? (factor 1000)"], scaled(3, 0.005, mm, mm)),
        case("kilometres", "y", &["reaches 100000.0000", "did you mean"], scaled(3, 1.0, mm, "unit = \"km\"")),
        case("the pressure of a star", "h", &["reaches", "Pa"], scaled(2, 1e6, cm, "unit = \"bar\"")),
        case("grams as kilograms", "h", &["reaches", "did you mean g?"], scaled(2, 100.0, cm, "unit = \"kg\"")),
        case("a temperature of a million", "h", &["reaches", "is that right?"], scaled(2, 1e5, cm, "unit = \"K\"")),
        case("markers in millimetres", "z", &["reaches 200.0000", "did you mean mm? (factor 0.001)"], arm(1.0)),
        Case::new("warning: markers in kilometres", markers, arm(1e-6)),
        case("column q times 1e5", "q", &["reaches", "unit is"], scaled(1, 1e5, deg, deg)),
        case("column h times 1e6", "h", &["reaches", "unit is"], scaled(2, 1e6, cm, cm)),
        case("column y times 1e4", "y", &["reaches", "unit is"], scaled(3, 1e4, mm, mm)),
    ]
}

fn constants() -> Vec<Case> {
    let mut cases = vec![];
    for (j, other) in [(1, 3), (2, 1), (3, 1)] {
        for value in [0.0, 7.5, 5e-324] {
            let name = format!("column {} is {value:e} everywhere", COLUMNS[j]);
            // so that no two trials hold the same values
            let rows = all_rows(move |i, row| (row[j], row[other]) = (value, row[other] + i as f64));
            cases.push(case(&name, COLUMNS[j], &["is constant", "manifest"], rows));
        }
    }
    let excluded = "the excluded trial alone moves";
    cases.push(case(excluded, "q", &["is constant"], all_rows(|_, row| row[1] = 3.0)));
    let rest = Said::of(0, "", &["no development trial moves an actuator"]);
    let at_two_values = |i, row: &mut [f64; 4]| row[1] = if i < 2 { 2.0 + i as f64 } else { row[1] };
    cases.push(Case::new("warning: development trials rest at two values", rest, all_rows(at_two_values)));
    cases
}

fn clocks() -> Vec<Case> {
    let jump = |by: f64| {
        move |set: &Set| {
            // long enough before and after for a window
            let mut rows: Vec<[f64; 4]> = [rows(1), rows(11)].concat();
            rows.iter_mut().enumerate().for_each(|(i, row)| row[0] = 100.0 * i as f64 + if i < 60 { 0.0 } else { by });
            set.write("data/run_b.csv", csv(&rows))
        }
    };
    let seconds = ["from sample to sample", "did you mean ms? (factor 0.001)"];
    vec![
        case("a clock that was set by a day", "t", &["jumps by 86400", "split the trial"], jump(86_400_000.0)),
        case("a clock that was set by fifty years", "t", &["jumps by", "split the trial"], jump(1.6e12)),
        case("milliseconds as seconds", "t", &seconds, |set| set.edit(FILE, "unit = \"ms\"", "unit = \"s\"")),
    ]
}

fn outliers() -> Vec<Case> {
    let one = |row: usize| {
        let words = [&format!("run_b.csv, row {row},"), "stands alone", "correct the cell"];
        case(&format!("an outlier of 5 m in row {row}"), "y", &words, move |set| {
            let mut rows = rows(1);
            rows[row - 2][3] += 5000.0;
            set.write("data/run_b.csv", csv(&rows))
        })
    };
    [2, 31, 61].map(one).into()
}
