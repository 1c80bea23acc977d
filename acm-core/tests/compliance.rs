//! How loads move the markers of a bent arm: closed forms of beams, and the difference of two shapes.

use acm_core::axis::Axis;
use acm_core::fields::{Field, FieldModel, Load, horizontal};
use acm_core::registration::RegistrationSpec;
use acm_core::shape::Shape;
use acm_core::strain::StrainBasis;
use acm_core::{ArmSpec, StrainModel};
use nalgebra::{Matrix3, Vector3};

const LENGTH: f64 = 0.62;

/// Numbers for each marker.
const WIDTH: usize = 3 * Field::ALL.len();

fn arm(axis: Axis, strain: StrainBasis) -> ArmSpec {
    ArmSpec {
        length: LENGTH,
        axis,
        strain,
        degree: 1,
        registration: RegistrationSpec::Identified { twist: true },
        ..ArmSpec::default()
    }
}

/// Displacements of all markers, [marker][field].
fn displacements(model: &StrainModel, down: Vector3<f64>, q: &[f64]) -> Vec<Vec<Vector3<f64>>> {
    let fields = FieldModel::new(model, down);
    let mut out = vec![f64::NAN; model.at().len() * WIDTH];
    fields.evaluate(model.parameters(), q, &mut fields.scratch(), &mut out);
    let marker = |values: &[f64]| values.chunks_exact(3).map(Vector3::from_column_slice).collect();
    out.chunks_exact(WIDTH).map(marker).collect()
}

/// Displacement by a load on the free arm.
fn of(fields: &[Vector3<f64>], load: Load) -> Vector3<f64> {
    fields[Field::Free(load).column()]
}

/// Displacement by the mean of its bending.
fn held(fields: &[Vector3<f64>], load: Load) -> Vector3<f64> {
    fields[Field::Held(load).column()]
}

/// A bent arm: its parameters differ from one another, and its base is tilted.
fn bent(axis: Axis, strain: StrainBasis, at: &[f64]) -> StrainModel {
    let model = StrainModel::new(&arm(axis, strain), 2, at).unwrap();
    let mut theta: Vec<f64> = (0..model.parameters().len()).map(|j| 2.0 * (0.3 + 1.9 * j as f64).sin()).collect();
    theta[model.registration_range()].copy_from_slice(&[0.1, -0.2, 0.3, 0.4, -0.5, 0.6]);
    model.with_parameters(&theta)
}

/// Oracle: a cantilever that stands out along x. At s, a force F at the end gives F s² (3L − s)/6EI and a load w
/// along it w s² (6L² − 4Ls + s²)/24EI; at the end F L³/3EI and w L⁴/8EI.
#[test]
fn a_straight_beam_bends_as_in_the_textbook() {
    let model = StrainModel::new(&arm(Axis::X, StrainBasis::default()), 1, &[1.0, 0.37]).unwrap();
    let found = displacements(&model, -Vector3::z(), &[0.0]);
    let end = &found[0];
    assert!((of(end, Load::TipWeight) + Vector3::z() * LENGTH.powi(3) / 3.0).norm() < 1e-14);
    assert!((of(end, Load::SelfWeight) + Vector3::z() * LENGTH.powi(4) / 8.0).norm() < 1e-14);
    for (at, found) in [1.0, 0.37].iter().zip(&found) {
        let s = at * LENGTH;
        let force = s * s * (3.0 * LENGTH - s) / 6.0;
        let spread = s * s * (6.0 * LENGTH * LENGTH - 4.0 * LENGTH * s + s * s) / 24.0;
        assert!((of(found, Load::TipWeight) + Vector3::z() * force).norm() < 1e-14);
        // The wind blows across the whole arm, all of it at the height of the base.
        for field in [Load::SelfWeight, Load::Wash, Load::WashNear] {
            assert!((of(found, field) + Vector3::z() * spread).norm() < 1e-14, "{field:?}");
        }
        // The first horizontal axis lies along the arm, and a load along a straight arm bends nothing.
        assert!(of(found, Load::SideFirst).norm() < 1e-15);
        assert!((of(found, Load::SideSecond) - Vector3::y() * spread).norm() < 1e-14);
    }
}

