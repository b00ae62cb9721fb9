//! An exciting motion as text for a terminal.

use std::fmt::Write;

use super::table::{Align, Table, optional, shorten, significant};
use crate::excite::{Criterion, Excitation, Expected, Family, JointUse, Start};
use crate::model::JointKind;

/// No line but a warning is longer.
const WIDTH: usize = 118;

/// Renders an exciting motion: what it is, how well it excites, what it uses of the limits, and what
/// an identification along it will know. A function of the value alone.
pub fn terminal(found: &Excitation) -> String {
    let mut text = heading(found);
    text.push_str(&joints(found).render(WIDTH));
    text.push('\n');
    text.push_str(&noise(found));
    text.push_str(&parameters(found).render(WIDTH));
    text.push_str(&undetermined(found));
    for (k, warning) in found.warnings.iter().enumerate() {
        let gap = if k == 0 { "\n" } else { "" };
        // Writing to a String does not fail.
        let _ = writeln!(text, "{gap}warning: {warning}");
    }
    text
}

fn heading(found: &Excitation) -> String {
    let family = match found.family {
        Family::Fourier { harmonics } => format!("Fourier series of {harmonics} harmonics"),
        Family::ViaPoints { points } => format!("quintic motion through {points} points"),
    };
    let start = match (found.start, found.family) {
        (Start::Moving, Family::Fourier { .. }) => "begins moving",
        _ => "begins and ends at rest",
    };
    let times = match found.periods {
        1 => String::new(),
        periods => format!(", {periods} times"),
    };
    let first = format!(
        "{}: {family}, {} s{times}, {start}; seed {}, {} starts",
        found.robot, found.period_s, found.search.seed, found.search.starts
    );
    let second = format!(
        "condition of W {} ({} with columns of unit norm)",
        significant(found.condition, 4),
        significant(found.condition_scaled, 4)
    );
    let chance = &found.by_chance;
    let third = format!(
        "minimised: {} {}; the best of {} motions by chance has {}, their median {}",
        measure(found),
        significant(chance.found, 4),
        chance.motions,
        optional(chance.best, 4),
        optional(chance.median, 4)
    );
    let lines = [first, second, third].map(|line| shorten(&line, WIDTH));
    lines.join("\n") + "\n\n"
}

fn measure(found: &Excitation) -> String {
    match &found.criterion {
        Criterion::Condition => "condition of W".into(),
        Criterion::Scaled => "condition with columns of unit norm".into(),
        Criterion::Determinant => "det(W'S^-1W)^(-1/2n)".into(),
        Criterion::Separate { columns } => {
            let names = columns.iter().filter_map(|k| found.parameters.get(*k));
            let names: Vec<&str> = names.map(|it| it.name.as_str()).collect();
            format!("mean sigma of {}", names.join(", "))
        }
    }
}

/// What the motion uses of each joint's limits.
fn joints(found: &Excitation) -> Table {
    let right = [Align::Right; 7];
    let mut table = Table::new([vec![Align::Left, Align::Left], right.to_vec()].concat());
    let titles = [
        "joint",
        "unit",
        "centre",
        "range",
        "limits",
        "max |qd|",
        "max |qdd|",
        "max |tau|",
    ];
    table.row(titles.map(str::to_owned).into());
    for joint in &found.joints {
        table.row(row(joint));
    }
    table
}

fn row(joint: &JointUse) -> Vec<String> {
    let unit = match joint.kind {
        JointKind::Revolute => "rad",
        JointKind::Prismatic => "m",
    };
    let limits = &joint.limits;
    let of = |used: f64, limit: f64| format!("{used:.3} of {limit:.3}");
    let effort = match (joint.effort, limits.effort.is_finite()) {
        (Some(used), true) => format!(
            "{} of {}",
            significant(used, 4),
            significant(limits.effort, 4)
        ),
        (Some(used), false) => significant(used, 4),
        (None, true) => format!("? of {}", significant(limits.effort, 4)),
        (None, false) => "-".into(),
    };
    vec![
        joint.name.clone(),
        unit.into(),
        format!("{:.3}", joint.center),
        format!("{:.3} .. {:.3}", joint.range[0], joint.range[1]),
        format!("{:.3} .. {:.3}", limits.lower, limits.upper),
        of(joint.velocity, limits.velocity),
        of(joint.acceleration, limits.acceleration),
        effort,
    ]
}

fn noise(found: &Excitation) -> String {
    let sigma = found.noise.sigma.iter().map(|sigma| significant(*sigma, 3));
    let line = format!(
        "with noise of {} N m or N in each of {} samples a second:",
        sigma.collect::<Vec<_>>().join(", "),
        significant(found.noise.rate_hz, 4)
    );
    shorten(&line, WIDTH) + "\n"
}

/// Name, unit, value, standard deviations, how much of its column is its own, periods.
fn parameters(found: &Excitation) -> Table {
    let left = [Align::Left; 2];
    let mut table = Table::new([left.to_vec(), vec![Align::Right; 5]].concat());
    let known = found.parameters.iter().any(|it| it.value.is_some());
    let mut titles = vec!["parameter", "unit", "sigma", "alone"];
    if known {
        titles = vec!["parameter", "unit", "value", "sigma", "%", "alone"];
    }
    let wanted = found.wanted_pct.map(|pct| format!("periods for {pct} %"));
    let titles = titles.into_iter().map(str::to_owned).chain(wanted);
    table.row(titles.collect());
    for it in &found.parameters {
        table.row(line(it, known, found.wanted_pct.is_some()));
    }
    table
}

fn line(it: &Expected, known: bool, wanted: bool) -> Vec<String> {
    let mut cells = vec![it.name.clone(), it.unit.clone()];
    if known {
        cells.push(optional(it.value, 4));
    }
    cells.push(optional(it.sigma, 3));
    if known {
        cells.push(optional(it.sigma_pct, 2));
    }
    cells.push(optional(it.alone, 2));
    if wanted {
        cells.push(
            it.periods
                .map_or_else(|| "-".into(), |periods| format!("{periods}")),
        );
    }
    cells
}

fn undetermined(found: &Excitation) -> String {
    let mut text = String::new();
    for group in &found.undetermined {
        let names = group.names.join(", ");
        let known = match group.known {
            0 => "not at all".to_owned(),
            known => format!("{known} of {} combinations", group.names.len()),
        };
        let _ = writeln!(
            text,
            "no motion within these limits determines {names} ({known})"
        );
    }
    text
}
