//! Conformal half-widths, with trials, values or blocks of time as exchangeable units.
//!
//! ```text
//! F_j(w)    = share of unit j with |e| ≤ w
//! w(β, J)   = min { w : mean over j in J of F_j(w) ≥ β }
//! c(β)      = mean over j of F_j(w(β, all but j))
//! level     = min(wanted, k / (k + 1))
//! β*        = min { β : c(β) ≥ level }          half-width = w(β*, all)
//! ```
//!
//! | symbol | meaning                                                      | unit |
//! | ------ | ------------------------------------------------------------ | ---- |
//! | `e`    | error of a model that did not learn from the sample's unit   | SI   |
//! | `k`    | units                                                        | –    |
//! | `w`    | half-width of the interval about a prediction                | SI   |
//! | `c`    | coverage of units left out in turn                           | –    |
//!
//! Units weigh alike, however many samples they have. Samples of one unit are not independent, so that k units attain no
//! level beyond k / (k + 1), as with k exchangeable scores. Pooled distributions of groups: Dunn, Wasserman, Ramdas,
//! *Distribution-free prediction sets for two-layer hierarchical models*, JASA 2022. Errors of units left out: Barber,
//! Candès, Ramdas, Tibshirani, *Predictive inference with the jackknife+*, Annals of Statistics 2021. β* in the place of
//! their level takes the loss of coverage that few units have, as measured on the units themselves.

/// Number of steps of the search for β: finer than any coverage that is printed.
const STEPS: usize = 1000;

/// The half-width of one output's interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfWidth {
    /// Half-width about the prediction, in the unit of the errors.
    pub half_width: f64,
    /// Coverage of units left out in turn, each by the half-width of the others.
    pub left_out: f64,
}

/// Returns the level of an interval that is to cover the share `wanted`, with so many units.
pub fn attainable(wanted: f64, units: usize) -> f64 {
    wanted.min(units as f64 / (units as f64 + 1.0))
}

/// Returns the half-width at `level` from the absolute errors of each unit; none with fewer than two units, or an empty
/// one.
pub fn half_width(units: &[Vec<f64>], level: f64) -> Option<HalfWidth> {
    if units.len() < 2 || units.iter().any(Vec::is_empty) {
        return None;
    }
    let sorted: Vec<Vec<f64>> = units.iter().map(|unit| ascending(unit.clone())).collect();
    let others: Vec<Pool> = (0..sorted.len()).map(|j| Pool::of(&sorted, Some(j))).collect();
    let coverage = |step: usize| {
        let beta = step as f64 / STEPS as f64;
        let covered = sorted.iter().zip(&others).map(|(unit, others)| share(unit, others.quantile(beta)));
        covered.sum::<f64>() / sorted.len() as f64
    };
    // Coverage rises with β: the first step that reaches the level, else the last.
    let enough = |step: usize| coverage(step) >= level - f64::EPSILON * STEPS as f64;
    let (mut low, mut high) = (0, STEPS);
    while low < high {
        let middle = usize::midpoint(low, high);
        if enough(middle) { high = middle } else { low = middle + 1 }
    }
    let half_width = Pool::of(&sorted, None).quantile(high as f64 / STEPS as f64);
    Some(HalfWidth { half_width, left_out: coverage(high) })
}

/// Returns the share of ascending values that are at most `limit`.
pub fn share(ascending: &[f64], limit: f64) -> f64 {
    ascending.partition_point(|value| *value <= limit) as f64 / ascending.len() as f64
}

/// Values of several units, ascending, each with the weight of all up to it; units weigh alike.
struct Pool(Vec<(f64, f64)>);

impl Pool {
    fn of(units: &[Vec<f64>], without: Option<usize>) -> Self {
        let taken: Vec<&Vec<f64>> =
            units.iter().enumerate().filter(|(j, _)| Some(*j) != without).map(|u| u.1).collect();
        let weighted = |unit: &&Vec<f64>| {
            let weight = 1.0 / (taken.len() * unit.len()) as f64;
            unit.iter().map(move |value| (*value, weight)).collect::<Vec<_>>()
        };
        let mut values: Vec<(f64, f64)> = taken.iter().flat_map(weighted).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        values.iter_mut().for_each(|(_, weight)| {
            sum += *weight;
            *weight = sum;
        });
        Self(values)
    }

    /// Returns the smallest value with at least the weight β at or below it.
    fn quantile(&self, beta: f64) -> f64 {
        let place = self.0.partition_point(|(_, weight)| *weight < beta - 1e-9);
        self.0[place.min(self.0.len() - 1)].0
    }
}

fn ascending(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Nine units of one error each, 1 to 9: 90 % asks for all of them, and the largest, left out, is
    /// missed by the width of the others.
    #[test]
    fn nine_single_errors_attain_eight_ninths_when_left_out() {
        let units: Vec<Vec<f64>> = (1..=9).map(|e| vec![f64::from(e)]).collect();
        let found = half_width(&units, attainable(0.9, 9)).unwrap();
        assert_eq!((found.half_width, found.left_out), (9.0, 8.0 / 9.0));
        assert_eq!(half_width(&units, 0.5).unwrap().half_width, 5.0);
    }

    #[test]
    fn few_units_attain_less() {
        assert_eq!([attainable(0.9, 3), attainable(0.9, 9), attainable(0.9, 40)], [0.75, 0.9, 0.9]);
        assert_eq!(half_width(&[vec![1.0]], 0.9), None);
        assert_eq!(half_width(&[vec![1.0], vec![]], 0.9), None);
    }

    /// A unit of a thousand samples weighs as much as one of ten.
    #[test]
    fn units_weigh_alike() {
        let units = [vec![1.0; 1000], vec![3.0; 10], vec![3.0; 10], vec![3.0; 10]];
        let found = half_width(&units, 0.7).unwrap();
        assert_eq!((found.half_width, found.left_out), (3.0, 1.0));
    }

    /// Errors of a unit share a scale, drawn again for the next: widths of 20 units hold 90 % of further units, from 85 to
    /// 95 %, over 200 redraws. With samples for units, as if they were independent, they would hold less.
    #[test]
    fn further_units_are_covered_at_the_level() {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut unit = || {
            let scale = 0.3 + 2.7 * uniform() * uniform();
            (0..60).map(|_| scale * uniform()).collect::<Vec<f64>>()
        };
        let covered = |_| {
            let units: Vec<Vec<f64>> = (0..20).map(|_| unit()).collect();
            let width = half_width(&units, attainable(0.9, 20)).unwrap().half_width;
            (0..10).map(|_| share(&ascending(unit()), width)).sum::<f64>() / 10.0
        };
        let mean = (0..200).map(covered).sum::<f64>() / 200.0;
        assert!((0.88..0.93).contains(&mean), "{mean}");
    }
}
