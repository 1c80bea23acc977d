//! Backbone shape: from strain to pose.
//!
//! ```text
//! dg/ds = g · ξ̂(s),   g(0) = identity,   ξ = (κ, ν),   ν = e_z
//! ```
//!
//! | symbol | meaning                                   | shape | unit  |
//! | `κ`    | bending about x and y, twist about z      | 3     | rad/m |
//! | `ν`    | shear (x, y) and stretch (z), constant    | 3     | 1     |
//! | `c`    | strain coordinates: all of κ_x, then all of κ_y, then (where given) all of κ_z | 2N or 3N | rad/m |
//! | `r`    | position in the arm's own frame, along +z | 3     | m     |
//!
//! Steps are those of the sixth-order Magnus expansion, `magnus.rs`: exact where strain is constant. Poses are products of
//! steps from the base; positions and their slopes, which are all that a marker needs, are folded from the tip, `fold.rs`.
//! Renda et al. (2020), RA-L 5(3); Blanes et al. (2009), Phys. Rep. 470.

use nalgebra::Vector3;

use crate::kinematics::fold::{self, Motion};
use crate::kinematics::grid::Grid;
use crate::kinematics::magnus::Twist;
use crate::kinematics::real::Real;
use crate::kinematics::se3::{self, Pose};
use crate::kinematics::strain::StrainBasis;
use crate::kinematics::triple::Triple;

/// Doublings of the step count that a tolerance may ask for.
const DOUBLINGS: usize = 10;

/// An arm without its strain: length, basis, markers and integration grids.
#[derive(Debug, Clone)]
pub struct Shape {
    length: f64,
    basis: StrainBasis,
    tolerance: Option<f64>,
    markers: usize,
    /// Each grid has twice the steps of the one before; a single one without tolerance.
    grids: Vec<Grid>,
}

/// Memory of one evaluation, reused from sample to sample.
#[derive(Debug, Clone)]
pub struct Scratch<T = f64> {
    /// Change of one step with each strain coordinate.
    changes: Vec<Motion<T>>,
    positions: Vec<Triple<T>>,
    slopes: Vec<Triple<T>>,
    coarse: Vec<Triple<T>>,
}

impl Shape {
    /// An arm of `length` m that reports its pose at `at` (s/L in [0, 1], any order).
    ///
    /// `steps` is the least number of steps from base to tip. With `tolerance` (m) the number is
    /// doubled, for each strain on its own, until the estimated error of every marker is below it.
    pub fn new(length: f64, basis: StrainBasis, at: &[f64], steps: usize, tolerance: Option<f64>) -> Self {
        let refine = tolerance.is_some() && !basis.is_constant_between_borders();
        let levels = if refine { DOUBLINGS } else { 0 };
        let grids = (0..=levels).map(|level| Grid::new(length, basis, at, steps << level)).collect();
        Self { length, basis, tolerance, markers: at.len(), grids }
    }

    /// Integration grids, each with twice the steps of the one before; a single one where the step count does not depend on
    /// the strain.
    pub fn grids(&self) -> &[Grid] {
        &self.grids
    }

    /// Number of places whose pose is reported.
    pub fn markers(&self) -> usize {
        self.markers
    }

    /// Memory for [`Shape::positions`] and [`Shape::jacobian`] with `coordinates` strain coordinates.
    pub fn scratch(&self, coordinates: usize) -> Scratch {
        self.scratch_of(coordinates, 0.0)
    }

    pub(crate) fn scratch_of<T: Real>(&self, coordinates: usize, like: T) -> Scratch<T> {
        let zero = Triple::zero(like);
        let still = Twist::of_strain(zero, like.like(0.0));
        Scratch {
            changes: vec![still.into(); coordinates],
            positions: vec![zero; self.markers],
            slopes: vec![zero; self.markers * coordinates],
            coarse: vec![zero; if self.tolerance.is_some() { self.markers } else { 0 }],
        }
    }

    /// Whether the number of steps depends on the strain, so that samples cannot go side by side.
    pub(crate) fn refines(&self) -> bool {
        self.tolerance.is_some()
    }

    /// Index in [`Shape::grids`] of the first grid that meets the tolerance at `c`; 0 without a tolerance.
    pub fn grid_for(&self, c: &[f64], scratch: &mut Scratch) -> usize {
        self.level(c, scratch)
    }

