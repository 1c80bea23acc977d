//! Sets of mechanisms that act together: any of the library's, except two that model the same part.
//!
//! The servo answers with one law, one weight hangs at the tip, the rotors blow one jet, and an encoder's zero or gain
//! drifts as one servo warms up.

use super::kind::{Cause, INSIDE};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Mechanisms of one part: at most one of each row acts.
const PARTS: [&[Cause]; 4] = [
    &[Cause::ActuatorLag, Cause::Resonance],
    &[Cause::TipLoad, Cause::Payload],
    &[Cause::Downwash, Cause::WakeLag],
    &[Cause::GainDrift, Cause::ZeroDrift],
];

/// Returns whether two mechanisms would be the same part in two ways.
pub fn contradict(one: Cause, two: Cause) -> bool {
    one == two || PARTS.iter().any(|part| part.contains(&one) && part.contains(&two))
}

/// Draws a number of mechanisms of the library that do not contradict each other.
pub fn causes(many: usize, generator: &mut ChaCha8Rng) -> Vec<Cause> {
    let (mut left, mut chosen) = (INSIDE.to_vec(), Vec::new());
    while chosen.len() < many && !left.is_empty() {
        let cause = left[generator.random_range(0..left.len())];
        left.retain(|other| !contradict(cause, *other));
        chosen.push(cause);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::super::super::random::{Purpose, Seeds};
    use super::*;

    #[test]
    fn six_are_drawn_without_contradiction_and_all_come() {
        let mut seen = std::collections::BTreeSet::new();
        for seed in 0..200 {
            let drawn = causes(6, &mut Seeds::both(seed).stream(1, Purpose::Rig));
            assert_eq!(drawn.len(), 6);
            assert_eq!(drawn.iter().collect::<std::collections::BTreeSet<_>>().len(), 6, "{drawn:?}");
            let both = |one: Cause, two: Cause| drawn.contains(&one) && drawn.contains(&two);
            assert!(!both(Cause::ActuatorLag, Cause::Resonance) && !both(Cause::TipLoad, Cause::Payload), "{drawn:?}");
            assert!(!both(Cause::Downwash, Cause::WakeLag) && !both(Cause::GainDrift, Cause::ZeroDrift), "{drawn:?}");
            seen.extend(drawn);
        }
        assert_eq!(seen.len(), INSIDE.len());
    }
}
