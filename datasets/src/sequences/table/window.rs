//! Windows of one length over a sequence of S steps.
//!
//! ```text
//! window n   steps n·stride + 1 … n·stride + length        while n·stride + length + spare ≤ S
//! ```
//!
//! A sequence that is too short for one is a window by itself. A window is called by the name of its sequence and its first step.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// Between the name of a sequence and the first step of a window.
const FROM: &str = " from step ";

/// Name of a window that begins at a step, from 0.
pub(super) fn name(sequence: &str, start: usize) -> String {
    format!("{sequence}{FROM}{}", start + 1)
}

/// Name of the sequence that a window is of; of a whole sequence its own.
pub fn whole(window: &str) -> &str {
    match window.rsplit_once(FROM) {
        Some((sequence, step)) if step.bytes().all(|byte| byte.is_ascii_digit()) => sequence,
        _ => window,
    }
}

/// How a sequence is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Windows {
    /// Steps of a window.
    pub length: usize,
    /// Steps from one start to the next.
    pub stride: usize,
    /// Steps that are left behind the last window, at least.
    #[serde(default)]
    pub spare: usize,
}

impl Windows {
    /// Steps of each window, from 0.
    pub(super) fn of(self, steps: usize) -> Vec<Range<usize>> {
        let last = steps.checked_sub(self.length + self.spare);
        match last {
            Some(last) => (0..=last).step_by(self.stride).map(|start| start..start + self.length).collect(),
            None => vec![0..steps],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_called_by_their_sequence() {
        assert_eq!(name("walk", 0), "walk from step 1");
        assert_eq!(
            [whole("walk from step 17"), whole("walk"), whole("walk from step b")],
            ["walk", "walk", "walk from step b"]
        );
    }

    /// Oracle: by hand.
    #[test]
    fn windows_lie_within_the_sequence() {
        let of = |length, stride, spare, steps| Windows { length, stride, spare }.of(steps);
        assert_eq!(of(4, 2, 0, 8), [0..4, 2..6, 4..8]);
        assert_eq!(of(4, 2, 1, 8), [0..4, 2..6]);
        assert_eq!(of(4, 2, 1, 9), [0..4, 2..6, 4..8]);
        assert_eq!(of(4, 2, 0, 3), [0..3]);
    }
}
