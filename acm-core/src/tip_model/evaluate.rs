//! The tip model and its slopes, for one sample or several side by side.
//!
//! ```text
//! ∂p/∂φ_ij = S_i m_j,   ∂p/∂a_in = C·U·(∂r/∂c_in) A_i,   S_i = C·U·(∂r/∂c_i0 + Σ_n a_in ∂r/∂c_in)
//! ∂p/∂q_a  = Σ_i S_i Σ_j φ_ij ∂m_j/∂q_a
//! ```
//!
//! | symbol | meaning                                 | shape | unit        |
//! | `m`    | monomials of the actuators              | M     | see [`crate::actuation`] |
//! | `S_i`  | slope of a marker with the amplitude A_i | 3     | m per rad/m |

use super::StrainModel;
use super::frame::Frame;
use crate::kinematics::real::Real;
use crate::kinematics::shape;
use crate::kinematics::strain::StrainBasis;
use crate::kinematics::triple::Triple;

/// Takes what is computed: output, column, value.
pub(crate) trait Sink<T> {
    fn put(&mut self, output: usize, column: usize, value: T);
}

/// A table of one sample that lies row by row: output, column.
pub(super) struct Rows<'a> {
    pub table: &'a mut [f64],
    pub width: usize,
}

impl Sink<f64> for Rows<'_> {
    #[inline(always)]
    fn put(&mut self, output: usize, column: usize, value: f64) {
        self.table[output * self.width + column] = value;
    }
}

/// x, y and z of one marker.
#[inline(always)]
fn put<T: Real>(sink: &mut impl Sink<T>, marker: usize, column: usize, value: Triple<T>) {
    sink.put(3 * marker, column, value.x);
    sink.put(3 * marker + 1, column, value.y);
    sink.put(3 * marker + 2, column, value.z);
}

/// Memory of one evaluation.
#[derive(Debug, Clone)]
pub(crate) struct Work<T> {
    monomials: Vec<T>,
    amplitudes: Vec<T>,
    pub coordinates: Vec<T>,
    pub shape: shape::Scratch<T>,
    /// C·U·r of each marker.
    turned: Vec<Triple<T>>,
    /// S of each marker and amplitude, then C·U·∂r/∂c of the higher orders.
    by_amplitude: Vec<Triple<T>>,
    by_order: Vec<Triple<T>>,
}

impl StrainModel {
    /// Memory for samples that stand side by side as in `like`.
    pub(crate) fn work<T: Real>(&self, like: T) -> Work<T> {
        let coordinates = 2 * self.arm.strain.functions();
        let zero = like.like(0.0);
        let (markers, none) = (self.at.len(), Triple::zero(like));
        Work {
            monomials: vec![zero; self.monomials.len()],
            amplitudes: vec![zero; self.amplitudes()],
            coordinates: vec![zero; coordinates],
            shape: self.shape.scratch_of(coordinates, like),
            turned: vec![none; markers],
            by_amplitude: vec![none; markers * self.amplitudes()],
            by_order: vec![none; markers * self.strain_range().len()],
        }
    }

    /// Actuators to strain coordinates.
    #[inline(always)]
    pub(crate) fn strain<T: Real>(&self, theta: &[f64], q: &[T], work: &mut Work<T>) {
        self.monomials.values(q, &mut work.monomials);
        let rows = theta[self.actuation_range()].chunks_exact(self.monomials.len());
        for (amplitude, row) in work.amplitudes.iter_mut().zip(rows) {
            *amplitude = sum(&work.monomials, row);
        }
        match self.arm.strain {
            StrainBasis::Piecewise { .. } => work.coordinates.copy_from_slice(&work.amplitudes),
            StrainBasis::Legendre { order } => {
                let a = &theta[self.strain_range()];
                for i in 0..2 {
                    let c = &mut work.coordinates[i * (order + 1)..(i + 1) * (order + 1)];
                    c[0] = work.amplitudes[i];
                    for n in 0..order {
                        c[n + 1] = work.amplitudes[i] * a[i * order + n];
                    }
                }
            }
        }
    }

    /// Puts every output of the samples whose strain is in `work`.
    #[inline(always)]
    pub(super) fn positions<T: Real>(&self, level: usize, frame: &Frame, work: &mut Work<T>, sink: &mut impl Sink<T>) {
        let positions = self.shape.positions_on(level, &work.coordinates, &mut work.shape);
        place(frame, positions, &mut work.turned, sink);
    }

