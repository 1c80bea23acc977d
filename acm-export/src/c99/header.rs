//! The header: counts, the state, and three functions.

use acm_stream::AverageParts;

use super::member::{Member, is_single};
use super::names;
use crate::Origin;

/// Types of the states of effects: name, definition, comment.
const TYPES: &[(&str, &str, &str)] = &[
    (
        "$whole_lag",
        "    int started;\n    double time, x, y;\n",
        "A signal that follows another: its time and value, and where it is.",
    ),
    ("$whole_spring", "    int started;\n    double time, x, y, speed;\n", "The same on a spring."),
    ("$whole_play", "    int started;\n    double rest;\n", "Where a play rests."),
    ("$whole_slip", "    int started;\n    double x, z;\n", "A friction: the signal before, and how far it is loaded."),
    ("$whole_slope", "    int count;\n    double time[3], x[3];\n", "The last three samples."),
];

/// Returns the header's text.
pub fn write(average: &AverageParts, members: &[Member], origin: &Origin, banner: &str) -> String {
    let guard = format!("{}_H", origin.name.to_uppercase());
    let count = |name: &str, value: usize, what: &str| format!("#define $WHOLE_{name} {value} /* {what} */\n");
    let mut text = format!("{banner}\n#ifndef {guard}\n#define {guard}\n\n");
    text += &count("INPUTS", average.inputs.len(), "numbers of a sample");
    text += &count("OUTPUTS", average.members[0].parts.tip.len(), "numbers of an answer");
    text += &names::inputs(average);
    text += &names::outputs(average);
    text += &RESULTS.replace("@MEMBERS", if members.len() > 1 { LATER } else { "" });
    text += &members.iter().map(|member| member.macros.as_str()).collect::<String>();
    for (name, definition, what) in TYPES {
        if members.iter().any(|member| member.types.contains(&format!("{name} "))) {
            text += &format!("\n/* {what} */\ntypedef struct {{\n{definition}}} {name};\n");
        }
    }
    text += &members.iter().map(|member| member.types.as_str()).collect::<String>();
    text += &state(average);
    let answered = match (is_single(average), average.members.iter().any(|member| member.parts.has_network())) {
        (None, _) => ["weighted mean of the members, SI", "weighted mean of their nominal models alone, SI"],
        (_, true) => ["nominal model and network, SI", "nominal model alone, SI"],
        (_, false) => ["nominal model, SI; there is no network", "the same"],
    };
    text += &FUNCTIONS.replace("@OUTPUT", answered[0]).replace("@NOMINAL", answered[1]);
    text + &format!("\n#endif /* {guard} */\n")
}

/// Returns the type of the memory of an average; a single estimator has its own.
fn state(average: &AverageParts) -> String {
    if is_single(average).is_some() {
        return String::new();
    }
    let member = |k: usize| format!("    $whole_member{k}_state member{k};\n");
    let members: String = (1..=average.members.len()).map(member).collect();
    format!(
        "\n/* All memory of the average. Set it up by $whole_restart. */\ntypedef struct {{\n    \
         unsigned long history; /* smallest number of samples that a member saw since the first, or since its last gap */\n{members}}} \
         $whole_state;\n"
    )
}

const RESULTS: &str = "
/* What a step returns. A sample that is refused changes nothing; but where an output of the nominal model or of the network
 * would not be finite, effects begin anew.@MEMBERS */
enum {
    $WHOLE_OK = 0,
    $WHOLE_INPUT = 1,   /* an input is no number, or beyond +-1e12: leave the sample out, add its time to that of the next */
    $WHOLE_TIME = 2,    /* the time since the sample before is not above 0 s: leave the sample out, or restart */
    $WHOLE_NOMINAL = 3, /* the nominal model's output is not finite */
    $WHOLE_CHANNEL = 4, /* an input of the network is not finite */
    $WHOLE_OUTPUT = 5,  /* the answer is not finite */
    $WHOLE_ROOM = 6     /* samples come faster than an effect has room for: raise $WHOLE_..._ROOM */
};
";

const LATER: &str = " Where a later member of the average refuses what an earlier\n * one took, all begin anew.";

const FUNCTIONS: &str = "
typedef struct {
    double output[$WHOLE_OUTPUTS];  /* @OUTPUT */
    double nominal[$WHOLE_OUTPUTS]; /* @NOMINAL */
    int in_range; /* 1: every channel lay in its training range; 0: one did not; -1: ranges are not known */
} $whole_answer;

/* Before the first sample of a trial. */
void $whole_restart($whole_state *state);

/* The answer to the next sample, `elapsed` seconds after the one before; of the first sample it says nothing. */
int $whole_step($whole_state *state, const double inputs[$WHOLE_INPUTS], double elapsed, $whole_answer *answer);

/* A sample that the network does not see, for actuators outside of what it was trained on: the answer is the nominal model's.
 * Effects remember the sample; to the network it is time that passed. */
int $whole_step_unseen($whole_state *state, const double inputs[$WHOLE_INPUTS], double elapsed, $whole_answer *answer);
";
