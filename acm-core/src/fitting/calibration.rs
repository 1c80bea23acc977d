//! Calibration of a nominal model: first the actuation map, then the strain parameters, then both.
//!
//! ```text
//! θ* = argmin Σ_t Σ_k ‖p_k(q_t; θ) − p_{t,k}‖²
//! ```
//!
//! 1. `explore`: all parameters from several starts on a thinned record; the best gives θ_s and the
//!    registration for what follows.
//! 2. `actuation`: θ_Φ alone.   3. `strain`: θ_s alone, Φ frozen.   4. `joint`: everything that is identified.
//!
//! Each of 2–4 is a row of the result, on all samples. Standard deviations take the residuals as
//! independent and equal: model error that repeats itself makes them too small.

use serde::{Deserialize, Serialize};

use crate::actuation::{LARGEST_DEGREE, monomial_count};
use crate::arm::ArmSpec;
use crate::fitting::levenberg_marquardt::{Fit, Options, StopReason, fit};
use crate::fitting::multi_start::{multi_start, scattered_starts};
pub use crate::fitting::observations::{CalibrationError, Observations};
pub use crate::fitting::order_study::{OrderFit, OrderFits, OrderRow, order_fits, order_study};
use crate::fitting::strain_fit::StrainFit;
use crate::fitting::strain_start;
use crate::kinematics::strain::StrainBasis;
use crate::nominal::{NominalModel, NominalSpec};
use crate::polynomial::Polynomial;
use crate::registration::RegistrationSpec;
use crate::tip_model::StrainModel;

/// Most parameters of one fit.
const MOST_PARAMETERS: usize = 2000;

/// Options of the comparison of starts, which the following stages refine.
const EXPLORE: Options = Options { iterations: 50, cost: 1e-5, step: 1e-8, gradient: 1e-8, radius: 10.0 };

/// Options of a calibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationOptions {
    /// Seed of the scattered starts.
    pub seed: u64,
    /// Number of starts.
    pub starts: usize,
    /// Most samples that the starts are compared on.
    pub explored_samples: usize,
    /// Whether the joint stage follows the two steps.
    pub joint: bool,
    /// Options of each Levenberg–Marquardt fit.
    pub fit: Options,
}

impl Default for CalibrationOptions {
    fn default() -> Self {
        Self { seed: 1, starts: 6, explored_samples: 400, joint: true, fit: Options::default() }
    }
}

/// A fitted parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Name, such as `A1[q1^2*q2]`, `a1`, `tilt_x`.
    pub name: String,
    /// SI unit; `q` stands for the unit of the actuators.
    pub unit: String,
    /// Fitted value.
    pub value: f64,
    /// Standard deviation; none where the data do not determine the value or it rests on a bound.
    pub sd: Option<f64>,
}

/// One stage of the calibration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// `actuation`, `strain`, `joint` or `polynomial`.
    pub name: String,
    /// 3-D RMS error, m.
    pub rms: f64,
    /// Iterations of the optimizer.
    pub iterations: usize,
    /// Stop reason.
    pub stopped: StopReason,
    /// Number of starts that were compared.
    pub starts: usize,
}

/// A calibrated model with its fit.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Calibrated model.
    pub model: NominalModel,
    /// Fitted values.
    pub parameters: Vec<Parameter>,
    /// Stages, in the order in which they ran.
    pub stages: Vec<Stage>,
    /// Root mean square error of each output, m for an arm.
    pub rms: Vec<f64>,
    /// Root mean square distance over samples and markers.
    pub rms_total: f64,
    /// Number of samples.
    pub samples: usize,
}

/// Calibrates with the default options.
///
/// # Errors
/// The data or the model are refused, the samples are too few for its parameters, or no start has a finite error.
pub fn calibrate(spec: &NominalSpec, data: &Observations) -> Result<Calibration, CalibrationError> {
    calibrate_with(spec, data, &CalibrationOptions::default())
}

