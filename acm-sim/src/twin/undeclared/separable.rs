//! Separability of a mechanism: whether its absence would be detectable, computed before the search.
//!
//! ```text
//! d = tip with all − tip with all but one,     r = d − X β̂,   β̂ fitted without the block
//! separable:   mean r² > 2 standard errors over blocks   and   √(σ² + mean r²) − σ > 0.05 σ
//! ```
//!
//! | symbol | meaning                                                                                    |
//! | --- | --- |
//! | `X`    | what a refit takes up: cubic maps of the actuators for each axis, what each other mechanism does |
//! | `σ`    | noise of the tip, 3-D                                                                      |
//! | block  | a development trial; a piece of one where there are less than six                          |
//!
//! The cubic maps contain the tangents of a recalibrated nominal model and more, so the answer errs towards no. Calibration
//! trials are always in the fit. Unrecorded offsets take every trial's mean away, from `d` and `X` alike. The standard
//! error has the spread over blocks and the noise in 2 r·e.

use nalgebra::{DMatrix, DVector, Vector3};

/// One trial, thinned.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Whether effects are sought in it; otherwise it calibrates.
    pub development: bool,
    /// Samples before thinning.
    pub samples: usize,
    /// Actuator angles, rad.
    pub actuators: Vec<[f64; 2]>,
    /// Displacement of the tip by each mechanism, m: mechanism, sample.
    pub differences: Vec<Vec<Vector3<f64>>>,
}

/// Noise of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of the tip's noise, 3-D, m.
    pub tip: f64,
    /// Whether trials have unrecorded offsets.
    pub offsets: bool,
}

/// Standard errors, and share of the noise, by which an absent mechanism has to be missed.
const SURE: f64 = 2.0;
const SHOWS: f64 = 0.05;
/// Smallest number of blocks.
const BLOCKS: usize = 6;
/// Number of monomials of degree three in two actuators.
const MONOMIALS: usize = 10;

/// Consequence of the absence of a mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Absence {
    /// Whether the absence shows.
    pub shows: bool,
    /// Mean r² in standard errors.
    pub errors: f64,
}

/// Returns the consequence of the absence of each mechanism.
pub fn separable(parts: &[Part], noise: Noise) -> Vec<Absence> {
    let many = parts.first().map_or(0, |part| part.differences.len());
    (0..many).map(|cause| absence(parts, cause, noise)).collect()
}

fn absence(parts: &[Part], cause: usize, noise: Noise) -> Absence {
    let blocks: Vec<Block> = parts.iter().flat_map(|part| blocks(part, parts, cause, noise.offsets)).collect();
    let size = blocks.first().map_or(0, |block| block.rows.ncols());
    let mut whole = (DMatrix::zeros(size, size), DVector::zeros(size));
    for block in &blocks {
        whole = (whole.0 + &block.normal, whole.1 + &block.right);
    }
    let left = |block: &Block| {
        let ridge = DMatrix::identity(size, size) * (1e-9 * whole.0.trace() / size as f64);
        let found = (&whole.0 - &block.normal + ridge).cholesky()?.solve(&(&whole.1 - &block.right));
        let rest = &block.target - &block.rows * found;
        Some((3.0 * rest.norm_squared() / rest.len() as f64, block.samples))
    };
    let squares: Option<Vec<(f64, f64)>> = blocks.iter().filter(|block| block.left_out).map(left).collect();
    squares.map_or_else(Absence::default, |squares| of_squares(&squares, noise.tip))
}

/// Tests whether mean squares (m²) over blocks of so many samples are significant, and large enough to show.
fn of_squares(squares: &[(f64, f64)], noise: f64) -> Absence {
    let many = squares.len() as f64;
    let mean = squares.iter().map(|(square, _)| square).sum::<f64>() / many;
    let spread = squares.iter().map(|(square, _)| (square - mean).powi(2)).sum::<f64>() / (many - 1.0).max(1.0);
    // Variance of the mean of 2 r·e over a block's samples; a third of the noise's square lies along r.
    let cross =
        squares.iter().map(|(square, samples)| 4.0 * square * noise * noise / 3.0 / samples).sum::<f64>() / many;
    let errors = mean / ((spread + cross) / many).sqrt().max(f64::MIN_POSITIVE);
    Absence { shows: errors > SURE && noise.hypot(mean.sqrt()) - noise > SHOWS * noise, errors }
}

/// Rows of a piece of a trial with their sums.
struct Block {
    left_out: bool,
    samples: f64,
    rows: DMatrix<f64>,
    target: DVector<f64>,
    normal: DMatrix<f64>,
    right: DVector<f64>,
}

fn blocks(part: &Part, all: &[Part], cause: usize, offsets: bool) -> Vec<Block> {
    let development = all.iter().filter(|part| part.development).count();
    let pieces = if part.development { BLOCKS.div_ceil(development.max(1)) } else { 1 };
    let (mut rows, mut target) = rows(part, cause);
    if offsets {
        centre(&mut rows, &mut target);
    }
    let length = part.actuators.len().div_ceil(pieces).max(1);
    let block = |from: usize| {
        let many = length.min(part.actuators.len() - from);
        let (rows, target) = (rows.rows(3 * from, 3 * many).into_owned(), target.rows(3 * from, 3 * many).into_owned());
        Block {
            left_out: part.development,
            samples: part.samples as f64 * many as f64 / part.actuators.len() as f64,
            normal: rows.tr_mul(&rows),
            right: rows.tr_mul(&target),
            rows,
            target,
        }
    };
    (0..part.actuators.len()).step_by(length).map(block).collect()
}

