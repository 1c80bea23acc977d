//! One spoiled data set, and what must be said of it.

use std::io::Result;

use super::good::Set;

/// A spoiled set.
pub struct Case {
    /// What was done, and where.
    pub name: String,
    pub spoil: Box<dyn Fn(&Set) -> Result<()>>,
    pub said: Said,
}

impl Case {
    pub fn new(name: impl Into<String>, said: Said, spoil: impl Fn(&Set) -> Result<()> + 'static) -> Case {
        Case { name: name.into(), spoil: Box::new(spoil), said }
    }
}

/// What a message must name.
#[derive(Debug, Clone)]
pub struct Said {
    pub code: i32,
    /// The end of the file's path.
    pub file: String,
    /// The row, where one row is wrong.
    pub row: Option<usize>,
    /// The column, where one column is wrong.
    pub column: Option<String>,
    /// Value, and remedy.
    pub words: Vec<String>,
}

/// How exactly a place is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// File, row and column.
    Cell,
    /// File and row: the row as a whole is wrong.
    Row,
    /// File and column: the column as a whole is wrong.
    Column,
    /// File, line and column of a manifest.
    Key,
    /// The file as a whole is wrong.
    File,
    /// A warning with file and column; the set is read.
    Warning,
}

impl Said {
    pub fn of(code: i32, file: &str, words: &[&str]) -> Said {
        let words = words.iter().map(ToString::to_string).collect();
        Said { code, file: file.into(), row: None, column: None, words }
    }

    pub fn row(self, row: usize) -> Said {
        Said { row: Some(row), ..self }
    }

    /// An empty name is none.
    pub fn column(self, column: &str) -> Said {
        Said { column: (!column.is_empty()).then(|| column.into()), ..self }
    }

    pub fn place(&self) -> Place {
        match (self.code, self.row, &self.column) {
            (0, _, _) => Place::Warning,
            (2, _, _) => Place::Key,
            (_, Some(_), Some(_)) => Place::Cell,
            (_, Some(_), None) => Place::Row,
            (_, None, Some(_)) => Place::Column,
            (_, None, None) => Place::File,
        }
    }

    /// What a message lacks; nothing, where it says all.
    pub fn lacks(&self, code: i32, message: &str) -> Vec<String> {
        let mut lacks = vec![];
        if code != self.code {
            lacks.push(format!("exit code {} (it is {code})", self.code));
        }
        // the line that is about this file
        let about = |line: &&str| {
            line.contains(&self.file)
                && self.row.is_none_or(|row| {
                    line.contains(&format!("{}, row {row},", self.file))
                        || line.contains(&format!("{}, row {row}:", self.file))
                })
                && self.column.as_ref().is_none_or(|column| line.contains(&format!("`{column}`")))
        };
        if !message.lines().any(|line| about(&line)) {
            lacks.push(format!("a line with {} row {:?} column {:?}", self.file, self.row, self.column));
        }
        lacks.extend(self.words.iter().filter(|w| !message.contains(w.as_str())).map(|w| format!("{w:?}")));
        if message.len() > 4096 {
            lacks.push(format!("at most 4 kB (it has {} bytes)", message.len()));
        }
        if message.contains("panicked") || message.contains(|c: char| c.is_control() && c != '\n') {
            lacks.push("no panic and no control character".into());
        }
        if self.place() != Place::Warning && !message.contains(';') && !message.contains(": correct") {
            lacks.push("a remedy".into());
        }
        lacks
    }
}
