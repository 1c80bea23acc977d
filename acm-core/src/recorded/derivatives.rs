//! Derivatives of a signal: of a whole record, or of a piece of a stream.

use std::ops::Deref;
use std::sync::Arc;

use super::record::Record;
use crate::effects::memory::{Derivative, Derivatives};

/// Window of a stream over that of a whole record: it fits a parabola, with past samples only.
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
    /// Returns the derivatives of a signal: of a whole record by quartics with half windows of `window`, s; of a piece of a `stream` by
    /// parabolas with half of these.
    pub fn derivatives<'m>(&self, signal: &[f64], window: f64, stream: Option<&'m mut Derivatives>) -> Found<'m> {
        match stream {
            None => Found::Whole(self.derived.of(&self.time, signal, window)),
            Some(stream) => Found::Piece(stream.of(&self.time, signal, PAST * window)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand: a signal that turns into a straight line three quarters of a window ago has the rate of the line in a stream, and
    /// another in a parabola through the whole window.
    #[test]
    fn a_stream_looks_back_half_a_window() {
        let time: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
        let signal: Vec<f64> = time.iter().map(|t| 3.0 * (t - 1.24).max(0.0)).collect();
        let record = Record::new(time, vec![signal.clone()], vec![], vec![]);
        let newest = |window: f64| {
            let mut stream = Derivatives::default();
            record.derivatives(&signal, window, Some(&mut stream)).last().map_or(0.0, |found| found.rate)
        };
        assert!((newest(1.0) - 3.0).abs() < 1e-9, "{}", newest(1.0));
        assert!((newest(2.0) - 3.0).abs() > 0.05, "{}", newest(2.0));
    }
}
