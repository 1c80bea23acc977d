//! A refused value of an experiment file, with its key underlined.

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

/// Fault of an experiment, with its place and advice.
#[derive(Debug, Error, Diagnostic)]
#[error("{place}: {what}")]
pub struct Complaint {
    /// Place of the fault: `file:line:column`, or the `--set` that it came by.
    pub place: String,
    /// The key, its value, and why it cannot be.
    pub what: String,
    /// Advice to the user.
    #[help]
    pub help: String,
    /// The text around the key.
    #[source_code]
    pub text: NamedSource<String>,
    /// Place of the key in the text; none for a default that is refused.
    #[label("this")]
    pub span: Option<SourceSpan>,
}
