//! Air under four rotors: contracted wakes with swirl, ground, fountain, room circulation; drag on the arm.
//!
//! ```text
//! v_h  = √(T / (2ρ·4πR²))                              hover velocity (momentum theory)
//! w(d) = v_h·(1 + d/√(d² + R²)),  R_w = R·√(v_h/w)      contracting wake at distance d below the rotor
//! f    = ½ρDℓ·[C_d·|u_⊥|·u_⊥ + π·C_f·|u_∥|·u_∥]         load on an element (Hoerner's cross-flow principle)
//! ```
//!
//! | symbol | meaning                                | unit |
//! | `d`    | distance below the rotor plane         | m    |
//! | `w`    | axial velocity of one wake             | m/s  |
//! | `R_w`  | radius of one wake                     | m    |
//! | `u_⊥`, `u_∥` | wind across and along the element | m/s  |
//!
//! The arm is shorter than 2.5 vehicle sizes, so it hangs in the near field of four separate wakes and no
//! far-field jet applies (Bauersfeld et al. 2024). Wake: Leishman, Principles of Helicopter Aerodynamics
//! (2006), ch. 2; wall jet and fountain in the manner of Glauert (1956) and of Tanner et al. (2015).

use crate::twin::settings::WindSettings;
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::PI;

/// Sign of rotation and place of the rotors, in units of the rotor offset.
const ROTORS: [(f64, f64, f64); 4] = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];

/// Returns the hover velocity under four rotors that share a thrust in N.
pub fn hover_velocity(settings: &WindSettings, thrust: f64) -> f64 {
    let disc = PI * settings.rotor_radius * settings.rotor_radius;
    (thrust / (2.0 * settings.density * 4.0 * disc)).sqrt()
}

/// Returns the mean wind at a point given in vehicle axes (z up, origin at the arm's attachment), m/s.
///
/// `hover` is the hover velocity in m/s and `altitude` the height of the attachment over the ground in m.
pub fn mean_wind(settings: &WindSettings, point: &Vector3<f64>, hover: f64, altitude: f64) -> Vector3<f64> {
    let height = (altitude + point.z).max(0.02);
    let braked = height * height / (height * height + settings.brake_height.powi(2));
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), settings.heading);
    let between_rotors = turned * point;
    let wakes: Vector3<f64> = ROTORS.iter().map(|rotor| wake(settings, &between_rotors, *rotor)).sum();
    let wakes = turned.inverse() * Vector3::new(wakes.x, wakes.y, braked * wakes.z);
    hover * wakes + hover * ground(settings, point, height, altitude) + 2.0 * hover * circulation(settings, altitude)
}

/// Returns one wake in units of hover velocity: axial velocity with shear layer, core deficit, decay, and swirl.
fn wake(settings: &WindSettings, point: &Vector3<f64>, rotor: (f64, f64, f64)) -> Vector3<f64> {
    let radius = settings.rotor_radius;
    let below = (settings.rotor_height - point.z).max(0.0);
    let axial = 1.0 + below / below.hypot(radius);
    let edge = radius / axial.sqrt();
    let drawn = 1.0 - settings.merging * below / (below + settings.rotor_offset);
    let dx = point.x - rotor.0 * settings.rotor_offset * drawn;
    let dy = point.y - rotor.1 * settings.rotor_offset * drawn;
    let from_axis = dx.hypot(dy).max(1e-9);
    let shear = settings.shear_width + settings.shear_growth * below;
    let inside = 1.0 / (1.0 + (2.0 * (from_axis - edge) / shear).exp());
    let core = 1.0 - 0.5 * (-(from_axis / (0.35 * edge)).powi(2)).exp();
    let speed = axial * inside * core / (1.0 + settings.decay * below / radius);
    let around = rotor.2 * settings.swirl * speed / from_axis;
    Vector3::new(-dy * around, dx * around, -speed)
}

/// Returns the wall jet outwards along the ground and fountain between the wakes, in units of hover velocity.
fn ground(settings: &WindSettings, point: &Vector3<f64>, height: f64, altitude: f64) -> Vector3<f64> {
    let out = point.x.hypot(point.y).max(1e-9);
    let profile = 1.0 / (height / settings.outwash_height).cosh().powi(2);
    let jet = settings.outwash * profile * (out / 0.3).tanh() / out;
    let reach = 1.0 / (1.0 + (height / settings.fountain_height).powi(4));
    let strength = 1.0 / (1.0 + (altitude / 1.3).powi(4));
    let fountain = settings.fountain * reach * strength * (-(out / settings.fountain_radius).powi(2)).exp();
    Vector3::new(jet * point.x, jet * point.y, fountain)
}

