//! From a log and its companion to a checked [`Recording`].

use std::ops::Range;
use std::path::PathBuf;

use super::checks::Motion;
use super::closed_loop::Reference;
use super::columns::{self, Group, Layout};
use super::companion::Companion;
use super::doubt::{self, Doubts, Finding};
use super::drives;
use super::error::{Found, LogError, Problem};
use super::grid::{Grid, Stamped};
use super::lookup::{Channel, Lookup};
use super::naming::QD;
use super::recording::Recording;
use super::source::{self, Source};
use super::spec::LogSpec;
use super::speed::Pair;
use super::table::{self, Table};
use crate::model::Joint;
use crate::settings::Drives;
use crate::signal::all_finite;

/// What the reader must find, and where it looks.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// A log without torque, without drive gains for its currents, or with holes in the torque is
    /// an error; otherwise it is read without torque.
    pub require_torque: bool,
    /// The log companion, if it is not the one beside the log.
    pub companion: Option<PathBuf>,
}

impl Default for ReadOptions {
    /// With torque, and the companion beside the log if there is one.
    fn default() -> Self {
        ReadOptions {
            require_torque: true,
            companion: None,
        }
    }
}

/// Reads a log, or a part of it: columns and units resolved, torque at the joints, checked, on a
/// uniform time grid. Everything odd that does not stop the reading is in the recording's warnings.
///
/// Uniform stamps leave the samples untouched; others are interpolated linearly onto
/// `t[0] + k / rate` after the part is cut out. A `q1_ref..` in the log becomes the companion's
/// reference if that has none.
///
/// # Errors
/// [`LogError::Log`] with the [`Problem`] in the file, [`LogError::Companion`],
/// [`LogError::CompanionFile`], [`LogError::CompanionRobot`] for those of its companion.
pub fn read(
    spec: &LogSpec,
    joints: &[Joint],
    drives: &Drives,
    options: &ReadOptions,
) -> Result<(Recording, Companion), LogError> {
    let file = spec.path.display().to_string();
    let in_log = |problem| LogError::Log {
        file: file.clone(),
        problem,
    };
    let Opened {
        source,
        mut companion,
        layout,
        mut warnings,
    } = open(spec, joints, drives, options)?;
    let table = table::read(source, &layout, spec.part, &mut warnings).map_err(in_log)?;
    check_finite(&table, &layout.channels, 0..1).map_err(in_log)?;
    let grid = grid(&table, spec, &companion, &mut warnings).map_err(in_log)?;
    let robot = (joints, drives);
    let mut rows = Rows::of(table, &layout, robot, options, &mut warnings).map_err(in_log)?;
    let findings = std::mem::take(&mut rows.findings);
    let doubtful = doubt::report(rows.table.first_row, findings, &mut warnings);
    rows.settle_speeds(joints, &companion, &mut warnings);
    rows.motion()
        .check(joints, companion.encoder_resolution, &mut warnings);
    if let (None, Some(q_ref)) = (&companion.reference, rows.q_ref.take()) {
        companion.reference = Some(Reference::Sampled {
            q: grid.apply(rows.table.stamps(), q_ref),
        });
    }
    Ok((rows.recording(spec, &grid, &doubtful, warnings), companion))
}

/// A log whose columns are known, and none of its rows.
pub(super) struct Opened {
    pub source: Source,
    pub companion: Companion,
    pub layout: Layout,
    pub warnings: Vec<String>,
}

/// Opens a log and finds its columns, with the help of its companion.
pub(super) fn open(
    spec: &LogSpec,
    joints: &[Joint],
    drives: &Drives,
    options: &ReadOptions,
) -> Result<Opened, LogError> {
    let file = spec.path.display().to_string();
    let in_log = |problem| LogError::Log {
        file: file.clone(),
        problem,
    };
    columns::check_drives(drives, joints.len()).map_err(in_log)?;
    let source = source::open(&spec.path).map_err(in_log)?;
    let companion = companion(spec, options)?;
    companion.check_joints(joints.len())?;
    let mut warnings = Vec::new();
    let lookup = Lookup {
        file: &file,
        header: &source.header,
        companion: &companion,
        joints,
        drives,
        require_torque: options.require_torque,
    };
    let layout = lookup.layout(&mut warnings)?;
    Ok(Opened {
        source,
        companion,
        layout,
        warnings,
    })
}