    /// Position of every marker; `out` has one entry for each.
    pub fn positions(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Vector3<f64>]) {
        let level = self.level(c, scratch);
        vectors(self.positions_on(level, c, scratch), out);
    }

    /// Positions as [`Shape::positions`], and `∂r/∂c` of marker k in `slopes[k·len(c)..]`, m per rad/m.
    pub fn jacobian(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Vector3<f64>], slopes: &mut [Vector3<f64>]) {
        let level = self.level(c, scratch);
        let (positions, along) = self.slopes_on(level, c, scratch);
        vectors(positions, out);
        vectors(along, slopes);
    }

    /// Pose of every marker; `out` has one entry for each.
    pub fn poses(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Pose]) {
        self.poses_from(Pose::identity(), c, scratch, out);
    }

    /// Poses along the arm in the frame in which the base has the pose `base`.
    pub fn poses_from(&self, base: Pose, c: &[f64], scratch: &mut Scratch, out: &mut [Pose]) {
        let level = self.level(c, scratch);
        integrate(&self.grids[level], base, c, out);
    }

    /// Pose at any place s in [0, L] m: for drawing, where speed does not matter.
    pub fn pose(&self, c: &[f64], s: f64) -> Pose {
        let steps = self.grids[0].least_steps;
        let there = Shape::new(self.length, self.basis, &[s / self.length], steps, self.tolerance);
        let mut out = [Pose::identity()];
        there.poses(c, &mut there.scratch(c.len()), &mut out);
        out[0]
    }

    /// Positions on one grid, left in the scratch memory.
    #[inline(always)]
    pub(crate) fn positions_on<'a, T: Real>(
        &self,
        level: usize,
        c: &[T],
        scratch: &'a mut Scratch<T>,
    ) -> &'a [Triple<T>] {
        fold::positions(&self.grids[level], c, &mut scratch.positions);
        &scratch.positions
    }

    /// Positions and slopes on one grid, left in the scratch memory.
    #[inline(always)]
    pub(crate) fn slopes_on<'a, T: Real>(
        &self,
        level: usize,
        c: &[T],
        scratch: &'a mut Scratch<T>,
    ) -> (&'a [Triple<T>], &'a [Triple<T>]) {
        let Scratch { changes, positions, slopes, .. } = scratch;
        fold::slopes(&self.grids[level], c, changes, positions, slopes);
        (positions, slopes)
    }

    /// Index of the first grid that meets the tolerance; of samples side by side, all of them.
    #[inline(always)]
    pub(crate) fn level<T: Real>(&self, c: &[T], scratch: &mut Scratch<T>) -> usize {
        self.tolerance.map_or(0, |tolerance| self.refine(tolerance, c, scratch))
    }

    fn refine<T: Real>(&self, tolerance: f64, c: &[T], scratch: &mut Scratch<T>) -> usize {
        self.positions_on(0, c, scratch);
        for level in 1..self.grids.len() {
            scratch.coarse.copy_from_slice(&scratch.positions);
            self.positions_on(level, c, scratch);
            // Halving the step divides the error by 64, so the finer result is off by 1/63 of the change.
            let change = largest_distance(&scratch.coarse, &scratch.positions) / 63.0;
            if change < tolerance || !change.is_finite() {
                return level;
            }
        }
        self.grids.len() - 1
    }
}

fn vectors(from: &[Triple<f64>], to: &mut [Vector3<f64>]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = Vector3::new(from.x, from.y, from.z));
}

fn largest_distance<T: Real>(a: &[Triple<T>], b: &[Triple<T>]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| {
        let change = *a + *b * b.x.like(-1.0);
        change.dot(change).largest()
    });
    squares.fold(0.0, f64::max).sqrt()
}

/// Poses on one grid, from the base on.
fn integrate(grid: &Grid, base: Pose, c: &[f64], out: &mut [Pose]) {
    let mut g = base;
    let mut stops = grid.stops.iter().peekable();
    for k in 0..=grid.steps.len() {
        while let Some(stop) = stops.next_if(|stop| stop.after == k) {
            out[stop.marker] = g;
        }
        if let Some(step) = grid.steps.get(k) {
            let twist = fold::twist(grid, step, c);
            let (omega, v) = (twist.omega(), twist.v());
            g = g.then(&se3::exp(&Vector3::new(omega.x, omega.y, omega.z), &Vector3::new(v.x, v.y, v.z)));
        }
    }
}
