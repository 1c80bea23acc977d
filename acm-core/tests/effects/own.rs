//! Effects of one's own: those of the example file are the library's, and keep its contract.

use acm_core::effects::instance::{Instance, Running};
use acm_core::effects::own::{Own, definition::Definition, read};
use acm_core::effects::{Carrier, Effect, Memory, ParameterSpec, Values, find};
use acm_core::record::Record;

use crate::difference;
use crate::rigs::{Scene, all, hovering};

const EXAMPLE: &str = include_str!("../../examples/my_effects.toml");

fn definitions() -> Vec<Definition> {
    read(EXAMPLE, "my_effects.toml").expect("definitions")
}

fn one(text: &str) -> Definition {
    read(text, "own.toml").unwrap_or_else(|error| panic!("{error}")).remove(0)
}

fn columns(scene: &Scene, effect: &dyn Effect) -> Vec<Vec<f64>> {
    match effect.site() {
        acm_core::effects::Site::Actuation => scene.record.actuators.clone(),
        _ => scene.outputs.clone(),
    }
}

/// Both at the same values; slopes by which sizes change with a context.
fn acted(effect: &dyn Effect, carrier: Carrier, scene: &Scene, theta: &[f64], slope: f64) -> Vec<Vec<f64>> {
    within(&effect.parameters(&scene.rig, carrier), effect, carrier, scene, theta, slope)
}

/// The same within the bounds of these parameters.
fn within(
    specs: &[ParameterSpec],
    effect: &dyn Effect,
    carrier: Carrier,
    scene: &Scene,
    theta: &[f64],
    slope: f64,
) -> Vec<Vec<f64>> {
    assert_eq!(specs.len(), theta.len(), "{}", effect.name());
    let mut columns = columns(scene, effect);
    let slopes: Vec<f64> = specs.iter().zip(theta).map(|(s, v)| if s.may_vary { slope * v } else { 0.0 }).collect();
    let context: Vec<f64> = (0..scene.record.samples()).map(|t| (0.07 * t as f64).sin()).collect();
    let values = match slope {
        0.0 => Values::constant(specs, theta),
        _ => Values::varying(specs, theta, &slopes, &context),
    };
    effect.act(carrier, values, &scene.record, &mut columns);
    columns
}

/// Oracle: the library, whose operators are written by hand, on all its own records: sizes at rest and with a context.
#[test]
fn the_example_is_the_library() {
    let definitions = definitions();
    let mut compared = [0; 3];
    for scene in all() {
        let own: Vec<_> =
            definitions.iter().map(|definition| Own::new(definition, &scene.rig).expect("an effect")).collect();
        for (which, name) in [(0, "backlash"), (2, "second_order_lag")] {
            let library = find(name).expect("an effect");
            for carrier in library.carriers(&scene.rig) {
                assert_eq!(own[which].carriers(&scene.rig), [carrier]);
                for theta in library.initial_guesses(&scene.rig, carrier) {
                    for slope in [0.0, 0.3] {
                        let expected = acted(library, carrier, &scene, &theta, slope);
                        let specs = library.parameters(&scene.rig, carrier);
                        let found = within(&specs, &*own[which], carrier, &scene, &theta, slope);
                        let off = difference(&found, &expected);
                        assert!(off < 1e-9, "{name} on the {}: {off:.1e} at {theta:?}", scene.name);
                        compared[which] += 1;
                    }
                }
            }
        }
        let (dry, viscous) = (find("coulomb_friction").expect("dry"), find("viscous_friction").expect("viscous"));
        for carrier in own[1].carriers(&scene.rig) {
            let outputs = scene.outputs.len();
            for theta in dry.initial_guesses(&scene.rig, carrier) {
                let (f, [speed, window]) = (&theta[..outputs], [theta[outputs], theta[outputs + 1]]);
                let c: Vec<f64> = f.iter().map(|f| -0.4 * f / speed).collect();
                let mut expected = acted(dry, carrier, &scene, &theta, 0.0);
                let second = [&c[..], &[window]].concat();
                let specs = viscous.parameters(&scene.rig, carrier);
                viscous.act(carrier, Values::constant(&specs, &second), &scene.record, &mut expected);
                let own_theta = [&c[..], f, &[window, speed]].concat();
                let off = difference(&acted(&*own[1], carrier, &scene, &own_theta, 0.0), &expected);
                assert!(off < 1e-9, "friction by {carrier:?} on the {}: {off:.1e}", scene.name);
                compared[1] += 1;
            }
        }
    }
    assert!(compared.iter().all(|count| *count > 100), "{compared:?}");
}

