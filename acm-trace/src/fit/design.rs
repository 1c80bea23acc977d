//! The regression of a state at the N samples that are compared.
//!
//! ```text
//! w_m (y_m − b_m) = Σ_j X_j β_jm + Σ_k Z_km α_k + e_m
//! ```
//!
//! | symbol | meaning                                                                      | shape |
//! | `b`    | base at the inputs as the effects left them, with its loads, frame and output | N × M |
//! | `X`    | columns that every output has a coefficient of: the correction's monomials, kinks and sums of angles, linear parameters | N × p |
//! | `Z`    | columns that all outputs share one coefficient of                            | c of N × M |
//! | `w`    | weight of an output                                                          | M     |

use std::borrow::Cow;
use std::sync::Arc;

use acm_core::actuation::Monomials;
use acm_core::augmented;
use acm_core::clock_corrected;
use acm_core::effects::Site;
use acm_core::record::Record;
use nalgebra::DMatrix;
use rayon::prelude::*;

mod about;
mod left;

use super::columns::{Key, Kind};
use super::form::BEYOND;
use super::form::angles::sums;
use super::problem::Problem;
use super::state::{Part, Placed, State};
use super::unrecorded::Unrecorded;
use crate::series::Series;

pub use super::moved::{carried, moved, tangents};
pub use super::state::modes;
pub use left::left;

/// Matrices of a regression.
#[derive(Debug, Clone)]
pub struct Design {
    /// Columns X.
    pub x: DMatrix<f64>,
    /// Columns Z of each output.
    pub coupled: Vec<DMatrix<f64>>,
    /// Weighted targets, N × M.
    pub y: DMatrix<f64>,
    /// Ones for the columns of X that the ridge shrinks, else zeros.
    pub shrunk: Vec<f64>,
    /// Number of columns of X that belong to the correction.
    pub correction: usize,
}

/// Functions of the actuators that the correction is a sum of.
struct Basis {
    monomials: Monomials,
    /// Actuator and place of each kink, the place in half ranges from the middle.
    kinks: Vec<(usize, f64)>,
    /// Multiples of each actuator in a sum of angles.
    sums: Vec<Vec<i8>>,
}

impl Basis {
    fn of(problem: &Problem, state: &State) -> Option<Self> {
        let actuators = problem.rig.actuators.len();
        let kinks = (0..actuators).flat_map(|a| state.form.kinks.places().map(move |place| (a, place))).collect();
        let sums = sums(problem.rig, state.form.sums);
        state.form.monomials(actuators).map(|monomials| Self { monomials, kinks, sums })
    }

    /// Returns the number of columns, with the constant.
    fn len(&self) -> usize {
        1 + self.monomials.len() + self.kinks.len() + 2 * self.sums.len()
    }
}

/// Columns and targets of one trial.
struct Rows {
    x: DMatrix<f64>,
    y: DMatrix<f64>,
}

/// Returns the regression of a state.
pub fn design(problem: &Problem, state: &State) -> Design {
    let basis = Basis::of(problem, state);
    let correction = basis.as_ref().map_or(0, Basis::len);
    let of = |s: usize| rows(problem, state, basis.as_ref(), s, None);
    let parts: Vec<Rows> = (0..problem.series.len()).into_par_iter().map(of).collect();
    let (x, y) = below(&parts);
    let mut shrunk = vec![1.0; x.ncols()];
    if correction > 0 {
        shrunk[0] = 0.0;
    }
    Design { x, coupled: vec![], y, shrunk, correction }
}

fn below(parts: &[Rows]) -> (DMatrix<f64>, DMatrix<f64>) {
    let rows = parts.iter().map(|part| part.x.nrows()).sum();
    let (p, r) = parts.first().map_or((0, 0), |part| (part.x.ncols(), part.y.ncols()));
    let (mut x, mut y, mut first) = (DMatrix::zeros(rows, p), DMatrix::zeros(rows, r), 0);
    for part in parts {
        x.rows_mut(first, part.x.nrows()).copy_from(&part.x);
        y.rows_mut(first, part.y.nrows()).copy_from(&part.y);
        first += part.x.nrows();
    }
    (x, y)
}

/// Returns a trial's record with the clock of its actuators corrected.
pub fn record<'r>(problem: &'r Problem, state: &State, s: usize) -> Cow<'r, Record> {
    let record = &problem.series[s].record;
    if state.clock == 0.0 { Cow::Borrowed(record) } else { Cow::Owned(clock_corrected(record, state.clock)) }
}

