//! Where a model's torque jumps: the switching surfaces of dry friction, found by evaluation.

use super::lanes::Lanes;
use super::linear::dot;
use crate::model::{Entry, IdentificationModel, Output};

/// Distance from a surface at which its two sides are evaluated, relative to the velocities: far
/// above rounding of a sum of velocities, far below every smooth change.
const SIDE: f64 = 1e-12;

/// A signal that changes by more than this across a surface jumps. Smooth ones change by the
/// distance of the sides, even a tanh of 1e-5 rad/s only by 1e-7.
const JUMP: f64 = 1e-6;

/// Random states at which every direction is tried.
const TRIALS: usize = 3;

/// A plane \\( a^T \dot q = 0 \\) across which some entries of D jump.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// Direction a, one component per joint: 0, 1 or -1.
    pub direction: Vec<f64>,
    /// The joint, if a is a joint axis.
    pub joint: Option<usize>,
    /// The entries of D that jump here and nowhere else; parameters that are zero left out.
    pub entries: Vec<Entry>,
}

impl Surface {
    /// \\( a^T \dot q \\), rad/s or m/s.
    pub(super) fn speed(&self, qd: &[f64]) -> f64 {
        match self.joint {
            Some(joint) => qd[joint],
            None => dot(&self.direction, qd),
        }
    }

    /// Takes the component along a out of a velocity or acceleration.
    pub(super) fn project(&self, qd: &mut [f64]) {
        match self.joint {
            Some(joint) => qd[joint] = 0.0,
            None => {
                let factor = -self.speed(qd) / dot(&self.direction, &self.direction);
                super::linear::add(qd, factor, &self.direction);
            }
        }
    }

    /// Moves a state onto one side (+1 or -1) of the surface; `qd` is its present velocity.
    pub(super) fn side(&self, lanes: &mut Lanes, state: usize, qd: &[f64], side: f64) {
        let distance = SIDE * qd.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
        match self.joint {
            Some(joint) => lanes.set_velocity(state, joint, side * distance),
            None => {
                let norm = dot(&self.direction, &self.direction);
                let factor = (side * distance - self.speed(qd)) / norm;
                lanes.push(state, factor, &self.direction);
            }
        }
    }
}

/// Finds the surfaces of a model, and the entries of D that jump nowhere. Entries whose parameter
/// is zero are in neither.
pub(super) fn find(
    model: &dyn IdentificationModel,
    parameters: &[f64],
) -> (Vec<Surface>, Vec<Entry>) {
    let pattern = model.pattern(Output::Explicit);
    let mut owner: Vec<Option<usize>> = vec![None; pattern.signals];
    let mut surfaces = directions(model.joints().len());
    let mut lanes = Lanes::new(model, Output::Explicit, 2);
    let slip = slips(model);
    for (index, surface) in surfaces.iter().enumerate() {
        for trial in 0..TRIALS {
            let (q, mut qd) = state(surface.direction.len(), trial);
            surface.project(&mut qd);
            lanes.fill(2, &q, &qd);
            surface.side(&mut lanes, 0, &qd, 1.0);
            surface.side(&mut lanes, 1, &qd, -1.0);
            lanes.run(model, &slip);
            for (signal, owner) in owner.iter_mut().enumerate() {
                let (plus, minus) = (lanes.signal(signal, 0), lanes.signal(signal, 1));
                let jumps = (plus - minus).abs() > JUMP * plus.abs().max(1.0);
                if jumps && owner.is_none() {
                    *owner = Some(index);
                }
            }
        }
    }
    let mut smooth = Vec::new();
    for entry in pattern
        .entries
        .iter()
        .filter(|entry| parameters[entry.column] != 0.0)
    {
        match owner[entry.signal] {
            Some(index) => surfaces[index].entries.push(*entry),
            None => smooth.push(*entry),
        }
    }
    surfaces.retain(|surface| !surface.entries.is_empty());
    (surfaces, smooth)
}

/// Presliding states of all joints, none of them deflected; empty for a model that has none.
pub(super) fn slips(model: &dyn IdentificationModel) -> Vec<f64> {
    match model.presliding() {
        [] => Vec::new(),
        _ => vec![0.0; model.joints().len()],
    }
}

/// The directions that are tried: every joint, then sum and difference of every two joints.
fn directions(joints: usize) -> Vec<Surface> {
    let surface = |parts: &[(usize, f64)]| {
        let mut direction = vec![0.0; joints];
        parts
            .iter()
            .for_each(|&(joint, part)| direction[joint] = part);
        let joint = if parts.len() == 1 {
            Some(parts[0].0)
        } else {
            None
        };
        Surface {
            direction,
            joint,
            entries: Vec::new(),
        }
    };
    let mut all: Vec<Surface> = (0..joints).map(|joint| surface(&[(joint, 1.0)])).collect();
    for i in 0..joints {
        for k in i + 1..joints {
            all.push(surface(&[(i, 1.0), (k, 1.0)]));
            all.push(surface(&[(i, 1.0), (k, -1.0)]));
        }
    }
    all
}

/// A fixed state with nothing special about it: positions of either sign, velocities of either
/// sign between 0.5 and 1.5 (golden-ratio sequence).
fn state(joints: usize, trial: usize) -> (Vec<f64>, Vec<f64>) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let number = |k: usize| ((trial * 2 * joints + k + 1) as f64 * GOLDEN).fract();
    let q = (0..joints).map(|k| 3.0 * number(k) - 1.5).collect();
    let speed = |k: usize| {
        let x = 2.0 * number(joints + k) - 1.0;
        x + 0.5f64.copysign(x)
    };
    (q, (0..joints).map(speed).collect())
}