/// Effects of every form, with inputs, memory, and time.
const FORMS: &str = r#"
[[effect]]
name = "leak"
place = "actuators"
unit = "rad"
rate = { p = "(q - p)/tau - k*tanh(p/scale)*scale" }
start = { p = "q" }
output = "q + a*if(t/one_second > 4, p - q, (p - q)*t/(4*one_second))"
[effect.constants]
scale = { value = 1, unit = "rad" }
one_second = { value = 1, unit = "s" }
[effect.parameters]
a = { silent = 0.0, bounds = [0, 1], guesses = [0.4, 1] }
tau = { unit = "s", bounds = [0.2, 5], guesses = [0.3, 1.5] }
k = { unit = "1/s", bounds = [0, 1], guesses = [0.1, 0.4] }

[[effect]]
name = "count"
place = "outputs"
unit = "m"
update = { turns = "turns + if(u*before < 0, 1, 0)", before = "u", way = "way + abs(u - before)*dt/one" }
output = "y + a*turns + b*way/metre"
[effect.inputs]
u = { signal = "vehicle", unit = "m/s" }
[effect.constants]
one = { value = 1, unit = "s" }
metre = { value = 1, unit = "m/s" }
[effect.parameters]
a = { unit = "mm", silent = 0, bounds = [-5, 5], guesses = [1] }
b = { unit = "mm", silent = 0, bounds = [-5, 5], guesses = [1] }

[[effect]]
name = "twist"
place = "frame"
static = { x = "x*cos(a*h) - y*sin(a*h)", y = "x*sin(a*h) + y*cos(a*h)" }
[effect.inputs]
h = { signal = "altitude", unit = "m" }
[effect.parameters]
a = { unit = "deg/m", silent = 0, bounds = [-20, 20], guesses = [5] }
"#;

fn forms() -> (Scene, Vec<std::sync::Arc<Own>>) {
    let scene = hovering();
    let of = |definition: &Definition| Own::new(definition, &scene.rig).unwrap_or_else(|error| panic!("{error}"));
    let mut all: Vec<_> = read(FORMS, "own.toml").expect("definitions").iter().map(of).collect();
    all.extend(definitions().iter().map(of));
    (scene, all)
}

/// Oracle: by hand, at all samples: turns are counted, and markers are turned about z.
#[test]
fn states_and_coordinates_by_hand() {
    let (scene, own) = forms();
    let theta = [2e-3, 1e-3];
    let found = acted(&*own[1], Carrier::Rig, &scene, &theta, 0.0);
    let (u, time) = (&scene.record.contexts[2], &scene.record.time);
    let (mut turns, mut way) = (0.0, 0.0);
    for t in 0..u.len() {
        if t > 0 {
            // The state `before` starts at 0, and is the input from the second sample on.
            let before = if t == 1 { 0.0 } else { u[t - 1] };
            turns += f64::from(u8::from(u[t] * before < 0.0));
            way += (u[t] - before).abs() * (time[t] - time[t - 1]);
        }
        for (y, x) in found.iter().zip(&scene.outputs) {
            assert!((y[t] - x[t] - theta[0] * turns - theta[1] * way).abs() < 1e-12, "{t}");
        }
    }
    assert!(turns > 3.0);
    let found = acted(&*own[2], Carrier::Rig, &scene, &[0.3], 0.0);
    for (t, h) in scene.record.contexts[1].iter().enumerate() {
        let (sine, cosine) = (0.3 * h).sin_cos();
        for marker in [0, 3] {
            let [x, y, z] = [0, 1, 2].map(|k| scene.outputs[marker + k][t]);
            let expected = [x * cosine - y * sine, x * sine + y * cosine, z];
            (0..3).for_each(|k| assert!((found[marker + k][t] - expected[k]).abs() < 1e-12));
        }
    }
}

