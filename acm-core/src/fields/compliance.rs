//! Compliance of a bent arm: how a small load moves each marker.
//!
//! ```text
//! M(s)  = ∫_s^L (p(σ) − p(s)) × w(σ) dσ + (p(L) − p(s)) × F
//! k(s)  = M(s) − t(s) (t(s)·M(s))                         bending follows the moment, twist does not
//! M̄_i   = 1/L ∫_0^L d_i(s)·M(s) ds,   i = 1, 2            mean bending, as the disks see it
//! k̄(s)  = d_1(s) M̄_1 + d_2(s) M̄_2                         the same bending everywhere along the arm
//! u_m   = ∫_0^{s_m} k(s) × (p(s_m) − p(s)) ds,   ū_m the same of k̄
//! ```
//!
//! | symbol | meaning                                                                    | unit  |
//! | `w`    | load per length over bending stiffness, spread along the arm               | 1/m³  |
//! | `F`    | force at the tip over bending stiffness                                     | 1/m²  |
//! | `M`    | moment over stiffness of all that lies beyond s                             | rad/m |
//! | `k`    | change of curvature of a free beam, t the tangent                           | rad/m |
//! | `d_i`  | axes of the disk at s, across the arm                                       | 1     |
//! | `u_m`  | displacement of marker m, in the measurement frame                          | m     |
//!
//! Tendons at one distance along the arm change length with its mean bending, so they resist a load with one moment for the
//! whole arm, against the mean: the arm bends by k − c k̄ and its markers move by u − c ū. The share c is 0 without tendons,
//! κ/(EI + κ) for elastic ones that give the arm a bending stiffness κ, and 1 where they don't stretch.
//! Rucker & Webster (2011), IEEE T-RO 27(6), for tendons that act as a moment along the arm.
//!
//! All of it is linear in the loads, so that loads which act together are added up before they bend the arm.
//!
//! First order about the arm as the nominal model bends it, at rest under the load. The axis of k and the tangent are seen
//! from the measurement frame. Panels of three nodes end at every marker and strain border; Simpson's rule over panels is of
//! fourth order, and exact for even loads on a straight arm. Gere & Timoshenko (1997), Mechanics of Materials, ch. 9:
//! moment-area method.

use nalgebra::{Matrix3, Vector3};

use super::Field;
use super::Load;
use super::beam::{self, ACROSS, Node, Place};
use crate::kinematics::se3::Pose;
use crate::kinematics::shape::{self, Shape};
use crate::tip_model::{self, StrainModel};

/// Panels over the whole arm, where no marker or border asks for more.
const PANELS: usize = 8;

/// Loads: each has a free field, and then each has a held one; the marker fields follow.
const LOADS: usize = Load::ALL.len();

/// Precomputed values that all samples of one arm share.
#[derive(Debug, Clone)]
pub struct FieldModel {
    model: StrainModel,
    shape: Shape,
    /// Half the length of each panel, m; panel j has the nodes 2j, 2j + 1, 2j + 2.
    halves: Vec<f64>,
    /// Node at which each marker sits.
    markers: Vec<usize>,
    down: Vector3<f64>,
    sides: [Vector3<f64>; 2],
}

/// Memory of one evaluation, reused from sample to sample.
#[derive(Debug, Clone)]
pub struct FieldScratch {
    tip: tip_model::Scratch,
    shape: shape::Scratch,
    poses: Vec<Pose>,
    places: Vec<Place>,
    units: Vec<Node<LOADS>>,
    sum: Vec<Node<1>>,
}

