//! The contract of effects: walks [`ALL`], in every way that each can act, on rigs of several kinds.

mod book;
mod by_hand;
mod own;
mod piece_by_piece;
mod recovery;
mod rigs;

use std::collections::BTreeSet;

use acm_core::effects::{ALL, ParameterSpec, Site, Values, find};
use acm_core::record::Record;
use acm_core::rig::Rig;
use rigs::{Case, all, cases};

/// Names that other programs read.
const PROMISED: [&str; 57] = [
    "dead_time",
    "actuator_lag",
    "backlash",
    "prandtl_ishlinskii",
    "bouc_wen",
    "tendon_friction",
    "creep",
    "static_gain",
    "gain_drift",
    "zero_drift",
    "encoder_periodic",
    "coupling",
    "saturation",
    "tip_load",
    "self_weight",
    "downwash",
    "wake_lag",
    "ground_effect",
    "side_wind",
    "base_tilt",
    "marker_offset",
    "misregistration",
    "scale",
    "measurement_lag",
    "measurement_drift",
    "coulomb_friction",
    "dahl_friction",
    "viscous_friction",
    "context_term",
    "context_gain",
    "context_lag",
    "input_disturbance",
    "input_gain",
    "second_order_lag",
    "rate_limit",
    "dead_zone",
    "dry_friction",
    "viscous_slip",
    "output_hysteresis",
    "inertia",
    "stribeck_friction",
    "joint_gravity",
    "measurement_delay",
    "measurement_second_order",
    "nonlinear_stiffness",
    "coulomb_damping",
    "state_dependent_lag",
    "outflow",
    "overflow",
    "friction_lag",
    "input_nonlinearity",
    "lugre_friction",
    "asymmetric_lag",
    "output_bouc_wen",
    "output_prandtl_ishlinskii",
    "measurement_creep",
    "vibration_mode",
];

/// How many samples ahead an effect may see: a rate is the slope of a line through two on either side, or of a parabola
/// through a window of 4 steps at least. Samples of the scenes are at least 0.6 steps apart.
fn looks_ahead(case: &Case, values: &[f64]) -> usize {
    let window = case.specs.iter().position(|spec| spec.name == "window");
    match window {
        Some(window) => 6.max((values[window] / (0.6 * case.scene.rig.step)).ceil() as usize),
        None if case.effect.name() == "viscous_slip" => 2,
        None => 0,
    }
}

/// Effects whose equations have no closed solution between two samples.
const APPROXIMATE: [&str; 6] =
    ["nonlinear_stiffness", "coulomb_damping", "state_dependent_lag", "outflow", "overflow", "output_bouc_wen"];

fn largest(columns: &[Vec<f64>]) -> f64 {
    columns.iter().flatten().fold(0.0, |most, x| x.abs().max(most))
}

/// Largest difference, over the largest value of its column.
fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let of = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let whole = largest(std::slice::from_ref(b)).max(f64::MIN_POSITIVE);
        a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs() / whole))
    };
    a.iter().zip(b).map(of).fold(0.0, f64::max)
}

/// Columns, record and time as `change` leaves each signal.
fn changed(record: &Record, time: Vec<f64>, change: impl Fn(&[f64]) -> Vec<f64>) -> Record {
    let each = |columns: &[Vec<f64>]| columns.iter().map(|column| change(column)).collect();
    Record::new(time, each(&record.actuators), each(&record.contexts), each(&record.acceleration))
}

