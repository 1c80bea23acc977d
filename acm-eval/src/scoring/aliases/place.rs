//! Trials on which effects are planted, of development seeds; nothing of their recorded outputs enters but the calibration of the
//! nominal model.

use acm_datasets::generate::small_rig;
use acm_datasets::generate::undeclared::generate;
use acm_sim::small_rigs::{self, simulate};
use acm_sim::twin::undeclared::{Design, Kind, Null};
use acm_trace::fit::form::Form;
use acm_trace::fit::problem::Problem;
use acm_trace::fit::state::State;
use acm_trace::prepared::{Prepared, prepare};
use acm_trace::search::nuisance::largest_polynomial;
use acm_trace::series::{Series, number_blocks};
use acm_trace::trace::Options;

use crate::error::EvalError;
use crate::question::recordings::recordings;
use crate::scoring::seeds::Seeds;

/// All places: designs of the arm, then kinds of small rigs.
pub const PLACES: [&str; 9] = [
    "rich",
    "paper",
    "joint_with_load",
    "axis",
    "heated_tank",
    "hardening_spring",
    "sheath",
    "static_map_motor",
    "six_joints",
];

/// Number of rigs of each kind; there is one campaign of each design, as its trials are many and alike.
const RIGS: u64 = 3;

/// Degree of the correction that is refitted beside each effect.
const DEGREE: usize = 3;

/// Samples that are compared.
const SAMPLES: usize = 1500;

/// Prepared trials.
pub struct Place {
    /// Calibrated nominal model, weights, library.
    pub prepared: Prepared,
    /// Calibration and development trials.
    pub series: Vec<Series>,
}

impl Place {
    /// Prepares every case of a place.
    ///
    /// # Errors
    /// A nominal model that cannot be calibrated.
    pub fn all(name: &str) -> Result<Vec<Self>, EvalError> {
        let campaigns = match small_rigs::Kind::find(name) {
            Some(kind) => {
                Seeds::Development.take(RIGS).map(|seed| small_rig::campaign(&simulate(kind, seed))).collect()
            }
            None => {
                let design = if name == Design::Paper.name() { Design::Paper } else { Design::Rich };
                let made = generate(Seeds::Development.first(), design, Some(Kind::Null(Null::White)));
                vec![made.map_err(|error| EvalError::Data(format!("{name}: {error}")))?.campaign]
            }
        };
        campaigns.iter().map(|campaign| Self::new(name, campaign)).collect()
    }

    fn new(name: &str, campaign: &acm_datasets::Campaign) -> Result<Self, EvalError> {
        let given = recordings(campaign, campaign.nominal_spec(), false)?;
        let options = Options { samples: SAMPLES, ..Options::default() };
        let prepared = prepare(given.case, &options).map_err(|error| EvalError::Data(format!("{name}: {error}")))?;
        let mut series: Vec<Series> = prepared.calibration.iter().chain(&prepared.development).cloned().collect();
        number_blocks(&mut series);
        Ok(Self { prepared, series })
    }

    /// Returns the regression on some outputs.
    pub fn problem<'a>(&'a self, series: &'a [Series]) -> Problem<'a> {
        Problem::new(&self.prepared.case.rig, series, &self.prepared.weight, self.prepared.base())
    }

    /// Returns the nominal form with its correction.
    pub fn bare(problem: &Problem) -> State {
        let largest = largest_polynomial(problem, &State::bare(Form::LINEAR));
        State::bare(Form { degree: largest.degree.map(|degree| degree.clamp(1, DEGREE)), ..largest })
    }
}
