//! What a log's values say about the log: joints at rest, wrong units, clipped torque.
//!
//! Nothing here changes a value or stops the reading; each finding is one sentence.

use super::table::Table;
use crate::model::{Joint, JointKind};

/// A joint that stays within this range rests: sag and encoder noise, rad.
const REST_ANGLE: f64 = 2e-3;

/// The same for a prismatic joint, m.
const REST_LENGTH: f64 = 2e-4;

/// More than two turns either way: rare in a robot, common in degrees; rad.
const FAR_ANGLE: f64 = 4.0 * std::f64::consts::PI;

/// Few robots are longer; m.
const FAR_LENGTH: f64 = 10.0;

const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

/// A run of this many rows at the largest value may be a limit.
const SHORTEST_CLIP: usize = 8;

/// The rows of a log, after units and drives, before any resampling.
pub(super) struct Motion<'a> {
    pub table: &'a Table,
    pub q: &'a [Vec<f64>],
    pub qd: Option<&'a [Vec<f64>]>,
    pub tau: Option<&'a [Vec<f64>]>,
}

impl Motion<'_> {
    /// Everything noticed, joint by joint.
    pub(super) fn check(
        &self,
        joints: &[Joint],
        encoder_resolution: Option<f64>,
        warnings: &mut Vec<String>,
    ) {
        for (j, joint) in joints.iter().enumerate() {
            let name = format!("Joint {} (`{}`)", j + 1, joint.name);
            let Some(q) = self.q.get(j) else { continue };
            let (low, high) = range(q);
            let rest = match joint.kind {
                JointKind::Revolute => REST_ANGLE,
                JointKind::Prismatic => REST_LENGTH,
            };
            let moves = high - low > rest.max(4.0 * encoder_resolution.unwrap_or(0.0));
            if !moves {
                let j = j + 1;
                warnings.push(format!(
                    "{name} never moves (its position stays within {:.2e}): FV{j}, FS{j}, IA{j} and \
                     the inertias that only its motion shows cannot be identified.",
                    high - low
                ));
            }
            let speed = self.qd.and_then(|qd| qd.get(j)).filter(|_| moves);
            let ratio = speed.and_then(|qd| speed_ratio(self.table.stamps(), q, qd));
            warnings.extend(ratio.and_then(|ratio| speed_finding(&name, ratio)));
            if !ratio.is_some_and(|ratio| (0.8..1.25).contains(&ratio)) {
                warnings.extend(far_finding(&name, joint.kind, low.abs().max(high.abs())));
            }
            if let Some(tau) = self.tau.and_then(|tau| tau.get(j)) {
                warnings.extend(self.torque_finding(&name, tau));
            }
        }
    }

    fn torque_finding(&self, name: &str, tau: &[f64]) -> Option<String> {
        let (low, high) = range(tau);
        if low == high {
            return Some(format!(
                "{name}: the torque is {low} in every row; its channel is dead."
            ));
        }
        let runs = runs(tau);
        let typical = tau.len() / runs.len().max(1);
        let clipped = |run: &&Run| {
            run.value != 0.0
                && (run.value == low || run.value == high)
                && run.len >= SHORTEST_CLIP.max(8 * typical)
        };
        let clips: Vec<&Run> = runs.iter().filter(clipped).collect();
        let first = clips.first()?;
        let rows: usize = clips.iter().map(|run| run.len).sum();
        Some(format!(
            "{name}: the torque looks clipped at {} in {rows} rows ({} runs, the first of {} rows at \
             {}); cut these parts away or expect a bias.",
            first.value,
            clips.len(),
            first.len,
            self.table.at(first.start)
        ))
    }
}

/// Smallest and largest value; (0, 0) of nothing.
fn range(values: &[f64]) -> (f64, f64) {
    let first = values.first().copied().unwrap_or(0.0);
    values.iter().fold((first, first), |(low, high), &value| {
        (low.min(value), high.max(value))
    })
}

/// Consecutive rows with one value.
struct Run {
    start: usize,
    len: usize,
    value: f64,
}

fn runs(values: &[f64]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (start, &value) in values.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if run.value == value => run.len += 1,
            _ => runs.push(Run {
                start,
                len: 1,
                value,
            }),
        }
    }
    runs
}

/// How many times larger the steps of q are than the integral of qd, by least squares; `None`
/// where noise hides how the two belong together.
fn speed_ratio(stamps: &[f64], q: &[f64], qd: &[f64]) -> Option<f64> {
    const ALIKE: f64 = 0.9;
    let (mut cross, mut of_qd, mut of_q) = (0.0, 0.0, 0.0);
    for ((t, q), qd) in stamps.windows(2).zip(q.windows(2)).zip(qd.windows(2)) {
        let expected = 0.5 * (qd[0] + qd[1]) * (t[1] - t[0]);
        let step = q[1] - q[0];
        cross += expected * step;
        of_qd += expected * expected;
        of_q += step * step;
    }
    let alike = cross * cross >= ALIKE * ALIKE * of_qd * of_q;
    (alike && of_qd > 0.0).then_some(cross / of_qd)
}

fn speed_finding(name: &str, ratio: f64) -> Option<String> {
    let near = |value: f64| (0.8..1.25).contains(&(ratio / value));
    let cause = if (0.5..2.0).contains(&ratio) {
        return None;
    } else if near(DEGREES_PER_RADIAN) {
        "q is in degrees and qd in rad/s; write unit = \"deg\" for q under [columns] of the log \
         companion"
    } else if near(1.0 / DEGREES_PER_RADIAN) {
        "qd is in degrees per second and q in rad; write unit = \"deg/s\" for qd under [columns] of \
         the log companion"
    } else if near(-1.0) {
        "q and qd have opposite signs; write gain = -1 for one of them under [columns] of the log \
         companion"
    } else {
        "their units, or their joints, do not belong together"
    };
    Some(format!(
        "{name}: q changes {ratio:.3} times as fast as qd says: {cause}."
    ))
}

fn far_finding(name: &str, kind: JointKind, farthest: f64) -> Option<String> {
    let (limit, here, likely, unit) = match kind {
        JointKind::Revolute => (FAR_ANGLE, "rad", "degrees", "deg"),
        JointKind::Prismatic => (FAR_LENGTH, "m", "millimetres", "mm"),
    };
    (farthest > limit).then(|| {
        format!(
            "{name} goes as far as {farthest:.1} {here}, which looks like {likely}; if it is, write \
             unit = \"{unit}\" under [columns] of the log companion."
        )
    })
}