#[test]
fn names_are_stable_and_explained() {
    let names: BTreeSet<&str> = ALL.iter().map(|effect| effect.name()).collect();
    assert_eq!(names.len(), ALL.len(), "two effects share a name");
    for name in PROMISED {
        assert!(find(name).is_some(), "{name} is missing");
    }
    for effect in ALL {
        assert!(effect.name().chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{}", effect.name());
        assert!(effect.meaning().len() > 10 && effect.source().len() > 10, "{}", effect.name());
    }
}

#[test]
fn they_act_place_by_place() {
    let sites: Vec<Site> = ALL.iter().map(|effect| effect.site()).collect();
    assert!(sites.is_sorted(), "{sites:?}");
}

/// Each effect can act on one of the rigs at least, and none on a rig without signals.
#[test]
fn each_finds_a_rig() {
    let scenes = all();
    let acting: BTreeSet<&str> = cases(&scenes).iter().map(|case| case.effect.name()).collect();
    let idle: Vec<&str> = ALL.iter().map(|effect| effect.name()).filter(|name| !acting.contains(name)).collect();
    assert!(idle.is_empty(), "{idle:?} act nowhere");
    let rig = Rig { actuators: vec![], contexts: vec![], outputs: vec![], throttle: None, ..rigs::passive().rig };
    for effect in ALL {
        assert!(effect.carriers(&rig).is_empty(), "{} acts on nothing", effect.name());
    }
}

#[test]
fn parameters_are_sound() {
    for case in cases(&all()) {
        let label = case.label();
        let names: BTreeSet<&String> = case.specs.iter().map(|spec| &spec.name).collect();
        assert!(!names.is_empty() && names.len() == case.specs.len(), "{label}: {names:?}");
        for spec in &case.specs {
            assert!(!spec.name.is_empty() && !spec.unit.is_empty(), "{label}: {spec:?}");
            assert!(spec.scale > 0.0 && spec.scale.is_finite() && spec.neutral.is_finite(), "{label}: {spec:?}");
            assert!(spec.lower <= spec.neutral && spec.neutral <= spec.upper, "{label}: {spec:?}");
        }
        assert!(case.specs.iter().any(ParameterSpec::is_free), "{label}: nothing to fit");
        assert!(case.specs.iter().any(|spec| spec.may_vary), "{label}: no size");
    }
}

#[test]
fn starts_are_inside_and_not_neutral() {
    for case in cases(&all()) {
        let label = case.label();
        assert!(!case.starts.is_empty(), "{label}: no start");
        for start in &case.starts {
            assert_eq!(start.len(), case.specs.len(), "{label}");
            for (value, spec) in start.iter().zip(&case.specs) {
                let inside = value.is_finite() && spec.lower <= *value && *value <= spec.upper;
                assert!(inside, "{label}: {value} for {spec:?}");
            }
            let moved = start.iter().zip(&case.specs).any(|(value, spec)| spec.may_vary && *value != spec.neutral);
            assert!(moved, "{label}: starts neutral");
        }
    }
}

/// Effects on the outputs that add in proportion to their sizes.
const LINEAR: [&str; 14] = [
    "vibration_mode",
    "output_prandtl_ishlinskii",
    "output_bouc_wen",
    "output_hysteresis",
    "coulomb_friction",
    "dahl_friction",
    "lugre_friction",
    "stribeck_friction",
    "viscous_friction",
    "inertia",
    "joint_gravity",
    "context_term",
    "context_lag",
    "measurement_drift",
];

/// Effects on the outputs that filter each of them.
const FILTERS: [&str; 5] =
    ["context_gain", "measurement_second_order", "measurement_lag", "measurement_creep", "measurement_delay"];

/// Oracle: what a filter does to a sum it does to each: act(a + 2b) = act(a) + 2 act(b), with one value for all outputs.
#[test]
fn output_filters_act_on_each_of_a_sum() {
    let mut filters = BTreeSet::new();
    for case in cases(&all()).iter().filter(|case| case.effect.traits().is_output_filter) {
        filters.insert(case.effect.name());
        assert_eq!(case.effect.site(), Site::Output);
        let (a, b) = (case.columns(), case.columns().into_iter().map(|y| y.iter().map(|y| y * y - 0.2).collect()));
        let b: Vec<Vec<f64>> = b.collect();
        let sum = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Vec<Vec<f64>> {
            a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + 2.0 * b).collect()).collect()
        };
        for start in &case.starts {
            let act = |columns: Vec<Vec<f64>>| case.act_on(start, &case.scene.record, columns);
            let off = difference(&act(sum(&a, &b)), &sum(&act(a.clone()), &act(b.clone())));
            assert!(off < 1e-12, "{}: {off:.1e} at {start:?}", case.label());
        }
    }
    assert_eq!(filters, BTreeSet::from(FILTERS));
}

