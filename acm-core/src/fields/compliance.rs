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
//! Tendons that run along the arm at one distance are as long as its mean bending makes them, so they answer a load with
//! one moment for the whole arm, against the mean: the arm bends by k − c k̄ and its markers move by u − c ū. The share
//! c is 0 without tendons, κ/(EI + κ) for elastic ones that give the arm a bending stiffness κ, and 1 where they don't
//! stretch. Rucker & Webster (2011), IEEE T-RO 27(6), for tendons that act as a moment along the arm.
//!
//! First order about the arm as the nominal model bends it, at rest under the load. The axis of k and the tangent are seen
//! from the measurement frame. Panels of three nodes end at every marker and strain border; Simpson's rule over panels is of
//! fourth order, and exact for even loads on a straight arm. Gere & Timoshenko (1997), Mechanics of Materials, ch. 9:
//! moment-area method.

use nalgebra::Vector3;

use super::{Field, Load};
use crate::se3::Pose;
use crate::shape::{self, Shape};
use crate::tip_model::{self, StrainModel};

/// Panels over the whole arm, where no marker or border asks for more.
const PANELS: usize = 8;

/// Loads: each has a field of the free beam, and then each one that is held; the marker follows.
const LOADS: usize = Load::ALL.len();

/// Those of them that are spread along the arm: all but the weight at the tip.
const SPREAD: usize = LOADS - 1;

/// Axes across the arm.
const ACROSS: usize = 2;

/// What is common to all samples of one arm.
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
    nodes: Vec<Node>,
}

