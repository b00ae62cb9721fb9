//! Robots in TOML: a modified Denavit-Hartenberg table, or the companion of a URDF.
//!
//! The text is walked with the place of every key and value at hand, so that several mistakes are
//! reported at once, each with line, column and the nearest word that would have been right.

mod effects;
mod frame;
mod joint;
mod links;
mod loops;
mod named;
mod options;
mod rest;
mod rows;
mod table;
mod value;

#[cfg(test)]
mod tests;

use super::check;
use super::code;
use super::description::{Description, EffectSpec};
use super::diagnostic::{Diagnostic, Span};
use super::findings::{Finding, Findings, finding};
use super::identifier;
use super::source;
use crate::catalogue::EffectKind;
use ::toml::de::DeTable;
use frame::Frame;
use rest::Rest;
use sha2::{Digest, Sha256};
use table::Table;

/// Largest TOML that is read, bytes.
const MAX_BYTES: usize = 4 << 20;

/// An effect with its default shape on a joint.
pub(super) fn plain_effect(kind: EffectKind, joint: &str, span: Span) -> EffectSpec {
    effects::Wanted::plain(kind, span).on(joint)
}

type Load<'l> = &'l dyn Fn(&str) -> Result<String, String>;

/// Reads a TOML text; `load` gives the text of the URDF that it names.
pub(super) fn read(text: &str, file: &str, load: Load) -> Result<Description, Vec<Diagnostic>> {
    if let Some(found) = not_toml(text) {
        return Err(vec![found.on_file(file)]);
    }
    let mut findings = Findings::new(text, file);
    let (document, mistakes) = DeTable::parse_recoverable(text);
    // Later ones are mostly consequences.
    if let Some(mistake) = mistakes.first() {
        let offset = mistake.span().map_or(0, |span| span.start);
        let first_line = mistake.message().lines().next().unwrap_or("not TOML");
        findings.error(offset, finding(code::TOML_SYNTAX, first_line));
        return Err(findings.decide().err().unwrap_or_default());
    }
    let mut table = Table::new(document.get_ref(), "", 0);
    let path = table.get("urdf");
    let path = path.and_then(|value| Some((value, value::text(value, "`urdf`", &mut findings)?)));
    let Some((value, path)) = path else {
        return describe(table, None, text, file, findings);
    };
    match load(path) {
        Ok(urdf) => {
            let beside = source::beside(file, path);
            let urdf = (source::without_mark(&urdf), beside.as_str());
            describe(table, Some(urdf), text, file, findings)
        }
        Err(why) => {
            let found = finding(
                code::FILE_UNREADABLE,
                format!("cannot read `{path}`: {why}"),
            );
            let help = "a path is relative to the file that names it";
            findings.error(value.span().start, found.help(help));
            Err(findings.decide().err().unwrap_or_default())
        }
    }
}

/// Why a text is not worth parsing.
fn not_toml(text: &str) -> Option<Finding> {
    if text.len() > MAX_BYTES {
        let message = format!("larger than {} MiB", MAX_BYTES >> 20);
        return Some(finding(code::FILE_TOO_LARGE, message).help("a robot takes a few lines"));
    }
    let xml = text.trim_start().starts_with('<');
    xml.then(|| finding(code::FILE_CONTENT, "this is XML, not TOML").help("name it .urdf"))
}

/// Reads a URDF without a companion.
pub(super) fn read_bare(urdf: &str, file: &str) -> Result<Description, Vec<Diagnostic>> {
    let empty = DeTable::new();
    let table = Table::new(&empty, "", 0);
    describe(table, Some((urdf, file)), "", file, Findings::new("", file))
}

/// Reads everything from a table, and from the text and file of a URDF if there is one.
fn describe(
    mut table: Table<'_>,
    urdf: Option<(&str, &str)>,
    text: &str,
    file: &str,
    mut to: Findings,
) -> Result<Description, Vec<Diagnostic>> {
    let lengths = table
        .get("lengths")
        .map(|value| named::lengths(value, &mut to));
    let lengths = lengths.unwrap_or_default();
    let name = table.get("name");
    let name = name.and_then(|value| value::text(value, "`name`", &mut to));
    let frame = match urdf {
        Some((urdf, file)) => frame::from_urdf(&mut table, urdf, file, &mut to),
        None => Ok(frame::from_rows(&mut table, &lengths, &mut to)),
    };
    let frame = match frame {
        Ok(frame) => frame,
        Err(mut errors) => {
            errors.extend(to.decide().err().unwrap_or_default());
            return Err(errors);
        }
    };
    let joints = check::joints(&frame.geometry);
    // Where joints could not be read, their absence is no news.
    if !joints.is_empty() || to.errors() == 0 {
        check::something_moves(&joints, &mut to);
    }
    let rest = Rest::read(&mut table, &joints, &frame, &lengths, &mut to);
    table.finish(&mut to);
    let mut warnings = to.decide()?;
    warnings.extend(frame.warnings.iter().cloned());
    let name = name
        .or(frame.name.as_deref())
        .map_or_else(|| source::stem(file), str::to_owned);
    let name = identifier::robot_name(&name);
    let hash = hash(&[text, urdf.map_or("", |(urdf, _)| urdf)]);
    Ok(assemble(name, hash, lengths, frame, rest, warnings))
}

fn assemble(
    name: String,
    hash: String,
    lengths: Vec<(String, f64)>,
    frame: Frame,
    rest: Rest,
    warnings: Vec<Diagnostic>,
) -> Description {
    Description {
        name,
        hash,
        gravity: rest.gravity,
        lengths,
        geometry: frame.geometry,
        loops: frame.loops,
        effects: rest.effects,
        scaled: rest.scaled,
        identify: rest.identify,
        drives: rest.drives,
        parameters: rest.parameters,
        prior: rest.prior,
        total_mass: rest.total_mass,
        links: rest.links,
        warnings,
        snaps: frame.snaps,
    }
}

/// SHA-256 of the texts one after the other, as `cat` and `sha256sum` give it.
pub(super) fn hash(texts: &[&str]) -> String {
    let mut hasher = Sha256::new();
    for text in texts {
        hasher.update(text.as_bytes());
    }
    hasher
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
