//! Colours that people with any colour vision can distinguish: the hues of Okabe & Ito (2008), "Color Universal
//! Design", the light ones darkened until a thin line stands out from white (3 : 1, WCAG 2.1, 1.4.11).
//!
//! Figures are drawn on white; [`crate::figures::canvas::dark`] says what each colour becomes on a dark page.

/// Text and axes.
pub const INK: &str = "#222222";
/// Colour of grid lines.
pub const GRID: &str = "#dddddd";
/// Colour of secondary text.
pub const FAINT: &str = "#5c5c5c";
/// The mark on figures of synthetic data.
pub const WARNING: &str = "#b03a00";

/// Orange.
pub const ORANGE: &str = "#bd8200";
/// Bluish green.
pub const GREEN: &str = "#009e73";
/// Blue.
pub const BLUE: &str = "#0072b2";
/// Vermillion.
pub const VERMILLION: &str = "#d55e00";
/// Reddish purple.
pub const PURPLE: &str = "#c46d9d";
/// Sky blue.
pub const SKY: &str = "#3796cf";

const NETWORKS: [&str; 6] = [ORANGE, GREEN, BLUE, VERMILLION, PURPLE, SKY];

/// Returns colours of trials, slices and other series without a colour of their own; from the start again after six.
pub fn series(index: usize) -> &'static str {
    [BLUE, ORANGE, GREEN, PURPLE, VERMILLION, SKY][index % 6]
}

/// The nominal model, sums, and noise.
pub const GREY: &str = "#6e6e6e";
/// The polynomial, and what stays in the background.
pub const PALE_GREY: &str = "#929292";

/// The arm in space.
pub const ARM: &str = "#4a6a8a";

/// Returns greys for models that are not learned.
pub fn baseline(key: &str) -> &'static str {
    if key == "polynomial" { PALE_GREY } else { GREY }
}

/// Assignment of colours by which one kind of network or outside baseline looks the same on every page.
#[derive(Debug, Default)]
pub struct Networks {
    taken: Vec<usize>,
}

impl Networks {
    /// Returns the kind's own colour where it is still free, otherwise the next free one (from the start again after
    /// six).
    pub fn next(&mut self, kind: &str) -> &'static str {
        let own = match kind {
            "mlp" => 0,
            "gru" => 1,
            "cfc" => 2,
            "ridge" => 4,
            "boosted_trees" => 5,
            _ => 3,
        };
        let free = |slot: &usize| !self.taken.contains(slot);
        // The first three belong to kinds that may yet come.
        let slot = std::iter::once(own).chain(3..NETWORKS.len()).chain(0..3).find(free).unwrap_or(self.taken.len());
        self.taken.push(slot);
        NETWORKS[slot % NETWORKS.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_keeps_its_colour_and_no_two_of_six_runs_share_one() {
        assert_eq!(Networks::default().next("cfc"), BLUE);
        assert_eq!(Networks::default().next("ridge"), PURPLE);
        assert_eq!(Networks::default().next("boosted_trees"), SKY);
        let mut colours = Networks::default();
        let mut six: Vec<_> = ["cfc", "cfc", "mlp", "gru", "cfc", "mlp"].map(|kind| colours.next(kind)).to_vec();
        assert_eq!((six[0], six[3]), (BLUE, GREEN));
        six.sort_unstable();
        six.dedup();
        assert_eq!(six.len(), 6);
        assert!(NETWORKS.contains(&colours.next("mlp")));
    }
}
