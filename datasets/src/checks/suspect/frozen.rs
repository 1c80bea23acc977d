//! Stretches in which an output repeats one value while the inputs move.
//!
//! | condition                                                                | keeps out                        |
//! | ------------------------------------------------------------------------ | -------------------------------- |
//! | 20 samples or more, and ten times the fourth-longest run of equal values | samples that are held, rests that come again |
//! | a thousand levels or more between least and greatest value               | coarse encoders and converters   |
//! | the inputs travel at least half as far as they usually do in that time   | a robot at rest                  |
//!
//! A sensor with noise hardly ever gives the same number twice: of a thousand levels that move, a run of twenty is no
//! chance. Where only some of the outputs are frozen, and they are no marker, every input that moves at all has to move:
//! one joint may rest while another is driven.

use std::ops::Range;

/// Samples of the shortest stretch that is reported.
const SHORTEST: usize = 20;

/// How many times the fourth-longest run.
const TIMES: usize = 10;

/// A signal with fewer levels is quantised.
const LEVELS: f64 = 1000.0;

/// Stretches of one value, out of proportion to the other runs of equal values.
pub fn find(values: &[f64]) -> Vec<Range<usize>> {
    let (mut runs, mut start) = (Vec::<Range<usize>>::new(), 0); // the four longest
    for i in 1..=values.len() {
        if i < values.len() && values[i] == values[start] {
            continue;
        }
        if runs.len() < 4 || i - start > runs[3].len() {
            let place = runs.partition_point(|run| run.len() >= i - start);
            runs.insert(place, start..i);
            runs.truncate(4);
        }
        start = i;
    }
    if runs.len() < 4 {
        return Vec::new();
    }
    let long = SHORTEST.max(TIMES * runs[3].len());
    runs.truncate(3);
    runs.retain(|run| run.len() >= long && 10 * run.len() <= 9 * values.len());
    runs.sort_unstable_by_key(|run| run.start);
    if levels(values) < LEVELS { Vec::new() } else { runs }
}

/// Range over the least step.
fn levels(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|step| *step > 0.0);
    let least = steps.fold(f64::INFINITY, f64::min);
    range(values) / least
}

/// Whether the inputs move in a stretch: on average, or every one of them.
pub fn inputs_move(inputs: &[&[f64]], run: &Range<usize>, on_average: bool) -> bool {
    let shares: Vec<f64> = inputs.iter().filter_map(|input| share(input, run)).collect();
    let mean = shares.iter().sum::<f64>() / shares.len().max(1) as f64;
    match on_average {
        true => mean >= 0.5,
        false => !shares.is_empty() && shares.iter().all(|share| *share >= 0.5),
    }
}

/// How far an input travels in a stretch, as a share of what it usually does in that time; 0 where it stays within a
/// twentieth of its range, `None` where it never moves.
fn share(input: &[f64], run: &Range<usize>) -> Option<f64> {
    let path = |values: &[f64]| values.windows(2).map(|v| (v[1] - v[0]).abs()).sum::<f64>();
    let (all, there) = (path(input), &input[run.clone()]);
    let usual = all * (run.len() - 1) as f64 / (input.len() - 1).max(1) as f64;
    let moves = range(there) >= 0.05 * range(input);
    (all > 0.0).then(|| if moves { path(there) / usual } else { 0.0 })
}

fn range(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    high - low
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(count: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..count).map(|i| of(i as f64)).collect()
    }

    fn moving(i: f64) -> f64 {
        (0.03 * i).sin() + 1e-4 * (77.7 * i).sin()
    }

    #[test]
    fn a_stretch_of_one_value_is_found() {
        let mut values = signal(1000, moving);
        let held = values[300];
        values[300..450].fill(held);
        assert_eq!(find(&values), vec![300..450]);
        let input = signal(1000, |i| (0.03 * i).sin());
        assert!(inputs_move(&[&input], &(300..450), true));
        let rests = signal(1000, |i| if (290.0..460.0).contains(&i) { 0.4 } else { (0.03 * i).sin() });
        assert!(!inputs_move(&[&rests], &(300..450), true));
        assert!(!inputs_move(&[], &(300..450), true) && !inputs_move(&[&[1.0; 1000]], &(300..450), false));
        let both = [input.as_slice(), &rests];
        assert!(inputs_move(&both, &(300..450), true) && !inputs_move(&both, &(300..450), false));
    }

    #[test]
    fn what_is_quantised_held_or_rests_often_is_not_frozen() {
        let none = |what: &str, of: &dyn Fn(f64) -> f64| assert!(find(&signal(1000, of)).is_empty(), "{what}");
        none("a signal", &moving);
        none("a constant", &|_| 2.0);
        none("a coarse encoder", &|i| (100.0 * (0.01 * i).sin()).round());
        none("samples held for ten", &|i| moving((i / 10.0).floor()));
        none("rests that come again", &|i| if i % 200.0 < 60.0 { 0.5 } else { moving(i) });
        none("a square wave", &|i| f64::from(u8::from(i % 300.0 < 150.0)));
        none("at rest but for the end", &|i| if i < 950.0 { 0.0 } else { moving(i) });
    }
}
