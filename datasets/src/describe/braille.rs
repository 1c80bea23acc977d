//! A signal as dots of braille: two columns and four levels in each character.

/// Bits of a braille character, by column and by level from the top.
const DOTS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Draws `values` over `time` between `least` and `greatest`, in `height` lines of `width` characters.
///
/// Each column of dots spans from the least to the greatest value in its part of the time, so that nothing is averaged
/// away; a part without samples is blank.
pub fn draw(time: &[f64], values: &[f64], width: usize, height: usize, (least, greatest): (f64, f64)) -> Vec<String> {
    let mut dots = vec![vec![0u32; width]; height];
    let top = 4 * height - 1;
    let level = |value: f64| {
        let part = if greatest > least { (value - least) / (greatest - least) } else { 0.5 };
        top - (part * top as f64).round().clamp(0.0, top as f64) as usize
    };
    for (column, span) in spans(time, values, 2 * width).into_iter().enumerate() {
        let Some((low, high)) = span else { continue };
        for row in level(high)..=level(low) {
            dots[row / 4][column / 2] |= DOTS[column % 2][row % 4];
        }
    }
    let character = |bits: &u32| if *bits == 0 { ' ' } else { char::from_u32(0x2800 + bits).unwrap_or('?') };
    dots.iter().map(|line| line.iter().map(character).collect()).collect()
}

/// Least and greatest value of each part of the time, where it has samples.
fn spans(time: &[f64], values: &[f64], parts: usize) -> Vec<Option<(f64, f64)>> {
    let mut spans: Vec<Option<(f64, f64)>> = vec![None; parts];
    let (Some(first), Some(last)) = (time.first(), time.last()) else { return Vec::new() };
    for (t, value) in time.iter().zip(values) {
        let place = if last > first { (t - first) / (last - first) * parts as f64 } else { 0.0 };
        let span = &mut spans[(place as usize).min(parts - 1)];
        let (low, high) = span.unwrap_or((*value, *value));
        *span = Some((low.min(*value), high.max(*value)));
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::draw;

    #[test]
    fn a_ramp_climbs_and_a_gap_is_blank() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        assert_eq!(draw(&time, &time, 4, 2, (0.0, 7.0)), ["  ⡠⠊", "⡠⠊  "]);
        assert_eq!(draw(&[0.0, 1.0, 9.0, 10.0], &[1.0; 4], 5, 1, (0.0, 1.0)), ["⠉   ⠈"]);
        assert_eq!(draw(&[], &[], 3, 1, (0.0, 1.0)), ["   "]);
    }

    /// A swing within one column is a bar, not its mean.
    #[test]
    fn nothing_is_averaged_away() {
        assert_eq!(draw(&[0.0, 0.1, 1.0], &[0.0, 1.0, 0.0], 1, 1, (0.0, 1.0)), ["⣇"]);
    }
}
