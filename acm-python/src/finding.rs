//! What the model lacks, and what these trials can tell apart.

use std::path::PathBuf;

use acm_core::augmented::AugmentedModel;
use acm_datasets::Manifest;
use acm_datasets::files::{atomic, owned};
use acm_eval::closed_loop::folder::LoopFolder;
use acm_eval::closed_loop::{
    self, finding_tables, head, separability_page, separability_summary, separability_tables, write_separability,
};
use acm_eval::error::EvalError;
use acm_eval::network_table::Trainings;
use acm_eval::question::{Asked, Question};
use acm_eval::stream::wiring::Wiring;
use acm_stream::{Nominal, Parts, Signals};
use acm_trace::{
    close::Closed,
    finding::{self, Step},
};
use acm_train::{run::progress::Progress, store::hashed};
use pyo3::{prelude::*, types::PyDict};

use crate::{
    errors::{DataError, of_data, of_eval, usage},
    estimator::Estimator,
    frame::Frame,
    own::effects,
    page::framed,
    recordings::place,
    settings::{Settings, edits, flatten, object},
    values::Values,
    waiting::{Interrupted, Teller, wait},
};

/// px that a finding takes in a notebook.
const HEIGHT: usize = 900;

/// What the loop found.
#[pyclass(frozen, module = "acm")]
pub struct Finding {
    closed: Closed,
    manifest: Manifest,
    /// Where the result was written, where it was.
    folder: Option<PathBuf>,
    page: Option<PathBuf>,
}

/// The nominal model with what it lacked.
#[pyclass(frozen, module = "acm")]
pub struct Model {
    model: AugmentedModel,
    manifest: Manifest,
}

/// What these trials can tell apart.
#[pyclass(frozen, module = "acm")]
pub struct Separability {
    found: finding::Separability,
}

/// A question as the command line asks it.
fn asked(
    data: Option<&Bound<'_, PyAny>>,
    config: Option<&Bound<'_, PyAny>>,
    effects: Option<&Bound<'_, PyAny>>,
    set: Option<&Bound<'_, PyAny>>,
    tables: Option<PathBuf>,
    out: Option<PathBuf>,
) -> PyResult<(Asked, Option<crate::recordings::Place>)> {
    let place = data.map(|data| place(data, tables.clone())).transpose()?;
    let mut asked = Asked { out, data: tables, ..Asked::default() };
    if let Some(place) = &place {
        (asked.folder, asked.data) = (Some(place.folder.clone()), place.tables.clone());
    }
    match Settings::of(config)? {
        Settings::File(_) if asked.folder.is_some() => {
            return Err(usage(
                "a configuration file names its data; leave `data` out, or give the configuration as a dictionary",
            ));
        }
        Settings::File(file) => asked.config = Some(file),
        Settings::Keys(_) if asked.folder.is_none() => return Err(usage("give recordings, or a configuration file")),
        Settings::Keys(keys) => flatten("", &keys, &mut asked.set),
    }
    if let Some(effects) = effects {
        flatten("", &effects::keys(effects)?, &mut asked.set);
    }
    asked.set.extend(edits(set)?);
    Ok((asked, place))
}