impl FieldModel {
    /// For the arm of `model`, of which only geometry matters here; `down` is a unit vector in the measurement frame.
    pub fn new(model: &StrainModel, down: Vector3<f64>) -> Self {
        let (arm, at) = (model.arm(), model.at());
        let places = places(&arm.strain.borders(), at);
        let nodes: Vec<f64> = places.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]).collect();
        let nodes: Vec<f64> = nodes.into_iter().chain([1.0]).collect();
        let halves = places.windows(2).map(|pair| 0.5 * arm.length * (pair[1] - pair[0])).collect();
        let place = |at: &f64| 2 * places.iter().position(|place| place == at).unwrap_or(0);
        let down = down.try_normalize(0.0).unwrap_or(-Vector3::z());
        Self {
            model: model.clone(),
            shape: Shape::new(arm.length, arm.strain, &nodes, 1, None),
            halves,
            markers: at.iter().map(place).collect(),
            down,
            sides: horizontal(&down),
        }
    }

    /// The arm with its nodes in the place of markers: panel j has the nodes 2j, 2j + 1, 2j + 2.
    pub fn nodes(&self) -> &Shape {
        &self.shape
    }

    /// Half the length of each panel, m.
    pub fn half_panels(&self) -> &[f64] {
        &self.halves
    }

    /// Node at which each marker sits.
    pub fn marker_nodes(&self) -> &[usize] {
        &self.markers
    }

    /// Unit vectors in the measurement frame: down, first and second horizontal axis.
    pub fn directions(&self) -> [Vector3<f64>; 3] {
        [self.down, self.sides[0], self.sides[1]]
    }

    /// Memory for [`FieldModel::evaluate`] and [`FieldModel::add`].
    pub fn scratch(&self) -> FieldScratch {
        let nodes = self.shape.markers();
        FieldScratch {
            tip: self.model.scratch(),
            shape: self.shape.scratch(2 * self.model.arm().strain.functions()),
            poses: vec![Pose::identity(); nodes],
            places: vec![Place::default(); nodes],
            units: vec![Node::default(); nodes],
            sum: vec![Node::default(); nodes],
        }
    }

    /// Displacement of each marker per unit of each field into `out`, laid out marker, field, x y z;
    /// `theta` are parameters of the model, `q` the actuators.
    pub fn evaluate(&self, theta: &[f64], q: &[f64], scratch: &mut FieldScratch, out: &mut [f64]) {
        self.place(theta, q, scratch);
        let width = 3 * Field::ALL.len();
        let FieldScratch { poses, places, units, .. } = scratch;
        for (node, place) in units.iter_mut().zip(&*places) {
            let [wash, near] = place.drag;
            let load = [Vector3::zeros(), self.down, wash, near, self.sides[0], self.sides[1]];
            *node = Node::under(load, place);
        }
        let mut tip = [Vector3::zeros(); LOADS];
        tip[0] = self.down;
        beam::bend(&self.halves, places, units, tip);
        let mean = self.mean(places, units);
        let mut put = |first: usize, units: &[Node<LOADS>]| {
            beam::displacements(&self.halves, &self.markers, places, units, |marker, u| {
                let out = out[marker * width + 3 * first..].chunks_exact_mut(3);
                out.zip(&u).for_each(|(out, u)| out.copy_from_slice(u.as_slice()));
            });
        };
        put(0, units);
        units.fill(Node::default());
        beam::add_even(places, units, mean);
        put(LOADS, units);
        for (&node, out) in self.markers.iter().zip(out.chunks_exact_mut(width)) {
            out[3 * 2 * LOADS..].copy_from_slice(self.disk(&poses[node]).as_slice());
        }
    }

    /// Adds Σ_f w_f u_f to each marker's place in `out`; `weights` has one entry for each field.
    pub fn add(&self, theta: &[f64], q: &[f64], weights: &[f64], scratch: &mut FieldScratch, out: &mut [f64]) {
        self.place(theta, q, scratch);
        let (free, rest) = weights.split_at(LOADS);
        let (held, marker) = rest.split_at(LOADS);
        let acts = |weights: &[f64]| weights.iter().any(|weight| *weight != 0.0);
        if acts(free) || acts(held) {
            let mean = acts(held).then(|| {
                self.bend(held, scratch);
                self.mean(&scratch.places, &scratch.sum)
            });
            self.bend(free, scratch);
            let FieldScratch { places, sum, .. } = scratch;
            if let Some(mean) = mean {
                beam::add_even(places, sum, mean);
            }
            beam::displacements(&self.halves, &self.markers, places, sum, |marker, [u]| {
                out[3 * marker..].iter_mut().zip(u.iter()).for_each(|(out, u)| *out += u);
            });
        }
        if acts(marker) {
            let moved = Vector3::from_column_slice(marker);
            for (&node, out) in self.markers.iter().zip(out.chunks_exact_mut(3)) {
                let u = self.disk(&scratch.poses[node]) * moved;
                out.iter_mut().zip(u.iter()).for_each(|(out, u)| *out += u);
            }
        }
    }

    /// Where the nodes are.
    fn place(&self, theta: &[f64], q: &[f64], scratch: &mut FieldScratch) {
        let coordinates = self.model.strain_coordinates_with(theta, q, &mut scratch.tip);
        let base = Pose { rotation: self.model.base_pose_with(theta).rotation, position: Vector3::zeros() };
        self.shape.poses_from(base, coordinates, &mut scratch.shape, &mut scratch.poses);
        for (place, pose) in scratch.places.iter_mut().zip(&scratch.poses) {
            let axis = |j: usize| -> Vector3<f64> { pose.rotation.column(j).into() };
            let drag = self.drag(&pose.position, &axis(2));
            *place = Place { position: pose.position, tangent: axis(2), across: [axis(0), axis(1)], drag };
        }
    }

    /// Bends the arm under one load: Σ w of all.
    fn bend(&self, weights: &[f64], scratch: &mut FieldScratch) {
        let even = self.down * weights[Load::SelfWeight as usize]
            + self.sides[0] * weights[Load::SideFirst as usize]
            + self.sides[1] * weights[Load::SideSecond as usize];
        for (node, place) in scratch.sum.iter_mut().zip(&scratch.places) {
            let [wash, near] = place.drag;
            let load = even + wash * weights[Load::Wash as usize] + near * weights[Load::WashNear as usize];
            *node = Node::under([load], place);
        }
        let tip = self.down * weights[Load::TipWeight as usize];
        beam::bend(&self.halves, &scratch.places, &mut scratch.sum, [tip]);
    }

    /// Loads [`Load::Wash`] and [`Load::WashNear`] at one node.
    fn drag(&self, position: &Vector3<f64>, tangent: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let across = self.down - tangent * tangent.dot(&self.down);
        let drag = across * across.norm();
        let near = 1.0 - (position.dot(&self.down) / self.model.arm().length).clamp(0.0, 1.0);
        [drag, drag * near]
    }

    /// M̄ of each load.
    fn mean<const N: usize>(&self, places: &[Place], nodes: &[Node<N>]) -> [[f64; ACROSS]; N] {
        beam::bending(&self.halves, places, nodes).map(|sum| sum.map(|sum| sum / self.model.arm().length))
    }

    /// Axes of the disk at a pose.
    fn disk(&self, pose: &Pose) -> Matrix3<f64> {
        pose.rotation * self.model.arm().axis.rotation().transpose()
    }
}