/// One node, seen from the base in the directions of the measurement frame.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    position: Vector3<f64>,
    tangent: Vector3<f64>,
    /// d_1 and d_2, and d × p.
    across: [Vector3<f64>; ACROSS],
    across_swing: [Vector3<f64>; ACROSS],
    /// w of each spread load, and its moment about the base.
    load: [Vector3<f64>; SPREAD],
    torque: [Vector3<f64>; SPREAD],
    /// k of each load, and k × p.
    bend: [Vector3<f64>; LOADS],
    swing: [Vector3<f64>; LOADS],
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

    /// Memory for [`FieldModel::evaluate`].
    pub fn scratch(&self) -> FieldScratch {
        FieldScratch {
            tip: self.model.scratch(),
            shape: self.shape.scratch(2 * self.model.arm().strain.functions()),
            poses: vec![Pose::identity(); self.shape.markers()],
            nodes: vec![Node::default(); self.shape.markers()],
        }
    }

    /// Displacement of each marker per unit of each field into `out`, laid out marker, field, x y z;
    /// `theta` are parameters of the model, `q` the actuators.
    pub fn evaluate(&self, theta: &[f64], q: &[f64], scratch: &mut FieldScratch, out: &mut [f64]) {
        let coordinates = self.model.strain_coordinates_with(theta, q, &mut scratch.tip);
        self.shape.poses(coordinates, &mut scratch.shape, &mut scratch.poses);
        let turn = self.model.base_pose_with(theta).rotation;
        for (node, pose) in scratch.nodes.iter_mut().zip(&scratch.poses) {
            node.position = turn * pose.position;
            let axes = turn * pose.rotation;
            node.tangent = axes.column(2).into();
            node.across = [axes.column(0).into(), axes.column(1).into()];
            node.across_swing = node.across.map(|axis| axis.cross(&node.position));
            self.load(node);
        }
        self.bend(&mut scratch.nodes);
        let mean = self.mean_bending(&scratch.nodes);
        self.displace(&scratch.nodes, &mean, out);
        let disk = self.model.arm().axis.rotation().transpose();
        for (&node, out) in self.markers.iter().zip(out.chunks_exact_mut(3 * Field::ALL.len())) {
            let axes = turn * scratch.poses[node].rotation * disk;
            out[3 * 2 * LOADS..].copy_from_slice(axes.as_slice());
        }
    }

    /// The spread loads at one node, in the order of the fields.
    fn load(&self, node: &mut Node) {
        let across = self.down - node.tangent * node.tangent.dot(&self.down);
        let drag = across * across.norm();
        let near = 1.0 - (node.position.dot(&self.down) / self.model.arm().length).clamp(0.0, 1.0);
        node.load = [self.down, drag, drag * near, self.sides[0], self.sides[1]];
        node.torque = node.load.map(|load| node.position.cross(&load));
    }

    /// Change of curvature at every node, from the tip inwards.
    fn bend(&self, nodes: &mut [Node]) {
        let last = nodes.len() - 1;
        // Force and its moment about the base, of all loads beyond the node: that at the tip, then those spread.
        let mut force = [Vector3::zeros(); LOADS];
        let mut torque = [Vector3::zeros(); LOADS];
        force[0] = self.down;
        torque[0] = nodes[last].position.cross(&self.down);
        follow(&mut nodes[last], &force, &torque);
        for (panel, half) in self.halves.iter().enumerate().rev() {
            let [a, m, b] = &mut nodes[2 * panel..2 * panel + 3] else { continue };
            let (mut middle_force, mut middle_torque) = (force, torque);
            for f in 0..SPREAD {
                middle_force[f + 1] += second_half(*half, a.load[f], m.load[f], b.load[f]);
                middle_torque[f + 1] += second_half(*half, a.torque[f], m.torque[f], b.torque[f]);
                force[f + 1] += simpson(*half, a.load[f], m.load[f], b.load[f]);
                torque[f + 1] += simpson(*half, a.torque[f], m.torque[f], b.torque[f]);
            }
            follow(m, &middle_force, &middle_torque);
            follow(a, &force, &torque);
        }
    }

    /// M̄ of each load along d_1 and d_2; that of k, since the part of M along the arm is across neither.
    fn mean_bending(&self, nodes: &[Node]) -> [[f64; ACROSS]; LOADS] {
        let mut mean = [[0.0; ACROSS]; LOADS];
        for (panel, &half) in self.halves.iter().enumerate() {
            for (node, weight) in nodes[2 * panel..2 * panel + 3].iter().zip([1.0, 4.0, 1.0]) {
                let share = weight * half / (3.0 * self.model.arm().length);
                let axes = node.across.map(|axis| axis * share);
                for (mean, bend) in mean.iter_mut().zip(&node.bend) {
                    mean.iter_mut().zip(&axes).for_each(|(mean, axis)| *mean += axis.dot(bend));
                }
            }
        }
        mean
    }

    /// Displacement of every marker from the change of curvature before it: of each load on the free beam, then of its mean.
    fn displace(&self, nodes: &[Node], mean: &[[f64; ACROSS]; LOADS], out: &mut [f64]) {
        let width = 3 * Field::ALL.len();
        let (mut turned, mut swung) = ([Vector3::zeros(); LOADS], [Vector3::zeros(); LOADS]);
        let (mut even_turned, mut even_swung) = ([Vector3::zeros(); ACROSS], [Vector3::zeros(); ACROSS]);
        for (panel, &half) in self.halves.iter().enumerate() {
            let [a, m, b] = &nodes[2 * panel..2 * panel + 3] else { continue };
            for f in 0..LOADS {
                turned[f] += simpson(half, a.bend[f], m.bend[f], b.bend[f]);
                swung[f] += simpson(half, a.swing[f], m.swing[f], b.swing[f]);
            }
            for i in 0..ACROSS {
                even_turned[i] += simpson(half, a.across[i], m.across[i], b.across[i]);
                even_swung[i] += simpson(half, a.across_swing[i], m.across_swing[i], b.across_swing[i]);
            }
            for (_, out) in self.markers.iter().zip(out.chunks_exact_mut(width)).filter(|(n, _)| **n == 2 * panel + 2) {
                let (free, rest) = out.split_at_mut(3 * LOADS);
                for (f, out) in free.chunks_exact_mut(3).enumerate() {
                    out.copy_from_slice((turned[f].cross(&b.position) - swung[f]).as_slice());
                }
                let even = [0, 1].map(|i| even_turned[i].cross(&b.position) - even_swung[i]);
                for (mean, out) in mean.iter().zip(rest.chunks_exact_mut(3)) {
                    out.copy_from_slice((even[0] * mean[0] + even[1] * mean[1]).as_slice());
                }
            }
        }
    }
}

/// Curvature at a node from force and moment beyond it.
fn follow(node: &mut Node, force: &[Vector3<f64>; LOADS], torque: &[Vector3<f64>; LOADS]) {
    for f in 0..LOADS {
        let moment = torque[f] - node.position.cross(&force[f]);
        node.bend[f] = moment - node.tangent * node.tangent.dot(&moment);
        node.swing[f] = node.bend[f].cross(&node.position);
    }
}

/// ∫ over a panel of the parabola through its nodes.
fn simpson(half: f64, a: Vector3<f64>, m: Vector3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    (a + m * 4.0 + b) * (half / 3.0)
}

/// ∫ of the same parabola from the middle node to the last.
fn second_half(half: f64, a: Vector3<f64>, m: Vector3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    (m * 8.0 + b * 5.0 - a) * (half / 12.0)
}

/// Ends of panels in order: base, borders, markers, tip, and what divides the stretches between them.
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
