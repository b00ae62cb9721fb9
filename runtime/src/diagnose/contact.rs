//! When something touched the robot: stretches of a log in which a joint's torque is further from
//! what the model allows than anywhere else.
//!
//! A joint that moves has the model's torque; one that is at rest, or nearly, any torque that its
//! friction can hold. What is beyond either is summed over windows of several lengths and compared
//! with the spread of the same sums over the whole log, so that an error of the model, which is
//! there all the time, is no contact. What is there all the time is left to the other effects.

use std::ops::Range;

use super::joined::Joined;
use super::rest::Rested;
use super::track::Track;
use crate::model::{ColumnKind, IdentificationModel, JointKind, Output};
use crate::observe::{Motion, contract};
use crate::report::{Contact, Touched};

/// Speed below which friction may be anything up to its value at this speed, rad/s or m/s:
/// presliding and stiction are over well before.
const SLOW: f64 = 0.02;

/// How long before and after such a speed that holds, s.
const AROUND: f64 = 0.15;

/// By how much more friction may hold than the model's, and the share of the load that is not
/// known better at rest.
const STICTION: f64 = 1.3;
const LOAD: f64 = 0.05;

/// Lengths of the windows, s: each twice the one before.
const SHORTEST: f64 = 0.1;
const LENGTHS: usize = 6;

/// Robust standard deviations from which a sum is contact.
const CONTACT: f64 = 10.0;

/// Those down to which it reaches before and after; and inside one that shows only over a longer
/// window.
const EDGE: f64 = 3.5;
const WEAK: f64 = 1.5;

/// Stretches nearer to each other are one, s.
const APART: f64 = 0.3;

/// What a joint's torque is known to at least, as a share of its largest.
const FLOOR: f64 = 0.002;

/// The same for a joint that hardly moves, which shows no spread.
const AT_REST: f64 = 0.02;

/// Share of the log that contact may take: what lasts longer is no event.
const EVENT: f64 = 0.5;

/// Rows of a moving joint that its spread needs.
const ENOUGH: usize = 50;

/// A stretch of rows with contact, and the joints that feel it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Window {
    pub rows: Range<usize>,
    /// Joint, largest torque beyond what the model allows, and how many standard deviations.
    pub joints: Vec<(usize, f64, f64)>,
}

/// Logs with what their joints' friction can hold.
pub(super) struct Look<'a> {
    model: &'a dyn IdentificationModel,
    joined: &'a Joined,
    /// By joint: friction of the model along the rows, what it can hold, and whether it may.
    friction: Vec<Vec<f64>>,
    holds: Vec<Vec<f64>>,
    slow: Vec<Vec<bool>>,
    /// Rows that cannot be believed.
    doubtful: Vec<bool>,
}

