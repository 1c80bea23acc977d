//! Validation of settings before a simulation.

use super::settings::TwinSettings;

/// A setting out of its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("twin setting {name} is {value}; give a number from {least} to {most}")]
pub struct BadSetting {
    /// Path of the setting, as in the settings file.
    pub name: &'static str,
    /// Value that was found.
    pub value: f64,
    /// Smallest value allowed.
    pub least: f64,
    /// Largest value allowed.
    pub most: f64,
}

impl TwinSettings {
    /// Refuses NaN, infinity and values without meaning.
    ///
    /// # Errors
    /// The first setting out of its range.
    pub fn validate(&self) -> Result<(), BadSetting> {
        let checks = self.lengths().into_iter().chain(self.shares()).chain(self.times()).chain(self.rest());
        for (name, value, least, most) in checks {
            if !(least..=most).contains(&value) {
                return Err(BadSetting { name, value, least, most });
            }
        }
        Ok(())
    }

    fn lengths(&self) -> Vec<(&'static str, f64, f64, f64)> {
        let (arm, wind, vehicle) = (&self.arm, &self.wind, &self.vehicle);
        let mut lengths = vec![
            ("arm.length", arm.length, 0.01, 10.0),
            ("tendons.radius", self.tendons.radius, 1e-4, 1.0),
            ("tendons.pulley[0]", self.tendons.pulley[0], 0.0, 1.0),
            ("tendons.pulley[1]", self.tendons.pulley[1], 0.0, 1.0),
            ("tendons.slack_width", self.tendons.slack_width, 1e-7, 0.01),
            ("sheath.slip", self.sheath.slip, 1e-7, 0.1),
            ("wind.rotor_radius", wind.rotor_radius, 0.01, 5.0),
            ("wind.rotor_offset", wind.rotor_offset, 0.01, 5.0),
            ("wind.rotor_height", wind.rotor_height, 0.0, 5.0),
            ("wind.shear_width", wind.shear_width, 1e-4, 5.0),
            ("wind.brake_height", wind.brake_height, 1e-3, 10.0),
            ("wind.outwash_height", wind.outwash_height, 1e-3, 10.0),
            ("wind.fountain_radius", wind.fountain_radius, 1e-3, 10.0),
            ("wind.fountain_height", wind.fountain_height, 1e-3, 10.0),
            ("wind.circulation_altitude", wind.circulation_altitude, 0.0, 100.0),
            ("wind.circulation_width", wind.circulation_width, 1e-3, 100.0),
            ("wind.diameter", wind.diameter, 0.0, 1.0),
            ("wind.tip_diameter", wind.tip_diameter, 0.0, 1.0),
            ("vehicle.stand", vehicle.stand, 0.0, 100.0),
            ("vehicle.hold_spread", vehicle.hold_spread, 0.0, 1.0),
            ("measurement.marker_noise", self.measurement.marker_noise, 0.0, 0.1),
            ("unrecorded.registration", self.unrecorded.registration, 0.0, 1.0),
        ];
        lengths.extend(vehicle.altitudes.map(|altitude| ("vehicle.altitudes", altitude, 0.1, 100.0)));
        lengths
    }

    fn shares(&self) -> Vec<(&'static str, f64, f64, f64)> {
        let (wind, excitation) = (&self.wind, &self.excitation);
        let mut shares = vec![
            ("arm.taper", self.arm.taper, 0.0, 0.99),
            ("cam[0]", self.cam[0], -10.0, 10.0),
            ("cam[1]", self.cam[1], -10.0, 10.0),
            // Above 2 the sheath would pass a negative tension.
            ("sheath.level[0]", self.sheath.level[0], 0.0, 1.5),
            ("sheath.level[1]", self.sheath.level[1], 0.0, 1.5),
            ("sheath.direct", self.sheath.direct, 1e-3, 1.0),
            ("sheath.ageing", self.sheath.ageing, 0.0, 1.0),
            ("creep.share", self.creep.share, 0.0, 100.0),
            // At 1 the primitive of the power law is a logarithm.
            ("creep.exponent", self.creep.exponent, 0.0, 0.999),
            ("wind.shear_growth", wind.shear_growth, 0.0, 1.0),
            ("wind.decay", wind.decay, 0.0, 10.0),
            ("wind.swirl", wind.swirl, -1.0, 1.0),
            ("wind.merging", wind.merging, 0.0, 1.0),
            ("wind.heading", wind.heading, -7.0, 7.0),
            ("wind.outwash", wind.outwash, 0.0, 10.0),
            ("wind.fountain", wind.fountain, 0.0, 10.0),
            ("wind.cross_drag", wind.cross_drag, 0.0, 10.0),
            ("wind.skin_drag", wind.skin_drag, 0.0, 10.0),
            ("wind.dispersion_shape", f64::from(wind.dispersion_shape), 1.0, 50.0),
            ("excitation.shortfall", excitation.shortfall, 0.0, 1.0),
            ("excitation.speed_spread", excitation.speed_spread, 0.0, 3.0),
            // At 1 a stroke would never end.
            ("excitation.partial", excitation.partial, 0.0, 0.95),
            ("excitation.dwell", excitation.dwell, 0.0, 1.0),
            ("measurement.drop", self.measurement.drop, 0.0, 1.0),
            ("measurement.gap", self.measurement.gap, 0.0, 1.0),
            ("unrecorded.pretension", self.unrecorded.pretension, 0.0, 1.0),
            ("unrecorded.turbulence", self.unrecorded.turbulence, 0.0, 1.0),
            ("unrecorded.circulation", self.unrecorded.circulation, 0.0, 1.0),
        ];
        shares.extend(wind.circulation.map(|part| ("wind.circulation", part, -1.0, 1.0)));
        shares
    }

