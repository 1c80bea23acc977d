//! How much of an offset may be a first-order lag, which shifts a slow motion as a delay does, and attenuates a fast one.
//!
//! ```text
//! τ·ẏ + y = x   ⇒   ẏ(t) ≈ a·(ẋ(u) − δ·ẍ(u) + c·d³x(u)/dt³),     c = τ²/2 where the offset takes the delay of slow motions, τ
//! ```
//!
//! c and its standard error σ come from least squares with the gains of [`super::refine`], jackknifed by blocks of time. Noise of the
//! regressor attenuates fast motions too. So a lag is seen only where the regression of the source on the reference has the opposite
//! sign: noise gives c > 0 in both. Largest lag: √(2·(c + 2·σ)).

use nalgebra::{SMatrix, SVector};

use super::refine::{Pair, Refined, grid, standard};
use super::slope::local;

/// Blocks of time.
const BLOCKS: usize = 16;

/// Standard errors from which on c is clear.
const CLEAR: f64 = 2.0;

/// Least half width of a window, in steps of the slower signal: a narrow one has too much noise.
const WIDTH: f64 = 16.0;

/// Regressors: the rate with its gains, its derivative, and the second one.
const TERMS: usize = 5;

/// What may be a lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// There is one.
    pub is_seen: bool,
    /// Noise attenuates the fast motions: the largest lag is not to be trusted.
    is_noisy: bool,
    /// Time constant of the largest, s.
    pub largest: f64,
}

/// c and its standard error, s².
type Curvature = (f64, f64);

/// The largest lag that one of the windows sees; where none sees one, the largest that one of those without much noise does not exclude.
/// Windows become wider.
pub fn largest_lag(windows: &[(Pair, Refined)], origin: f64) -> Lag {
    let is_wide = |pair: &Pair| pair.width > 0.9 * WIDTH * pair.reference.step().max(pair.source.step());
    let first = windows.iter().position(|(pair, _)| is_wide(pair)).unwrap_or(windows.len().saturating_sub(1));
    let lags: Vec<Lag> = windows[first..].iter().filter_map(|(pair, found)| in_window(pair, found, origin)).collect();
    let largest = |counts: &dyn Fn(&&Lag) -> bool| {
        lags.iter().filter(counts).max_by(|a, b| a.largest.total_cmp(&b.largest)).copied()
    };
    let unknown = Lag { is_seen: false, is_noisy: true, largest: f64::INFINITY };
    largest(&|lag| lag.is_seen).or(largest(&|lag| !lag.is_noisy)).or(lags.last().copied()).unwrap_or(unknown)
}

/// A lag of the reference behind the source, or of the source behind the reference.
fn in_window(pair: &Pair, found: &Refined, origin: f64) -> Option<Lag> {
    let back = Pair { reference: pair.source, source: pair.reference, width: pair.width };
    let forward = curvature(pair, found.offset, found.drift, origin)?;
    let backward = curvature(&back, -found.offset, -found.drift, origin + found.offset)?;
    let clear = |(c, error): Curvature| c.signum() * f64::from(u8::from(c.abs() > CLEAR * error));
    let largest = |(c, error): Curvature| (2.0 * (c + CLEAR * error).max(0.0)).sqrt();
    let minus = |(c, error): Curvature| (-c, error);
    let is_seen = clear(forward) * clear(backward) < 0.0;
    let ahead = largest(forward).max(largest(minus(backward)));
    let behind = largest(backward).max(largest(minus(forward)));
    let largest = match is_seen {
        true if forward.0 > 0.0 => ahead,
        true => behind,
        false => largest(forward).max(largest(backward)),
    };
    let is_noisy = clear(forward) > 0.0 && clear(backward) > 0.0;
    Some(Lag { is_seen, is_noisy, largest })
}

/// The regression of the reference's rates on the source's.
fn curvature(pair: &Pair, offset: f64, drift: f64, origin: f64) -> Option<Curvature> {
    type Normal = (SMatrix<f64, TERMS, TERMS>, SVector<f64, TERMS>);
    let times = grid(pair, offset, drift, origin);
    let (first, last) = (*times.first()?, *times.last()?);
    if last - first < 2.0 * pair.width * BLOCKS as f64 {
        return None; // neighbouring blocks are not independent
    }
    let ((center, scale), h) = (standard(pair.source), 0.5 * pair.width);
    let rate = |u: f64| local(pair.source, u, pair.width);
    let mut blocks: Vec<Normal> = vec![(SMatrix::zeros(), SVector::zeros()); BLOCKS];
    for t in &times {
        let u = origin + (t - offset - origin) / (1.0 + drift);
        let (Some((_, r)), Some((x, s)), Some((_, before)), Some((_, after))) =
            (local(pair.reference, *t, pair.width), rate(u), rate(u - h), rate(u + h))
        else {
            continue;
        };
        let (z, slope, bend) =
            ((x - center) / scale, (after - before) / (2.0 * h), (after - 2.0 * s + before) / (h * h));
        let row = SVector::from([s, z * s, z * z * s, slope, bend]);
        let block = &mut blocks[(((t - first) / (last - first) * BLOCKS as f64) as usize).min(BLOCKS - 1)];
        block.0 += row * row.transpose();
        block.1 += row * r;
    }
    let solve = |a: SMatrix<f64, TERMS, TERMS>, g: SVector<f64, TERMS>| a.lu().solve(&g).map(|x| x[4] / x[0]);
    let (a, g) = blocks.iter().fold((SMatrix::zeros(), SVector::zeros()), |(a, g), b| (a + b.0, g + b.1));
    let c = solve(a, g)?;
    let without = blocks.iter().map(|b| Some((solve(a - b.0, g - b.1)? - c).powi(2)));
    let sum = without.sum::<Option<f64>>()?;
    let error = (sum * (BLOCKS - 1) as f64 / BLOCKS as f64).sqrt();
    (c.is_finite() && error.is_finite()).then_some((c, error))
}
