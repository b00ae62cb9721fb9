//! Where results go: standard output that may be closed, files that are written whole.

use std::io::Write;
use std::path::{Path, PathBuf};

use idim_runtime::whole::Whole;
use serde::Serialize;

use super::Failure;

/// Prints a text; a reader that went away (`| head`) is no error.
///
/// # Errors
/// [`Failure::Write`] when standard output cannot be written for another reason.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Write {
            path: "standard output".into(),
            source: error,
        }),
        _ => Ok(()),
    }
}

/// Prints a message on standard error; if that is closed there is nobody to tell.
pub fn complain(message: &str) {
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Writes a file by way of a temporary one beside it, so that it is there whole or not at all.
///
/// # Errors
/// [`Failure::Write`] when the folder or the file cannot be written.
pub fn write_whole(path: &Path, text: &str) -> Result<(), Failure> {
    place(path, temporary(path, text)?)
}

/// Writes files that belong together: none takes its place before all are written.
///
/// # Errors
/// [`Failure::Write`] when the folder or one of the files cannot be written.
pub fn write_all_whole(texts: &[(PathBuf, String)]) -> Result<(), Failure> {
    let written = texts.iter().map(|(path, text)| temporary(path, text));
    let written = written.collect::<Result<Vec<_>, Failure>>()?;
    let mut pairs = texts.iter().zip(written);
    pairs.try_for_each(|((path, _), file)| place(path, file))
}

fn temporary(path: &Path, text: &str) -> Result<Whole, Failure> {
    let failed = |source| failed(path, source);
    let mut file = Whole::begin(path).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    Ok(file)
}

fn place(path: &Path, file: Whole) -> Result<(), Failure> {
    file.place().map_err(|source| failed(path, source))
}

fn failed(path: &Path, source: std::io::Error) -> Failure {
    Failure::Write {
        path: path.to_owned(),
        source,
    }
}

/// A result as JSON to a file, or to standard output for `-`.
///
/// # Errors
/// [`Failure::Write`].
pub fn json(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::Defect(format!("a result is not JSON: {error}")))?;
    text.push('\n');
    self::text(path, &text)
}

/// A text to a file, or to standard output for `-`.
///
/// # Errors
/// [`Failure::Write`].
pub fn text(path: &Path, text: &str) -> Result<(), Failure> {
    if path == Path::new("-") {
        print(text)
    } else {
        write_whole(path, text)
    }
}

/// The command line of this program as one would type it.
pub fn command_line() -> String {
    let arguments = std::env::args_os().skip(1);
    let words = arguments.map(|word| quoted(&word.to_string_lossy()));
    std::iter::once("idim".to_owned())
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

/// A word for a shell, in quotes if it has to be.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,=:@#%+".contains(c);
    // A word that begins with # would be a comment.
    match !word.is_empty() && !word.starts_with('#') && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

/// Whether a file asked for is `-`, which claims standard output for itself.
pub fn claims_stdout(file: Option<&Path>) -> bool {
    file == Some(Path::new("-"))
}
