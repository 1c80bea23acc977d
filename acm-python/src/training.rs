//! Training, as acm-train does it, and what it leaves.

use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
};

use acm_datasets::files::{atomic, owned};
use acm_eval::report::{Report as Made, default_folder};
use acm_train::{
    cli::{Cli, TrainError, conduct_with},
    explain,
    run::{
        progress::Progress,
        record::{PartScores, RunRecord, Stage, read_records},
    },
    store::hashed,
};
use clap::Parser;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    errors::{of_data, of_eval, of_train, usage},
    estimator::Estimator,
    finding::Model,
    frame::Frame,
    page::framed,
    recordings::{Place, place},
    settings::{Settings, edit, edits, object},
    values::Values,
    waiting::{Interrupted, Teller, wait},
};

/// px that a report takes in a notebook.
const HEIGHT: usize = 900;

/// A run folder.
#[pyclass(frozen, module = "acm")]
pub struct Run {
    folder: PathBuf,
    text: String,
}

/// Trains as ``acm-train --config``.
///
/// ``config`` is an experiment file or a dictionary with its keys, ``{"network": {"kind": "gru"}}``. ``data`` is :class:`Recordings` or a
/// folder, in place of the experiment's own; of a frame that was not saved, a copy is kept beside the run, in ``<out>-recordings``.
/// ``nominal`` is a :class:`Model` of a finding or its file. ``out`` is the run folder, ``resume`` goes on in it. Ctrl-C stops after the
/// epoch; the same call with ``resume=True`` then gives the same bits as a run that was never stopped.
#[pyfunction]
#[pyo3(signature = (config=None, *, data=None, out=None, nominal=None, set=None, tables=None, resume=false, jobs=None, threads=None,
                    progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn train(
    py: Python<'_>,
    config: Option<&Bound<'_, PyAny>>,
    data: Option<&Bound<'_, PyAny>>,
    out: Option<PathBuf>,
    nominal: Option<&Bound<'_, PyAny>>,
    set: Option<&Bound<'_, PyAny>>,
    tables: Option<PathBuf>,
    resume: bool,
    jobs: Option<usize>,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Run> {
    let scratch = tempfile::tempdir().map_err(|error| usage(format!("no temporary folder can be made: {error}")))?;
    let file = match Settings::of(config)? {
        Settings::File(file) => file,
        Settings::Keys(keys) => {
            let file = scratch.path().join("experiment.toml");
            let text = toml::to_string(&keys).map_err(|error| usage(error.to_string()))?;
            atomic::write_bytes(&file, text.as_bytes()).map_err(of_data)?;
            file
        }
    };
    let out = match out {
        Some(out) => out,
        None if file.starts_with(scratch.path()) => return Err(usage("give the run a folder by out=")),
        None => Path::new("runs").join(file.file_stem().unwrap_or("experiment".as_ref())),
    };
    let mut sets = vec![];
    let mut tables = tables;
    if let Some(data) = data {
        let kept = kept(place(data, tables)?, &out)?;
        sets.push(edit("data", &absolute(&kept.folder)));
        tables = kept.tables;
    }
    if let Some(nominal) = nominal {
        sets.push(edit("nominal.augmented", &absolute(&model(nominal, &out)?)));
    }
    sets.extend(edits(set)?);
    let cli = arguments(&file, &out, tables, &sets, resume, jobs, threads)?;
    let folder = out.clone();
    let trained = wait(py, progress, Interrupted::Finishes, move |teller| {
        let _until_done = scratch;
        conduct(&cli, teller)
    })?;
    Ok(Run { folder, text: trained.map_err(of_train)? })
}

fn conduct(cli: &Cli, teller: &Teller) -> Result<String, TrainError> {
    let lines = teller.clone();
    let trained = conduct_with(cli, &Progress::told(move |line| lines.line(line)), teller.stop());
    match trained {
        Err(error) if error.exit_code() == 130 => {
            let stopped = explain(error);
            teller.line(stopped.clone());
            Ok(stopped)
        }
        other => other,
    }
}

/// As the command line has them.
fn arguments(
    file: &Path,
    out: &Path,
    tables: Option<PathBuf>,
    sets: &[String],
    resume: bool,
    jobs: Option<usize>,
    threads: Option<usize>,
) -> PyResult<Cli> {
    let mut words: Vec<OsString> = ["acm-train", "--config"].map(OsString::from).to_vec();
    words.extend([file.into(), "--out".into(), out.into()]);
    words.extend(tables.into_iter().flat_map(|tables| ["--data".into(), tables.into()]));
    words.extend(sets.iter().flat_map(|set| ["--set".into(), set.into()]));
    words.extend(resume.then(|| "--resume".into()));
    for (option, count) in [("--jobs", jobs), ("--threads", threads)] {
        words.extend(count.into_iter().flat_map(|count| [option.into(), count.to_string().into()]));
    }
    Cli::try_parse_from(words).map_err(|error| usage(error.to_string()))
}

/// Recordings that the run finds again: of a frame, a copy beside its folder.
fn kept(place: Place, out: &Path) -> PyResult<Place> {
    if !place.is_passing() {
        return Ok(place);
    }
    let mut name = out.file_name().unwrap_or("run".as_ref()).to_os_string();
    name.push("-recordings");
    place.keep(&out.with_file_name(name))
}

/// File of a model, which is written beside the run where it has none.
fn model(nominal: &Bound<'_, PyAny>, out: &Path) -> PyResult<PathBuf> {
    let Ok(model) = nominal.cast::<Model>() else { return nominal.extract() };
    let mut name = out.file_name().unwrap_or("run".as_ref()).to_os_string();
    name.push("-model.json");
    let file = out.with_file_name(name);
    let bytes = model.get().bytes()?;
    if fs::read(&file).is_ok_and(|own| own == bytes) {
        return Ok(file);
    }
    owned::claim(&file, |head| hashed::begins(head, "rig")).map_err(of_data)?;
    if let Some(parent) = file.parent() {
        atomic::make_folder(parent).map_err(|error| usage(format!("{}: {error}", parent.display())))?;
    }
    atomic::write_bytes(&file, &bytes).map_err(of_data)?;
    Ok(file)
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.into())
}

