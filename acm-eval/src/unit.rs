//! Units of a report: metres inside, millimetres on the page.

pub use acm_train::summary::total_name;

/// How values of an output are shown: multiply by `factor`, then write `symbol`.
#[derive(Debug, Clone, PartialEq)]
pub struct Display {
    /// Shown value per SI value.
    pub factor: f64,
    /// Unit symbol on the page.
    pub symbol: String,
}

impl Display {
    /// Millimetres for lengths; any other SI unit is shown as it is.
    pub fn of(si: &str) -> Self {
        match si {
            "m" => Self { factor: 1000.0, symbol: "mm".into() },
            other => Self { factor: 1.0, symbol: other.into() },
        }
    }
}
