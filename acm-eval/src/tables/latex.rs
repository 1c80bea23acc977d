//! A table as LaTeX, for a paper: the cells as the page shows them, rules of the package booktabs.

use acm_train::run::record::DataStamp;

use super::{Cell, Column, Row, Table};

impl Table {
    /// Returns a `table` environment; it says so where the data are synthetic.
    pub fn latex(&self, data: &DataStamp) -> String {
        let aligned: String = self.columns.iter().map(|column| if column.text { 'l' } else { 'r' }).collect();
        let heads: Vec<String> = self.columns.iter().map(|column| escaped(&column.heading())).collect();
        let mark = if data.synthetic { " Synthetic data, made by a simulator." } else { "" };
        let mut lines = vec![
            "% needs \\usepackage{booktabs}".to_string(),
            "\\begin{table}".into(),
            "\\centering".into(),
            format!("\\caption{{{}. {}{mark}}}", escaped(&self.title), escaped(&self.note)),
            format!("\\begin{{tabular}}{{{aligned}}}"),
            "\\toprule".into(),
            format!("{} \\\\", heads.join(" & ")),
            "\\midrule".into(),
        ];
        for (index, row) in self.rows.iter().enumerate() {
            if row.opens && index > 0 {
                lines.push("\\midrule".into());
            }
            lines.push(format!("{} \\\\", cells(row, &self.columns)));
        }
        lines.extend(["\\bottomrule", "\\end{tabular}", "\\end{table}"].map(String::from));
        lines.join("\n") + "\n"
    }
}

fn cells(row: &Row, columns: &[Column]) -> String {
    let cell = |(cell, column): (&Cell, &Column)| {
        let shown = escaped(&column.show(cell));
        match cell {
            Cell::Best(_) => format!("\\textbf{{{shown}}}"),
            _ if row.bound && !shown.is_empty() => format!("\\textit{{{shown}}}"),
            _ => shown,
        }
    };
    row.cells.iter().zip(columns).map(cell).collect::<Vec<_>>().join(" & ")
}

/// Escapes LaTeX's special characters, and signs that a font may lack.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', c]),
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '·' => out.push_str("$\\cdot$"),
            '°' => out.push_str("$^\\circ$"),
            'µ' => out.push_str("$\\mu$"),
            '±' => out.push_str("$\\pm$"),
            '−' => out.push_str("$-$"),
            '→' => out.push_str("$\\to$"),
            '≤' => out.push_str("$\\le$"),
            '≥' => out.push_str("$\\ge$"),
            '√' => out.push_str("$\\surd$"),
            'Δ' => out.push_str("$\\Delta$"),
            'σ' => out.push_str("$\\sigma$"),
            '²' => out.push_str("$^2$"),
            '–' => out.push_str("--"),
            '\u{202f}' | '\u{a0}' => out.push('~'),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spread::Spread;

    fn stamp(synthetic: bool) -> DataStamp {
        DataStamp {
            name: "d".into(),
            title: "D".into(),
            licence: "CC0".into(),
            source: "s".into(),
            synthetic,
            hash: "0".into(),
            unit: "m".into(),
            trials: Default::default(),
            floors: None,
            constant: Default::default(),
        }
    }

    #[test]
    fn signs_are_escaped_groups_are_ruled_and_the_best_is_bold() {
        let columns = vec![Column::text("Model_1"), Column::number("x", "mm", 1)];
        let number = |mean| Spread { mean, sd: Some(0.5) };
        let rows = vec![
            Row { cells: vec![Cell::Text("a & b".into()), Cell::Best(number(-1.0))], opens: true, bound: false },
            Row { cells: vec![Cell::Text("50 %".into()), Cell::Empty], opens: true, bound: true },
        ];
        let table = Table { name: "t", title: "T".into(), note: "N.".into(), columns, rows, folded: false };
        let text = table.latex(&stamp(true));
        for line in [
            "\\begin{tabular}{lr}",
            "Model\\_1 & x [mm] \\\\",
            "a \\& b & \\textbf{$-$1.0 $\\pm$ 0.5} \\\\\n\\midrule\n\\textit{50 \\%} & \\textit{--} \\\\\n\\bottomrule",
            "Synthetic data, made by a simulator.",
        ] {
            assert!(text.contains(line), "{line} is not in\n{text}");
        }
        assert!(!table.latex(&stamp(false)).contains("Synthetic"));
    }
}
