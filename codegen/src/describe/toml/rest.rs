//! Everything of a description but the geometry.

use super::super::check::Known;
use super::super::code;
use super::super::description::{
    DrivesSpec, EffectSpec, IdentifySpec, LinkSpec, PriorSpec, ScaledParameter,
};
use super::super::diagnostic::Span;
use super::super::findings::{Findings, finding};
use super::effects::{self, Wanted};
use super::frame::{Frame, of_driven};
use super::joint::Extras;
use super::links;
use super::named;
use super::options;
use super::table::Table;
use super::value;
use crate::catalogue::EffectKind;

/// What a joint has when the description is silent.
const DEFAULT_EFFECTS: [EffectKind; 4] = [
    EffectKind::Viscous,
    EffectKind::Coulomb,
    EffectKind::Offset,
    EffectKind::RotorInertia,
];

/// m/s^2 in frame 0 when the description is silent.
const DEFAULT_GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// The parts, each as [`super::super::Description`] has it.
pub(super) struct Rest {
    pub(super) gravity: [f64; 3],
    pub(super) effects: Vec<EffectSpec>,
    pub(super) scaled: Vec<ScaledParameter>,
    pub(super) identify: IdentifySpec,
    pub(super) drives: DrivesSpec,
    pub(super) parameters: Vec<(String, f64)>,
    pub(super) prior: Option<PriorSpec>,
    pub(super) total_mass: Option<f64>,
    pub(super) links: Vec<LinkSpec>,
}

impl Rest {
    /// Reads the tables.
    pub(super) fn read(
        table: &mut Table<'_>,
        joints: &[Known],
        frame: &Frame,
        lengths: &[(String, f64)],
        to: &mut Findings,
    ) -> Self {
        let extras = &frame.extras[..];
        let drives = table
            .get("drives")
            .and_then(|value| options::drives(value, to));
        let drives = drives.unwrap_or_default();
        let identify = table
            .get("identify")
            .and_then(|value| options::identify(value, to));
        let parameters = table
            .get("parameters")
            .map(|value| named::parameters(value, to));
        let scaled = table
            .get("scaled")
            .map(|value| named::scaled(value, lengths, to));
        Rest {
            gravity: gravity(table, to),
            effects: all_effects(table, joints, extras, drives.link_side, to),
            scaled: scaled.unwrap_or_default(),
            identify: identify.unwrap_or_default(),
            drives: drives.settle(&of_driven(joints, extras), to),
            parameters: parameters.unwrap_or_default(),
            prior: table
                .get("prior")
                .and_then(|value| options::prior(value, to)),
            total_mass: links::total_mass(table, to),
            links: links::read(table, &frame.geometry, lengths, to),
        }
    }
}

fn gravity(table: &mut Table<'_>, to: &mut Findings) -> [f64; 3] {
    let Some(value) = table.get("gravity") else {
        return DEFAULT_GRAVITY;
    };
    let Some(numbers) = value::numbers(value, "`gravity`", to) else {
        return DEFAULT_GRAVITY;
    };
    if let [x, y, z] = numbers[..] {
        return [x, y, z];
    }
    let message = format!("`gravity` has {} numbers instead of 3", numbers.len());
    let help = "m/s^2 in frame 0, such as [0.0, 0.0, -9.81]";
    to.error(
        value.span().start,
        finding(code::NUMBER_COUNT, message).help(help),
    );
    DEFAULT_GRAVITY
}

/// Joint by joint, then `[[effect]]`.
fn all_effects(
    table: &mut Table<'_>,
    joints: &[Known],
    extras: &[Extras],
    link_side: bool,
    to: &mut Findings,
) -> Vec<EffectSpec> {
    let common = table
        .get("effects")
        .and_then(|value| effects::wanted(value, "`effects`", to));
    let common = common.unwrap_or_else(|| default_effects(link_side));
    let mut all = Vec::new();
    for (joint, extras) in joints.iter().zip(extras) {
        if joint.is_driven() {
            let wanted = extras.effects.as_ref().unwrap_or(&common);
            all.extend(wanted.iter().map(|effect| effect.on(&joint.name)));
        }
    }
    if let Some(value) = table.get("effect")
        && let Some(values) = value::list(value, "`effect` (written [[effect]])", to)
    {
        all.extend(
            values
                .iter()
                .filter_map(|value| effects::on_joints(value, joints, to)),
        );
    }
    effects::check_distinct(&all, to);
    all
}

/// No rotor turns behind a torque sensor on the link side.
fn default_effects(link_side: bool) -> Vec<Wanted> {
    DEFAULT_EFFECTS
        .into_iter()
        .filter(|kind| !(link_side && *kind == EffectKind::RotorInertia))
        .map(|kind| Wanted::plain(kind, Span::default()))
        .collect()
}
