//! Best accuracy of parity from the events without their times.
//!
//! ```text
//! limit = Σ_e max(P(e, even), P(e, odd)),   e = (first bit, number of runs, whether the last run is longer than one bit)
//! ```
//!
//! Without times a sequence of events says e and no more: this is the best possible accuracy. The probabilities are counted bit
//! by bit, over all streams at once. For N = 32 it is 0.55000.

/// Probabilities by number of runs, first bit, whether the last run is longer than one bit, and parity.
type Counts = Vec<[[[f64; 2]; 2]; 2]>;

/// The best share of right guesses without elapsed time, for streams of 2 … `length` − 1 bits.
pub fn limit(length: usize) -> f64 {
    // There are at most as many runs as bits.
    let mut now: Counts = vec![[[[0.0; 2]; 2]; 2]; length + 1];
    (now[1][0][0][0], now[1][1][0][1]) = (0.5, 0.5);
    let mut all: Counts = vec![[[[0.0; 2]; 2]; 2]; length + 1];
    for _ in 2..length {
        now = longer(&now);
        let both = all.iter_mut().flatten().flatten().flatten().zip(now.iter().flatten().flatten().flatten());
        both.for_each(|(sum, share)| *sum += share / (length - 2) as f64);
    }
    all.iter().flatten().flatten().map(|[even, odd]| even.max(*odd)).sum()
}

/// One bit more: it goes on with the last run, or begins another.
fn longer(now: &Counts) -> Counts {
    let mut next: Counts = vec![[[[0.0; 2]; 2]; 2]; now.len()];
    for runs in 1..now.len() - 1 {
        for (first, of_first) in now[runs].iter().enumerate() {
            let last = (first + runs + 1) % 2;
            for parity in 0..2 {
                let half = of_first.iter().map(|of_run| of_run[parity]).sum::<f64>() / 2.0;
                next[runs][first][1][(parity + last) % 2] += half;
                next[runs + 1][first][0][(parity + 1 - last) % 2] += half;
            }
        }
    }
    next
}

#[cfg(test)]
mod tests {
    use super::super::{BitStream, generate};
    use super::*;

    /// Oracle: by hand. Streams of two bits differ in their events. Among those of two and three bits, 11 (1/8, even) looks
    /// like 111 (1/16, odd), and 10 (1/8, odd) like 110 (1/16, even).
    #[test]
    fn short_streams() {
        assert_eq!(limit(3), 1.0);
        assert_eq!(limit(4), 1.0 - 2.0 / 16.0);
    }

    /// Oracle: the streams themselves. A table of what is more frequent among 200,000 of them is right about that often.
    #[test]
    fn counting_streams_gives_the_same() {
        let set = generate(&BitStream { training: 200_000, validation: 0.0, test: 0, ..BitStream::default() });
        let mut counts = std::collections::BTreeMap::<(u64, usize, bool), [usize; 2]>::new();
        for sequence in &set.training {
            let (bits, n) = (&sequence.inputs, sequence.steps());
            let seen = (bits[(0, 0)] as u64, n, bits[(n - 1, 0)] == bits[(n - 2, 0)]);
            counts.entry(seen).or_default()[sequence.targets[(0, 0)] as usize] += 1;
        }
        let right = counts.values().map(|both| both[0].max(both[1])).sum::<usize>() as f64 / 200_000.0;
        assert!((right - limit(32)).abs() < 0.005, "{right} {}", limit(32));
        assert!((limit(32) - 0.55).abs() < 1e-4, "{}", limit(32));
    }
}
