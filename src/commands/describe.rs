//! `idim describe`: the model of a robot, to be understood in one minute.

use std::fmt::Write;
use std::path::PathBuf;

use idim::codegen::Robot;
use idim::codegen::base::lengths;
use idim::codegen::derive::ParameterKind;
use idim::codegen::describe::{Drive, Geometry};
use idim::codegen::expr::Angle;
use idim::codegen::expr::Operations;
use idim::codegen::mechanism::{Follow, Joint, JointKind};
use serde::Serialize;

use super::{Failure, failure, output, robot};

/// Arguments of `idim describe`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    robot: String,
    /// Write the description as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print nothing but what was asked for as a file.
    #[arg(long)]
    quiet: bool,
}

/// Describes the robot.
///
/// # Errors
/// [`Failure`] when the robot cannot be read or the file not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let robot = robot::derived(&arguments.robot)?;
    if let Some(path) = &arguments.json {
        output::json(path, &Report::new(&robot))?;
    }
    if arguments.quiet || output::claims_stdout(arguments.json.as_deref()) {
        return Ok(());
    }
    for warning in &robot.description.warnings {
        output::complain(&format!("{:?}", failure::report(warning)));
    }
    output::print(&text(&robot))
}

/// The JSON of `describe`.
#[derive(Debug, Serialize)]
struct Report {
    robot: String,
    /// Those with a drive: what a log has columns of.
    joints: Vec<JointReport>,
    /// Those that follow them, numbered behind.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    followers: Vec<FollowerReport>,
    standard_parameters: usize,
    rank_gap: f64,
    /// Base parameters that a detail of the description alone keeps in the set.
    #[serde(skip_serializing_if = "Option::is_none")]
    detail: Option<DetailReport>,
    lengths: Vec<LengthReport>,
    base_parameters: Vec<ParameterReport>,
    operations: OperationsReport,
    snaps: Vec<SnapReport>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct JointReport {
    name: String,
    kind: &'static str,
    /// Antecedent, counted from 1; 0 is the base.
    ant: usize,
    gamma: f64,
    alpha: f64,
    theta: f64,
    position: [f64; 3],
    bodies: Vec<String>,
}

#[derive(Debug, Serialize)]
struct DetailReport {
    columns: Vec<String>,
    /// How much smaller what tells them from the others is than for any other column.
    drop: f64,
}

/// A length that relations speak of by name, m.
#[derive(Debug, Serialize)]
struct LengthReport {
    name: String,
    value: f64,
}

#[derive(Debug, Serialize)]
struct FollowerReport {
    #[serde(flatten)]
    joint: JointReport,
    /// `mimic` or `passive`.
    drive: &'static str,
    /// Its position, as text.
    position: String,
}

#[derive(Debug, Serialize)]
struct ParameterReport {
    name: String,
    unit: String,
    link: usize,
    kind: &'static str,
    relation: String,
}

#[derive(Debug, Serialize)]
struct OperationsReport {
    explicit: CountReport,
    implicit: CountReport,
    energy: CountReport,
}

#[derive(Debug, Serialize)]
struct CountReport {
    mul: usize,
    add: usize,
    trig: usize,
}

#[derive(Debug, Serialize)]
struct SnapReport {
    joint: String,
    from: f64,
    to: String,
}

impl Report {
    fn new(robot: &Robot) -> Report {
        let counts = robot.counts();
        let snap = |snap: &idim::codegen::describe::Snap| SnapReport {
            joint: snap.joint.clone(),
            from: snap.from,
            to: snap.to.clone(),
        };
        Report {
            robot: robot.mechanism.name.clone(),
            joints: robot
                .mechanism
                .driven()
                .iter()
                .map(JointReport::new)
                .collect(),
            followers: (robot.mechanism.driven..robot.mechanism.joints.len())
                .map(|joint| FollowerReport::new(robot, joint))
                .collect(),
            standard_parameters: robot.base.standard,
            rank_gap: robot.base.gap,
            detail: robot.base.detail.as_ref().map(|detail| DetailReport {
                columns: named(robot, &detail.parameters),
                drop: detail.drop,
            }),
            lengths: lengths::of(&robot.mechanism, &robot.description)
                .into_iter()
                .map(|length| LengthReport {
                    name: length.name,
                    value: length.value,
                })
                .collect(),
            base_parameters: robot
                .base
                .parameters
                .iter()
                .map(ParameterReport::new)
                .collect(),
            operations: OperationsReport {
                explicit: counts.explicit.into(),
                implicit: counts.implicit.into(),
                energy: counts.energy.into(),
            },
            snaps: robot.mechanism.snaps.iter().map(snap).collect(),
            warnings: robot
                .description
                .warnings
                .iter()
                .map(ToString::to_string)
                .collect(),
        }
    }
}

impl JointReport {
    fn new(joint: &Joint) -> JointReport {
        JointReport {
            name: joint.name.clone(),
            kind: kind(joint.kind),
            ant: joint.parent.map_or(0, |parent| parent + 1),
            gamma: joint.gamma.value(),
            alpha: joint.alpha.value(),
            theta: joint.theta.value(),
            position: joint.position,
            bodies: joint.bodies.iter().map(|body| body.name.clone()).collect(),
        }
    }
}

impl FollowerReport {
    fn new(robot: &Robot, joint: usize) -> FollowerReport {
        let known = &robot.mechanism.joints[joint];
        FollowerReport {
            joint: JointReport::new(known),
            drive: drive(robot, &known.name),
            position: position(robot, joint),
        }
    }
}

/// What moves a joint without a drive, in a word.
fn drive(robot: &Robot, name: &str) -> &'static str {
    let passive = match &robot.description.geometry {
        Geometry::Urdf(_) => false,
        Geometry::Mdh(rows) => {
            let mut rows = rows.iter();
            rows.any(|row| row.name == name && row.drive == Drive::Passive)
        }
    };
    if passive { "passive" } else { "mimic" }
}

