//! Roles of trials.

/// Role of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// The nominal model is fitted here.
    Calibration,
    /// Effects are sought here.
    Development,
    /// Not used for selection; scored last.
    HeldOut,
}
