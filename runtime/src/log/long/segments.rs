//! From the rows as the file has them to joint positions and torques that can be believed, segment
//! by segment.
//!
//! Segments overlap, so that each sample is judged with its surroundings; a finding on the border
//! of two is one finding.

use std::ops::Range;

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use super::super::checks::Motion;
use super::super::columns::Layout;
use super::super::doubt::{self, Finding};
use super::super::error::Found;
use super::super::read::{self, ReadOptions};
use super::super::speed::Pair;
use super::super::table::Table;
use super::Robot;
use super::spooling::Rows;
use crate::signal::extent;

/// Rows of a segment.
const SEGMENT: usize = 1 << 15;

/// Rows on either side of a segment that are looked at with it.
const MARGIN: usize = 1 << 12;

/// More segments than this at a time would only cost memory.
const MOST_AT_ONCE: usize = 4;

/// What the segments together say.
#[derive(Default)]
pub(super) struct Settled {
    /// Rows that cannot be believed, ascending and disjoint.
    pub doubtful: Vec<Range<usize>>,
    /// Smallest and largest position of each joint.
    pub range: Vec<(f64, f64)>,
}

/// Brings all rows to the joint side of the drives, bridges what cannot be believed, and checks
/// what remains; the spool then holds the result.
pub(super) fn settle(
    rows: &Rows,
    layout: &Layout,
    robot: Robot<'_>,
    encoder_resolution: Option<f64>,
    warnings: &mut Vec<String>,
) -> Found<Settled> {
    let whole = rayon::scope(|_| along(rows, layout, robot))?;
    Ok(whole.report(rows.first_row, robot, encoder_resolution, warnings))
}

fn along(rows: &Rows, layout: &Layout, robot: Robot<'_>) -> Found<Whole> {
    let starts: Vec<usize> = (0..rows.spool.rows).step_by(SEGMENT).collect();
    let at_once = rayon::current_num_threads().clamp(1, MOST_AT_ONCE);
    let settle = |(&start, room): (&usize, &mut Vec<Vec<f64>>)| {
        Segment::read(rows, start, layout, room)?.settle(layout, robot)
    };
    // Series that are not needed any more, for each segment that is worked on.
    let mut rooms: Vec<Vec<Vec<f64>>> = vec![Vec::new(); at_once];
    let mut whole = Whole::default();
    // Values are replaced only when the next segments, which overlap, have been read.
    let mut changed: Vec<Segment> = Vec::new();
    for starts in starts.chunks(at_once) {
        let segments = starts.par_iter().zip(&mut rooms).map(settle);
        let settled: Vec<Segment> = segments.collect::<Found<_>>()?;
        replace(&changed, rows, layout)?;
        changed.clear();
        for (mut segment, room) in settled.into_iter().zip(&mut rooms) {
            whole.take(&mut segment);
            match segment.changed {
                true => changed.push(segment),
                false => *room = segment.into_series(),
            }
        }
    }
    replace(&changed, rows, layout)?;
    Ok(whole)
}

fn replace(segments: &[Segment], rows: &Rows, layout: &Layout) -> Found<()> {
    let mut segments = segments.iter();
    segments.try_for_each(|segment| segment.write(rows, layout))
}

/// Some rows and their surroundings.
struct Segment {
    /// The rows that are settled here, counted from the first one read.
    core: Range<usize>,
    /// The first row read.
    first: usize,
    table: Table,
    q: Vec<Vec<f64>>,
    qd: Option<Vec<Vec<f64>>>,
    tau: Option<Vec<Vec<f64>>>,
    findings: Vec<Finding>,
    /// Smallest and largest values of the rows that are settled here: positions, torques.
    ranges: [Vec<(f64, f64)>; 2],
    changed: bool,
}

impl Segment {
    fn read(
        rows: &Rows,
        start: usize,
        layout: &Layout,
        room: &mut Vec<Vec<f64>>,
    ) -> Found<Segment> {
        let first = start.saturating_sub(MARGIN);
        let end = (start + SEGMENT).min(rows.spool.rows);
        let last = (end + MARGIN).min(rows.spool.rows);
        let column = |channel| {
            let room = room.pop().unwrap_or_default();
            rows.spool.read_into(channel, first..last, room)
        };
        let columns = (0..layout.channels.len()).map(column);
        Ok(Segment {
            core: start - first..end - first,
            first,
            table: Table {
                first_row: rows.first_row + first,
                columns: columns.collect::<Found<_>>()?,
            },
            q: Vec::new(),
            qd: None,
            tau: None,
            findings: Vec::new(),
            ranges: Default::default(),
            changed: false,
        })
    }

    fn settle(self, layout: &Layout, robot: Robot<'_>) -> Found<Segment> {
        // Missing values were counted over the whole log.
        let options = ReadOptions {
            require_torque: false,
            ..ReadOptions::default()
        };
        let of = (robot.joints, robot.drives);
        let rows = read::Rows::of(self.table, layout, of, &options, &mut Vec::new())?;
        let findings: Vec<Finding> = (rows.findings.into_iter())
            .map(|finding| within(finding, self.first, &self.core))
            .collect();
        let motor = layout.q.motor || layout.tau.as_ref().is_some_and(|tau| tau.motor);
        let mut settled = Segment {
            table: rows.table,
            q: rows.q,
            qd: rows.qd,
            tau: rows.tau,
            changed: motor || findings.iter().any(|finding| !finding.ranges.is_empty()),
            findings,
            ..self
        };
        let tau = settled.tau.as_deref().unwrap_or_default();
        settled.ranges = [&settled.q[..], tau].map(|series| settled.extents(series));
        Ok(settled)
    }

