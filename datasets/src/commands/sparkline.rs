//! A signal in one line of text.

const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Draws `values` over `time` in `width` characters between `least` and `greatest`: each character is the mean of its
/// span of time, and a span without samples is blank.
pub fn draw(time: &[f64], values: &[f64], width: usize, (least, greatest): (f64, f64)) -> String {
    let (Some(first), Some(last)) = (time.first(), time.last()) else { return " ".repeat(width) };
    let mut spans = vec![(0.0, 0usize); width];
    for (t, value) in time.iter().zip(values) {
        let place = if last > first { (t - first) / (last - first) * width as f64 } else { 0.0 };
        let span = &mut spans[(place as usize).min(width - 1)];
        *span = (span.0 + value, span.1 + 1);
    }
    let bar = |(sum, count): &(f64, usize)| match *count {
        0 => ' ',
        n => BARS[level(sum / n as f64, least, greatest)],
    };
    spans.iter().map(bar).collect()
}

fn level(value: f64, least: f64, greatest: f64) -> usize {
    let part = if greatest > least { (value - least) / (greatest - least) } else { 0.5 };
    ((part * BARS.len() as f64) as usize).min(BARS.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::draw;

    #[test]
    fn a_ramp_climbs_and_a_gap_is_blank() {
        let time: Vec<f64> = (0..80).map(f64::from).collect();
        assert_eq!(draw(&time, &time, 8, (0.0, 79.0)), "▁▂▃▄▅▆▇█");
        assert_eq!(draw(&[0.0, 1.0, 9.0, 10.0], &[1.0; 4], 5, (1.0, 1.0)), "▅   ▅");
        assert_eq!(draw(&[], &[], 3, (0.0, 1.0)), "   ");
    }
}
