//! `[arm]`: its length, axes, strain and registration.

use super::Check;
use crate::manifest::Arm;
use crate::units::Dimension;

/// A longer arm was measured in millimetres, m.
const LONGEST_ARM: f64 = 100.0;

impl Check<'_> {
    pub(super) fn arm(&mut self, arm: &Arm) {
        if self.quantity(&["arm", "length"], &arm.length).is_some_and(|d| d != Dimension::Length) {
            self.say(&["arm", "length", "unit"], format!("{:?} is no length; use m or mm", arm.length.unit));
        }
        if arm.length.value <= 0.0 {
            self.say(
                &["arm", "length", "value"],
                format!("the arm is {} long; give a length above 0", arm.length.value),
            );
        }
        if arm.length.si() > LONGEST_ARM {
            let message = format!("the arm is {} m long; correct its unit: 620 mm are 0.62 m", arm.length.si());
            self.say(&["arm", "length", "unit"], message);
        }
        for (name, axis) in [("axis", &arm.axis), ("down", &arm.down)] {
            if let Some(axis) = axis.as_deref().filter(|a| !["x", "y", "z", "-x", "-y", "-z"].contains(a)) {
                self.say(&["arm", name], format!("{name} {axis:?} is not one of x y z -x -y -z; choose one"));
            }
        }
        let before = self.problems.len();
        self.strain(arm);
        self.registration(arm);
        if let (true, Err(e)) = (self.problems.len() == before && arm.length.si() > 0.0, arm.spec().validate()) {
            self.say(&[&["arm"], arm_key(&e)].concat(), e.to_string());
        }
    }

    fn registration(&mut self, arm: &Arm) {
        let Some(registration) = &arm.registration else { return };
        let key = ["arm", "registration"];
        let pose = registration.rotation.is_some() || registration.translation.is_some();
        match registration.kind.as_deref() {
            Some("identified") if pose => {
                let message = "`rotation` and `translation` belong to kind = \"fixed\"; correct it, or delete them";
                self.say(&["arm", "registration", "kind"], message);
            }
            Some("fixed") if registration.twist.is_some() => {
                self.say(
                    &["arm", "registration", "twist"],
                    "it belongs to kind = \"identified\"; delete one of the two",
                );
            }
            Some("identified" | "fixed") => {}
            Some(other) => {
                self.say(&["arm", "registration", "kind"], format!("unknown kind {other:?}; known: identified, fixed"));
            }
            None => self.say(&key, "`kind` is missing; say kind = \"identified\" or \"fixed\""),
        }
    }

    fn strain(&mut self, arm: &Arm) {
        let (strain, key) = (&arm.strain, ["arm", "strain"]);
        match (strain.basis.as_deref(), strain.order, strain.segments) {
            (None, None, None) | (Some("legendre"), _, None) | (Some("piecewise"), None, Some(_)) => {}
            (Some("piecewise"), None, None) => self.say(&key, "a piecewise basis needs `segments`"),
            (Some("legendre"), _, Some(_)) => self.say(&key, "`segments` belongs to basis = \"piecewise\""),
            (Some("piecewise"), Some(_), _) => self.say(&key, "`order` belongs to basis = \"legendre\""),
            (Some(other), _, _) => {
                self.say(&["arm", "strain", "basis"], format!("unknown basis {other:?}; known: legendre, piecewise"));
            }
            (None, _, _) => self.say(&key, "`basis` is missing; say basis = \"legendre\" or \"piecewise\""),
        }
    }
}

/// The key that an error of the physics is about.
fn arm_key(error: &acm_core::arm::ArmError) -> &'static [&'static str] {
    use acm_core::arm::ArmError;
    match error {
        ArmError::Length { .. } => &["length", "value"],
        ArmError::OutOfRange { what: "strain.segments", .. } => &["strain", "segments"],
        ArmError::OutOfRange { what, .. } if what.starts_with("strain") => &["strain", "order"],
        ArmError::OutOfRange { what: "degree", .. } => &["actuation", "degree"],
        ArmError::OutOfRange { .. } => &["steps"],
        ArmError::Tolerance { .. } => &["tolerance"],
        ArmError::Registration { what: "rotation", .. } => &["registration", "rotation"],
        ArmError::Registration { .. } => &["registration", "translation"],
    }
}
