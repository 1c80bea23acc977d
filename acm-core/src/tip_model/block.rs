//! The tip model over blocks of samples, as many at once as a register holds.
//!
//! | table           | entry                            | unit             |
//! | `actuators`     | a·[`STRIDE`] + t                 | SI               |
//! | `outputs`       | o·[`STRIDE`] + t                 | m                |
//! | `by_parameter`  | (j·M + o)·[`STRIDE`] + t         | m per parameter  |
//! | `by_actuator`   | (a·M + o)·[`STRIDE`] + t         | m per actuator   |
//!
//! t is the sample, o one of M outputs, j a parameter among those asked for, a an actuator. A sample has the bits that
//! [`StrainModel::predict`] and [`StrainModel::jacobians_with`] give it, whatever stands beside it.

use pulp::{Arch, Simd, WithSimd};

use super::StrainModel;
use super::evaluate::Sink;
use super::frame::Frame;
use crate::kinematics::lanes::{Register, Single, Wide};

/// Samples of one block.
pub const STRIDE: usize = 64;

/// No column.
const NONE: usize = usize::MAX;

/// Outputs of an evaluation beside the positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Positions,
    Parameters,
    All,
}

/// Memory for [`STRIDE`] samples.
#[derive(Debug, Clone)]
pub struct Block {
    actuators: Vec<f64>,
    outputs: Vec<f64>,
    by_parameter: Vec<f64>,
    by_actuator: Vec<f64>,
    /// Where each parameter stands among those asked for.
    columns: Vec<usize>,
    actuator_columns: Vec<usize>,
    wanted: Wanted,
}

impl Block {
    /// Actuator `a` of all samples; what is behind the samples in use may hold anything finite.
    pub fn actuator_mut(&mut self, a: usize) -> &mut [f64] {
        &mut self.actuators[a * STRIDE..(a + 1) * STRIDE]
    }

    /// Output `o` of all samples.
    pub fn output(&self, o: usize) -> &[f64] {
        &self.outputs[o * STRIDE..(o + 1) * STRIDE]
    }

    /// Slope of output `o` with parameter `j` of those asked for.
    pub fn by_parameter(&self, o: usize, j: usize) -> &[f64] {
        let place = (j * self.outputs.len() / STRIDE + o) * STRIDE;
        &self.by_parameter[place..place + STRIDE]
    }

    /// Slope of output `o` with actuator `a`.
    pub fn by_actuator(&self, o: usize, a: usize) -> &[f64] {
        let place = (a * self.outputs.len() / STRIDE + o) * STRIDE;
        &self.by_actuator[place..place + STRIDE]
    }
}

impl StrainModel {
    /// A block for positions alone.
    pub fn block(&self) -> Block {
        self.block_of(&[], Wanted::Positions)
    }

    /// A block for positions and their slopes with the parameters `free`.
    pub fn block_with_slopes(&self, free: &[usize]) -> Block {
        self.block_of(free, Wanted::Parameters)
    }

    /// A block for positions and their slopes with the parameters `free` and with the actuators.
    pub fn block_with_all_slopes(&self, free: &[usize]) -> Block {
        self.block_of(free, Wanted::All)
    }

    fn block_of(&self, free: &[usize], wanted: Wanted) -> Block {
        let mut columns = vec![NONE; self.theta.len()];
        free.iter().enumerate().for_each(|(column, &j)| columns[j] = column);
        let by_actuator = if wanted == Wanted::All { self.outputs() * self.actuators } else { 0 };
        Block {
            actuators: vec![0.0; self.actuators * STRIDE],
            outputs: vec![0.0; self.outputs() * STRIDE],
            by_parameter: vec![0.0; self.outputs() * free.len() * STRIDE],
            by_actuator: vec![0.0; by_actuator * STRIDE],
            columns,
            actuator_columns: (0..self.actuators).collect(),
            wanted,
        }
    }