/// The position of a joint without a drive in those of the driven ones.
fn position(robot: &Robot, joint: usize) -> String {
    let sum = match robot.mechanism.follow(joint) {
        Follow::Sum(sum) => sum,
        Follow::Dyad { dyad, .. } => {
            let drivers = robot.mechanism.dyads[dyad].drivers.iter();
            let names: Vec<String> = drivers.map(|driver| format!("q{}", driver + 1)).collect();
            return format!("a function of {}", names.join(", "));
        }
    };
    let mut text = String::new();
    let constant = (sum.offset != 0.0).then(|| (sum.offset, String::new()));
    let terms = sum.terms.iter();
    let terms = terms.map(|&(driver, factor)| (factor, format!("q{}", driver + 1)));
    for (factor, name) in terms.chain(constant) {
        let size = match name.is_empty() {
            true => angle(Angle::radians(factor.abs())),
            false if factor.abs() == 1.0 => String::new(),
            false => format!("{} ", factor.abs()),
        };
        text.push_str(match (text.is_empty(), factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        });
        text.push_str(&format!("{size}{name}"));
    }
    text
}

impl ParameterReport {
    fn new(parameter: &idim::codegen::base::BaseParameter) -> ParameterReport {
        ParameterReport {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            link: parameter.link + 1,
            kind: match parameter.kind {
                ParameterKind::Inertial(_) => "inertial",
                ParameterKind::Drive => "drive",
                ParameterKind::Friction => "friction",
                ParameterKind::Effect => "effect",
            },
            relation: parameter.relation_text(),
        }
    }
}

impl From<Operations> for CountReport {
    fn from(count: Operations) -> CountReport {
        CountReport {
            mul: count.mul,
            add: count.add,
            trig: count.trig,
        }
    }
}

fn kind(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    }
}

/// The description for people.
fn text(robot: &Robot) -> String {
    let mut out = String::new();
    let n = robot.mechanism.driven;
    let others = match robot.mechanism.joints.len() - n {
        0 => String::new(),
        1 => " with a drive and 1 that follows".to_owned(),
        more => format!(" with a drive and {more} that follow"),
    };
    let np = robot.base.parameters.len();
    let _ = writeln!(
        out,
        "{}: {n} joint{}{others}, {np} base parameters of {} standard ones (rank gap {:.0e})\n",
        robot.mechanism.name,
        if n == 1 { "" } else { "s" },
        robot.base.standard,
        robot.base.gap
    );
    joints(&mut out, robot);
    followers(&mut out, robot);
    snaps(&mut out, robot);
    parameters(&mut out, robot);
    detail(&mut out, robot);
    operations(&mut out, robot);
    out
}

/// Names of base parameters.
fn named(robot: &Robot, places: &[usize]) -> Vec<String> {
    let parameters = &robot.base.parameters;
    let names = places.iter().map(|&place| parameters[place].name.clone());
    names.collect()
}

/// What an identification can know of columns that stand on a detail.
fn detail(out: &mut String, robot: &Robot) {
    let Some(detail) = &robot.base.detail else {
        return;
    };
    let names = named(robot, &detail.parameters);
    let (stand, them, their) = match names.len() {
        1 => ("stands", "it", "its value"),
        _ => ("stand", "them", "their values"),
    };
    let _ = writeln!(
        out,
        "\n  {} {stand} on a detail of the description: what tells {them} from the others is {:.0e} times\n  \
         smaller than for any other column, and a log has to be that precise to identify {them}.\n  \
         An axis that is almost parallel, a length that is almost zero, a loop that is almost a\n  \
         parallelogram, gravity that is almost along an axis? Make it exact, or do without {their}.",
        names.join(", "),
        detail.drop
    );
}

