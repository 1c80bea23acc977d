//! Every constant of the synthetic campaign, with its unit and the reason for its value.
//!
//! Values were chosen once, so that the campaign has the statistics of the paper and two stated noise
//! floors (see `statistics` and `floors`). Agreement shows that such numbers are reachable by an arm
//! of this kind; it does not validate the arm.

use serde::{Deserialize, Serialize};

/// All constants of the simulator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TwinSettings {
    /// Geometry, stiffness and mass of the arm.
    pub arm: ArmSettings,
    /// Four tendons between servo and arm tip.
    pub tendons: TendonSettings,
    /// Friction between tendon and sheath.
    pub sheath: SheathSettings,
    /// Long memory of the backbone material.
    pub creep: CreepSettings,
    /// Air under the rotors.
    pub wind: WindSettings,
    /// Carrier: mass, tilt, altitude, throttle.
    pub vehicle: VehicleSettings,
    /// Error of the pulleys' shape as a share of the tables, 1, per pulley.
    pub cam: [f64; 2],
    /// Motion of q1.
    pub excitation: ExcitationSettings,
    /// Clock, encoders, motion capture.
    pub measurement: MeasurementSettings,
    /// Unrecorded quantities that differ from trial to trial.
    pub unrecorded: UnrecordedSettings,
    /// Time step and tolerance.
    pub solver: SolverSettings,
}

impl Default for TwinSettings {
    fn default() -> Self {
        Self {
            arm: ArmSettings::default(),
            tendons: TendonSettings::default(),
            sheath: SheathSettings::default(),
            creep: CreepSettings::default(),
            wind: WindSettings::default(),
            vehicle: VehicleSettings::default(),
            cam: [1.12, 1.35],
            excitation: ExcitationSettings::default(),
            measurement: MeasurementSettings::default(),
            unrecorded: UnrecordedSettings::default(),
            solver: SolverSettings::default(),
        }
    }
}

/// Geometry, stiffness and mass of the arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArmSettings {
    /// Length of the backbone, m (the paper's arm).
    pub length: f64,
    /// Universal joints of the discrete rod; bending is not described by strain modes.
    pub joints: usize,
    /// Bending stiffness at the base, N·m².
    pub stiffness: f64,
    /// Relative loss of stiffness from base to tip, 1.
    pub taper: f64,
    /// Mass of backbone and discs per length, kg/m (16 discs of 5.2 g).
    pub line_density: f64,
    /// Mass of the tip body with its markers, kg.
    pub tip_mass: f64,
    /// Payload of trials 13–16, kg.
    pub payload: f64,
    /// Axial stiffness, N: the tendons compress the backbone.
    pub axial_stiffness: f64,
    /// Gravity, m/s².
    pub gravity: f64,
}

impl Default for ArmSettings {
    fn default() -> Self {
        Self {
            length: 0.62,
            joints: 16,
            stiffness: 0.06,
            taper: 0.42,
            line_density: 16.0 * 0.0052 / 0.62,
            tip_mass: 0.026,
            payload: 0.045,
            axial_stiffness: 2500.0,
            gravity: 9.81,
        }
    }
}

/// Four tendons in two antagonistic pairs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TendonSettings {
    /// Distance of the tendons from the backbone, m.
    pub radius: f64,
    /// Effective radius of the two servo pulleys, m; q2 turns a smaller one.
    pub pulley: [f64; 2],
    /// Axial stiffness of one tendon with its sheath, N/m.
    pub stiffness: f64,
    /// Pretension of each tendon in the straight arm, N.
    pub pretension: f64,
    /// Elongation over which a tendon goes from slack to taut, m (the rope straightens gradually).
    pub slack_width: f64,
}

impl Default for TendonSettings {
    fn default() -> Self {
        Self { radius: 0.024, pulley: [0.0245, 0.0125], stiffness: 2200.0, pretension: 2.0, slack_width: 2e-4 }
    }
}

/// Rate-and-state friction in the sheath (not on the discs).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SheathSettings {
    /// Friction number (coefficient × wrap angle) at the reference speed, 1, per pair.
    pub level: [f64; 2],
    /// Direct effect of speed, 1.
    pub direct: f64,
    /// Effect of contact age, 1.
    pub ageing: f64,
    /// Reference speed, m/s: about that of a tendon at 0.2 rad/s.
    pub speed: f64,
    /// Slip after which contacts are renewed, m.
    pub slip: f64,
}

impl Default for SheathSettings {
    fn default() -> Self {
        Self { level: [0.50, 0.50], direct: 0.06, ageing: 0.04, speed: 5e-3, slip: 5e-4 }
    }
}

/// Power-law relaxation of the backbone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CreepSettings {
    /// Share of the bending stiffness that relaxes, 1.
    pub share: f64,
    /// Time after which the power law sets in, s.
    pub onset: f64,
    /// Exponent of the power law, 1 (not 1 exactly: the primitive would be a logarithm).
    pub exponent: f64,
}