/// Finds the physical effect that a nominal model lacks, as ``acm-eval close-loop``.
///
/// ``data`` is :class:`Recordings` or a folder with ``manifest.toml``. ``config`` is a dictionary with the keys of a configuration,
/// ``{"search": {"max_effects": 2}}``, or a file, which names its data. ``effects`` are tried beside those of the library: an effect file,
/// an :class:`Effect`, or a list of them. ``set`` replaces single values, ``{"nominal.degree": 2}``. With ``out``
/// the result is written there as the program writes it. ``progress`` is called with each line; ``False`` says nothing.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
#[pyo3(signature = (data=None, config=None, *, effects=None, set=None, tables=None, out=None, progress=None))]
pub fn close_loop(
    py: Python<'_>,
    data: Option<&Bound<'_, PyAny>>,
    config: Option<&Bound<'_, PyAny>>,
    effects: Option<&Bound<'_, PyAny>>,
    set: Option<&Bound<'_, PyAny>>,
    tables: Option<PathBuf>,
    out: Option<PathBuf>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Finding> {
    let (asked, place) = asked(data, config, effects, set, tables, out)?;
    let finding = wait(py, progress, Interrupted::Leaves, move |teller| close(&asked, teller))?;
    drop(place);
    finding.map_err(of_eval)
}

fn close(asked: &Asked, teller: &Teller) -> Result<Finding, EvalError> {
    let question = asked.read("loop", |warning| teller.line(format!("warning: {warning}")))?;
    let trainings = Trainings::of(&question.config, &question.source, &question.campaign, asked.data.as_deref())?;
    if trainings.is_some() && asked.out.is_none() {
        let what = "networks.experiment trains networks, whose runs need a folder; give one by out=";
        return Err(EvalError::Usage(what.into()));
    }
    let folder = asked.out.as_ref().map(|_| LoopFolder::claim(&question.out)).transpose()?;
    let (manifest, out) = (question.campaign.manifest.clone(), question.out.clone());
    let mut closed = question.close(|step| {
        teller.line(line(step));
        teller.check();
    })?;
    let mut page = folder.as_ref().map(|folder| folder.write(&closed)).transpose()?;
    if let (Some(trainings), Some(folder)) = (trainings, &folder) {
        let lines = teller.clone();
        let progress = Progress::told(move |line| lines.line(line));
        page = Some(trainings.add(&mut closed, folder, &progress, teller.stop())?);
    }
    Ok(Finding { closed, manifest, folder: folder.map(|_| out), page })
}

fn line(step: &Step) -> String {
    let rejected = if step.accepted { "" } else { ", rejected" };
    let gain = step.gain.map_or(String::new(), |gain| format!(", gain {:.1} %", 100.0 * gain));
    format!("{}: error {:.4e}{gain}{rejected}", step.model, step.error)
}

#[pymethods]
impl Finding {
    /// What was found, in one sentence.
    #[getter]
    fn sentence(&self) -> &str {
        &self.closed.finding.sentence
    }

    /// What may be concluded: ``"named"``, ``"no effect"``, …
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.closed.finding.verdict)
    }

    /// What held-out trials say: ``"confirmed"``, ``"open"``, ``"refuted"`` or ``"not_tested"``.
    #[getter]
    fn confirmation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.closed.finding.confirmation)
    }

    /// A row for each parameter of each effect: value and 95 % interval in SI units.
    #[getter]
    fn effects(&self) -> Frame {
        let effects = &self.closed.finding.effects;
        let rows =
            || effects.iter().flat_map(|effect| effect.parameters.iter().map(move |parameter| (effect, parameter)));
        let word = |word: &dyn Fn(&finding::FoundEffect, &finding::FoundParameter) -> Option<String>| {
            Values::Words(rows().map(|(effect, parameter)| word(effect, parameter)).collect())
        };
        let number = |number: &dyn Fn(&finding::FoundEffect, &finding::FoundParameter) -> f64| {
            let finite = |value: f64| value.is_finite().then_some(value);
            Values::Numbers(rows().map(|(effect, parameter)| finite(number(effect, parameter))).collect())
        };
        Frame::new(vec![
            ("effect", word(&|effect, _| Some(effect.name.clone()))),
            ("meaning", word(&|effect, _| Some(effect.meaning.clone()))),
            ("carrier", word(&|effect, _| effect.carrier.clone())),
            ("parameter", word(&|_, parameter| Some(parameter.name.clone()))),
            ("value", number(&|_, parameter| parameter.value)),
            ("low", number(&|_, parameter| parameter.interval[0])),
            ("high", number(&|_, parameter| parameter.interval[1])),
            ("unit", word(&|_, parameter| Some(parameter.unit.clone()))),
            ("size", number(&|effect, _| effect.size)),
            ("share", number(&|effect, _| effect.confidence.share)),
            ("confidence", word(&|effect, _| Some(effect.confidence.level.adverb().into()))),
        ])
    }

    /// Errors on held-out trials, before and after, in SI units: the page's first table.
    #[getter]
    fn table(&self) -> Option<Frame> {
        finding_tables(&self.closed.finding).first().map(Frame::of_table)
    }

    /// Every table of the page, by name.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tables = PyDict::new(py);
        for table in finding_tables(&self.closed.finding) {
            tables.set_item(table.name, Frame::of_table(&table))?;
        }
        Ok(tables)
    }

    /// What weakens the conclusion, a sentence each.
    #[getter]
    fn cautions(&self) -> Vec<String> {
        self.closed.finding.cautions.clone()
    }

    /// The model with what it lacked.
    #[getter]
    fn model(&self) -> Model {
        Model { model: self.closed.model.clone(), manifest: self.manifest.clone() }
    }

    /// Folder of the result, where it was written.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// The page, where the result was written.
    #[getter]
    fn page(&self) -> Option<PathBuf> {
        self.page.clone()
    }

    /// Everything, as in ``loop.json``.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.closed.finding)
    }

    /// Writes page, figures, tables, ``loop.json`` and ``model.json`` as ``acm-eval close-loop --out``; returns the page's path.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<PathBuf> {
        py.detach(|| LoopFolder::claim(&folder)?.write(&self.closed)).map_err(of_eval)
    }

    fn __repr__(&self) -> String {
        closed_loop::summary(&self.closed.finding)
    }

    fn _repr_html_(&self) -> String {
        framed(&head(&self.closed.finding), HEIGHT)
    }
}

