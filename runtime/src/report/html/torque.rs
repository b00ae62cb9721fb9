//! Torque as measured and as predicted, and the residual, along one log.

use super::markup::{Element, classed, el};
use super::panel::{Curve, Frame, Panel, drawing, label};
use super::scale::padded_range;
use super::words::{number, percent, short};
use crate::report::{Fit, JointSeries, LogSeries, ModelSeries};

const SIZE: (f64, f64) = (620.0, 240.0);
const TORQUE: Frame = Frame {
    left: 56.0,
    top: 24.0,
    width: 556.0,
    height: 112.0,
};
const RESIDUAL: Frame = Frame {
    left: 56.0,
    top: 148.0,
    width: 556.0,
    height: 58.0,
};

/// A drawing per joint. The band of the residuals is that of `training`; curves have at most
/// `points` points.
pub(super) fn joints(log: &LogSeries, training: Option<&Fit>, points: usize) -> Vec<Element> {
    let joints = log.joints.iter().enumerate();
    joints
        .map(|(j, joint)| {
            let rmse = training
                .and_then(|fit| fit.joints.get(j))
                .map(|joint| joint.rmse);
            one(joint, rmse, points)
        })
        .collect()
}

fn one(joint: &JointSeries, training_rmse: Option<f64>, points: usize) -> Element {
    let words = format!("Torque and residual of {} over time", joint.name);
    drawing("plot", SIZE, &words)
        .child(heading(joint))
        .child(torque(joint, points))
        .child(residual(joint, training_rmse, points))
}

fn heading(joint: &JointSeries) -> Element {
    let error = joint.models.first().map_or(String::new(), |model| {
        let (pct, rmse) = (percent(model.rel_pct), number(model.rmse, 3));
        format!(
            "{}: error {pct}, rmse {rmse} {}",
            model.model.name(),
            joint.unit
        )
    });
    let name = label(TORQUE.left, 15.0, "start", &short(&joint.name, 36)).attr("class", "name");
    el("g")
        .child(name.child(el("title").text(&joint.name)))
        .child(label(TORQUE.left + TORQUE.width, 15.0, "end", &error))
}

fn torque(joint: &JointSeries, points: usize) -> Element {
    let measured = double(&joint.measured);
    // Only the first model widens the axis: another one that fails must not flatten the picture.
    let first = joint
        .models
        .first()
        .map_or(Vec::new(), |model| double(&model.predicted));
    let range = padded_range(measured.iter().chain(&first).copied());
    let mut panel = Panel::new(TORQUE, span(&joint.t), range);
    let mut draw = |class: &str, y: &[f64], name: String| {
        panel.curve(&Curve {
            class,
            name,
            x: &joint.t,
            y,
            points,
        });
    };
    draw("measured", &measured, "measured".to_owned());
    for model in &joint.models {
        let predicted = double(&model.predicted);
        draw(
            model.model.name(),
            &predicted,
            model.model.name().to_owned(),
        );
    }
    let title = if joint.unit == "N" {
        "force, N"
    } else {
        "torque, N m"
    };
    panel.finish(None, title, joint.unit)
}

fn residual(joint: &JointSeries, training_rmse: Option<f64>, points: usize) -> Element {
    let band = training_rmse.map_or(0.0, |rmse| 2.0 * rmse);
    let first = joint
        .models
        .first()
        .map_or(Vec::new(), |model| joint.residual(model));
    let range = padded_range(first.into_iter().chain([-band, band]));
    let mut panel = Panel::new(RESIDUAL, span(&joint.t), range);
    if training_rmse.is_some() {
        panel.band(-band, band);
    }
    for model in &joint.models {
        panel.curve(&Curve {
            class: &format!("{} residual", model.model.name()),
            name: residual_name(model),
            x: &joint.t,
            y: &joint.residual(model),
            points,
        });
    }
    panel.finish(Some("time, s"), "residual", joint.unit)
}

fn residual_name(model: &ModelSeries) -> String {
    format!("{} residual", model.model.name())
}

fn span(t: &[f64]) -> (f64, f64) {
    (
        t.first().copied().unwrap_or(0.0),
        t.last().copied().unwrap_or(1.0),
    )
}

fn double(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&value| f64::from(value)).collect()
}

/// Switches for the curves of all figures; the style sheet does the switching.
pub(super) fn switches(log: &LogSeries) -> Element {
    let models = log.joints.first().map_or(&[][..], |joint| &joint.models);
    let names = models.iter().map(|model| model.model.name());
    let shown = models.first().map(|model| model.model.name());
    let switch = |name: &'static str| {
        let input = el("input").attr("type", "checkbox").attr("value", name);
        let input = match name == "measured" || Some(name) == shown {
            true => input.attr("checked", "checked"),
            false => input,
        };
        let line = classed("path", &format!("curve {name}")).attr("d", "M0 5H26");
        let key = classed("svg", "key")
            .attr("viewBox", "0 0 26 10")
            .child(line);
        el("label").child(input).child(key).text(name)
    };
    classed("p", "switches")
        .text("Curves: ")
        .children(["measured"].into_iter().chain(names).map(switch))
}
