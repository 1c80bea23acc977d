//! Activations of the samples of one shard at each time step.

use crate::gradient::Stretches;
use crate::row::Row;

/// Rows [slots][width]. A pass that keeps nothing uses slot 0 alone, whatever the step.
#[derive(Clone, Debug)]
pub(crate) struct Tape {
    rows: Vec<Row>,
    width: usize,
    one: Option<usize>,
}

impl Tape {
    /// Rows for `width` features and no slots yet.
    pub fn new(width: usize) -> Self {
        Self { rows: Vec::new(), width, one: None }
    }

    /// The same with a feature that is always one.
    pub fn with_one(width: usize, one: usize) -> Self {
        Self { rows: Vec::new(), width, one: Some(one) }
    }

    /// Makes sure of at least `slots`.
    pub fn reserve(&mut self, slots: usize) {
        let old = self.rows.len() / self.width.max(1);
        if slots > old {
            self.rows.resize(slots * self.width, Row::ZERO);
            if let Some(one) = self.one {
                (old..slots).for_each(|slot| self.rows[slot * self.width + one] = Row::ONE);
            }
        }
    }

    /// Features.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.width
    }

    /// The rows of a slot.
    #[inline(always)]
    pub fn at(&self, slot: usize) -> &[Row] {
        &self.rows[slot * self.width..][..self.width]
    }

    /// The rows of a slot.
    #[inline(always)]
    pub fn at_mut(&mut self, slot: usize) -> &mut [Row] {
        &mut self.rows[slot * self.width..][..self.width]
    }

    /// The rows of a slot and of the next.
    #[inline(always)]
    pub fn pair_mut(&mut self, slot: usize) -> (&mut [Row], &mut [Row]) {
        self.rows[slot * self.width..][..2 * self.width].split_at_mut(self.width)
    }

    /// Features `first .. first + width` of the slots from `slot` on.
    #[inline(always)]
    pub fn stretches(&self, slot: usize, first: usize, width: usize) -> Stretches<'_> {
        Stretches { rows: &self.rows[slot * self.width + first..], stride: self.width, width }
    }
}
