//! The memory of one estimator, as types of the header.

use acm_stream::{Parts, StateRule};

use super::Written;
use super::network::state_size;

const ONE: &str = "
/* All memory of one estimator. Set it up by $whole_restart. */
typedef struct {
    int started;                          /* whether the trial has begun */
    double time;                          /* since its first sample, s */
    unsigned long history;                /* samples that the network saw since the first, or since the last gap */
@NETWORK@EFFECTS} $name_state;
";

/// Returns the type of the memory of one estimator, with the types that it needs.
pub fn write(parts: &Parts, nominal: &Written) -> String {
    let mut text = nominal.memory.clone();
    let effects = if nominal.members.is_empty() {
        String::new()
    } else {
        text += &format!(
            "\n/* What the effects of the nominal model remember. */\ntypedef struct {{\n{}}} $name_memory;\n",
            nominal.members
        );
        "    $name_memory memory;\n".into()
    };
    let network = if parts.has_network() { network_memory(parts) } else { String::new() };
    text + &ONE.replace("@EFFECTS", &effects).replace("@NETWORK", &network)
}

/// Returns what a network needs to remember.
fn network_memory(parts: &Parts) -> String {
    let state = state_size(parts);
    let hidden = match parts.state {
        _ if state == 0 => String::new(),
        StateRule::Running => format!("    float hidden[{state}];                 /* the network's state */\n"),
        StateRule::Window(length) => format!(
            "    int kept, next;                       /* samples of the window, the newest before `next` */\n    \
             float channels[{length}][{}], steps[{length}];\n",
            parts.channels.len()
        ),
    };
    format!(
        "    double unseen;                        /* time since the last of them, s */\n    \
         double before[{}]; /* inputs of the last of them */\n{hidden}",
        parts.width()
    )
}
