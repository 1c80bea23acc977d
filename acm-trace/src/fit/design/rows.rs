//! Columns and targets of the regression of one trial. Those of the nominal form are cached where states share them, and are not copied.

use std::sync::Arc;

use acm_core::record::Record;
use nalgebra::{DMatrix, DMatrixView, DMatrixViewMut};

use super::base::{base, loaded};
use super::correction::{Basis, correction};
use super::inputs::{acting, flattened, inputs, record};
use crate::fit::columns::{Key, Kind};
use crate::fit::problem::Problem;
use crate::fit::state::{Part, Placed, State};
use crate::fit::unrecorded::Unrecorded;

/// Columns and targets of one trial, N samples and M outputs.
pub struct Rows {
    /// The base, N × M, and then the columns of the correction.
    nominal: Arc<Vec<f64>>,
    additive: DMatrix<f64>,
    /// Weighted targets, N × M.
    pub y: DMatrix<f64>,
}

impl Rows {
    fn correction(&self) -> DMatrixView<'_, f64> {
        parted(&self.nominal, self.y.nrows(), self.y.ncols()).1
    }

    /// Returns the number of columns of X.
    pub fn columns(&self) -> usize {
        self.correction().ncols() + self.additive.ncols()
    }

    /// Writes X.
    pub fn copy_to(&self, mut x: DMatrixViewMut<f64>) {
        let correction = self.correction();
        x.columns_mut(0, correction.ncols()).copy_from(&correction);
        x.columns_mut(correction.ncols(), self.additive.ncols()).copy_from(&self.additive);
    }

    /// Computes y − X β.
    pub fn less(&self, beta: &DMatrix<f64>) -> DMatrix<f64> {
        let (correction, count) = (self.correction(), self.additive.ncols());
        let first = correction.ncols();
        &self.y - correction * beta.rows(0, first) - &self.additive * beta.rows(first, count)
    }
}

/// Returns a trial's columns and targets.
pub fn rows(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize) -> Rows {
    let (record, kept) = (record(problem, state, s), kept(problem, s));
    let filters = acting(state, &problem.series[s], Part::Filter);
    let unrecorded = Unrecorded::new(problem, state, s);
    let of = |(placed, group)| match filters.is_empty() {
        true => additive(problem, state, (s, &record, &kept), placed, group),
        false => additive_behind(problem, state, (s, &record, &kept), (placed, group), &filters),
    };
    let columns: Vec<Arc<Vec<f64>>> = groups(problem, state).map(of).collect();
    let nominal = match filters.is_empty() {
        true => nominal(problem, state, basis, s, &unrecorded),
        false => nominal_behind(problem, state, basis, (s, &record, &kept), (&filters, &unrecorded)),
    };
    let base = parted(&nominal, kept.len(), problem.outputs()).0.into_owned();
    let y = targets(problem, state, s, base, &unrecorded);
    Rows { nominal, additive: unrecorded.taken_out(matrix(&columns, kept.len())), y }
}

/// Returns the samples of the record that count.
pub fn kept(problem: &Problem, s: usize) -> Vec<usize> {
    problem.kept[s].iter().map(|&k| problem.series[s].rows[k]).collect()
}

/// Returns the weighted targets less a base.
pub fn targets(
    problem: &Problem,
    state: &State,
    s: usize,
    base: DMatrix<f64>,
    unrecorded: &Unrecorded,
) -> DMatrix<f64> {
    let given = loaded(problem, state, s, base);
    let mut y = problem.targets[s].clone();
    for ((mut y, given), weight) in y.column_iter_mut().zip(given.column_iter()).zip(problem.weight) {
        y.axpy(-weight, &given, 1.0);
    }
    unrecorded.taken_out(y)
}

/// Returns the base, and the columns of the correction behind it.
pub fn parted(nominal: &[f64], rows: usize, width: usize) -> (DMatrixView<'_, f64>, DMatrixView<'_, f64>) {
    let (base, x) = nominal.split_at(rows * width);
    (DMatrixView::from_slice(base, rows, width), DMatrixView::from_slice(x, rows, x.len() / rows.max(1)))
}

/// Returns the base and the columns of the correction at all samples of the record.
pub fn unfiltered(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize) -> Arc<Vec<f64>> {
    let compute = || {
        let count = record(problem, state, s).samples();
        let q = inputs(problem, state, s).concat();
        let (base, x) = (base(problem, &q, count), correction(problem, basis, &q, count));
        [base.as_slice(), x.as_slice()].concat()
    };
    let chain = acting(state, &problem.series[s], Part::Input);
    problem.columns.get(Key::together(Kind::Unfiltered, s, &chain, &form_key(state)), compute)
}

/// Returns the base and the columns of the correction at the samples that count.
fn nominal(
    problem: &Problem,
    state: &State,
    basis: Option<&Basis>,
    s: usize,
    unrecorded: &Unrecorded,
) -> Arc<Vec<f64>> {
    if let Some(known) = problem.columns.known(&nominal_key(problem, state, s, unrecorded)) {
        return known;
    }
    let rows = problem.kept[s].len();
    let chain = acting(state, &problem.series[s], Part::Input);
    let at_rows = || flattened(&inputs(problem, state, s), &kept(problem, s));
    let q = problem.columns.get(Key::together(Kind::Inputs, s, &chain, &[state.clock]), at_rows);
    let x = unrecorded.taken_out(correction(problem, basis, &q, rows));
    Arc::new([base(problem, &q, rows).as_slice(), x.as_slice()].concat())
}

/// Caches the columns of the nominal form.
pub fn nominal_kept(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize) {
    let unrecorded = Unrecorded::new(problem, state, s);
    let nominal = nominal(problem, state, basis, s, &unrecorded);
    problem.columns.put(nominal_key(problem, state, s, &unrecorded), nominal);
}

