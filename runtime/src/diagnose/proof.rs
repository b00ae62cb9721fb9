//! The gap before and after, on data that neither fitted nor confirmed.

use super::joined::Joined;
use super::state::{Bench, State};
use crate::model::JointKind;
use crate::report::{Fit, JointFit};

/// Torque error of a state along the rows of logs that count.
pub(super) fn fit(bench: &Bench<'_>, state: &State, joined: &Joined) -> Fit {
    let rows = bench.rows(state, joined);
    let (mut errors, mut totals) = (0.0, 0.0);
    let mut joints = Vec::with_capacity(rows.len());
    for (joint, (predicted, about)) in rows.iter().zip(bench.model.joints()).enumerate() {
        let measured = joined.measured(joint);
        let counted = joined.weights[joint]
            .iter()
            .zip(measured.iter().zip(predicted));
        let (mut error, mut total, mut count) = (0.0, 0.0, 0.0);
        for (_, (y, p)) in counted.filter(|(weight, _)| **weight > 0.0) {
            error += (y - p).powi(2);
            total += y * y;
            count += 1.0;
        }
        errors += error;
        totals += total;
        joints.push(JointFit {
            name: about.name.to_string(),
            unit: match about.kind {
                JointKind::Revolute => "N m",
                JointKind::Prismatic => "N",
            },
            rmse: (error / f64::max(count, 1.0)).sqrt(),
            rel_pct: percent(error, total),
        });
    }
    Fit {
        total_pct: percent(errors, totals),
        joints,
    }
}

fn percent(error: f64, total: f64) -> f64 {
    if total > 0.0 {
        100.0 * (error / total).sqrt()
    } else {
        0.0
    }
}
