//! Static discrepancy map: the nominal residual at rest, a smooth function of the actuators.
//!
//! ```text
//! m(q) = Σ_j b_j Π_a T_{n_ja}(z_a) + Σ_h s_h max(0, q_{a_h} − κ_h) + Σ_h h(q),
//!        z_a = clamp( (2 q_a − high_a − low_a)/(high_a − low_a), −1, 1 ),   Σ_a n_ja ≤ degree
//! ```
//!
//! | symbol   | meaning                                              | shape | unit |
//! | `b`      | coefficients                                         | J × M | of the outputs |
//! | `T_n`    | Chebyshev polynomial of the first kind               |       | 1    |
//! | `κ`, `s` | kinks: where the slope with an actuator changes, and by how much; most maps have none | H, H × M | of the actuator; outputs / actuator |
//! | `h`      | [harmonics](Harmonic) of angles; most maps have none | H     | of the outputs |
//! | `low`, `high` | range of each actuator in the trials that it is fitted to | A | SI |
//!
//! Outside that range the polynomials keep their border values; kinks continue linearly, and harmonics go on
//! everywhere. Boyd (2001), Chebyshev and Fourier Spectral Methods, ch. 2.

mod harmonic;
mod kink;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

pub use harmonic::Harmonic;
pub use kink::Kink;

/// Highest degree that is tried.
const LARGEST_DEGREE: usize = 9;

/// A map with its coefficients.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaticMap {
    low: Vec<f64>,
    high: Vec<f64>,
    exponents: Vec<Vec<usize>>,
    coefficients: DMatrix<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    kinks: Vec<Kink>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    harmonics: Vec<Harmonic>,
}

/// Memory of one evaluation.
#[derive(Debug, Clone)]
pub struct MapScratch(Vec<AxisValues>);

impl StaticMap {
    /// The map Σ_j c_j Π_a z_a^{n_ja}, as it stands in powers of the normalised actuators; `coefficients` is J × M.
    ///
    /// # Panics
    /// If a power is above nine, or there is not one row of coefficients for each list of powers.
    pub fn from_powers(low: Vec<f64>, high: Vec<f64>, powers: &[Vec<usize>], coefficients: &DMatrix<f64>) -> Self {
        assert_eq!(powers.len(), coefficients.nrows(), "one row of coefficients for each list of powers");
        let degree = powers.iter().map(|n| n.iter().sum::<usize>()).max().unwrap_or(0);
        assert!(degree <= LARGEST_DEGREE, "powers up to {LARGEST_DEGREE}");
        let exponents = exponents(low.len(), degree);
        let mut own = DMatrix::zeros(exponents.len(), coefficients.ncols());
        for (j, powers) in powers.iter().enumerate() {
            for (row, n) in exponents.iter().enumerate() {
                let share: f64 = powers.iter().zip(n).map(|(&power, &n)| in_chebyshev(power, n)).product();
                let mut row = own.row_mut(row);
                row += coefficients.row(j) * share;
            }
        }
        Self { low, high, exponents, coefficients: own, kinks: vec![], harmonics: vec![] }
    }

    /// Returns the map with changes of slope beside its polynomials.
    ///
    /// # Panics
    /// If a kink has another number of outputs than the map, or an actuator that the map does not have.
    #[must_use]
    pub fn with_kinks(self, kinks: Vec<Kink>) -> Self {
        let fits = |kink: &Kink| kink.slopes.len() == self.coefficients.ncols() && kink.actuator < self.low.len();
        assert!(kinks.iter().all(fits), "a slope for each output, and an actuator of the map");
        Self { kinks, ..self }
    }

    /// Returns the map with terms of angles beside its polynomials.
    ///
    /// # Panics
    /// If a term has another number of outputs or of actuators than the map.
    #[must_use]
    pub fn with_harmonics(self, harmonics: Vec<Harmonic>) -> Self {
        let width = self.coefficients.ncols();
        let fits = |term: &Harmonic| {
            term.cosine.len() == width && term.sine.len() == width && term.multiples.len() == self.low.len()
        };
        assert!(harmonics.iter().all(fits), "sizes for each output, and a multiple of each actuator");
        Self { harmonics, ..self }
    }

