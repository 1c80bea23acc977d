//! Displacement of each marker of a bent arm per unit of a load or of a marker displacement.

mod beam;
mod compliance;

pub use compliance::{FieldModel, FieldScratch, horizontal};

/// Loads on an arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// Weight at the tip, downwards; force over bending stiffness, 1/m².
    TipWeight,
    /// Weight spread evenly along the arm, downwards; force per length over stiffness, 1/m³.
    SelfWeight,
    /// Drag of a wind that blows straight down along the whole arm, |v_n| v_n with v_n the part of it across the arm.
    Wash,
    /// Drag of the wash, times a factor that falls linearly from 1 at the base's height to 0 one arm length below.
    WashNear,
    /// Sideways load along the first horizontal axis ([`horizontal`]), spread evenly; 1/m³.
    SideFirst,
    /// Sideways load along the second horizontal axis.
    SideSecond,
}

impl Load {
    /// In the order of the columns.
    pub const ALL: [Load; 6] =
        [Load::TipWeight, Load::SelfWeight, Load::Wash, Load::WashNear, Load::SideFirst, Load::SideSecond];
}

/// The columns of [`crate::effects::Site::Load`] and [`crate::effects::Site::Marker`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// Displacement by a load on an arm that bends freely.
    Free(Load),
    /// Displacement by the mean of that bending, the same everywhere along the arm: what tendons can hold against the load.
    Held(Load),
    /// The marker's place along its disk's own x, y, z, m.
    MarkerX,
    /// See [`Field::MarkerX`].
    MarkerY,
    /// See [`Field::MarkerX`].
    MarkerZ,
}

impl Field {
    /// In the order of the columns.
    pub const ALL: [Field; 15] = [
        Field::Free(Load::TipWeight),
        Field::Free(Load::SelfWeight),
        Field::Free(Load::Wash),
        Field::Free(Load::WashNear),
        Field::Free(Load::SideFirst),
        Field::Free(Load::SideSecond),
        Field::Held(Load::TipWeight),
        Field::Held(Load::SelfWeight),
        Field::Held(Load::Wash),
        Field::Held(Load::WashNear),
        Field::Held(Load::SideFirst),
        Field::Held(Load::SideSecond),
        Field::MarkerX,
        Field::MarkerY,
        Field::MarkerZ,
    ];

    /// Index of the column.
    pub fn column(self) -> usize {
        let loads = Load::ALL.len();
        match self {
            Field::Free(load) => load as usize,
            Field::Held(load) => loads + load as usize,
            Field::MarkerX => 2 * loads,
            Field::MarkerY => 2 * loads + 1,
            Field::MarkerZ => 2 * loads + 2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_places_in_the_list() {
        let columns: Vec<usize> = Field::ALL.iter().map(|field| field.column()).collect();
        assert_eq!(columns, (0..Field::ALL.len()).collect::<Vec<_>>());
    }
}
