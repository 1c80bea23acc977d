//! Long work in a thread of its own: the interpreter is released, lines of progress come through, and Ctrl-C is heard.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    sync::mpsc::{RecvTimeoutError, Sender, channel},
    thread::Builder,
    time::Duration,
};

use acm_train::run::stop::Stop;
use pyo3::{prelude::*, types::PyBool};

use crate::errors::{AcmError, usage};

/// How long Ctrl-C may wait to be heard.
const PAUSE: Duration = Duration::from_millis(50);

/// Of the worker: as a program's main thread has.
const STACK: usize = 16 << 20;

/// What the thread that works says.
enum Said<T> {
    Line(String),
    Done(Result<T, Box<dyn Any + Send>>),
}

/// What ends a search that nobody waits for any more.
struct Abandoned;

/// Tells lines from any thread.
#[derive(Clone)]
pub struct Teller {
    tell: std::sync::Arc<dyn Fn(String) + Send + Sync>,
    stop: Stop,
}

impl Teller {
    /// Says a line.
    pub fn line(&self, line: impl Into<String>) {
        (self.tell)(line.into());
    }

    /// Ends the work here if Ctrl-C was pressed.
    pub fn check(&self) {
        if self.stop.asked() {
            resume_unwind(Box::new(Abandoned));
        }
    }

    /// Whether Ctrl-C was pressed, for work that ends by itself.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }
}

/// What happens at Ctrl-C.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Interrupted {
    /// The work is waited for until it has reached a place to go on from: it looks at [`Teller::stop`].
    Finishes,
    /// The work is left behind, and ends at its next [`Teller::check`].
    Leaves,
}

/// Does `work`, and hands its lines to `progress`: none writes to `sys.stderr`, `False` nowhere, a callable is called.
///
/// # Errors
/// An interrupt, an exception of the callable, or a bug in the work.
pub fn wait<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    interrupted: Interrupted,
    work: impl FnOnce(&Teller) -> T + Send + 'static,
) -> PyResult<T> {
    let listener = Listener::of(progress)?;
    let (said, mut heard) = channel();
    let lines: Sender<Said<T>> = said.clone();
    let stop = Stop::default();
    // A listener that went away is no reason to stop.
    let tell = move |line| drop(lines.send(Said::Line(line)));
    let teller = Teller { tell: std::sync::Arc::new(tell), stop: stop.clone() };
    let run = move || drop(said.send(Said::Done(catch_unwind(AssertUnwindSafe(|| work(&teller))))));
    let thread = Builder::new().name("acm".into()).stack_size(STACK).spawn(run);
    thread.map_err(|error| AcmError::new_err(format!("no thread can be started: {error}")))?;
    let mut raised: Option<PyErr> = None;
    loop {
        let next;
        (heard, next) = py.detach(move || {
            let next = heard.recv_timeout(PAUSE);
            (heard, next)
        });
        let problem = match next {
            Ok(Said::Line(line)) => listener.hear(py, &line).err(),
            Ok(Said::Done(_)) if raised.is_some() => None,
            Ok(Said::Done(Ok(done))) => return Ok(done),
            Ok(Said::Done(Err(panic))) => return Err(bug(panic.as_ref())),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return Err(raised.unwrap_or_else(|| bug(&()))),
        };
        let Some(problem) = problem.or_else(|| py.check_signals().err()) else { continue };
        let again = raised.is_some();
        stop.ask();
        if again || interrupted == Interrupted::Leaves {
            return Err(problem);
        }
        listener.hear(py, "stopping after this epoch; interrupt again to wait no longer")?;
        raised = Some(problem);
    }
}

/// Where lines go.
enum Listener<'a, 'py> {
    Stderr,
    Nobody,
    Callable(&'a Bound<'py, PyAny>),
}

impl<'a, 'py> Listener<'a, 'py> {
    fn of(progress: Option<&'a Bound<'py, PyAny>>) -> PyResult<Self> {
        match progress {
            None => Ok(Self::Stderr),
            Some(flag) if flag.is_instance_of::<PyBool>() => {
                Ok(if flag.is_truthy()? { Self::Stderr } else { Self::Nobody })
            }
            Some(callable) if callable.is_callable() => Ok(Self::Callable(callable)),
            Some(_) => Err(usage("`progress` is no callable; give a function of one line, False, or leave it out")),
        }
    }

    fn hear(&self, py: Python<'py>, line: &str) -> PyResult<()> {
        match self {
            Self::Nobody => Ok(()),
            Self::Callable(callable) => callable.call1((line,)).map(drop),
            Self::Stderr => {
                let stderr = py.import("sys")?.getattr("stderr")?;
                if stderr.is_none() {
                    return Ok(());
                }
                stderr.call_method1("write", (format!("{line}\n"),))?;
                stderr.call_method0("flush").map(drop)
            }
        }
    }
}

/// A panic of the work, which is a bug of this program.
fn bug(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("no message");
    AcmError::new_err(format!("a bug in acm: {text}; please report it with the recordings that led to it"))
}
