//! Activations of the samples of one shard at each time step.

use crate::vectors::gradient::Stretches;
use crate::vectors::row::Row;

/// Rows [slots][width]. A pass that keeps nothing uses slot 0 alone, whatever the step.
///
/// From slot to slot it is an odd number of rows. Were it a power of two, a feature's rows of all slots would
/// fall into the same few sets of the first-level cache, and drive each other out.
#[derive(Clone, Debug)]
pub(crate) struct Tape {
    rows: Vec<Row>,
    width: usize,
    stride: usize,
    one: Option<usize>,
}

impl Tape {
    /// Returns a tape with rows for `width` features and no slots yet.
    pub fn new(width: usize) -> Self {
        Self { rows: Vec::new(), width, stride: width | 1, one: None }
    }

    /// Returns a tape with a feature that is always one.
    pub fn with_one(width: usize, one: usize) -> Self {
        Self { one: Some(one), ..Self::new(width) }
    }

    /// Reserves at least `slots`.
    pub fn reserve(&mut self, slots: usize) {
        let old = self.rows.len() / self.stride;
        if slots > old {
            self.rows.resize(slots * self.stride, Row::ZERO);
            if let Some(one) = self.one {
                (old..slots).for_each(|slot| self.rows[slot * self.stride + one] = Row::ONE);
            }
        }
    }

    /// Returns the number of features.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the rows of a slot.
    #[inline(always)]
    pub fn at(&self, slot: usize) -> &[Row] {
        &self.rows[slot * self.stride..][..self.width]
    }

    /// Returns the rows of a slot.
    #[inline(always)]
    pub fn at_mut(&mut self, slot: usize) -> &mut [Row] {
        &mut self.rows[slot * self.stride..][..self.width]
    }

    /// Returns the rows of a slot and of the next.
    #[inline(always)]
    pub fn pair_mut(&mut self, slot: usize) -> (&mut [Row], &mut [Row]) {
        let (here, next) = self.rows[slot * self.stride..].split_at_mut(self.stride);
        (&mut here[..self.width], &mut next[..self.width])
    }

    /// Returns features `first .. first + width` of the slots from `slot` on.
    #[inline(always)]
    pub fn stretches(&self, slot: usize, first: usize, width: usize) -> Stretches<'_> {
        Stretches { rows: &self.rows[slot * self.stride + first..], stride: self.stride, width }
    }
}
