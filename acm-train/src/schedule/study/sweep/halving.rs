//! Successive halving: many settings for a few epochs, the best of them for more. Jamieson & Talwalkar (2016), AISTATS 51,
//! 240; η as in Li et al. (2018), JMLR 18(185).
//!
//! ```text
//! n settings, R epochs in the experiment file, s = min(⌊log_η n⌋, ⌊log_η R⌋)
//! round k = 0 … s:    ⌊n / η^k⌋ settings for ⌊R / η^(s−k)⌋ epochs each
//! ```
//!
//! A round trains from the start, so that the learning rate follows the schedule of its own epochs, and every run has a record that
//! needs no other.

use toml::Value;

use super::axis::Setting;

/// Key that every round sets.
pub const EPOCHS: &str = "training.epochs";

/// One round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Round {
    settings: usize,
    epochs: usize,
}

/// Returns the next round: `first` holds the settings of the first one, `tried` and their `errors` what was done, round
/// after round; the last round trains for `epochs`.
pub fn next(first: &[Setting], eta: usize, epochs: usize, tried: &[Setting], errors: &[f64]) -> Vec<Setting> {
    let (mut start, mut from) = (0, 0..0);
    for round in rounds(first.len(), eta, epochs) {
        if start == tried.len() {
            let mut best: Vec<usize> = from.clone().collect();
            best.sort_by(|&a, &b| errors[a].total_cmp(&errors[b]).then(a.cmp(&b)));
            let best: Vec<&Setting> =
                if start == 0 { first.iter().collect() } else { best.iter().map(|&i| &tried[i]).collect() };
            return best.into_iter().take(round.settings).map(|setting| with(setting, round.epochs)).collect();
        }
        from = start..start + round.settings;
        start = from.end;
    }
    vec![]
}

fn rounds(settings: usize, eta: usize, epochs: usize) -> Vec<Round> {
    if settings == 0 || epochs == 0 {
        return vec![];
    }
    let last = settings.ilog(eta).min(epochs.ilog(eta));
    (0..=last).map(|k| Round { settings: settings / eta.pow(k), epochs: epochs / eta.pow(last - k) }).collect()
}

fn with(setting: &Setting, epochs: usize) -> Setting {
    let kept = setting.iter().filter(|(key, _)| key != EPOCHS).cloned();
    kept.chain([(EPOCHS.to_string(), Value::Integer(epochs as i64))]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(rate: f64) -> Setting {
        vec![("rate".into(), Value::Float(rate))]
    }

    /// Oracle: Li et al. (2018), Table 1, bracket s = 4 with η = 3 and R = 81: 81, 27, 9, 3 and 1 settings.
    #[test]
    fn rounds_are_those_of_the_paper() {
        let bracket = [(81, 1), (27, 3), (9, 9), (3, 27), (1, 81)];
        let rounds = |settings, eta, epochs| {
            rounds(settings, eta, epochs).into_iter().map(|round| (round.settings, round.epochs)).collect::<Vec<_>>()
        };
        assert_eq!(rounds(81, 3, 81), bracket);
        assert_eq!(rounds(24, 3, 60), [(24, 6), (8, 20), (2, 60)]);
        assert_eq!(rounds(16, 2, 5), [(16, 1), (8, 2), (4, 5)], "no round of less than an epoch");
        assert_eq!(rounds(5, 8, 60), [(5, 60)]);
        assert_eq!((rounds(0, 3, 60), rounds(9, 3, 0)), (vec![], vec![]));
    }

    /// Oracle: by hand; the error is the distance from 4, and of two equal ones the first continues.
    #[test]
    fn the_best_of_each_round_go_on() {
        let first: Vec<Setting> = (0..9).map(f64::from).map(setting).collect();
        let (mut tried, mut errors): (Vec<Setting>, Vec<f64>) = (vec![], vec![]);
        let mut batches = vec![];
        loop {
            let batch = next(&first, 3, 30, &tried, &errors);
            if batch.is_empty() {
                break;
            }
            let of = |setting: &Setting| (setting[0].1.as_float().unwrap(), setting[1].1.as_integer().unwrap());
            batches.push(batch.iter().map(of).collect::<Vec<_>>());
            errors.extend(batch.iter().map(|setting| (of(setting).0 - 4.0).abs()));
            tried.extend(batch);
        }
        assert_eq!(batches.len(), 3);
        assert_eq!(batches[0].iter().map(|of| of.1).collect::<Vec<_>>(), [3; 9]);
        assert_eq!(batches[1], [(4.0, 10), (3.0, 10), (5.0, 10)]);
        assert_eq!(batches[2], [(4.0, 30)]);
    }
}
