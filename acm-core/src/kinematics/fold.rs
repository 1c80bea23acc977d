//! Positions along the arm and their slopes: steps folded together from the tip back to the base.
//!
//! ```text
//! r_k = R_k r_{k+1} + J_k v_k = r_{k+1} + v + ω × w,   w = A r_{k+1} + B v + ω × u,   u = B r_{k+1} + C v
//! δr_k = δr_{k+1} + δv + δω × w + ω × δw
//! δw   = A δr_{k+1} + B δv + δx (A' r_{k+1} + B' v) + δω × u + ω × δu
//! δu   = B δr_{k+1} + C δv + δx (B' r_{k+1} + C' v),   δx = 2 ω·δω
//! ```
//!
//! | symbol    | meaning                                              | shape | unit   |
//! | `r_k`     | marker, seen from the start of step k                | 3     | m      |
//! | `ω, v`    | twist Ω of step k, see `magnus.rs`                   | 3, 3  | rad, m |
//! | `A, B, C` | of ω, with slopes A', B', C', see `coefficients.rs`  | 1     | 1      |
//!
//! A position needs no orientation: going from the tip to the base, each step turns a vector and never a matrix. All markers
//! that lie beyond a step take part in it. Everything is written over [`Real`], for one sample or several side by side.

use crate::kinematics::coefficients::Coefficients;
use crate::kinematics::grid::{Grid, Step, Variation};
use crate::kinematics::magnus::{Bending, Constant, Expansion, General, Twist};
use crate::kinematics::real::Real;
use crate::kinematics::triple::Triple;

/// Rotation vector and translation of one step, or a change of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<T> {
    omega: Triple<T>,
    v: Triple<T>,
}

impl<T: Real> From<Twist<T>> for Motion<T> {
    #[inline(always)]
    fn from(twist: Twist<T>) -> Self {
        Self { omega: twist.omega(), v: twist.v() }
    }
}

/// Ω of one step with strain coordinates `c`.
#[inline(always)]
pub(crate) fn twist<T: Real>(grid: &Grid, step: &Step, c: &[T]) -> Twist<T> {
    match grid.variation {
        Variation::Constant => expand::<T, Constant<T>>(grid, step, c).omega(),
        Variation::Linear if !is_twisted(grid, c) => expand::<T, Bending<T>>(grid, step, c).omega(),
        _ => expand::<T, General<T>>(grid, step, c).omega(),
    }
}

/// Position of every marker into `out`.
#[inline(always)]
pub(crate) fn positions<T: Real>(grid: &Grid, c: &[T], out: &mut [Triple<T>]) {
    let mut beyond = grid.stops.len();
    for k in (0..=grid.steps.len()).rev() {
        if let Some(step) = grid.steps.get(k) {
            let motion = Motion::from(twist(grid, step, c));
            let coefficients = Coefficients::at(motion.omega.dot(motion.omega));
            for stop in &grid.stops[beyond..] {
                let r = &mut out[stop.marker];
                *r = Folded::new(&motion, &coefficients, *r).r;
            }
        }
        while beyond > 0 && grid.stops[beyond - 1].after == k {
            beyond -= 1;
            out[grid.stops[beyond].marker] = Triple::zero(c[0]);
        }
    }
}

/// As [`positions`], and `∂r/∂c` of marker k in `slopes[k·len(c)..]`; `changes` has one place for each coordinate.
#[inline(always)]
pub(crate) fn slopes<T: Real>(
    grid: &Grid,
    c: &[T],
    changes: &mut [Motion<T>],
    out: &mut [Triple<T>],
    slopes: &mut [Triple<T>],
) {
    let width = c.len();
    let mut beyond = grid.stops.len();
    for k in (0..=grid.steps.len()).rev() {
        if let Some(step) = grid.steps.get(k) {
            let motion = differentiate(grid, step, c, changes);
            let coefficients = Coefficients::at(motion.omega.dot(motion.omega));
            for stop in &grid.stops[beyond..] {
                let row = &mut slopes[stop.marker * width..(stop.marker + 1) * width];
                out[stop.marker] = fold(grid, step, &motion, &coefficients, changes, out[stop.marker], row);
            }
        }
        while beyond > 0 && grid.stops[beyond - 1].after == k {
            beyond -= 1;
            let marker = grid.stops[beyond].marker;
            out[marker] = Triple::zero(c[0]);
            slopes[marker * width..(marker + 1) * width].fill(Triple::zero(c[0]));
        }
    }
}

/// One marker through one step: its position before it, and all its slopes.
#[inline(always)]
fn fold<T: Real>(
    grid: &Grid,
    step: &Step,
    motion: &Motion<T>,
    coefficients: &Coefficients<T>,
    changes: &[Motion<T>],
    r: Triple<T>,
    row: &mut [Triple<T>],
) -> Triple<T> {
    let folded = Folded::new(motion, coefficients, r);
    let bent = folded.bent(r);
    for (row, changes) in row.chunks_exact_mut(grid.functions).zip(changes.chunks_exact(grid.functions)) {
        // Coordinates of functions that end before this step have no slope yet.
        let (active, later) = row[step.first..].split_at_mut(grid.active);
        for (slope, change) in active.iter_mut().zip(&changes[step.first..]) {
            *slope = folded.moved(*slope, change, &bent);
        }
        for slope in later {
            *slope = folded.turned(*slope);
        }
    }
    folded.r
}

