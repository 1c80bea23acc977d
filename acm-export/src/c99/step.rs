//! The step function: checks, nominal model, channels, network, state.

use acm_stream::{Parts, Source, StateRule};

use super::network::{has_state, padded, state_size};
use super::text::{double, doubles, rows};

/// A longer step than the limit, but for the rounding of time stamps: as in acm-stream.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Tolerance for rounding, as a share of a range's width, by which a value of training may lie outside of its range: as
/// in acm-stream.
const SLACK: f64 = 1e-9;

const STEP: &str = include_str!("runtime/step.c");
const NOMINAL: &str = include_str!("runtime/step_nominal.c");
const PREDICT: &str = include_str!("runtime/predict.c");

/// Writes the function `take`, with the tables of channels and scalers where there is a network.
pub fn write(parts: &Parts, remembers: bool) -> String {
    let (tables, step, own) = match parts.has_network() {
        true => (tables(parts), STEP, of_network(parts, remembers)),
        false => (String::new(), NOMINAL, vec![]),
    };
    let mut places = vec![("@PREDICT", PREDICT.to_owned())];
    places.extend(own);
    places.extend([
        ("@INPUTS", parts.width().to_string()),
        ("@OUTPUTS", parts.tip.len().to_string()),
        ("@ALL", parts.nominal.outputs().to_string()),
        ("@TIP", parts.tip.start.to_string()),
        ("@MEMORY", if remembers { "&s->memory, ".into() } else { String::new() }),
        ("@REFUSE_NOMINAL", refuse("NOMINAL", "            ", remembers)),
    ]);
    tables + "\n" + &places.iter().fold(step.to_owned(), |text, (key, value)| text.replace(key, value))
}

/// Returns the lines that refuse a sample after effects took it: they begin anew.
fn refuse(code: &str, deep: &str, remembers: bool) -> String {
    match remembers {
        true => format!("memset(&s->memory, 0, sizeof s->memory);\n{deep}return $WHOLE_{code};"),
        false => format!("return $WHOLE_{code};"),
    }
}

/// Returns the tables of channels and scalers.
fn tables(parts: &Parts) -> String {
    let actuators = parts.signals.actuators.len();
    let places: Vec<Vec<String>> = parts
        .channels
        .iter()
        .map(|channel| {
            let place = match channel.source {
                Source::Actuator(a) => a,
                Source::Context(e) => actuators + e,
            };
            vec![place.to_string(), u8::from(channel.rate).to_string()]
        })
        .collect();
    let mut text = format!(
        "\n/* Channels of the network: input, and whether its rate of change stands in its place. */\n{}",
        rows("int", "CHANNEL", &places)
    );
    text += "/* z = (x - mean)/spread of each channel, and of each output. */\n";
    text += &doubles("CHANNEL_MEAN", &parts.inputs.mean);
    text += &doubles("CHANNEL_SPREAD", &parts.inputs.spread);
    text += &doubles("TARGET_MEAN", &parts.targets.mean);
    text += &doubles("TARGET_SPREAD", &parts.targets.spread);
    if !parts.straight.is_empty() {
        let weights: Vec<Vec<String>> =
            parts.straight.iter().map(|row| row.iter().map(|weight| double(*weight)).collect()).collect();
        text += "/* Straight path beside the network: of each channel, then the constant. */\n";
        text += &rows("double", "STRAIGHT", &weights);
    }
    if let Some(ranges) = &parts.ranges {
        let slack = |low: f64, high: f64| SLACK * (high - low).max(low.abs()).max(high.abs());
        let ends: Vec<Vec<String>> = ranges
            .iter()
            .map(|r| vec![double(r.low - slack(r.low, r.high)), double(r.high + slack(r.low, r.high))])
            .collect();
        text += &format!(
            "/* Smallest and largest value of each channel in training. */\n{}",
            rows("double", "RANGE", &ends)
        );
    }
    text
}

/// Returns what stands for the names in the step of an estimator with a network.
fn of_network(parts: &Parts, remembers: bool) -> Vec<(&'static str, String)> {
    let (ask, commit, locals) = asking(parts);
    let known = parts.ranges.is_some();
    // An estimator without a network has an infinite gap, which C cannot write as a number.
    let gap = (parts.max_gap * ROUNDING).min(f64::MAX);
    vec![
        ("@LOCALS", locals),
        ("@ASK", ask),
        ("@COMMIT", commit),
        ("@STRAIGHT", if parts.straight.is_empty() { String::new() } else { STRAIGHT.into() }),
        ("@PATH", if parts.straight.is_empty() { String::new() } else { " + path[o]".into() }),
        ("@CHANNELS", parts.channels.len().to_string()),
        ("@PADDED", padded(parts.network.outputs).to_string()),
        ("@MAX_GAP", double(gap)),
        ("@FIRST", double(parts.first_elapsed)),
        ("@IN_RANGE", if known { "inside".into() } else { "-1".into() }),
        ("@LOOK", if known { LOOK.into() } else { String::new() }),
        ("@INSIDE", if known { "    int inside = 1;\n".into() } else { String::new() }),
        ("@REFUSE_CHANNEL", refuse("CHANNEL", "                ", remembers)),
        ("@REFUSE_OUTPUT", refuse("OUTPUT", "                ", remembers)),
    ]
}

const LOOK: &str =
    "        if (!(value >= RANGE[c][0] && value <= RANGE[c][1])) {\n            inside = 0;\n        }\n";

const STRAIGHT: &str = "\
        for (int o = 0; o < @OUTPUTS; ++o) {
            path[o] = STRAIGHT[@CHANNELS][o];
            for (int c = 0; c < @CHANNELS; ++c) {
                path[o] += STRAIGHT[c][o] * (double)x[c];
            }
        }
";

const WINDOW: &str = "\
        kept = begins ? 0 : (s->kept < @W ? s->kept : @W - 1);
        memset(h, 0, sizeof h);
        for (int k = 0; k < kept; ++k) {
            const int place = (s->next + @W - kept + k) % @W;
            network(s->channels[place], s->steps[place], h, predicted);
        }
        network(x, step, h, predicted);
";

const KEEP: &str = "\
        memcpy(s->channels[s->next], x, sizeof x);
        s->steps[s->next] = step;
        s->next = (s->next + 1) % @W;
        s->kept = kept + 1;
";

/// Returns the lines that call the network, the lines that keep its state, and the declarations that they need.
fn asking(parts: &Parts) -> (String, String, String) {
    let path = if parts.straight.is_empty() { "" } else { "    double path[@OUTPUTS];\n" };
    let locals = format!("    float h[{}];\n{path}", state_size(parts));
    match parts.state {
        _ if !has_state(parts) => ("        network(x, step, predicted);\n".into(), String::new(), path.into()),
        StateRule::Running => (
            "        if (begins) {\n            memset(h, 0, sizeof h);\n        } else {\n            \
             memcpy(h, s->hidden, sizeof h);\n        }\n        network(x, step, h, predicted);\n"
                .into(),
            "        memcpy(s->hidden, h, sizeof h);\n".into(),
            locals,
        ),
        StateRule::Window(length) => {
            let fill = |text: &str| text.replace("@W", &length.to_string());
            (fill(WINDOW), fill(KEEP), format!("{locals}    int kept;\n"))
        }
    }
}
