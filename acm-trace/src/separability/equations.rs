//! Normal equations of a set of effects and the calibration together: of all trials, or block by block.
//!
//! ```text
//! H = (E D)ᵀ(E D),   g = (E D)ᵀ r,   E = ∂r/∂θ,   D = ∂r/∂δ
//! ```
//!
//! A step needs the sum alone, and leaving a block out needs the parts. DᵀD is known from the reference, unless a trial begins
//! in an unknown state.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::separability::evaluate::{self, Point, Tip, free};
use crate::separability::normal::Block;
use crate::separability::setup::{Setup, ranges};
use crate::tall::{TILE, product};

/// Of all trials together.
pub(crate) fn whole(setup: &Setup, point: Point, tip: Tip) -> Block {
    let part = |s: usize| {
        let all = 0..setup.series[s].samples();
        Trial::new(setup, s, point, tip).part(all, &setup.references[s].whole)
    };
    let parts: Vec<Block> = (0..setup.series.len()).into_par_iter().map(part).collect();
    sum(&parts, unknowns(setup, point))
}

/// Of each block.
pub(crate) fn blocks(setup: &Setup, point: Point, tip: Tip) -> Vec<Block> {
    let parts = |s: usize| {
        let trial = Trial::new(setup, s, point, tip);
        let ranges = ranges(&setup.series[s]).into_iter().zip(&setup.references[s].normal);
        ranges.map(|((block, rows), known)| (block, trial.part(rows, known))).collect()
    };
    let parts: Vec<Vec<(usize, Block)>> = (0..setup.series.len()).into_par_iter().map(parts).collect();
    let mut blocks = vec![Block::empty(unknowns(setup, point)); setup.blocks()];
    parts.iter().flatten().for_each(|(block, part)| blocks[*block].add(part));
    blocks
}

/// H and g with σ²Λ and its pull.
pub(crate) fn with_prior(setup: &Setup, mut sum: Block, delta: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let calibrated = setup.calibrated();
    let first = sum.gradient.len() - calibrated;
    let precision = &setup.precision * setup.noise;
    let mut corner = sum.normal.view_mut((first, first), (calibrated, calibrated));
    corner += &precision;
    let pull = &precision * (delta - &setup.centre);
    let mut tail = sum.gradient.rows_mut(first, calibrated);
    tail += &pull;
    (sum.normal, sum.gradient)
}

fn unknowns(setup: &Setup, point: Point) -> usize {
    free(point.instances).len() + setup.calibrated()
}

fn sum(blocks: &[Block], unknowns: usize) -> Block {
    let mut sum = Block::empty(unknowns);
    blocks.iter().for_each(|block| sum.add(block));
    sum
}

/// One trial.
struct Trial<'t> {
    setup: &'t Setup<'t>,
    s: usize,
    effects: usize,
    /// E, r, and what makes it as wide as a tile.
    beside: DMatrix<f64>,
    /// D where it is not the reference's.
    by_delta: Option<DMatrix<f64>>,
}

impl<'t> Trial<'t> {
    fn new(setup: &'t Setup, s: usize, point: Point, tip: Tip) -> Self {
        let sloped = evaluate::sloped(setup, s, point, tip);
        let effects = sloped.by_theta.ncols();
        let mut beside = DMatrix::zeros(sloped.residual.len(), (effects + 1).max(TILE));
        beside.columns_mut(0, effects).copy_from(&sloped.by_theta);
        beside.column_mut(effects).copy_from(&sloped.residual);
        Self { setup, s, effects, beside, by_delta: sloped.by_delta }
    }

    /// Of some samples; `known` is DᵀD of the reference there.
    fn part(&self, samples: Range<usize>, known: &DMatrix<f64>) -> Block {
        let (effects, calibrated, width) = (self.effects, self.setup.calibrated(), self.setup.outputs());
        let rows = samples.start * width..samples.end * width;
        let by_delta = self.by_delta.as_ref().unwrap_or(&self.setup.references[self.s].by_parameter);
        let own = product(&self.beside, &self.beside, rows.clone());
        let cross = product(&self.beside, by_delta, rows.clone());
        let mut part = Block::empty(effects + calibrated);
        let normal = &mut part.normal;
        normal.view_mut((0, 0), (effects, effects)).copy_from(&own.view((0, 0), (effects, effects)));
        normal.view_mut((0, effects), (effects, calibrated)).copy_from(&cross.rows(0, effects));
        normal.view_mut((effects, 0), (calibrated, effects)).copy_from(&cross.rows(0, effects).transpose());
        let mut corner = normal.view_mut((effects, effects), (calibrated, calibrated));
        match &self.by_delta {
            None => corner.copy_from(known),
            Some(by_delta) => corner.copy_from(&product(by_delta, by_delta, rows.clone())),
        }
        part.gradient.rows_mut(0, effects).copy_from(&own.view((0, effects), (effects, 1)));
        part.gradient.rows_mut(effects, calibrated).copy_from(&cross.row(effects).transpose());
        part.cost = self.beside.column(effects).rows(rows.start, rows.len()).norm_squared();
        part.count = self.setup.series[self.s].counts[samples].iter().filter(|counts| **counts).count();
        part
    }
}
