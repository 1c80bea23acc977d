//! Claims of a finding and the truth, independent of their file formats.

use acm_trace::finding::Doubt;
use serde::{Deserialize, Deserializer, Serialize};

use super::matching::matching;
use crate::scoring::aliases::ALIAS;

/// One effect that is claimed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// Name in the effect library.
    pub name: String,
    /// The signal that carries it, where one is named.
    pub signal: Option<String>,
    /// Whether it is named with confidence `sure`.
    pub sure: bool,
    /// Share of resamples in which it is chosen again.
    pub share: f64,
    /// Why it is not sure.
    #[serde(default)]
    pub doubts: Vec<Doubt>,
}

/// An effect that the data cannot distinguish from the true one, by the table of aliases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alias {
    /// Name in the effect library.
    pub name: String,
    /// Smaller of the shares of each that the other explains.
    pub share: f64,
}

/// One cause that acts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrueCause {
    /// The effect that should be named; that of a mechanism outside of the library is none's.
    pub name: Option<String>,
    /// The signal that it acts on, where it matters.
    pub signal: Option<String>,
    /// Effects that explain much of it, and of which it explains much.
    pub also: Vec<Alias>,
    /// Whether its absence shows, according to the simulator.
    pub absence_shows: bool,
    /// Standard errors by which its absence worsens blocks left out, by the simulator.
    pub missed: f64,
    /// Largest share of it that another effect explains, by the table of aliases.
    pub imitated: f64,
}

impl TrueCause {
    /// Returns it with further effects whose formula contains it as right names.
    #[must_use]
    pub fn contained_in(mut self, effects: &[String]) -> Self {
        self.also.extend(effects.iter().map(|name| Alias { name: name.clone(), share: 1.0 }));
        self
    }

    /// Returns whether it has to be found: its absence shows, and no other effect in its place comes within one
    /// standard error.
    ///
    /// What another effect does not explain of it, a share 1 − s of the square, is missed by t·√(1 − s) standard errors where the
    /// whole is missed by t: the standard error of the difference of two losses is 2σ‖r‖ to first order.
    pub fn is_separable(&self) -> bool {
        self.absence_shows && self.name.is_some() && self.missed * (1.0 - self.imitated).max(0.0).sqrt() > 1.0
    }

    /// Returns the mutual share by which a name stands for it: 1 for its own, 0 for one that does not.
    pub fn share(&self, name: &str) -> f64 {
        let alias = || self.also.iter().filter(|alias| alias.name == name).map(|alias| alias.share).fold(0.0, f64::max);
        if self.name.as_deref() == Some(name) { 1.0 } else { alias() }
    }

    /// Returns whether a claim is right for it. Signals are compared where both sides name one.
    pub fn is(&self, claim: &Claim) -> bool {
        let same = match (&self.signal, &claim.signal) {
            (Some(one), Some(two)) => one == two,
            _ => true,
        };
        same && self.share(&claim.name) >= ALIAS
    }
}

/// An interval that was claimed for a true value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// True value.
    pub truth: f64,
    /// A fitted value may differ by this much and be right, as the truth's formula is another one.
    pub tolerance: f64,
    /// Interval of 95 %.
    #[serde(deserialize_with = "ends")]
    pub interval: [f64; 2],
    /// Width of the ideal interval: 3.92 standard deviations of the estimates of a fit with the true structure, over
    /// redraws of the noise.
    pub ideal: Option<f64>,
}

/// Answer for one campaign or rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Kind of the campaign or rig.
    pub kind: String,
    /// True causes.
    pub causes: Vec<TrueCause>,
    /// Claims.
    pub claims: Vec<Claim>,
    /// Intervals of values that have a counterpart.
    pub intervals: Vec<Interval>,
    /// Removed share F = (b² − a²)/(b² − floor²) on held-out trials; none where there was nothing to remove.
    pub removed: Option<f64>,
    /// Error on held-out trials over that of the best baseline.
    pub over_best: Option<f64>,
}

/// Reads the ends of an interval; JSON has no infinity, and writes null.
///
/// # Errors
/// What is written there are no two numbers.
pub fn ends<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
    let [low, high] = <[Option<f64>; 2]>::deserialize(from)?;
    Ok([low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY)])
}

/// Counts of right and wrong names of one answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Names {
    /// Number of names that are sure.
    pub sure: usize,
    /// Sure names that stand for no cause, with their signals.
    pub wrong: Vec<String>,
    /// Number of causes that have to be found.
    pub separable: usize,
    /// Number of separable causes that a sure name stands for.
    pub found: usize,
    /// Number of causes whose absence shows, also where another effect explains it as well.
    pub shown: usize,
    /// Number of those causes that a sure name stands for: the true one, or an indistinguishable effect.
    pub shown_found: usize,
}