/// Initial guesses stay few enough to try them all, and times of the record bound every time.
#[test]
fn guesses_are_few_and_times_within_the_record() {
    for case in cases(&all()) {
        assert!(case.starts.len() <= 150, "{}: {} guesses", case.label(), case.starts.len());
        let trial = case.scene.rig.duration * (1.0 + 1e-12);
        // Creep may last as long as a trial, and a period that damping may end: two lags of a time constant in a row have 2π of it.
        let is_damped = case.effect.name() != "vibration_mode";
        for spec in case.specs.iter().filter(|spec| spec.unit == "s") {
            let is_long = case.effect.name().ends_with("creep") || is_damped && spec.name == "period";
            let longest = if is_long { trial } else { trial / 3.0 };
            assert!(spec.upper <= longest && spec.scale <= trial / 3.0, "{}: {spec:?}", case.label());
        }
    }
}

/// Oracle: what adds in proportion, and whatever it is added to: act(2θ) − act(θ) = act(θ) − act(0), on any columns.
#[test]
fn linear_parameters_add_in_proportion() {
    let mut linear = BTreeSet::new();
    for case in cases(&all()).iter().filter(|case| case.specs.iter().any(|spec| spec.linear)) {
        linear.insert(case.effect.name());
        assert!(case.specs.iter().all(|spec| !spec.linear || spec.neutral == 0.0), "{}", case.label());
        let other: Vec<Vec<f64>> =
            case.columns().iter().map(|column| column.iter().map(|y| 0.3 - 1.7 * y * y).collect()).collect();
        for start in &case.starts {
            let at = |times: f64, columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
                let of = |(value, spec): (&f64, &ParameterSpec)| if spec.linear { times * value } else { *value };
                let theta: Vec<f64> = start.iter().zip(&case.specs).map(of).collect();
                case.act_on(&theta, &case.scene.record, columns.to_vec())
            };
            let minus = |a: Vec<Vec<f64>>, b: Vec<Vec<f64>>| -> Vec<f64> {
                a.into_iter().flatten().zip(b.into_iter().flatten()).map(|(a, b)| a - b).collect()
            };
            let columns = case.columns();
            let first = minus(at(1.0, &columns), at(0.0, &columns));
            let size = first.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            assert!(size > 0.0, "{} is not heard at {start:?}", case.label());
            for second in [minus(at(2.0, &columns), at(1.0, &columns)), minus(at(1.0, &other), at(0.0, &other))] {
                let off = first.iter().zip(&second).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                assert!(off < 1e-9 * size.max(largest(&columns)), "{}: {off:.1e} at {start:?}", case.label());
            }
        }
    }
    assert_eq!(linear, BTreeSet::from(LINEAR));
}

#[test]
fn silent_at_neutral_and_heard_at_a_start() {
    for case in cases(&all()) {
        let (label, before) = (case.label(), case.columns());
        let left = difference(&case.act(&case.neutral()), &before);
        assert!(left < 1e-12, "{label}: {left:.1e} at its neutral values");
        let beyond: Vec<Vec<f64>> = before.iter().map(|column| column.iter().map(|x| 1.5 * x).collect()).collect();
        let left = difference(&case.act_on(&case.neutral(), &case.scene.record, beyond.clone()), &beyond);
        assert!(left < 1e-12, "{label}: {left:.1e} at its neutral values, beyond the recorded range");
        let heard = case.starts.iter().any(|start| case.act(start) != before);
        assert!(heard, "{label}: no start does anything");
    }
}

/// Shapes alone change nothing: the sizes decide whether an effect is there.
#[test]
fn silent_at_neutral_sizes_whatever_the_shapes() {
    for case in cases(&all()) {
        for start in &case.starts {
            let of = |(value, spec): (&f64, &ParameterSpec)| {
                if spec.may_vary { spec.neutral } else { *value }
            };
            let theta: Vec<f64> = start.iter().zip(&case.specs).map(of).collect();
            assert!(difference(&case.act(&theta), &case.columns()) < 1e-12, "{}", case.label());
        }
    }
}

