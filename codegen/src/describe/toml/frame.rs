//! Where the joints are: `[[joint]]` rows here, or a URDF with `[joint.NAME]` tables beside it.

use super::super::check::{self, Known};
use super::super::code;
use super::super::description::{Geometry, Limits, LoopSpec, Snap, UrdfTree};
use super::super::diagnostic::Diagnostic;
use super::super::findings::{Findings, finding};
use super::super::urdf;
use super::joint::{self, Extras};
use super::loops;
use super::rows;
use super::table::{Table, Value, in_text_order, wrong_type};
use toml::de::DeValue;

/// Geometry and what its joints say beside it.
pub(super) struct Frame {
    /// Rows or tree.
    pub(super) geometry: Geometry,
    /// Closed loops.
    pub(super) loops: Vec<LoopSpec>,
    /// Effects and gains, one entry per joint of the geometry.
    pub(super) extras: Vec<Extras>,
    /// Angles taken as multiples of pi/2.
    pub(super) snaps: Vec<Snap>,
    /// The name that the URDF gives the robot.
    pub(super) name: Option<String>,
    /// What was noticed in the URDF.
    pub(super) warnings: Vec<Diagnostic>,
}

/// Reads the rows of the table itself.
pub(super) fn from_rows(
    table: &mut Table<'_>,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Frame {
    let values: Vec<Value<'_>> = match table.get("joint").map(|value| (value, value.get_ref())) {
        Some((_, DeValue::Array(values))) => values.iter().collect(),
        Some((value, DeValue::Table(_))) => {
            let message = "[joint.NAME] needs `urdf = \"...\"`, which says where the joints are";
            let help = "the rows of a Denavit-Hartenberg table are written [[joint]]";
            to.error(
                value.span().start,
                finding(code::KEY_MISSING, message).help(help),
            );
            Vec::new()
        }
        Some((value, other)) => {
            wrong_type(value, "`joint`", "written [[joint]]", other, to);
            Vec::new()
        }
        None => Vec::new(),
    };
    let read = rows::read(&values, lengths, to);
    let joints: Vec<Known> = read.rows.iter().map(Known::of_row).collect();
    check::mimics(&joints, to);
    Frame {
        loops: loops::read(table, &read.rows, lengths, to),
        geometry: Geometry::Mdh(read.rows),
        extras: read.extras,
        snaps: read.snaps,
        name: None,
        warnings: Vec::new(),
    }
}

/// Reads the URDF and the `[joint.NAME]` tables.
pub(super) fn from_urdf(
    table: &mut Table<'_>,
    text: &str,
    file: &str,
    to: &mut Findings,
) -> Result<Frame, Vec<Diagnostic>> {
    let robot = urdf::read(text, file)?;
    let mut tree = robot.tree;
    let mut extras: Vec<Extras> = tree.joints.iter().map(|_| Extras::default()).collect();
    match table.get("joint").map(|value| (value, value.get_ref())) {
        Some((_, DeValue::Table(joints))) => {
            for (name, offset, value) in in_text_order(joints) {
                companion(name, offset, value, &mut tree, &mut extras, to);
            }
        }
        Some((value, _)) => {
            let message = "[[joint]] rows and `urdf` both say where the joints are";
            let help = "beside a URDF, settings of a joint are written [joint.NAME]";
            to.error(
                value.span().start,
                finding(code::KEYS_EXCLUDE, message).help(help),
            );
        }
        None => {}
    }
    Ok(Frame {
        geometry: Geometry::Urdf(tree),
        loops: vec![],
        extras,
        snaps: robot.snaps,
        name: Some(robot.name),
        warnings: robot.warnings,
    })
}

/// Reads one `[joint.NAME]`.
fn companion(
    name: &str,
    offset: usize,
    value: Value<'_>,
    tree: &mut UrdfTree,
    extras: &mut [Extras],
    to: &mut Findings,
) {
    let Some(mut table) = Table::from_value(value, &format!("joint `{name}`"), to) else {
        return;
    };
    let Some(index) = tree.joints.iter().position(|joint| joint.name == name) else {
        let message = format!("the URDF has no joint `{name}`");
        let help = to.suggest(name, tree.joints.iter().map(|joint| joint.name.as_str()));
        to.error(offset, finding(code::EFFECT_JOINT, message).help(help));
        return;
    };
    let stated = joint::limits(&mut table, to);
    let read = joint::extras(&mut table, to);
    table.finish(to);
    let joint = &mut tree.joints[index];
    joint::check_motion(&Known::of_urdf(joint), &read, offset, to);
    let (old, both) = (
        joint.limits,
        stated.lower.is_some() && stated.upper.is_some(),
    );
    joint.limits = merged(old, stated);
    if !both
        && let (Some(lower), Some(upper)) = (joint.limits.lower, joint.limits.upper)
        && lower > upper
    {
        let message = format!("joint `{name}`: lower {lower} is above upper {upper}");
        let help = "one of the two is from the URDF";
        to.error(offset, finding(code::LIMITS_REVERSED, message).help(help));
    }
    extras[index] = read;
}

/// The limits of the URDF, except where the companion states its own.
fn merged(old: Limits, stated: Limits) -> Limits {
    Limits {
        lower: stated.lower.or(old.lower),
        upper: stated.upper.or(old.upper),
        velocity: stated.velocity.or(old.velocity),
        effort: stated.effort.or(old.effort),
    }
}

/// The settings of the joints with a drive.
pub(super) fn of_driven<'e>(joints: &[Known], extras: &'e [Extras]) -> Vec<&'e Extras> {
    let driven = |(joint, extras): (&Known, &'e Extras)| joint.is_driven().then_some(extras);
    joints.iter().zip(extras).filter_map(driven).collect()
}
