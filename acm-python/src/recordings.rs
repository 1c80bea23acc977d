//! Recordings: a folder, or a frame that is written as one.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_datasets::files::table::write_arrow;
use acm_datasets::files::{atomic, owned};
use acm_datasets::predict::TABLE;
use acm_datasets::recordings::Options;
use acm_datasets::units::Unit;
use acm_datasets::{Campaign, Recordings as Opened, Role, Trial, describe};
use nalgebra::DMatrix;
use polars_arrow::datatypes::ArrowDataType as Type;
use pyo3::{
    exceptions::PyKeyError,
    prelude::*,
    types::{PyDict, PyType},
};
use tempfile::TempDir;
use toml::Value;

use crate::{
    arrow,
    errors::{of_data, usage},
    frame::{Frame, escaped},
    manifest::{Columns, FILE, texts},
    names,
    own::nominal,
    page::Text,
    settings::object,
    values::Values,
    view,
    waiting::{Interrupted, wait},
};

const MANIFEST: &str = "manifest.toml";

/// Recordings of a robot, checked, in SI units: trials with times, actuators, contexts and measured outputs.
#[pyclass(frozen, module = "acm")]
pub struct Recordings {
    place: Place,
    campaign: Arc<Campaign>,
}

/// Where recordings lie.
#[derive(Debug, Clone)]
pub struct Place {
    /// Folder with the manifest.
    pub folder: PathBuf,
    /// Folder of the tables, where it is another one.
    pub tables: Option<PathBuf>,
    /// Of a frame: the folder is gone when nobody needs it any more.
    held: Option<Arc<TempDir>>,
}

impl Place {
    /// Of a folder that somebody keeps.
    pub fn of(folder: PathBuf, tables: Option<PathBuf>) -> Self {
        Self { folder, tables, held: None }
    }

    /// Whether it lasts no longer than the process.
    pub fn is_passing(&self) -> bool {
        self.held.is_some()
    }

    /// Copies a frame's set to a folder of its own.
    ///
    /// # Errors
    /// The folder holds another set, or cannot be written.
    pub fn keep(&self, folder: &Path) -> PyResult<Self> {
        let read = |path: PathBuf| fs::read(&path).map_err(|error| file("read", &path, &error));
        let own = read(self.folder.join(MANIFEST))?;
        if folder.join(MANIFEST).exists() && read(folder.join(MANIFEST))? != own {
            return Err(usage(format!(
                "{} is of another data set; choose another folder",
                folder.join(MANIFEST).display()
            )));
        }
        atomic::make_folder(folder).map_err(|error| file("create", folder, &error))?;
        let table = if self.folder.join(FILE).exists() { FILE } else { TABLE };
        let is_kept = folder.join(MANIFEST).exists();
        owned::claim(&folder.join(table), |_| is_kept).map_err(of_data)?;
        for (name, bytes) in [(table, read(self.folder.join(table))?), (MANIFEST, own)] {
            atomic::write_bytes(&folder.join(name), &bytes).map_err(of_data)?;
        }
        Ok(Self::of(folder.into(), None))
    }
}

fn file(action: &'static str, path: &Path, error: &std::io::Error) -> PyErr {
    of_data(acm_datasets::DataError::file_system(action, path, error))
}

impl Recordings {
    /// Where they lie.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Reads a folder.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn open(py: Python<'_>, place: Place) -> PyResult<Self> {
        let (folder, tables) = (place.folder.clone(), place.tables.clone());
        let read = move |_: &_| Campaign::read(&folder, tables.as_deref());
        let campaign = wait(py, None, Interrupted::Leaves, read)?.map_err(of_data)?;
        Ok(Self { place, campaign: Arc::new(campaign) })
    }

    fn find(&self, trial: &str) -> PyResult<&Trial> {
        self.campaign.trial(trial).ok_or_else(|| {
            let known: Vec<&str> = self.campaign.trials.iter().map(|trial| trial.name.as_str()).collect();
            PyKeyError::new_err(format!("there is no trial {trial:?}; there are {}", known.join(", ")))
        })
    }

    /// Kind, name, SI unit, column and values of every signal of a trial.
    fn signals(&self) -> Vec<(&'static str, String, &'static str, usize)> {
        let manifest = &self.campaign.manifest;
        let si = |unit: &str| Unit::parse(unit).map_or("1", |unit| unit.si_name());
        let mut all = vec![];
        for (kind, signals) in
            [("actuator", &manifest.actuator), ("context", &manifest.context), ("predicted", &manifest.predicted)]
        {
            all.extend(signals.iter().enumerate().map(|(at, s)| (kind, s.name().to_string(), si(&s.unit), at)));
        }
        let measured = manifest.measured.iter().enumerate();
        all.extend(measured.map(|(at, m)| ("measured", m.name().to_string(), si(&m.unit), at)));
        all
    }
}

