//! Row numbers as text: `3, 8 to 12`.

use std::fmt;

/// Stretches of rows that are named; the rest is counted.
const NAMED: usize = 5;

/// Rows, increasing, as stretches.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Rows {
    stretches: Vec<(usize, usize)>,
    count: usize,
    cut: bool,
}

/// Number and rows of further cells of a column with the same problem.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct More(Rows);

impl Rows {
    /// Notes a row behind the others.
    pub fn add(&mut self, row: usize) {
        self.count += 1;
        let named = self.stretches.len();
        match self.stretches.last_mut() {
            Some((_, last)) if !self.cut && (*last == row || *last + 1 == row) => *last = row,
            _ if named < NAMED => self.stretches.push((row, row)),
            _ => self.cut = true,
        }
    }

    /// How many were noted.
    pub fn count(&self) -> usize {
        self.count
    }
}

impl FromIterator<usize> for Rows {
    fn from_iter<I: IntoIterator<Item = usize>>(rows: I) -> Self {
        let mut all = Rows::default();
        rows.into_iter().for_each(|row| all.add(row));
        all
    }
}

/// `row 3`, `rows 3, 8 to 12 …`.
impl fmt::Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.count == 1 { "row " } else { "rows " })?;
        for (i, (first, last)) in self.stretches.iter().enumerate() {
            let comma = if i > 0 { ", " } else { "" };
            match last - first {
                0 => write!(f, "{comma}{first}")?,
                1 => write!(f, "{comma}{first}, {last}")?,
                _ => write!(f, "{comma}{first} to {last}")?,
            }
        }
        f.write_str(if self.cut { " …" } else { "" })
    }
}

impl More {
    /// Notes a further cell, by its row.
    pub fn add(&mut self, row: usize) {
        self.0.add(row);
    }
}

impl fmt::Display for More {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.count() {
            0 => Ok(()),
            1 => write!(f, ", likewise {}", self.0),
            count => write!(f, ", likewise {count} more ({})", self.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn rows_are_written_as_stretches() {
        let text = |rows: &[usize]| rows.iter().copied().collect::<Rows>().to_string();
        assert_eq!(text(&[7]), "row 7");
        assert_eq!(text(&[3, 4]), "rows 3, 4");
        assert_eq!(text(&[3, 8, 9, 10, 12]), "rows 3, 8 to 10, 12");
        assert_eq!(text(&[1, 3, 5, 7, 9, 11, 12]), "rows 1, 3, 5, 7, 9 …");
        let mut more = More::default();
        assert_eq!(more.to_string(), "");
        more.add(5);
        assert_eq!(more.to_string(), ", likewise row 5");
        more.add(6);
        assert_eq!(more.to_string(), ", likewise 2 more (rows 5, 6)");
    }
}
