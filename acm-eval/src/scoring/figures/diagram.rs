//! The reliability diagram: fraction of right claims over their share, bin by bin.

use crate::closed_loop::figures::{
    axes::{Axes, BELOW, LEFT, Stroke},
    scale::Scale,
    sheet::{Mark, Sheet},
};
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use kuva::render::render::TextAnchor;

use super::reliability::Bin;

/// Caption title.
pub const QUESTION: &str = "Is a name that is given a share of 95 % right in 95 % of the cases?";

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 440.0;

/// Draws one panel; `of` names its campaigns.
pub fn diagram(bins: &[Bin], of: &str) -> Drawing {
    let legend = [
        ("right, of all claims in the bin", palette::BLUE, Mark::Dot),
        ("95 % interval (Wilson)", palette::BLUE, Mark::Line(None)),
        ("calibrated", palette::INK, Mark::Line(Some("6 4"))),
    ];
    let mut sheet = Sheet::of(WIDTH, 40.0 + HEIGHT + BELOW, &legend, of, true);
    let limits = Scale::exactly(-0.05, 1.05, 6);
    let axes =
        Axes { left: LEFT, top: sheet.top + 20.0, width: WIDTH - LEFT - 24.0, height: HEIGHT, x: limits, y: limits };
    axes.draw(&mut sheet, "", "share that was given (mean of the bin)", "fraction that is right");
    let calibrated = Stroke { colour: palette::INK, width: 1.4, dashes: Some("6 4") };
    axes.curve(&mut sheet, [(0.0, 0.0), (1.0, 1.0)], calibrated);
    bins.iter().for_each(|bin| draw(&mut sheet, &axes, bin));
    sheet.series += 1;
    sheet.finish(EXPLANATION)
}

/// Half length of the ends of an interval, px.
const CAP: f64 = 5.0;

/// Draws dot, interval and count of a bin that holds claims. The count stands below the interval, or above where there
/// is no room.
fn draw(sheet: &mut Sheet, axes: &Axes, bin: &Bin) {
    let (Some(mean), Some([low, high])) = (bin.mean, bin.interval) else { return };
    let right = bin.right.count as f64 / bin.right.of as f64;
    let places = (axes.at(mean, low), axes.at(mean, high), axes.at(mean, right));
    let (Some(from), Some(to), Some(at)) = places else { return };
    sheet.line(from, to, palette::BLUE, 2.0, None);
    for (x, y) in [from, to] {
        sheet.line((x - CAP, y), (x + CAP, y), palette::BLUE, 2.0, None);
    }
    sheet.dot(at, 5.0, palette::BLUE);
    let words = format!("{}/{}", bin.right.count, bin.right.of);
    let y = if low > 0.05 { from.1 + 18.0 } else { to.1 - 9.0 };
    sheet.words(at.0, y, &words, 13, TextAnchor::Middle, palette::INK, false);
}

const EXPLANATION: &str = "Claims of all campaigns, sure or not, by the share of resamples in which they were chosen again; \
    beside each bin the claims in it that are right, by their own name or an alias of the committed table.\n\
    A calibrated share lies on the dashed line; above it, claims are better than they say, below it worse.";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::share::Share;

    /// Oracle: counted by hand; a bin without claims draws nothing.
    #[test]
    fn bins_with_claims_are_drawn_with_their_counts() {
        let bin = |count, of, mean, interval| Bin { from: 0.0, right: Share { count, of }, mean, interval };
        let bins = [bin(0, 0, None, None), bin(9, 12, Some(0.8), Some([0.47, 0.91]))];
        let svg = diagram(&bins, "3 campaigns").svg("reliability", QUESTION, "");
        assert!(svg.contains("9/12") && !svg.contains("0/0") && svg.contains("3 campaigns"), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2, "legend and one bin");
    }
}
