//! The nominal model as C: the function `nominal`, which predicts all outputs of a sample.
//!
//! ```text
//! y = O( F( p(Q(q)) + m(Q(q)) + Σ_f w_f u_f(Q(q)) + (s − g(q)) ) )
//! ```

use acm_core::NominalModel;
use acm_core::augmented::AugmentedModel;
use acm_core::effects::Site;
use acm_core::effects::instance::Instance;
use acm_core::inter_sample::{AHEAD, InterSample, QUARTIC, UNEVEN};
use acm_core::polynomial::Polynomial;
use acm_core::rig::Rig;
use acm_core::static_map::{Harmonic, StaticMap};
use acm_stream::{Nominal, Parts};

use super::effects::{self, Inputs};
use super::text::{double, doubles, rows};
use super::{Written, arm};
use crate::ExportError;

/// Writes the tables, functions and memory of the nominal model; `met` are actuators of samples.
pub fn write(parts: &Parts, met: &[Vec<f64>]) -> Result<Written, ExportError> {
    let Parts { nominal, signals, .. } = parts;
    let actuators = signals.actuators.len();
    let mut written = Written::default();
    let body = match nominal {
        Nominal::Given(outputs) => {
            let first = actuators + signals.contexts.len();
            format!("    memcpy(y, in + {first}, {outputs} * sizeof *y);\n")
        }
        Nominal::Model(model) => base(model, None, "in", met, &mut written),
        Nominal::Augmented(model) => augmented(model, met, &mut written)?,
    };
    let unused = ["time", "in"].into_iter().filter(|word| !effects::uses(&body, word));
    let unused: String = unused.map(|word| format!("    (void){word};\n")).collect();
    let memory = if written.memory.is_empty() { "" } else { "$name_memory *memory, " };
    let between = match nominal {
        Nominal::Augmented(model) if !written.memory.is_empty() => Some((model.rig(), model.inter_sample())),
        _ => None,
    };
    let between = between.filter(|(_, inter_sample)| *inter_sample != InterSample::Straight);
    let name = if between.is_none() { "nominal" } else { "straight" };
    written.source += &format!(
        "\n/* All outputs y of the nominal model at one sample; `in` are its inputs. Returns $WHOLE_OK, or why it cannot. */\n\
         static int {name}(double time, const double *in, {memory}double *y)\n{{\n{body}{unused}    return $WHOLE_OK;\n}}\n",
    );
    if let Some((rig, inter_sample)) = between {
        add_samples(&inter_sample, rig, parts.width(), &mut written);
    }
    Ok(written)
}

/// Adds the function that passes a sample on to `straight`, after the one that goes in before it.
fn add_samples(inter_sample: &InterSample, rig: &Rig, inputs: usize, written: &mut Written) {
    let signals = rig.actuators.len() + rig.contexts.len() + if rig.carried { 3 } else { 0 };
    let (members, constants, source) = match inter_sample {
        InterSample::Quartic(_) => (
            format!("    double values[{signals}][{QUARTIC}], times[{QUARTIC}];\n    int count;\n"),
            format!(
                "#define SAMPLES {QUARTIC}\n#define UNEVEN {}\n/* Places of the actuators that follow a quartic. */\nstatic const int CURVED",
                double(UNEVEN)
            ),
            include_str!("runtime/quartic.c"),
        ),
        _ => (
            format!("    double last[{signals}], last_time;\n    int begun;\n"),
            format!(
                "#define AHEAD {}\n/* Places of the actuators that are held. */\nstatic const int HELD",
                double(AHEAD)
            ),
            include_str!("runtime/held.c"),
        ),
    };
    let places = inter_sample.actuators();
    let listed: Vec<String> = places.iter().map(ToString::to_string).collect();
    let sizes = [("@COUNT", places.len()), ("@SIGNALS", signals), ("@INPUTS", inputs)];
    let source = sizes.iter().fold(source.to_owned(), |text, (key, size)| text.replace(key, &size.to_string()));
    written.members += &members;
    written.source += &format!("\n{constants}[{}] = {{ {} }};\n\n{source}", places.len(), listed.join(", "));
}

