//! From the text of a robot description to a checked [`Description`].
//!
//! Reading collects [`Diagnostic`]s and goes on; [`check`] decides. URDF, modified
//! Denavit-Hartenberg tables and SYMORO's `.par` end in the same type; nothing after this module
//! reads text.

pub mod angle;
pub mod check;
pub mod code;
pub mod description;
pub mod diagnostic;
mod expression;
mod findings;
pub mod identifier;
#[cfg(test)]
mod never_panics;
mod par;
pub mod shapes;
mod source;
mod suggest;
mod toml;
mod tree;
mod urdf;

pub use description::*;
pub use diagnostic::{Diagnostic, Severity, Span};
pub use source::Kind;

use crate::mechanism;
use findings::{Finding, finding};
use std::path::Path;

/// Reads a robot from a file: `.urdf`, `.par`, or `.toml` (which may name a URDF beside it).
///
/// # Errors
/// Every mistake that was found, in the order of the text; warnings are in the description.
pub fn read_path(path: &Path) -> Result<Description, Vec<Diagnostic>> {
    let file = path.display().to_string();
    let text = source::text_of(path, &file)?;
    let kind = Kind::of(path, &text).map_err(|found| vec![found.on_file(&file)])?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let load = |named: &str| {
        let path = folder.join(named);
        // The place in the file is lost here; what remains says enough to go and look.
        source::text_of(&path, named).map_err(|all| match all.first() {
            Some(first) if first.span.line > 0 => {
                format!("line {}: {}", first.span.line, first.message)
            }
            Some(first) => first.message.clone(),
            None => String::new(),
        })
    };
    read_text(&text, &file, kind, &load)
}

/// The kind of a description by its file name, or by its text where the name does not tell.
///
/// # Errors
/// One diagnostic for a format that is not a robot description.
pub fn kind_of(path: &Path, text: &str) -> Result<Kind, Vec<Diagnostic>> {
    let file = path.display().to_string();
    Kind::of(path, text).map_err(|found| vec![found.on_file(&file)])
}

/// The text of a description file: UTF-8, of a sane size.
///
/// # Errors
/// One diagnostic for a file that cannot be read, is too large or is no text.
pub fn text_of(path: &Path) -> Result<String, Vec<Diagnostic>> {
    source::text_of(path, &path.display().to_string())
}

/// Reads a robot from a text that the user knows as `file`; `load` gives the text of the URDF that
/// a TOML names, by the path as it is written there.
///
/// # Errors
/// Every mistake that was found, in the order of the text; warnings are in the description.
pub fn read_text(
    text: &str,
    file: &str,
    kind: Kind,
    load: &dyn Fn(&str) -> Result<String, String>,
) -> Result<Description, Vec<Diagnostic>> {
    let text = source::without_mark(text);
    if text.len() as u64 > source::MAX_BYTES {
        let message = format!("larger than {} MiB", source::MAX_BYTES >> 20);
        return Err(vec![finding(code::FILE_TOO_LARGE, message).on_file(file)]);
    }
    let description = match kind {
        Kind::Urdf => toml::read_bare(text, file),
        Kind::Toml => toml::read(text, file, load),
        Kind::Par => par::read(text, file),
    }?;
    match unsolved(&description) {
        Some((span, found)) => Err(vec![found.at(file, span)]),
        None => Ok(description),
    }
}

/// A closed loop that is not modelled, with its place.
fn unsolved(description: &Description) -> Option<(Span, Finding)> {
    let why = mechanism::unsolved(description)?;
    let named = |one: &&LoopSpec| Some(one.name.as_str()) == why.name();
    let stated = description.loops.iter().find(named).map(|one| one.span);
    let rows = match &description.geometry {
        Geometry::Mdh(rows) => rows.as_slice(),
        Geometry::Urdf(_) => &[],
    };
    let passive = rows.iter().find(|row| row.drive == Drive::Passive);
    let span = stated.or(passive.map(|row| row.span));
    let help = "leave its cut out and give every joint a drive for the model of the open tree";
    Some((
        span.unwrap_or_default(),
        finding(code::CLOSED_LOOP, why.to_string()).help(help),
    ))
}