/// A position seen from the start of a step, and what its slopes need.
struct Folded<'a, T> {
    motion: &'a Motion<T>,
    coefficients: &'a Coefficients<T>,
    u: Triple<T>,
    w: Triple<T>,
    r: Triple<T>,
}

impl<'a, T: Real> Folded<'a, T> {
    #[inline(always)]
    fn new(motion: &'a Motion<T>, coefficients: &'a Coefficients<T>, r: Triple<T>) -> Self {
        let (omega, v) = (motion.omega, motion.v);
        let u = r * coefficients.b + v * coefficients.c;
        let w = r * coefficients.a + v * coefficients.b + omega.cross(u);
        Self { motion, coefficients, u, w, r: r + v + omega.cross(w) }
    }

    /// B' r + C' v and A' r + B' v, with r as it was beyond the step.
    #[inline(always)]
    fn bent(&self, r: Triple<T>) -> [Triple<T>; 2] {
        let [a, b, c] = self.coefficients.slopes();
        [r * b + self.motion.v * c, r * a + self.motion.v * b]
    }

    /// The slope of a coordinate that changes this step.
    #[inline(always)]
    fn moved(&self, slope: Triple<T>, change: &Motion<T>, bent: &[Triple<T>; 2]) -> Triple<T> {
        let (omega, by) = (self.motion.omega, self.coefficients);
        let grown = omega.dot(change.omega) * 2.0;
        let u = slope * by.b + change.v * by.c + bent[0] * grown;
        let w = slope * by.a + change.v * by.b + bent[1] * grown + change.omega.cross(self.u) + omega.cross(u);
        slope + change.v + change.omega.cross(self.w) + omega.cross(w)
    }

    /// The slope of a coordinate that changes later steps only.
    #[inline(always)]
    fn turned(&self, slope: Triple<T>) -> Triple<T> {
        let (omega, by) = (self.motion.omega, self.coefficients);
        slope + omega.cross(slope * by.a + omega.cross(slope * by.b))
    }
}

/// Ω of one step, and its change with each active coordinate.
#[inline(always)]
fn differentiate<T: Real>(grid: &Grid, step: &Step, c: &[T], changes: &mut [Motion<T>]) -> Motion<T> {
    match grid.variation {
        Variation::Constant => differentiate_as::<T, Constant<T>>(grid, step, c, changes),
        Variation::Linear if !is_twisted(grid, c) => differentiate_as::<T, Bending<T>>(grid, step, c, changes),
        _ => differentiate_as::<T, General<T>>(grid, step, c, changes),
    }
}

#[inline(always)]
fn differentiate_as<T: Real, E: Expansion<T>>(
    grid: &Grid,
    step: &Step,
    c: &[T],
    changes: &mut [Motion<T>],
) -> Motion<T> {
    let expansion: E = expand(grid, step, c);
    for (strain, changes) in changes.chunks_exact_mut(grid.functions).enumerate() {
        for (i, change) in changes[step.first..step.first + grid.active].iter_mut().enumerate() {
            let weights = [0, 1, 2].map(|order| grid.values[step.weights + order * grid.active + i]);
            *change = expansion.slope(weighted(c[0], strain, weights)).into();
        }
    }
    expansion.omega().into()
}

/// α per unit of one coordinate of a strain.
#[inline(always)]
fn weighted<T: Real>(like: T, strain: usize, weights: [f64; 3]) -> [Twist<T>; 3] {
    [along(like, strain, weights[0]), along(like, strain, weights[1]), along(like, strain, weights[2])]
}

#[inline(always)]
fn along<T: Real>(like: T, strain: usize, weight: f64) -> Twist<T> {
    let zero = like.like(0.0);
    let mut kappa = [0.0; 3];
    kappa[strain] = weight;
    Twist::of_strain(Triple::new(like.like(kappa[0]), like.like(kappa[1]), like.like(kappa[2])), zero)
}

#[inline(always)]
fn expand<T: Real, E: Expansion<T>>(grid: &Grid, step: &Step, c: &[T]) -> E {
    let mut all = [alpha(grid, step, c, 0); 3];
    if E::ORDERS > 1 {
        all[1] = alpha(grid, step, c, 1);
    }
    if E::ORDERS > 2 {
        all[2] = alpha(grid, step, c, 2);
    }
    E::new(all)
}

/// Whether torsion is among the coordinates.
#[inline(always)]
fn is_twisted<T>(grid: &Grid, c: &[T]) -> bool {
    c.len() > 2 * grid.functions
}

/// α of one order: strain, its slope or its curvature over the step; the stretch is constant.
#[inline(always)]
fn alpha<T: Real>(grid: &Grid, step: &Step, c: &[T], order: usize) -> Twist<T> {
    let torsion = if is_twisted(grid, c) { share(grid, step, c, 2, order) } else { c[0].like(0.0) };
    let kappa = Triple::new(share(grid, step, c, 0, order), share(grid, step, c, 1, order), torsion);
    Twist::of_strain(kappa, c[0].like(if order == 0 { step.length } else { 0.0 }))
}

/// Sum of the active coordinates of one strain with their weights.
#[inline(always)]
fn share<T: Real>(grid: &Grid, step: &Step, c: &[T], strain: usize, order: usize) -> T {
    let c = &c[strain * grid.functions + step.first..][..grid.active];
    let weights = &grid.values[step.weights + order * grid.active..][..grid.active];
    let mut sum = c[0] * weights[0];
    for (c, weight) in c[1..].iter().zip(&weights[1..]) {
        sum = sum + *c * *weight;
    }
    sum
}
