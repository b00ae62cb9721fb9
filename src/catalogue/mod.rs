//! The catalogue of effects: what a robot can have that its model has not.
//!
//! Each entry is one [`Effect`]: its description, where it may act and with which shapes, the
//! torque columns that it adds, and which values of its parameters cannot be. Torques that a
//! description can ask for as well are those that [`crate::codegen`] defines; this module only
//! evaluates them. Torque balance at joint j, positive as the drive pushes: an effect's torque
//! stands on the side of the measured torque's prediction.

mod acting;
mod along;
mod bodies;
mod changes;
mod described;
mod drive;
mod evaluate;
mod extension;
mod friction;
mod gear;
mod geometry;
mod guide;
mod memory;
mod position;
mod reach;
mod sensitivity;
#[cfg(test)]
mod tests;
mod whole;
mod widened;

use std::sync::OnceLock;

use idim_codegen::Robot;
use idim_codegen::catalogue::EffectKind;
use idim_codegen::derive::ParameterKind;
use idim_codegen::emit::signals::signals as distinct;
use idim_codegen::expr::Expr;
use idim_codegen::mechanism::JointKind;
use idim_codegen::robot::Output;
use idim_runtime::diagnose::{Catalogue, ColumnsAlong, Entry, Hypothesis, Signals, TorqueColumn};

pub use changes::Changes;
pub use described::toml;
pub use extension::Extension;
pub use guide::guide;
pub use whole::{Gear, Whole};
pub use widened::{WidenError, Widened};

use along::Along;
use evaluate::Linear;
use geometry::Length;
use reach::Reach;

