//! Bending of an arm under N loads at once: moments from the tip inwards, displacements from the base outwards.
//!
//! The equations stand at the head of `compliance.rs`. Everything is linear in the loads: those of one call may be units of
//! load, or the sum of all that acts.

use nalgebra::Vector3;

/// Axes across the arm.
pub(super) const ACROSS: usize = 2;

/// Where one node is, seen from the base in the directions of the measurement frame.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Place {
    pub position: Vector3<f64>,
    pub tangent: Vector3<f64>,
    /// d_1 and d_2.
    pub across: [Vector3<f64>; ACROSS],
    /// Drag of a jet that keeps its strength, and of one that loses it all on its way down.
    pub drag: [Vector3<f64>; 2],
}

/// Contributions of N loads at one node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node<const N: usize> {
    /// w of each load, and its moment about the base.
    load: [Vector3<f64>; N],
    torque: [Vector3<f64>; N],
    /// k of each load.
    bend: [Vector3<f64>; N],
}

impl<const N: usize> Default for Node<N> {
    fn default() -> Self {
        let zero = [Vector3::zeros(); N];
        Self { load: zero, torque: zero, bend: zero }
    }
}

impl<const N: usize> Node<N> {
    /// Under `load` per length.
    pub fn under(load: [Vector3<f64>; N], place: &Place) -> Self {
        Self { load, torque: load.map(|load| place.position.cross(&load)), ..Self::default() }
    }

    /// Curvature from force and moment beyond the node.
    #[inline(always)]
    fn follow(&mut self, place: &Place, force: &[Vector3<f64>; N], torque: &[Vector3<f64>; N]) {
        for f in 0..N {
            let moment = torque[f] - place.position.cross(&force[f]);
            self.bend[f] = moment - place.tangent * place.tangent.dot(&moment);
        }
    }
}

/// Change of curvature at every node, from the tip inwards; `force` at the tip.
pub(super) fn bend<const N: usize>(
    halves: &[f64],
    places: &[Place],
    nodes: &mut [Node<N>],
    mut force: [Vector3<f64>; N],
) {
    let last = nodes.len() - 1;
    // Force and its moment about the base, of all loads beyond the node.
    let mut torque = force.map(|force| places[last].position.cross(&force));
    nodes[last].follow(&places[last], &force, &torque);
    for (panel, half) in halves.iter().enumerate().rev() {
        let [a, m, b] = &mut nodes[2 * panel..2 * panel + 3] else { continue };
        let (mut middle_force, mut middle_torque) = (force, torque);
        for f in 0..N {
            middle_force[f] += second_half(*half, a.load[f], m.load[f], b.load[f]);
            middle_torque[f] += second_half(*half, a.torque[f], m.torque[f], b.torque[f]);
            force[f] += simpson(*half, a.load[f], m.load[f], b.load[f]);
            torque[f] += simpson(*half, a.torque[f], m.torque[f], b.torque[f]);
        }
        m.follow(&places[2 * panel + 1], &middle_force, &middle_torque);
        a.follow(&places[2 * panel], &force, &torque);
    }
}

/// ∫ d_i·M ds of each load along d_1 and d_2; that of k, since M along the arm is normal to both.
pub(super) fn bending<const N: usize>(halves: &[f64], places: &[Place], nodes: &[Node<N>]) -> [[f64; ACROSS]; N] {
    let mut sum = [[0.0; ACROSS]; N];
    for (panel, &half) in halves.iter().enumerate() {
        let nodes = places[2 * panel..2 * panel + 3].iter().zip(&nodes[2 * panel..2 * panel + 3]);
        for ((place, node), weight) in nodes.zip([1.0, 4.0, 1.0]) {
            let axes = place.across.map(|axis| axis * (weight * half / 3.0));
            for (sum, bend) in sum.iter_mut().zip(&node.bend) {
                sum.iter_mut().zip(&axes).for_each(|(sum, axis)| *sum += axis.dot(bend));
            }
        }
    }
    sum
}

/// Displacement of every marker from the change of curvature before it, by each load; `at` receives the marker.
pub(super) fn displacements<const N: usize>(
    halves: &[f64],
    markers: &[usize],
    places: &[Place],
    nodes: &[Node<N>],
    mut at: impl FnMut(usize, [Vector3<f64>; N]),
) {
    // k × p of each load at a node.
    let swing = |node: usize| nodes[node].bend.map(|bend| bend.cross(&places[node].position));
    let (mut turned, mut swung) = ([Vector3::zeros(); N], [Vector3::zeros(); N]);
    let mut first = swing(0);
    for (panel, &half) in halves.iter().enumerate() {
        let [a, m, b] = &nodes[2 * panel..2 * panel + 3] else { continue };
        let (middle, end) = (swing(2 * panel + 1), swing(2 * panel + 2));
        for f in 0..N {
            turned[f] += simpson(half, a.bend[f], m.bend[f], b.bend[f]);
            swung[f] += simpson(half, first[f], middle[f], end[f]);
        }
        first = end;
        for marker in (0..markers.len()).filter(|&marker| markers[marker] == 2 * panel + 2) {
            let place = &places[2 * panel + 2];
            at(marker, std::array::from_fn(|f| turned[f].cross(&place.position) - swung[f]));
        }
    }
}

/// Adds one curvature everywhere, along d_1 times the first of `mean` and along d_2 times the second, to each load.
pub(super) fn add_even<const N: usize>(places: &[Place], nodes: &mut [Node<N>], mean: [[f64; ACROSS]; N]) {
    for (node, place) in nodes.iter_mut().zip(places) {
        for (f, [first, second]) in mean.iter().enumerate() {
            node.bend[f] += place.across[0] * *first + place.across[1] * *second;
        }
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