/// Oracle: the cantilever's mean moment is F L/2 of a force at the end, and w L²/6 of a load along it. Bent by that
/// everywhere it is at F L s²/4 and w L² s²/12. Held whole, a force at the end leaves F L³/12 there, as for a beam whose
/// end cannot turn.
#[test]
fn tendons_hold_the_mean_moment_of_a_straight_beam() {
    let model = StrainModel::new(&arm(Axis::X, StrainBasis::default()), 1, &[1.0, 0.37]).unwrap();
    let found = displacements(&model, -Vector3::z(), &[0.0]);
    for (at, found) in [1.0, 0.37].iter().zip(&found) {
        let s = at * LENGTH;
        let (force, spread) = (LENGTH * s * s / 4.0, LENGTH * LENGTH * s * s / 12.0);
        assert!((held(found, Load::TipWeight) + Vector3::z() * force).norm() < 1e-14);
        for load in [Load::SelfWeight, Load::Wash, Load::WashNear] {
            assert!((held(found, load) + Vector3::z() * spread).norm() < 1e-14, "{load:?}");
        }
        assert!(held(found, Load::SideFirst).norm() < 1e-15);
        assert!((held(found, Load::SideSecond) - Vector3::y() * spread).norm() < 1e-14);
    }
    let left = of(&found[0], Load::TipWeight) - held(&found[0], Load::TipWeight);
    assert!((left + Vector3::z() * LENGTH.powi(3) / 12.0).norm() < 1e-14);
}

/// Oracle: an arm that hangs straight feels only what acts sideways.
#[test]
fn a_hanging_arm_does_not_bend_under_what_pulls_along_it() {
    let model = StrainModel::new(&arm(Axis::MinusZ, StrainBasis::default()), 1, &[1.0]).unwrap();
    let found = &displacements(&model, -Vector3::z(), &[0.0])[0];
    for field in [Load::TipWeight, Load::SelfWeight, Load::Wash, Load::WashNear] {
        assert!(of(found, field).norm() < 1e-15, "{field:?}");
    }
    assert!((of(found, Load::SideFirst) - Vector3::x() * LENGTH.powi(4) / 8.0).norm() < 1e-14);
    assert!((of(found, Load::SideSecond) - Vector3::y() * LENGTH.powi(4) / 8.0).norm() < 1e-14);
}

/// Oracle: a beam that leans by a from the vertical. Weight acts with sin a across it, wind with sin² a; what falls off
/// as 1 − x cos a/L at x from the base has the tip deflection of two textbook loads: w L⁴/8EI even, and 11 w L⁴/120EI for
/// one that grows linearly from 0 at the base to w at the end.
#[test]
fn wind_acts_by_its_part_across_the_arm() {
    let lean = 0.7f64;
    let model = StrainModel::new(&arm(Axis::MinusZ, StrainBasis::default()), 1, &[1.0]).unwrap();
    let down = Vector3::new(lean.sin(), 0.0, -lean.cos());
    let found = &displacements(&model, down, &[0.0])[0];
    let even = LENGTH.powi(4) / 8.0;
    let growing = LENGTH.powi(4) * 11.0 / 120.0;
    let expected = [
        (Load::TipWeight, lean.sin() * LENGTH.powi(3) / 3.0),
        (Load::SelfWeight, lean.sin() * even),
        (Load::Wash, lean.sin().powi(2) * even),
        (Load::WashNear, lean.sin().powi(2) * (even - lean.cos() * growing)),
    ];
    for (field, size) in expected {
        assert!((of(found, field) - Vector3::x() * size).norm() < 1e-6 * even, "{field:?}");
    }
}

