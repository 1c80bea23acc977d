//! Meaning of each verdict.

use acm_trace::finding::{Finding, Probe, Verdict};

/// A verdict in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Words {
    /// Label on the badge.
    pub label: &'static str,
    /// Meaning of the verdict.
    pub means: &'static str,
    /// Recommended next step.
    pub next: &'static str,
    /// Class of the badge: `clear`, `part` or `open`.
    pub class: &'static str,
}

/// Returns the words for the verdict of a finding.
pub fn words(finding: &Finding) -> Words {
    match finding.verdict {
        Verdict::UnmeasuredDisturbance if !nothing_predicts(finding) => UNEXPLAINED,
        verdict => of_verdict(verdict),
    }
}

/// Returns whether both a linear regression and a network were run, and neither predicts the remaining residual.
fn nothing_predicts(finding: &Finding) -> bool {
    let nothing = |probe: &Option<Probe>| probe.as_ref().is_some_and(|probe| !probe.finds());
    nothing(&finding.left.probe) && nothing(&finding.left.network)
}

/// Words for an unmeasured disturbance that not every test has confirmed.
const UNEXPLAINED: Words = Words {
    label: "unexplained",
    means: "What is left is no noise, for it lasts. No effect that the tool knows explains it, and no linear combination of \
            recorded signals with memory was shown to. A nonlinear function of them is not excluded.",
    next: "Train a network on what is left ([networks] of the configuration): if it gains nothing either, something acted that \
           was not measured, such as wind, temperature, contact, load or tension.",
    class: "open",
};

fn of_verdict(verdict: Verdict) -> Words {
    match verdict {
        Verdict::NoEffect => Words {
            label: "no effect",
            means: "What the model misses cannot be told from noise: no effect that the tool knows makes it better on \
                    trials left out, and the recorded inputs do not predict what is left.",
            next: "Keep the model as it is. To see smaller effects, record more trials, or move faster, farther and \
                   under load.",
            class: "clear",
        },
        Verdict::Named => Words {
            label: "named",
            means: "What was found explains at least 95 % of what the model missed on trials left out (of the mean square \
                    over the noise), or all but noise.",
            next: "Put the effect into the model, with the values below. Check first whether something else explains \
                   as much.",
            class: "clear",
        },
        Verdict::FormImperfect => Words {
            label: "named, form imperfect",
            means: "The effect is clear, and most of the error is gone; but the robot does not follow quite the \
                    equation that the tool has for it, and a little more than noise is left.",
            next: "Use the effect, and take its values as the best within this form. What is left shows where the \
                   form fails.",
            class: "part",
        },
        Verdict::Partial => Words {
            label: "partial",
            means: "What was found explains a part of the error, and the rest has another cause, which no effect that \
                    the tool knows explains; or it only imitates the cause.",
            next: "Use the effect with care: its values may have taken up some of what is missing. See what remains \
                   below.",
            class: "part",
        },
        Verdict::UnknownStructure => Words {
            label: "unknown structure",
            means: "The recorded inputs predict what the model misses, so it is a property of the robot and not \
                    chance; but no effect that the tool knows has this form.",
            next: "Look at the formula, where there is one, and at the residual against the actuators. A network can \
                   learn it.",
            class: "open",
        },
        Verdict::Event => Words {
            label: "event",
            means: "What the model misses happened in a few places: a slip, a vibration, a shift in one trial. It is \
                    no property that a model could have.",
            next: "Look at the recording in the places named below. Repair or leave out what happened there, and run \
                   again.",
            class: "open",
        },
        Verdict::UnmeasuredDisturbance => Words {
            label: "unmeasured disturbance",
            means: "What is left is no noise, for it lasts; yet neither a regression nor a network predicts it from what was \
                    recorded. Something acted that was not measured.",
            next: "Measure more: wind, temperature, contact, load, tension. No model can be better with these inputs \
                   alone.",
            class: "open",
        },
    }
}