/// Ends of panels in order: base, borders, markers, tip, and divisions between them.
fn places(borders: &[f64], at: &[f64]) -> Vec<f64> {
    let mut fixed: Vec<f64> = [0.0, 1.0].iter().chain(borders).chain(at).copied().collect();
    fixed.sort_by(f64::total_cmp);
    fixed.dedup();
    let mut places = vec![0.0];
    for pair in fixed.windows(2) {
        let panels = ((pair[1] - pair[0]) * PANELS as f64 - 1e-9).ceil().max(1.0) as usize;
        let width = (pair[1] - pair[0]) / panels as f64;
        places.extend((1..panels).map(|k| pair[0] + k as f64 * width));
        places.push(pair[1]);
    }
    places
}

/// Two horizontal unit vectors that make a right-handed frame with the upward one. The first lies under the x axis, or under
/// the y axis where x is nearly vertical.
pub fn horizontal(down: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let axis = if down.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let first = (axis - down * down.dot(&axis)).normalize();
    [first, first.cross(down)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, for an arm that hangs and one that lies along x.
    #[test]
    fn horizontal_axes_are_those_of_the_frame() {
        let hanging = horizontal(&-Vector3::z());
        assert_eq!(hanging, [Vector3::x(), Vector3::y()]);
        let turned = horizontal(&Vector3::x());
        assert_eq!(turned, [Vector3::y(), -Vector3::z()]);
    }

    #[test]
    fn panels_end_at_markers_and_borders() {
        let places = places(&[0.5], &[0.3, 1.0, 0.3]);
        assert!([0.0, 0.3, 0.5, 1.0].iter().all(|place| places.contains(place)), "{places:?}");
        assert!(places.windows(2).all(|pair| pair[1] > pair[0] && pair[1] - pair[0] <= 0.125 + 1e-9), "{places:?}");
    }
}
