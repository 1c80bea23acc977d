//! Bounds that may be open: JSON has no infinity, so an open bound is written as null.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the bounds; null for a bound that is not finite.
pub fn serialize<S: Serializer>(bounds: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
    bounds.map(|bound| bound.is_finite().then_some(bound)).serialize(serializer)
}

/// Reads the bounds. Where null stands, the lower bound is −∞ and the upper one ∞.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let [lower, upper] = <[Option<f64>; 2]>::deserialize(deserializer)?;
    Ok([lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY)])
}

#[cfg(test)]
mod tests {
    use crate::finding::FoundParameter;

    #[test]
    fn an_open_bound_survives_a_file() {
        let parameter = FoundParameter {
            name: "delay".into(),
            value: 0.2,
            unit: "s".into(),
            interval: [0.0, f64::INFINITY],
            depends_on: None,
            at_bound: false,
            undetermined: false,
        };
        let text = serde_json::to_string(&parameter).unwrap();
        assert!(text.contains("[0.0,null]"), "{text}");
        assert_eq!(serde_json::from_str::<FoundParameter>(&text).unwrap(), parameter);
    }
}