impl<'a> Look<'a> {
    pub fn new(
        model: &'a dyn IdentificationModel,
        joined: &'a Joined,
        parameters: &[f64],
    ) -> Look<'a> {
        let own = model.columns().iter().zip(parameters);
        let friction: Vec<f64> = own
            .map(|(column, value)| match column.kind {
                ColumnKind::Friction | ColumnKind::Effect => *value,
                ColumnKind::Inertial | ColumnKind::Drive => 0.0,
            })
            .collect();
        let mut look = Look {
            model,
            joined,
            friction: joined.product(&friction),
            holds: vec![Vec::new(); joined.joints()],
            slow: vec![Vec::new(); joined.joints()],
            doubtful: Vec::new(),
        };
        for track in &joined.tracks {
            let holds = holds(model, track, &friction);
            let slow = slow(track);
            for joint in 0..joined.joints() {
                look.holds[joint].extend(track.at_rows(&holds[joint]));
                look.slow[joint].extend_from_slice(&slow[joint]);
            }
            look.doubtful.extend(track.doubtful_rows());
        }
        look
    }

    /// Torque of a joint beyond what the model allows, given what it predicts.
    fn beyond(&self, joint: usize, predicted: &[f64]) -> Vec<f64> {
        let measured = self.joined.measured(joint);
        let rows = measured.iter().zip(predicted).enumerate();
        rows.map(|(row, (y, p))| {
            if self.doubtful[row] {
                return 0.0;
            }
            if !self.slow[joint][row] {
                return y - p;
            }
            let free = p - self.friction[joint][row];
            let holds = STICTION * self.holds[joint][row] + LOAD * free.abs();
            y - y.clamp((free - holds).min(*p), (free + holds).max(*p))
        })
        .collect()
    }

    /// The stretches with contact, given the torque that the model predicts along the rows.
    pub fn windows(&self, predicted: &[Vec<f64>]) -> Vec<Window> {
        let joints: Vec<Felt> = (0..self.joined.joints())
            .map(|joint| self.felt(joint, &predicted[joint]))
            .collect();
        let inside = |row: usize| joints.iter().any(|felt| felt.inside(row));
        let strong = |row: usize| joints.iter().any(|felt| felt.strength[row] > CONTACT);
        let gap = self.rows_of(APART);
        let of_segment = |segment| stretched(segment, gap, (&inside, &strong));
        let segments = self.joined.segments.iter();
        let stretches: Vec<Range<usize>> = segments.flat_map(of_segment).collect();
        let rows: usize = stretches.iter().map(Range::len).sum();
        if rows as f64 > EVENT * self.joined.rows() as f64 {
            return Vec::new();
        }
        let window = |rows: Range<usize>| {
            let touched = joints.iter().enumerate();
            let touched = touched.filter_map(|(joint, felt)| felt.touched(joint, rows.clone()));
            Window {
                joints: touched.collect(),
                rows,
            }
        };
        stretches.into_iter().map(window).collect()
    }

    fn rows_of(&self, seconds: f64) -> usize {
        let step = self.joined.tracks.first().map_or(1.0, Track::step);
        (seconds / step).round().max(1.0) as usize
    }

    /// What a joint feels along the rows.
    fn felt(&self, joint: usize, predicted: &[f64]) -> Felt {
        let beyond = self.beyond(joint, predicted);
        let measured = self.joined.measured(joint);
        let largest = measured.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        let mut felt = Felt {
            strength: vec![0.0; beyond.len()],
            at_once: Vec::new(),
            beyond,
        };
        for k in 0..LENGTHS {
            let len = self.rows_of(SHORTEST * f64::from(1_u32 << k));
            let means = self.means(&felt.beyond, len);
            let spread = self.spread(joint, &means, largest);
            for (rows, mean) in means {
                let z = mean.abs() / spread;
                let strength = &mut felt.strength[rows];
                strength.iter_mut().for_each(|s| *s = s.max(z));
            }
            if k == 0 {
                felt.at_once.clone_from(&felt.strength);
            }
        }
        felt
    }

    /// The means over all windows of a length inside the logs.
    fn means(&self, series: &[f64], len: usize) -> Vec<(Range<usize>, f64)> {
        let mean = |start: usize| {
            let rows = start..start + len;
            let sum: f64 = series[rows.clone()].iter().sum();
            (rows, sum / len as f64)
        };
        let segments = self.joined.segments.iter();
        let starts = segments.flat_map(|rows| rows.start..(rows.end + 1).saturating_sub(len));
        starts.map(mean).collect()
    }

    /// Standard deviation of the means of a joint while it moves; where it hardly moves, what its
    /// torque is known to.
    fn spread(&self, joint: usize, means: &[(Range<usize>, f64)], largest: f64) -> f64 {
        let moves = |rows: &Range<usize>| rows.clone().all(|row| !self.slow[joint][row]);
        let moving = means.iter().filter(|(rows, _)| moves(rows));
        let moving: Vec<f64> = moving.map(|(_, mean)| mean.abs()).collect();
        match moving.len() >= ENOUGH {
            true => (1.4826 * median(moving)).max(FLOOR * largest),
            false => AT_REST * largest,
        }
        .max(f64::MIN_POSITIVE)
    }

    /// The stretches as they are reported.
    pub fn contacts(&self, windows: &[Window]) -> Vec<Contact> {
        windows
            .iter()
            .filter_map(|window| self.contact(window))
            .collect()
    }

    fn contact(&self, window: &Window) -> Option<Contact> {
        let segments = self.joined.tracks.iter().zip(&self.joined.segments);
        let mut own = segments.filter(|(_, rows)| rows.contains(&window.rows.start));
        let (track, rows) = own.next()?;
        let start = track.source.recording.start;
        let time = |row: usize| start + track.row_time(row - rows.start);
        let touched = |&(joint, torque, sigmas): &(usize, f64, f64)| Touched {
            joint: self.model.joints()[joint].name.to_string(),
            number: joint + 1,
            torque,
            unit: match self.model.joints()[joint].kind {
                JointKind::Revolute => "N m".to_owned(),
                JointKind::Prismatic => "N".to_owned(),
            },
            sigmas,
        };
        Some(Contact {
            log: track.motion.log.clone(),
            from_s: time(window.rows.start),
            to_s: time(window.rows.end - 1),
            joints: window.joints.iter().map(touched).collect(),
        })
    }
}

