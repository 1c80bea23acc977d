//! The arm as a chain of universal joints: positions of its points, and moments of loads.
//!
//! ```text
//! R_{j+1} = R_j · Rx(α_j) · Ry(β_j),     c_{j+1} = c_j + ℓ·R_{j+1}·e_z
//! Q_i     = Σ_k f_k · (a_i × (p_k − c_i)),        k beyond joint i
//! ∂Q_i/∂θ_m = a_m · [M_i·a_i − a_i·tr M_i],   M_i = Σ_k (p_k − c_i) f_kᵀ,   m not beyond i
//! ```
//!
//! | symbol | meaning                                              | shape | unit |
//! | `θ`    | joint angles (α_0, β_0, α_1, β_1, …)                  | 2N    | rad  |
//! | `c_j`  | joint centres, in the middle of each of N elements    | 3     | m    |
//! | `a_i`  | axis of coordinate i                                 | 3     | 1    |
//! | `f_k`  | dead loads at joint centres and (last) at the tip     | 3     | N    |
//! | `Q_i`  | moment of the loads about axis i                     | 2N    | N·m  |
//!
//! A joint in the middle of each element is the midpoint rule: second order in 1/N. The second line holds
//! for dead loads, whose moments derive from a potential, so ∂Q/∂θ is symmetric. Axial compression shortens
//! every length by the same factor, so moments scale with it.
//! Source: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 4; derivation of ∂Q/∂θ by a × (b × r).

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};

/// Positions and axes of the chain in one configuration, lengths uncompressed.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Joint centres, then the tip, relative to the attachment, m.
    pub points: Vec<Vector3<f64>>,
    /// Axis of each coordinate, unit vectors.
    pub axes: Vec<Vector3<f64>>,
    /// Direction of the arm at each joint (mean of its two sides), unit vectors.
    pub tangents: Vec<Vector3<f64>>,
}

impl Chain {
    /// Returns the configuration of a straight arm's worth of joints, all at the attachment.
    pub fn new(joints: usize) -> Self {
        Self {
            points: vec![Vector3::zeros(); joints + 1],
            axes: vec![Vector3::zeros(); 2 * joints],
            tangents: vec![Vector3::z(); joints],
        }
    }

    /// Returns the number of joints N.
    pub fn joints(&self) -> usize {
        self.tangents.len()
    }

    /// Places the chain: `base` turns the attachment frame into the world, `element` is ℓ in m.
    pub fn place(&mut self, base: &Rotation3<f64>, angles: &DVector<f64>, element: f64) {
        let mut frame = *base.matrix();
        let mut point = 0.5 * element * frame.column(2);
        for joint in 0..self.joints() {
            self.points[joint] = point;
            let before: Vector3<f64> = frame.column(2).into();
            self.axes[2 * joint] = frame.column(0).into();
            frame = turn_x(&frame, angles[2 * joint]);
            self.axes[2 * joint + 1] = frame.column(1).into();
            frame = turn_y(&frame, angles[2 * joint + 1]);
            let after: Vector3<f64> = frame.column(2).into();
            self.tangents[joint] = (before + after).normalize();
            point += element * after;
        }
        let last = 0.5 * element * frame.column(2);
        self.points[self.axes.len() / 2] = point - last;
    }

    /// Writes the moments of the loads about every axis to `moments`.
    pub fn moments(&self, loads: &[Vector3<f64>], moments: &mut DVector<f64>) {
        let mut force = Vector3::zeros();
        let mut moment = Vector3::zeros();
        for joint in (0..self.joints()).rev() {
            force += loads[joint + 1];
            moment += self.points[joint + 1].cross(&loads[joint + 1]);
            let about = moment - self.points[joint].cross(&force);
            moments[2 * joint] = self.axes[2 * joint].dot(&about);
            moments[2 * joint + 1] = self.axes[2 * joint + 1].dot(&about);
        }
    }