/// Loads of the fields at a place of the arm, written down once more for the test: w at position p with tangent t.
fn spread(load: Load, p: Vector3<f64>, t: Vector3<f64>, down: Vector3<f64>) -> Vector3<f64> {
    let across = t.cross(&down).cross(&t);
    match load {
        Load::SelfWeight => down,
        Load::Wash => across.norm() * across,
        Load::WashNear => across.norm() * across * (1.0 - p.dot(&down).max(0.0) / LENGTH).max(0.0),
        Load::SideFirst => horizontal(&down)[0],
        Load::SideSecond => horizontal(&down)[1],
        Load::TipWeight => Vector3::zeros(),
    }
}

/// Oracle: cut the arm into many arcs of constant curvature, sum the moment of all later arcs at the middle of each, add
/// a little of it to the arc's curvature, and take the difference of the two shapes. The cut is wrong in
/// second order, so that two cuts give the limit.
#[test]
fn a_bent_arm_moves_as_the_difference_of_two_shapes() {
    let down = Vector3::new(0.2, -0.1, -1.0).normalize();
    let at = [0.5, 1.0];
    for (axis, basis) in [
        (Axis::MinusZ, StrainBasis::Legendre { order: 1 }),
        (Axis::X, StrainBasis::Legendre { order: 2 }),
        (Axis::Y, StrainBasis::Piecewise { segments: 2 }),
    ] {
        let model = bent(axis, basis, &at);
        let q = [0.5, -0.8];
        let found = displacements(&model, down, &q);
        for load in Load::ALL {
            let coarse = by_difference(&model, &q, down, load, 64);
            let fine = by_difference(&model, &q, down, load, 128);
            for (marker, place) in at.iter().enumerate() {
                for (part, field) in [Field::Free(load), Field::Held(load)].into_iter().enumerate() {
                    let found = found[marker][field.column()];
                    let (coarse, fine) = (coarse[marker][part], fine[marker][part]);
                    let off = |other: Vector3<f64>| (other - found).norm() / found.norm();
                    let errors = [coarse, fine, (fine * 4.0 - coarse) / 3.0].map(off);
                    println!("{axis:?} {field:?} s/L {place}: {errors:?}");
                    assert!(found.norm() > 1e-5 && errors[2] < 2e-4, "{field:?}: {errors:?}");
                }
            }
        }
    }
}

/// Of each marker, the displacement on the free arm and that by the mean bending.
fn by_difference(
    model: &StrainModel,
    q: &[f64],
    down: Vector3<f64>,
    load: Load,
    arcs: usize,
) -> Vec<[Vector3<f64>; 2]> {
    let basis = model.arm().strain;
    let (c, functions, h) = (model.strain_coordinates(q), basis.functions(), LENGTH / arcs as f64);
    let middle = |i: usize| (i as f64 + 0.5) / arcs as f64;
    let curvature = |strain: usize, i: usize| {
        let (first, values) = basis.active(middle(i));
        (0..values.len()).map(|n| c[strain * functions + first + n] * values[n]).sum::<f64>()
    };
    let kappa: Vec<f64> =
        (0..2).flat_map(|strain| (0..arcs).map(move |i| (strain, i))).map(|(x, i)| curvature(x, i)).collect();
    // One place more than the arcs: the tip.
    let places: Vec<f64> = (0..arcs).map(middle).chain([1.0]).chain(model.at().iter().copied()).collect();
    let cut = Shape::new(LENGTH, StrainBasis::Piecewise { segments: arcs }, &places, 1, None);
    let poses = |kappa: &[f64]| {
        let mut out = vec![acm_core::se3::Pose::identity(); places.len()];
        cut.poses(kappa, &mut cut.scratch(kappa.len()), &mut out);
        out
    };
    let turn: Matrix3<f64> = model.base_pose().rotation;
    let nominal = poses(&kappa);
    let at = |i: usize| turn * nominal[i].position;
    // Change of curvature of every arc about its own x, then about its own y.
    let mut bent = vec![0.0; 2 * arcs];
    for i in 0..arcs {
        let mut moment = if load == Load::TipWeight { (at(arcs) - at(i)).cross(&down) } else { Vector3::zeros() };
        for j in i + 1..arcs {
            let tangent = turn * nominal[j].rotation.column(2);
            moment += (at(j) - at(i)).cross(&spread(load, at(j), tangent, down)) * h;
        }
        // Half of the arc itself lies beyond its middle, a quarter of its length away: of second order, left out.
        let own = nominal[i].rotation.transpose() * turn.transpose() * moment;
        (bent[i], bent[arcs + i]) = (own.x, own.y);
    }
    let mean = |part: &[f64]| vec![part.iter().sum::<f64>() / arcs as f64; arcs];
    let even = [mean(&bent[..arcs]), mean(&bent[arcs..])].concat();
    let moved = |change: &[f64]| -> Vec<Vector3<f64>> {
        let small = 1e-4;
        let by = |sign: f64| poses(&kappa.iter().zip(change).map(|(k, c)| k + sign * small * c).collect::<Vec<f64>>());
        let (after, before) = (by(1.0), by(-1.0));
        let of = |k: usize| turn * (after[k].position - before[k].position) / (2.0 * small);
        (arcs + 1..places.len()).map(of).collect()
    };
    moved(&bent).into_iter().zip(moved(&even)).map(|(free, held)| [free, held]).collect()
}

