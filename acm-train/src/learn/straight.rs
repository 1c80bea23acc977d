//! Straight path beside a network: least squares from the channels to the residual, which the network then refines.
//!
//! ```text
//! r̂ = W [x̃ 1]          W = argmin Σ_t ‖r_t − W [x̃_t 1]‖² + ρ T ‖W‖²
//! ```
//!
//! | symbol | meaning                                     | shape     | unit |
//! | ------ | ------------------------------------------- | --------- | ---- |
//! | `x̃`    | channels, standardised                      | `[C]`     | –    |
//! | `r`    | residual of the nominal model               | `[O]`     | m    |
//! | `W`    | weights of the path                         | `[O×(C+1)]` | m    |
//! | `ρ`    | ridge, so that collinear channels have a W  | –         | –    |
//!
//! The path is used where it predicts blocks of the training part left out better than a constant, by more than one standard error of the
//! difference over the blocks ([`simplest`]).

use std::ops::{AddAssign, Sub};

use acm_core::left_out::{BLOCKS, simplest};
use acm_datasets::{Series, Standardizer};
use nalgebra::{DMatrix, DVector};

use super::examples::single::by_rows;

/// Ridge ρ: of the rounding's size, relative to channels of variance 1.
const RIDGE: f64 = 1e-6;

/// Weights of the path.
#[derive(Debug, Clone, PartialEq)]
pub struct Straight {
    /// Rows of the channels, then of the constant: `[(C+1)×O]`.
    weights: DMatrix<f64>,
}

impl Straight {
    /// Fits the path to the series that `training` shows one after the other, each time it is called. Returns `None` if a constant is as good.
    ///
    /// # Errors
    /// What `training` says.
    pub fn chosen<E>(
        inputs: &Standardizer,
        levels: &[bool],
        training: impl Fn(&mut dyn FnMut(&Series)) -> Result<(), E>,
    ) -> Result<Option<Self>, E> {
        let (mut total, mut row, mut blocks) = (0, 0, vec![Products::default(); BLOCKS]);
        training(&mut |series| total += measured(series).count())?;
        training(&mut |series| {
            let mut channels = inputs.standardize(&series.inputs).insert_column(levels.len(), 1.0);
            (0..levels.len()).filter(|channel| !levels[*channel]).for_each(|rate| channels.column_mut(rate).fill(0.0));
            let of_block: Vec<(usize, usize)> =
                measured(series).enumerate().map(|(k, sample)| ((row + k) * BLOCKS / total, sample)).collect();
            for samples in of_block.chunk_by(|a, b| a.0 == b.0) {
                let rows: Vec<usize> = samples.iter().map(|(_, sample)| *sample).collect();
                blocks[samples[0].0] += &Products::of(&channels.select_rows(&rows), &series.target.select_rows(&rows));
            }
            row += of_block.len();
        })?;
        let mut whole = Products::default();
        blocks.iter().for_each(|block| whole += block);
        let left_out = |solve: &dyn Fn(&Products) -> DMatrix<f64>| -> Vec<f64> {
            blocks.iter().map(|block| block.error(&solve(&(&whole - block)), &whole)).collect()
        };
        let errors = [left_out(&Products::constant), left_out(&Products::path)];
        Ok((total > BLOCKS && simplest(&errors) == 1).then(|| Self { weights: whole.path() }))
    }

    /// Returns the path's prediction of output `o` from standardised channels.
    pub fn of(&self, channels: &[f32], o: usize) -> f64 {
        let weights = self.weights.column(o);
        let products = weights.iter().zip(channels).map(|(weight, channel)| weight * f64::from(*channel));
        products.fold(weights[channels.len()], |sum, product| sum + product)
    }

    /// Returns the path's prediction at each sample of a series `[T×O]`.
    pub fn along(&self, inputs: &Standardizer, series: &Series) -> DMatrix<f64> {
        let channels = by_rows(&inputs.standardize(&series.inputs));
        let width = self.weights.nrows() - 1;
        DMatrix::from_fn(series.time.len(), self.weights.ncols(), |t, o| {
            self.of(&channels[t * width..(t + 1) * width], o)
        })
    }

    /// Returns the weights row by row: of each channel for all outputs, then of the constant.
    pub fn rows(&self) -> Vec<Vec<f64>> {
        self.weights.row_iter().map(|row| row.iter().copied().collect()).collect()
    }
}

/// Samples of a series that have an output.
fn measured(series: &Series) -> impl Iterator<Item = usize> {
    (0..series.time.len()).filter(|sample| series.is_measured(*sample))
}

/// Sums of products over some samples.
#[derive(Debug, Clone)]
struct Products {
    samples: f64,
    /// Of channels and constant with one another [(C+1)×(C+1)].
    own: DMatrix<f64>,
    /// Of these with the residual [(C+1)×O].
    with: DMatrix<f64>,
    /// Of the residual with itself, by output [O].
    square: DVector<f64>,
}