/// Returns three rows for each sample, one for each axis: maps of the axis, then the other mechanisms.
fn rows(part: &Part, cause: usize) -> (DMatrix<f64>, DVector<f64>) {
    let others: Vec<&Vec<Vector3<f64>>> =
        part.differences.iter().enumerate().filter(|(k, _)| *k != cause).map(|(_, difference)| difference).collect();
    let mut rows = DMatrix::zeros(3 * part.actuators.len(), 3 * MONOMIALS + others.len());
    let mut target = DVector::zeros(3 * part.actuators.len());
    for (sample, angles) in part.actuators.iter().enumerate() {
        let terms = monomials(*angles);
        for axis in 0..3 {
            let row = 3 * sample + axis;
            (0..MONOMIALS).for_each(|k| rows[(row, MONOMIALS * axis + k)] = terms[k]);
            // Of a size with the maps' terms, which are about one.
            others
                .iter()
                .enumerate()
                .for_each(|(k, other)| rows[(row, 3 * MONOMIALS + k)] = 100.0 * other[sample][axis]);
            target[row] = part.differences[cause][sample][axis];
        }
    }
    (rows, target)
}

/// Returns all products of up to three factors, of angles in units of about their range.
fn monomials([q1, q2]: [f64; 2]) -> [f64; MONOMIALS] {
    let (a, b) = (q1 / 2.4, (q2 - 1.2) / 1.2);
    [1.0, a, b, a * a, a * b, b * b, a * a * a, a * a * b, a * b * b, b * b * b]
}

/// Subtracts the mean of each axis.
fn centre(rows: &mut DMatrix<f64>, target: &mut DVector<f64>) {
    let many = target.len() / 3;
    for axis in 0..3 {
        let mean = |column: &dyn Fn(usize) -> f64| (0..many).map(|k| column(3 * k + axis)).sum::<f64>() / many as f64;
        for column in 0..rows.ncols() {
            let away = mean(&|row| rows[(row, column)]);
            (0..many).for_each(|k| rows[(3 * k + axis, column)] -= away);
        }
        let away = mean(&|row| target[row]);
        (0..many).for_each(|k| target[3 * k + axis] -= away);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the trials on a course of the actuators; `of` gives what two mechanisms do at an instant.
    fn parts(of: impl Fn(usize, f64, [f64; 2]) -> [f64; 2]) -> Vec<Part> {
        let part = |trial: usize| {
            let time = (0..100).map(|k| 0.5 * f64::from(k));
            let angle = |t: f64| [(0.9 * t + trial as f64).sin() * 2.0, 1.2 + (0.37 * t).cos()];
            let along = |which: usize| {
                let value = |t: f64| Vector3::new(of(trial, t, angle(t))[which], 0.0, 0.0);
                time.clone().map(value).collect()
            };
            let differences = vec![along(0), along(1)];
            Part { development: trial >= 3, samples: 500, actuators: time.clone().map(angle).collect(), differences }
        };
        (0..10).map(part).collect()
    }

    fn told(of: impl Fn(usize, f64, [f64; 2]) -> [f64; 2], offsets: bool) -> Vec<bool> {
        separable(&parts(of), Noise { tip: 2.6e-3, offsets }).iter().map(|absence| absence.shows).collect()
    }

    /// Oracle: what a map of the actuators takes up is not separable, what goes with time is; two that are alike are not.
    #[test]
    fn maps_and_likenesses_take_a_mechanism_up() {
        let wave = |t: f64| 0.01 * (2.3 * t).sin();
        assert_eq!(told(|_, t, q| [wave(t), 0.01 * q[0] * q[1]], false), [true, false]);
        assert_eq!(told(|_, t, _| [wave(t), 1.4 * wave(t)], false), [false, false]);
        assert_eq!(told(|_, t, _| [0.05 * wave(t), wave(t + 0.3)], false), [false, true], "half a millimetre of noise");
    }

    /// Oracle: what differs from trial to trial alone hides behind offsets; what acts in one trial is never sure.
    #[test]
    fn offsets_and_single_trials_hide_a_mechanism() {
        let level = |trial: usize| 0.01 * ((trial * 7) % 5) as f64;
        assert_eq!(told(|trial, t, _| [level(trial), 0.01 * (2.3 * t).sin()], false), [true, true]);
        assert_eq!(told(|trial, t, _| [level(trial), 0.01 * (2.3 * t).sin()], true), [false, true]);
        let once = |trial: usize| if trial == 6 { 0.03 } else { 0.0 };
        assert!(!told(|trial, t, _| [once(trial) * (2.3 * t).sin(), 0.01 * (1.1 * t).cos()], false)[0]);
    }

    /// Oracle: 5 % of 2 mm by hand, √(4 + x²) = 2.1 at x = 0.6403 mm.
    #[test]
    fn five_percent_of_the_noise_shows() {
        let alike = |millimetres: f64| vec![((1e-3 * millimetres).powi(2), 500.0); 8];
        assert!(of_squares(&alike(0.65), 2e-3).shows && !of_squares(&alike(0.63), 2e-3).shows);
    }

    /// Oracle: by hand. Eight blocks alike have no spread; with r² = 1 mm² and σ = 2 mm the variance of 2 r·e over 100 samples is
    /// 4·1·4/3/100 mm⁴, a standard error of √(0.05333/8) = 0.08165 mm².
    #[test]
    fn absence_is_counted_in_standard_errors() {
        let found = of_squares(&[(1e-6, 100.0); 8], 2e-3);
        assert!((found.errors - 1.0 / 0.081_650).abs() < 1e-2, "{found:?}");
    }
}
