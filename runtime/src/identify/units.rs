//! Positions in degrees or millimetres that nobody said are: suspected by their size, decided by
//! the dynamics.

use super::{Options, Plan, score};
use crate::estimate::estimate;
use crate::evidence::{Cut, Evidence};
use crate::log::{Companion, Recording};
use crate::model::{IdentificationModel, JointKind};
use crate::observe::{ModelKind, Motion, observe};

/// A revolute joint that stays within one turn raises no suspicion, rad.
const ONE_TURN: f64 = std::f64::consts::TAU;

/// Two turns either way are worth a word if the dynamics cannot tell, rad.
const TWO_TURNS: f64 = 4.0 * std::f64::consts::PI;

/// Few robots are longer, m.
const LONG: f64 = 10.0;

/// One reading of a log is decided against another if it explains the torque this many times
/// better: the product, over the joints, of the ratios of what is left unexplained.
const DECISIVE: f64 = 2.0;

/// Puts positions that are plainly in degrees (of a prismatic joint: millimetres) into SI, and
/// their velocities with them.
///
/// A joint is suspected when it goes further than one turn (10 m) and the companion states no unit
/// for it. Then the explicit model is identified with the positions as they are and with those of
/// suspected joints converted; whichever explains the torque at least twice as well is right: a
/// joint that really turns many times keeps its radians. What was found is added to the recording's
/// warnings, also where the dynamics cannot tell, which is so for a joint whose angle enters nothing
/// but its own acceleration.
///
/// A log without torque, or that cannot be identified at all, is left as it is.
pub fn settle_units(
    model: &dyn IdentificationModel,
    log: &mut Recording,
    companion: &Companion,
    options: &Options,
) {
    let joints = model.joints();
    let suspects: Vec<Suspect> = (joints.iter().zip(&log.q).enumerate())
        .filter(|(joint, _)| !companion.states_position(*joint, joints))
        .filter_map(|(joint, (of, q))| Suspect::of(joint, of.kind, q))
        .collect();
    if suspects.is_empty() || log.tau.is_none() {
        return;
    }
    let trial = Trial {
        model,
        log,
        suspects: &suspects,
        options,
    };
    let as_is = vec![false; suspects.len()];
    let converted = trial.best_converted();
    let better = match (trial.unexplained(&as_is), &converted) {
        (Some(as_is), Some((_, converted))) => as_is - converted,
        _ => 0.0,
    };
    if better >= DECISIVE.ln() {
        let choice = converted.map_or(as_is, |(choice, _)| choice);
        for (suspect, _) in suspects.iter().zip(choice).filter(|(_, yes)| *yes) {
            suspect.convert(log);
            let sentence = suspect.converted(model, better.exp());
            log.warnings.push(sentence);
        }
    } else if better > -DECISIVE.ln() {
        let open = suspects.iter().filter(|suspect| suspect.far());
        log.warnings.extend(open.map(|suspect| suspect.open(model)));
    }
}

/// A joint that may be in degrees or millimetres.
#[derive(Clone, Copy)]
struct Suspect {
    joint: usize,
    kind: JointKind,
    /// Largest position, as it stands in the log.
    farthest: f64,
}

impl Suspect {
    fn of(joint: usize, kind: JointKind, q: &[f64]) -> Option<Suspect> {
        let low = q.iter().copied().fold(f64::INFINITY, f64::min);
        let high = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let farthest = low.abs().max(high.abs());
        let limit = match kind {
            JointKind::Revolute => ONE_TURN,
            JointKind::Prismatic => LONG,
        };
        let suspect = Suspect {
            joint,
            kind,
            farthest,
        };
        (farthest > limit || high - low > limit).then_some(suspect)
    }

    fn factor(&self) -> f64 {
        match self.kind {
            JointKind::Revolute => std::f64::consts::PI / 180.0,
            JointKind::Prismatic => 1e-3,
        }
    }

