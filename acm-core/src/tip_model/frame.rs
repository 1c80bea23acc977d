//! Registration of a strain model, ready to apply.
//!
//! ```text
//! p = C·U·r + p_0,   C·U = U·exp([w]),   δ(C·U·r) = −[C·U·r] · spin · δw,   spin = U · J(w)
//! ```
//!
//! | symbol | meaning                                         | shape | unit |
//! | `U`    | from the arm's own frame to that of its mounting | 3 × 3 | 1    |
//! | `w`    | rotation vector of C in the arm's own frame     | 3     | rad  |
//! | `J`    | left Jacobian of the rotation, see [`crate::kinematics::se3`] | 3 × 3 | 1    |

use nalgebra::{Matrix3, Vector3};

use super::StrainModel;
use crate::kinematics::real::Real;
use crate::kinematics::se3;
use crate::kinematics::triple::Triple;

/// C·U, p_0 and spin at one set of parameters.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Frame {
    pub turn: Matrix3<f64>,
    pub base: Vector3<f64>,
    pub spin: Matrix3<f64>,
}

impl StrainModel {
    /// The frame at the parameters `theta`.
    pub(crate) fn frame_of(&self, theta: &[f64]) -> Frame {
        let place = &theta[self.registration_range()];
        let w = Vector3::new(place[0], place[1], place[2]);
        Frame {
            turn: self.axis * se3::rotation(&w),
            base: Vector3::new(place[3], place[4], place[5]),
            spin: self.axis * se3::left_jacobian(&w),
        }
    }
}

impl Frame {
    /// C·U·r.
    #[inline(always)]
    pub fn turned<T: Real>(&self, r: Triple<T>) -> Triple<T> {
        Triple::new(self.row(r, 0), self.row(r, 1), self.row(r, 2))
    }

    #[inline(always)]
    fn row<T: Real>(&self, r: Triple<T>, k: usize) -> T {
        r.x * self.turn[(k, 0)] + r.y * self.turn[(k, 1)] + r.z * self.turn[(k, 2)]
    }

    /// Slope of the marker at C·U·r with component `k` of w.
    #[inline(always)]
    pub fn swung<T: Real>(&self, turned: Triple<T>, k: usize) -> Triple<T> {
        let (like, spin) = (turned.x, self.spin.column(k));
        let axis = Triple::new(like.like(spin[0]), like.like(spin[1]), like.like(spin[2]));
        axis.cross(turned)
    }
}
