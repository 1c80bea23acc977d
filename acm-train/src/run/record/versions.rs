//! Versions of the running code, for records.

use super::Versions;

/// Version of burn, pinned exactly in the workspace.
const BURN: &str = "0.22.1";

/// Returns the versions of this build.
pub fn versions() -> Versions {
    let commit = option_env!("ACM_COMMIT").filter(|commit| !commit.is_empty()).map(String::from);
    Versions { acm: env!("CARGO_PKG_VERSION").into(), burn: BURN.into(), commit }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the workspace's own pin.
    #[test]
    fn burn_is_the_version_that_is_pinned() {
        let workspace = include_str!("../../../../Cargo.toml");
        assert!(workspace.contains(&format!("version = \"={BURN}\"")));
    }
}