fn matrix<'a>(trial: &'a Trial, kind: &str) -> Option<&'a DMatrix<f64>> {
    match kind {
        "actuator" => Some(&trial.actuators),
        "context" => Some(&trial.context),
        "measured" => Some(&trial.measured),
        _ => trial.predicted.as_ref(),
    }
}

#[pymethods]
impl Recordings {
    /// Recordings in a frame of pandas, polars or pyarrow, in the words of a manifest.
    ///
    /// ``time`` is a column (unit of ``units``, else s) or ``{"rate_hz": 100.0}``. ``trial`` is the column of the trials' names; without it
    /// all rows are one trial. ``actuators``, ``outputs``, ``context`` and ``predicted`` are lists of columns (units of ``units``, else 1),
    /// dictionaries of columns and units, or lists of dictionaries as in ``[[actuator]]``. Trials without another role develop.
    /// ``manifest`` has further keys of a manifest: ``{"arm": {...}}``.
    ///
    /// The frame is written as Parquet beside a manifest, into a folder that lasts as long as the object, and read from there: what
    /// is checked and computed is that of the programs. :meth:`save` keeps the folder.
    #[classmethod]
    #[pyo3(signature = (frame, *, time, actuators, outputs, trial=None, context=None, predicted=None, units=None, calibration=None,
                        development=None, held_out=None, excluded=None, manifest=None))]
    #[allow(clippy::too_many_arguments)]
    fn from_frame<'py>(
        _class: &Bound<'py, PyType>,
        py: Python<'py>,
        frame: &Bound<'py, PyAny>,
        time: Bound<'py, PyAny>,
        actuators: Bound<'py, PyAny>,
        outputs: Bound<'py, PyAny>,
        trial: Option<String>,
        context: Option<Bound<'py, PyAny>>,
        predicted: Option<Bound<'py, PyAny>>,
        units: Option<Bound<'py, PyAny>>,
        calibration: Option<Vec<String>>,
        development: Option<Vec<String>>,
        held_out: Option<Vec<String>>,
        excluded: Option<Vec<String>>,
        manifest: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let columns = Columns {
            time,
            trial,
            actuators,
            outputs,
            context,
            predicted,
            units,
            calibration,
            development,
            held_out,
            excluded,
            manifest,
        };
        Self::of_frame(py, frame, &columns)
    }

    /// Name of the set.
    #[getter]
    fn name(&self) -> &str {
        &self.campaign.manifest.name
    }

    /// Where the manifest lies.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.place.folder.clone()
    }

    /// SHA-256 of manifest and tables.
    #[getter]
    fn hash(&self) -> &str {
        &self.campaign.hash
    }

    /// What looks wrong and may be right, a sentence each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.campaign.warnings.clone()
    }

    /// The manifest, as a dictionary.
    #[getter]
    fn manifest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.campaign.manifest)
    }

    /// A row for each trial: name, role, samples, duration in s, samples left out.
    #[getter]
    fn trials(&self) -> Frame {
        let trials = &self.campaign.trials;
        let count = |count: usize| count as f64;
        Frame::new(vec![
            ("trial", Values::words(trials.iter().map(|trial| trial.name.clone()))),
            ("role", Values::words(trials.iter().map(|trial| trial.role.name()))),
            ("samples", Values::numbers(trials.iter().map(|trial| count(trial.samples())))),
            ("duration", Values::numbers(trials.iter().map(Trial::duration))),
            ("left_out", Values::numbers(trials.iter().map(|trial| count(trial.dropped.values().sum())))),
        ])
    }

    /// A row for each signal: name, kind, SI unit.
    #[getter]
    #[pyo3(name = "signals")]
    fn signal_table(&self) -> Frame {
        let signals = self.signals();
        Frame::new(vec![
            ("signal", Values::words(signals.iter().map(|signal| signal.1.clone()))),
            ("kind", Values::words(signals.iter().map(|signal| signal.0))),
            ("unit", Values::words(signals.iter().map(|signal| signal.2))),
        ])
    }

    /// ``recordings["run1"]``: ``time`` and each signal of a trial as an array ``[T]`` in SI units, which is a view and cannot be written;
    /// predictions have the prefix ``predicted_``.
    fn __getitem__<'py>(slf: &Bound<'py, Self>, trial: &str) -> PyResult<Bound<'py, PyDict>> {
        let own = slf.get();
        let (trial, arrays) = (own.find(trial)?, PyDict::new(slf.py()));
        arrays.set_item("time", view::of(&trial.time, slf)?)?;
        for (kind, name, _, column) in own.signals() {
            let Some(values) = matrix(trial, kind) else { continue };
            let rows = values.nrows();
            let name = if kind == "predicted" { format!("predicted_{name}") } else { name };
            arrays.set_item(name, view::of(&values.as_slice()[column * rows..(column + 1) * rows], slf)?)?;
        }
        Ok(arrays)
    }

    fn __len__(&self) -> usize {
        self.campaign.trials.len()
    }

    fn __contains__(&self, trial: &str) -> bool {
        self.campaign.trial(trial).is_some()
    }

    /// Keeps a frame's recordings in a folder, from which the programs read them: manifest.toml and frame.parquet.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        if !self.place.is_passing() {
            return Err(usage(format!("these recordings lie in {}; copy that folder", self.place.folder.display())));
        }
        Self::open(py, self.place.keep(&folder)?)
    }

    /// The same recordings with the predictions of ``model``, a nominal model of one's own, in the place of those they may have.
    ///
    /// ``model`` is called with each trial: a dictionary of arrays ``[T]``, ``time`` in s, then actuators, contexts and conditions in the units of
    /// the manifest. It gives an array ``[T, O]``, ``[T]`` of one output, or a dictionary of arrays by output, in the units of the outputs.
    fn with_nominal(&self, py: Python<'_>, model: &Bound<'_, PyAny>) -> PyResult<Self> {
        let held =
            TempDir::with_prefix("acm-").map_err(|error| file("create", Path::new("a temporary folder"), &error))?;
        let folder = held.path().to_path_buf();
        nominal::write(&self.campaign, model, &folder)?;
        Self::open(py, Place { folder, tables: None, held: Some(Arc::new(held)) })
    }

    fn __repr__(&self) -> String {
        let trials = &self.campaign.trials;
        let of = |role: &Role| {
            let count = trials.iter().filter(|trial| trial.role == *role).count();
            (count > 0).then(|| format!("{count} {}", role.name().replace('_', " ")))
        };
        let roles: Vec<String> = Role::ALL.iter().filter_map(of).collect();
        let samples: usize = trials.iter().map(Trial::samples).sum();
        let (name, count) = (&self.campaign.manifest.name, trials.len());
        format!("{name}: {count} trials ({}), {samples} samples", roles.join(", "))
    }

    fn _repr_html_(&self) -> String {
        format!("<p>{}</p>{}", escaped(&self.__repr__()), self.trials()._repr_html_())
    }
}

