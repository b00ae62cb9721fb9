//! Diagnostics of one text, collected while reading goes on.

use super::diagnostic::{Diagnostic, Severity, Span};
use super::suggest;

/// Positions are looked up from checkpoints this many bytes apart, so that a file of one single
/// line costs no more than any other.
const STRIDE: usize = 1024;

/// What a person reads before giving up on the rest.
const MAX_SHOWN: usize = 50;

/// From byte offsets to lines and columns.
struct Places<'t> {
    text: &'t [u8],
    checkpoints: Vec<Span>,
}

impl<'t> Places<'t> {
    fn new(text: &'t str) -> Self {
        let text = text.as_bytes();
        let mut at = Span { line: 1, column: 1 };
        let mut checkpoints = Vec::with_capacity(text.len() / STRIDE + 1);
        for chunk in text.chunks(STRIDE) {
            checkpoints.push(at);
            at = advance(at, chunk);
        }
        checkpoints.push(at);
        Places { text, checkpoints }
    }

    fn at(&self, offset: usize) -> Span {
        let offset = offset.min(self.text.len());
        let first = offset / STRIDE;
        match (
            self.checkpoints.get(first),
            self.text.get(first * STRIDE..offset),
        ) {
            (Some(&from), Some(between)) => advance(from, between),
            _ => Span::default(),
        }
    }
}

/// The place after `bytes`; continuation bytes of UTF-8 are no columns of their own.
fn advance(mut at: Span, bytes: &[u8]) -> Span {
    for byte in bytes {
        if *byte == b'\n' {
            at = Span {
                line: at.line + 1,
                column: 1,
            };
        } else if byte & 0xC0 != 0x80 {
            at.column += 1;
        }
    }
    at
}

/// A message and what to do about it.
pub(crate) struct Finding {
    code: &'static str,
    message: String,
    help: String,
}

/// A finding without help yet.
pub(crate) fn finding(code: &'static str, message: impl Into<String>) -> Finding {
    Finding {
        code,
        message: message.into(),
        help: String::new(),
    }
}

impl Finding {
    /// Says what to do about it.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }

    /// The error at a place of a file.
    pub(crate) fn at(self, file: &str, span: Span) -> Diagnostic {
        self.diagnostic(Severity::Error, file, span)
    }

    /// The error on a file as a whole, before it has places.
    pub(crate) fn on_file(self, file: &str) -> Diagnostic {
        self.diagnostic(Severity::Error, file, Span::default())
    }

    fn diagnostic(self, severity: Severity, file: &str, span: Span) -> Diagnostic {
        let Finding {
            code,
            message,
            help,
        } = self;
        Diagnostic {
            code,
            severity,
            file: file.to_owned(),
            span,
            message,
            help,
        }
    }
}

/// The diagnostics of one text.
pub(crate) struct Findings<'t> {
    file: String,
    places: Places<'t>,
    list: Vec<Diagnostic>,
}

impl<'t> Findings<'t> {
    /// No findings yet about `text`, which the user knows as `file`.
    pub(crate) fn new(text: &'t str, file: &str) -> Self {
        Findings {
            file: file.to_owned(),
            places: Places::new(text),
            list: Vec::new(),
        }
    }

    /// The line and column of a byte offset.
    pub(crate) fn span(&self, offset: usize) -> Span {
        self.places.at(offset)
    }

    /// Records an error at a byte offset.
    pub(crate) fn error(&mut self, offset: usize, finding: Finding) {
        self.error_at(self.span(offset), finding);
    }

    /// Records an error at a place that is already known.
    pub(crate) fn error_at(&mut self, span: Span, finding: Finding) {
        self.list
            .push(finding.diagnostic(Severity::Error, &self.file, span));
    }

    /// Records a warning at a byte offset.
    pub(crate) fn warn(&mut self, offset: usize, finding: Finding) {
        self.warn_at(self.span(offset), finding);
    }

    /// Records a warning at a place that is already known.
    pub(crate) fn warn_at(&mut self, span: Span, finding: Finding) {
        self.list
            .push(finding.diagnostic(Severity::Warning, &self.file, span));
    }

    /// How many errors there are so far.
    pub(crate) fn errors(&self) -> usize {
        self.list
            .iter()
            .filter(|one| one.severity == Severity::Error)
            .count()
    }

    /// How many errors there are whose code starts with `group`.
    pub(crate) fn errors_of_group(&self, group: &str) -> usize {
        let within = |one: &&Diagnostic| one.code.starts_with(group);
        self.list
            .iter()
            .filter(|one| one.severity == Severity::Error)
            .filter(within)
            .count()
    }

    /// Help for a misspelt name. None once there are more errors than are shown: comparing every
    /// wrong name with every right one would take for ever.
    pub(crate) fn suggest<'c>(&self, word: &str, names: impl Iterator<Item = &'c str>) -> String {
        if self.list.len() >= MAX_SHOWN {
            return String::new();
        }
        suggest::help(word, &names.collect::<Vec<_>>())
    }

    /// The warnings if there is no error, otherwise the errors, in the order of the text.
    pub(crate) fn decide(mut self) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        self.list
            .sort_by_key(|one| (one.span.line, one.span.column));
        let failed = self.errors() > 0;
        if failed {
            self.list.retain(|one| one.severity == Severity::Error);
        }
        if self.list.len() > MAX_SHOWN {
            let more = self.list.len() - MAX_SHOWN;
            self.list.truncate(MAX_SHOWN);
            if let Some(last) = self.list.last_mut() {
                last.help = format!("{} (and {more} more like these)", last.help);
            }
        }
        if failed {
            Err(self.list)
        } else {
            Ok(self.list)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_and_lines_from_one() {
        let text = "é=1\n\u{1F916}x";
        let places = Places::new(text);
        assert_eq!(places.at(0), Span { line: 1, column: 1 });
        assert_eq!(places.at(2), Span { line: 1, column: 2 });
        assert_eq!(places.at(5), Span { line: 2, column: 1 });
        assert_eq!(places.at(9), Span { line: 2, column: 2 });
        assert_eq!(places.at(999), Span { line: 2, column: 3 });
    }

    #[test]
    fn places_beyond_a_checkpoint_equal_a_walk_from_the_start() {
        let text = "añb\ncd ".repeat(900);
        let places = Places::new(&text);
        for (offset, _) in text.char_indices() {
            let walked = advance(Span { line: 1, column: 1 }, &text.as_bytes()[..offset]);
            assert_eq!(places.at(offset), walked);
        }
    }
}