    /// Computes the first `samples` samples of a block at the parameters `theta`; the others hold anything.
    pub fn fill(&self, theta: &[f64], samples: usize, block: &mut Block) {
        let task = Fill { model: self, theta, frame: self.frame_of(theta), samples, block };
        if self.shape.refines() {
            task.on(Single);
        } else {
            Arch::new().dispatch(task);
        }
    }
}

struct Fill<'a> {
    model: &'a StrainModel,
    theta: &'a [f64],
    frame: Frame,
    samples: usize,
    block: &'a mut Block,
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.on(Wide(simd));
    }
}

impl Fill<'_> {
    #[inline(always)]
    fn on<R: Register>(self, register: R) {
        let Self { model, theta, frame, samples, block } = self;
        let like = register.load(&block.actuators);
        let mut work = model.work(like);
        let mut q = vec![like; model.actuators];
        let count = model.outputs();
        for start in (0..samples).step_by(R::PLACES) {
            for (a, q) in q.iter_mut().enumerate() {
                *q = register.load(&block.actuators[a * STRIDE + start..]);
            }
            model.strain(theta, &q, &mut work);
            let level = model.shape.level(&work.coordinates, &mut work.shape);
            let outputs = &mut block.outputs;
            let mut places = Columns { register, start, outputs: count, columns: &[0], table: outputs };
            if block.wanted == Wanted::Positions {
                model.positions(level, &frame, &mut work, &mut places);
                continue;
            }
            model.slopes(level, &frame, theta, &mut work, &mut places);
            let table = &mut block.by_parameter;
            let mut places = Columns { register, start, outputs: count, columns: &block.columns, table };
            model.parameter_slopes(&frame, theta, &work, &mut places);
            if block.wanted == Wanted::All {
                let (columns, table) = (&block.actuator_columns, &mut block.by_actuator);
                let mut places = Columns { register, start, outputs: count, columns, table };
                model.actuator_slopes(theta, &work, &mut places);
            }
        }
    }
}

/// A table of a block: where a register's samples go.
struct Columns<'a, R> {
    register: R,
    /// First of the samples.
    start: usize,
    outputs: usize,
    columns: &'a [usize],
    table: &'a mut [f64],
}

impl<R: Register> Sink<R::Value> for Columns<'_, R> {
    #[inline(always)]
    fn put(&mut self, output: usize, column: usize, value: R::Value) {
        let column = self.columns[column];
        if column != NONE {
            let place = (column * self.outputs + output) * STRIDE + self.start;
            self.register.store(value, &mut self.table[place..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::ArmSpec;

    fn filled(run: impl FnOnce(Fill<'_>)) -> Vec<u64> {
        let arm = ArmSpec { degree: 2, ..ArmSpec::default() };
        let model = StrainModel::new(&arm, 2, &[1.0, 0.3]).unwrap();
        let theta: Vec<f64> = (0..model.parameters().len()).map(|j| (1.0 + j as f64).sin()).collect();
        let mut block = model.block_with_all_slopes(&[0, 3, 7]);
        block.actuators.iter_mut().enumerate().for_each(|(t, q)| *q = 3.0 * (t as f64).cos());
        run(Fill { model: &model, theta: &theta, frame: model.frame_of(&theta), samples: STRIDE, block: &mut block });
        [block.outputs, block.by_parameter, block.by_actuator].concat().iter().map(|v| v.to_bits()).collect()
    }

    /// Oracle: the same formulas without registers; those of this processor, and the narrower ones that it may have.
    #[test]
    fn the_width_of_the_registers_changes_no_bit() {
        let plain = filled(|task| task.on(Single));
        assert_eq!(filled(|task| Arch::new().dispatch(task)), plain);
        #[cfg(target_arch = "x86_64")]
        if let Some(narrow) = pulp::x86::V3::try_new() {
            assert_eq!(filled(|task| Simd::vectorize(narrow, task)), plain);
        }
    }
}
