//! TOML files whose errors show file, line and column with the key underlined.
//!
//! The file is read once, with a limit on its size. Errors of syntax, of type and of unknown keys come from the parser;
//! what a `validate` function refuses afterwards is located by its key path, so that both look alike:
//!
//! ```text
//! manifest.toml:12:3: unknown field `colum`, expected one of `column`, `unit`, `name`
//!    ╭─[manifest.toml:12:3]
//! 12 │ colum = "u1"
//!    · ──┬──
//! ```

mod controls;
mod located;
pub mod overflow;
mod walk;
pub mod words;

use std::collections::BTreeMap;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::de::DeserializeOwned;
use toml::de::DeTable;

use crate::error::DataError;
use crate::files::regular;
use crate::toml_file::words::{cut, empty, in_words, key_near, remedy, short, syntax_remedy};

pub use located::TomlError;
use walk::each;

/// A configuration file is written by hand: a larger one is a mistaken path.
pub const SIZE_LIMIT: u64 = 1 << 20;

/// Past this length source lines are not printed.
const LINE_LIMIT: usize = 240;

/// Where to see what such a file can say.
const EXAMPLE: &str = "book/src/manifest.md";

/// The text of a TOML file, kept to say where a value stands.
#[derive(Debug, Clone)]
pub struct TomlSource {
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Place of each value, by its path; computed once, on demand.
    spans: OnceLock<BTreeMap<Vec<String>, Range<usize>>>,
}

/// Reads `path` as a `T`.
///
/// # Errors
/// A file that cannot be read, is larger than [`SIZE_LIMIT`], is not UTF-8, is not TOML, or does not fit `T`.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<(T, TomlSource), DataError> {
    let source = TomlSource::read(path)?;
    let value = source.parse()?;
    Ok((value, source))
}

impl TomlSource {
    /// Reads the text alone.
    ///
    /// # Errors
    /// A file that cannot be read, is larger than [`SIZE_LIMIT`], or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, DataError> {
        let failed = |reason: &std::io::Error| match reason.kind() {
            std::io::ErrorKind::IsADirectory => {
                DataError::Usage(format!("{}: {reason}; put a TOML file in its place", path.display()))
            }
            _ => DataError::file_system("read", path, reason),
        };
        let mut bytes = Vec::new();
        let file = regular::open(path).map_err(|e| failed(&e))?;
        file.take(SIZE_LIMIT + 1).read_to_end(&mut bytes).map_err(|e| failed(&e))?;
        let source = |text: String| TomlSource { path: path.to_path_buf(), text, spans: OnceLock::new() };
        if bytes.len() as u64 > SIZE_LIMIT {
            let message = format!("the file is larger than {SIZE_LIMIT} bytes; is this the right file?");
            return Err(source(String::new()).at(0..0, message).into());
        }
        match String::from_utf8(bytes) {
            Ok(text) => match empty(&text, EXAMPLE) {
                Some((what, remedy)) => Err(source(text).at(0..0, format!("{what}; {remedy}")).into()),
                None => Ok(source(text)),
            },
            Err(e) => {
                let valid = e.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(e.as_bytes()).into_owned();
                let message = "the text is not UTF-8; save the file as UTF-8".to_string();
                Err(source(text).at(valid..valid, message).into())
            }
        }
    }

    /// Parses the text as a `T`.
    ///
    /// # Errors
    /// A text that is not TOML, or does not fit `T`.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, TomlError> {
        let parsed = toml::Deserializer::parse(&self.text).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            let near = key_near(&self.text, span.start).map_or(String::new(), |key| format!(" (at `{key}`)"));
            self.at(span, format!("{}{near}; {}", in_words(e.message()), syntax_remedy(e.message())))
        })?;
        let too_large = overflow::find(&self.text).map(|(span, what, remedy)| (span, format!("{what}; {remedy}")));
        if let Some((span, message)) = controls::find(&self.text).or(too_large) {
            return Err(self.at(span, message));
        }
        serde_path_to_error::deserialize(parsed).map_err(|e| {
            let path = e.path().to_string();
            let key = if path.is_empty() || path == "." { String::new() } else { format!("`{}`: ", cut(&path, 120)) };
            let message = e.inner().message();
            let what = format!("{key}{}; {}", in_words(message), remedy(message, EXAMPLE));
            self.at(e.inner().span().unwrap_or(0..0), what)
        })
    }

    /// An error at a key, given by its path; the numbers of an array's members are written as text:
    /// `["measured", "0", "unit"]`. A key that the file omits is located at the nearest one above it.
    pub fn problem(&self, key: &[&str], message: impl Into<String>) -> TomlError {
        self.at(self.span(key), message.into())
    }

    /// `file:line:column` of a key.
    pub fn place(&self, key: &[&str]) -> String {
        let (line, column) = self.line_column(self.span(key).start);
        format!("{}:{line}:{column}", self.path.display())
    }

    /// Byte range of a key's value.
    fn span(&self, key: &[&str]) -> Range<usize> {
        let spans = self.spans.get_or_init(|| {
            let mut spans = BTreeMap::new();
            if let Ok(root) = DeTable::parse(&self.text) {
                let _ = each(root.get_ref(), &mut vec![], &mut |key, _, value| {
                    spans.insert(key.to_vec(), value.span());
                    None::<()>
                });
            }
            spans
        });
        let key: Vec<String> = key.iter().map(ToString::to_string).collect();
        (1..=key.len()).rev().find_map(|length| spans.get(&key[..length]).cloned()).unwrap_or(0..0)
    }

    fn line_column(&self, byte: usize) -> (usize, usize) {
        let before = self.text.get(..byte).unwrap_or(&self.text);
        let line = before.matches('\n').count() + 1;
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        (line, before[start..].chars().count() + 1)
    }

    fn at(&self, span: Range<usize>, message: String) -> TomlError {
        let (line, column) = self.line_column(span.start);
        let message = short(&controls::escaped(&message));
        let snippet = self.snippet(span, line, &message);
        TomlError { path: self.path.clone(), line, column, message, snippet }
    }

    /// The line between its neighbours with the span underlined, as miette draws it; of a span, the first line.
    fn snippet(&self, span: Range<usize>, line: usize, message: &str) -> String {
        let Some(rest) = self.text.get(span.start..) else { return String::new() };
        let mut shown = self.text.lines().skip(line.saturating_sub(2)).take(3);
        if self.text.is_empty() || shown.any(|l| l.len() > LINE_LIMIT) {
            return String::new();
        }
        let first = rest.find('\n').unwrap_or(rest.len());
        let length = (span.end - span.start).min(first);
        let label = miette::LabeledSpan::new(None, span.start, length);
        let report = miette::MietteDiagnostic::new(message).with_labels([label]);
        let name = self.path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let report =
            miette::Report::new(report).with_source_code(miette::NamedSource::new(name, controls::masked(&self.text)));
        let theme = miette::GraphicalTheme::unicode_nocolor();
        let handler = miette::GraphicalReportHandler::new_themed(theme).with_context_lines(1).without_cause_chain();
        let mut drawn = String::new();
        match handler.render_report(&mut drawn, report.as_ref()) {
            Ok(()) => drawn.lines().skip_while(|l| !l.contains('╭')).map(|l| format!("{}\n", l.trim_end())).collect(),
            Err(_) => String::new(),
        }
    }
}
