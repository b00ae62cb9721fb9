//! What is wrong with a description: what, where, and what to do.

use std::fmt;

/// A place in a text, counted from 1; line 0 means the file as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
}

/// Whether a model can still be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// No model: the description contradicts itself or cannot be read.
    Error,
    /// A model, but something a person should know.
    Warning,
}

/// One finding about a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable code, such as `IDIM012`, documented in the book.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// File as the user named it.
    pub file: String,
    /// Where in the file.
    pub span: Span,
    /// What is wrong, naming the element.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.span.line > 0 {
            write!(f, ":{}:{}", self.span.line, self.span.column)?;
        }
        let word = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, ": {word} [{}]: {}", self.code, self.message)?;
        if !self.help.is_empty() {
            write!(f, "\n  help: {}", self.help)?;
        }
        Ok(())
    }
}
