//! How well parameters explain torque.

use crate::evidence::Evidence;
use crate::model::{IdentificationModel, JointKind};
use crate::report::{Fit, JointFit};

/// Error of the torque of each joint and of all: \\( 100 \|\tau - W X\| / \|\tau\| \\) on the
/// filtered, decimated signals.
pub(super) fn torque(
    model: &dyn IdentificationModel,
    evidence: &Evidence,
    parameters: &[f64],
) -> Fit {
    let errors = Squares::of(evidence, parameters);
    let joints = errors.iter().zip(model.joints());
    let joints = joints.map(|(error, joint)| JointFit {
        name: joint.name.to_string(),
        unit: unit(joint.kind),
        rmse: error.rmse(),
        rel_pct: error.rel_pct(),
    });
    Fit {
        total_pct: Squares::sum(&errors).rel_pct(),
        joints: joints.collect(),
    }
}

/// Unit of the torque of a joint.
pub(super) fn unit(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "N m",
        JointKind::Prismatic => "N",
    }
}

/// Error of all equations together, in percent of the measurements.
pub(super) fn equations(evidence: &Evidence, parameters: &[f64]) -> f64 {
    let errors = Squares::of(evidence, parameters);
    Squares::sum(&errors).rel_pct()
}

/// Sums of squares over equations.
struct Squares {
    rows: usize,
    residual: f64,
    measured: f64,
}

impl Squares {
    /// Of each joint.
    fn of(evidence: &Evidence, parameters: &[f64]) -> Vec<Self> {
        let residuals = evidence.residual_squares(parameters);
        let measured = evidence.residual_squares(&[]);
        let total = |of: &[Vec<f64>], joint: usize| of.iter().map(|block| block[joint]).sum();
        let rows = evidence.joint_rows().into_iter().enumerate();
        rows.map(|(joint, rows)| Squares {
            rows,
            residual: total(&residuals, joint),
            measured: total(&measured, joint),
        })
        .collect()
    }

    fn sum(all: &[Squares]) -> Self {
        Squares {
            rows: all.iter().map(|s| s.rows).sum(),
            residual: all.iter().map(|s| s.residual).sum(),
            measured: all.iter().map(|s| s.measured).sum(),
        }
    }

    fn rmse(&self) -> f64 {
        (self.residual / self.rows.max(1) as f64).sqrt()
    }

    /// Zero when there is nothing to explain and nothing is predicted.
    fn rel_pct(&self) -> f64 {
        match self.residual {
            0.0 => 0.0,
            residual => 100.0 * (residual / self.measured).sqrt(),
        }
    }
}