/// What comes later changes nothing before, but for the few samples that a rate of change looks ahead.
#[test]
fn causal() {
    for case in cases(&all()) {
        let record = &case.scene.record;
        let now = record.samples() / 2;
        let later = |column: &[f64]| -> Vec<f64> {
            let change = |(t, x): (usize, &f64)| if t > now { 1.3 * x + 0.1 * column[0] } else { *x };
            column.iter().enumerate().map(change).collect()
        };
        let other = changed(record, record.time.clone(), later);
        let columns: Vec<Vec<f64>> = case.columns().iter().map(|column| later(column)).collect();
        for start in &case.starts {
            let Some(seen) = now.checked_sub(looks_ahead(&case, start)) else { continue };
            let until = |columns: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
                columns.into_iter().map(|column| column[..=seen].to_vec()).collect()
            };
            let (a, b) = (case.act(start), case.act_on(start, &other, columns.clone()));
            assert!(until(a) == until(b), "{} sees the future at {start:?}", case.label());
        }
    }
}

#[test]
fn finite_within_its_bounds() {
    for case in cases(&all()) {
        let end = |bound: fn(&ParameterSpec) -> f64, sign: f64| -> Vec<f64> {
            let of = |spec| if bound(spec).is_finite() { bound(spec) } else { spec.neutral + sign * 10.0 * spec.scale };
            case.specs.iter().map(of).collect()
        };
        for theta in case.starts.iter().chain([&end(|spec| spec.lower, -1.0), &end(|spec| spec.upper, 1.0)]) {
            assert!(case.act(theta).iter().flatten().all(|x| x.is_finite()), "{} at {theta:?}", case.label());
            let lasting = case.effect.memory(Values::constant(&case.specs, theta));
            assert!(lasting.is_none_or(|time| time.is_finite() && time >= 0.0), "{}: {lasting:?}", case.label());
        }
    }
}

/// Oracle: signals are straight between samples, so that one more sample on the line changes nothing at the others.
#[test]
fn exact_on_irregular_time_stamps() {
    fn finer(column: &[f64]) -> Vec<f64> {
        let between = column.windows(2).flat_map(|pair| [pair[0], pair[0] + 0.3 * (pair[1] - pair[0])]);
        between.chain(column.last().copied()).collect()
    }
    let exact = |case: &&Case| looks_ahead(case, &case.neutral()) == 0 && !APPROXIMATE.contains(&case.effect.name());
    for case in cases(&all()).iter().filter(exact) {
        let record = &case.scene.record;
        let fine = changed(record, finer(&record.time), finer);
        let columns: Vec<Vec<f64>> = case.columns().iter().map(|column| finer(column)).collect();
        for start in &case.starts {
            let dense = case.act_on(start, &fine, columns.clone());
            let same: Vec<Vec<f64>> = dense.iter().map(|column| column.iter().step_by(2).copied().collect()).collect();
            let off = difference(&same, &case.act(start));
            assert!(off < 1e-9, "{}: {off:.1e} at {start:?}", case.label());
        }
    }
}

/// Oracle: a parameter that depends on a context that rests is a constant.
#[test]
fn parameters_follow_a_context() {
    for case in cases(&all()) {
        let Some(start) = case.starts.first() else { continue };
        let slope = |spec: &ParameterSpec| if spec.may_vary { 0.2 * spec.scale } else { 0.0 };
        let slopes: Vec<f64> = case.specs.iter().map(slope).collect();
        let at = |context: f64| {
            let mut columns = case.columns();
            let context = vec![context; case.scene.record.samples()];
            let values = Values::varying(&case.specs, start, &slopes, &context);
            case.effect.act(case.carrier, values, &case.scene.record, &mut columns);
            columns
        };
        let moved = |context: f64| -> Vec<f64> {
            let theta = start.iter().zip(&slopes).map(|(value, slope)| value + slope * context);
            let bounded = |(value, spec): (f64, &ParameterSpec)| {
                if spec.linear { value } else { value.clamp(spec.lower, spec.upper) }
            };
            theta.zip(&case.specs).map(bounded).collect()
        };
        for context in [0.0, 1.0, -0.5, 1e6] {
            assert!(at(context) == case.act(&moved(context)), "{} at {context}", case.label());
        }
    }
}

