//! Places: which stretch of the packed weights and of the dense gradient belongs to which matrix.
//!
//! A plan is drawn up once a kernel, while the body lists its matrices in the order of the parameters.

use std::ops::Range;

use crate::matrix::Matrix;

/// A matrix that has its place in a buffer.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub matrix: Matrix,
    start: usize,
}

impl Placed {
    /// Returns the matrix's stretch of the buffer.
    #[inline(always)]
    pub fn of<'a>(&self, buffer: &'a [f32]) -> &'a [f32] {
        &buffer[self.range()]
    }

    /// Returns the matrix's stretch of the buffer.
    #[inline(always)]
    pub fn of_mut<'a>(&self, buffer: &'a mut [f32]) -> &'a mut [f32] {
        &mut buffer[self.range()]
    }

    #[inline(always)]
    fn range(&self) -> Range<usize> {
        self.start..self.start + self.matrix.len()
    }
}

/// Matrices placed so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    /// Number of parameters.
    pub parameters: usize,
    /// Matrices whose panels the forward pass reads.
    pub forward: Vec<Placed>,
    /// Matrices whose panels the backward pass reads.
    pub backward: Vec<Placed>,
    /// Matrices that get a gradient.
    pub gradients: Vec<Placed>,
}

/// Number of a matrix in its list of the [`Plan`].
pub(crate) type Place = usize;

impl Plan {
    /// Reserves `count` parameters, and returns the index of the first.
    pub fn parameters(&mut self, count: usize) -> usize {
        self.parameters += count;
        self.parameters - count
    }

    /// Returns a place among the weights that the forward pass reads.
    pub fn forward(&mut self, matrix: Matrix) -> Place {
        place(&mut self.forward, matrix)
    }

    /// Returns a place among the weights that the backward pass reads; `matrix` is that of the forward pass.
    pub fn backward(&mut self, matrix: &Matrix) -> Place {
        place(&mut self.backward, matrix.transposed())
    }

    /// Returns a place among the gradients.
    pub fn gradient(&mut self, matrix: Matrix) -> Place {
        place(&mut self.gradients, matrix)
    }
}

fn place(list: &mut Vec<Placed>, matrix: Matrix) -> Place {
    list.push(Placed { start: length(list), matrix });
    list.len() - 1
}

/// Returns the number of values in the buffer of a list.
pub(crate) fn length(list: &[Placed]) -> usize {
    list.iter().map(|placed| placed.matrix.len()).sum()
}

/// Writes the panels of all matrices on a list.
pub(crate) fn pack(list: &[Placed], parameters: &[f32], panels: &mut [f32]) {
    for placed in list {
        placed.matrix.pack(parameters, placed.of_mut(panels));
    }
}

/// The panels of all matrices on a list.
#[derive(Clone, Copy)]
pub(crate) struct Panels<'a> {
    pub list: &'a [Placed],
    pub values: &'a [f32],
}

impl<'a> Panels<'a> {
    /// Returns the panels of one matrix.
    #[inline(always)]
    pub fn at(&self, place: Place) -> &'a [f32] {
        self.list[place].of(self.values)
    }
}

/// The dense gradients of all matrices on a list.
pub(crate) struct Gradients<'a> {
    pub list: &'a [Placed],
    pub values: &'a mut [f32],
}

impl Gradients<'_> {
    /// Returns the gradient of one matrix.
    #[inline(always)]
    pub fn at(&mut self, place: Place) -> &mut [f32] {
        self.list[place].of_mut(self.values)
    }
}
