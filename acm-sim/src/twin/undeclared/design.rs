//! Trials of a campaign: 5 of calibration, 9 of development, 3 held out at an altitude that no other trial has,
//! or other numbers of each.

use super::super::random::{Purpose, Seeds, between};
use crate::role::Role;
use serde::{Deserialize, Serialize};

/// Motion of the actuators and the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Motion of the paper: q1 goes to and fro at one speed, q2 is held in each trial, the vehicle hovers.
    Paper,
    /// Motion of both actuators at varied speed with partial reversals and dwells; throttle, altitude and position
    /// change.
    Rich,
}

impl Design {
    /// Both designs.
    pub const ALL: [Design; 2] = [Design::Paper, Design::Rich];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Design::Paper => "paper",
            Design::Rich => "rich",
        }
    }
}

/// One trial as planned.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Number of the trial, from 1; it is also the trial's name.
    pub number: usize,
    /// Role of the trial; rotors are off in calibration.
    pub role: Role,
    /// Altitudes that are held one after the other, m.
    pub altitudes: Vec<f64>,
    /// Held value of q2 (`paper`), rad.
    pub slice: f64,
}

/// Height of the stand for trials with rotors off, m.
const STAND: f64 = 1.2;
/// Slices of q2 with rotors off and in flight, rad.
const REST_SLICES: [f64; 5] = [0.0, 0.6, 1.2, 1.8, 2.4];
const SLICES: [f64; 3] = [0.4, 1.2, 2.0];
/// Altitudes of development and of the held-out trials, m.
const PAPER_LEVELS: [f64; 3] = [0.5, 1.3, 2.2];
const PAPER_HELD_OUT: f64 = 0.9;
const RICH_LEVELS: [f64; 4] = [0.5, 0.8, 1.6, 2.2];
const RICH_HELD_OUT: [f64; 2] = [1.05, 1.3];

/// Trials of calibration, of development and held out, unless a kind says otherwise.
pub const COUNTS: [usize; 3] = [5, 9, 3];

/// Returns all trials, for the given number of each role.
pub fn plans(design: Design, counts: [usize; 3], seeds: &Seeds) -> Vec<Plan> {
    (1..=counts.iter().sum()).map(|number| plan(design, number, counts, seeds)).collect()
}

fn plan(design: Design, number: usize, [calibration, development, _]: [usize; 3], seeds: &Seeds) -> Plan {
    let role = match number {
        _ if number <= calibration => Role::Calibration,
        _ if number <= calibration + development => Role::Development,
        _ => Role::HeldOut,
    };
    let altitudes = match (role, design) {
        (Role::Calibration, _) => vec![STAND],
        (Role::Development, Design::Paper) => vec![PAPER_LEVELS[(number - calibration - 1) / 3 % PAPER_LEVELS.len()]],
        (_, Design::Paper) => vec![PAPER_HELD_OUT],
        (Role::Development, Design::Rich) => changing(number, &RICH_LEVELS, seeds),
        (_, Design::Rich) => changing(number, &RICH_HELD_OUT, seeds),
    };
    let slice =
        if role == Role::Calibration { REST_SLICES[(number - 1) % REST_SLICES.len()] } else { SLICES[number % 3] };
    Plan { number, role, altitudes, slice }
}

/// Returns three altitudes, each other than the one before.
fn changing(number: usize, levels: &[f64], seeds: &Seeds) -> Vec<f64> {
    let mut generator = seeds.stream(number, Purpose::Flight);
    let mut level = number % levels.len();
    (0..3)
        .map(|_| {
            let held = levels[level];
            level = (level + 1 + between(&mut generator, [0.0, levels.len() as f64 - 1.0]) as usize) % levels.len();
            held
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_out_altitudes_are_held_nowhere_else() {
        for design in Design::ALL {
            let plans = plans(design, COUNTS, &Seeds::both(4));
            let count = |role: Role| plans.iter().filter(|plan| plan.role == role).count();
            assert_eq!([Role::Calibration, Role::Development, Role::HeldOut].map(count), [5, 9, 3]);
            let held = |plan: &&Plan| plan.role == Role::HeldOut;
            let elsewhere: Vec<f64> =
                plans.iter().filter(|plan| plan.role == Role::Development).flat_map(|p| p.altitudes.clone()).collect();
            assert!(plans.iter().filter(held).flat_map(|p| &p.altitudes).all(|h| !elsewhere.contains(h)));
            assert!(plans.iter().all(|plan| plan.altitudes.windows(2).all(|pair| pair[0] != pair[1])));
        }
    }
}