/// Returns the effects of a kind that act in a trial.
fn acting<'s>(state: &'s State, series: &Series, part: Part) -> Vec<&'s Placed> {
    let acts = |placed: &&Placed| placed.acts_in(series.calibrates) && placed.part() == part;
    state.effects.iter().map(AsRef::as_ref).filter(acts).collect()
}

/// Returns the actuators as the input effects leave them, all T samples.
pub fn inputs(problem: &Problem, state: &State, s: usize) -> Vec<Vec<f64>> {
    let record = record(problem, state, s);
    let chain = acting(state, &problem.series[s], Part::Input);
    let known = |done: usize| {
        let key = Key::together(Kind::Courses, s, &chain[..done], &[state.clock]);
        problem.columns.known(&key).map(|flat| (done, flat))
    };
    let (done, mut q) = match (1..=chain.len()).rev().find_map(known) {
        Some((done, flat)) => (done, flat.chunks(record.samples()).map(<[f64]>::to_vec).collect()),
        None => (0, record.actuators.clone()),
    };
    chain[done..].iter().for_each(|placed| placed.instance.act(&placed.theta, &record, &mut q));
    q
}

/// Caches what states that begin as this one share with it: the actuators after the first input effects, and the
/// columns of the nominal form.
pub fn keep(problem: &Problem, state: &State) {
    keep_inputs(problem, state);
    let basis = Basis::of(problem, state);
    (0..problem.series.len()).into_par_iter().for_each(|s| {
        let unrecorded = Unrecorded::new(problem, state, s);
        let (x, base) = nominal(problem, state, basis.as_ref(), s, &unrecorded);
        let both = [base.as_slice(), x.as_slice()].concat();
        problem.columns.put(nominal_key(problem, state, s, &unrecorded), both);
    });
}

/// Caches the actuators after each of the first input effects.
pub fn keep_inputs(problem: &Problem, state: &State) {
    (0..problem.series.len()).into_par_iter().for_each(|s| {
        let record = record(problem, state, s);
        let chain = acting(state, &problem.series[s], Part::Input);
        let mut q = record.actuators.clone();
        for (done, placed) in chain.iter().enumerate() {
            placed.instance.act(&placed.theta, &record, &mut q);
            problem.columns.put(Key::together(Kind::Courses, s, &chain[..=done], &[state.clock]), q.concat());
        }
    });
}

/// Returns each actuator at some rows, one after the other.
fn flattened(q: &[Vec<f64>], rows: &[usize]) -> Vec<f64> {
    q.iter().flat_map(|q| rows.iter().map(move |&row| q[row])).collect()
}

/// Returns a trial's columns and targets; with coefficients β the sum of the columns, X β, in the place of X.
fn rows(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize, beta: Option<&DMatrix<f64>>) -> Rows {
    let series = &problem.series[s];
    let record = record(problem, state, s);
    let filters = acting(state, series, Part::Filter);
    let kept: Vec<usize> = problem.kept[s].iter().map(|&k| series.rows[k]).collect();
    let unrecorded = Unrecorded::new(problem, state, s);
    let summed = |x: DMatrix<f64>| match beta {
        Some(beta) => x * beta,
        None => x,
    };
    let (x, base) = if filters.is_empty() {
        let (x, base) = nominal(problem, state, basis, s, &unrecorded);
        let additive = unrecorded.taken_out(matrix(&additive(problem, state, s, &record, &kept, true), kept.len()));
        (summed(joined(x, &additive)), base)
    } else {
        // A filter sees the columns at the full rate of the record; of their sum it makes the sum of the filtered.
        let rows: Vec<usize> = (0..record.samples()).collect();
        let (x, mut base) = unfiltered(problem, state, basis, s);
        let additive = matrix(&additive(problem, state, s, &record, &rows, false), rows.len());
        let mut x = summed(joined(x, &additive));
        filtered(&filters, &record, &mut x);
        filtered(&filters, &record, &mut base);
        (unrecorded.taken_out(x.select_rows(&kept)), base.select_rows(&kept))
    };
    let given = loaded(problem, state, s, base);
    let mut y = problem.targets[s].clone();
    for ((mut y, given), weight) in y.column_iter_mut().zip(given.column_iter()).zip(problem.weight) {
        y.axpy(-weight, &given, 1.0);
    }
    Rows { x, y: unrecorded.taken_out(y) }
}

/// Returns the correction's columns, and the base, at all samples of the record.
fn unfiltered(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (count, width) = (record(problem, state, s).samples(), problem.outputs());
    let compute = || {
        let q = inputs(problem, state, s).concat();
        let (base, x) = (base(problem, &q, count), correction(problem, basis, &q, count));
        [base.as_slice(), x.as_slice()].concat()
    };
    let chain = acting(state, &problem.series[s], Part::Input);
    let known = problem.columns.get(Key::together(Kind::Unfiltered, s, &chain, &form_key(state)), compute);
    parted(&known, count, width)
}

