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

/// Writes the tables of channels and scalers, and the functions of the header.
pub fn write(parts: &Parts, remembers: bool) -> String {
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
    let (channels, outputs) = (parts.channels.len(), parts.tip.len());
    let mut text = format!(
        "\n/* Channels of the network: input, and whether its rate of change stands in its place. */\n{}",
        rows("int", "CHANNEL", &places)
    );
    text += "/* z = (x - mean)/spread of each channel, and of each output. */\n";
    text += &doubles("CHANNEL_MEAN", &parts.inputs.mean);
    text += &doubles("CHANNEL_SPREAD", &parts.inputs.spread);
    text += &doubles("TARGET_MEAN", &parts.targets.mean);
    text += &doubles("TARGET_SPREAD", &parts.targets.spread);
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
    let forget = if remembers { "memset(&s->memory, 0, sizeof s->memory);" } else { "" };
    let refuse = |code: &str, deep: &str| match remembers {
        true => format!("{forget}\n{deep}return $NAME_{code};"),
        false => format!("return $NAME_{code};"),
    };
    let (ask, commit, locals) = asking(parts);
    let places = [
        ("@LOCALS", locals),
        ("@ASK", ask),
        ("@COMMIT", commit),
        ("@CHANNELS", channels.to_string()),
        ("@OUTPUTS", outputs.to_string()),
        ("@PADDED", padded(outputs).to_string()),
        ("@ALL", parts.nominal.outputs().to_string()),
        ("@TIP", parts.tip.start.to_string()),
        ("@MAX_GAP", double(parts.max_gap * ROUNDING)),
        ("@FIRST", double(parts.first_elapsed)),
        ("@MEMORY", if remembers { "&s->memory, ".into() } else { String::new() }),
        ("@IN_RANGE", if parts.ranges.is_some() { "inside".into() } else { "-1".into() }),
        ("@LOOK", if parts.ranges.is_some() { LOOK.into() } else { String::new() }),
        ("@INSIDE", if parts.ranges.is_some() { "    int inside = 1;\n".into() } else { String::new() }),
        ("@REFUSE_NOMINAL", refuse("NOMINAL", "            ")),
        ("@REFUSE_CHANNEL", refuse("CHANNEL", "                ")),
        ("@REFUSE_OUTPUT", refuse("OUTPUT", "                ")),
    ];
    text + "\n" + &places.iter().fold(STEP.to_owned(), |text, (key, value)| text.replace(key, value))
}

const LOOK: &str =
    "        if (!(value >= RANGE[c][0] && value <= RANGE[c][1])) {\n            inside = 0;\n        }\n";

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
    let locals = format!("    float h[{}];\n", state_size(parts));
    match parts.state {
        _ if !has_state(parts) => ("        network(x, step, predicted);\n".into(), String::new(), String::new()),
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