/// Oracle: the pose of the marker as the tip model gives it.
#[test]
fn a_marker_moves_along_the_axes_of_its_disk() {
    let model = bent(Axis::MinusZ, StrainBasis::default(), &[0.4, 1.0]);
    let q = [0.3, 0.9];
    let found = displacements(&model, -Vector3::z(), &q);
    for (at, found) in [0.4, 1.0].iter().zip(&found) {
        let frame = model.pose(&q, at * LENGTH).rotation;
        for (axis, field) in [Field::MarkerX, Field::MarkerY, Field::MarkerZ].into_iter().enumerate() {
            let column: Vector3<f64> = frame.column(axis).into();
            assert!((found[field.column()] - column).norm() < 1e-5, "{field:?}");
        }
    }
}

/// Oracle: a base frame turned with the load turns every displacement with it; other parameters than the model's own count.
#[test]
fn turning_arm_and_load_turns_the_answer() {
    let model = bent(Axis::MinusZ, StrainBasis::default(), &[0.6, 1.0]);
    let (turn, q) = (model.base_pose().rotation, [0.4, -0.2]);
    let mut theta = model.parameters().to_vec();
    theta[model.registration_range()].fill(0.0);
    let upright = model.clone().with_parameters(&theta);
    let spin = turn * upright.base_pose().rotation.transpose();
    let down = Vector3::new(0.3, 0.1, -0.9).normalize();
    let (here, there) = (displacements(&upright, down, &q), displacements(&model, spin * down, &q));
    for field in [Load::TipWeight, Load::SelfWeight, Load::Wash, Load::WashNear] {
        for (here, there) in here.iter().zip(&there) {
            assert!((spin * of(here, field) - of(there, field)).norm() < 1e-15, "{field:?}");
            assert!((spin * held(here, field) - held(there, field)).norm() < 1e-15, "{field:?}");
        }
    }
    let fields = FieldModel::new(&upright, down);
    let (mut with, mut own) = (vec![0.0; 2 * WIDTH], vec![0.0; 2 * WIDTH]);
    fields.evaluate(model.parameters(), &q, &mut fields.scratch(), &mut with);
    let fields = FieldModel::new(&model, down);
    fields.evaluate(model.parameters(), &q, &mut fields.scratch(), &mut own);
    assert_eq!(with, own);
}

