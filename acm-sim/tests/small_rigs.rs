//! Small rigs: bits, finiteness, ranges, and what an oracle makes of them.

use acm_sim::small_rigs::{Kind, Recorded, Role, deviations, oracle, simulate};

/// Every kind and thirty seeds: finite, in the stated ranges, with one to four causes whose names are the library's.
#[test]
fn every_kind_simulates_for_thirty_seeds() {
    for kind in Kind::ALL {
        let mut mechanisms = std::collections::BTreeSet::new();
        for seed in 0..30 {
            let made = simulate(kind, seed);
            let development = made.trials(Role::Development).count();
            assert!((1..=20).contains(&development) && made.trials(Role::HeldOut).count() > 0, "{}", made.name);
            assert!((1..=4).contains(&made.truth.causes.len()), "{}: {:?}", made.name, made.truth.causes);
            made.trials.iter().for_each(|trial| whole(&made, trial));
            assert!(made.truth.noise[0] > 0.0);
            mechanisms.extend(made.truth.causes.iter().map(|cause| cause.mechanism.clone()));
        }
        assert!(mechanisms.len() >= 2, "{}: {mechanisms:?}", kind.name());
    }
}

fn whole(made: &Recorded, trial: &acm_sim::small_rigs::SimTrial) {
    let rows = trial.time.len();
    assert!(rows > 50 && trial.time.windows(2).all(|pair| pair[1] > pair[0]), "{}", made.name);
    for (signals, columns) in
        [(&made.actuators, &trial.actuators), (&made.contexts, &trial.contexts), (&made.outputs, &trial.outputs)]
    {
        assert_eq!(signals.len(), columns.len());
        for column in columns {
            assert!(column.len() == rows && column.iter().all(|value| value.is_finite()), "{}", made.name);
            assert!(column.iter().any(|value| *value != column[0]), "{}: a column stands still", made.name);
        }
    }
}

#[test]
fn a_seed_gives_the_same_bits_and_another_one_others() {
    for kind in Kind::ALL {
        assert_eq!(simulate(kind, 7), simulate(kind, 7));
        assert_ne!(simulate(kind, 7).trials, simulate(kind, 8).trials);
    }
}

/// Oracle: the noise that was added. Whoever knows the structure is left with it, but for what sampled and quantised
/// inputs hide; where rates matter, that is more.
#[test]
fn an_oracle_is_left_with_the_noise() {
    for kind in Kind::ALL {
        let torque = matches!(kind, Kind::JointWithLoad | Kind::SixJoints);
        let (usual, most) = if torque { (1.08, 2.3) } else { (1.04, 1.3) };
        let mut ratios: Vec<f64> = (100..107)
            .map(|seed| {
                let found = oracle(&simulate(kind, seed));
                assert!((0.8..most).contains(&(found.development / found.noise)), "{}-{seed}: {found:?}", kind.name());
                found.error / found.noise
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[0] > 0.9 && ratios[6] < most, "{}: {ratios:?}", kind.name());
        assert!(ratios[3] < usual, "{}: {ratios:?}", kind.name());
    }
}

/// Oracle: what is separable by its size. A cause whose true values are its neutral ones is never missed; most causes as
/// they are drawn are.
#[test]
fn a_cause_that_does_nothing_is_not_missed() {
    let made = simulate(Kind::Axis, 104);
    let found = oracle(&made);
    assert!(found.separable.iter().all(|separable| *separable), "{:?}", found.separable);
    let mut without = made.clone();
    let plant = &mut without.truth.plant;
    let late = made.truth.causes.iter().position(|cause| cause.mechanism == "dead_time").expect("seed 104 is late");
    plant.free.iter_mut().filter(|free| free.cause == Some(late)).for_each(|free| free.neutral = free.value);
    assert!(!oracle(&without).separable[late], "to hold it at its true value takes nothing away");
}

/// Oracle: standard errors to first order, σ²(JᵀJ)⁻¹, which share no draw with the redraws. A chain is nearly linear in its values
/// over so little, and its encoders' noise adds; 60 redraws know a standard deviation to 9 %.
#[test]
fn redraws_scatter_as_first_order_says() {
    for (kind, seed) in [(Kind::HeatedTank, 103), (Kind::Axis, 104)] {
        let known = oracle(&simulate(kind, seed));
        let scatter = deviations(kind, seed, &known, 60);
        let ratios: Vec<f64> = scatter.iter().zip(&known.standard_errors).map(|(one, other)| one / other).collect();
        assert!(ratios.iter().all(|ratio| (0.7..2.5).contains(ratio)), "{}: {ratios:?}", kind.name());
        assert_eq!(scatter, deviations(kind, seed, &known, 60), "the same bits");
    }
}
