//! Columns with the same time stamps that pass through one linear filter: a step is computed once for all, and applied to several
//! columns at a time.

use super::{Last, Point, State, interval};

/// Columns that go together.
const TOGETHER: usize = 4;

/// Samples for which steps are computed before columns pass through them.
const AHEAD: usize = 64;

/// A linear filter with a state for each column.
pub trait Beside: State + Copy {
    /// Parameters of the filter.
    type Shape: Copy + PartialEq;
    /// A step: what it does to any signal.
    type Stride: Copy + Default;

    /// The step over an interval `h` in s; 0 at the first sample.
    fn stride(h: f64, shape: Self::Shape) -> Self::Stride;

    /// The filtered signal after the step, from the signal at both ends of it.
    fn go(&mut self, stride: &Self::Stride, past: f64, x: f64) -> f64;

    /// The last sample of the signal.
    fn before(&mut self) -> &mut Option<Point>;
}

/// Passes all columns through a filter with a state for each; `shape` gives its parameters at each sample.
pub fn pass<F: Beside>(lags: &mut [F], time: &[f64], shape: impl Fn(usize) -> F::Shape, columns: &mut [Vec<f64>]) {
    let mut last = lags.first_mut().and_then(|lag| *lag.before()).map(|before| before.time);
    let (mut strides, mut known) = ([F::Stride::default(); AHEAD], Last::default());
    for (part, time) in time.chunks(AHEAD).enumerate() {
        let first = part * AHEAD;
        for (k, (stride, now)) in strides.iter_mut().zip(time).enumerate() {
            let (h, shape) = (last.map_or(0.0, |last| interval(last, *now)), shape(first + k));
            *stride = known.of((h, shape), || F::stride(h, shape));
            last = Some(*now);
        }
        let strides = &strides[..time.len()];
        let Some(end) = last else { return };
        let mut of_columns = columns.chunks_exact_mut(TOGETHER);
        let mut of_lags = lags.chunks_exact_mut(TOGETHER);
        for (columns, lags) in of_columns.by_ref().zip(of_lags.by_ref()) {
            go::<F, TOGETHER>(lags, strides, (first, end), columns);
        }
        let rest = of_columns.into_remainder().iter_mut().zip(of_lags.into_remainder());
        rest.for_each(|(column, lag)| {
            go::<F, 1>(std::slice::from_mut(lag), strides, (first, end), std::slice::from_mut(column));
        });
    }
}

/// Passes `N` columns through steps from sample `first` to time `end`.
#[inline]
fn go<F: Beside, const N: usize>(
    lags: &mut [F],
    strides: &[F::Stride],
    (first, end): (usize, f64),
    columns: &mut [Vec<f64>],
) {
    let mut columns = columns.iter_mut();
    let columns: [&mut [f64]; N] = std::array::from_fn(|_| {
        columns.next().and_then(|column| column.get_mut(first..first + strides.len())).unwrap_or_default()
    });
    let mut states: [F; N] = std::array::from_fn(|j| lags[j]);
    let mut past: [f64; N] =
        std::array::from_fn(|j| states[j].before().map_or_else(|| columns[j].first().copied().unwrap_or(0.0), |b| b.x));
    for (t, stride) in strides.iter().enumerate() {
        for j in 0..N {
            let Some(y) = columns[j].get_mut(t) else { return };
            let x = *y;
            *y = states[j].go(stride, past[j], x);
            past[j] = x;
        }
    }
    for (j, lag) in lags.iter_mut().enumerate().take(N) {
        *states[j].before() = Some(Point { time: end, x: past[j] });
        *lag = states[j];
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Decay, Lag, SecondOrderLag, Swing};
    use super::*;

    fn columns(time: &[f64], count: usize) -> Vec<Vec<f64>> {
        (0..count).map(|j| time.iter().map(|t| ((1.0 + j as f64) * t).sin() + j as f64).collect()).collect()
    }

    /// Oracle: one column after the other, sample by sample, with time stamps that repeat and parameters that vary; bit for bit, and
    /// however the trial is cut.
    #[test]
    fn columns_together_are_columns_alone() {
        let time: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k - k % 7 / 6) + 0.003 * f64::from(k % 5)).collect();
        for count in [1, 3, 4, 9] {
            let alone: Vec<[Vec<f64>; 2]> = columns(&time, count)
                .into_iter()
                .map(|x| {
                    let (mut lag, mut decay) = (Lag::default(), Decay::default());
                    let (mut sprung, mut swing) = (SecondOrderLag::default(), Swing::default());
                    let each = time.iter().zip(&x).enumerate();
                    let both = each.map(|(k, (t, x))| {
                        let late = lag.step(*t, *x, 0.2 + 0.001 * k as f64, &mut decay);
                        (late, sprung.step(*t, *x, (0.3, 0.4 + 0.001 * k as f64), &mut swing))
                    });
                    let (late, sprung) = both.unzip();
                    [late, sprung]
                })
                .collect();
            for pieces in [200, 70, 1] {
                let (mut late, mut sprung) = (columns(&time, count), columns(&time, count));
                let (mut lags, mut springs) = (vec![Lag::default(); count], vec![SecondOrderLag::default(); count]);
                for (k, time) in time.chunks(pieces).enumerate() {
                    let first = k * pieces;
                    let mut part = |x: &mut Vec<Vec<f64>>, is_late: bool| {
                        let mut cut: Vec<Vec<f64>> = x.iter().map(|x| x[first..first + time.len()].to_vec()).collect();
                        if is_late {
                            pass(&mut lags, time, |k| 0.2 + 0.001 * (first + k) as f64, &mut cut);
                        } else {
                            pass(&mut springs, time, |k| (0.3, 0.4 + 0.001 * (first + k) as f64), &mut cut);
                        }
                        x.iter_mut().zip(cut).for_each(|(x, cut)| x[first..first + cut.len()].copy_from_slice(&cut));
                    };
                    part(&mut late, true);
                    part(&mut sprung, false);
                }
                for (j, [alone_late, alone_sprung]) in alone.iter().enumerate() {
                    assert_eq!((&late[j], &sprung[j]), (alone_late, alone_sprung), "{count} {pieces} {j}");
                }
            }
        }
    }
}