impl Model {
    /// The model as acm-train takes it.
    ///
    /// # Errors
    /// A number that is not finite.
    pub fn bytes(&self) -> PyResult<Vec<u8>> {
        hashed::encode(&self.model).map_err(|error| usage(error.to_string()))
    }
}

#[pymethods]
impl Model {
    /// Writes the model, for ``[nominal] augmented`` of an experiment.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        owned::claim(&path, |head| hashed::begins(head, "rig")).map_err(of_data)?;
        atomic::write_bytes(&path, &self.bytes()?).map_err(of_data)
    }

    /// What predicts with it, sample by sample.
    fn estimator(&self) -> PyResult<Estimator> {
        let refuse = |what: String| DataError::new_err(format!("the model cannot answer sample by sample: {what}"));
        let nominal = Nominal::Augmented(self.model.clone());
        let wiring = Wiring::new(&self.manifest, &[], &nominal).map_err(of_eval)?;
        let signals = Signals { actuators: wiring.actuators(), contexts: wiring.contexts() };
        let parts = Parts::alone(signals, nominal, self.manifest.tip_columns(), self.model.rig().step);
        Estimator::of_parts(parts.map_err(|error| refuse(error.to_string()))?, wiring).map_err(refuse)
    }

    /// Everything, as in ``model.json``.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.model)
    }
}

/// Says which effects the trials could tell apart, as ``acm-eval separability``; arguments as of :func:`close_loop`.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
#[pyo3(signature = (data=None, config=None, *, effects=None, set=None, tables=None, out=None, progress=None))]
pub fn separability(
    py: Python<'_>,
    data: Option<&Bound<'_, PyAny>>,
    config: Option<&Bound<'_, PyAny>>,
    effects: Option<&Bound<'_, PyAny>>,
    set: Option<&Bound<'_, PyAny>>,
    tables: Option<PathBuf>,
    out: Option<PathBuf>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Separability> {
    let (asked, place) = asked(data, config, effects, set, tables, out.clone())?;
    let found = wait(py, progress, Interrupted::Leaves, move |teller| {
        let question: Question = asked.read("separability", |warning| teller.line(format!("warning: {warning}")))?;
        let found = question.separability()?;
        out.map(|out| write_separability(&found, &out)).transpose()?;
        Ok(found)
    })?;
    drop(place);
    Ok(Separability { found: found.map_err(of_eval)? })
}

#[pymethods]
impl Separability {
    /// Names of the effects that can act on the rig.
    #[getter]
    fn effects(&self) -> Vec<String> {
        self.found.effects.clone()
    }

    /// Effects that imitate each other by 90 % or more of what recalibration leaves, with the experiment that would tell them apart.
    #[getter]
    fn groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.found.groups)
    }

    /// Every table of the page, by name: pairs, and what recalibration takes over.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tables = PyDict::new(py);
        for table in separability_tables(&self.found) {
            tables.set_item(table.name, Frame::of_table(&table))?;
        }
        Ok(tables)
    }

    /// Everything, as in ``separability.json``.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.found)
    }

    /// Writes page, figures, tables and ``separability.json``; returns the page's path.
    fn save(&self, folder: PathBuf) -> PyResult<PathBuf> {
        write_separability(&self.found, &folder).map_err(of_eval)
    }

    fn __repr__(&self) -> String {
        separability_summary(&self.found)
    }

    fn _repr_html_(&self) -> String {
        framed(&separability_page(&self.found), HEIGHT)
    }
}
