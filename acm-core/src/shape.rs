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
//! One step of length h takes the mean strain and its first commutator at the two Gauss points a, b:
//!
//! ```text
//! ω = h/2 (κ_a + κ_b) + √3/12 h² κ_a × κ_b,   v = h ν + √3/12 h² (κ_a − κ_b) × ν
//! ```
//!
//! Fourth order in h, exact where strain is constant. Renda et al. (2020), RA-L 5(3); Blanes et al. (2009), Phys. Rep. 470.

use nalgebra::{Matrix3, Vector3};

use crate::grid::{Grid, Step};
use crate::se3::{self, Pose};
use crate::strain::StrainBasis;

/// √3/12, the weight of the commutator.
const COMMUTATOR: f64 = 0.144_337_567_297_406_44;

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
pub struct Scratch {
    /// Turn (rad) and displacement (m) of the base per unit of each strain coordinate.
    turn: Vec<Vector3<f64>>,
    shift: Vec<Vector3<f64>>,
    coarse: Vec<Pose>,
}

/// Mean strain and commutator of one step.
struct Magnus {
    omega: Vector3<f64>,
    v: Vector3<f64>,
    early: Vector3<f64>,
    late: Vector3<f64>,
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

    /// Number of places whose pose is reported.
    pub fn markers(&self) -> usize {
        self.markers
    }

    /// Memory for [`Shape::poses`] and [`Shape::jacobian`] with `coordinates` strain coordinates.
    pub fn scratch(&self, coordinates: usize) -> Scratch {
        Scratch {
            turn: vec![Vector3::zeros(); coordinates],
            shift: vec![Vector3::zeros(); coordinates],
            coarse: vec![Pose::identity(); self.markers],
        }
    }

    /// Pose of every marker; `out` has one entry for each.
    pub fn poses(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Pose]) {
        self.refine(c, scratch, out);
    }

    /// Pose at any place s in [0, L] m: for drawing, where speed does not matter.
    pub fn pose(&self, c: &[f64], s: f64) -> Pose {
        let steps = self.grids[0].least_steps;
        let there = Shape::new(self.length, self.basis, &[s / self.length], steps, self.tolerance);
        let mut out = [Pose::identity()];
        there.poses(c, &mut there.scratch(c.len()), &mut out);
        out[0]
    }

    /// Poses as [`Shape::poses`], and `∂r/∂c` of marker k in `slopes[k·len(c)..]`, m per rad/m.
    pub fn jacobian(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Pose], slopes: &mut [Vector3<f64>]) {
        let level = self.refine(c, scratch, out);
        differentiate(&self.grids[level], c, scratch, slopes);
    }

    /// Fills `out` on the first grid that meets the tolerance, and returns its index.
    fn refine(&self, c: &[f64], scratch: &mut Scratch, out: &mut [Pose]) -> usize {
        integrate(&self.grids[0], c, out);
        let Some(tolerance) = self.tolerance else {
            return 0;
        };
        for level in 1..self.grids.len() {
            scratch.coarse.copy_from_slice(out);
            integrate(&self.grids[level], c, out);
            // Halving the step divides the error by 16, so the coarse result is off by 16/15 of the change.
            let change = largest_distance(&scratch.coarse, out) / 15.0;
            if change < tolerance || !change.is_finite() {
                return level;
            }
        }
        self.grids.len() - 1
    }
}

fn largest_distance(a: &[Pose], b: &[Pose]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a.position - b.position).norm()).fold(0.0, f64::max)
}

fn integrate(grid: &Grid, c: &[f64], out: &mut [Pose]) {
    let mut g = Pose::identity();
    let mut stops = grid.stops.iter().peekable();
    for k in 0..=grid.steps.len() {
        while let Some(stop) = stops.next_if(|stop| stop.after == k) {
            out[stop.marker] = g;
        }
        if let Some(step) = grid.steps.get(k) {
            let m = magnus(grid, step, c);
            g = g.then(&se3::exp(&m.omega, &m.v));
        }
    }
}

/// Sum of the strain coordinates at the two Gauss points of a step.
fn magnus(grid: &Grid, step: &Step, c: &[f64]) -> Magnus {
    let (early, late) = (strain_at(grid, step, c, step.early), strain_at(grid, step, c, step.late));
    let h = step.length;
    let weight = COMMUTATOR * h * h;
    let difference = early - late;
    Magnus {
        omega: (early + late) * (0.5 * h) + early.cross(&late) * weight,
        v: Vector3::new(difference.y * weight, -difference.x * weight, h),
        early,
        late,
    }
}

fn strain_at(grid: &Grid, step: &Step, c: &[f64], values: usize) -> Vector3<f64> {
    let values = &grid.values[values..values + grid.active];
    let mut kappa = Vector3::zeros();
    for (strain, coordinates) in c.chunks_exact(grid.functions).enumerate() {
        let active = &coordinates[step.first..step.first + grid.active];
        kappa[strain] = active.iter().zip(values).map(|(c, phi)| c * phi).sum();
    }
    kappa
}

/// Each step adds a small motion (turn, shift) of everything beyond it, seen from the base:
/// δr = shift + turn × r. Adding these up needs no work in columns that a step does not touch.
fn differentiate(grid: &Grid, c: &[f64], scratch: &mut Scratch, slopes: &mut [Vector3<f64>]) {
    scratch.turn.fill(Vector3::zeros());
    scratch.shift.fill(Vector3::zeros());
    let mut g = Pose::identity();
    let mut stops = grid.stops.iter().peekable();
    for k in 0..=grid.steps.len() {
        while let Some(stop) = stops.next_if(|stop| stop.after == k) {
            let row = &mut slopes[stop.marker * c.len()..(stop.marker + 1) * c.len()];
            for (j, slope) in row.iter_mut().enumerate() {
                *slope = scratch.shift[j] + scratch.turn[j].cross(&g.position);
            }
        }
        if let Some(step) = grid.steps.get(k) {
            g = add_step(grid, step, c, g, scratch);
        }
    }
}

/// Motion of the rest of the arm with the strain of one step; returns the pose at the step's end.
fn add_step(grid: &Grid, step: &Step, c: &[f64], g: Pose, scratch: &mut Scratch) -> Pose {
    let m = magnus(grid, step, c);
    let (local, tangent) = se3::exp_with_tangent(&m.omega, &m.v);
    let end = g.then(&local);
    let (spin, bend) = (g.rotation * tangent.spin, g.rotation * tangent.bend);
    let h = step.length;
    let weight = COMMUTATOR * h * h;
    let mean = Matrix3::from_diagonal_element(0.5 * h);
    let commutator = se3::hat(&Vector3::z()) * weight;
    for (kappa, sign, values) in [(m.late, -1.0, step.early), (m.early, 1.0, step.late)] {
        let turn_of_omega = mean + se3::hat(&kappa) * (sign * weight);
        let turn = spin * turn_of_omega;
        let shift = bend * turn_of_omega + spin * commutator * sign;
        for strain in 0..c.len() / grid.functions {
            let axis: Vector3<f64> = turn.column(strain).into();
            let moved: Vector3<f64> = shift.column(strain).into();
            let base = moved - axis.cross(&end.position);
            for i in 0..grid.active {
                let phi = grid.values[values + i];
                let j = strain * grid.functions + step.first + i;
                scratch.turn[j] += axis * phi;
                scratch.shift[j] += base * phi;
            }
        }
    }
    end
}