    /// Returns whether a map that was read suits a rig of so many actuators and outputs.
    ///
    /// # Errors
    /// What does not fit, in words.
    pub fn suits(&self, actuators: usize, outputs: usize) -> Result<(), String> {
        let Self { low, high, exponents, coefficients, kinks, harmonics } = self;
        let same = |what: &str, found: usize, needed: usize| match found == needed {
            true => Ok(()),
            false => Err(format!("the static map has {found} {what} where the rig needs {needed}")),
        };
        same("lower ends of ranges", low.len(), actuators)?;
        same("upper ends of ranges", high.len(), actuators)?;
        same("columns of coefficients", coefficients.ncols(), outputs)?;
        same("rows of coefficients", coefficients.nrows(), exponents.len())?;
        for n in exponents {
            same("exponents of a term", n.len(), actuators)?;
            if n.iter().any(|n| *n > LARGEST_DEGREE) {
                return Err(format!(
                    "the static map has the exponents {n:?}, and the largest degree is {LARGEST_DEGREE}"
                ));
            }
        }
        for kink in kinks {
            same("slopes of a kink", kink.slopes.len(), outputs)?;
            if kink.actuator >= actuators {
                return Err(format!("a kink of the static map is of actuator {}, of {actuators}", kink.actuator));
            }
        }
        for term in harmonics {
            same("multiples of a harmonic", term.multiples.len(), actuators)?;
            same("cosines of a harmonic", term.cosine.len(), outputs)?;
            same("sines of a harmonic", term.sine.len(), outputs)?;
        }
        Ok(())
    }

    /// Returns the changes of slope.
    pub fn kinks(&self) -> &[Kink] {
        &self.kinks
    }

    /// Returns the terms of angles.
    pub fn harmonics(&self) -> &[Harmonic] {
        &self.harmonics
    }

    /// Range of each actuator, SI: smallest values, largest values.
    pub fn range(&self) -> [&[f64]; 2] {
        [&self.low, &self.high]
    }

    /// Degree n_ja of the Chebyshev polynomial of each actuator, one list for each of the J terms.
    pub fn exponents(&self) -> &[Vec<usize>] {
        &self.exponents
    }

    /// Coefficients b, J × M.
    pub fn coefficients(&self) -> &DMatrix<f64> {
        &self.coefficients
    }

    /// Adds m(q) to `out` `[M]`.
    pub fn add(&self, q: &[f64], out: &mut [f64]) {
        self.add_with(q, &mut self.scratch(), out);
    }

    /// Memory for [`StaticMap::add_with`].
    pub fn scratch(&self) -> MapScratch {
        MapScratch(Vec::with_capacity(self.low.len()))
    }

    /// Adds the map at `q` to `out`, with scratch memory that is reused from sample to sample.
    pub fn add_with(&self, q: &[f64], scratch: &mut MapScratch, out: &mut [f64]) {
        let MapScratch(axes) = scratch;
        axes.clear();
        axes.extend((0..q.len()).map(|a| AxisValues::new(self.low[a], self.high[a], q[a])));
        for (j, n) in self.exponents.iter().enumerate() {
            let basis: f64 = n.iter().zip(&*axes).map(|(&n, axis)| axis.value[n]).product();
            out.iter_mut().enumerate().for_each(|(o, out)| *out += self.coefficients[(j, o)] * basis);
        }
        for kink in &self.kinks {
            let beyond = kink.beyond(q);
            out.iter_mut().zip(&kink.slopes).for_each(|(out, slope)| *out += slope * beyond);
        }
        self.harmonics.iter().for_each(|term| term.add(q, out));
    }

