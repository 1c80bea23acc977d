//! Effects as C: one function each, with its equation and parameter values.
//!
//! | in C      | meaning                                                     |
//! | --------- | ----------------------------------------------------------- |
//! | `x`       | columns of the effect's place: actuators, loads or outputs  |
//! | `v`       | values of its parameters, SI                                |
//! | `in`      | inputs of the sample, as they came                          |
//! | `time`    | since the first sample, s                                   |
//! | `m`       | what it remembers                                           |

mod bodies;

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, Rig, Site};

use super::text::{double, plain};
use crate::ExportError;
use bodies::Body;

/// Numbers of signals in a sample, and of outputs.
#[derive(Debug, Clone, Copy)]
pub struct Inputs {
    pub actuators: usize,
    pub contexts: usize,
    pub outputs: usize,
}

/// C code of one effect.
#[derive(Debug)]
pub struct Effect {
    /// Function of the effect.
    pub source: String,
    /// Member of the memory for the effect; empty where it has no state.
    pub memory: String,
    /// Definitions of the header.
    pub macros: String,
    /// Names of the fragments.
    pub needs: Vec<&'static str>,
    /// Lines that check whether the effect can take the sample, before any effect has.
    pub check: String,
    /// Line that calls the effect on `$columns`.
    pub call: String,
}

/// Writes effect `number` of `count`.
pub fn write(
    number: usize,
    count: usize,
    instance: &Instance,
    theta: &[f64],
    rig: &Rig,
    inputs: Inputs,
) -> Result<Effect, ExportError> {
    let name = instance.effect().name();
    let columns = match instance.site() {
        Site::Actuation => inputs.actuators,
        _ => inputs.outputs,
    };
    let asked = bodies::Asked { number, instance, theta, rig, inputs, columns };
    let Some(Body { equation, memory, code, mut needs, macros, ring }) = bodies::write(&asked) else {
        return Err(ExportError::Unsupported {
            what: format!("the effect {name}"),
            format: "C99",
            remedy: format!(
                "close the loop without it (`--set 'effects.without=[\"{name}\"]'`) and export that model, or use the crate acm-stream \
                 in Rust"
            ),
        });
    };
    let varies = instance.context().is_some();
    if varies {
        needs.push("values");
    }
    let label = plain(&instance.label(rig));
    let (mut parameters, mut arguments) = (vec![], vec![]);
    for (word, parameter) in [("time", "double time"), ("in", "const double *in")] {
        if uses(&code, word) || (word == "in" && varies) {
            parameters.push(parameter.to_owned());
            arguments.push(word.to_owned());
        }
    }
    if !memory.is_empty() {
        parameters.push(format!("$name_effect_{number} *m"));
        arguments.push(format!("&memory->effect_{number}"));
    }
    parameters.push("double *x".into());
    arguments.push("$columns".into());
    let source = format!(
        "\n/* Effect {number} of {count}, {label}: {}.\n *   {equation}\n * {} */\nstatic void effect_{number}({})\n{{\n{}{code}}}\n",
        plain(instance.effect().meaning()),
        plain(instance.effect().source()),
        parameters.join(", "),
        if uses(&code, "v") { values(instance, theta, inputs) } else { String::new() },
    );
    let check = ring.map_or(String::new(), |ring| ring.check(number));
    let functions = ring.map_or(String::new(), |ring| ring.functions(number));
    Ok(Effect {
        source: functions + &source,
        memory: if memory.is_empty() {
            String::new()
        } else {
            format!("\n/* {label} */\ntypedef struct {{\n{memory}}} $name_effect_{number};\n")
        },
        macros,
        needs,
        check,
        call: format!("    effect_{number}({});\n", arguments.join(", ")),
    })
}

/// Returns whether a word stands in the code by itself.
pub fn uses(code: &str, word: &str) -> bool {
    let letter = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_' || c == '>' || c == '.');
    code.match_indices(word).any(|(at, _)| {
        !letter(code[..at].chars().next_back())
            && !code[at + word.len()..].starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
    })
}

/// Returns the table `v` of the effect's own values.
fn values(instance: &Instance, theta: &[f64], inputs: Inputs) -> String {
    let own = &instance.parameters()[..instance.own_parameters()];
    let what = |j: usize| format!("/* {}, {} */", plain(&own[j].name), plain(&own[j].unit));
    let Some(context) = instance.context() else {
        let lines: String = (0..own.len()).map(|j| format!("        {}, {}\n", double(theta[j]), what(j))).collect();
        return format!("    static const double v[{}] = {{\n{lines}    }};\n", own.len());
    };
    let mut slopes = vec![0.0; own.len()];
    instance.varying().iter().zip(&theta[own.len()..]).for_each(|(&j, slope)| slopes[j] = *slope);
    let (mut bows, bowed) = (vec![0.0; own.len()], &theta[own.len() + instance.varying().len()..]);
    instance.varying().iter().zip(bowed).for_each(|(&j, bow)| bows[j] = *bow);
    let [low, high] = instance.ends().unwrap_or_default();
    let bound = |value: f64| double(value.clamp(-f64::MAX, f64::MAX));
    let line = |j: usize| {
        let [lower, upper] = own[j].along();
        format!(
            "        {{ {}, {}, {}, {}, {} }}, {}\n",
            double(theta[j]),
            double(slopes[j]),
            double(bows[j]),
            bound(lower),
            bound(upper),
            what(j)
        )
    };
    let lines: String = (0..own.len()).map(line).collect();
    let place = place(context, inputs).unwrap_or(0);
    format!(
        "    /* Value, change of it per unit of the signal in[{place}], bow over it, bounds. */\n    static const double table[{n}][5] = {{\n\
         {lines}    }};\n    double v[{n}];\n    values(v, {n}, table, in[{place}], {}, {});\n",
        double(low),
        double(high),
        n = own.len()
    )
}

/// Returns the index of a carrier among the inputs; none for the rig as a whole.
pub fn place(carrier: Carrier, inputs: Inputs) -> Option<usize> {
    match carrier {
        Carrier::Rig => None,
        Carrier::Actuator(a) => Some(a),
        Carrier::Context(e) => Some(inputs.actuators + e),
    }
}
