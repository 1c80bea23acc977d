//! Where the entries of a matrix lie among the flat parameters, and its two other layouts.
//!
//! A matrix is the sum of blocks, each a stretch of the parameters in torch's layout. A bias is a block of
//! one column, under the input that is always one; two blocks in one place are added, as torch's two
//! biases of a gate are, and both get the gradient.
//!
//! | layout     | order                                               | for                          |
//! | ---------- | --------------------------------------------------- | ---------------------------- |
//! | parameters | torch's                                             | the caller                   |
//! | panels     | as [`product`](crate::product) reads them           | forward; transposed backward |
//! | dense      | [rows, columns], one after the other                | sums of gradients            |

use std::ops::Range;

use crate::product::PANEL;

/// A rectangle of a matrix that is a stretch of the parameters.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Rows of the matrix.
    pub rows: Range<usize>,
    /// Columns of the matrix.
    pub columns: Range<usize>,
    /// The parameter at its first row and column.
    pub first: usize,
    /// Parameters from one row to the next, and from one column to the next.
    pub strides: (usize, usize),
}

/// A matrix as the sum of its blocks; zero where none is.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    blocks: Vec<Block>,
}

impl Matrix {
    /// Zeros.
    pub fn new(rows: usize, columns: usize) -> Self {
        Self { rows, columns, blocks: Vec::new() }
    }

    /// With a block of row-major parameters from `first` on, `stride` of them a row.
    pub fn with(mut self, rows: Range<usize>, columns: Range<usize>, first: usize, stride: usize) -> Self {
        self.blocks.push(Block { rows, columns, first, strides: (stride, 1) });
        self
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.rows * self.columns
    }

    /// The part of it at `rows` and `columns`.
    pub fn part(&self, rows: Range<usize>, columns: Range<usize>) -> Self {
        let cut = |own: &Range<usize>, to: &Range<usize>| {
            let (start, end) = (own.start.max(to.start), own.end.min(to.end));
            (start < end).then(|| (start - own.start, start - to.start..end - to.start))
        };
        let blocks = self.blocks.iter().filter_map(|block| {
            let (down, new_rows) = cut(&block.rows, &rows)?;
            let (right, new_columns) = cut(&block.columns, &columns)?;
            let first = block.first + down * block.strides.0 + right * block.strides.1;
            Some(Block { rows: new_rows, columns: new_columns, first, strides: block.strides })
        });
        Self { rows: rows.len(), columns: columns.len(), blocks: blocks.collect() }
    }

    /// Rows for columns.
    pub fn transposed(&self) -> Self {
        let turn = |block: &Block| Block {
            rows: block.columns.clone(),
            columns: block.rows.clone(),
            first: block.first,
            strides: (block.strides.1, block.strides.0),
        };
        Self { rows: self.columns, columns: self.rows, blocks: self.blocks.iter().map(turn).collect() }
    }
    /// Each entry once for each of its blocks: `visit` gets row, column and parameter.
    pub fn entries(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for block in &self.blocks {
            for (down, row) in block.rows.clone().enumerate() {
                for (right, column) in block.columns.clone().enumerate() {
                    visit(row, column, block.first + down * block.strides.0 + right * block.strides.1);
                }
            }
        }
    }

    /// Writes the panels.
    pub fn pack(&self, parameters: &[f32], panels: &mut [f32]) {
        panels.fill(0.0);
        for block in &self.blocks {
            for (down, row) in block.rows.clone().enumerate() {
                let start = row / PANEL * PANEL;
                let width = PANEL.min(self.rows - start);
                let to = panels[start * self.columns + (row - start)..].iter_mut().step_by(width);
                let from = parameters[block.first + down * block.strides.0..].iter().step_by(block.strides.1);
                for (to, from) in to.skip(block.columns.start).zip(from.take(block.columns.len())) {
                    *to += from;
                }
            }
        }
    }

    /// Adds the dense gradient to that of the parameters.
    pub fn unpack(&self, dense: &[f32], gradient: &mut [f32]) {
        for block in &self.blocks {
            for (down, row) in block.rows.clone().enumerate() {
                let from = &dense[row * self.columns + block.columns.start..][..block.columns.len()];
                let to = gradient[block.first + down * block.strides.0..].iter_mut().step_by(block.strides.1);
                for (to, from) in to.zip(from) {
                    *to += from;
                }
            }
        }
    }
}
