//! Derivatives of a signal, as far as the record lets them be known: of a whole record, or of a piece of a stream.

use std::ops::Deref;
use std::sync::Arc;

use super::record::Record;
use crate::effects::memory::{Derivative, Derivatives};

/// Window of a stream, in those of a whole record: it fits a parabola, as it knows the past only.
const PAST: f64 = 0.5;

/// Derivatives at each sample.
pub enum Found<'m> {
    /// Of a whole record.
    Whole(Arc<Vec<Derivative>>),
    /// Of a piece of a stream.
    Piece(&'m [Derivative]),
}

impl Deref for Found<'_> {
    type Target = [Derivative];

    fn deref(&self) -> &[Derivative] {
        match self {
            Self::Whole(found) => found,
            Self::Piece(found) => found,
        }
    }
}

impl Record {
    /// Returns the derivatives of a signal: of a whole record by quartics through windows of half a width of `window`, s; of a piece of a
    /// `stream` by parabolas through half of them.
    pub fn derivatives<'m>(&self, signal: &[f64], window: f64, stream: Option<&'m mut Derivatives>) -> Found<'m> {
        match stream {
            None => Found::Whole(self.derived.of(&self.time, signal, window)),
            Some(stream) => Found::Piece(stream.of(&self.time, signal, PAST * window)),
        }
    }
}