impl Names {
    /// Compares the sure names of an answer with its causes; each name stands for one cause at most.
    pub fn new(answer: &Answer) -> Self {
        let sure: Vec<&Claim> = answer.claims.iter().filter(|claim| claim.sure).collect();
        // Separable causes first, so that none goes without for one that is not.
        let mut causes: Vec<&TrueCause> = answer.causes.iter().collect();
        causes.sort_by_key(|cause| (!cause.is_separable(), !cause.absence_shows));
        let stands = matching(sure.len(), causes.len(), |claim, cause| causes[cause].is(sure[claim]));
        let wrong = sure.iter().zip(&stands).filter(|(_, cause)| cause.is_none()).map(|(claim, _)| written(claim));
        let found = |of: fn(&TrueCause) -> bool| stands.iter().flatten().filter(|cause| of(causes[**cause])).count();
        let there = |of: fn(&TrueCause) -> bool| causes.iter().filter(|cause| of(cause)).count();
        Self {
            sure: sure.len(),
            wrong: wrong.collect(),
            separable: there(TrueCause::is_separable),
            found: found(TrueCause::is_separable),
            shown: there(|cause| cause.absence_shows),
            shown_found: found(|cause| cause.absence_shows),
        }
    }

    /// Computes 2·TP/(2·TP + FP + FN) of sure names against separable causes; one where nothing is to be found and
    /// nothing is wrong. A sure name for a cause that need not be found counts on neither side.
    pub fn f1(&self) -> f64 {
        let (hit, wrong, missed) = (self.found, self.wrong.len(), self.separable - self.found);
        if wrong + missed == 0 { 1.0 } else { 2.0 * hit as f64 / (2 * hit + wrong + missed) as f64 }
    }

    /// Returns whether every cause whose absence shows has a sure name, its own or an indistinguishable effect, and
    /// nothing is wrong.
    pub fn is_exact(&self) -> bool {
        self.wrong.is_empty() && self.shown_found == self.shown
    }
}

/// Returns whether each claim of an answer, sure or not, is right.
pub fn rights(answer: &Answer) -> Vec<bool> {
    causes_of(answer).iter().map(Option::is_some).collect()
}

/// Returns whether every cause whose absence shows is named, and every name is right, sure or not.
pub fn is_named(answer: &Answer) -> bool {
    let of = causes_of(answer);
    let named = |k: usize| of.contains(&Some(k));
    let shown = answer.causes.iter().enumerate().filter(|(_, cause)| cause.absence_shows);
    of.iter().all(Option::is_some) && shown.map(|(k, _)| k).all(named)
}

/// Returns the cause that each claim stands for; each stands for one cause at most. Causes whose absence shows come
/// first, so that none goes without for another.
fn causes_of(answer: &Answer) -> Vec<Option<usize>> {
    let mut order: Vec<usize> = (0..answer.causes.len()).collect();
    order.sort_by_key(|&k| !answer.causes[k].absence_shows);
    let stands = |claim: usize, cause: usize| answer.causes[order[cause]].is(&answer.claims[claim]);
    let of = matching(answer.claims.len(), answer.causes.len(), stands);
    of.into_iter().map(|cause| cause.map(|cause| order[cause])).collect()
}

fn written(claim: &Claim) -> String {
    claim.signal.as_ref().map_or(claim.name.clone(), |signal| format!("{} of {signal}", claim.name))
}

/// Returns a claim, for tests.
#[cfg(test)]
pub fn claim(name: &str, signal: Option<&str>, sure: bool, share: f64) -> Claim {
    Claim { name: name.into(), signal: signal.map(Into::into), sure, share, doubts: vec![] }
}

/// Returns a cause whose absence costs ten standard errors, for tests; the effects `also` are indistinguishable from
/// it.
#[cfg(test)]
pub fn cause(name: &str, signal: Option<&str>, also: &[&str], absence_shows: bool) -> TrueCause {
    let imitated = if also.is_empty() { 0.0 } else { 1.0 };
    let also = also.iter().map(|name| Alias { name: (*name).to_string(), share: 1.0 }).collect();
    TrueCause { name: Some(name.into()), signal: signal.map(Into::into), also, absence_shows, missed: 10.0, imitated }
}

