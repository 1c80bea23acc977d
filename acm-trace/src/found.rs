//! Effects as they are reported: with values, intervals, and what explains as much.

use acm_core::effects::ParameterSpec;
use acm_core::effects::instance::{Instance, signal};
use nalgebra::{DMatrix, DVector};

use crate::equations::total;
use crate::evaluate::free;
use crate::finding::{FoundEffect, FoundParameter};
use crate::fit::Scored;
use crate::intervals::jackknife;
use crate::moving;
use crate::prepared::Prepared;
use crate::sentence;
use crate::trace::Traced;

/// How much in line with a parameter what is left may be.
const IN_LINE: f64 = 1.2;

/// The effects of the last model, in the order in which they were found; sizes times `scale`.
pub fn effects(prepared: &Prepared, traced: &Traced, last: &Scored, scale: f64) -> Vec<FoundEffect> {
    let rig = &prepared.case.rig;
    let one = |(i, instance): (usize, &Instance)| FoundEffect {
        name: instance.effect().name().into(),
        meaning: instance.effect().meaning().into(),
        site: instance.site(),
        carrier: sentence::carrier(instance, rig),
        parameters: parameters(prepared, traced, last, i),
        size: moving::size(&traced.setup, last, i) * scale,
        equivalent: traced.equivalent.get(i).cloned().unwrap_or_default(),
        in_calibration: (!prepared.calibration.is_empty()).then_some(traced.joined),
        source: instance.effect().source().into(),
    };
    let mut found: Vec<(usize, FoundEffect)> = last
        .fit
        .instances
        .iter()
        .enumerate()
        .map(one)
        .enumerate()
        .map(|(i, effect)| (traced.order[i], effect))
        .collect();
    // The first is the one that was found first: it explains most.
    found.sort_by_key(|(order, _)| *order);
    found.into_iter().map(|(_, effect)| effect).collect()
}

fn parameters(prepared: &Prepared, traced: &Traced, last: &Scored, i: usize) -> Vec<FoundParameter> {
    let (instance, theta) = (&last.fit.instances[i], &last.fit.theta[i]);
    let rig = &prepared.case.rig;
    let slack = slack(traced, last);
    let one = |(k, &(_, j)): (usize, &(usize, usize))| {
        let spec = &instance.parameters()[j];
        let without: Vec<f64> = last.jackknife.iter().map(|theta| theta[i][j]).collect();
        let depends_on = (j >= instance.own_parameters()).then(|| instance.context()).flatten();
        let interval = jackknife(theta[j], &without, slack[k]).map(|bound| spec.inside(bound));
        FoundParameter {
            name: spec.name.clone(),
            value: theta[j],
            unit: spec.unit.clone(),
            interval,
            undetermined: is_undetermined(spec, theta[j], interval),
            depends_on: depends_on.and_then(|c| signal(c, rig)).map(|signal| signal.name.clone()),
            at_bound: spec.is_at_bound(theta[j]),
        }
    };
    free(&last.fit.instances).iter().enumerate().filter(|(_, (effect, _))| *effect == i).map(one).collect()
}

/// Two orders of magnitude beyond a typical value, an interval says nothing of the size of the value.
const OPEN: f64 = 100.0;

/// Whether the interval has no end, holds all that the effect admits, or is far wider than a typical value.
fn is_undetermined(spec: &ParameterSpec, value: f64, [low, high]: [f64; 2]) -> bool {
    let reach = 0.5 * (high - low);
    let holds_all = spec.is_free() && low <= spec.lower && high >= spec.upper;
    holds_all || !(reach <= OPEN * spec.scale.max(value.abs()))
}

/// How far each free parameter could be led astray by what is left over the noise, were it wholly in line with what the
/// parameter does: `1.2 √(v − floor²) √(N (H⁻¹)_kk)`.
fn slack(traced: &Traced, last: &Scored) -> Vec<f64> {
    let excess = (last.mean_square() - traced.floor.powi(2)).max(0.0).sqrt();
    let samples: usize = last.fit.blocks.iter().map(|block| block.count).sum();
    let (normal, _) = total(&traced.setup, &last.fit.blocks, &last.fit.delta);
    let scale =
        DVector::from_iterator(normal.nrows(), normal.diagonal().iter().map(|d| 1.0 / d.max(f64::MIN_POSITIVE).sqrt()));
    let scaled = DMatrix::from_fn(normal.nrows(), normal.ncols(), |a, b| normal[(a, b)] * scale[a] * scale[b]);
    let ridge = DMatrix::from_diagonal_element(normal.nrows(), normal.nrows(), 1e-9);
    let Some(factor) = (scaled + ridge).cholesky() else { return vec![f64::INFINITY; last.fit.parameters()] };
    let inverse = factor.inverse();
    (0..last.fit.parameters())
        .map(|k| IN_LINE * excess * (samples as f64 * inverse[(k, k)]).sqrt() * scale[k])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_without_end_or_far_beyond_what_is_typical_leaves_the_value_open() {
        let free = |typical| ParameterSpec::size("a", "1", typical);
        assert!(is_undetermined(&free(1.0), 0.0, [-6.3e157, 6.3e157]));
        assert!(is_undetermined(&free(1.0), 2.0, [f64::NEG_INFINITY, f64::INFINITY]));
        assert!(is_undetermined(&free(1.0), 2.0, [f64::NAN, f64::NAN]));
        assert!(!is_undetermined(&free(1e-3), 1e-9, [-1e-4, 1e-4]));
        assert!(!is_undetermined(&free(1.0), 5e3, [4e3, 6e3]));
        assert!(is_undetermined(&free(1.0).within(0.0, 4.0), 2.0, [0.0, 4.0]));
        assert!(!is_undetermined(&free(1.0).within(0.0, 4.0), 2.0, [0.0, 3.9]));
    }
}