impl Default for CreepSettings {
    fn default() -> Self {
        Self { share: 1.5, onset: 2.0, exponent: 0.6 }
    }
}

/// Air under the rotors, relative to the momentum-theory velocity of hover.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindSettings {
    /// Air density, kg/m³.
    pub density: f64,
    /// Rotor radius, m.
    pub rotor_radius: f64,
    /// Distance of the rotor axes from the vehicle axis along x and along y, m.
    pub rotor_offset: f64,
    /// Heading of the arm's first bending plane between the rotors, rad: the arm is not mounted along a diagonal.
    pub heading: f64,
    /// Height of the rotor plane over the arm's attachment, m.
    pub rotor_height: f64,
    /// Shear layer at the rotor, m.
    pub shear_width: f64,
    /// Growth of the shear layer per metre of wake, 1.
    pub shear_growth: f64,
    /// Share of wake velocity lost per rotor radius of travel, 1.
    pub decay: f64,
    /// Swirl as a share of the axial velocity, 1.
    pub swirl: f64,
    /// Displacement of the four wakes towards each other, as a share of the rotor offset, 1.
    pub merging: f64,
    /// Height over which the ground brakes the wake, m.
    pub brake_height: f64,
    /// Outward wall jet as a share of hover velocity, 1.
    pub outwash: f64,
    /// Thickness of the wall jet, m.
    pub outwash_height: f64,
    /// Fountain between the wakes as a share of hover velocity, 1.
    pub fountain: f64,
    /// Radius of the fountain, m.
    pub fountain_radius: f64,
    /// Height to which the fountain reaches, m.
    pub fountain_height: f64,
    /// Mean room circulation at its strongest altitude, as a share of wake velocity, 1.
    pub circulation: [f64; 3],
    /// Altitude at which the room circulation is strongest, m.
    pub circulation_altitude: f64,
    /// Half width of the maximum of the room circulation, m.
    pub circulation_width: f64,
    /// Diameter of arm elements that faces the cross flow, m.
    pub diameter: f64,
    /// Drag coefficient of a cylinder in cross flow, 1.
    pub cross_drag: f64,
    /// Friction coefficient along the cylinder, 1.
    pub skin_drag: f64,
    /// Diameter of the tip body, m.
    pub tip_diameter: f64,
    /// Dead part of the delay between an element's motion and the flow around it, s.
    pub dead_delay: f64,
    /// Speed at which the disturbed wake reorders along the arm, m/s.
    pub convection: f64,
    /// Shape of the gamma spread of the delay, 1 (whole number).
    pub dispersion_shape: u32,
    /// Longest delay kept, s.
    pub longest_delay: f64,
}

impl Default for WindSettings {
    fn default() -> Self {
        Self {
            density: 1.19,
            rotor_radius: 0.19,
            rotor_offset: 0.27,
            heading: 0.35,
            rotor_height: 0.09,
            shear_width: 0.02,
            shear_growth: 0.115,
            decay: 0.10,
            swirl: 0.12,
            merging: 0.55,
            brake_height: 0.15,
            outwash: 1.4,
            outwash_height: 0.25,
            fountain: 0.6,
            fountain_radius: 0.16,
            fountain_height: 0.6,
            circulation: [0.06, -0.045, -0.04],
            circulation_altitude: 1.1,
            circulation_width: 0.4,
            diameter: 0.053,
            cross_drag: 1.15,
            skin_drag: 0.035,
            tip_diameter: 0.085,
            dead_delay: 0.10,
            convection: 0.7,
            dispersion_shape: 4,
            longest_delay: 2.0,
        }
    }
}

/// Carrier: mass, altitude hold and reported signals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VehicleSettings {
    /// Mass with arm, kg.
    pub mass: f64,
    /// Altitudes of trials 1–3, 4–6, 7–9 and 10–12, m; the last one is not in the development set.
    pub altitudes: [f64; 4],
    /// Height of the stand for trials with rotors off, m.
    pub stand: f64,
    /// Spread of altitude hold, m.
    pub hold_spread: f64,
    /// Correlation time of altitude hold, s.
    pub hold_time: f64,
    /// Throttle that carries the vehicle far from the ground on a full battery, 1.
    pub throttle: f64,
    /// Throttle added per second as the battery sags, 1/s.
    pub sag: f64,
    /// Spread of throttle by control activity, 1.
    pub throttle_spread: f64,
    /// Correlation time of control activity, s.
    pub throttle_time: f64,
    /// Noise of the logged throttle, 1.
    pub throttle_noise: f64,
}

impl Default for VehicleSettings {
    fn default() -> Self {
        Self {
            mass: 3.4,
            altitudes: [1.30, 1.65, 2.00, 0.98],
            stand: 1.20,
            hold_spread: 0.012,
            hold_time: 3.0,
            throttle: 0.86,
            sag: 6e-5,
            throttle_spread: 0.004,
            throttle_time: 2.0,
            throttle_noise: 0.002,
        }
    }
}