/// An entry of the catalogue and what it does.
struct Effect {
    entry: Entry,
    /// Where it may act along a motion; the index of the entry is filled in later.
    hypotheses: fn(&Effects, &Reach<'_>) -> Vec<Hypothesis>,
    /// Its columns with a shape.
    columns: fn(&Along<'_>, &[usize], &[f64]) -> Vec<TorqueColumn>,
    /// The same as a description asks for it; nothing where it cannot.
    described: &'static [EffectKind],
    /// Why values of its parameters cannot be.
    implausible: fn(&[f64]) -> Option<&'static str>,
}

/// Every effect, in the order of the catalogue.
static CATALOGUE: [&Effect; 24] = [
    &position::TORQUE_OFFSET,
    &friction::VISCOUS_ASYMMETRY,
    &friction::STRIBECK,
    &friction::NONLINEAR_VISCOUS,
    &friction::POSITION_DEPENDENT_FRICTION,
    &position::TORQUE_RIPPLE,
    &position::SPRING,
    &position::END_STOP,
    &friction::TRANSMISSION_COUPLING,
    &bodies::ROTOR_INERTIA,
    &bodies::PAYLOAD,
    &bodies::BASE_TILT,
    &bodies::EXTERNAL_FORCE,
    &friction::LOAD_DEPENDENT_FRICTION,
    &drive::DRIVE_GAIN,
    &drive::DRIVE_SATURATION,
    &drive::DRIVE_DEAD_ZONE,
    &drive::TIME_SHIFT,
    &bodies::LINK_LENGTH,
    &position::ENCODER_ECCENTRICITY,
    &memory::PRESLIDING,
    &memory::FRICTION_DRIFT,
    &memory::JOINT_ELASTICITY,
    &memory::BACKLASH,
];

/// The catalogue on one robot.
#[derive(Debug)]
pub struct Effects {
    entries: Vec<Entry>,
    robot: Robot,
    /// The smooth part of the present model: rigid bodies, rotor inertias, viscous friction.
    smooth: Linear,
    /// Standard columns of all links.
    links: OnceLock<Linear>,
    /// Standard columns of the link that the tool is on.
    tool: OnceLock<Linear>,
    /// Standard columns under unit gravity along x, y, z of frame 0.
    gravity: OnceLock<[Linear; 3]>,
    /// The same along the axes that the first joint stands in.
    gravity_of_root: OnceLock<[Linear; 3]>,
    /// Per joint, the robot with another length there.
    lengths: Vec<OnceLock<Option<Length>>>,
}

/// The entries of the catalogue, in its order, on any robot: what there is to list.
pub fn entries() -> Vec<Entry> {
    CATALOGUE
        .iter()
        .map(|effect| effect.entry.clone())
        .collect()
}

impl Effects {
    /// The catalogue on a robot. What takes time (variants of the mechanism) is made when it is
    /// first asked for.
    pub fn new(robot: &Robot) -> Effects {
        Effects {
            entries: entries(),
            smooth: smooth(robot),
            links: OnceLock::new(),
            tool: OnceLock::new(),
            gravity: OnceLock::new(),
            gravity_of_root: OnceLock::new(),
            lengths: robot
                .mechanism
                .driven()
                .iter()
                .map(|_| OnceLock::new())
                .collect(),
            robot: robot.clone(),
        }
    }

    fn joints(&self) -> usize {
        self.robot.mechanism.driven
    }

    fn kind(&self, joint: usize) -> JointKind {
        self.robot.mechanism.joints[joint].kind
    }

    fn is_revolute(&self, joint: usize) -> bool {
        self.kind(joint) == JointKind::Revolute
    }

    fn links(&self) -> &Linear {
        self.links
            .get_or_init(|| geometry::rigid(&self.robot.mechanism, |_, _| true))
    }

    fn tool(&self) -> &Linear {
        self.tool.get_or_init(|| {
            let tool = self.robot.mechanism.tool();
            geometry::rigid(&self.robot.mechanism, |link, _| Some(link) == tool)
        })
    }

    fn gravity(&self) -> &[Linear; 3] {
        self.gravity
            .get_or_init(|| geometry::unit_gravity(&self.robot.description))
    }

    fn gravity_of_root(&self) -> &[Linear; 3] {
        self.gravity_of_root
            .get_or_init(|| geometry::unit_gravity_of_root(&self.robot.mechanism))
    }

    fn length(&self, joint: usize) -> Option<&Length> {
        self.lengths[joint]
            .get_or_init(|| Length::of(&self.robot, joint))
            .as_ref()
    }
}

/// The columns of D whose torque has derivatives: no sign of a velocity.
fn smooth(robot: &Robot) -> Linear {
    let all = distinct(robot, Output::Explicit);
    let is_smooth = |column: usize| {
        let parameter = &robot.base.parameters[column];
        let viscous = || parameter.name == format!("FV{}", parameter.link + 1);
        match parameter.kind {
            ParameterKind::Inertial(_) | ParameterKind::Drive => true,
            ParameterKind::Friction => viscous(),
            ParameterKind::Effect => false,
        }
    };
    let mut columns: Vec<(usize, Vec<(usize, Expr)>)> = Vec::new();
    for &(row, column, signal) in all.entries.iter().filter(|entry| is_smooth(entry.1)) {
        columns.push((column, vec![(row, all.values[signal])]));
    }
    let columns = columns
        .iter()
        .map(|(column, entry)| (*column, entry.as_slice()));
    Linear::new(&robot.graph, robot.mechanism.driven, columns)
}

impl Catalogue for Effects {
    fn entries(&self) -> &[Entry] {
        &self.entries
    }

    fn hypotheses(&self, signals: &Signals<'_>) -> Vec<Hypothesis> {
        let reach = Reach::new(signals);
        let of_entry = |(entry, effect): (usize, &&Effect)| {
            let all = (effect.hypotheses)(self, &reach).into_iter();
            all.map(move |hypothesis| Hypothesis {
                entry,
                ..hypothesis
            })
        };
        CATALOGUE.iter().enumerate().flat_map(of_entry).collect()
    }

    fn columns(
        &self,
        hypothesis: &Hypothesis,
        shape: &[f64],
        signals: &Signals<'_>,
    ) -> Vec<TorqueColumn> {
        Along::new(self, *signals).columns(hypothesis, shape)
    }

    fn along<'a>(&'a self, signals: Signals<'a>) -> ColumnsAlong<'a> {
        let along = Along::new(self, signals);
        Box::new(move |hypothesis, shape| along.columns(hypothesis, shape))
    }

    fn repeats_per_turn(&self, hypothesis: &Hypothesis, shape: &[f64]) -> Option<f64> {
        let effect = CATALOGUE.get(hypothesis.entry)?;
        let repeats = effect.described == [EffectKind::TorqueRipple];
        repeats.then(|| shape.first().copied()).flatten()
    }

    fn implausible(
        &self,
        hypothesis: &Hypothesis,
        _shape: &[f64],
        values: &[f64],
    ) -> Option<String> {
        let effect = CATALOGUE.get(hypothesis.entry)?;
        (effect.implausible)(values).map(str::to_owned)
    }
}