/// Oracle: the effect on the whole trial. The same bits in pieces of any length, with constant values and varying ones.
#[test]
fn pieces_make_the_whole() {
    let (scene, own) = forms();
    let (record, samples) = (&scene.record, scene.record.samples());
    let context: Vec<f64> = (0..samples).map(|t| (0.07 * t as f64).sin()).collect();
    for effect in own.iter().filter(|effect| effect.name() != "own_friction") {
        let carrier = effect.carriers(&scene.rig)[0];
        let specs = effect.parameters(&scene.rig, carrier);
        for theta in effect.initial_guesses(&scene.rig, carrier) {
            for slope in [0.0, 1.3] {
                let slopes: Vec<f64> =
                    specs.iter().zip(&theta).map(|(s, v)| if s.may_vary { slope * v } else { 0.0 }).collect();
                let whole = {
                    let mut whole = columns(&scene, &**effect);
                    let values = values(&specs, &theta, slope, &slopes, &context);
                    effect.act(carrier, values, record, &mut whole);
                    whole
                };
                for length in [1, 5, 64, 100] {
                    let mut memory = Memory::default();
                    for first in (0..samples).step_by(length) {
                        let rows = first..samples.min(first + length);
                        let cut = |all: &[Vec<f64>]| all.iter().map(|c| c[rows.clone()].to_vec()).collect::<Vec<_>>();
                        let mut now = cut(&columns(&scene, &**effect));
                        let piece: Record = record.select(&rows.clone().collect::<Vec<usize>>());
                        let values = values(&specs, &theta, slope, &slopes, &context[rows.clone()]);
                        effect.proceed(carrier, values, &piece, &mut memory, &mut now);
                        assert!(now == cut(&whole), "{} in pieces of {length}: {theta:?} {slope}", effect.name());
                    }
                }
            }
        }
    }
}

fn values<'a>(
    specs: &'a [ParameterSpec],
    theta: &'a [f64],
    slope: f64,
    slopes: &'a [f64],
    context: &'a [f64],
) -> Values<'a> {
    if slope == 0.0 { Values::constant(specs, theta) } else { Values::varying(specs, theta, slopes, context) }
}

#[test]
fn contract() {
    let (scene, own) = forms();
    for effect in &own {
        for carrier in effect.carriers(&scene.rig) {
            let (specs, guesses) =
                (effect.parameters(&scene.rig, carrier), effect.initial_guesses(&scene.rig, carrier));
            assert!((1..=150).contains(&guesses.len()), "{}: {} guesses", effect.name(), guesses.len());
            let before = columns(&scene, &**effect);
            let neutral: Vec<f64> = specs.iter().map(|spec| spec.neutral).collect();
            assert_eq!(acted(&**effect, carrier, &scene, &neutral, 0.0), before, "{}", effect.name());
            for theta in &guesses {
                let inside = theta.iter().zip(&specs).all(|(v, s)| s.lower <= *v && *v <= s.upper);
                assert!(inside, "{}: {theta:?}", effect.name());
                let after = acted(&**effect, carrier, &scene, theta, 0.0);
                assert!(after.iter().flatten().all(|x| x.is_finite()) && after != before, "{}", effect.name());
                // Where sizes are silent in a part of the trial, the column stays as it is there.
                let silent: Vec<f64> =
                    specs.iter().zip(theta).map(|(s, v)| if s.may_vary { s.neutral } else { *v }).collect();
                assert_eq!(acted(&**effect, carrier, &scene, &silent, 0.0), before);
            }
            for samples in [0, 1] {
                let record = scene.record.select(&(0..samples).collect::<Vec<usize>>());
                let mut short: Vec<Vec<f64>> = before.iter().map(|column| column[..samples].to_vec()).collect();
                effect.act(carrier, Values::constant(&specs, &guesses[0]), &record, &mut short);
                assert!(short.iter().flatten().all(|x| x.is_finite()), "{} on {samples} samples", effect.name());
            }
            let instance = Instance::own(effect, carrier, &scene.rig);
            let mut running = Running::new(&instance, &guesses[0]);
            let mut acted = || {
                let mut all = vec![];
                for t in 0..20 {
                    let mut now: Vec<Vec<f64>> = before.iter().map(|column| vec![column[t]]).collect();
                    running.proceed(&scene.record.select(&[t]), &mut now);
                    all.push(now);
                }
                running.restart();
                all
            };
            assert!(acted() == acted(), "{}", effect.name());
        }
    }
}

