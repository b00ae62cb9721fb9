//! Does the model explain the data? The torque error of each joint, held out against training.

use super::markup::{Element, classed, el};
use super::panel::{drawing, label, px};
use super::scale::{Scale, round_range};
use super::words::{number, percent, short};
use crate::report::{Fit, ModelResult};

const WIDTH: f64 = 620.0;
/// Width of the names of joints, pixels.
pub(super) const NAMES: f64 = 132.0;
const RIGHT: f64 = 150.0;
const BAR: f64 = 12.0;
/// More validation logs than this are in the table only.
const MOST_LOGS: usize = 4;

/// One bar: its kind, its length, and what is written beside it.
pub(super) struct Bar {
    pub class: &'static str,
    pub title: String,
    pub value: f64,
    pub beside: String,
}

/// Bars of the torque error per joint and of all joints, for one model.
pub(super) fn bars(model: &ModelResult) -> Element {
    let held = model.validation.iter().take(MOST_LOGS);
    let held = held.map(|validation| {
        let title = format!("held out: {}", validation.log);
        ("held", title, &validation.fit)
    });
    let training = ("training", "training".to_owned(), &model.fit);
    let fits: Vec<(&'static str, String, &Fit)> = held.chain([training]).collect();
    let words = format!(
        "Torque error of each joint, {} model, percent",
        model.name.name()
    );
    fits_side_by_side(&fits, &words)
}

/// Bars of the torque errors of some fits, each with its class and what it is called.
pub(super) fn fits_side_by_side(fits: &[(&'static str, String, &Fit)], words: &str) -> Element {
    let joints = fits.first().map_or(&[][..], |(.., fit)| &fit.joints);
    let mut groups: Vec<(String, Vec<Bar>)> = joints
        .iter()
        .enumerate()
        .map(|(j, joint)| (joint.name.clone(), group(fits, |fit| self::joint(fit, j))))
        .collect();
    groups.push((
        "all joints".to_owned(),
        group(fits, |fit| (fit.total_pct, String::new())),
    ));
    let title = "torque error, % of the measured torque (rms)";
    grouped(&groups, NAMES, title, words)
}

/// Groups of bars with their names, which take `left` pixels, over an axis of that title.
pub(super) fn grouped(
    groups: &[(String, Vec<Bar>)],
    left: f64,
    axis_title: &str,
    words: &str,
) -> Element {
    let largest = groups
        .iter()
        .flat_map(|(_, bars)| bars)
        .map(|bar| bar.value);
    let (_, high) = round_range(largest.chain([0.0]), 5);
    let x = Scale::linear((0.0, high), (left, WIDTH - RIGHT));
    let mut marks = Vec::new();
    let mut top = 6.0;
    for (name, bars) in groups {
        marks.extend(drawn(name, bars, &x, (left, top)));
        top += bars.len() as f64 * BAR + 14.0;
    }
    drawing("bars", (WIDTH, top + 30.0), words)
        .children(axis(&x, (left, top), axis_title))
        .children(marks)
}

/// The bars of one joint.
fn group(fits: &[(&'static str, String, &Fit)], of: impl Fn(&Fit) -> (f64, String)) -> Vec<Bar> {
    let bar = |(class, title, fit): &(&'static str, String, &Fit)| {
        let (value, absolute) = of(fit);
        Bar {
            class,
            title: title.clone(),
            value,
            beside: match absolute.is_empty() {
                true => percent(value),
                false => format!("{} ({absolute})", percent(value)),
            },
        }
    };
    fits.iter().map(bar).collect()
}

fn joint(fit: &Fit, j: usize) -> (f64, String) {
    fit.joints
        .get(j)
        .map_or((f64::NAN, String::new()), |joint| {
            (
                joint.rel_pct,
                format!("{} {}", number(joint.rmse, 3), joint.unit),
            )
        })
}

fn drawn(name: &str, bars: &[Bar], x: &Scale, (left, top): (f64, f64)) -> Vec<Element> {
    let middle = top + bars.len() as f64 * BAR / 2.0 + 4.0;
    let title = el("title").text(name);
    let mut marks = vec![
        label(
            left - 8.0,
            middle,
            "end",
            &short(name, (left / 6.6) as usize),
        )
        .attr("class", "name")
        .child(title),
    ];
    for (k, bar) in bars.iter().enumerate() {
        let y = top + k as f64 * BAR;
        let width = px(x.at(bar.value) - left).max(0.5);
        let rect = classed("rect", &format!("bar {}", bar.class))
            .attr("x", left)
            .attr("y", px(y + 0.75))
            .attr("width", width)
            .attr("height", BAR - 1.5);
        marks.push(rect.child(el("title").text(format!("{}: {}", bar.title, bar.beside))));
        marks.push(
            label(x.at(bar.value) + 5.0, y + BAR - 2.5, "start", &bar.beside)
                .attr("class", bar.class),
        );
    }
    marks
}

fn axis(x: &Scale, (left, bottom): (f64, f64), title: &str) -> Vec<Element> {
    let mut marks = Vec::new();
    for tick in x.ticks(5) {
        let at = px(x.at(tick.value));
        let class = if tick.value == 0.0 {
            "grid zero"
        } else {
            "grid"
        };
        marks.push(classed("path", class).attr("d", format!("M{at} 2V{}", px(bottom))));
        marks.push(label(at, bottom + 13.0, "middle", &tick.label));
    }
    let middle = (left + WIDTH - RIGHT) / 2.0;
    marks.push(label(middle, bottom + 27.0, "middle", title).attr("class", "axis"));
    marks
}