fn grid(
    table: &Table,
    spec: &LogSpec,
    companion: &Companion,
    warnings: &mut Vec<String>,
) -> Found<Grid> {
    let differs = |k: &&usize| table.columns.iter().any(|c| c.get(**k) != c.get(**k - 1));
    let rows = Stamped {
        stamps: &table.stamps(),
        first_row: table.first_row,
        differ: &|rows| rows.iter().filter(differs).count(),
    };
    Grid::of(&rows, spec.part, companion.rate_hz, warnings)
}

fn companion(spec: &LogSpec, options: &ReadOptions) -> Result<Companion, LogError> {
    if let Some(path) = &options.companion {
        return Companion::load(path);
    }
    let beside = spec.companion_path();
    if beside.is_file() && beside != spec.path {
        return Companion::load(&beside);
    }
    Ok(Companion::default())
}

/// The rows of the part, one series per joint.
pub(super) struct Rows {
    /// Only the stamps are left in it.
    pub table: Table,
    pub q: Vec<Vec<f64>>,
    pub qd: Option<Vec<Vec<f64>>>,
    pub tau: Option<Vec<Vec<f64>>>,
    q_ref: Option<Vec<Vec<f64>>>,
    /// What cannot be believed of it, and was bridged.
    pub findings: Vec<Finding>,
}

impl Rows {
    pub fn of(
        mut table: Table,
        layout: &Layout,
        (joints, drives): (&[Joint], &Drives),
        options: &ReadOptions,
        warnings: &mut Vec<String>,
    ) -> Found<Rows> {
        check_finite(&table, &layout.channels, layout.q.channels.clone())?;
        if let (Some(tau), true) = (&layout.tau, options.require_torque) {
            check_finite(&table, &layout.channels, tau.channels.clone())?;
        }
        let mut optional = |group: &Option<Group>, warnings: &mut Vec<String>| {
            let group = group.as_ref()?;
            let finite = check_finite(&table, &layout.channels, group.channels.clone());
            let unused = |why| warnings.push(format!("These columns are not used: {why}."));
            finite.map_err(unused).ok()?;
            Some(take(&mut table, group))
        };
        let mut qd = optional(&layout.qd, warnings);
        let mut reported = optional(&layout.tau, warnings);
        let q_ref = optional(&layout.q_ref, warnings);
        let mut q = take(&mut table, &layout.q);
        // On the side of the drive where they were measured: behind a coupling one bad channel
        // spoils several joints.
        let mut doubts = Doubts {
            joints,
            findings: Vec::new(),
        };
        doubts.positions(&mut q);
        doubts.velocities(qd.as_deref_mut().unwrap_or_default());
        if layout.q.motor {
            q = drives::joint_positions(drives, q)?;
        }
        let alone = drives.coupling.is_empty();
        let moves_with = |joint: usize| match q.get(joint) {
            Some(q) if alone => vec![q.as_slice()],
            _ => q.iter().map(Vec::as_slice).collect(),
        };
        doubts.torques(reported.as_deref_mut().unwrap_or_default(), moves_with);
        let findings = doubts.findings;
        let motor = layout.tau.as_ref().is_some_and(|tau| tau.motor);
        let tau = match reported {
            Some(reported) if motor => Some(drives::joint_torques(drives, reported)),
            joint_side => joint_side,
        };
        Ok(Rows {
            table,
            q,
            qd,
            tau,
            q_ref,
            findings,
        })
    }

