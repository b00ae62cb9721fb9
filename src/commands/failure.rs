//! How a command fails: what, where, what to do, on standard error.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::output;
use idim::codegen::BuildError;
use idim::codegen::describe::{Diagnostic, Severity};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};

/// A reason for exit status 1 (or 2 for bad usage that only a command can see).
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A built-in robot that is not there.
    #[error("there is no robot called `{name}`")]
    UnknownRobot {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<&'static str>,
    },
    /// A description that cannot become a robot.
    #[error(transparent)]
    Description(#[from] BuildError),
    /// A log specification or log that cannot be read.
    #[error(transparent)]
    Log(#[from] idim::runtime::log::LogError),
    /// A part of a log that is not written as one.
    #[error(transparent)]
    Part(#[from] idim::runtime::log::SpecError),
    /// An identification that is not possible.
    #[error(transparent)]
    Identify(#[from] idim::runtime::identify::IdentifyError),
    /// A diagnosis that is not possible.
    #[error(transparent)]
    Diagnose(#[from] idim::runtime::diagnose::DiagnoseError),
    /// An exciting motion that is not possible.
    #[error(transparent)]
    Excite(#[from] idim::runtime::excite::ExciteError),
    /// A simulation that is not possible.
    #[error(transparent)]
    Simulate(#[from] idim::runtime::simulate::SimulateError),
    /// An export that is not possible.
    #[error(transparent)]
    Export(#[from] idim::exported::ExportError),
    /// A file of parameters that cannot be used.
    #[error("{path}: {message}")]
    Parameters {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        message: String,
    },
    /// A result that could not be written.
    #[error("{path}: {source}")]
    Write {
        /// Where to.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// Something asked for that does not go together.
    #[error("{message}")]
    Usage {
        /// What does not go together.
        message: String,
        /// What to do.
        help: String,
    },
    /// A robot that SYMORO's format cannot hold.
    #[error(transparent)]
    Par(#[from] idim::codegen::emit::ParError),
    /// A defect of the generator.
    #[error("{0}: please report this")]
    Defect(String),
}

impl Failure {
    /// Prints the failure and says how the program ends.
    pub fn show(&self) -> ExitCode {
        match self {
            Failure::Description(BuildError::Description(diagnostics)) => {
                for diagnostic in diagnostics {
                    output::complain(&format!("{:?}", report(diagnostic)));
                }
            }
            other => {
                let mut shown = MietteDiagnostic::new(other.to_string());
                shown.help = other.help();
                output::complain(&format!("{:?}", Report::new(shown)));
            }
        }
        match self {
            Failure::UnknownRobot { .. } | Failure::Usage { .. } | Failure::Part(_) => {
                ExitCode::from(2)
            }
            _ => ExitCode::from(1),
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            Failure::UnknownRobot { known, .. } => Some(format!(
                "built in are {}; or give the path of a .urdf, .toml or .par",
                known.join(", ")
            )),
            Failure::Usage { help, .. } => Some(help.clone()),
            _ => None,
        }
    }
}

/// A diagnostic with the lines of the file around it.
pub fn report(diagnostic: &Diagnostic) -> Report {
    let mut shown = MietteDiagnostic::new(diagnostic.message.clone()).with_code(diagnostic.code);
    if !diagnostic.help.is_empty() {
        shown = shown.with_help(diagnostic.help.clone());
    }
    if diagnostic.severity == Severity::Warning {
        shown = shown.with_severity(miette::Severity::Warning);
    }
    let text = std::fs::read_to_string(Path::new(&diagnostic.file)).ok();
    let place = text.as_deref().and_then(|text| offset(text, diagnostic));
    match (text, place) {
        (Some(text), Some(place)) => {
            let label = LabeledSpan::new_with_span(Some("here".into()), (place, 0));
            Report::new(shown.with_label(label))
                .with_source_code(NamedSource::new(&diagnostic.file, text))
        }
        _ => {
            shown.message = format!("{}: {}", diagnostic.file, shown.message);
            Report::new(shown)
        }
    }
}

/// Byte offset of a line and column that count from 1.
fn offset(text: &str, diagnostic: &Diagnostic) -> Option<usize> {
    let line = diagnostic.span.line.checked_sub(1)?;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let rest = text.get(start..)?.lines().next()?;
    let column = diagnostic.span.column.saturating_sub(1);
    let within: usize = rest.chars().take(column).map(char::len_utf8).sum();
    Some(start + within)
}
