//! Files beside a page: each figure as SVG and PNG, and as CSV where it is lines or dots; each table as CSV.

use acm_trace::finding::{Finding, Separability};

use super::numbers;
use crate::closed_loop::figures::{self, matrix};
use crate::closed_loop::readable::readable;
use crate::{error::EvalError, figures::Drawing, tables::Table};

/// The folder of figures.
pub const FIGURES: &str = "figures";
/// The folder of tables.
pub const TABLES: &str = "tables";

/// File with its path, relative to the page, and its bytes.
pub type Beside = (String, Vec<u8>);

/// Returns the files of a finding.
///
/// # Errors
/// A figure is too large to be drawn as pixels.
pub fn of_finding(finding: &Finding) -> Result<Vec<Beside>, EvalError> {
    let (mut files, shown) = (vec![], readable(finding));
    for figure in figures::ALL {
        for (index, drawing) in (figure.draw)(&shown).iter().enumerate() {
            files.extend(pictures(&figure_name(figure.name, index), figure.question, drawing, &finding.data.name)?);
        }
    }
    files.extend(numbers::of_finding(finding).iter().map(csv));
    Ok(files)
}

/// Returns the files of separability.
///
/// # Errors
/// As [`of_finding`].
pub fn of_separability(separability: &Separability) -> Result<Vec<Beside>, EvalError> {
    let mut files = vec![];
    if let Some(drawing) = matrix::draw(separability) {
        files.extend(pictures(&figure_name(matrix::NAME, 0), matrix::QUESTION, &drawing, &separability.data.name)?);
    }
    files.extend(numbers::of_separability(separability).iter().map(csv));
    Ok(files)
}

/// Returns whether a finding may have such a file in that folder; any other file is the user's.
pub fn is_own(folder: &str, file: &str) -> bool {
    match folder {
        FIGURES => {
            let picture = [".svg", ".png", ".csv"].into_iter().find_map(|kind| file.strip_suffix(kind));
            let parts = picture.and_then(|picture| picture.rsplit_once('-'));
            parts.is_some_and(|(name, number)| {
                figures::ALL.iter().any(|figure| figure.name == name)
                    && !number.is_empty()
                    && number.bytes().all(|digit| digit.is_ascii_digit())
            })
        }
        TABLES => file.strip_suffix(".csv").is_some_and(|name| numbers::OF_FINDING.contains(&name)),
        _ => false,
    }
}

/// Returns the name of a figure's files, and of its anchor on the page: a figure may have several drawings.
pub fn figure_name(figure: &str, index: usize) -> String {
    format!("{figure}-{}", index + 1)
}

/// Returns the path of a table, relative to the page.
pub fn table_file(name: &str) -> String {
    format!("{TABLES}/{name}.csv")
}

/// Returns the paths of a figure, relative to the page: as SVG, and as PNG.
pub fn figure_files(name: &str) -> [String; 2] {
    ["svg", "png"].map(|extension| format!("{FIGURES}/{name}.{extension}"))
}

/// Returns the path of the numbers of a figure, relative to the page.
pub fn numbers_file(name: &str) -> String {
    format!("{FIGURES}/{name}.csv")
}

fn pictures(name: &str, question: &str, drawing: &Drawing, data: &str) -> Result<Vec<Beside>, EvalError> {
    let [svg, png] = figure_files(name);
    let mut files = vec![(svg, drawing.svg(name, question, data).into_bytes()), (png, drawing.png(name)?)];
    files.extend(drawing.csv().map(|csv| (numbers_file(name), csv.into_bytes())));
    Ok(files)
}

fn csv(table: &Table) -> Beside {
    (table_file(table.name), table.csv().into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_its_own_files_are_its_own() {
        for (folder, file) in [
            ("figures", "trace-1.svg"),
            ("figures", "carrier-12.png"),
            ("figures", "trace-1.csv"),
            ("tables", "trials.csv"),
        ] {
            assert!(is_own(folder, file), "{folder}/{file}");
        }
        for (folder, file) in [
            ("figures", "trace-final.svg"),
            ("figures", "trace-.svg"),
            ("figures", "mine-1.svg"),
            ("figures", "trials.csv"),
            ("tables", "mine.csv"),
            ("networks", "trials.csv"),
        ] {
            assert!(!is_own(folder, file), "{folder}/{file}");
        }
    }
}
