//! `acm-eval separability`: effects that these trials can distinguish, before any claim is made from them.

use acm_eval::{
    closed_loop::{claim_separability, separability_summary, write_separability},
    error::EvalError,
    question::Asked,
    terminal::print,
};
use acm_trace::finding::Separability;

use super::steps::Steps;

/// Text above the options, in full.
pub const ABOUT: &str = "\
Says which physical effects your trials could tell apart at all, and which experiment would tell the rest apart

Every effect that can act on the rig is given the same size, 10 mm root mean square (a tenth of the spread of outputs \
that are no lengths), and every other effect is asked how much of it it could take over, calibration included. Only the \
excitation decides: how the actuators and the carrier moved. Run it before close-loop, and before the next campaign.";

/// Examples below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval separability my-robot                          your recordings: a folder with manifest.toml
  acm-eval separability my-robot --data ~/recordings      the same, with the tables elsewhere
  acm-eval separability --config experiments/close-the-loop.toml
      with the nominal model and effects of that file
  acm-eval separability my-robot --set 'effects.only=[\"backlash\",\"actuator_lag\"]'

How to read it: a share of 97 % in the row of backlash and the column of actuator_lag says that a lag, fitted to what a
play does in these trials, leaves 3 % of its mean square. Effects of one group imitate each other by 90 % or more of
what recalibration leaves: a claim for one of them is a claim for any of them.

Results in DIR: separability.html for people, with its figures (figures/, SVG and PNG) and tables (tables/, CSV) beside it,
and separability.json for programs.

Exit codes: 0 done; 2 usage or configuration; 3 data (with file, row and column); 4 file system.";

/// Writes the result; prints the groups, the strongest confusions and where the page is.
pub fn run(asked: &Asked) -> Result<(), EvalError> {
    let question = asked.read("separability", |warning| eprintln!("warning: {warning}"))?;
    claim_separability(&question.out)?;
    let (out, steps) = (question.out.clone(), Steps::new(&question.recordings.case.rig));
    steps.begin("asking of every effect how much of it the others could imitate");
    let found = question.separability();
    steps.end();
    let found = found?;
    let page = write_separability(&found, &out)?;
    print(&format!("{}\n", separability_summary(&found)))?;
    if let Some(matrix) = matrix(&found) {
        print(&format!("{matrix}\n"))?;
    }
    print(&page.display().to_string())
}

/// Effects in the matrix of the terminal, at most: so many columns fit 100 letters with the names.
const SHOWN: usize = 10;

/// Returns the effects that are confused most, in percent; none for fewer than two.
fn matrix(found: &Separability) -> Option<String> {
    let count = found.effects.len();
    if count < 2 {
        return None;
    }
    // Of what recalibration leaves; what it takes over whole is in a group of its own.
    let of_rest = |a: usize, b: usize| {
        let taken = found.by_recalibration[a];
        if taken < 0.9 { (found.imitated[a][b] - taken) / (1.0 - taken) } else { 0.0 }
    };
    let mutual = |a: usize, b: usize| of_rest(a, b).min(of_rest(b, a));
    let worst = |a: usize| (0..count).filter(|&b| b != a).map(|b| mutual(a, b)).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| worst(b).total_cmp(&worst(a)));
    order.truncate(SHOWN);
    order.sort_unstable();
    let mut text = String::from("How many percent of the effect of a row the effects of the columns imitate:\n");
    let widest = order.iter().map(|&a| found.effects[a].chars().count()).max().unwrap_or(0);
    text.push_str(&" ".repeat(widest + 3));
    (1..=order.len()).for_each(|column| text.push_str(&format!("{column:>5}")));
    text.push_str("   calibration");
    for (row, &a) in order.iter().enumerate() {
        text.push_str(&format!("\n{:>2} {:<widest$}", row + 1, found.effects[a]));
        for &b in &order {
            let share = format!("{:.0}", 100.0 * found.imitated[a][b]);
            text.push_str(&format!("{:>5}", if a == b { "·" } else { &share }));
        }
        text.push_str(&format!("{:>14.0}", 100.0 * found.by_recalibration[a]));
    }
    Some(text)
}