/// Not an assertion on time: run with `--nocapture` to read it.
#[test]
fn many_samples_share_one_scratch() {
    let model = bent(Axis::MinusZ, StrainBasis::default(), &[1.0]);
    let fields = FieldModel::new(&model, -Vector3::z());
    let (mut scratch, mut out) = (fields.scratch(), vec![0.0; WIDTH]);
    let start = std::time::Instant::now();
    let samples = 20_000;
    for k in 0..samples {
        fields.evaluate(model.parameters(), &[0.3, 1e-5 * f64::from(k)], &mut scratch, &mut out);
    }
    println!("{:.2} µs per sample", start.elapsed().as_secs_f64() * 1e6 / f64::from(samples));
    let mut fresh = vec![0.0; WIDTH];
    fields.evaluate(model.parameters(), &[0.3, 1e-5 * f64::from(samples - 1)], &mut fields.scratch(), &mut fresh);
    assert_eq!(out, fresh);
}

/// Displacement of all markers by loads that act together.
fn together(model: &StrainModel, down: Vector3<f64>, q: &[f64], weights: &[f64]) -> Vec<Vector3<f64>> {
    let fields = FieldModel::new(model, down);
    let mut out = vec![0.0; 3 * model.at().len()];
    fields.add(model.parameters(), q, weights, &mut fields.scratch(), &mut out);
    out.chunks_exact(3).map(Vector3::from_column_slice).collect()
}

/// Oracle: the cantilever of the textbook under a force and a load at once. Free they move its end by F L³/3 + w L⁴/8, and
/// with their mean bending held by a share c, of which the force's is F L²·L/4 and the load's w L⁴/12, by so much less.
#[test]
fn loads_that_act_together_add_up() {
    let model = StrainModel::new(&arm(Axis::X, StrainBasis::default()), 1, &[1.0]).unwrap();
    let (force, load, share) = (0.7, 1.9, 0.35);
    let mut weights = vec![0.0; Field::ALL.len()];
    weights[Field::Free(Load::TipWeight).column()] = force;
    weights[Field::Free(Load::SelfWeight).column()] = load;
    let free = force * LENGTH.powi(3) / 3.0 + load * LENGTH.powi(4) / 8.0;
    let found = together(&model, -Vector3::z(), &[0.0], &weights);
    assert!((found[0] + Vector3::z() * free).norm() < 1e-14);
    weights[Field::Held(Load::TipWeight).column()] = -share * force;
    weights[Field::Held(Load::SelfWeight).column()] = -share * load;
    let held = force * LENGTH.powi(3) / 4.0 + load * LENGTH.powi(4) / 12.0;
    let found = together(&model, -Vector3::z(), &[0.0], &weights);
    assert!((found[0] + Vector3::z() * (free - share * held)).norm() < 1e-14);
    let (held_alone, none) = (weights.split_off(6), vec![0.0; 6]);
    let found = together(&model, -Vector3::z(), &[0.0], &[none, held_alone].concat());
    assert!((found[0] - Vector3::z() * share * held).norm() < 1e-14);
}

/// Oracle: the sum of what each does alone, on a bent arm.
#[test]
fn every_load_counts_on_a_bent_arm() {
    let down = Vector3::new(0.2, -0.3, -0.9).normalize();
    let model = bent(Axis::MinusZ, StrainBasis::default(), &[0.4, 1.0]);
    let (q, alone) = ([0.3, -0.6], displacements(&model, down, &[0.3, -0.6]));
    let weights: Vec<f64> = (0..Field::ALL.len()).map(|f| (1.0 + 1.7 * f as f64).sin()).collect();
    for (found, alone) in together(&model, down, &q, &weights).iter().zip(&alone) {
        let sum: Vector3<f64> = alone.iter().zip(&weights).map(|(u, weight)| u * *weight).sum();
        assert!((found - sum).norm() < 1e-13 * sum.norm(), "{found} and not {sum}");
    }
    for (f, weight) in weights.iter().enumerate() {
        let one: Vec<f64> = (0..weights.len()).map(|g| if f == g { *weight } else { 0.0 }).collect();
        for (found, alone) in together(&model, down, &q, &one).iter().zip(&alone) {
            assert!((found - alone[f] * *weight).norm() < 1e-13 * alone[f].norm(), "{:?}", Field::ALL[f]);
        }
    }
}