    /// Adds ∂m/∂q to `slopes` [M×A].
    pub fn add_slopes(&self, q: &[f64], slopes: &mut [f64]) {
        let axes = self.axes(q);
        let width = q.len();
        for (j, n) in self.exponents.iter().enumerate() {
            for a in (0..width).filter(|&a| n[a] > 0 && axes[a].inside) {
                let others = (0..width).filter(|&b| b != a).map(|b| axes[b].value[n[b]]).product::<f64>();
                let slope = axes[a].slope[n[a]] * others;
                (0..self.coefficients.ncols()).for_each(|o| slopes[o * width + a] += self.coefficients[(j, o)] * slope);
            }
        }
        for kink in self.kinks.iter().filter(|kink| kink.beyond(q) > 0.0) {
            kink.slopes.iter().enumerate().for_each(|(o, slope)| slopes[o * width + kink.actuator] += slope);
        }
        self.harmonics.iter().for_each(|term| term.add_slopes(q, slopes));
    }

    fn axes(&self, q: &[f64]) -> Vec<AxisValues> {
        let of = |a: usize| AxisValues::new(self.low[a], self.high[a], q[a]);
        (0..q.len()).map(of).collect()
    }

    /// Total degree.
    pub fn degree(&self) -> usize {
        self.exponents.iter().map(|n| n.iter().sum()).max().unwrap_or(0)
    }
}

/// Coefficient of T_n in z^power: 2^{1−power} C(power, (power − n)/2), half of it for n = 0.
fn in_chebyshev(power: usize, n: usize) -> f64 {
    if n > power || (power - n) % 2 == 1 {
        return 0.0;
    }
    let k = (power - n) / 2;
    let binomial = (0..k).fold(1.0, |c, i| c * (power - i) as f64 / (i + 1) as f64);
    binomial * 2f64.powi(1 - power as i32) * if n == 0 { 0.5 } else { 1.0 }
}

/// T_0 … T_9 of one actuator, and their slopes with it.
#[derive(Debug, Clone)]
struct AxisValues {
    value: [f64; LARGEST_DEGREE + 1],
    slope: [f64; LARGEST_DEGREE + 1],
    /// Whether the actuator is within its range.
    inside: bool,
}

impl AxisValues {
    /// T_{n+1} = 2 z T_n − T_{n−1}, and T_n' = n U_{n−1} with U alike.
    fn new(low: f64, high: f64, q: f64) -> Self {
        let z = position(low, high, q);
        let per_unit = if high > low { 2.0 / (high - low) } else { 0.0 };
        let (mut value, mut slope) = ([1.0; LARGEST_DEGREE + 1], [0.0; LARGEST_DEGREE + 1]);
        let mut second_kind = [1.0; LARGEST_DEGREE + 1];
        value[1] = z;
        second_kind[1] = 2.0 * z;
        slope[1] = per_unit;
        for n in 2..=LARGEST_DEGREE {
            value[n] = 2.0 * z * value[n - 1] - value[n - 2];
            second_kind[n] = 2.0 * z * second_kind[n - 1] - second_kind[n - 2];
            slope[n] = n as f64 * second_kind[n - 1] * per_unit;
        }
        Self { value, slope, inside: z.abs() < 1.0 && high > low }
    }
}

/// All exponents whose sum is at most `degree`.
fn exponents(width: usize, degree: usize) -> Vec<Vec<usize>> {
    if width == 0 {
        return vec![vec![]];
    }
    let with =
        |first: usize| exponents(width - 1, degree - first).into_iter().map(move |rest| [vec![first], rest].concat());
    (0..=degree).flat_map(with).collect()
}

