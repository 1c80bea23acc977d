//! The values of one column of a table.

/// One column.
#[derive(Debug, Clone)]
pub enum Values {
    /// Numbers; empty cells have none.
    Numbers(Vec<Option<f64>>),
    /// Words.
    Words(Vec<Option<String>>),
}

impl Values {
    /// Words that are all there.
    pub fn words<T: Into<String>>(words: impl IntoIterator<Item = T>) -> Self {
        Self::Words(words.into_iter().map(|word| Some(word.into())).collect())
    }

    /// Numbers that are all there.
    pub fn numbers(numbers: impl IntoIterator<Item = f64>) -> Self {
        Self::Numbers(numbers.into_iter().map(Some).collect())
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Words(values) => values.len(),
        }
    }
}
