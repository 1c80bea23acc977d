//! The header: counts, the state, and three functions.

use acm_stream::{Nominal, Parts, StateRule};

use super::Written;
use super::network::state_size;
use super::text::plain;
use crate::Origin;

/// Types of the states of effects: name, definition, comment.
const TYPES: &[(&str, &str, &str)] = &[
    (
        "$name_lag",
        "    int started;\n    double time, x, y;\n",
        "A signal that follows another: its time and value, and where it is.",
    ),
    ("$name_spring", "    int started;\n    double time, x, y, speed;\n", "The same on a spring."),
    ("$name_play", "    int started;\n    double rest;\n", "Where a play rests."),
    ("$name_slip", "    int started;\n    double x, z;\n", "A friction: the signal before, and how far it is loaded."),
    ("$name_slope", "    int count;\n    double time[3], x[3];\n", "The last three samples."),
];

/// Returns the header's text.
pub fn write(parts: &Parts, origin: &Origin, nominal: &Written, banner: &str) -> String {
    let guard = format!("{}_H", origin.name.to_uppercase());
    let state = state_size(parts);
    let count = |name: &str, value: usize, what: &str| format!("#define $NAME_{name} {value} /* {what} */\n");
    let mut text = format!("{banner}\n#ifndef {guard}\n#define {guard}\n\n");
    text += &count("INPUTS", parts.width(), "numbers of a sample");
    text += &count("OUTPUTS", parts.tip.len(), "numbers of an answer");
    text += &format!("\n/* Inputs of a sample, in order, SI:\n{} */\n", inputs(parts));
    text += &format!("\n/* Outputs, SI:\n{} */\n", outputs(parts));
    text += RESULTS;
    text += &nominal.macros;
    for (name, members, what) in TYPES.iter().filter(|(name, _, _)| nominal.memory.contains(&format!("{name} "))) {
        text += &format!("\n/* {what} */\ntypedef struct {{\n{members}}} {name};\n");
    }
    text += &nominal.memory;
    let memory = if nominal.members.is_empty() {
        String::new()
    } else {
        text += &format!(
            "\n/* What the effects of the nominal model remember. */\ntypedef struct {{\n{}}} $name_memory;\n",
            nominal.members
        );
        "    $name_memory memory;\n".into()
    };
    let hidden = match parts.state {
        _ if state == 0 => String::new(),
        StateRule::Running => format!("    float hidden[{state}];                 /* the network's state */\n"),
        StateRule::Window(length) => format!(
            "    int kept, next;                       /* samples of the window, the newest before `next` */\n    \
             float channels[{length}][{}], steps[{length}];\n",
            parts.channels.len()
        ),
    };
    text + &FUNCTIONS.replace("@MEMORY", &memory).replace("@HIDDEN", &hidden) + &format!("\n#endif /* {guard} */\n")
}

/// Returns a line for each input.
fn inputs(parts: &Parts) -> String {
    let signals = &parts.signals;
    let units = |k: usize| match &parts.nominal {
        Nominal::Augmented(model) => {
            let rig = model.rig();
            rig.actuators
                .iter()
                .chain(&rig.contexts)
                .nth(k)
                .map_or(String::new(), |signal| format!(", {}", signal.unit))
        }
        _ => String::new(),
    };
    let mut names: Vec<String> = signals.actuators.iter().map(|name| format!("{name} (actuator")).collect();
    names.extend(signals.contexts.iter().map(|name| format!("{name} (context")));
    let mut names: Vec<String> =
        names.into_iter().enumerate().map(|(k, name)| format!("{name}{})", units(k))).collect();
    let accelerations = ["x", "y", "z"].iter().take(parts.nominal.acceleration());
    names.extend(accelerations.map(|axis| format!("acceleration of the carrier along {axis} (m/s^2)")));
    names
        .extend((0..parts.nominal.predicted()).map(|o| format!("prediction of output {o} that comes with the sample")));
    names.iter().enumerate().map(|(k, name)| format!(" *   [{k}] {}\n", plain(name))).collect()
}

fn outputs(parts: &Parts) -> String {
    let name = |o: usize| match &parts.nominal {
        Nominal::Augmented(model) => {
            model.rig().outputs.get(o).map_or(String::new(), |signal| format!(" {}, {}", signal.name, signal.unit))
        }
        _ => String::new(),
    };
    let line = |(k, o): (usize, usize)| format!(" *   [{k}] output {o} of the nominal model{}\n", plain(&name(o)));
    parts.tip.clone().enumerate().map(line).collect()
}

const RESULTS: &str = "
/* What a step returns. A sample that is refused changes nothing; but where an output of the nominal model or of the network
 * would not be finite, effects begin anew. */
enum {
    $NAME_OK = 0,
    $NAME_INPUT = 1,   /* an input is no number, or beyond +-1e12: leave the sample out, add its time to that of the next */
    $NAME_TIME = 2,    /* the time since the sample before is not above 0 s: leave the sample out, or restart */
    $NAME_NOMINAL = 3, /* the nominal model's output is not finite */
    $NAME_CHANNEL = 4, /* an input of the network is not finite */
    $NAME_OUTPUT = 5,  /* the answer is not finite */
    $NAME_ROOM = 6     /* samples come faster than an effect has room for: raise $NAME_EFFECT_..._ROOM */
};
";

const FUNCTIONS: &str = "
/* All memory of one estimator. Set it up by $name_restart. */
typedef struct {
    int started;                          /* whether the trial has begun */
    double time;                          /* since its first sample, s */
    unsigned long history;                /* samples that the network saw since the first, or since the last gap */
    double unseen;                        /* time since the last of them, s */
    double before[$NAME_INPUTS]; /* inputs of the last of them */
@HIDDEN@MEMORY} $name_state;

typedef struct {
    double output[$NAME_OUTPUTS];  /* nominal model and network, SI */
    double nominal[$NAME_OUTPUTS]; /* nominal model alone, SI */
    int in_range; /* 1: every channel lay in its training range; 0: one did not; -1: ranges are not known */
} $name_answer;

/* Before the first sample of a trial. */
void $name_restart($name_state *state);

/* The answer to the next sample, `elapsed` seconds after the one before; of the first sample it says nothing. */
int $name_step($name_state *state, const double inputs[$NAME_INPUTS], double elapsed, $name_answer *answer);

/* A sample that the network does not see, for actuators outside of what it was trained on: the answer is the nominal model's.
 * Effects remember the sample; to the network it is time that passed. */
int $name_step_unseen($name_state *state, const double inputs[$NAME_INPUTS], double elapsed, $name_answer *answer);
";