impl Recordings {
    /// As [`Recordings::from_frame`].
    ///
    /// # Errors
    /// A frame that cannot be taken, or whose recordings have problems.
    pub fn of_frame(py: Python<'_>, frame: &Bound<'_, PyAny>, columns: &Columns<'_>) -> PyResult<Self> {
        let taken = arrow::take(frame)?;
        let found = columns.trial.as_ref().and_then(|trial| names::of(&taken, trial));
        let names = if columns.trial.is_none() { vec!["frame".to_string()] } else { found.unwrap_or_default() };
        let timed = |column: &str| taken.schema.get(column).is_some_and(|field| is_time(&field.dtype));
        let manifest = Value::Table(columns.manifest(&names, timed)?);
        let mut named = BTreeSet::new();
        texts(&manifest, &mut named);
        let taken = taken.only(|column| named.contains(column))?;
        let held =
            TempDir::with_prefix("acm-").map_err(|error| file("create", Path::new("a temporary folder"), &error))?;
        let folder = held.path().to_path_buf();
        write_arrow(&folder.join(FILE), &taken.schema, taken.batches).map_err(of_data)?;
        atomic::write_bytes(&folder.join(MANIFEST), manifest_text(&manifest)?.as_bytes()).map_err(of_data)?;
        Self::open(py, Place { folder, tables: None, held: Some(Arc::new(held)) })
    }
}