/// Returns the columns of the correction, and the base before them.
fn parted(known: &[f64], rows: usize, width: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (base, x) = known.split_at(rows * width);
    (DMatrix::from_column_slice(rows, x.len() / rows.max(1), x), DMatrix::from_column_slice(rows, width, base))
}

/// Returns the correction's columns, and the base, at the samples that count.
fn nominal(
    problem: &Problem,
    state: &State,
    basis: Option<&Basis>,
    s: usize,
    unrecorded: &Unrecorded,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let (rows, width) = (problem.kept[s].len(), problem.outputs());
    if let Some(known) = problem.columns.known(&nominal_key(problem, state, s, unrecorded)) {
        return parted(&known, rows, width);
    }
    let kept: Vec<usize> = problem.kept[s].iter().map(|&k| problem.series[s].rows[k]).collect();
    let chain = acting(state, &problem.series[s], Part::Input);
    let at_rows = || flattened(&inputs(problem, state, s), &kept);
    let q = problem.columns.get(Key::together(Kind::Inputs, s, &chain, &[state.clock]), at_rows);
    (unrecorded.taken_out(correction(problem, basis, &q, rows)), base(problem, &q, rows))
}

fn nominal_key(problem: &Problem, state: &State, s: usize, unrecorded: &Unrecorded) -> Key {
    let chain = acting(state, &problem.series[s], Part::Input);
    let settings = [&[problem.offset_share], &form_key(state)[..], &unrecorded.key()].concat();
    Key::together(Kind::Nominal, s, &chain, &settings)
}

/// What the columns of the correction depend on beside the inputs.
fn form_key(state: &State) -> Vec<f64> {
    let degree = state.form.degree.map_or(-1.0, |degree| degree as f64);
    [&[state.clock, degree, state.form.sums.key()], &state.form.powers.key()[..], &state.form.kinks.key()[..]].concat()
}

/// Returns the columns beside one another.
fn matrix(columns: &[Arc<Vec<f64>>], rows: usize) -> DMatrix<f64> {
    let mut x = DMatrix::zeros(rows, columns.len());
    x.column_iter_mut().zip(columns).for_each(|(mut to, from)| to.copy_from_slice(from));
    x
}

/// Joins two matrices side by side.
fn joined(x: DMatrix<f64>, more: &DMatrix<f64>) -> DMatrix<f64> {
    let first = x.ncols();
    if more.ncols() == 0 {
        return x;
    }
    let mut x = x.resize_horizontally(first + more.ncols(), 0.0);
    x.columns_mut(first, more.ncols()).copy_from(more);
    x
}

/// Returns the monomials and kinks of the normalised inputs, and the cosine and the sine of each sum of angles.
fn correction(problem: &Problem, basis: Option<&Basis>, q: &[f64], rows: usize) -> DMatrix<f64> {
    let Some(Basis { monomials, kinks, sums }) = basis else { return DMatrix::zeros(rows, 0) };
    let mut z = DMatrix::from_column_slice(rows, problem.range.len(), q);
    let turned = turned(&z, sums);
    for (mut z, (middle, half)) in z.column_iter_mut().zip(&problem.range) {
        z.apply(|z| *z = (*z - middle) / half);
    }
    if problem.base.is_some() {
        z.apply(|z| *z = z.clamp(-1.0, 1.0));
    }
    let bent: DMatrix<f64> = match kinks.len() {
        0 => DMatrix::zeros(rows, 0),
        count => DMatrix::from_fn(rows, count, |row, k| (z[(row, kinks[k].0)] - kinks[k].1).max(0.0)),
    };
    if problem.base.is_some() {
        return joined(joined(monomials.design(&z), &bent), &turned);
    }
    let straight = z.columns(0, monomials.len().min(z.ncols())).into_owned();
    z.apply(|z| *z = z.clamp(-BEYOND, BEYOND));
    let mut x = monomials.design(&z);
    x.columns_mut(1, straight.ncols()).copy_from(&straight);
    joined(joined(x, &bent), &turned)
}

/// Returns the cosine and the sine of each sum of the angles q.
fn turned(q: &DMatrix<f64>, sums: &[Vec<i8>]) -> DMatrix<f64> {
    let mut x = DMatrix::zeros(q.nrows(), 2 * sums.len());
    for (h, sum) in sums.iter().enumerate() {
        for row in 0..q.nrows() {
            let angle: f64 = sum.iter().zip(q.row(row).iter()).map(|(n, q)| f64::from(*n) * q).sum();
            (x[(row, 2 * h + 1)], x[(row, 2 * h)]) = angle.sin_cos();
        }
    }
    x
}

