//! What a log's values say about the log: joints at rest, dead channels.
//!
//! Nothing here changes a value or stops the reading; each finding is one sentence.

use crate::model::{Joint, JointKind};
use crate::signal::extent;

/// A joint that stays within this range rests: sag and encoder noise, rad.
const REST_ANGLE: f64 = 2e-3;

/// The same for a prismatic joint, m.
const REST_LENGTH: f64 = 2e-4;

/// The rows of a log, after units and drives, before any resampling.
pub(super) struct Motion<'a> {
    pub q: &'a [Vec<f64>],
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
            if let Some(tau) = self.tau.and_then(|tau| tau.get(j)) {
                warnings.extend(torque_finding(&name, tau));
            }
        }
    }
}

/// Smallest and largest value; (0, 0) of nothing.
fn range(values: &[f64]) -> (f64, f64) {
    match values.is_empty() {
        true => (0.0, 0.0),
        false => extent(values),
    }
}

fn torque_finding(name: &str, tau: &[f64]) -> Option<String> {
    let (low, high) = range(tau);
    (low == high).then(|| format!("{name}: the torque is {low} in every row; its channel is dead."))
}
