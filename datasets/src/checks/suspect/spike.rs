//! Single outliers: samples far from the median of their neighbourhood (Hampel identifier).
//!
//! ```text
//! e_i = x_i − median(x_{i−3} … x_{i+3})       0 on steps and ramps, small on anything that is sampled well
//! outlier where |e_i| > 30 E and |e_i| > R/2,   or   |e_i| > 200 E and |e_i| > R/20
//! ```
//!
//! | symbol | meaning                                                             |
//! | ------ | ------------------------------------------------------------------- |
//! | `E`    | the |e| that one sample in a hundred passes, or else the usual step of a signal that is quantised |
//! | `R`    | range of all samples but the farthest one in a hundred at either end |
//!
//! Of white noise, the greatest of a million |e| is 1.9 E; of a Laplace distribution 3 E. In recordings of a trunk, a brake, a
//! grasper, a pneumatic cylinder and a fatigue rig the greatest |e| of an output is 25 E where it is more than R/2, and 69 E where it is
//! less: markers that jump by millimetres while others hide them, and friction that slips. A pulse of four samples or more is no
//! outlier. Hampel (1974), JASA 69(346).

/// Samples to either side.
const SIDE: usize = 3;

/// Fewer samples say too little of what is usual.
const LEAST: usize = 20;

/// An outlier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spike {
    pub sample: usize,
    pub value: f64,
    /// Distance from the median of its neighbourhood.
    pub away: f64,
}

/// The outliers of a signal.
pub fn find(values: &[f64]) -> Vec<Spike> {
    if values.len() < LEAST {
        return Vec::new();
    }
    let away: Vec<f64> = (0..values.len()).map(|i| (values[i] - median(values, i)).abs()).collect();
    let few = (values.len() / 100).max(3);
    let usual = nth_from_above(away.clone(), few).max(step(values));
    let (high, low) = (nth_from_above(values.to_vec(), few), -nth_from_above(values.iter().map(|v| -v).collect(), few));
    let limit = (30.0 * usual).max((high - low) / 2.0).min((200.0 * usual).max((high - low) / 20.0));
    let spike = |(sample, away): (usize, &f64)| Spike { sample, value: values[sample], away: *away };
    let beyond = |spike: &Spike| usual > 0.0 && spike.away > limit;
    away.iter().enumerate().map(spike).filter(beyond).collect()
}

fn median(values: &[f64], i: usize) -> f64 {
    let start = i.saturating_sub(SIDE).min(values.len() - 2 * SIDE - 1);
    let mut near = [0.0; 2 * SIDE + 1];
    near.copy_from_slice(&values[start..=start + 2 * SIDE]);
    near.sort_unstable_by(f64::total_cmp);
    near[SIDE]
}

fn nth_from_above(mut values: Vec<f64>, n: usize) -> f64 {
    *values.select_nth_unstable_by(n, |a, b| b.total_cmp(a)).1
}

/// The usual step of a signal that mostly rests: the median of those that are not 0.
fn step(values: &[f64]) -> f64 {
    let mut steps: Vec<f64> = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|step| *step > 0.0).collect();
    // an outlier alone makes two steps
    match steps.len() {
        0..=6 => 0.0,
        count => *steps.select_nth_unstable_by(count / 2, f64::total_cmp).1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even noise in −0.5 to 0.5.
    fn noise(i: usize) -> f64 {
        ((i as u64 * 2_654_435_761 + 12_345) % 10_007) as f64 / 10_007.0 - 0.5
    }

    fn samples(values: &[f64]) -> Vec<usize> {
        find(values).iter().map(|spike| spike.sample).collect()
    }

    #[test]
    fn outliers_are_found_wherever_they_are() {
        for at in [0, 1, 30, 250, 498, 499] {
            let mut values: Vec<f64> = (0..500).map(|i| 0.2 * (0.05 * i as f64).sin() + 1e-3 * noise(i)).collect();
            values[at] += 5.0;
            assert_eq!(samples(&values), [at]);
            let spike = find(&values)[0];
            assert!((spike.away - 5.0).abs() < 0.1 && spike.value == values[at], "{spike:?}");
        }
        let mut values: Vec<f64> = (0..60).map(|i| (0.1 * f64::from(i)).cos()).collect();
        values[7] = -50.0;
        values[40] = 50.0;
        values[41] = 50.0;
        assert_eq!(samples(&values), [7, 40, 41]);
    }

    #[test]
    fn steps_ramps_noise_pulses_and_quanta_have_none() {
        let none = |what: &str, of: &dyn Fn(usize) -> f64| {
            for count in [60, 3000] {
                let values: Vec<f64> = (0..count).map(of).collect();
                assert_eq!(samples(&values), [0; 0], "{what}, {count} samples");
            }
        };
        none("a step", &|i| if i < 11 { 0.0 } else { 5.0 });
        none("a step with noise", &|i| 1e-3 * noise(i) + if i < 11 { 0.0 } else { 5.0 });
        none("a constant", &|_| 3.0);
        none("noise", &noise);
        none("heavy tails", &|i| noise(i).powi(9) * 512.0);
        none("a sine", &|i| (0.3 * i as f64).sin());
        none("a sine of four samples a turn", &|i| (1.6 * i as f64).sin());
        none("coarse quanta", &|i| (3.0 * (0.02 * i as f64).sin()).round());
        none("a flicker of the last digit", &|i| f64::from(u8::from(i % 37 == 5)));
        none("pulses", &|i| f64::from(u8::from(i % 50 < 2)) * 10.0 + 0.01 * noise(i));
        none("a pulse of five samples", &|i| f64::from(u8::from((10..15).contains(&i))) * 10.0 + 0.01 * noise(i));
        none("a square wave", &|i| f64::from(u8::from(i % 16 < 8)));
        none("a staircase", &|i| (i / 10) as f64);
    }
}
