//! How good answers are, against the truth.

use idim::runtime::report::Verdict;

use super::answer::{Answer, Said};
use super::truth::{Category, TrueEffect, Truth};

/// Near relatives: a wrong name among them is a near miss, and counted as one.
const RELATIVES: [&[&str]; 10] = [
    &["stribeck", "presliding", "backlash"],
    &["nonlinear_viscous", "stribeck"],
    &[
        "torque_ripple",
        "encoder_eccentricity",
        "position_dependent_friction",
    ],
    &[
        "drive_gain",
        "load_dependent_friction",
        "drive_saturation",
        "drive_dead_zone",
    ],
    &[
        "payload",
        "base_tilt",
        "external_force",
        "link_length",
        "rotor_inertia",
    ],
    &["time_shift", "joint_elasticity"],
    &["spring", "end_stop", "torque_ripple"],
    &["torque_offset", "spring"],
    &["torque_offset", "viscous_asymmetry"],
    &["friction_drift", "nonlinear_viscous"],
];

/// Most names that a group of indistinguishable effects may have to count as an answer.
const GROUP: usize = 3;

/// The gap is only spoken of where the described robot is worse than the truth by this factor.
const GAP: f64 = 1.1;

/// A case with what was said of it.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The truth.
    pub truth: Truth,
    /// What was said.
    pub answer: Answer,
}

impl Scored {
    /// The first effect named, if the verdict stands by it.
    pub fn first(&self) -> Option<&Said> {
        let named = self.answer.verdict == Verdict::Named;
        self.answer.effects.first().filter(|_| named)
    }

    /// What was said in one word: the first name, `nothing` or `unknown`.
    pub fn word(&self) -> &str {
        match (self.first(), self.answer.verdict) {
            (Some(said), _) => &said.effect,
            (None, Verdict::Unknown) => "unknown",
            (None, _) => "nothing",
        }
    }

    /// Name of the strongest hidden effect, or what else the case is.
    pub fn hidden(&self) -> &str {
        match (self.truth.category, self.truth.effects.first()) {
            (Category::One, Some(effect)) => &effect.effect,
            (Category::Nothing, _) => "nothing",
            (Category::Outside, _) => "outside",
            _ => "two",
        }
    }

    /// Whether the first name is that of the only hidden effect.
    pub fn right(&self) -> bool {
        self.word() == self.hidden()
    }

    /// Whether the truth is the first name or one of at most three that it is said to be
    /// indistinguishable from.
    pub fn grouped(&self) -> bool {
        let within = |said: &Said| {
            said.same.len() <= GROUP && said.same.iter().any(|name| name == self.hidden())
        };
        self.right() || self.first().is_some_and(within)
    }

    /// Whether the first name is at least a near relative of the truth.
    pub fn related(&self) -> bool {
        let near = |said: &Said| {
            let both = |all: &&&[&str]| {
                all.contains(&said.effect.as_str()) && all.contains(&self.hidden())
            };
            RELATIVES.iter().any(|all| both(&all))
        };
        self.grouped() || self.first().is_some_and(near)
    }

    /// Whether every hidden effect is named.
    pub fn all_named(&self) -> bool {
        let said = |name: &str| self.answer.effects.iter().any(|said| said.effect == name);
        self.answer.verdict == Verdict::Named
            && self.truth.effects.iter().all(|effect| said(&effect.effect))
    }

    /// For each hidden effect that is named, whether on the right joints.
    pub fn joints(&self) -> Vec<bool> {
        let found = |effect: &TrueEffect| {
            let mut all = self
                .answer
                .effects
                .iter()
                .filter(|said| said.effect == effect.effect);
            let any = all.clone().next().is_some();
            any.then(|| all.any(|said| said.joints == effect.joints))
        };
        match self.answer.verdict {
            Verdict::Named => self.truth.effects.iter().filter_map(found).collect(),
            _ => Vec::new(),
        }
    }

    /// Share of the torque gap that is closed, of what the true structure closes; where there is
    /// one.
    pub fn closed(&self) -> Option<f64> {
        if !matches!(self.truth.category, Category::One | Category::Two) {
            return None;
        }
        let joints = self.gap_joints();
        let error = |rmse: &[f64]| {
            let relative = joints.iter().map(|&j| rmse[j] / self.truth.scale[j]);
            (relative.map(|e| e * e).sum::<f64>() / joints.len() as f64).sqrt()
        };
        let [null, oracle, after] = [
            error(&self.truth.rmse_null),
            error(&self.truth.rmse_oracle),
            error(&self.answer.rmse_after),
        ];
        (null > GAP * oracle).then(|| (null - after) / (null - oracle))
    }

    /// The same of the closed-loop position, against the true robot without noise.
    pub fn position_closed(&self) -> Option<f64> {
        let [before, after] = self.answer.position.as_ref()?;
        let best = &self.truth.position_best;
        let joints = self.gap_joints();
        if best.is_empty() || !matches!(self.truth.category, Category::One | Category::Two) {
            return None;
        }
        let error = |rms: &[f64]| joints.iter().map(|&j| rms[j] * rms[j]).sum::<f64>().sqrt();
        let [before, after, best] = [error(before), error(after), error(best)];
        (before > 2.0 * GAP * best).then(|| (before - after) / (before - best))
    }

    /// The joints, from 0, on which the true structure helps; all where it helps on none.
    fn gap_joints(&self) -> Vec<usize> {
        let (null, oracle) = (&self.truth.rmse_null, &self.truth.rmse_oracle);
        let helped: Vec<usize> = (0..null.len())
            .filter(|&j| null[j] > GAP * oracle[j])
            .collect();
        if helped.is_empty() {
            (0..null.len()).collect()
        } else {
            helped
        }
    }
}