    fn unit(&self) -> (&'static str, &'static str) {
        match self.kind {
            JointKind::Revolute => ("deg", "rad"),
            JointKind::Prismatic => ("mm", "m"),
        }
    }

    fn far(&self) -> bool {
        self.kind == JointKind::Prismatic || self.farthest > TWO_TURNS
    }

    fn convert(&self, log: &mut Recording) {
        let q = log.q.get_mut(self.joint);
        let qd = log.qd.as_mut().and_then(|qd| qd.get_mut(self.joint));
        for value in q.into_iter().chain(qd).flatten() {
            *value *= self.factor();
        }
    }

    fn converted(&self, model: &dyn IdentificationModel, times: f64) -> String {
        let (unit, si) = self.unit();
        format!(
            "{} was taken to be in {unit}: so its log explains the torque {times:.1} times as well \
             as in {si}. Confirm it with unit = \"{unit}\" for q{} under [columns] of the log \
             companion.",
            self.name(model),
            self.joint + 1
        )
    }

    fn open(&self, model: &dyn IdentificationModel) -> String {
        let (unit, si) = self.unit();
        format!(
            "{} goes as far as {:.1}: in {si} that is unusual, and the torque fits as well if it is \
             in {unit}. State unit = \"{unit}\" or \"{si}\" for q{} under [columns] of the log \
             companion.",
            self.name(model),
            self.farthest,
            self.joint + 1
        )
    }

    fn name(&self, model: &dyn IdentificationModel) -> String {
        let name = model.joints().get(self.joint).map_or("", |j| &j.name);
        format!("Joint {} (`{name}`)", self.joint + 1)
    }
}

/// A log to be identified with some of the suspects converted.
struct Trial<'a> {
    model: &'a dyn IdentificationModel,
    log: &'a Recording,
    suspects: &'a [Suspect],
    options: &'a Options,
}

impl Trial<'_> {
    /// The best choice that converts at least one suspect: of one and of all of them, the better
    /// one, changed suspect by suspect as long as it becomes better still.
    fn best_converted(&self) -> Option<(Vec<bool>, f64)> {
        let n = self.suspects.len();
        let one = |k: usize| (0..n).map(|j| j == k).collect::<Vec<bool>>();
        let starts = (0..n).map(one).chain([vec![true; n]]);
        let tried = starts.filter_map(|choice| Some((self.unexplained(&choice)?, choice)));
        let (mut least, mut best) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        for k in 0..n {
            let mut other = best.clone();
            other[k] = !other[k];
            if !other.contains(&true) {
                continue;
            }
            if let Some(found) = self.unexplained(&other).filter(|found| *found < least) {
                (least, best) = (found, other);
            }
        }
        Some((best, least))
    }

    /// Sum over the joints of the logarithm of the torque that the explicit model leaves
    /// unexplained; `None` if the log cannot be identified so.
    fn unexplained(&self, choice: &[bool]) -> Option<f64> {
        let mut log = self.log.clone();
        for (suspect, _) in self.suspects.iter().zip(choice).filter(|(_, yes)| **yes) {
            suspect.convert(&mut log);
        }
        let options = Options {
            models: vec![ModelKind::Explicit],
            ..self.options.clone()
        };
        let plan: Plan = options
            .resolve(self.model, std::slice::from_ref(&log))
            .ok()?;
        let np = self.model.columns().len();
        let motion = Motion::trimmed(&log, self.model, &plan.filtering).ok()?;
        let observed = observe(self.model, ModelKind::Explicit, &motion, &plan.filtering).ok()?;
        let found = estimate(&observed.blocks, np, plan.weights).ok()?;
        let evidence = Evidence::from_observations(self.model, &observed, &[], Cut::Blocks(1));
        let fit = score::torque(self.model, &evidence.ok()?, &found.solution);
        let shares = fit.joints.iter().map(|joint| joint.rel_pct);
        let known = shares.filter(|share| share.is_finite());
        Some(known.map(|share| share.max(1e-6).ln()).sum())
    }
}
