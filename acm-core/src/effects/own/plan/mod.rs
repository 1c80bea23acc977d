//! A definition that is checked and compiled: what holds on every rig.

mod compile;
mod names;
mod parts;

use super::definition::{Definition, Place};
use super::fault::OwnError;
use super::function::Function;
use super::program::Program;
use super::sound::{key, sound};
use super::units::{Dimension, Unit};
use names::{metres, named, open, unit_of};
use parts::Parts;

/// A compiled definition.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Operations on registers.
    pub program: Program,
    /// Registers of the columns, then of the inputs, then of the time where it is used: 0 and up.
    pub base: usize,
    /// Whether the last of these is the time.
    pub uses_time: bool,
    /// Register of the time since the sample before.
    pub elapsed: usize,
    /// First register of the parameters, in the order of their names.
    pub parameters: usize,
    /// Registers of the states before, and at the sample.
    pub before: Vec<usize>,
    /// See above.
    pub now: Vec<usize>,
    /// Registers of the states at the first sample.
    pub start: Vec<usize>,
    /// Registers of the output columns.
    pub results: Vec<usize>,
    /// How states advance.
    pub form: Form,
    /// The operations of an update of one state, where each takes on from the one before.
    pub chain: Option<Vec<(Function, usize)>>,
    /// Unit of each input's signal and of each parameter, in the order of their names.
    pub inputs: Vec<Unit>,
    /// See above.
    pub units: Vec<Unit>,
    /// Unit of the columns; none where it is open.
    pub column: Option<Unit>,
    /// Whether it adds to the columns in proportion to its sizes.
    pub is_additive: bool,
    /// Whether it is a linear filter of each column, with one set of values and no inputs.
    pub is_filter: bool,
    /// Whether it is a function of the present sample.
    pub is_static: bool,
}

/// How states go on from one sample to the next.
#[derive(Debug, Clone)]
pub enum Form {
    /// There are none.
    Static,
    /// As operations say.
    Update,
    /// ż = A z + B u + c, exactly.
    Linear(Linear),
    /// ż = f(z, u), by Runge–Kutta: registers of the rates, and steps between two samples.
    RungeKutta { rates: Vec<usize>, steps: usize },
}

/// Registers of the coefficients of a linear rate.
#[derive(Debug, Clone)]
pub struct Linear {
    /// A, row by row; none where it is 0.
    pub a: Vec<Option<usize>>,
    /// Entries of B: state, register of the input, register of the coefficient.
    pub b: Vec<(usize, usize, usize)>,
    /// c; none where it is 0.
    pub c: Vec<Option<usize>>,
    /// Whether A is the same for every column.
    pub is_shared: bool,
}
impl Plan {
    /// Checks a definition and compiles it.
    ///
    /// # Errors
    /// What cannot be carried out, with its key.
    pub fn new(definition: &Definition) -> Result<Self, OwnError> {
        sound(definition)?;
        let column = definition.unit.as_ref().map(|unit| unit_of("unit", unit, &[])).transpose()?;
        let column = if definition.place == Place::Frame { Some(metres(definition, column)?) } else { column };
        let mut named = named(definition, column.as_ref())?;
        let parts = Parts::read(definition)?;
        parts.states_are_dimensioned(&mut named)?;
        parts.fit(definition, &named)?;
        let open = open(definition, column.as_ref());
        let units =
            definition.parameters.iter().map(|(name, p)| unit_of(&key("parameters", name, "unit"), &p.unit, &open));
        let units: Vec<Unit> = units.collect::<Result<_, _>>()?;
        let inputs = definition.inputs.iter().map(|(name, input)| match &input.unit {
            Some(unit) => unit_of(&key("inputs", name, "unit"), unit, &[]),
            None => Ok(Unit { dimension: Dimension::CARRIER, ..Unit::one() }),
        });
        let inputs: Vec<Unit> = inputs.collect::<Result<_, _>>()?;
        Ok(parts.compiled(definition, column, units, inputs))
    }
}
