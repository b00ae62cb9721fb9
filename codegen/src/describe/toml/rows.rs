//! `[[joint]]`: the rows of a modified Denavit-Hartenberg table.

use super::super::angle;
use super::super::check::{self, Known, Named};
use super::super::code;
use super::super::description::{Drive, Limits, MdhRow, Motion, Quantity, Snap};
use super::super::findings::{Findings, finding};
use super::joint::{self, Extras};
use super::table::{Table, Value};
use super::value;

/// Rows, what they say beside the geometry, and the angles that were snapped.
pub(super) struct Rows {
    /// The table.
    pub(super) rows: Vec<MdhRow>,
    /// Effects, gains of each row.
    pub(super) extras: Vec<Extras>,
    /// Angles taken as multiples of pi/2.
    pub(super) snaps: Vec<Snap>,
}

const KINDS: [(&str, Motion); 3] = [
    ("revolute", Motion::Revolute),
    ("prismatic", Motion::Prismatic),
    ("fixed", Motion::Fixed),
];

/// Reads all rows, and goes on after a bad one.
pub(super) fn read(values: &[Value<'_>], lengths: &[(String, f64)], to: &mut Findings) -> Rows {
    let mut all = Rows {
        rows: Vec::new(),
        extras: Vec::new(),
        snaps: Vec::new(),
    };
    let mut names = Vec::new();
    for (index, value) in values.iter().enumerate() {
        let Some(table) = Table::from_value(value, &format!("joint {}", index + 1), to) else {
            continue;
        };
        let mut reader = RowReader {
            table,
            lengths,
            snaps: &mut all.snaps,
        };
        let (row, extras) = reader.read(index, to);
        reader.table.finish(to);
        names.push(Named {
            name: row.name.clone(),
            span: row.span,
        });
        all.rows.push(row);
        all.extras.push(extras);
    }
    let names: Vec<&Named> = names.iter().collect();
    check::unique("joint", &names, to);
    check::identifiers(&names, to);
    all
}

/// Reads a row, or a frame of a loop.
pub(super) struct RowReader<'r, 't> {
    /// Its keys.
    pub(super) table: Table<'t>,
    /// Named lengths.
    pub(super) lengths: &'r [(String, f64)],
    /// Angles taken as multiples of pi/2.
    pub(super) snaps: &'r mut Vec<Snap>,
}

impl RowReader<'_, '_> {
    fn read(&mut self, index: usize, to: &mut Findings) -> (MdhRow, Extras) {
        let span = to.span(self.table.offset);
        let name = self.name(index, to);
        let motion = self.motion(to);
        let row = MdhRow {
            ant: self.antecedent(index, to),
            gamma: self.angle("gamma", &name, to),
            b: self.length("b", to),
            alpha: self.angle("alpha", &name, to),
            d: self.length("d", to),
            theta: self.angle("theta", &name, to),
            r: self.length("r", to),
            inertial: None,
            drive: joint::drive(&mut self.table, to),
            limits: joint::limits(&mut self.table, to),
            name,
            motion,
            span,
        };
        let extras = joint::extras(&mut self.table, to);
        joint::check_motion(&Known::of_row(&row), &extras, self.table.offset, to);
        (row, extras)
    }

    /// A frame behind `rows` rows, fixed to one of them, or a joint that turns in its place.
    pub(super) fn frame(&mut self, rows: usize, motion: Motion, to: &mut Findings) -> MdhRow {
        let name = self.table.name.clone();
        // Which of the rows it hangs on cannot be guessed.
        self.table.need("ant", to);
        MdhRow {
            ant: self.antecedent(rows, to),
            gamma: self.angle("gamma", &name, to),
            b: self.length("b", to),
            alpha: self.angle("alpha", &name, to),
            d: self.length("d", to),
            theta: self.angle("theta", &name, to),
            r: self.length("r", to),
            drive: Drive::Passive,
            inertial: None,
            limits: Limits::default(),
            span: to.span(self.table.offset),
            name,
            motion,
        }
    }

    fn name(&mut self, index: usize, to: &mut Findings) -> String {
        let fallback = format!("joint{}", index + 1);
        let Some(value) = self.table.get("name") else {
            return fallback;
        };
        match value::text(value, &self.table.path("name"), to) {
            Some(name) if name.trim().is_empty() => {
                let message = format!("the name of {} is empty", self.table.name);
                to.error(value.span().start, finding(code::NAME_MISSING, message));
                fallback
            }
            Some(name) => {
                self.table.name = format!("joint `{name}`");
                name.to_owned()
            }
            None => fallback,
        }
    }

    fn motion(&mut self, to: &mut Findings) -> Motion {
        let kind = self.table.need("kind", to);
        kind.and_then(|value| value::word(value, &self.table.path("kind"), &KINDS, to))
            .unwrap_or(Motion::Revolute)
    }

    /// The row that this one hangs on: by default the one before.
    fn antecedent(&mut self, index: usize, to: &mut Findings) -> usize {
        let Some(value) = self.table.get("ant") else {
            return index;
        };
        let what = self.table.path("ant");
        let Some(ant) = value::count_within(value, &what, (0, usize::MAX), to) else {
            return index;
        };
        if ant > index {
            let message = format!("{what} is {ant}, which is not an earlier row");
            let help = format!("0 is the base, 1 the first row; here 0 to {index} are possible");
            to.error(
                value.span().start,
                finding(code::ANTECEDENT, message).help(help),
            );
            return index;
        }
        ant
    }

    fn length(&mut self, key: &'static str, to: &mut Findings) -> Quantity {
        let Some(value) = self.table.get(key) else {
            return zero();
        };
        let what = self.table.path(key);
        let Some(found) = value::quantity(value, &what, self.lengths, to) else {
            return zero();
        };
        if found.value.abs() > check::DOUBTFUL_LENGTH {
            to.warn(
                value.span().start,
                check::doubtful_length(&what, found.value),
            );
        }
        found
    }

    fn angle(&mut self, key: &'static str, joint: &str, to: &mut Findings) -> Quantity {
        let Some(value) = self.table.get(key) else {
            return zero();
        };
        let what = self.table.path(key);
        let Some(found) = value::quantity(value, &what, self.lengths, to) else {
            return zero();
        };
        if found.value.abs() > check::DOUBTFUL_ANGLE {
            to.warn(
                value.span().start,
                check::doubtful_angle(&what, found.value),
            );
        }
        let (snapped, Some(turns)) = angle::snap(found.value) else {
            return found;
        };
        if (snapped - found.value).abs() <= angle::REPORTED {
            return Quantity {
                value: snapped,
                ..found
            };
        }
        let text = angle::quarter_turns(turns);
        self.snaps.push(Snap {
            joint: joint.to_owned(),
            from: found.value,
            to: text.clone(),
        });
        Quantity {
            value: snapped,
            text,
        }
    }
}

fn zero() -> Quantity {
    Quantity {
        value: 0.0,
        text: "0".to_owned(),
    }
}