/// Returns the call that leaves p(q) in y.
fn base(
    model: &NominalModel,
    down: Option<nalgebra::Vector3<f64>>,
    q: &str,
    met: &[Vec<f64>],
    written: &mut Written,
) -> String {
    match model {
        NominalModel::Strain(strain) => {
            let arm = arm::write(strain, down, met);
            written.source += &arm.source;
            written.needs.extend(arm.needs);
            format!("    double c[2 * FUNCTIONS];\n    strain({q}, c);\n    arm(c, y);\n")
        }
        NominalModel::Polynomial(polynomial) => {
            written.source += &polynomial_function("polynomial", polynomial);
            format!("    polynomial({q}, y);\n")
        }
        NominalModel::None { outputs } => format!("    memset(y, 0, {outputs} * sizeof *y);\n"),
    }
}

/// Writes `y_o = C[o][0] + Σ_j C[o][j + 1] m_j(q)`.
fn polynomial_function(name: &str, polynomial: &Polynomial) -> String {
    let table = name.to_uppercase();
    let columns = polynomial.coefficients().column_iter();
    let coefficients: Vec<Vec<String>> = columns.map(|c| c.iter().map(|value| double(*value)).collect()).collect();
    let count = polynomial.monomials().len();
    format!(
        "\n/* Coefficients of each output: constant, then monomials. */\n{}\n/* y = c_0 + sum_j c_j m_j(q), with the monomials m of \
         the actuators. */\nstatic void {name}(const double *q, double *y)\n{{\n{}    for (int o = 0; o < {}; ++o) {{\n        \
         double sum = 0.0;\n        for (int j = 0; j < {count}; ++j) {{\n            sum += {table}[o][j + 1] * m[j];\n        \
         }}\n        y[o] = {table}[o][0] + sum;\n    }}\n}}\n",
        rows("double", &table, &coefficients),
        arm::monomial_lines(polynomial.monomials().exponents()),
        polynomial.outputs(),
    )
}

fn map_function(map: &StaticMap, outputs: usize, actuators: usize) -> String {
    let [low, high] = map.range();
    let of = |n: &Vec<usize>| n.iter().map(ToString::to_string).collect();
    let exponents: Vec<Vec<String>> = map.exponents().iter().map(of).collect();
    let b: Vec<Vec<String>> =
        map.coefficients().row_iter().map(|row| row.iter().map(|value| double(*value)).collect()).collect();
    let (kinks, loop_over_kinks) = kinks(map);
    let (harmonics, loop_over_harmonics) = harmonics(map);
    format!(
        "\n#define MAP_TERMS {}\n#define MAP_DEGREE {}\n#define ACTUATORS {actuators}\n#define MODEL_OUTPUTS {outputs}\n{}{}{}{}{kinks}{harmonics}\n{}",
        exponents.len(),
        map.degree(),
        doubles("MAP_LOW", low),
        doubles("MAP_HIGH", high),
        rows("int", "MAP_EXPONENT", &exponents),
        rows("double", "MAP_COEFFICIENT", &b),
        include_str!("runtime/static_map.c")
            .replace("$kinks", loop_over_kinks)
            .replace("$harmonics", loop_over_harmonics),
    )
}

/// Returns the tables of the terms of angles, and the loop over them; nothing where there are none.
fn harmonics(map: &StaticMap) -> (String, &'static str) {
    if map.harmonics().is_empty() {
        return (String::new(), "");
    }
    let of = |sizes: fn(&Harmonic) -> &[f64]| -> Vec<Vec<String>> {
        map.harmonics().iter().map(|term| sizes(term).iter().map(|size| double(*size)).collect()).collect()
    };
    let multiples: Vec<Vec<String>> =
        map.harmonics().iter().map(|term| term.multiples.iter().map(ToString::to_string).collect()).collect();
    let tables = format!(
        "#define HARMONICS {}\n{}{}{}",
        multiples.len(),
        rows("int", "HARMONIC_MULTIPLE", &multiples),
        rows("double", "HARMONIC_COSINE", &of(|term| &term.cosine)),
        rows("double", "HARMONIC_SINE", &of(|term| &term.sine)),
    );
    (tables, include_str!("runtime/harmonics.c"))
}

