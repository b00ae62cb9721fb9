//! Torque and simulated motion along the log that proves it, before and after.

use super::super::figure;
use super::super::markup::{Element, classed, el};
use super::super::panel::{Curve, Frame, Panel, drawing, label};
use super::super::scale::padded_range;
use super::super::words::{number, short};
use crate::report::{Diagnosis, GapCurves};

const SIZE: (f64, f64) = (620.0, 240.0);
const VALUES: Frame = Frame {
    left: 56.0,
    top: 24.0,
    width: 556.0,
    height: 100.0,
};
const ERROR: Frame = Frame {
    left: 56.0,
    top: 136.0,
    width: 556.0,
    height: 70.0,
};

/// Points of a curve.
const POINTS: usize = 1400;

/// What the curves of a section are.
struct Kind {
    /// Of the values.
    title: &'static str,
    /// Of the difference below them.
    error: &'static str,
}

/// Measured and predicted torque.
pub(super) fn torque(diagnosis: &Diagnosis) -> Option<Element> {
    let curves = &diagnosis.pictures.as_ref()?.torque;
    let kind = Kind {
        title: "torque",
        error: "residual",
    };
    let caption = format!(
        "Along {}, after the filters; below each the residual: measured minus predicted.",
        super::verdict::on(diagnosis)
    );
    let section = section("Measured and predicted torque", curves, &kind, &caption)?;
    Some(section)
}

/// Measured and simulated position.
pub(super) fn motion(diagnosis: &Diagnosis) -> Option<Element> {
    let curves = &diagnosis.pictures.as_ref()?.motion;
    let kind = Kind {
        title: "position",
        error: "error",
    };
    let caption = "The controller of the log drives the model along the reference of the log; \
                   below each the measured minus the simulated position.";
    section("Simulated motion", curves, &kind, caption)
}

fn section(title: &str, curves: &[GapCurves], kind: &Kind, caption: &str) -> Option<Element> {
    if curves.is_empty() {
        return None;
    }
    let same = curves.iter().all(|curve| curve.before == curve.after);
    let drawings = curves.iter().map(|curve| one(curve, kind, same));
    let grid = classed("div", "grid2").children(drawings);
    Some(
        el("section")
            .child(el("h2").text(title))
            .child(switches(same))
            .child(figure([grid], caption)),
    )
}

/// Switches for the curves of all figures; the style sheet does the switching.
fn switches(same: bool) -> Element {
    let names: &[&str] = match same {
        true => &["measured", "before"],
        false => &["measured", "before", "after"],
    };
    let switch = |name: &&str| {
        let input = el("input").attr("type", "checkbox").attr("value", name);
        let line = classed("path", &format!("curve {name}")).attr("d", "M0 5H26");
        let key = classed("svg", "key")
            .attr("viewBox", "0 0 26 10")
            .child(line);
        let input = input.attr("checked", "checked");
        el("label").child(input).child(key).text(words(name, same))
    };
    classed("p", "switches")
        .text("Curves: ")
        .children(names.iter().map(switch))
}

fn words(name: &str, same: bool) -> &'static str {
    match name {
        "before" if same => "model",
        "before" => "before: the model as it is described, refitted",
        "after" => "after: with what was found",
        _ => "measured",
    }
}

fn one(curve: &GapCurves, kind: &Kind, same: bool) -> Element {
    let words = format!(
        "{} of {} over time, before and after",
        kind.title, curve.joint
    );
    drawing("plot", SIZE, &words)
        .child(heading(curve, same))
        .child(values(curve, kind, same))
        .child(errors(curve, kind, same))
}

fn heading(curve: &GapCurves, same: bool) -> Element {
    let rms = |model: &[f64]| {
        let error = difference(curve, model);
        let square: f64 = error.iter().map(|e| e * e).sum();
        number((square / error.len().max(1) as f64).sqrt(), 3)
    };
    let text = match same {
        true => format!(
            "rms of the {} drawn {} {}",
            "error",
            rms(&curve.before),
            curve.unit
        ),
        false => format!(
            "rms of the error drawn: {} before, {} after, {}",
            rms(&curve.before),
            rms(&curve.after),
            curve.unit
        ),
    };
    let name = label(VALUES.left, 15.0, "start", &short(&curve.joint, 30)).attr("class", "name");
    el("g")
        .child(name.child(el("title").text(&curve.joint)))
        .child(label(VALUES.left + VALUES.width, 15.0, "end", &text))
}

fn values(curve: &GapCurves, kind: &Kind, same: bool) -> Element {
    let mut all = vec![
        ("measured", curve.measured.clone()),
        ("before", curve.before.clone()),
    ];
    if !same {
        all.push(("after", curve.after.clone()));
    }
    let range = padded_range(all.iter().flat_map(|(_, values)| values.iter().copied()));
    let panel = drawn(curve, VALUES, range, &all, "");
    panel.finish(
        None,
        &format!("{}, {}", kind.title, curve.unit),
        &curve.unit,
    )
}

fn errors(curve: &GapCurves, kind: &Kind, same: bool) -> Element {
    let mut all = vec![("before", difference(curve, &curve.before))];
    if !same {
        all.push(("after", difference(curve, &curve.after)));
    }
    let (factor, unit) = scaled(&curve.unit, all.iter().flat_map(|(_, values)| values));
    for value in all.iter_mut().flat_map(|(_, values)| values) {
        *value *= factor;
    }
    let range = padded_range(all.iter().flat_map(|(_, values)| values.iter().copied()));
    let panel = drawn(curve, ERROR, range, &all, " residual");
    let title = match factor == 1.0 {
        true => kind.error.to_owned(),
        false => format!("{}, {unit}", kind.error),
    };
    panel.finish(Some("time, s"), &title, &unit)
}

/// A unit in which errors of that size are numbers that can be read, and the factor to it.
fn scaled<'a>(unit: &str, values: impl Iterator<Item = &'a f64>) -> (f64, String) {
    let largest = values.fold(0.0, |top: f64, value| top.max(value.abs()));
    match (unit, largest) {
        ("rad" | "m", largest) if largest < 1e-4 => (1e6, format!("\u{b5}{unit}")),
        ("rad" | "m", largest) if largest < 0.1 => (1e3, format!("m{unit}")),
        _ => (1.0, unit.to_owned()),
    }
}

fn drawn(
    curve: &GapCurves,
    frame: Frame,
    range: (f64, f64),
    all: &[(&str, Vec<f64>)],
    what: &str,
) -> Panel {
    let ends = (curve.t.first().copied(), curve.t.last().copied());
    let span = (ends.0.unwrap_or(0.0), ends.1.unwrap_or(1.0));
    let mut panel = Panel::new(frame, span, range);
    for (name, y) in all {
        panel.curve(&Curve {
            class: &format!("{name}{what}"),
            name: (*name).to_owned(),
            x: &curve.t,
            y,
            points: POINTS,
        });
    }
    panel
}

/// Measured minus a model's.
fn difference(curve: &GapCurves, model: &[f64]) -> Vec<f64> {
    let pairs = curve.measured.iter().zip(model);
    pairs.map(|(y, p)| y - p).collect()
}