impl Default for Products {
    fn default() -> Self {
        Self { samples: 0.0, own: DMatrix::zeros(0, 0), with: DMatrix::zeros(0, 0), square: DVector::zeros(0) }
    }
}

impl Products {
    /// Returns the sums over samples with these channels and constant [T×(C+1)], and targets [T×O].
    fn of(channels: &DMatrix<f64>, targets: &DMatrix<f64>) -> Self {
        Self {
            samples: channels.nrows() as f64,
            own: channels.tr_mul(channels),
            with: channels.tr_mul(targets),
            square: DVector::from_iterator(targets.ncols(), targets.column_iter().map(|column| column.norm_squared())),
        }
    }

    fn path(&self) -> DMatrix<f64> {
        let size = self.own.nrows();
        let ridged = &self.own + DMatrix::identity(size, size) * (RIDGE * self.samples.max(1.0));
        ridged.cholesky().map_or_else(|| DMatrix::zeros(size, self.with.ncols()), |factors| factors.solve(&self.with))
    }

    /// Returns the weights of a constant alone.
    fn constant(&self) -> DMatrix<f64> {
        let mut weights = DMatrix::zeros(self.with.nrows(), self.with.ncols());
        if let Some(last) = self.with.nrows().checked_sub(1) {
            weights.set_row(last, &(self.with.row(last) / self.samples.max(1.0)));
        }
        weights
    }

    /// Returns the mean squared error of weights on these samples, each output in units of its mean square in `whole`.
    fn error(&self, weights: &DMatrix<f64>, whole: &Self) -> f64 {
        let of = |o: usize| {
            let w = weights.column(o);
            let left = self.square[o] - 2.0 * w.dot(&self.with.column(o)) + w.dot(&(&self.own * w));
            if whole.square[o] > 0.0 { left * whole.samples / (self.samples.max(1.0) * whole.square[o]) } else { 0.0 }
        };
        (0..self.square.len()).map(of).sum()
    }
}

impl AddAssign<&Self> for Products {
    fn add_assign(&mut self, other: &Self) {
        if self.samples == 0.0 {
            other.clone_into(self);
            return;
        }
        self.samples += other.samples;
        self.own += &other.own;
        self.with += &other.with;
        self.square += &other.square;
    }
}

impl Sub for &Products {
    type Output = Products;

    fn sub(self, other: Self) -> Products {
        if other.samples == 0.0 {
            return self.clone();
        }
        Products {
            samples: self.samples - other.samples,
            own: &self.own - &other.own,
            with: &self.with - &other.with,
            square: &self.square - &other.square,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A channel, its rate, and a target; the last sample has no output.
    fn series(target: impl Fn(f64, usize) -> f64) -> Series {
        let channel = |t: usize| (0.7 * t as f64).sin() + 3.0;
        let target = DMatrix::from_fn(200, 1, |t, _| if t < 199 { target(channel(t), t) } else { f64::NAN });
        Series {
            trial: "a".into(),
            time: (0..200).map(f64::from).collect(),
            elapsed: vec![1.0; 200],
            inputs: DMatrix::from_fn(200, 2, |t, c| if c == 0 { channel(t) } else { (0.7 * t as f64).cos() }),
            measured: target.clone(),
            target,
            nominal: DMatrix::zeros(200, 1),
            segments: vec![0..200],
            slopes: DMatrix::zeros(200, 0),
        }
    }

    fn chosen(series: &Series, inputs: &Standardizer) -> Option<Straight> {
        let all = |see: &mut dyn FnMut(&Series)| {
            see(series);
            Ok::<(), std::convert::Infallible>(())
        };
        Straight::chosen(inputs, &[true, false], all).unwrap()
    }

    /// Oracle: the line that the data are made with, 4 + 4 (channel − 3), to the ridge and to single precision. Noise has no path.
    #[test]
    fn the_line_of_the_data_is_found() {
        let inputs = Standardizer { mean: vec![3.0, 0.0], spread: vec![0.5, 1.0] };
        let line = series(|channel, _| 4.0 + 4.0 * (channel - 3.0));
        let path = chosen(&line, &inputs).unwrap();
        let along = path.along(&inputs, &line);
        assert!((0..199).all(|t| (along[(t, 0)] - line.target[(t, 0)]).abs() < 1e-4));
        assert!((path.of(&[0.0, 9.0], 0) - 4.0).abs() < 1e-4, "a rate has no weight");
        assert_eq!(path.rows().iter().map(Vec::len).collect::<Vec<_>>(), [1, 1, 1]);
        let noise = series(|_, t| [0.3, -1.1, 0.8, 0.1, -0.6, 1.2, -0.7, 0.4, -0.2, 0.9, -1.0][t * t % 11]);
        assert_eq!(chosen(&noise, &inputs), None);
    }
}