/// Returns the tables of the changes of slope, and the loop over them; nothing where there are none.
fn kinks(map: &StaticMap) -> (String, &'static str) {
    if map.kinks().is_empty() {
        return (String::new(), "");
    }
    let at: Vec<f64> = map.kinks().iter().map(|kink| kink.at).collect();
    let actuator: Vec<Vec<String>> = map.kinks().iter().map(|kink| vec![kink.actuator.to_string()]).collect();
    let slopes: Vec<Vec<String>> =
        map.kinks().iter().map(|kink| kink.slopes.iter().map(|slope| double(*slope)).collect()).collect();
    let tables = format!(
        "#define KINKS {}\n{}{}{}",
        at.len(),
        rows("int", "KINK_ACTUATOR", &actuator),
        doubles("KINK_AT", &at),
        rows("double", "KINK_SLOPE", &slopes)
    );
    (tables, include_str!("runtime/kinks.c"))
}

/// Returns the body of `nominal` for a model with effects; their functions go to `written`.
fn augmented(model: &AugmentedModel, met: &[Vec<f64>], written: &mut Written) -> Result<String, ExportError> {
    let rig = model.rig();
    let (actuators, outputs) = (rig.actuators.len(), rig.outputs.len());
    let restore = |term| {
        Instance::restore(term, rig).map_err(|what| ExportError::Unsupported {
            what,
            format: "C99",
            remedy: "write the model again with this version".into(),
        })
    };
    let instances: Vec<Instance> = model.effects().iter().map(restore).collect::<Result<_, _>>()?;
    let is_load = |site| matches!(site, Site::Load | Site::Marker);
    // Only an arm bends: elsewhere loads do nothing, in acm-stream too.
    let bends = matches!(model.nominal(), NominalModel::Strain(_)) && rig.arm.is_some();
    let loaded = bends && instances.iter().any(|instance| is_load(instance.site()));
    let down = rig.arm.as_ref().filter(|_| loaded).map(|arm| arm.down);
    let inputs = Inputs { actuators, contexts: rig.contexts.len(), outputs };
    let (mut checks, mut calls) = (String::new(), [String::new(), String::new(), String::new()]);
    for (k, (instance, term)) in instances.iter().zip(model.effects()).enumerate() {
        let (place, columns) = match instance.site() {
            Site::Actuation => (0, "q"),
            Site::Load | Site::Marker => (1, "w"),
            Site::Frame | Site::Output => (2, "y"),
        };
        if place == 1 && !bends {
            continue;
        }
        let effect = effects::write(k + 1, instances.len(), instance, &term.values, rig, inputs)?;
        written.source += &effect.source;
        if !effect.memory.is_empty() {
            written.members += &format!("    $name_effect_{n} effect_{n};\n", n = k + 1);
        }
        written.memory += &effect.memory;
        written.macros += &effect.macros;
        written.needs.extend(effect.needs);
        checks += &effect.check;
        calls[place] += &effect.call.replace("$columns", columns);
    }
    let [actuation, load, output] = calls;
    let mut body = checks;
    let q = if actuation.is_empty() { "in" } else { "q" };
    if q == "q" {
        body += &format!("    double q[{actuators}];\n    memcpy(q, in, sizeof q);\n{actuation}");
    }
    body += &base(model.nominal(), down, q, met, written);
    if let Some(map) = model.static_map() {
        written.source += &map_function(map, outputs, actuators);
        written.needs.extend((!map.harmonics().is_empty()).then_some("sin_cos_d"));
        body += &format!("    static_map({q}, y);\n");
    }
    if loaded {
        body += &format!("    double w[15] = {{ 0.0 }};\n{load}    add_loads(c, w, y);\n");
    }
    if let Some(g) = model.stands_for() {
        written.source += &polynomial_function("stands_for", g);
        let first = actuators + rig.contexts.len() + if rig.carried { 3 } else { 0 };
        body += &format!(
            "    /* What the prediction that comes with the sample has beyond its polynomial. */\n    double g[{outputs}];\n    \
             stands_for(in, g);\n    for (int o = 0; o < {outputs}; ++o) {{\n        y[o] += in[{first} + o] - g[o];\n    }}\n"
        );
    }
    Ok(body + &output)
}