    /// Velocities and positions in units that show to be others than SI are put into it.
    fn settle_speeds(
        &mut self,
        joints: &[Joint],
        companion: &Companion,
        warnings: &mut Vec<String>,
    ) {
        let Some(qd) = &mut self.qd else { return };
        let pairs = joints.iter().zip(self.q.iter_mut().zip(qd)).enumerate();
        for (j, (joint, (q, qd))) in pairs {
            let pair = Pair {
                name: format!("Joint {} (`{}`)", j + 1, joint.name),
                kind: joint.kind,
                q,
                qd,
                q_stated: companion.states_position(j, joints),
                qd_stated: companion.states_unit(&QD, j, joints),
            };
            warnings.extend(pair.settle(self.table.stamps()));
        }
    }

    fn recording(
        self,
        spec: &LogSpec,
        grid: &Grid,
        doubtful: &[Range<usize>],
        warnings: Vec<String>,
    ) -> Recording {
        let stamps = self.table.columns.into_iter().next().unwrap_or_default();
        let doubtful = grid.samples(|row| stamps.get(row).copied(), doubtful);
        Recording {
            doubtful,
            name: spec.name.clone(),
            stem: spec.stem(),
            rate_hz: grid.rate_hz,
            start: grid.start,
            len: grid.len,
            q: grid.apply(&stamps, self.q),
            qd: self.qd.map(|qd| grid.apply(&stamps, qd)),
            tau: self.tau.map(|tau| grid.apply(&stamps, tau)),
            stamps,
            warnings,
        }
    }

    pub fn motion(&self) -> Motion<'_> {
        Motion {
            q: &self.q,
            tau: self.tau.as_deref(),
        }
    }
}

/// Moves a group's columns out of the table.
fn take(table: &mut Table, group: &Group) -> Vec<Vec<f64>> {
    let columns = table
        .columns
        .get_mut(group.channels.clone())
        .unwrap_or_default();
    columns.iter_mut().map(std::mem::take).collect()
}

/// Whether all values of these channels are finite.
fn check_finite(table: &Table, channels: &[Channel], group: Range<usize>) -> Found<()> {
    for place in group {
        let (Some(values), Some(channel)) = (table.columns.get(place), channels.get(place)) else {
            continue;
        };
        let mut bad = NotFinite::default();
        bad.count(table.first_row, values);
        bad.bearable(place, values.len(), channel)?;
    }
    Ok(())
}

/// The values of a channel that are no finite numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct NotFinite {
    pub count: usize,
    /// The first data rows.
    rows: Vec<usize>,
}

impl NotFinite {
    /// Rows listed, and one more that shows that there are more.
    const LISTED: usize = 3;

    /// Counts those among values that begin at a data row.
    pub fn count(&mut self, first_row: usize, values: &[f64]) {
        if all_finite(values) {
            return;
        }
        for (k, _) in values.iter().enumerate().filter(|(_, v)| !v.is_finite()) {
            self.count += 1;
            if self.rows.len() < Self::LISTED {
                self.rows.push(first_row + k);
            }
        }
    }

    /// Moves the rows, counted from the first, to a data row where they begin.
    pub fn begin_at(&mut self, first_row: usize) {
        self.rows.iter_mut().for_each(|row| *row += first_row);
    }

    /// Whether so few of `len` values can be borne in the channel at `place` of the layout.
    pub fn bearable(&self, place: usize, len: usize, channel: &Channel) -> Found<()> {
        // A few can be bridged; in the time there is nothing to bridge from.
        let bearable = if place == 0 { 0.0 } else { doubt::BEARABLE };
        if self.count as f64 <= bearable * len as f64 {
            return Ok(());
        }
        let rows: Vec<String> = self.rows.iter().map(usize::to_string).collect();
        let more = if self.count > Self::LISTED {
            ", ..."
        } else {
            ""
        };
        Err(Problem::NotFinite {
            column: channel.name.clone(),
            count: self.count,
            rows: format!("{}{more}", rows.join(", ")),
        })
    }
}