/// Returns g at the inputs as the effects left them; zero without a base.
fn base(problem: &Problem, q: &[f64], rows: usize) -> DMatrix<f64> {
    match problem.base {
        Some(base) => base.stands_for.predict(&DMatrix::from_column_slice(rows, problem.range.len(), q)),
        None => DMatrix::zeros(rows, problem.outputs()),
    }
}

/// Adds loads on the arm, and then all other effects that act after it, at the samples that count, without what is
/// added to every prediction.
fn loaded(problem: &Problem, state: &State, s: usize, mut given: DMatrix<f64>) -> DMatrix<f64> {
    let series = &problem.series[s];
    let others = acting(state, series, Part::Other);
    if others.is_empty() {
        return given;
    }
    let width = problem.outputs();
    let (later, loads): (Vec<&Placed>, Vec<&Placed>) =
        others.into_iter().partition(|placed| matches!(placed.instance.site(), Site::Frame | Site::Output));
    if !loads.is_empty() && !problem.fields[s].is_empty() {
        let moved = problem.columns.get(Key::together(Kind::Loads, s, &loads, &[]), || displaced(problem, s, &loads));
        given.iter_mut().zip(moved.iter()).for_each(|(given, moved)| *given += moved);
    }
    if later.is_empty() {
        return given;
    }
    let mut columns = vec![vec![0.0; series.samples()]; width];
    let each = || problem.kept[s].iter().enumerate().flat_map(|(k, &n)| (0..width).map(move |o| (k, n, o)));
    let offset = |n: usize, o: usize| problem.offset[s][n * width + o];
    each().for_each(|(k, n, o)| columns[o][n] = given[(k, o)] + offset(n, o));
    later.iter().for_each(|placed| placed.instance.act(&placed.theta, &series.thin, &mut columns));
    each().for_each(|(k, n, o)| given[(k, o)] = columns[o][n] - offset(n, o));
    given
}

/// Returns the displacement of the outputs by loads on the arm at the compared samples, column by column.
fn displaced(problem: &Problem, s: usize, loads: &[&Placed]) -> Vec<f64> {
    let (series, width) = (&problem.series[s], problem.outputs());
    let mut y = vec![0.0; series.samples() * width];
    let (instances, theta): (Vec<_>, Vec<&[f64]>) =
        loads.iter().map(|placed| (placed.instance.clone(), placed.theta.as_slice())).unzip();
    if let Some(loads) = augmented::loads(&instances, &theta, &series.record) {
        let thin: Vec<Vec<f64>> = loads.iter().map(|column| series.rows.iter().map(|&t| column[t]).collect()).collect();
        augmented::displace(&thin, &problem.fields[s], &mut y);
    }
    (0..width).flat_map(|o| problem.kept[s].iter().map(move |&n| (n, o))).map(|(n, o)| y[n * width + o]).collect()
}

/// Returns φ of each group of linear parameters, one parameter for each output, at some rows; zero where the effect
/// does not act.
fn additive(
    problem: &Problem,
    state: &State,
    s: usize,
    record: &Record,
    rows: &[usize],
    is_kept: bool,
) -> Vec<Arc<Vec<f64>>> {
    let width = problem.outputs();
    let of = |placed: &Placed, group: usize| {
        let compute = || {
            let column = unit_column(placed, record, width, group);
            rows.iter().map(|&row| column[row]).collect::<Vec<f64>>()
        };
        match (placed.acts_in(problem.series[s].calibrates), is_kept) {
            (false, _) => Arc::new(vec![0.0; rows.len()]),
            (true, true) => problem.columns.get(Key::group(s, placed, group, state.clock), compute),
            (true, false) => Arc::new(compute()),
        }
    };
    let all = state.effects.iter().filter(|placed| placed.part() == Part::Additive);
    all.flat_map(|placed| (0..placed.linear().len() / width).map(|group| of(placed, group)).collect::<Vec<_>>())
        .collect()
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
fn filtered(filters: &[&Placed], record: &Record, x: &mut DMatrix<f64>) {
    let mut columns: Vec<Vec<f64>> = x.as_slice().chunks(x.nrows().max(1)).map(<[f64]>::to_vec).collect();
    filters.iter().for_each(|placed| placed.instance.act(&placed.theta, record, &mut columns));
    x.column_iter_mut().zip(&columns).for_each(|(mut to, from)| to.copy_from_slice(from));
}