/// The set is named as a frame is, and not as its folder.
fn manifest_text(manifest: &Value) -> PyResult<String> {
    let text = toml::to_string(manifest).map_err(|error| usage(error.to_string()))?;
    let named = manifest.get("name").is_some();
    Ok(if named { text } else { format!("name = \"frame\"\n{text}") })
}

fn is_time(stored: &Type) -> bool {
    matches!(stored, Type::Timestamp(..) | Type::Duration(_) | Type::Time32(_) | Type::Time64(_) | Type::Date32)
}

/// Reads a folder with ``manifest.toml``, and checks everything; ``tables`` is the folder of its tables, where they do not lie beside it.
#[pyfunction]
#[pyo3(signature = (folder, *, tables=None))]
pub fn read(py: Python<'_>, folder: PathBuf, tables: Option<PathBuf>) -> PyResult<Recordings> {
    Recordings::open(py, Place::of(folder, tables))
}

/// Where the recordings of an argument lie: an object of this package, or a folder.
///
/// # Errors
/// Something else.
pub fn place(data: &Bound<'_, PyAny>, tables: Option<PathBuf>) -> PyResult<Place> {
    if let Ok(recordings) = data.cast::<Recordings>() {
        let own = recordings.get().place().clone();
        return Ok(Place { tables: tables.or(own.tables), ..own });
    }
    if arrow::is_frame(data) {
        return Err(usage(
            "a frame does not say what its columns are; give acm.Recordings.from_frame(frame, time=…, …)",
        ));
    }
    Ok(Place::of(data.extract()?, tables))
}

/// What ``acm-data check`` says of recordings without problems: trials, samples, warnings. Trials shorter than ``window`` samples in a
/// row, without a gap over ``max_gap`` s, are problems.
#[pyfunction]
#[pyo3(signature = (data, *, tables=None, window=50, max_gap=None))]
pub fn check(
    py: Python<'_>,
    data: &Bound<'_, PyAny>,
    tables: Option<PathBuf>,
    window: usize,
    max_gap: Option<f64>,
) -> PyResult<Text> {
    let opened = open(py, place(data, tables)?, Some(window), max_gap)?;
    Ok(Text(describe::checked(&opened).trim_end().to_string()))
}

/// What ``acm-data describe`` prints: trials, ranges, clocks, and every signal drawn.
#[pyfunction]
#[pyo3(name = "describe", signature = (data, *, tables=None, max_gap=None))]
pub fn described(
    py: Python<'_>,
    data: &Bound<'_, PyAny>,
    tables: Option<PathBuf>,
    max_gap: Option<f64>,
) -> PyResult<Text> {
    let place = place(data, tables)?;
    let folder = place.folder.clone();
    let opened = open(py, place, None, max_gap)?;
    let text = py.detach(|| describe::description(&opened, &folder, max_gap, None)).map_err(of_data)?;
    Ok(Text(text.trim_end().to_string()))
}

fn open(py: Python<'_>, place: Place, window: Option<usize>, max_gap: Option<f64>) -> PyResult<Opened> {
    if let Some(max_gap) = max_gap.filter(|gap| !(*gap > 0.0 && gap.is_finite())) {
        return Err(usage(format!("max_gap is {max_gap}; give a finite number above 0")));
    }
    let read = move |_: &_| {
        let options = Options { window, max_gap, ..Options::default() };
        Opened::open(&place.folder, place.tables.as_deref(), &options)
    };
    wait(py, None, Interrupted::Leaves, read)?.map_err(of_data)
}
