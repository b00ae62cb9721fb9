//! Robots in the format of SYMORO (`.par`), as its `parfile.py` reads it.
//!
//! Frames are modified Denavit-Hartenberg rows. Values are numbers, expressions or symbols: in the
//! geometry a symbol needs a value (`D3 = 0.4318` on a line of its own, which SYMORO overlooks);
//! an inertial parameter that is a symbol is not known.

mod document;
mod links;
mod rows;
mod values;

#[cfg(test)]
mod tests;

use super::check;
use super::code;
use super::description::{Description, DrivesSpec, Geometry, IdentifySpec};
use super::diagnostic::Diagnostic;
use super::findings::{Findings, finding};
use super::identifier;
use super::source;
use super::toml::hash;
use values::Values;

/// Largest `.par` that is read, bytes.
const MAX_BYTES: usize = 4 << 20;

/// Reads a `.par` text.
pub(super) fn read(text: &str, file: &str) -> Result<Description, Vec<Diagnostic>> {
    if text.len() > MAX_BYTES {
        let message = format!("larger than {} MiB", MAX_BYTES >> 20);
        let found = finding(code::FILE_TOO_LARGE, message).help("a robot takes a few lines");
        return Err(vec![found.on_file(file)]);
    }
    let mut to = Findings::new(text, file);
    let document = document::read(text, &mut to);
    let values = Values::new(&document, &mut to);
    let Some(counts) = rows::counts(&values, &mut to) else {
        return Err(to.decide().err().unwrap_or_default());
    };
    let (mut rows, snaps) = rows::read(&values, counts, &mut to);
    let loops = rows::loops(&mut rows, counts);
    links::inertial(&values, &mut rows, &mut to);
    let (effects, parameters) = links::effects(&values, &rows, &mut to);
    let gravity = links::gravity(&values, &mut to);
    links::left_out(&values, &mut to);
    let geometry = Geometry::Mdh(rows);
    check::something_moves(&check::joints(&geometry), &mut to);
    values.finish(&mut to);
    let warnings = to.decide()?;
    let name = document
        .name
        .map_or_else(|| source::stem(file), str::to_owned);
    Ok(Description {
        name: identifier::robot_name(&name),
        hash: hash(&[text]),
        gravity,
        lengths: Vec::new(),
        geometry,
        loops,
        effects,
        scaled: Vec::new(),
        identify: IdentifySpec::default(),
        drives: DrivesSpec::default(),
        parameters,
        prior: None,
        total_mass: None,
        links: Vec::new(),
        warnings,
        snaps,
    })
}