/// Calibrates the model that `spec` names on `data`.
///
/// # Errors
/// As [`calibrate`].
pub fn calibrate_with(
    spec: &NominalSpec,
    data: &Observations,
    options: &CalibrationOptions,
) -> Result<Calibration, CalibrationError> {
    data.validate()?;
    match spec {
        NominalSpec::Strain(arm) => calibrate_strain(arm, data, options),
        NominalSpec::Polynomial { degree } => calibrate_polynomial(*degree, data),
        NominalSpec::None => {
            let outputs = data.measured.ncols();
            Ok(summary(NominalModel::None { outputs }, vec![], vec![], data))
        }
    }
}

fn calibrate_polynomial(degree: usize, data: &Observations) -> Result<Calibration, CalibrationError> {
    if !(1..=LARGEST_DEGREE).contains(&degree) {
        let most = LARGEST_DEGREE;
        return Err(CalibrationError::Degree { degree, most });
    }
    let coefficients = 1 + monomial_count(data.actuators.ncols(), degree);
    enough(data.samples(), coefficients, coefficients + 1)?;
    let fit = Polynomial::fit(&data.actuators, &data.measured, degree);
    let mut parameters = Vec::new();
    for output in 0..fit.polynomial.outputs() {
        for row in 0..coefficients {
            parameters.push(Parameter {
                name: format!("c{}[{}]", output + 1, fit.polynomial.name(row)),
                unit: format!("y/q^{}", fit.polynomial.degree_of(row)),
                value: fit.polynomial.coefficients()[(row, output)],
                sd: Some(fit.deviations[(row, output)]).filter(|sd| sd.is_finite()),
            });
        }
    }
    let model = NominalModel::Polynomial(fit.polynomial);
    let mut calibration = summary(model, parameters, vec![], data);
    calibration.stages.push(Stage {
        name: "polynomial".into(),
        rms: calibration.rms_total,
        iterations: 1,
        stopped: StopReason::ClosedForm,
        starts: 1,
    });
    Ok(calibration)
}

fn calibrate_strain(
    arm: &ArmSpec,
    data: &Observations,
    options: &CalibrationOptions,
) -> Result<Calibration, CalibrationError> {
    data.validate_markers()?;
    arm.validate()?;
    let per_amplitude = monomial_count(data.actuators.ncols(), arm.degree);
    let unknowns = unknowns(arm, per_amplitude);
    enough(data.samples(), unknowns, unknowns / data.measured.ncols().max(1) + 1)?;
    let model = StrainModel::new(arm, data.actuators.ncols(), &data.at)?;
    let (mut model, starts) = explore(strain_start::start(model, data), data, options)?;
    let (actuation, strain) = (model.actuation_range(), model.strain_range());
    let mut stages = Vec::new();
    let mut run = |model: StrainModel, name: &str, free: Vec<usize>, starts| {
        let (model, fit) = fit_some(model, free, data, &options.fit);
        stages.push(stage(name, &fit, data, starts));
        (model, fit)
    };
    (model, _) = run(model, "actuation", actuation.collect(), starts);
    if !strain.is_empty() {
        (model, _) = run(model, "strain", strain.collect(), 1);
    }
    let identified = identified(&model);
    let fit = if options.joint {
        let fitted;
        (model, fitted) = run(model, "joint", identified.clone(), 1);
        fitted
    } else {
        let still = Options { iterations: 0, ..options.fit };
        fit_some(model.clone(), identified.clone(), data, &still).1
    };
    let parameters = named(&model, &identified, &fit);
    Ok(summary(NominalModel::Strain(model), parameters, stages, data))
}