    /// Writes the derivative of the moments by the angles to `derivative` (2N × 2N, symmetric).
    pub fn moment_derivative(&self, loads: &[Vector3<f64>], derivative: &mut DMatrix<f64>) {
        let mut force = Vector3::zeros();
        let mut virial = Matrix3::zeros();
        for joint in (0..self.joints()).rev() {
            let load = loads[joint + 1];
            force += load;
            virial += self.points[joint + 1] * load.transpose();
            let about = virial - self.points[joint] * force.transpose();
            for row in [2 * joint, 2 * joint + 1] {
                let axis = self.axes[row];
                let lever = about * axis - axis * about.trace();
                for column in 0..=row {
                    let value = self.axes[column].dot(&lever);
                    derivative[(row, column)] = value;
                    derivative[(column, row)] = value;
                }
            }
        }
    }
}

/// Returns `frame · Rx(angle)`.
fn turn_x(frame: &Matrix3<f64>, angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = angle.sin_cos();
    let (y, z) = (frame.column(1), frame.column(2));
    Matrix3::from_columns(&[frame.column(0).into(), y * cosine + z * sine, z * cosine - y * sine])
}

/// Returns `frame · Ry(angle)`.
fn turn_y(frame: &Matrix3<f64>, angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = angle.sin_cos();
    let (x, z) = (frame.column(0), frame.column(2));
    Matrix3::from_columns(&[x * cosine - z * sine, frame.column(1).into(), x * sine + z * cosine])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent(joints: usize) -> (Chain, DVector<f64>, Vec<Vector3<f64>>) {
        let angles = DVector::from_fn(2 * joints, |i, _| 0.21 * (1.3 * i as f64 + 0.4).sin());
        let loads = (0..=joints)
            .map(|k| Vector3::new((k as f64).sin(), (2.0 * k as f64).cos(), -1.0 - 0.1 * k as f64))
            .collect();
        let mut chain = Chain::new(joints);
        chain.place(&base(), &angles, 0.1);
        (chain, angles, loads)
    }

    fn base() -> Rotation3<f64> {
        Rotation3::from_euler_angles(3.0, 0.1, 0.2)
    }

    /// Oracle: rotations composed by nalgebra.
    #[test]
    fn tip_is_the_product_of_rotations() {
        let (chain, angles, _) = bent(5);
        let mut frame = base();
        let mut tip = Vector3::zeros();
        for joint in 0..5 {
            tip += frame * Vector3::new(0.0, 0.0, 0.05);
            frame *= Rotation3::from_axis_angle(&Vector3::x_axis(), angles[2 * joint]);
            frame *= Rotation3::from_axis_angle(&Vector3::y_axis(), angles[2 * joint + 1]);
            tip += frame * Vector3::new(0.0, 0.0, 0.05);
        }
        assert!((chain.points[5] - tip).norm() < 1e-14);
    }

    /// Oracle: the moments are the derivative of the work Σ f·p, by central differences.
    #[test]
    fn moments_are_the_gradient_of_the_work_of_the_loads() {
        let (chain, angles, loads) = bent(5);
        let mut moments = DVector::zeros(10);
        chain.moments(&loads, &mut moments);
        let work = |angles: &DVector<f64>| {
            let mut chain = Chain::new(5);
            chain.place(&base(), angles, 0.1);
            chain.points.iter().zip(&loads).map(|(p, f)| p.dot(f)).sum::<f64>()
        };
        for i in 0..10 {
            let (mut up, mut down) = (angles.clone(), angles.clone());
            up[i] += 1e-5;
            down[i] -= 1e-5;
            let slope = (work(&up) - work(&down)) / 2e-5;
            assert!((slope - moments[i]).abs() < 1e-8, "coordinate {i}: {slope} {}", moments[i]);
        }
    }

    /// Oracle: central differences of the moments.
    #[test]
    fn moment_derivative_matches_finite_differences() {
        let (chain, angles, loads) = bent(5);
        let mut derivative = DMatrix::zeros(10, 10);
        chain.moment_derivative(&loads, &mut derivative);
        let moments = |angles: &DVector<f64>| {
            let mut chain = Chain::new(5);
            chain.place(&base(), angles, 0.1);
            let mut moments = DVector::zeros(10);
            chain.moments(&loads, &mut moments);
            moments
        };
        for m in 0..10 {
            let (mut up, mut down) = (angles.clone(), angles.clone());
            up[m] += 1e-5;
            down[m] -= 1e-5;
            let slope = (moments(&up) - moments(&down)) / 2e-5;
            assert!((slope - derivative.column(m)).amax() < 1e-8, "column {m}");
        }
    }
}
