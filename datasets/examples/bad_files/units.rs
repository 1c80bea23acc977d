//! Sets that can be read and cannot be meant: units that are off, columns that never change, clocks that jump. Each is a
//! warning with file and column, and the unit that was meant.

use super::case::{Case, Said};
use super::good::{COLUMNS, Set, csv, rows};

/// Every case.
pub fn all() -> Vec<Case> {
    [units(), scaled(), constants(), clocks(), outliers()].into_iter().flatten().collect()
}

fn case(name: &str, column: &str, words: &[&str], spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
    Case { name: format!("warning: {name}"), spoil: Box::new(spoil), said: Said::of(0, "run_", words).column(column) }
}

/// The four trials in CSV, each row changed.
fn all_rows(change: impl Fn(&mut [f64; 4]) + 'static) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            let mut rows = rows(i);
            rows.iter_mut().for_each(&change);
            set.write(&format!("data/run_{name}.csv"), csv(&rows))?;
        }
        Ok(())
    }
}

/// The manifest with one text replaced.
fn manifest(from: &'static str, to: &'static str) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        let text = String::from_utf8_lossy(&set.read("data/manifest.toml")?).into_owned();
        set.write("data/manifest.toml", text.replacen(from, to, 1))
    }
}

/// What is written in one unit and declared in another.
fn units() -> Vec<Case> {
    let with = |arm: &str| format!("[arm]\nlength = {{ value = {arm}, unit = \"m\" }}\n[roles]");
    let arm = move |length: &'static str, scale: f64| {
        move |set: &Set| {
            let text = String::from_utf8_lossy(&set.read("data/manifest.toml")?).into_owned();
            let marker = |axis: &str| format!("[[measured]]\ncolumn = \"{axis}\"\nunit = \"m\"\n");
            let text =
                text.replace("[[measured]]\ncolumn = \"y\"\nunit = \"mm\"\n", &["x", "y", "z"].map(marker).concat());
            let text = text
                .replace("[roles]", &with(length))
                .replace(", \"run_*.parquet\"", "")
                .replace("excluded = [\"p\"]", "");
            set.write("data/manifest.toml", text)?;
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
    };
    vec![
        case("degrees as radians", "q", &["reaches 10000.0000", "unit is rad"], |set| {
            all_rows(|row| row[1] *= 1000.0)(set)?;
            manifest("unit = \"deg\"", "unit = \"rad\"")(set)
        }),
        case("45 degrees as radians", "q", &["reaches 45.0000", "did you mean deg? (factor 0.01745"], |set| {
            all_rows(|row| row[1] *= 4.5)(set)?;
            manifest("unit = \"deg\"", "unit = \"rad\"")(set)
        }),
        case(
            "radians as degrees",
            "q",
            &["stays below", "did you mean rad? (factor 57.29"],
            all_rows(|row| row[1] *= 0.15),
        ),
        case("millimetres as metres", "y", &["reaches 300.0000", "did you mean mm? (factor 0.001)"], |set| {
            all_rows(|row| row[3] *= 3.0)(set)?;
            manifest("unit = \"mm\"", "unit = \"m\"")(set)
        }),
        case(
            "metres as millimetres",
            "y",
            &["stays below", "did you mean m? (factor 1000)"],
            all_rows(|row| row[3] *= 0.005),
        ),
        case("kilometres", "y", &["reaches 100000.0000", "did you mean"], manifest("unit = \"mm\"", "unit = \"km\"")),
        case("the pressure of a star", "h", &["reaches", "Pa"], |set| {
            all_rows(|row| row[2] *= 1e6)(set)?;
            manifest("unit = \"cm\"", "unit = \"bar\"")(set)
        }),
        case("grams as kilograms", "h", &["reaches", "did you mean g?"], |set| {
            all_rows(|row| row[2] *= 100.0)(set)?;
            manifest("unit = \"cm\"", "unit = \"kg\"")(set)
        }),
        case("a temperature of a million", "h", &["reaches", "is that right?"], |set| {
            all_rows(|row| row[2] *= 1e5)(set)?;
            manifest("unit = \"cm\"", "unit = \"K\"")(set)
        }),
        case(
            "markers in millimetres, an arm in metres",
            "z",
            &["reaches 200.0000", "did you mean mm? (factor 0.001)"],
            arm("0.4", 1.0),
        ),
        case("markers in kilometres, an arm in metres", "run", &[], |_| Ok(())).or_markers(arm("0.4", 1e-6)),
    ]
}

impl Case {
    /// Markers are told as a whole, without a column.
    fn or_markers(self, spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
        let said =
            Said { column: None, ..Said::of(0, "run_", &["no marker of trial", "did you mean km? (factor 1000)"]) };
        Case { spoil: Box::new(spoil), said, ..self }
    }
}

/// The same through the columns, by a factor.
fn scaled() -> Vec<Case> {
    [(1, "q", 1e5), (2, "h", 1e6), (3, "y", 1e4)]
        .into_iter()
        .map(|(j, column, factor)| {
            case(
                &format!("column {column} times {factor:e}"),
                column,
                &["reaches", "unit is"],
                all_rows(move |row| row[j] *= factor),
            )
        })
        .collect()
}

fn constants() -> Vec<Case> {
    let mut cases: Vec<Case> = (1..4)
        .flat_map(|j| [0.0, 7.5, 5e-324].map(|value| (j, value)))
        .map(|(j, value)| {
            // so that no two trials hold the same values
            let other = if j == 1 { 3 } else { 1 };
            let name = format!("column {} is {value:e} everywhere", COLUMNS[j]);
            case(&name, COLUMNS[j], &["is constant", "manifest"], move |set| {
                for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
                    let mut rows = rows(i);
                    rows.iter_mut().for_each(|row| {
                        row[j] = value;
                        row[other] += i as f64;
                    });
                    set.write(&format!("data/run_{name}.csv"), csv(&rows))?;
                }
                Ok(())
            })
        })
        .collect();
    let excluded = "the excluded trial alone moves";
    cases.push(case(excluded, "q", &["is constant"], |set| {
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            let mut rows = rows(i);
            rows.iter_mut().for_each(|row| row[1] = 3.0);
            set.write(&format!("data/run_{name}.csv"), csv(&rows))?;
        }
        Ok(())
    }));
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
    vec![
        case("a clock that was set by a day", "t", &["jumps by 86400", "split the trial"], jump(86_400_000.0)),
        case("a clock that was set by fifty years", "t", &["jumps by", "split the trial"], jump(1.6e12)),
        case("milliseconds as seconds", "t", &["from sample to sample", "did you mean ms? (factor 0.001)"], |set| {
            manifest("time = { column = \"t\", unit = \"ms\" }", "time = { column = \"t\", unit = \"s\" }")(set)
        }),
    ]
}

fn outliers() -> Vec<Case> {
    let one = |row: usize| {
        case(
            &format!("an outlier of 5 m in row {row}"),
            "y",
            &[&format!("run_b.csv, row {row},"), "stands alone", "correct the cell"],
            move |set| {
                let mut rows = rows(1);
                rows[row - 2][3] += 5000.0;
                set.write("data/run_b.csv", csv(&rows))
            },
        )
    };
    [2, 31, 61].map(one).into()
}