/// Oracle: signals are straight between samples, so that one more sample on the line changes nothing at the others.
#[test]
fn a_linear_rate_is_exact_on_irregular_time_stamps() {
    fn finer(column: &[f64]) -> Vec<f64> {
        let between = column.windows(2).flat_map(|pair| [pair[0], pair[0] + 0.3 * (pair[1] - pair[0])]);
        between.chain(column.last().copied()).collect()
    }
    let third = r#"
[[effect]]
name = "third"
place = "actuators"
unit = "rad"
rate = { a = "(q + g*u - a)/tau", b = "(a - b)/(2*tau)", c = "b - c/s" }
start = { a = "q", b = "q", c = "q*s" }
output = "q + g*(c/s + 0.1*(b - a))/r"
[effect.inputs]
u = { signal = "throttle", unit = "1" }
[effect.constants]
s = { value = 1000, unit = "ms" }
r = { value = 1, unit = "rad" }
[effect.parameters]
tau = { unit = "s", bounds = [0.01, 5], guesses = [0.2, 1.5] }
g = { unit = "rad", silent = 0, bounds = [-1, 1], guesses = [0.3] }
"#;
    let scene = hovering();
    let own = Own::new(&one(third), &scene.rig).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(own.is_exact(), Some(true));
    let each = |columns: &[Vec<f64>]| columns.iter().map(|column| finer(column)).collect::<Vec<_>>();
    let Record { time, actuators, contexts, .. } = &scene.record;
    let fine = Record::new(finer(time), each(actuators), each(contexts), vec![]);
    let specs = own.parameters(&scene.rig, Carrier::Rig);
    for theta in own.initial_guesses(&scene.rig, Carrier::Rig) {
        let mut dense = each(actuators);
        own.act(Carrier::Rig, Values::constant(&specs, &theta), &fine, &mut dense);
        let same: Vec<Vec<f64>> = dense.iter().map(|column| column.iter().step_by(2).copied().collect()).collect();
        let off = difference(&same, &acted(&*own, Carrier::Rig, &scene, &theta, 0.0));
        assert!(off < 1e-12, "{off:.1e}");
        // 2τ is slower than a second at either guess but the first: the slowest pole.
        let lasting = own.memory(Values::constant(&specs, &theta)).expect("a time");
        assert!((lasting - f64::max(1.0, 2.0 * theta[1])).abs() < 1e-9, "{lasting} at {theta:?}");
    }
}

/// Oracle: the closed form of ż = −k z² + 0·q: z = z0/(1 + k z0 t). Halving the step divides the error by sixteen.
#[test]
fn a_rate_that_is_not_linear_converges_at_fourth_order() {
    let scene = hovering();
    let error = |steps: usize| {
        let text = format!(
            "[[effect]]\nname = \"burn\"\nplace = \"actuators\"\nunit = \"rad\"\nrate = {{ z = \"-k*z^2\" }}\nstart = {{ z = \"1\" }}\n\
             output = \"q + a*z\"\nsteps = {steps}\n[effect.parameters]\n\
             a = {{ unit = \"rad\", silent = 0, bounds = [0, 1], guesses = [0.5] }}\n\
             k = {{ unit = \"1/s\", bounds = [0.1, 9], guesses = [4] }}\n"
        );
        let own = Own::new(&one(&text), &scene.rig).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(own.is_exact(), Some(false));
        let found = acted(&*own, Carrier::Rig, &scene, &[0.5, 4.0], 0.0);
        let of = |t: usize| {
            let z = 1.0 / (1.0 + 4.0 * (scene.record.time[t] - scene.record.time[0]));
            (found[0][t] - scene.record.actuators[0][t] - 0.5 * z).abs()
        };
        (0..scene.record.samples()).map(of).fold(0.0, f64::max)
    };
    let order = (error(2) / error(4)).log2();
    assert!((order - 4.0).abs() < 0.3, "measured order {order:.2}");
    assert!(error(8) < 1e-6);
}

/// A model keeps the definition: what is read from the text alone does the same, and a name that the library has stays the library's.
#[test]
fn a_term_has_its_definition() {
    let (scene, own) = forms();
    for effect in &own {
        let carrier = effect.carriers(&scene.rig)[0];
        let instance = Instance::own(effect, carrier, &scene.rig);
        let theta = instance.initial_guesses(&scene.rig).remove(0);
        let text = serde_json::to_string(&instance.term(&theta)).expect("JSON");
        let term = serde_json::from_str(&text).expect("a term");
        let restored = Instance::restore(&term, &scene.rig).expect("an effect");
        assert!(restored.is_own() && restored.effect().source().contains(".toml"));
        let [mut a, mut b] = [(); 2].map(|()| columns(&scene, &**effect));
        instance.act(&theta, &scene.record, &mut a);
        restored.act(&term.values, &scene.record, &mut b);
        assert_eq!(a, b);
        let mut spoiled = term.clone();
        spoiled.definition.as_mut().expect("a definition").parameters.clear();
        let refusal = Instance::restore(&spoiled, &scene.rig).expect_err("refused");
        assert!(refusal.contains(effect.name()) && refusal.contains("run close-loop again"), "{refusal}");
    }
}