fn joints(out: &mut String, robot: &Robot) {
    let width = robot
        .mechanism
        .joints
        .iter()
        .map(|joint| joint.name.chars().count())
        .max();
    let width = width.unwrap_or(0).max(5);
    let _ = writeln!(
        out,
        "  j  {:<width$}  {:<9}  ant  {:>8} {:>8} {:>8}   origin in the antecedent's frame, m",
        "joint", "kind", "gamma", "alpha", "theta"
    );
    // What follows has a position, but no column in a log.
    let variable = |index: usize| match index < robot.mechanism.driven {
        true => format!("q{}", index + 1),
        false => format!("p{}", index + 1),
    };
    for (index, joint) in robot.mechanism.joints.iter().enumerate() {
        let [gamma, alpha, theta] = [joint.gamma, joint.alpha, joint.theta].map(angle);
        let own = match joint.kind {
            JointKind::Revolute => variable(index),
            JointKind::Prismatic => String::new(),
        };
        let theta = match (theta.as_str(), own.as_str()) {
            (theta, "") => theta.to_owned(),
            ("0", own) => own.to_owned(),
            (theta, own) => format!("{own} + {theta}").replace("+ -", "- "),
        };
        let [x, y, z] = joint.position;
        let _ = write!(
            out,
            "{:>3}  {:<width$}  {:<9}  {:>3}  {gamma:>8} {alpha:>8} {theta:>8}   ({x}, {y}, {z})",
            index + 1,
            joint.name,
            kind(joint.kind),
            joint.parent.map_or(0, |parent| parent + 1),
        );
        if joint.kind == JointKind::Prismatic {
            let _ = write!(out, " + {} along z", variable(index));
        }
        out.push('\n');
    }
}

fn angle(angle: Angle) -> String {
    match angle.right() {
        Some(_) => angle.text(),
        None => format!("{:.6}", angle.value()),
    }
}

/// What every joint without a drive does.
fn followers(out: &mut String, robot: &Robot) {
    for joint in robot.mechanism.driven..robot.mechanism.joints.len() {
        let name = &robot.mechanism.joints[joint].name;
        let (number, position) = (joint + 1, position(robot, joint));
        let _ = match drive(robot, name) {
            "passive" => writeln!(
                out,
                "  {name} has no drive, a closed loop moves it: p{number} = {position}"
            ),
            _ => writeln!(out, "  {name} follows: p{number} = {position}"),
        };
    }
}

fn snaps(out: &mut String, robot: &Robot) {
    for snap in &robot.mechanism.snaps {
        let _ = writeln!(
            out,
            "  taken as exact: {}: {} is {}",
            snap.joint, snap.from, snap.to
        );
    }
}

fn parameters(out: &mut String, robot: &Robot) {
    let lengths = lengths::of(&robot.mechanism, &robot.description);
    let lengths = lengths.iter().map(|l| format!("{} = {}", l.name, l.value));
    let lengths: Vec<String> = lengths.collect();
    if !lengths.is_empty() {
        let _ = writeln!(out, "\n  lengths, m: {}", lengths.join(", "));
    }
    let _ = writeln!(out, "\n  {:<8} {:<10} stands for", "column", "unit");
    for parameter in &robot.base.parameters {
        let head = format!("  {:<8} {:<10} ", parameter.name, parameter.unit);
        let indent = " ".repeat(head.len());
        out.push_str(&head);
        let mut column = head.len();
        for (index, word) in parameter.relation_text().split(' ').enumerate() {
            // A relation breaks before a sign, never between a sign and its term.
            if column + word.len() > 100 && (word == "+" || word == "-") {
                out.push('\n');
                out.push_str(&indent);
                column = indent.len();
            } else if index > 0 {
                out.push(' ');
                column += 1;
            }
            out.push_str(word);
            column += word.len();
        }
        out.push('\n');
    }
}

fn operations(out: &mut String, robot: &Robot) {
    let counts = robot.counts();
    let _ = writeln!(
        out,
        "\n  operations (inertial columns)      x      +  sin/cos"
    );
    for (name, count) in [
        ("D   explicit", counts.explicit),
        ("P+R implicit", counts.implicit),
        ("h   energy", counts.energy),
    ] {
        let _ = writeln!(
            out,
            "  {name:<30} {:>6} {:>6} {:>8}",
            count.mul, count.add, count.trig
        );
    }
}
