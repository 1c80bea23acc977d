//! Kind of each seed: dealt from shuffled decks, so that any run of seeds contains all kinds equally.
//!
//! Every twenty seeds in a row from a multiple of twenty hold twelve single mechanisms of the library, two pairs, three
//! mechanisms from outside of it and the three nulls. Within each of the four the deck is gone through before a card
//! comes again.

use super::kind::{INSIDE, Kind, NULLS, OUTSIDE, PAIRS};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Seed of all shuffles.
const DECK: u64 = 0x0ac3_dec4;
/// Number of campaigns of each class in a round of twenty: inside, pair, outside, null.
const HAND: [u64; 4] = [12, 2, 3, 3];

/// Returns the kind of a seed.
pub fn draw(seed: u64) -> Kind {
    let (round, place) = (seed / 20, (seed % 20) as usize);
    let mut classes: Vec<usize> = (0..4).flat_map(|class| vec![class; HAND[class] as usize]).collect();
    shuffle(&mut classes, round, 4);
    let class = classes[place];
    let before = classes[..place].iter().filter(|other| **other == class).count() as u64;
    // Wrapping: the largest seeds are cards as well.
    let card = round.wrapping_mul(HAND[class]).wrapping_add(before);
    let mut deck: Vec<Kind> = match class {
        0 => INSIDE.into_iter().map(Kind::One).collect(),
        1 => PAIRS.into_iter().map(|(one, two)| Kind::Two(one, two)).collect(),
        2 => OUTSIDE.into_iter().map(Kind::One).collect(),
        _ => NULLS.into_iter().map(Kind::Null).collect(),
    };
    let cards = deck.len() as u64;
    shuffle(&mut deck, card / cards, class as u64);
    deck[(card % cards) as usize]
}

/// Shuffles by Fisher & Yates, from a stream of the round's own.
fn shuffle<T>(cards: &mut [T], round: u64, class: u64) {
    let mut generator = ChaCha8Rng::seed_from_u64(DECK ^ (class << 56));
    generator.set_stream(round);
    for last in (1..cards.len()).rev() {
        cards.swap(last, generator.random_range(0..=last));
    }
}

#[cfg(test)]
mod tests {
    use super::super::truth::Class;
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn shares_hold_in_every_hand_and_every_card_comes() {
        for round in [0, 7, 1_000_003] {
            let mut counts: BTreeMap<Class, usize> = BTreeMap::new();
            (20 * round..20 * round + 20).for_each(|seed| *counts.entry(draw(seed).class()).or_default() += 1);
            let share = |class| counts.get(&class).copied().unwrap_or(0);
            assert_eq!([Class::Inside, Class::Pair, Class::Outside, Class::Null].map(share), [12, 2, 3, 3]);
        }
        let mut seen: BTreeMap<Kind, usize> = BTreeMap::new();
        (0..520).for_each(|seed| *seen.entry(draw(seed)).or_default() += 1);
        assert_eq!(seen.len(), Kind::drawn().len());
        assert!(INSIDE.iter().all(|cause| seen[&Kind::One(*cause)] == 12), "312 of 520 cards over 26");
        draw(u64::MAX);
    }
}