    /// Replaces the rows in the spool.
    fn write(&self, rows: &Rows, layout: &Layout) -> Found<()> {
        let groups = [
            (Some(&layout.q), Some(&self.q)),
            (layout.qd.as_ref(), self.qd.as_ref()),
            (layout.tau.as_ref(), self.tau.as_ref()),
        ];
        for (group, series) in groups.into_iter().filter_map(|(g, s)| g.zip(s)) {
            for (channel, values) in group.channels.clone().zip(series) {
                let core = values.get(self.core.clone()).unwrap_or_default();
                rows.spool
                    .write(channel, self.first + self.core.start, core)?;
            }
        }
        Ok(())
    }
}

impl Segment {
    fn into_series(self) -> Vec<Vec<f64>> {
        let optional = [self.qd, self.tau].into_iter().flatten().flatten();
        let all = self.table.columns.into_iter().chain(self.q).chain(optional);
        all.filter(|series| !series.is_empty()).collect()
    }

    /// The rows without their surroundings.
    fn core<'a>(&self, series: &'a [f64]) -> &'a [f64] {
        series.get(self.core.clone()).unwrap_or_default()
    }

    fn extents(&self, series: &[Vec<f64>]) -> Vec<(f64, f64)> {
        series.iter().map(|one| extent(self.core(one))).collect()
    }

    fn lively(&self) -> Lively {
        let cores = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
            series.iter().map(|one| self.core(one).to_vec()).collect()
        };
        Lively {
            table: Table {
                first_row: self.table.first_row + self.core.start,
                columns: vec![self.core(self.table.stamps()).to_vec()],
            },
            q: cores(&self.q),
            qd: self.qd.as_deref().map(cores),
            tau: self.tau.as_deref().map(cores),
        }
    }
}

/// A finding in the core of a segment, in rows of the log.
fn within(finding: Finding, first: usize, core: &Range<usize>) -> Finding {
    let inside = |range: Range<usize>| {
        let (start, end) = (range.start.max(core.start), range.end.min(core.end));
        (start < end).then(|| first + start..first + end)
    };
    Finding {
        ranges: finding.ranges.into_iter().filter_map(inside).collect(),
        ..finding
    }
}

/// What is known of all segments so far.
#[derive(Default)]
struct Whole {
    findings: Vec<Finding>,
    q: Vec<(f64, f64)>,
    tau: Vec<(f64, f64)>,
    /// The segment with the most motion, and how much that is.
    liveliest: Option<(f64, Lively)>,
}

/// A segment without its surroundings.
struct Lively {
    table: Table,
    q: Vec<Vec<f64>>,
    qd: Option<Vec<Vec<f64>>>,
    tau: Option<Vec<Vec<f64>>>,
}

impl Lively {
    /// Says where velocities do not go with positions. The whole log is not at hand any more, so
    /// that no unit is settled here.
    fn compare_speeds(&mut self, robot: Robot<'_>, warnings: &mut Vec<String>) {
        let Some(qd) = &mut self.qd else { return };
        let pairs = self.q.iter_mut().zip(qd).zip(robot.joints).enumerate();
        for (j, ((q, qd), joint)) in pairs {
            let pair = Pair {
                name: format!("Joint {} (`{}`)", j + 1, joint.name),
                kind: joint.kind,
                q,
                qd,
                q_stated: true,
                qd_stated: true,
            };
            warnings.extend(pair.settle(self.table.stamps()));
        }
    }
}

impl Whole {
    fn take(&mut self, segment: &mut Segment) {
        let found = std::mem::take(&mut segment.findings);
        if self.findings.is_empty() {
            self.findings = found;
        } else {
            for (all, found) in self.findings.iter_mut().zip(found) {
                all.append(found);
            }
        }
        let [q, tau] = &segment.ranges;
        widen(&mut self.q, q);
        widen(&mut self.tau, tau);
        let motion: f64 = q.iter().map(|(low, high)| high - low).sum();
        let most = self.liveliest.as_ref().map(|(most, _)| *most);
        if most.is_none_or(|most| motion > most) {
            self.liveliest = Some((motion, segment.lively()));
        }
    }

    /// Says what was found; units and limits are judged where the robot moves most.
    fn report(
        self,
        first_row: usize,
        robot: Robot<'_>,
        encoder_resolution: Option<f64>,
        warnings: &mut Vec<String>,
    ) -> Settled {
        let united = |finding: Finding| Finding {
            ranges: doubt::united(finding.ranges),
            ..finding
        };
        let findings = self.findings.into_iter().map(united).collect();
        let doubtful = doubt::report(first_row, findings, warnings);
        if let Some((_, mut lively)) = self.liveliest {
            lively.compare_speeds(robot, warnings);
            // Behind the rows of one segment, the extremes of all.
            extend(&mut lively.q, &self.q);
            extend(lively.tau.as_deref_mut().unwrap_or_default(), &self.tau);
            let motion = Motion {
                q: &lively.q,
                tau: lively.tau.as_deref(),
            };
            motion.check(robot.joints, encoder_resolution, warnings);
        }
        Settled {
            doubtful,
            range: self.q,
        }
    }
}

fn widen(ranges: &mut Vec<(f64, f64)>, more: &[(f64, f64)]) {
    ranges.resize(
        more.len().max(ranges.len()),
        (f64::INFINITY, f64::NEG_INFINITY),
    );
    for (range, (low, high)) in ranges.iter_mut().zip(more) {
        *range = (range.0.min(*low), range.1.max(*high));
    }
}

fn extend(series: &mut [Vec<f64>], ranges: &[(f64, f64)]) {
    for (series, (low, high)) in series.iter_mut().zip(ranges) {
        series.extend([low, high]);
    }
}