/// Returns the base and the columns of the correction behind filters, at the samples that count. A filter sees them at the full rate of the
/// record.
fn nominal_behind(
    problem: &Problem,
    state: &State,
    basis: Option<&Basis>,
    (s, record, kept): (usize, &Record, &[usize]),
    (filters, unrecorded): (&[&Placed], &Unrecorded),
) -> Arc<Vec<f64>> {
    let compute = || {
        let nominal = unfiltered(problem, state, basis, s);
        let (base, x) = parted(&nominal, record.samples(), problem.outputs());
        let (mut base, mut x) = (base.into_owned(), x.into_owned());
        filtered(filters, record, &mut base);
        filtered(filters, record, &mut x);
        [base.select_rows(kept).as_slice(), unrecorded.taken_out(x.select_rows(kept)).as_slice()].concat()
    };
    problem.columns.get(nominal_key(problem, state, s, unrecorded).behind(filters), compute)
}

fn nominal_key(problem: &Problem, state: &State, s: usize, unrecorded: &Unrecorded) -> Key {
    let chain = acting(state, &problem.series[s], Part::Input);
    let settings = [&[problem.offset_share], &form_key(state)[..], &unrecorded.key()].concat();
    Key::together(Kind::Nominal, s, &chain, &settings)
}

/// What the columns of the correction depend on besides the inputs.
fn form_key(state: &State) -> Vec<f64> {
    let degree = state.form.degree.map_or(-1.0, |degree| degree as f64);
    [&[state.clock, degree, state.form.sums.key()], &state.form.powers.key()[..], &state.form.kinks.key()[..]].concat()
}

/// Returns each group of linear parameters of the additive effects, one parameter for each output.
pub fn groups<'s>(problem: &Problem, state: &'s State) -> impl Iterator<Item = (&'s Placed, usize)> {
    let width = problem.outputs();
    let all = state.effects.iter().map(AsRef::as_ref).filter(|placed: &&Placed| placed.part() == Part::Additive);
    all.flat_map(move |placed| (0..placed.linear().len() / width).map(move |group| (placed, group)))
}

/// Returns φ of a group of linear parameters at the samples that count; zero where the effect does not act.
fn additive(
    problem: &Problem,
    state: &State,
    (s, record, kept): (usize, &Record, &[usize]),
    placed: &Placed,
    group: usize,
) -> Arc<Vec<f64>> {
    let compute = || {
        let column = unit_column(placed, record, problem.outputs(), group);
        kept.iter().map(|&row| column[row]).collect()
    };
    where_it_acts(problem, (s, placed), kept.len(), Key::group(s, placed, group, state.clock), compute)
}

/// Returns the same behind filters.
fn additive_behind(
    problem: &Problem,
    state: &State,
    (s, record, kept): (usize, &Record, &[usize]),
    (placed, group): (&Placed, usize),
    filters: &[&Placed],
) -> Arc<Vec<f64>> {
    let compute = || {
        let course = course(problem, state, (s, record), placed, group);
        let mut column = DMatrix::from_column_slice(record.samples(), 1, &course);
        filtered(filters, record, &mut column);
        kept.iter().map(|&row| column[row]).collect()
    };
    let key = Key::group(s, placed, group, state.clock).behind(filters);
    where_it_acts(problem, (s, placed), kept.len(), key, compute)
}

/// Returns φ of a group at all samples of the record.
pub fn course(
    problem: &Problem,
    state: &State,
    (s, record): (usize, &Record),
    placed: &Placed,
    group: usize,
) -> Arc<Vec<f64>> {
    let compute = || unit_column(placed, record, problem.outputs(), group);
    let key = Key::group(s, placed, group, state.clock).throughout();
    where_it_acts(problem, (s, placed), record.samples(), key, compute)
}

/// Returns a cached column where an effect acts in a trial, else zeros.
fn where_it_acts(
    problem: &Problem,
    (s, placed): (usize, &Placed),
    rows: usize,
    key: Key,
    compute: impl FnOnce() -> Vec<f64>,
) -> Arc<Vec<f64>> {
    if placed.acts_in(problem.series[s].calibrates) {
        problem.columns.get(key, compute)
    } else {
        Arc::new(vec![0.0; rows])
    }
}

/// Returns the columns as a matrix.
pub fn matrix(columns: &[Arc<Vec<f64>>], rows: usize) -> DMatrix<f64> {
    let mut x = DMatrix::zeros(rows, columns.len());
    x.column_iter_mut().zip(columns).for_each(|(mut to, from)| to.copy_from_slice(from));
    x
}

/// Returns the effect of the first parameter of a group on the first output at the value 1. Groups have one parameter
/// for each output, and all act in the same way.
fn unit_column(placed: &Placed, record: &Record, width: usize, group: usize) -> Vec<f64> {
    let linear = placed.linear();
    let mut theta = placed.theta.clone();
    linear.iter().for_each(|&l| theta[l] = 0.0);
    theta[linear[group * width]] = 1.0;
    let mut columns = vec![vec![0.0; record.samples()]; width];
    placed.instance.act(&theta, record, &mut columns);
    columns.swap_remove(0)
}

/// Passes all columns through the filters, in the order of action.
pub fn filtered(filters: &[&Placed], record: &Record, x: &mut DMatrix<f64>) {
    let mut columns: Vec<Vec<f64>> = x.as_slice().chunks(x.nrows().max(1)).map(<[f64]>::to_vec).collect();
    filters.iter().for_each(|placed| placed.instance.act(&placed.theta, record, &mut columns));
    x.column_iter_mut().zip(&columns).for_each(|(mut to, from)| to.copy_from_slice(from));
}