/// Returns the strength of the room's circulation at an altitude, 1: a cell as high as the room has a favourite
/// altitude.
pub fn circulation_strength(settings: &WindSettings, altitude: f64) -> f64 {
    let distance = (altitude - settings.circulation_altitude) / settings.circulation_width;
    0.5 + 1.2 / (1.0 + distance * distance)
}

fn circulation(settings: &WindSettings, altitude: f64) -> Vector3<f64> {
    Vector3::from(settings.circulation) * circulation_strength(settings, altitude)
}

/// Returns the load on an element of some length with a direction (unit vector) in a wind, N.
pub fn element_drag(settings: &WindSettings, wind: &Vector3<f64>, tangent: &Vector3<f64>, length: f64) -> Vector3<f64> {
    let along = wind.dot(tangent);
    let across = wind - along * tangent;
    let pressure = 0.5 * settings.density * settings.diameter * length;
    pressure * (settings.cross_drag * across.norm() * across + PI * settings.skin_drag * along.abs() * along * tangent)
}

/// Returns the load on the tip body (drag coefficient 1 on its disc), N.
pub fn tip_drag(settings: &WindSettings, wind: &Vector3<f64>) -> Vector3<f64> {
    let area = 0.25 * PI * settings.tip_diameter * settings.tip_diameter;
    0.5 * settings.density * area * wind.norm() * wind
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic. 4 N on four discs of 0.25/π m² each in air of 0.5 kg/m³: v = √(4/(2·0.5·1)) ... = 2.
    #[test]
    fn hover_velocity_by_hand() {
        let settings = WindSettings { density: 0.5, rotor_radius: (0.25 / PI).sqrt(), ..WindSettings::default() };
        assert!((hover_velocity(&settings, 4.0) - 2.0).abs() < 1e-12);
    }

    /// Oracle: continuity, w·R_w² = v_h·R² at every distance (top-hat wake, no decay).
    #[test]
    fn wake_conserves_volume_flow() {
        let settings =
            WindSettings { shear_width: 1e-3, shear_growth: 0.0, decay: 0.0, merging: 0.0, ..WindSettings::default() };
        for z in [0.05, -0.2, -0.8] {
            let flow: f64 = (0..40_000)
                .map(|k| {
                    let r = (f64::from(k) + 0.5) * 1e-5;
                    let point = Vector3::new(0.27 + r, 0.27, z);
                    let core = 1.0 - 0.5 * (-(r / (0.35 * edge(&settings, z))).powi(2)).exp();
                    -wake(&settings, &point, ROTORS[0]).z / core * r * 1e-5
                })
                .sum();
            let expected = 0.5 * 0.19 * 0.19;
            assert!((flow / expected - 1.0).abs() < 2e-3, "z = {z}: {flow} {expected}");
        }
    }

    fn edge(settings: &WindSettings, z: f64) -> f64 {
        let d = settings.rotor_height - z;
        settings.rotor_radius / (1.0 + d / (d * d + 0.19 * 0.19).sqrt()).sqrt()
    }

    #[test]
    fn flow_is_downwards_under_a_rotor_and_braked_at_the_ground() {
        let settings = WindSettings { merging: 0.0, heading: 0.0, ..WindSettings::default() };
        let high = mean_wind(&settings, &Vector3::new(0.27, 0.27, -0.3), 5.5, 1.65);
        let low = mean_wind(&settings, &Vector3::new(0.27, 0.27, -0.3), 5.5, 0.35);
        assert!(high.z < -4.0, "{high}");
        assert!(low.z > high.z / 3.0, "{low}");
    }

    /// Oracle: symmetry. Without circulation the wind on the vehicle axis has no horizontal part.
    #[test]
    fn axis_sees_no_side_wind() {
        let settings = WindSettings { circulation: [0.0; 3], ..WindSettings::default() };
        let wind = mean_wind(&settings, &Vector3::new(0.0, 0.0, -0.3), 5.5, 1.3);
        assert!(wind.x.abs() < 1e-12 && wind.y.abs() < 1e-12);
    }

    #[test]
    fn drag_across_follows_the_wind_and_its_square() {
        let settings = WindSettings { diameter: 0.048, cross_drag: 1.15, ..WindSettings::default() };
        let tangent = Vector3::z();
        let single = element_drag(&settings, &Vector3::new(2.0, 0.0, 0.0), &tangent, 0.1);
        let double = element_drag(&settings, &Vector3::new(4.0, 0.0, 0.0), &tangent, 0.1);
        assert!((double - 4.0 * single).norm() < 1e-12);
        // Hand arithmetic: ½·1.19·0.048·0.1·1.15·4 = 0.013138 N.
        assert!((single.x - 0.0131376).abs() < 1e-6 && single.y == 0.0 && single.z == 0.0);
    }
}
