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
//! Three things differ from acm-stream. An input beyond ±1e12 is refused. A delay has room for so many samples; when they come faster, the
//! sample is refused (`ROOM`). The last bits differ, as in any other order of the same sums.

mod arm;
mod effects;
mod fragments;
mod header;
mod network;
mod nominal;
mod self_test;
mod step;
mod text;

use std::path::PathBuf;

use acm_stream::{Estimator, Parts};

use crate::{ExportError, File, Origin, fingerprint, refuse_unsupported, rehearsal, with_factor_in_scaler};

/// Default number of samples in the self-test.
const RECORDED: usize = 120;

/// Writes the header and the source.
///
/// # Errors
/// Parts that make no estimator, a name that is no identifier, or a part that cannot be written as C yet.
pub fn export(parts: &Parts, origin: &Origin) -> Result<Vec<File>, ExportError> {
    origin.validate()?;
    Estimator::new(parts.clone())?;
    refuse_unsupported(parts, "C99")?;
    let hash = fingerprint(parts)?;
    let samples = rehearsal::samples(parts, origin.recorded.unwrap_or(RECORDED));
    let actuators = parts.signals.actuators.len();
    let met: Vec<Vec<f64>> = samples.iter().map(|sample| sample.inputs[..actuators].to_vec()).collect();
    let nominal = nominal::write(&parts.nominal, &parts.signals, &met)?;
    let network = network::write(parts);
    let answers = rehearsal::answers(parts, &samples)?;
    let parts = &with_factor_in_scaler(parts);
    let banner = text::banner(parts, origin, &hash);
    let header = header::write(parts, origin, &nominal, &banner);
    let needs: Vec<&'static str> = nominal.needs.iter().chain(&network.needs).copied().collect();
    let source = [
        banner,
        format!("#include \"{}.h\"\n\n#include <stdint.h>\n#include <string.h>\n", origin.name),
        text::section("Elementary functions"),
        fragments::all(&needs),
        text::section("Nominal model, double precision, SI units"),
        nominal.source,
        text::section("Network, single precision, standardised inputs and outputs"),
        network.source,
        text::section("One sample"),
        step::write(parts, !nominal.memory.is_empty()),
        self_test::write(parts, &samples, &answers),
    ];
    let file = |extension: &str, text: &str| {
        let text = text.replace("$name", &origin.name).replace("$NAME", &origin.name.to_uppercase());
        File { path: PathBuf::from(format!("{}.{extension}", origin.name)), bytes: text.into_bytes() }
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
