//! Completion of a calibrated strain model from further trials, where those of its calibration leave parameters open.
//!
//! ```text
//! θ* = argmin (1/N) Σ ‖p(q_t; θ) − p_t‖² + (ω/N') Σ ‖p(q'_t; θ) − p'_t‖²
//! ```
//!
//! | symbol | meaning | shape |
//! | --- | --- | --- |
//! | `q`, `p` | actuators and markers of the calibration | N × A, N × 3K |
//! | `q'`, `p'` | the same of further trials, which may show what the model lacks | N' × A, N' × 3K |
//! | `ω` | weight of a further trial, [`FURTHER`] | 1 |
//!
//! An actuator that the calibration holds at n values leaves one direction of a polynomial of degree n open: the one that is zero
//! at all of them. The further trials determine it. Where the calibration has data, it outweighs them. Outside, the markers of the
//! calibrated model may be too far off for a descent; a calibration to all trials alike is another start.

use std::iter;

use nalgebra::stack;

use crate::fitting::calibration::identified;
use crate::fitting::levenberg_marquardt::Options;
use crate::fitting::multi_start::multi_start;
use crate::fitting::observations::Observations;
use crate::fitting::strain_fit::StrainFit;
use crate::tip_model::StrainModel;

/// Weight of further trials: with ten times the error of the calibration they count as much. On development seeds (14002 and
/// 14005, several causes, paper) a tenth and ten times of it find a start as good, and up to two causes more or less.
pub const FURTHER: f64 = 1e-2;

/// Returns the model with its parameters fitted to its calibration, and to further trials with the weight [`FURTHER`]. The fit
/// starts from the model, and from `other` where given; the better result is kept.
///
/// # Panics
/// Where actuators or markers of the two are not those of the model.
#[expect(clippy::toplevel_ref_arg, reason = "nalgebra::stack! writes it")]
pub fn completed(
    model: &StrainModel,
    calibration: &Observations,
    further: &Observations,
    other: Option<&StrainModel>,
) -> StrainModel {
    let all = Observations {
        actuators: stack![calibration.actuators; further.actuators],
        measured: stack![calibration.measured; further.measured],
        at: calibration.at.clone(),
    };
    let [own, others] = [calibration.samples(), further.samples()];
    let weight = (FURTHER * own as f64 / others.max(1) as f64).sqrt();
    let weights: Vec<f64> = (0..own + others).map(|t| if t < own { 1.0 } else { weight }).collect();
    let of = |model| StrainFit::new(model, identified(model), &all);
    let problem = of(model).weighted(&weights);
    let starts: Vec<Vec<f64>> = iter::once(model).chain(other).map(|start| of(start).start()).collect();
    let best = multi_start(&problem, &starts, &problem.bounds(), &Options::default());
    best.map_or_else(|| model.clone(), |fit| model.clone().with_parameters(&problem.all(&fit.theta)))
}
