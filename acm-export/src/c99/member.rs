//! One estimator of the source, or one member of an average.

use acm_stream::{AverageParts, MemberParts};

use super::{Written, memory, network, nominal, prefixed::prefixed, step, text};
use crate::rehearsal::Sample;
use crate::{ExportError, with_factor_in_scaler};

/// Text of an estimator. Where it is a member of an average, names at file scope have a prefix of their own.
pub struct Member {
    /// Type of the memory, and what that needs: for the header.
    pub types: String,
    /// Definitions of the header that the memory uses.
    pub macros: String,
    /// Tables and functions, up to the function `take`.
    pub source: String,
    /// Names of the fragments.
    pub needs: Vec<&'static str>,
}

/// Writes all estimators of an average; that of a single one has no prefix.
pub fn all(average: &AverageParts, samples: &[Sample]) -> Result<Vec<Member>, ExportError> {
    if let Some(one) = is_single(average) {
        return Ok(vec![write(one, samples)?.named("$whole", "$WHOLE")]);
    }
    let of = |(k, member): (usize, &MemberParts)| {
        let written = write(member, samples)?;
        let number = k + 1;
        let heading = text::section(&format!("Member {number} of {}", average.members.len()));
        let source = heading + &prefixed(&written.source, &format!("m{number}_"));
        let own = Member { source, ..written };
        Ok(own.named(&format!("$whole_member{number}"), &format!("$WHOLE_MEMBER{number}")))
    };
    average.members.iter().enumerate().map(of).collect()
}

/// Returns the member of an average of one that reads all inputs in order.
pub fn is_single(average: &AverageParts) -> Option<&MemberParts> {
    let [one] = average.members.as_slice() else { return None };
    one.places.iter().copied().eq(0..average.inputs.len()).then_some(one)
}

fn write(member: &MemberParts, samples: &[Sample]) -> Result<Member, ExportError> {
    let MemberParts { parts, places, .. } = member;
    let actuators = &places[..parts.signals.actuators.len()];
    let met: Vec<Vec<f64>> =
        samples.iter().map(|sample| actuators.iter().map(|place| sample.inputs[*place]).collect()).collect();
    let nominal = nominal::write(parts, &met)?;
    let learned = parts.has_network().then(|| with_factor_in_scaler(parts));
    let network = learned.as_ref().map_or_else(Written::default, network::write);
    let parts = learned.as_ref().unwrap_or(parts);
    let mut source = text::section("Nominal model, double precision, SI units") + &nominal.source;
    if learned.is_some() {
        source += &text::section("Network, single precision, standardised inputs and outputs");
        source += &network.source;
    }
    source += &text::section("One sample");
    source += &step::write(parts, !nominal.memory.is_empty());
    Ok(Member {
        types: memory::write(parts, &nominal),
        macros: nominal.macros,
        source,
        needs: nominal.needs.into_iter().chain(network.needs).collect(),
    })
}

impl Member {
    /// Gives the member its name, in lower and in upper case.
    fn named(self, lower: &str, upper: &str) -> Self {
        let named = |text: &str| text.replace("$name", lower).replace("$NAME", upper);
        Self { types: named(&self.types), macros: named(&self.macros), source: named(&self.source), needs: self.needs }
    }
}
