//! A trained network beside Python: sample by sample, or a trial at once.

use std::path::{Path, PathBuf};

use acm_datasets::{Domain, files::regular};
use acm_eval::{
    error::EvalError,
    stream::{
        best::{self, SavedBest},
        robot::Robot,
        sampler::{RowError, Sampler},
        saved::{Request, Saved, load},
        wiring::{Clock, Column, Wiring},
    },
};
use acm_stream::{Average, AverageParts, Parts, StepError};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use polars_arrow::array::{Array, PrimitiveArray};
use pyo3::{exceptions::PyUserWarning, prelude::*};

use crate::{
    arrow::{self, Taken},
    errors::{DataError, of_eval, usage},
    frame::Frame,
    names,
    values::Values,
    waiting::{Interrupted, wait},
};

/// A nominal model, with a network or without one, under way through a trial. Inputs and answers are in the units of the manifest; of a
/// file that ``acm-eval stream --save`` wrote they are in SI units.
#[pyclass(module = "acm")]
pub struct Estimator {
    sampler: Sampler,
    /// Inputs of the sample at hand, and its answer.
    inputs: Vec<f64>,
    answer: Vec<f64>,
    title: String,
}

impl Estimator {
    /// Of parts, which know no domain.
    ///
    /// # Errors
    /// Parts that do not fit.
    pub fn of_parts(parts: Parts, wiring: Wiring) -> Result<Self, String> {
        let one = acm_stream::Estimator::new(parts).map_err(|error| error.to_string())?;
        Ok(Self::new(Robot::One(Box::new(one)), wiring, None, "model".into()))
    }

    fn new(robot: Robot, wiring: Wiring, domain: Option<Domain>, title: String) -> Self {
        let (inputs, answer) = (vec![0.0; wiring.inputs.len()], vec![0.0; wiring.outputs.len()]);
        Self { sampler: Sampler::new(robot, wiring, domain), inputs, answer, title }
    }

    /// Of a run folder, or the folder of a study of the best model.
    ///
    /// # Errors
    /// As `acm-eval stream`.
    pub fn of_run(
        py: Python<'_>,
        run: PathBuf,
        network: Option<String>,
        windows: bool,
        everywhere: bool,
        tables: Option<PathBuf>,
    ) -> PyResult<Self> {
        let read = move |_: &_| {
            let request = Request { run: &run, id: network.as_deref(), data: tables.as_deref(), windows };
            of_folder(&request, everywhere)
        };
        let (estimator, doubt) = wait(py, None, Interrupted::Leaves, read)?.map_err(of_eval)?;
        if let Some(doubt) = doubt {
            let text = std::ffi::CString::new(doubt).unwrap_or_default();
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
        }
        Ok(estimator)
    }

    fn fault(&self, error: StepError) -> String {
        match error {
            StepError::NotFinite { index, value } => {
                let name = &self.sampler.wiring().inputs[index].name;
                format!("input `{name}` is {value}; leave the sample out, and add its time to that of the next")
            }
            error => error.to_string(),
        }
    }

    fn row_fault(&self, RowError { row, error }: RowError) -> PyErr {
        DataError::new_err(format!("row {row}: {}", self.fault(error)))
    }

    fn refuse_without_time(&self, time: bool) -> PyResult<()> {
        match self.sampler.wiring().time() {
            Some(column) if !time => {
                let Column { name, unit, .. } = column;
                Err(usage(format!("give the times of the rows: time=, as `{name}` in {}", unit.name)))
            }
            _ => Ok(()),
        }
    }
}

/// What a folder holds, and the doubt of its folds.
fn of_folder(request: &Request, everywhere: bool) -> Result<(Estimator, Option<String>), EvalError> {
    let unfit = |error: String| EvalError::Data(format!("{}: {error}", request.run.display()));
    let kept = |domain| (!everywhere).then_some(domain);
    if best::is_one(request.run) {
        let SavedBest { parts, wiring, domain, id, title, .. } = best::load(request)?;
        let mean = Average::new(parts).map_err(|error| unfit(error.to_string()))?;
        return Ok((Estimator::new(Robot::Mean(mean), wiring, kept(domain), format!("{title}: {id}")), None));
    }
    let Saved { parts, wiring, domain, id, title, doubt } = load(request)?;
    let one = acm_stream::Estimator::new(parts).map_err(|error| unfit(error.to_string()))?;
    Ok((Estimator::new(Robot::One(Box::new(one)), wiring, kept(domain), format!("{title}: {id}")), doubt))
}

