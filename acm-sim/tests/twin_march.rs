//! The simulator as it marches: convergence, equilibrium at every step, bits.

use acm_sim::twin::campaign::{SyntheticTrial, run_all, run_trial};
use acm_sim::twin::random::Seeds;
use acm_sim::twin::schedule::{TrialPlan, plan};
use acm_sim::twin::{TwinError, TwinSettings, generate};
use nalgebra::Vector3;

/// The first seconds of a trial.
fn beginning(settings: &TwinSettings, number: usize, until: f64) -> TrialPlan {
    let mut plan = plan(settings, number, &Seeds::both(3));
    plan.times.retain(|time| *time < until);
    plan
}

fn run(settings: &TwinSettings, number: usize, until: f64) -> Result<SyntheticTrial, TwinError> {
    run_trial(settings, &beginning(settings, number, until), &Seeds::both(3))
}

/// Nothing random but the joystick and the clock: what is left depends on the step and the joints alone.
fn smooth() -> TwinSettings {
    let mut settings = TwinSettings::default();
    settings.unrecorded.zero = 0.0;
    settings.unrecorded.pretension = 0.0;
    settings.unrecorded.registration = 0.0;
    settings.unrecorded.registration_tilt = 0.0;
    settings.unrecorded.registration_heading = 0.0;
    settings.unrecorded.tilt_bias = 0.0;
    settings.unrecorded.tilt = 0.0;
    settings.unrecorded.turbulence = 0.0;
    settings.unrecorded.circulation = 0.0;
    settings.vehicle.hold_spread = 0.0;
    settings.vehicle.throttle_spread = 0.0;
    settings.measurement.marker_noise = 0.0;
    settings.measurement.decimals = [12; 3];
    settings
}

/// Root mean square distance of two courses of the tip, m.
fn distance(one: &[Vector3<f64>], two: &[Vector3<f64>]) -> f64 {
    let squares: f64 = one.iter().zip(two).map(|(a, b)| (a - b).norm_squared()).sum();
    (squares / one.len() as f64).sqrt()
}

/// Oracle: the midpoint rule is of second order, so a doubled chain is off by a quarter; (1 − 1/16)/(1/4 − 1/16) = 5
/// between the distances of N and of 2N joints from 4N joints, 4 in the limit.
#[test]
fn joints_converge_at_second_order() -> Result<(), TwinError> {
    for trial in [17, 12] {
        let tip = |joints: usize| {
            let mut settings = smooth();
            settings.arm.joints = joints;
            run(&settings, trial, 15.0).map(|trial| trial.tip)
        };
        let finest = tip(64)?;
        let (coarse, fine) = (distance(&tip(16)?, &finest), distance(&tip(32)?, &finest));
        assert!(coarse < 5e-3, "trial {trial}: 16 joints are {coarse} m off");
        assert!((2.7..7.0).contains(&(coarse / fine)), "trial {trial}: {coarse} {fine}");
    }
    Ok(())
}

/// Oracle: implicit Euler for friction and a delayed wind are of first order, so a step is off by twice the half step.
#[test]
fn time_step_converges_at_first_order() -> Result<(), TwinError> {
    for trial in [17, 12] {
        let tip = |step: f64| {
            let mut settings = smooth();
            settings.solver.step = step;
            run(&settings, trial, 15.0).map(|trial| trial.tip)
        };
        let finest = tip(0.00625)?;
        let (coarse, fine) = (distance(&tip(0.05)?, &finest), distance(&tip(0.025)?, &finest));
        assert!(coarse < 5e-4, "trial {trial}: a step of 0.05 s is {coarse} m off");
        // (8 − 1)/(4 − 1) = 2.33 against a reference of an eighth of the step.
        assert!((1.6..3.2).contains(&(coarse / fine)), "trial {trial}: {coarse} {fine}");
    }
    Ok(())
}

#[test]
fn every_step_is_an_equilibrium() -> Result<(), TwinError> {
    let settings = TwinSettings::default();
    for trial in [3, 16, 21] {
        let found = run(&settings, trial, 60.0)?;
        assert!(
            found.residual > 0.0 && found.residual < settings.solver.tolerance,
            "trial {trial}: {}",
            found.residual
        );
    }
    Ok(())
}

/// The arm has memory: at the same actuator angles the tip differs with the way there.
#[test]
fn same_angles_reached_from_both_sides_give_different_tips() -> Result<(), TwinError> {
    let found = run_trial(&smooth(), &plan(&smooth(), 17, &Seeds::both(3)), &Seeds::both(3))?;
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for k in 1..found.time.len() {
        let rate = (found.q1[k] - found.q1[k - 1]) / (found.time[k] - found.time[k - 1]);
        if (found.q1[k] - 1.5).abs() < 0.1 {
            if rate > 0.1 {
                up.push(found.tip[k]);
            } else if rate < -0.1 {
                down.push(found.tip[k]);
            }
        }
    }
    let mean = |tips: &[Vector3<f64>]| tips.iter().sum::<Vector3<f64>>() / tips.len() as f64;
    let loop_width = (mean(&up) - mean(&down)).norm();
    assert!(up.len() > 5 && down.len() > 5 && (0.01..0.15).contains(&loop_width), "{loop_width} m");
    Ok(())
}

#[test]
fn one_and_two_threads_give_the_same_bits() -> Result<(), Box<dyn std::error::Error>> {
    let settings = TwinSettings::default();
    let plans: Vec<TrialPlan> = [1, 5, 14, 19].map(|number| beginning(&settings, number, 20.0)).to_vec();
    let on = |threads: usize| -> Result<_, Box<dyn std::error::Error>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(pool.install(|| run_all(&settings, &plans, &Seeds::both(3), &|_, _| {}))?)
    };
    let (one, two) = (on(1)?, on(2)?);
    assert_eq!(one, two);
    let other = run_all(&settings, &plans, &Seeds::both(4), &|_, _| {})?;
    assert_ne!(one[0].tip, other[0].tip);
    Ok(())
}

#[test]
fn nonsense_is_refused_with_its_name() {
    let mut settings = TwinSettings::default();
    settings.arm.stiffness = f64::NAN;
    let message = generate(&settings, 1, &|_, _| {}).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(message.contains("arm.stiffness is NaN"), "{message}");
}
