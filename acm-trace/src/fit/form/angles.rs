//! Sums of angles that a nominal form may have terms of.
//!
//! ```text
//! a·cos(n·q) + b·sin(n·q),   n_j = −1, 0, 1 for actuators in rad, else 0
//! ```
//!
//! Positions of a chain of revolute joints, and its gravity torques, are linear in them (Siciliano et al. 2009, Robotics, ch. 2 and 7).
//! Where all axes are parallel, sums of consecutive joints suffice: links have angles q_1 + … + q_k, and forces across a link turn with
//! q_i + … + q_k.

use acm_core::rig::{Rig, Signal};

/// Which sums a form has terms of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sums {
    /// None.
    None,
    /// Those of all joints from the first on, q_1 + … + q_k.
    Chain,
    /// Those of consecutive joints, q_i + … + q_k.
    Planar,
    /// Those of at most so many joints, with either sign.
    UpTo(usize),
}

impl Sums {
    /// Returns a number that stands for it.
    pub fn key(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Chain => -2.0,
            Self::Planar => -1.0,
            Self::UpTo(joints) => joints as f64,
        }
    }
}

/// Returns the multiples n of each sum, one of n and −n.
pub fn sums(rig: &Rig, which: Sums) -> Vec<Vec<i8>> {
    match which {
        Sums::None => vec![],
        Sums::Chain => planar(rig, 1),
        Sums::Planar => planar(rig, usize::MAX),
        Sums::UpTo(joints) => signed(rig, joints),
    }
}

/// Returns the sums of consecutive joints that begin with one of the first `first`.
fn planar(rig: &Rig, first: usize) -> Vec<Vec<i8>> {
    let angles: Vec<usize> = (0..rig.actuators.len()).filter(|&j| is_angle(&rig.actuators[j])).collect();
    let of = |chain: &[usize]| (0..rig.actuators.len()).map(|j| i8::from(chain.contains(&j))).collect();
    (0..angles.len().min(first))
        .flat_map(|i| (i..angles.len()).map(move |k| (i, k)))
        .map(|(i, k)| of(&angles[i..=k]))
        .collect()
}

fn signed(rig: &Rig, joined: usize) -> Vec<Vec<i8>> {
    let mut all = vec![vec![]];
    for actuator in &rig.actuators {
        let multiples: &[i8] = if is_angle(actuator) { &[0, 1, -1] } else { &[0] };
        let longer = |sum: Vec<i8>| multiples.iter().map(move |n| [&sum[..], &[*n]].concat());
        all = all.into_iter().flat_map(longer).filter(|sum| is_one_of_both(sum) && count(sum) <= joined).collect();
    }
    all.retain(|sum| count(sum) > 0);
    all
}

/// Returns the number of actuators that are angles.
pub fn angles(rig: &Rig) -> usize {
    rig.actuators.iter().filter(|actuator| is_angle(actuator)).count()
}

fn is_angle(actuator: &Signal) -> bool {
    actuator.unit == "rad"
}

fn count(sum: &[i8]) -> usize {
    sum.iter().filter(|n| **n != 0).count()
}

fn is_one_of_both(sum: &[i8]) -> bool {
    sum.iter().find(|n| **n != 0).is_none_or(|first| *first == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::bench;

    /// Oracle: by hand; three angles make 13 sums of up to three, since 3³ patterns of signs are two of each and zero.
    #[test]
    fn each_sum_is_there_once() {
        let two = bench::rig(&["a", "b"], &[], &["y"]);
        assert_eq!(sums(&two, Sums::UpTo(1)), [[0, 1], [1, 0]]);
        assert_eq!(sums(&two, Sums::UpTo(2)), [[0, 1], [1, 0], [1, 1], [1, -1]]);
        let mut three = bench::rig(&["a", "b", "c"], &[], &["y"]);
        assert_eq!((sums(&three, Sums::UpTo(3)).len(), angles(&three)), (13, 3));
        let planar = [[1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 0], [0, 1, 1], [0, 0, 1]];
        assert_eq!(sums(&three, Sums::Planar), planar);
        assert_eq!(sums(&three, Sums::Chain), planar[..3]);
        three.actuators[1].unit = "V".into();
        assert_eq!((sums(&three, Sums::UpTo(3)).len(), angles(&three)), (4, 2));
        assert_eq!(sums(&three, Sums::Planar), [[1, 0, 0], [1, 0, 1], [0, 0, 1]]);
    }
}
