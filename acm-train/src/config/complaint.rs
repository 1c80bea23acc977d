//! A refused value of an experiment file, with its key underlined.

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

/// One fault of an experiment: where, what, and what to do.
#[derive(Debug, Error, Diagnostic)]
#[error("{place}: {what}")]
pub struct Complaint {
    /// `file:line:column`, or the `--set` it came by.
    pub place: String,
    /// The key, its value, and why it cannot be.
    pub what: String,
    /// Remedy.
    #[help]
    pub help: String,
    /// The text around the key.
    #[source_code]
    pub text: NamedSource<String>,
    /// Where the key is in the text; a default that is refused has no place in it.
    #[label("this")]
    pub span: Option<SourceSpan>,
}