/// Returns an answer, for tests.
#[cfg(test)]
pub fn answer(kind: &str, causes: Vec<TrueCause>, claims: Vec<Claim>) -> Answer {
    Answer { kind: kind.into(), causes, claims, intervals: vec![], removed: None, over_best: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Three causes of which two have to be found; a right name, one for a cause that need not be found,
    /// one on the wrong signal, one that is not sure.
    #[test]
    fn names_by_hand() {
        let causes = vec![
            cause("creep", None, &[], false),
            cause("coulomb_friction", Some("q2"), &[], true),
            cause("dead_time", None, &[], true),
            cause("actuator_lag", None, &["measurement_lag"], true),
        ];
        let claims = vec![
            claim("coulomb_friction", Some("q1"), true, 1.0),
            claim("dead_time", Some("q1"), true, 0.99),
            claim("creep", None, true, 0.97),
            claim("measurement_lag", None, false, 0.6),
        ];
        let answer = answer("several4", causes, claims);
        let names = Names::new(&answer);
        assert_eq!((names.sure, names.separable, names.found), (3, 2, 1));
        assert_eq!((names.shown, names.shown_found), (3, 1), "the lag is named, and not for sure");
        assert_eq!(names.wrong, ["coulomb_friction of q1"]);
        assert!((names.f1() - 2.0 / 4.0).abs() < 1e-12 && !names.is_exact());
        assert_eq!(rights(&answer), [false, true, true, true]);
    }

    /// Oracle: by hand. An effect that contains the cause is a right name for it, and no reason not to find it.
    #[test]
    fn an_effect_that_contains_the_cause_is_right() {
        let lag = cause("actuator_lag", None, &[], true).contained_in(&["second_order_lag".into()]);
        let is = |name: &str| lag.is(&claim(name, None, true, 1.0));
        assert_eq!(["actuator_lag", "second_order_lag", "dead_time"].map(is), [true, true, false]);
        assert!(lag.is_separable());
    }

    /// Oracle: by hand. The lag is named by its alias and not for sure; without that name, or with one too many, not all is named.
    #[test]
    fn all_is_named_where_every_name_is_right_and_no_cause_goes_without() {
        let causes = vec![
            cause("creep", None, &[], false),
            cause("actuator_lag", None, &["measurement_lag"], true),
            cause("dead_time", None, &[], true),
        ];
        let claims = [
            claim("measurement_lag", None, false, 0.6),
            claim("dead_time", Some("q1"), true, 0.99),
            claim("backlash", None, false, 0.5),
        ];
        for (many, all) in [(1, false), (2, true), (3, false)] {
            assert_eq!(is_named(&answer("several3", causes.clone(), claims[..many].to_vec())), all, "{many}");
        }
    }

    #[test]
    fn nothing_to_find_and_nothing_said_is_exact() {
        let names = Names::new(&answer("white", vec![], vec![claim("scale", None, false, 0.7)]));
        assert!(names.is_exact() && names.f1() == 1.0);
        let said = Names::new(&answer("white", vec![], vec![claim("scale", None, true, 0.96)]));
        assert!(!said.is_exact() && said.f1() == 0.0);
    }

    /// Oracle: by hand. One name for two causes that it could stand for takes the one that has to be found.
    #[test]
    fn a_name_stands_for_the_cause_that_has_to_be_found() {
        let causes = vec![cause("backlash", None, &["creep"], true), cause("creep", None, &[], true)];
        let names = Names::new(&answer("several2", causes, vec![claim("creep", None, true, 1.0)]));
        assert_eq!((names.found, names.separable), (1, 1));
    }

    /// Oracle: by hand. Missed by ten standard errors, another effect that explains 0.98 of it is missed by √2 of them, one that
    /// explains 0.995 by 0.71.
    #[test]
    fn a_cause_is_separable_where_no_other_effect_comes_within_one_standard_error() {
        let imitated = |imitated: f64| TrueCause { imitated, ..cause("creep", None, &[], true) };
        assert!(imitated(0.98).is_separable() && !imitated(0.995).is_separable());
        assert!(!TrueCause { absence_shows: false, ..imitated(0.0) }.is_separable());
    }

    /// Oracle: by hand, at the threshold of an alias.
    #[test]
    fn an_alias_is_right_from_its_share_on() {
        let with = |share: f64| TrueCause {
            also: vec![Alias { name: "lag".into(), share }],
            ..cause("creep", None, &[], true)
        };
        assert!(with(0.98).is(&claim("lag", None, true, 1.0)) && !with(0.979).is(&claim("lag", None, true, 1.0)));
        assert_eq!((with(0.5).share("lag"), with(0.5).share("creep"), with(0.5).share("drift")), (0.5, 1.0, 0.0));
    }

    /// Oracle: what was written, infinite ends included.
    #[test]
    fn an_answer_is_read_as_it_was_written() {
        let interval = Interval { truth: 1.0, tolerance: 0.0, interval: [f64::NEG_INFINITY, 2.0], ideal: None };
        let answer = Answer { intervals: vec![interval], ..answer("white", vec![], vec![]) };
        let text = serde_json::to_string(&answer).expect("it can be written");
        assert_eq!(serde_json::from_str::<Answer>(&text).expect("it can be read"), answer);
    }
}