/// What a joint feels along the rows: in standard deviations over windows of any length and over
/// the shortest, and as torque beyond what the model allows.
struct Felt {
    strength: Vec<f64>,
    at_once: Vec<f64>,
    beyond: Vec<f64>,
}

impl Felt {
    /// Whether a row is part of a contact, if there is one.
    fn inside(&self, row: usize) -> bool {
        let weak = self.strength[row] > CONTACT && self.at_once[row] > WEAK;
        weak || self.at_once[row] > EDGE
    }

    /// Largest torque and strength in a stretch, if the joint feels contact there.
    fn touched(&self, joint: usize, rows: Range<usize>) -> Option<(usize, f64, f64)> {
        let most = self.strength[rows.clone()]
            .iter()
            .copied()
            .fold(0.0, f64::max);
        let larger = |top: f64, x: &f64| if x.abs() > top.abs() { *x } else { top };
        let torque = self.beyond[rows].iter().fold(0.0, larger);
        (most > CONTACT).then_some((joint, torque, most))
    }
}

/// Stretches of rows inside contacts, joined where they are near each other, that are strong
/// somewhere.
fn stretched(
    segment: &Range<usize>,
    gap: usize,
    (inside, strong): (&dyn Fn(usize) -> bool, &dyn Fn(usize) -> bool),
) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    for row in segment.clone().filter(|&row| inside(row)) {
        match all.last_mut() {
            Some(last) if row - last.end < gap => last.end = row + 1,
            _ => all.push(row..row + 1),
        }
    }
    all.retain(|rows| rows.clone().any(strong));
    all
}

/// What friction can hold on each joint along a track, at its full rate: its size at a small speed
/// in either direction.
fn holds(model: &dyn IdentificationModel, track: &Track, friction: &[f64]) -> Vec<Vec<f64>> {
    let rested = Rested::new(model, vec![0.0; model.joints().len()]);
    let along = |side: f64| {
        let constant = |value: f64| vec![vec![value; track.motion.len]; model.joints().len()];
        let motion = Motion {
            qd: constant(side * SLOW),
            qdd: constant(0.0),
            slip: track
                .motion
                .slip
                .iter()
                .map(|s| vec![side; s.len()])
                .collect(),
            ..track.motion.clone()
        };
        contract(&rested, Output::Explicit, &motion, friction)
    };
    let (mut up, down) = (along(1.0), along(-1.0));
    for (up, down) in up.iter_mut().zip(&down) {
        let pairs = up.iter_mut().zip(down);
        pairs.for_each(|(up, down)| *up = up.abs().max(down.abs()));
    }
    up
}

/// Whether each joint moves at the rows of logs.
pub(super) fn moving(joined: &Joined) -> Vec<Vec<bool>> {
    let mut all: Vec<Vec<bool>> = vec![Vec::new(); joined.joints()];
    for track in &joined.tracks {
        for (all, slow) in all.iter_mut().zip(slow(track)) {
            all.extend(slow.into_iter().map(|slow| !slow));
        }
    }
    all
}

/// The rows of each joint at which it is slow, or a moment before or after.
fn slow(track: &Track) -> Vec<Vec<bool>> {
    let around = (AROUND * track.motion.rate_hz).round() as usize;
    let joint = |(qd, band): (&Vec<f64>, &f64)| {
        let limit = SLOW.max(*band);
        let mut slow = vec![0.0; qd.len()];
        for (at, _) in qd.iter().enumerate().filter(|(_, v)| v.abs() < limit) {
            let near = at.saturating_sub(around)..(at + around + 1).min(qd.len());
            slow[near].iter_mut().for_each(|s| *s = 1.0);
        }
        let rows = track.at_rows(&slow).into_iter();
        rows.map(|s| s > 0.5).collect()
    };
    track
        .motion
        .qd
        .iter()
        .zip(&track.dead_band)
        .map(joint)
        .collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
