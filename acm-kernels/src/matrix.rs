//! Positions of a matrix's entries among the flat parameters, and its two packed layouts.
//!
//! A matrix is the sum of blocks, each a stretch of the parameters in torch's layout. A bias is a block of
//! one column, under the input that is always one; two blocks in one place are added, as torch's two
//! biases of a gate are, and both get the gradient.
//!
//! | layout     | order                                               | for                          |
//! | ---------- | --------------------------------------------------- | ---------------------------- |
//! | parameters | torch's                                             | the caller                   |
//! | panels     | as [`product`](crate::vectors::product) reads them           | forward; transposed backward |
//! | dense      | as [`gradient`](crate::vectors::gradient) writes its panels  | sums of gradients            |

use std::ops::Range;

use crate::vectors::gradient::HIGH;
use crate::vectors::product::PANEL;

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
    /// Returns a matrix of zeros.
    pub fn new(rows: usize, columns: usize) -> Self {
        Self { rows, columns, blocks: Vec::new() }
    }

    /// Adds a block of row-major parameters from `first` on, `stride` of them a row.
    pub fn with(mut self, rows: Range<usize>, columns: Range<usize>, first: usize, stride: usize) -> Self {
        self.blocks.push(Block { rows, columns, first, strides: (stride, 1) });
        self
    }

    /// Returns the number of entries.
    pub fn len(&self) -> usize {
        self.rows * self.columns
    }

    /// Returns the part of the matrix at `rows` and `columns`.
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

    /// Returns the matrix with rows and columns exchanged.
    pub fn transposed(&self) -> Self {
        let turn = |block: &Block| Block {
            rows: block.columns.clone(),
            columns: block.rows.clone(),
            first: block.first,
            strides: (block.strides.1, block.strides.0),
        };
        Self { rows: self.columns, columns: self.rows, blocks: self.blocks.iter().map(turn).collect() }
    }

    /// Calls `visit` with row, column and parameter of each entry, once for each of its blocks.
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
            for piece in self.pieces(block, PANEL) {
                let columns = panels[piece.panel..].chunks_exact_mut(piece.width).take(block.columns.len());
                for (right, column) in columns.enumerate() {
                    let (to, from) = (&mut column[piece.lanes.clone()], piece.parameters + right * block.strides.1);
                    match to.first_chunk_mut::<PANEL>() {
                        // Most panels are whole, and a length that is known spares the loop over it.
                        Some(to) => add_strided(to, &parameters[from..], block.strides.0),
                        None => add_strided(to, &parameters[from..], block.strides.0),
                    }
                }
            }
        }
    }

    /// Adds the dense gradient to that of the parameters. The matrix is none that was transposed.
    pub fn unpack(&self, dense: &[f32], gradient: &mut [f32]) {
        for block in &self.blocks {
            debug_assert_eq!(block.strides.1, 1);
            for piece in self.pieces(block, HIGH) {
                let panel = &dense[piece.panel..];
                for (down, lane) in piece.lanes.enumerate() {
                    let to = &mut gradient[piece.parameters + down * block.strides.0..][..block.columns.len()];
                    if piece.width == HIGH {
                        let (columns, _) = panel.as_chunks::<HIGH>();
                        to.iter_mut().zip(columns).for_each(|(to, from)| *to += from[lane]);
                    } else {
                        add_strided(to, &panel[lane..], piece.width);
                    }
                }
            }
        }
    }

    /// Returns a block cut where panels of `high` rows end.
    fn pieces<'a>(&'a self, block: &'a Block, high: usize) -> impl Iterator<Item = Piece> + 'a {
        (block.rows.start / high * high..block.rows.end).step_by(high).map(move |start| {
            let rows = block.rows.start.max(start)..block.rows.end.min(start + high);
            let width = high.min(self.rows - start);
            Piece {
                panel: start * self.columns + block.columns.start * width,
                width,
                lanes: rows.start - start..rows.end - start,
                parameters: block.first + (rows.start - block.rows.start) * block.strides.0,
            }
        })
    }
}

/// The rows of a block that share a panel.
struct Piece {
    /// Index of the panel's first value at the block's first column.
    panel: usize,
    /// Rows of the panel.
    width: usize,
    /// Rows of the block among those of the panel.
    lanes: Range<usize>,
    /// Index of the first parameter.
    parameters: usize,
}

/// Adds every `stride`-th value.
#[inline(always)]
fn add_strided(to: &mut [f32], from: &[f32], stride: usize) {
    if stride == 1 {
        to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
    } else {
        to.iter_mut().enumerate().for_each(|(i, to)| *to += from[i * stride]);
    }
}
