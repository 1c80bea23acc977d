//! Residual against the swept actuator, slice by slice: mean and spread of each component in bins.
//!
//! The bins are the same for all slices, so that their curves can be compared; a bin with few samples is not shown.

use acm_datasets::Trial;
use nalgebra::DMatrix;

use super::{
    described::Described,
    record::{ResidualStudy, Slice, SliceBin},
};
use crate::run::evaluation::spread::Spread;
use crate::schedule::descriptive::bins::Bins;
use crate::schedule::descriptive::rms::{Rms, stacked};
use crate::schedule::descriptive::sweep;

/// Returns the slices of the trials described; one with all of them, and a note, where no actuator is held.
pub fn slices(described: &[Described], record: &ResidualStudy, notes: &mut Vec<String>) -> Vec<Slice> {
    let trials: Vec<&Trial> = described.iter().map(|d| d.trial).collect();
    let (swept, asked) = (record.swept, &record.asked);
    let found = sweep::slices(&trials, swept, asked.slice_tolerance).unwrap_or_else(|| {
        if record.actuators.len() > 1 {
            let name = &record.actuators[swept].name;
            notes.push(format!("More actuators than {name} move within trials, so there are no slices."));
        }
        vec![sweep::whole(&trials, swept)]
    });
    let all = trials.iter().flat_map(|trial| trial.actuators.column(swept).iter().copied().collect::<Vec<_>>());
    let edges = Bins::over(all, asked.bins);
    let slice = |slice: sweep::Slice| {
        let own = || slice.trials.iter().map(|&place| &described[place]);
        let q: Vec<f64> =
            own().flat_map(|d| d.trial.actuators.column(swept).iter().copied().collect::<Vec<_>>()).collect();
        let residual = stacked(own().map(|d| &d.residual));
        Slice {
            trials: own().map(|d| d.trial.name.clone()).collect(),
            rms: Rms::of(&residual),
            bins: binned(&q, &residual, &edges, asked.least_in_bin),
            actuators: slice.actuators,
        }
    };
    found.into_iter().map(slice).collect()
}

/// Returns the mean and spread of the rows of `residual` [T×O] in bins of `q` [T].
fn binned(q: &[f64], residual: &DMatrix<f64>, edges: &Bins, least: usize) -> Vec<SliceBin> {
    let mut members = vec![vec![]; edges.range().len()];
    q.iter().enumerate().for_each(|(t, &q)| members[edges.of(q)].push(t));
    members.retain(|bin| bin.len() >= least);
    let one = |rows: &Vec<usize>| {
        let spread = |values: Vec<f64>| Spread::of(&values).map_or((0.0, 0.0), |s| (s.mean, s.sd.unwrap_or(0.0)));
        let component = |o: usize| spread(rows.iter().map(|&t| residual[(t, o)]).collect());
        let (mean, sd) = (0..residual.ncols()).map(component).unzip();
        SliceBin { q: spread(rows.iter().map(|&t| q[t]).collect()).0, samples: rows.len(), mean, sd }
    };
    members.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; bins [0, 1) and [1, 2] of five samples, of which the second needs one more.
    #[test]
    fn five_samples_by_hand() {
        let q = [0.0, 0.2, 0.7, 1.0, 2.0];
        let residual = DMatrix::from_row_slice(5, 2, &[1.0, 0.0, 2.0, 0.0, 6.0, 3.0, 9.0, 9.0, 9.0, 9.0]);
        let bins = binned(&q, &residual, &Bins::over(q.into_iter(), 2), 3);
        assert_eq!(bins.len(), 1);
        assert!((bins[0].q - 0.3).abs() < 1e-15);
        assert_eq!((bins[0].samples, bins[0].mean.clone()), (3, vec![3.0, 1.0]));
        assert!((bins[0].sd[0] - 7.0_f64.sqrt()).abs() < 1e-15 && (bins[0].sd[1] - 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