fn position(low: f64, high: f64, q: f64) -> f64 {
    if high > low { ((2.0 * q - high - low) / (high - low)).clamp(-1.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: powers multiplied out, within the range.
    #[test]
    fn powers_are_the_same_in_chebyshev_polynomials() {
        let powers = [vec![0, 0], vec![1, 2], vec![4, 0], vec![3, 3], vec![0, 5]];
        let c = DMatrix::from_fn(5, 2, |j, o| 0.3 * (j as f64 + 1.0) - 0.7 * o as f64);
        let map = StaticMap::from_powers(vec![-1.0, 2.0], vec![3.0, 6.0], &powers, &c);
        for (a, b) in [(-0.5, 2.2), (1.0, 4.0), (2.9, 5.5)] {
            let z: [f64; 2] = [(a - 1.0) / 2.0, (b - 4.0) / 2.0];
            let mut out = [0.0; 2];
            map.add(&[a, b], &mut out);
            for o in 0..2 {
                let sum: f64 = powers
                    .iter()
                    .enumerate()
                    .map(|(j, n)| c[(j, o)] * z[0].powi(n[0] as i32) * z[1].powi(n[1] as i32))
                    .sum();
                assert!((out[o] - sum).abs() < 1e-12);
            }
        }
    }

    /// Oracle: |q₁ − 2| + 1, which is 3 − q₁ + 2 max(0, q₁ − 2), far beyond the range too.
    #[test]
    fn a_kink_changes_the_slope_of_one_actuator() {
        let c = DMatrix::from_row_slice(2, 1, &[1.0, -2.0]);
        let map = StaticMap::from_powers(vec![-1.0, 0.0], vec![1.0, 4.0], &[vec![0, 0], vec![0, 1]], &c)
            .with_kinks(vec![Kink { actuator: 1, at: 2.0, slopes: vec![2.0] }]);
        for (q, value, slope) in [(0.5, 2.5, -1.0), (2.0, 1.0, -1.0), (3.5, 2.5, 1.0)] {
            let (mut out, mut slopes) = ([0.0], [0.0; 2]);
            map.add(&[0.3, q], &mut out);
            map.add_slopes(&[0.3, q], &mut slopes);
            assert!((out[0] - value).abs() < 1e-12 && (slopes[1] - slope).abs() < 1e-12 && slopes[0] == 0.0, "{q}");
        }
        let mut out = [0.0];
        map.add(&[0.3, 10.0], &mut out);
        assert!((out[0] - (-1.0 + 2.0 * 8.0)).abs() < 1e-12, "{out:?}");
    }

    #[test]
    fn a_map_of_another_rig_does_not_suit() {
        let c = DMatrix::zeros(2, 3);
        let map = StaticMap::from_powers(vec![0.0; 2], vec![1.0; 2], &[vec![0, 0], vec![1, 0]], &c);
        assert_eq!(map.suits(2, 3), Ok(()));
        assert!(map.suits(1, 3).is_err() && map.suits(2, 1).is_err());
        let kink = |actuator, outputs| Kink { actuator, at: 0.5, slopes: vec![0.0; outputs] };
        for (kink, told) in [(kink(2, 3), "of actuator 2, of 2"), (kink(1, 1), "1 slopes of a kink")] {
            let bent = StaticMap { kinks: vec![kink], ..map.clone() };
            assert!(bent.suits(2, 3).unwrap_err().contains(told));
        }
        let term = Harmonic { multiples: vec![1], cosine: vec![0.0; 3], sine: vec![0.0; 3] };
        let turning = StaticMap { harmonics: vec![term], ..map.clone() };
        assert!(turning.suits(2, 3).unwrap_err().contains("1 multiples of a harmonic"));
        let steep = StaticMap { exponents: vec![vec![0, 0], vec![10, 0], vec![0, 1]], ..map };
        assert!(steep.suits(2, 3).is_err());
    }

    /// Oracle: z₁ z₂² by hand, with z₁ = q₁ − 1 and z₂ = q₂/2: its slopes, and its value at the border beyond it.
    #[test]
    fn a_map_keeps_its_value_at_the_border() {
        let (low, high) = (vec![0.0, -2.0], vec![2.0, 2.0]);
        let map = StaticMap::from_powers(low, high, &[vec![1, 2]], &DMatrix::from_element(1, 1, 1.0));
        let of = |q: [f64; 2]| {
            let (mut out, mut slopes) = ([0.0], [0.0; 2]);
            map.add(&q, &mut out);
            map.add_slopes(&q, &mut slopes);
            [out[0], slopes[0], slopes[1]]
        };
        for (found, wanted) in of([1.5, 1.0]).into_iter().zip([0.125, 0.25, 0.25]) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
        assert_eq!(of([7.0, 1.0]), [0.25, 0.0, 0.5]);
    }
}