/// Oracle: a context in a small unit, with values far beyond the bounds of a size: θ1 alone adds c times what θ0 alone adds.
#[test]
fn linear_parameters_are_proportional_to_a_context_in_any_unit() {
    for case in cases(&all()).iter().filter(|case| case.specs.iter().any(|spec| spec.linear)) {
        let samples = case.scene.record.samples();
        let context: Vec<f64> = (0..samples).map(|t| 1e5 * (1.0 + 0.01 * t as f64)).collect();
        for start in &case.starts {
            let of = |linear: f64| -> Vec<f64> {
                start.iter().zip(&case.specs).map(|(value, spec)| if spec.linear { linear } else { *value }).collect()
            };
            let ones: Vec<f64> = case.specs.iter().map(|spec| f64::from(u8::from(spec.linear))).collect();
            let silent = case.act(&of(0.0));
            let constant = case.act(&of(1.0));
            let (mut varying, base) = (case.columns(), of(0.0));
            let values = Values::varying(&case.specs, &base, &ones, &context);
            case.effect.act(case.carrier, values, &case.scene.record, &mut varying);
            for ((varying, constant), silent) in varying.iter().zip(&constant).zip(&silent) {
                for (t, context) in context.iter().enumerate() {
                    let (got, wanted) = (varying[t] - silent[t], context * (constant[t] - silent[t]));
                    assert!((got - wanted).abs() <= 1e-9 * context * (1.0 + constant[t].abs()), "{}", case.label());
                }
            }
        }
    }
}

/// Oracle: a size that changes half-way leaves the first half as it was, and is heard in the second.
#[test]
fn parameters_vary_within_a_trial() {
    for case in cases(&all()) {
        let samples = case.scene.record.samples();
        let half = samples / 2;
        let slopes: Vec<f64> = case.specs.iter().map(|spec| if spec.may_vary { spec.scale } else { 0.0 }).collect();
        let heard = case.starts.iter().any(|start| {
            let mut columns = case.columns();
            let context: Vec<f64> = (0..samples).map(|t| if t < half { 0.0 } else { 0.5 }).collect();
            let values = Values::varying(&case.specs, start, &slopes, &context);
            case.effect.act(case.carrier, values, &case.scene.record, &mut columns);
            let constant = case.act(start);
            let first = |columns: &[Vec<f64>]| columns.iter().map(|column| column[..half].to_vec()).collect::<Vec<_>>();
            assert!(first(&columns) == first(&constant), "{} changes too early", case.label());
            columns != constant
        });
        assert!(heard, "{} does not heed a context", case.label());
    }
}

/// Oracle: a rig that reports the same motion in other units has the same effects.
#[test]
fn units_of_actuators_do_not_matter() {
    let scenes = all();
    let scaled: Vec<_> = all()
        .into_iter()
        .map(|mut scene| {
            for q in &mut scene.rig.actuators {
                (q.low, q.high) = (q.low * 1024.0, q.high * 1024.0);
            }
            let times = |columns: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
                columns.iter().map(|column| column.iter().map(|x| x * 1024.0).collect()).collect()
            };
            scene.record.actuators = times(&scene.record.actuators);
            scene.record.actuator_rates = times(&scene.record.actuator_rates);
            scene
        })
        .collect();
    let actuation = |case: &Case| case.effect.site() == Site::Actuation;
    for (case, other) in cases(&scenes).iter().zip(&cases(&scaled)).filter(|(case, _)| actuation(case)) {
        for (start, same) in case.starts.iter().zip(&other.starts) {
            let expected: Vec<Vec<f64>> =
                case.act(start).iter().map(|column| column.iter().map(|x| x * 1024.0).collect()).collect();
            let off = difference(&other.act(same), &expected);
            assert!(off < 1e-9, "{}: {off:.1e}", case.label());
        }
    }
}

/// Nothing fails on a trial of one sample, or of none.
#[test]
fn short_of_samples() {
    for case in cases(&all()) {
        for samples in [0, 1] {
            let rows: Vec<usize> = (0..samples).collect();
            let record = case.scene.record.select(&rows);
            for start in &case.starts {
                let columns: Vec<Vec<f64>> = case.columns().iter().map(|column| column[..samples].to_vec()).collect();
                let after = case.act_on(start, &record, columns);
                assert!(after.iter().flatten().all(|x| x.is_finite()), "{} on {samples} samples", case.label());
            }
        }
    }
}