#[pymethods]
impl Run {
    /// A run folder that acm-train wrote, or the folder of a study.
    #[new]
    fn new(folder: PathBuf) -> PyResult<Self> {
        if !folder.is_dir() {
            return Err(of_eval(acm_eval::error::EvalError::NoFolder { path: folder }));
        }
        let text = format!("run {}", folder.display());
        Ok(Self { folder, text })
    }

    /// The folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    /// The records of its finished runs, as in ``records/*.json``.
    #[getter]
    fn records<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.read()?)
    }

    /// A row for each run, part and estimator: root mean square error over all outputs, in SI units.
    #[getter]
    fn scores(&self) -> PyResult<Frame> {
        let records = self.read()?;
        let mut rows: Vec<(&RunRecord, &str, &String, f64, usize)> = vec![];
        for record in &records {
            let parts = [("validation", Some(&record.validation)), ("held_out", record.held_out.as_ref())];
            for (part, scores) in parts {
                let scores = scores.into_iter().flat_map(|scores: &PartScores| &scores.estimators);
                rows.extend(scores.map(|(name, score)| (record, part, name, score.rmse_total, score.samples)));
            }
        }
        let stage = |record: &RunRecord| match record.stage {
            Stage::Final => "final".to_string(),
            Stage::CrossValidation { fold } => format!("fold {fold}"),
        };
        Ok(Frame::new(vec![
            ("run", Values::words(rows.iter().map(|row| row.0.id.clone()))),
            ("stage", Values::words(rows.iter().map(|row| stage(row.0)))),
            ("seed", Values::numbers(rows.iter().map(|row| row.0.seed as f64))),
            ("part", Values::words(rows.iter().map(|row| row.1))),
            ("estimator", Values::words(rows.iter().map(|row| row.2.clone()))),
            ("rmse", Values::numbers(rows.iter().map(|row| row.3))),
            ("samples", Values::numbers(rows.iter().map(|row| row.4 as f64))),
        ]))
    }

    /// What predicts with a network of the run; arguments as of :meth:`Estimator.load`.
    #[pyo3(signature = (*, network=None, windows=false, everywhere=false, tables=None))]
    fn estimator(
        &self,
        py: Python<'_>,
        network: Option<String>,
        windows: bool,
        everywhere: bool,
        tables: Option<PathBuf>,
    ) -> PyResult<Estimator> {
        Estimator::of_run(py, self.folder.clone(), network, windows, everywhere, tables)
    }

    /// The page of ``acm-eval report``.
    #[pyo3(signature = (out=None))]
    fn report(&self, py: Python<'_>, out: Option<PathBuf>) -> PyResult<Report> {
        made(py, vec![self.folder.clone()], out)
    }

    fn __fspath__(&self) -> OsString {
        self.folder.clone().into_os_string()
    }

    fn __repr__(&self) -> &str {
        &self.text
    }
}

impl Run {
    fn read(&self) -> PyResult<Vec<RunRecord>> {
        read_records(&self.folder).map_err(|error| of_eval(error.into()))
    }
}

/// Runs and studies on one page.
#[pyclass(frozen, module = "acm")]
pub struct Report {
    made: Made,
    page: PathBuf,
}

/// Compares runs and studies on one page, as ``acm-eval report``: ``runs`` is a run, a folder, or a list of them.
#[pyfunction]
#[pyo3(signature = (runs, *, out=None))]
pub fn report(py: Python<'_>, runs: &Bound<'_, PyAny>, out: Option<PathBuf>) -> PyResult<Report> {
    let folders: Vec<PathBuf> = match runs.extract::<PathBuf>() {
        Ok(one) => vec![one],
        Err(_) => runs.extract()?,
    };
    made(py, folders, out)
}

fn made(py: Python<'_>, folders: Vec<PathBuf>, out: Option<PathBuf>) -> PyResult<Report> {
    let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
    let command = format!("acm-eval report {}", names.join(" "));
    let out = out.unwrap_or_else(|| default_folder(&folders));
    let write = move |_: &Teller| {
        let made = Made::of(&folders, command)?;
        let page = made.write(&out)?;
        Ok(Report { made, page })
    };
    wait(py, None, Interrupted::Leaves, write)?.map_err(of_eval)
}

#[pymethods]
impl Report {
    /// Path of the page.
    #[getter]
    fn page(&self) -> PathBuf {
        self.page.clone()
    }

    /// Every table of the page, by chapter and name.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let chapters = PyDict::new(py);
        for chapter in &self.made.chapters {
            let tables = PyDict::new(py);
            chapter.tables.iter().try_for_each(|table| tables.set_item(table.name, Frame::of_table(table)))?;
            chapters.set_item(&chapter.slug, tables)?;
        }
        Ok(chapters)
    }

    fn __repr__(&self) -> String {
        format!("{}\n\n{}", acm_eval::terminal::summary(&self.made), self.page.display())
    }

    fn _repr_html_(&self) -> String {
        framed(&acm_eval::page::html(&self.made), HEIGHT)
    }
}
