//! What a unit of load, or of marker displacement, does to each marker of a bent arm.

mod compliance;

pub use compliance::{FieldModel, FieldScratch, horizontal};

/// The columns of [`crate::effects::Site::Load`] and [`crate::effects::Site::Marker`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// Weight at the tip, downwards; force over bending stiffness, 1/m².
    TipWeight,
    /// Weight spread evenly along the arm, downwards; force per length over stiffness, 1/m³.
    SelfWeight,
    /// Drag of a wind that blows straight down along the whole arm, |v_n| v_n with v_n the part of it across the arm.
    Wash,
    /// The same drag, times what falls off linearly from 1 at the base's height to 0 one arm length below.
    WashNear,
    /// Sideways load along the first horizontal axis ([`horizontal`]), spread evenly; 1/m³.
    SideFirst,
    /// Sideways load along the second horizontal axis.
    SideSecond,
    /// The marker's place along its disk's own x, y, z, m.
    MarkerX,
    /// See [`Field::MarkerX`].
    MarkerY,
    /// See [`Field::MarkerX`].
    MarkerZ,
}

impl Field {
    /// In the order of the columns.
    pub const ALL: [Field; 9] = [
        Field::TipWeight,
        Field::SelfWeight,
        Field::Wash,
        Field::WashNear,
        Field::SideFirst,
        Field::SideSecond,
        Field::MarkerX,
        Field::MarkerY,
        Field::MarkerZ,
    ];

    /// Index of the column.
    pub fn column(self) -> usize {
        self as usize
    }
}