    fn times(&self) -> Vec<(&'static str, f64, f64, f64)> {
        let (measurement, unrecorded) = (&self.measurement, &self.unrecorded);
        vec![
            ("creep.onset", self.creep.onset, 1e-3, 1e6),
            ("wind.dead_delay", self.wind.dead_delay, 0.0, 10.0),
            ("wind.longest_delay", self.wind.longest_delay, self.wind.dead_delay.max(1e-3), 100.0),
            ("vehicle.hold_time", self.vehicle.hold_time, 1e-3, 1e4),
            ("vehicle.throttle_time", self.vehicle.throttle_time, 1e-3, 1e4),
            ("excitation.dwell_time[0]", self.excitation.dwell_time[0], 0.01, 1e3),
            ("excitation.dwell_time[1]", self.excitation.dwell_time[1], 0.01, 1e3),
            ("measurement.period", measurement.period, 1e-3, 100.0),
            ("measurement.jitter", measurement.jitter, 0.0, measurement.period),
            ("measurement.gap_time[0]", measurement.gap_time[0], 0.0, 1e4),
            ("measurement.gap_time[1]", measurement.gap_time[1], 0.0, 1e4),
            ("measurement.preroll", measurement.preroll, 0.0, 1e4),
            ("unrecorded.tilt_time", unrecorded.tilt_time, 1e-3, 1e4),
            ("unrecorded.turbulence_time", unrecorded.turbulence_time, 1e-3, 1e4),
            ("unrecorded.circulation_time", unrecorded.circulation_time, 1e-3, 1e4),
            ("solver.step", self.solver.step, 1e-4, 1.0),
        ]
    }

    fn rest(&self) -> Vec<(&'static str, f64, f64, f64)> {
        let (arm, excitation, vehicle, unrecorded) = (&self.arm, &self.excitation, &self.vehicle, &self.unrecorded);
        let mut rest = vec![
            ("arm.joints", arm.joints as f64, 2.0, 200.0),
            ("arm.stiffness", arm.stiffness, 1e-6, 1e6),
            ("arm.line_density", arm.line_density, 0.0, 100.0),
            ("arm.tip_mass", arm.tip_mass, 0.0, 100.0),
            ("arm.payload", arm.payload, 0.0, 100.0),
            ("arm.axial_stiffness", arm.axial_stiffness, 1.0, 1e12),
            ("arm.gravity", arm.gravity, 0.0, 100.0),
            ("tendons.stiffness", self.tendons.stiffness, 1.0, 1e9),
            ("tendons.pretension", self.tendons.pretension, 1e-6, 1e5),
            ("sheath.speed", self.sheath.speed, 1e-9, 10.0),
            ("wind.density", self.wind.density, 0.0, 100.0),
            ("wind.convection", self.wind.convection, 1e-3, 1e3),
            ("vehicle.mass", vehicle.mass, 0.01, 1e4),
            ("vehicle.throttle", vehicle.throttle, 0.01, 10.0),
            ("vehicle.sag", vehicle.sag, 0.0, 1.0),
            ("vehicle.throttle_spread", vehicle.throttle_spread, 0.0, 1.0),
            ("vehicle.throttle_noise", vehicle.throttle_noise, 0.0, 1.0),
            ("excitation.calibration_amplitude", excitation.calibration_amplitude, 0.01, 100.0),
            ("excitation.flight_amplitude", excitation.flight_amplitude, 0.01, 100.0),
            ("excitation.speed", excitation.speed, 1e-3, 100.0),
            ("excitation.speed_limits[0]", excitation.speed_limits[0], 1e-3, 100.0),
            ("excitation.speed_limits[1]", excitation.speed_limits[1], excitation.speed_limits[0], 100.0),
            ("excitation.partial_length[0]", excitation.partial_length[0], 0.0, 100.0),
            ("excitation.partial_length[1]", excitation.partial_length[1], 0.0, 100.0),
            ("excitation.wander[0]", excitation.wander[0], 0.0, 10.0),
            ("excitation.wander[1]", excitation.wander[1], 0.0, 10.0),
            ("measurement.encoder_bits", f64::from(self.measurement.encoder_bits), 1.0, 31.0),
            ("measurement.encoder_noise", self.measurement.encoder_noise, 0.0, 1.0),
            ("unrecorded.zero", unrecorded.zero, 0.0, 1.0),
            ("unrecorded.registration_tilt", unrecorded.registration_tilt, 0.0, 1.0),
            ("unrecorded.registration_heading", unrecorded.registration_heading, 0.0, 1.0),
            ("unrecorded.tilt_bias", unrecorded.tilt_bias, 0.0, 1.0),
            ("unrecorded.tilt", unrecorded.tilt, 0.0, 1.0),
            ("solver.tolerance", self.solver.tolerance, 1e-12, 1e-3),
            ("solver.iterations", self.solver.iterations as f64, 1.0, 1e4),
        ];
        rest.extend(self.measurement.decimals.map(|digits| ("measurement.decimals", f64::from(digits), 0.0, 12.0)));
        rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_pass_and_nonsense_is_named() {
        assert_eq!(TwinSettings::default().validate(), Ok(()));
        let mut settings = TwinSettings::default();
        settings.creep.onset = f64::NAN;
        assert_eq!(settings.validate().map_err(|bad| bad.name), Err("creep.onset"));
        let mut settings = TwinSettings::default();
        settings.solver.step = 0.0;
        let message = settings.validate().map_err(|bad| bad.to_string());
        assert_eq!(message, Err("twin setting solver.step is 0; give a number from 0.0001 to 1".into()));
    }
}
