//! Initial values of a strain model's calibration, in closed form from the data.
//!
//! 1. Registration: the samples nearest to all actuators at zero show the arm straight. Their markers
//!    give the base, and with several markers the direction (where it lies within 60° of the axis).
//! 2. Curvature: the arc from one marker to the next has the bending axis e_z × t and the bending angle
//!    2·atan2(|t_xy|, t_z), where t is the next marker seen from the end of the arc before.
//! 3. Actuation map: linear least squares of these curvatures on the monomials.

use nalgebra::{DMatrix, Vector3};

use crate::fitting::linear;
use crate::fitting::observations::Observations;
use crate::kinematics::se3::{self, Pose};
use crate::kinematics::strain::StrainBasis;
use crate::registration::RegistrationSpec;
use crate::tip_model::StrainModel;

/// Share of the samples that count as near rest.
const NEAR_REST: usize = 50;

/// Angle between the markers at rest and the axis beyond which the markers are ignored, rad.
const LARGEST_TILT: f64 = std::f64::consts::FRAC_PI_3;

/// The model with the start's parameters; θ_s is left at zero.
pub(crate) fn start(model: StrainModel, data: &Observations) -> StrainModel {
    let mut theta = model.parameters().to_vec();
    if let RegistrationSpec::Identified { .. } = model.arm().registration {
        let registration = model.registration_range();
        theta[registration].copy_from_slice(&registration_at_rest(&model, data));
    }
    let model = model.with_parameters(&theta);
    let phi = actuation(&model, data);
    theta[model.actuation_range()].copy_from_slice(&phi);
    model.with_parameters(&theta)
}

/// Tilt (arm's own frame) and base from the straight arm.
fn registration_at_rest(model: &StrainModel, data: &Observations) -> [f64; 6] {
    let rest = markers_at_rest(data);
    let tilt = tilt(model, &rest);
    let direction = model.arm().axis.rotation() * se3::rotation(&tilt) * Vector3::z();
    let base = rest
        .iter()
        .zip(model.at())
        .map(|(marker, at)| marker - direction * (model.arm().length * at))
        .sum::<Vector3<f64>>()
        / rest.len() as f64;
    [tilt.x, tilt.y, 0.0, base.x, base.y, base.z]
}

/// Mean marker positions of the samples nearest to all actuators at zero, m.
fn markers_at_rest(data: &Observations) -> Vec<Vector3<f64>> {
    let spans: Vec<f64> = data.actuators.column_iter().map(|c| c.amax()).collect();
    let effort = |row: usize| -> f64 {
        let scaled = spans.iter().enumerate().filter(|(_, span)| **span > 0.0);
        scaled.map(|(a, span)| (data.actuators[(row, a)] / span).powi(2)).sum()
    };
    let mut rows: Vec<usize> = (0..data.samples()).collect();
    rows.sort_by(|&a, &b| effort(a).total_cmp(&effort(b)).then(a.cmp(&b)));
    rows.truncate(data.samples().div_ceil(NEAR_REST));
    let mean = data.measured.select_rows(&rows).row_mean();
    (0..data.at.len()).map(|k| Vector3::new(mean[3 * k], mean[3 * k + 1], mean[3 * k + 2])).collect()
}

/// Rotation vector from the reference axis to the line through the markers, arm's own frame, rad.
fn tilt(model: &StrainModel, rest: &[Vector3<f64>]) -> Vector3<f64> {
    let by_place = |a: &usize, b: &usize| model.at()[*a].total_cmp(&model.at()[*b]);
    let (first, last) = ((0..rest.len()).min_by(by_place), (0..rest.len()).max_by(by_place));
    let (Some(first), Some(last)) = (first, last) else {
        return Vector3::zeros();
    };
    let along = model.arm().axis.rotation().transpose() * (rest[last] - rest[first]);
    let axis = Vector3::z().cross(&along);
    let angle = axis.norm().atan2(along.z);
    if angle > LARGEST_TILT || axis.norm() == 0.0 {
        return Vector3::zeros();
    }
    axis.normalize() * angle
}

/// θ_Φ by linear least squares.
fn actuation(model: &StrainModel, data: &Observations) -> Vec<f64> {
    let design = model.monomials().design(&data.actuators).remove_column(0);
    let mut wanted = DMatrix::zeros(data.samples(), model.amplitudes());
    for sample in 0..data.samples() {
        let curvature = amplitudes(model, data, sample);
        wanted.row_mut(sample).copy_from_slice(&curvature);
    }
    // One column of coefficients per amplitude, which is the order of θ_Φ.
    linear::solve(&design, &wanted).coefficients.as_slice().to_vec()
}

/// Amplitudes that put one sample's markers on arcs, rad/m.
fn amplitudes(model: &StrainModel, data: &Observations, sample: usize) -> Vec<f64> {
    let arcs = arcs(model, data, sample);
    let total = arcs.last().map_or(1.0, |arc| arc.to);
    match model.arm().strain {
        StrainBasis::Legendre { .. } => {
            let shares = arcs.iter().map(|arc| arc.curvature * (arc.to - arc.from) / total);
            let mean: Vector3<f64> = shares.sum();
            vec![mean.x, mean.y]
        }
        StrainBasis::Piecewise { segments } => {
            let of_segment = |n: usize| {
                let middle = (n as f64 + 0.5) / segments as f64;
                let here = arcs.iter().find(|arc| middle < arc.to).or(arcs.last());
                here.map_or(Vector3::zeros(), |arc| arc.curvature)
            };
            let curvatures: Vec<Vector3<f64>> = (0..segments).map(of_segment).collect();
            let first = curvatures.iter().map(|k| k.x);
            first.chain(curvatures.iter().map(|k| k.y)).collect()
        }
    }
}

/// One arc between two markers, s/L from and to.
struct Arc {
    from: f64,
    to: f64,
    /// About x and y, rad/m.
    curvature: Vector3<f64>,
}

fn arcs(model: &StrainModel, data: &Observations, sample: usize) -> Vec<Arc> {
    let mut order: Vec<usize> = (0..data.at.len()).collect();
    order.sort_by(|&a, &b| data.at[a].total_cmp(&data.at[b]));
    let base = model.base_pose().inverse();
    let (mut g, mut from, mut arcs) = (Pose::identity(), 0.0, Vec::new());
    for k in order {
        let length = (data.at[k] - from) * model.arm().length;
        if length <= 0.0 {
            continue;
        }
        let row = data.measured.row(sample);
        let marker = Vector3::new(row[3 * k], row[3 * k + 1], row[3 * k + 2]);
        let target = g.inverse().apply(&base.apply(&marker));
        let curvature = curvature_to(&target, length);
        g = g.then(&se3::exp(&(curvature * length), &(Vector3::z() * length)));
        arcs.push(Arc { from, to: data.at[k], curvature });
        from = data.at[k];
    }
    arcs
}

/// Curvature of the arc that leaves along +z and points at `target`, rad/m.
fn curvature_to(target: &Vector3<f64>, length: f64) -> Vector3<f64> {
    let axis = Vector3::z().cross(target);
    let sideways = axis.norm();
    if sideways == 0.0 {
        return Vector3::zeros();
    }
    axis * (2.0 * sideways.atan2(target.z) / (sideways * length))
}
