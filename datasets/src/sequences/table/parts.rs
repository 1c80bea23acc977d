//! Training, validation and test parts of sequences: from a column, or drawn.

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::super::Sequence;
use super::Tables;
use super::steps::Cut;

/// The sequences of each part, in the order of the files.
pub fn deal(tables: &Tables, sequences: Vec<Cut>) -> [Vec<Sequence>; 3] {
    let drawn = drawn(tables, sequences.len());
    let mut parts = [vec![], vec![], vec![]];
    for (cut, drawn) in sequences.into_iter().zip(drawn) {
        parts[cut.part.unwrap_or(drawn)].extend(cut.sequences);
    }
    parts
}

/// The part of each sequence: the first of a shuffled list are tested, the next choose, the others learn.
fn drawn(tables: &Tables, count: usize) -> Vec<usize> {
    let share = |share: f64| (share * count as f64).round() as usize;
    let (test, validation) = (share(tables.test), share(tables.validation));
    let mut order: Vec<usize> = (0..count).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(tables.seed));
    let mut parts = vec![0; count];
    for (place, index) in order.into_iter().enumerate() {
        parts[index] = if place < test { 2 } else { usize::from(place < test + validation) };
    }
    parts
}