/// Loads a file that `acm-eval stream --save` wrote: its own names, SI units, no domain.
fn of_file(file: &Path) -> PyResult<Estimator> {
    let bytes = regular::read(file).map_err(|error| of_eval(EvalError::read(file, error)))?;
    let unfit = |error: String| DataError::new_err(format!("{}: {error}", file.display()));
    let title = file.display().to_string();
    if let Ok(parts) = AverageParts::from_json(&bytes) {
        let wiring = Wiring::in_si(&parts.inputs, parts.members.first().map_or(0, |member| member.parts.tip.len()));
        let mean = Average::new(parts).map_err(|error| unfit(error.to_string()))?;
        return Ok(Estimator::new(Robot::Mean(mean), wiring.map_err(of_eval)?, None, title));
    }
    let parts = Parts::from_json(&bytes).map_err(|error| unfit(error.to_string()))?;
    let signals = &parts.signals;
    let mut inputs: Vec<String> = signals.actuators.iter().chain(&signals.contexts).cloned().collect();
    inputs.extend((inputs.len()..parts.width()).map(|at| format!("input_{at}")));
    let wiring = Wiring::in_si(&inputs, parts.tip.len()).map_err(of_eval)?;
    let one = acm_stream::Estimator::new(parts).map_err(|error| unfit(error.to_string()))?;
    Ok(Estimator::new(Robot::One(Box::new(one)), wiring, None, title))
}

#[pymethods]
impl Estimator {
    /// Loads a network of a run folder, of a study of the best model, or of a file that ``acm-eval stream --save`` wrote.
    ///
    /// ``network`` names one of the run's; left out, it is the final one with the smallest validation loss. ``windows`` gives it a window
    /// of samples for each answer, as it was scored. ``everywhere`` asks it outside of the calibrated domain, too. ``tables`` is the folder
    /// of the tables of the run's data, where they do not lie beside the manifest.
    #[staticmethod]
    #[pyo3(signature = (run, *, network=None, windows=false, everywhere=false, tables=None))]
    fn load(
        py: Python<'_>,
        run: PathBuf,
        network: Option<String>,
        windows: bool,
        everywhere: bool,
        tables: Option<PathBuf>,
    ) -> PyResult<Self> {
        if run.is_file() { of_file(&run) } else { Self::of_run(py, run, network, windows, everywhere, tables) }
    }