    /// As [`StrainModel::positions`], and leaves in `work` what the slopes below are put together from.
    #[inline(always)]
    pub(super) fn slopes<T: Real>(
        &self,
        level: usize,
        frame: &Frame,
        theta: &[f64],
        work: &mut Work<T>,
        sink: &mut impl Sink<T>,
    ) {
        let (positions, along) = self.shape.slopes_on(level, &work.coordinates, &mut work.shape);
        place(frame, positions, &mut work.turned, sink);
        let (amplitudes, a) = (work.amplitudes.len(), &theta[self.strain_range()]);
        let orders = a.len() / 2;
        let markers = work.by_amplitude.chunks_exact_mut(amplitudes).zip(along.chunks_exact(work.coordinates.len()));
        for (marker, (by_amplitude, along)) in markers.enumerate() {
            for (i, (slope, along)) in by_amplitude.iter_mut().zip(along.chunks_exact(orders + 1)).enumerate() {
                *slope = frame.turned(along[0]);
                for n in 0..orders {
                    let of_order = frame.turned(along[n + 1]);
                    *slope = *slope + of_order * along[0].x.like(a[i * orders + n]);
                    work.by_order[marker * a.len() + i * orders + n] = of_order;
                }
            }
        }
    }

    /// Puts ∂p/∂θ: output, parameter, slope.
    #[inline(always)]
    pub(super) fn parameter_slopes<T: Real>(
        &self,
        frame: &Frame,
        theta: &[f64],
        work: &Work<T>,
        sink: &mut impl Sink<T>,
    ) {
        let (amplitudes, monomials) = (work.amplitudes.len(), work.monomials.len());
        let (strain, registration) = (self.strain_range(), self.registration_range());
        let orders = strain.len() / 2;
        let zero = Triple::zero(work.amplitudes[0]);
        let one = zero.x.like(1.0);
        for marker in 0..self.at.len() {
            for i in 0..amplitudes {
                let slope = work.by_amplitude[marker * amplitudes + i];
                for (j, m) in work.monomials.iter().enumerate() {
                    put(sink, marker, i * monomials + j, slope * *m);
                }
                for n in 0..orders {
                    let k = i * orders + n;
                    put(sink, marker, strain.start + k, work.by_order[marker * strain.len() + k] * work.amplitudes[i]);
                }
            }
            for k in 0..3 {
                put(sink, marker, registration.start + k, frame.swung(work.turned[marker], k));
            }
            put(sink, marker, registration.start + 3, Triple { x: one, ..zero });
            put(sink, marker, registration.start + 4, Triple { y: one, ..zero });
            put(sink, marker, registration.start + 5, Triple { z: one, ..zero });
        }
        debug_assert_eq!(registration.end, theta.len());
    }

    /// Puts ∂p/∂q: output, actuator, slope.
    #[inline(always)]
    pub(super) fn actuator_slopes<T: Real>(&self, theta: &[f64], work: &Work<T>, sink: &mut impl Sink<T>) {
        let (amplitudes, monomials) = (work.amplitudes.len(), work.monomials.len());
        for a in 0..self.actuators {
            for marker in 0..self.at.len() {
                let mut slope = Triple::zero(work.amplitudes[0]);
                for i in 0..amplitudes {
                    let row = &theta[i * monomials..(i + 1) * monomials];
                    let turn = self.monomials.slope(row, &work.monomials, a);
                    slope = slope + work.by_amplitude[marker * amplitudes + i] * turn;
                }
                put(sink, marker, a, slope);
            }
        }
    }
}

/// Transforms from the arm's own frame to the measurement frame.
#[inline(always)]
fn place<T: Real>(frame: &Frame, positions: &[Triple<T>], turned: &mut [Triple<T>], sink: &mut impl Sink<T>) {
    for (marker, (position, turned)) in positions.iter().zip(turned).enumerate() {
        *turned = frame.turned(*position);
        sink.put(3 * marker, 0, turned.x + frame.base.x);
        sink.put(3 * marker + 1, 0, turned.y + frame.base.y);
        sink.put(3 * marker + 2, 0, turned.z + frame.base.z);
    }
}

/// Σ_j c_j m_j.
#[inline(always)]
fn sum<T: Real>(m: &[T], c: &[f64]) -> T {
    let mut sum = m[0] * c[0];
    for (m, c) in m[1..].iter().zip(&c[1..]) {
        sum = sum + *m * *c;
    }
    sum
}
