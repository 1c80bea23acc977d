//! Export of the whole estimator as C99: one header and one source.
//!
//! ```text
//! y_k = p_k + r_k,   r_k = spread · network(z_k, Δt_k, h_{k−1}) + mean,   z = (x − mean)/spread
//! ```
//!
//! | part                                       | precision |
//! | ------------------------------------------ | --------- |
//! | nominal model, effects, channels, scalers  | double    |
//! | network                                    | float     |
//!
//! The source allocates nothing, keeps its memory in a struct of the caller and calls no function but `memcpy` and `memset`:
//! elementary functions are its own, those of the network the approximations that acm-kernels has. Tables are constant. Gaps,
//! irregular steps, samples that the network does not see, and windows are treated as acm-stream treats them.
//!
//! A nominal model without a network ([`Parts::alone`]) leaves as it is. An average of several estimators is one source, in which what
//! belongs to a member has a prefix of its own (`m1_`, `m2_`, …).
//!
//! Three things differ from acm-stream. An input beyond ±1e12 is refused. A delay has room for so many samples; when they come faster, the
//! sample is refused (`ROOM`). The last bits differ, as in any other order of the same sums.

mod arm;
mod average;
mod effects;
mod fragments;
mod header;
mod member;
mod memory;
mod names;
mod network;
mod nominal;
mod prefixed;
mod self_test;
mod step;
mod text;

use std::path::PathBuf;

use acm_stream::{Average, AverageParts, Estimator, Parts};

use crate::{ExportError, File, Origin, fingerprint, fingerprint_of_average, refuse_unsupported, rehearsal};

/// Default number of samples in the self-test.
const RECORDED: usize = 120;

/// How both files of an export begin.
const HEAD: &str = "/* A trained estimator, written by acm-export ";

/// The functions of the header.
const FUNCTIONS: &str = include_str!("c99/runtime/functions.c");

/// Writes the header and the source.
///
/// # Errors
/// Parts that make no estimator, a name that is no identifier, or a part that cannot be written as C yet.
pub fn export(parts: &Parts, origin: &Origin) -> Result<Vec<File>, ExportError> {
    Estimator::new(parts.clone())?;
    written(&AverageParts::of_one(parts.clone()), origin, &fingerprint(parts)?)
}

/// Writes the header and the source of the average of several estimators.
///
/// # Errors
/// As [`export`], and parts that make no average.
pub fn export_average(average: &AverageParts, origin: &Origin) -> Result<Vec<File>, ExportError> {
    Average::new(average.clone())?;
    written(average, origin, &fingerprint_of_average(average)?)
}

fn written(average: &AverageParts, origin: &Origin, hash: &str) -> Result<Vec<File>, ExportError> {
    origin.validate()?;
    average.members.iter().try_for_each(|member| refuse_unsupported(&member.parts, "C99"))?;
    let samples = rehearsal::samples_of_average(average, origin.recorded.unwrap_or(RECORDED));
    let answers = rehearsal::answers_of_average(average, &samples)?;
    let members = member::all(average, &samples)?;
    let banner = text::banner(average, origin, hash);
    let header = header::write(average, &members, origin, &banner);
    let needs: Vec<&'static str> = members.iter().flat_map(|member| &member.needs).copied().collect();
    let source = [
        banner,
        format!("#include \"{}.h\"\n\n#include <stdint.h>\n#include <string.h>\n", origin.name),
        text::section("Elementary functions"),
        fragments::all(&needs),
        members.iter().map(|member| member.source.as_str()).collect(),
        average::write(average),
        "\n".into(),
        FUNCTIONS.into(),
        self_test::write(average.members[0].parts.tip.len(), &samples, &answers),
    ];
    let file = |extension: &str, text: &str| {
        let text = text.replace("$whole", &origin.name).replace("$WHOLE", &origin.name.to_uppercase());
        File { path: PathBuf::from(format!("{}.{extension}", origin.name)), bytes: text.into_bytes(), marks: &[HEAD] }
    };
    Ok(vec![file("h", &header), file("c", &source.concat())])
}

/// Parts of the C source, with the fragments that they need.
#[derive(Debug, Default)]
struct Written {
    /// Tables and functions.
    source: String,
    /// Types of the effects' states, and the members of the memory that have them; empty where no effect has a state.
    memory: String,
    members: String,
    /// Definitions of the header that the memory uses.
    macros: String,
    /// Names of the fragments.
    needs: Vec<&'static str>,
}