    /// Names of the inputs of a sample, in order.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        self.sampler.wiring().inputs.iter().map(|column| column.name.clone()).collect()
    }

    /// Names of the outputs, in order.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.sampler.wiring().outputs.iter().map(|column| column.name.clone()).collect()
    }

    /// Units by name, of inputs, outputs and time.
    #[getter]
    fn units(&self) -> std::collections::BTreeMap<String, &'static str> {
        let wiring = self.sampler.wiring();
        let columns = wiring.inputs.iter().chain(&wiring.outputs).chain(wiring.time());
        columns.map(|column| (column.name.clone(), column.unit.name)).collect()
    }

    /// The outputs ``[O]`` at the next sample: ``x`` holds the inputs ``[I]`` in order, ``dt`` is the time since the sample before in s, of
    /// which the first sample takes no notice.
    #[pyo3(signature = (x, dt=0.0))]
    fn step<'py>(&mut self, x: &Bound<'py, PyAny>, dt: f64) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = match x.cast::<PyArray1<f64>>() {
            Ok(array) => {
                let (array, count) = (array.try_readonly()?, array.len());
                self.inputs.iter_mut().zip(array.as_array()).for_each(|(input, value)| *input = *value);
                count
            }
            Err(_) => {
                let values: Vec<f64> = x.extract()?;
                self.inputs.iter_mut().zip(&values).for_each(|(input, value)| *input = *value);
                values.len()
            }
        };
        let needed = self.inputs.len();
        let taken = match count == needed {
            true => self.sampler.step(&self.inputs, dt),
            false => Err(StepError::Count { found: count, needed }),
        };
        taken.map_err(|error| DataError::new_err(self.fault(error)))?;
        self.answer.iter_mut().zip(self.sampler.outputs()).for_each(|(answer, value)| *answer = value);
        Ok(PyArray1::from_slice(x.py(), &self.answer))
    }

    /// The outputs of a whole trial from its start.
    ///
    /// Of an array ``[T, I]`` with the inputs in order, and ``time`` ``[T]`` in the unit of its column, an array ``[T, O]``. Of a frame with columns
    /// by name, time among them, a :class:`Frame` with what ``acm-eval stream`` answers; where ``trial`` names a column, each change of the
    /// name begins a trial.
    #[pyo3(signature = (x, time=None, *, trial=None))]
    fn predict<'py>(
        &mut self,
        x: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        trial: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = x.py();
        if arrow::is_frame(x) {
            let answers = self.of_frame(py, &arrow::take(x)?, trial)?;
            return Ok(Bound::new(py, answers)?.into_any());
        }
        if trial.is_some() {
            return Err(usage("trial= names a column of a frame, and this is an array"));
        }
        let array = array2(x)?;
        let time = time.map(array1).transpose()?;
        self.refuse_without_time(time.is_some())?;
        let [rows, columns] = [array.shape()[0], array.shape()[1]];
        if let Some(time) = &time
            && time.len() != rows
        {
            return Err(usage(format!("there are {} times and {rows} rows", time.len())));
        }
        if columns != self.inputs.len() {
            let error = StepError::Count { found: columns, needed: self.inputs.len() };
            return Err(DataError::new_err(format!("{error}: {}", self.inputs().join(", "))));
        }
        let width = self.answer.len();
        let answers = PyArray2::<f64>::zeros(py, [rows, width], false);
        {
            let (array, time) = (array.try_readonly()?, time.map(|time| time.try_readonly()).transpose()?);
            let (array, time) = (array.as_array(), time.as_ref().map(numpy::PyReadonlyArray1::as_array));
            let mut out = answers.try_readwrite()?;
            let out = out.as_slice_mut().map_err(|error| usage(error.to_string()))?;
            let sampler = &mut self.sampler;
            let done = py.detach(|| {
                let at = |k: usize| time.map_or(0.0, |time| time[k]);
                let row = |k: usize, inputs: &mut [f64]| {
                    inputs.iter_mut().zip(array.row(k)).for_each(|(input, value)| *input = *value);
                };
                sampler.trial(rows, at, row, |k, sampler| {
                    let row = &mut out[k * width..(k + 1) * width];
                    row.iter_mut().zip(sampler.outputs()).for_each(|(answer, value)| *answer = value);
                })
            });
            done.map_err(|error| self.row_fault(error))?;
        }
        Ok(answers.into_any())
    }

    /// What the nominal model alone said of the last sample, ``[O]``.
    #[getter]
    fn nominal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.sampler.nominal().collect())
    }

    /// Whether every channel of the last sample lay in its range of training; none where that is not known.
    #[getter]
    fn in_range(&self) -> Option<bool> {
        self.sampler.in_range()
    }

    /// Samples behind the last answer; 0 where the nominal model answered alone.
    #[getter]
    fn history(&self) -> u64 {
        self.sampler.history()
    }

    /// Ends of the interval about each output of the last sample, ``(low, high)``; none without an interval.
    #[getter]
    fn interval(&self) -> Option<Vec<(f64, f64)>> {
        (0..self.answer.len()).map(|o| self.sampler.ends(o).map(|[low, high]| (low, high))).collect()
    }

    /// Forgets the trial, so that another can begin.
    fn restart(&mut self) {
        self.sampler.restart();
    }

    fn __repr__(&self) -> String {
        let named = |columns: &[Column]| {
            columns
                .iter()
                .map(|column| format!("{} [{}]", column.name, column.unit.name))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let wiring = self.sampler.wiring();
        format!("{}: {} → {}", self.title.trim_start_matches(": "), named(&wiring.inputs), named(&wiring.outputs))
    }
}

impl Estimator {
    /// Answers a frame: time, outputs, nominal outputs, history, in_range (1 or 0), ends of intervals.
    fn of_frame(&mut self, py: Python<'_>, frame: &Taken, trial: Option<&str>) -> PyResult<Frame> {
        let wiring = self.sampler.wiring();
        let time_name = wiring.time().map(|column| column.name.clone());
        let time = time_name.as_ref().map(|name| numbers(frame, name)).transpose()?;
        let inputs = wiring.inputs.iter().map(|column| numbers(frame, &column.name)).collect::<PyResult<Vec<_>>>()?;
        let outputs = self.outputs();
        let rows: usize = frame.batches.iter().map(acm_datasets::files::table::Batch::height).sum();
        let starts = trial.map_or(Ok(vec![0]), |trial| {
            names::starts(frame, trial).ok_or_else(|| usage(format!("column `{trial}` has no names of trials")))
        })?;
        let rate = matches!(wiring.clock, Clock::Rate(_));
        let mut answers = Answers::new(outputs.len(), self.sampler.interval().is_some(), rows);
        let sampler = &mut self.sampler;
        let done = py.detach(|| {
            for (at, &start) in starts.iter().enumerate() {
                let end = starts.get(at + 1).copied().unwrap_or(rows);
                let when = |k: usize| time.as_ref().map_or(0.0, |time| time[start + k]);
                let row = |k: usize, into: &mut [f64]| {
                    into.iter_mut().zip(&inputs).for_each(|(input, column)| *input = column[start + k]);
                };
                let answered = |_: usize, sampler: &Sampler| answers.push(sampler);
                let trial = sampler.trial(end - start, when, row, answered);
                trial.map_err(|error| RowError { row: start + error.row, ..error })?;
            }
            Ok(())
        });
        done.map_err(|error| self.row_fault(error))?;
        let first = if rate { None } else { time_name.zip(time) };
        Ok(answers.frame(first, &outputs))
    }
}