/// The best of several starts on a thinned record, and their number.
fn explore(
    model: StrainModel,
    data: &Observations,
    options: &CalibrationOptions,
) -> Result<(StrainModel, usize), CalibrationError> {
    let free = identified(&model);
    // Ten residuals per parameter, so that no start wins by fitting noise.
    let least = 10 * free.len() / data.measured.ncols();
    let few = data.thinned(options.explored_samples.max(least));
    let problem = StrainFit::new(&model, free.clone(), &few);
    let spread: Vec<f64> = free.iter().map(|&j| spread(&model, j)).collect();
    let count = if spread.iter().any(|s| *s > 0.0) { options.starts.max(1) } else { 1 };
    let starts = scattered_starts(&problem.start(), &spread, count, options.seed);
    let best = multi_start(&problem, &starts, &problem.bounds(), &EXPLORE);
    let best = best.filter(|fit| fit.stopped != StopReason::NotFinite);
    let best = best.ok_or_else(|| CalibrationError::Diverged { what: "first guess".into() })?;
    let theta = problem.all(&best.theta);
    Ok((model.with_parameters(&theta), count))
}

/// How far starts are scattered: θ_s by 1.5, base by 0.2 rad and a twentieth of the length.
fn spread(model: &StrainModel, parameter: usize) -> f64 {
    let turns = model.registration_range().start + 3;
    if model.actuation_range().contains(&parameter) {
        0.0
    } else if model.strain_range().contains(&parameter) {
        1.5
    } else if parameter < turns {
        0.2
    } else {
        0.05 * model.arm().length
    }
}

/// All parameters that the calibration determines.
pub(crate) fn identified(model: &StrainModel) -> Vec<usize> {
    let registration = model.registration_range();
    let flags = model.arm().registration.identified();
    let chosen = registration.clone().filter(|j| flags[j - registration.start]);
    (0..registration.start).chain(chosen).collect()
}

fn unknowns(arm: &ArmSpec, per_amplitude: usize) -> usize {
    let registration = match arm.registration {
        RegistrationSpec::Fixed { .. } => 0,
        RegistrationSpec::Identified { twist } => 5 + usize::from(twist),
    };
    let strain = match arm.strain {
        StrainBasis::Legendre { order } => 2 * per_amplitude + 2 * order,
        StrainBasis::Piecewise { segments } => 2 * segments * per_amplitude,
    };
    registration + strain
}

fn enough(samples: usize, parameters: usize, needed: usize) -> Result<(), CalibrationError> {
    if parameters > MOST_PARAMETERS {
        let most = MOST_PARAMETERS;
        return Err(CalibrationError::TooManyParameters { parameters, most });
    }
    if samples < needed {
        return Err(CalibrationError::TooFewSamples { samples, parameters, needed });
    }
    Ok(())
}

/// Fits the parameters in `free`, with all others as they are.
pub(crate) fn fit_some(
    model: StrainModel,
    free: Vec<usize>,
    data: &Observations,
    options: &Options,
) -> (StrainModel, Fit) {
    let problem = StrainFit::new(&model, free, data);
    let fit = fit(&problem, &problem.start(), &problem.bounds(), options);
    let theta = problem.all(&fit.theta);
    (model.with_parameters(&theta), fit)
}

fn stage(name: &str, fit: &Fit, data: &Observations, starts: usize) -> Stage {
    Stage {
        name: name.into(),
        rms: (fit.cost / points(data)).sqrt(),
        iterations: fit.iterations,
        stopped: fit.stopped,
        starts,
    }
}

/// Number of measured points: samples × markers.
fn points(data: &Observations) -> f64 {
    (data.samples() * data.at.len().max(1)) as f64
}

fn named(model: &StrainModel, identified: &[usize], fit: &Fit) -> Vec<Parameter> {
    let names = model.parameter_names();
    let deviations = fit.deviations();
    let values = identified.iter().zip(deviations);
    values
        .map(|(&j, sd)| Parameter {
            name: names[j].0.clone(),
            unit: names[j].1.clone(),
            value: model.parameters()[j],
            sd,
        })
        .collect()
}

fn summary(model: NominalModel, parameters: Vec<Parameter>, stages: Vec<Stage>, data: &Observations) -> Calibration {
    let error = model.predict(&data.actuators) - &data.measured;
    let samples = data.samples() as f64;
    Calibration {
        rms: error.column_iter().map(|c| c.norm() / samples.sqrt()).collect(),
        rms_total: (error.norm_squared() / points(data)).sqrt(),
        samples: data.samples(),
        model,
        parameters,
        stages,
    }
}