/// Reciprocation of q1 by a person at a joystick; q2 is held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExcitationSettings {
    /// Amplitude of q1 with rotors off, rad.
    pub calibration_amplitude: f64,
    /// Amplitude of q1 in flight, rad. It is slightly larger, so that a few samples leave the calibrated domain.
    pub flight_amplitude: f64,
    /// Share of the amplitude by which a stroke may fall short, 1.
    pub shortfall: f64,
    /// Median speed of a stroke, rad/s.
    pub speed: f64,
    /// Spread of the logarithm of that speed, 1.
    pub speed_spread: f64,
    /// Slowest and fastest stroke, rad/s.
    pub speed_limits: [f64; 2],
    /// Probability that a stroke is broken by a partial reversal, and by each further one, 1.
    pub partial: f64,
    /// Length of a partial reversal, rad.
    pub partial_length: [f64; 2],
    /// Probability of a dwell after a stroke, 1.
    pub dwell: f64,
    /// Duration of a dwell, s.
    pub dwell_time: [f64; 2],
    /// Wander of the held q2 with rotors off and in flight, rad.
    pub wander: [f64; 2],
}

impl Default for ExcitationSettings {
    fn default() -> Self {
        Self {
            calibration_amplitude: 2.92,
            flight_amplitude: 3.0,
            shortfall: 0.12,
            speed: 0.32,
            speed_spread: 0.45,
            speed_limits: [0.10, 0.90],
            partial: 0.62,
            partial_length: [0.2, 1.4],
            dwell: 0.35,
            dwell_time: [0.5, 4.0],
            wander: [0.006, 0.003],
        }
    }
}

/// Clock, encoders, motion capture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MeasurementSettings {
    /// Period of the motion capture, s.
    pub period: f64,
    /// Jitter of a time stamp, s.
    pub jitter: f64,
    /// Probability that 1–5 frames are lost after a sample, 1.
    pub drop: f64,
    /// Probability of an occlusion after a sample, 1.
    pub gap: f64,
    /// Duration of an occlusion, s.
    pub gap_time: [f64; 2],
    /// Noise of a marker coordinate, m.
    pub marker_noise: f64,
    /// Bits of the servo encoders per turn.
    pub encoder_bits: u32,
    /// Noise of the encoders before rounding, rad.
    pub encoder_noise: f64,
    /// Duration of motion before the first recorded sample, s: without it the start-up transient is recorded.
    pub preroll: f64,
    /// Decimals of a logged time in s, position in m and throttle: loggers round, and rounded logs do not show
    /// in which order a compiler added two numbers.
    pub decimals: [i32; 3],
}

impl Default for MeasurementSettings {
    fn default() -> Self {
        Self {
            period: 0.1,
            jitter: 0.004,
            drop: 0.006,
            gap: 0.0012,
            gap_time: [1.0, 6.0],
            marker_noise: 4e-4,
            encoder_bits: 12,
            encoder_noise: 5e-4,
            preroll: 12.0,
            decimals: [4, 6, 5],
        }
    }
}

/// Spread of unrecorded quantities that differ from trial to trial, or moment to moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct UnrecordedSettings {
    /// Zero offset of each servo, rad.
    pub zero: f64,
    /// Relative spread of pretension, 1.
    pub pretension: f64,
    /// Registration of the tip, translation per axis, m.
    pub registration: f64,
    /// Registration of the tip, tilt per horizontal axis, rad.
    pub registration_tilt: f64,
    /// Registration of the tip, heading, rad.
    pub registration_heading: f64,
    /// Constant tilt of the vehicle per axis, rad.
    pub tilt_bias: f64,
    /// Moving tilt of the vehicle per axis, rad.
    pub tilt: f64,
    /// Correlation time of the tilt, s.
    pub tilt_time: f64,
    /// Turbulence as a share of the local wind, 1.
    pub turbulence: f64,
    /// Correlation time of turbulence, s.
    pub turbulence_time: f64,
    /// Wandering room circulation, as a share of wake velocity, 1.
    pub circulation: f64,
    /// Correlation time of the room circulation, s.
    pub circulation_time: f64,
}

impl Default for UnrecordedSettings {
    fn default() -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self {
            zero: 0.008,
            pretension: 0.02,
            registration: 1e-3,
            registration_tilt: 0.1 * degree,
            registration_heading: 0.15 * degree,
            tilt_bias: 0.2 * degree,
            tilt: 0.5 * degree,
            tilt_time: 1.6,
            turbulence: 0.15,
            turbulence_time: 0.9,
            circulation: 0.015,
            circulation_time: 6.0,
        }
    }
}

/// Time step and tolerance of the quasi-static equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverSettings {
    /// Time step, s.
    pub step: f64,
    /// Largest joint moment left unbalanced, N·m (the arm's own moments are about 0.3; friction at rest is so stiff that rounding leaves 1e-9).
    pub tolerance: f64,
    /// Largest number of Newton iterations in a step.
    pub iterations: usize,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self { step: 0.05, tolerance: 1e-8, iterations: 60 }
    }
}