/// Answers column by column.
struct Answers {
    outputs: Vec<Vec<f64>>,
    nominal: Vec<Vec<f64>>,
    history: Vec<f64>,
    in_range: Vec<Option<f64>>,
    ends: Option<Vec<[Vec<Option<f64>>; 2]>>,
}

impl Answers {
    fn new(outputs: usize, interval: bool, rows: usize) -> Self {
        let columns = || vec![Vec::with_capacity(rows); outputs];
        let ends = interval.then(|| vec![[vec![], vec![]]; outputs]);
        Self { outputs: columns(), nominal: columns(), history: vec![], in_range: vec![], ends }
    }

    fn push(&mut self, sampler: &Sampler) {
        self.outputs.iter_mut().zip(sampler.outputs()).for_each(|(column, value)| column.push(value));
        self.nominal.iter_mut().zip(sampler.nominal()).for_each(|(column, value)| column.push(value));
        self.history.push(sampler.history() as f64);
        self.in_range.push(sampler.in_range().map(|inside| f64::from(u8::from(inside))));
        for (o, [low, high]) in self.ends.iter_mut().flatten().enumerate() {
            let ends = sampler.ends(o);
            low.push(ends.map(|ends| ends[0]));
            high.push(ends.map(|ends| ends[1]));
        }
    }

    fn frame(self, time: Option<(String, Vec<f64>)>, names: &[String]) -> Frame {
        let mut columns: Vec<(String, Values)> = vec![];
        columns.extend(time.map(|(name, time)| (name, Values::numbers(time))));
        let of = |values: Vec<Vec<f64>>| names.iter().cloned().zip(values.into_iter().map(Values::numbers));
        columns.extend(of(self.outputs));
        columns.extend(of(self.nominal).map(|(name, values)| (format!("nominal_{name}"), values)));
        columns.push(("history".into(), Values::numbers(self.history)));
        columns.push(("in_range".into(), Values::Numbers(self.in_range)));
        for (name, [low, high]) in names.iter().zip(self.ends.into_iter().flatten()) {
            columns.push((format!("low_{name}"), Values::Numbers(low)));
            columns.push((format!("high_{name}"), Values::Numbers(high)));
        }
        Frame::named(columns)
    }
}

/// A column of numbers; an empty cell is NaN, which no sample may hold.
fn numbers(frame: &Taken, name: &str) -> PyResult<Vec<f64>> {
    let Some((at, ..)) = frame.schema.get_full(name) else {
        let known: Vec<&str> = frame.schema.iter_names().map(|name| name.as_str()).collect();
        return Err(DataError::new_err(format!("the frame has no column `{name}`; it has {}", known.join(", "))));
    };
    let mut all = vec![];
    for batch in &frame.batches {
        let array = batch.arrays()[at].as_ref();
        let of_type = || DataError::new_err(format!("column `{name}` holds no numbers; give 64-bit floats"));
        all.extend(floats(array).ok_or_else(of_type)?);
    }
    Ok(all)
}

fn floats(array: &dyn Array) -> Option<Vec<f64>> {
    macro_rules! of {
        ($($kind:ty),+) => {
            $(if let Some(array) = array.as_any().downcast_ref::<PrimitiveArray<$kind>>() {
                #[allow(clippy::cast_lossless, clippy::unnecessary_cast)]
                return Some(array.iter().map(|value| value.map_or(f64::NAN, |value| *value as f64)).collect());
            })+
        };
    }
    of!(f64, f32, i64, i32, i16, i8, u64, u32, u16, u8);
    None
}

/// An array of 64-bit floats, which is not copied if it is one.
fn array2<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let array = as_floats(object)?;
    array.cast_into::<PyArray2<f64>>().map_err(|_| usage("give an array [T, I]: a row a sample, a column an input"))
}

fn array1<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
    as_floats(object)?.cast_into::<PyArray1<f64>>().map_err(|_| usage("give the times as an array [T]"))
}

fn as_floats<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = object.py().import("numpy")?;
    numpy.getattr("asarray")?.call1((object, numpy.getattr("float64")?))
}
