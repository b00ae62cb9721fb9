//! Does the model explain the data? The torque error of each joint, held out against training.

use super::markup::{Element, classed, el};
use super::panel::{drawing, label, px};
use super::scale::{Scale, round_range};
use super::words::{number, percent, short};
use crate::report::{Fit, ModelResult};

const WIDTH: f64 = 620.0;
const LEFT: f64 = 132.0;
const RIGHT: f64 = 150.0;
const BAR: f64 = 12.0;
/// More validation logs than this are in the table only.
const MOST_LOGS: usize = 4;

/// One bar: its kind, its percentage, and what is written beside it.
struct Bar {
    class: &'static str,
    title: String,
    pct: f64,
    beside: String,
}

/// Bars of the torque error per joint and of all joints, for one model.
pub(super) fn bars(model: &ModelResult) -> Element {
    let names: Vec<&str> = model
        .fit
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    let mut groups: Vec<(String, Vec<Bar>)> = names
        .iter()
        .enumerate()
        .map(|(j, name)| ((*name).to_owned(), group(model, |fit| joint(fit, j))))
        .collect();
    groups.push((
        "all joints".to_owned(),
        group(model, |fit| (fit.total_pct, String::new())),
    ));
    let largest = groups.iter().flat_map(|(_, bars)| bars).map(|bar| bar.pct);
    let (_, high) = round_range(largest.chain([0.0]), 5);
    let x = Scale::linear((0.0, high), (LEFT, WIDTH - RIGHT));
    let mut marks = Vec::new();
    let mut top = 6.0;
    for (name, bars) in &groups {
        marks.extend(drawn(name, bars, &x, top));
        top += bars.len() as f64 * BAR + 14.0;
    }
    let words = format!(
        "Torque error of each joint, {} model, percent",
        model.name.name()
    );
    drawing("bars", (WIDTH, top + 30.0), &words)
        .children(axis(&x, top))
        .children(marks)
}

/// The bars of one joint: each validation log, then training.
fn group(model: &ModelResult, of: impl Fn(&Fit) -> (f64, String)) -> Vec<Bar> {
    let bar = |class, title: String, fit: &Fit| {
        let (pct, beside) = of(fit);
        Bar {
            class,
            title,
            pct,
            beside,
        }
    };
    let held = model.validation.iter().take(MOST_LOGS);
    held.map(|validation| {
        bar(
            "held",
            format!("held out: {}", validation.log),
            &validation.fit,
        )
    })
    .chain([bar("training", "training".to_owned(), &model.fit)])
    .collect()
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

fn drawn(name: &str, bars: &[Bar], x: &Scale, top: f64) -> Vec<Element> {
    let middle = top + bars.len() as f64 * BAR / 2.0 + 4.0;
    let title = el("title").text(name);
    let mut marks = vec![
        label(LEFT - 8.0, middle, "end", &short(name, 20))
            .attr("class", "name")
            .child(title),
    ];
    for (k, bar) in bars.iter().enumerate() {
        let y = top + k as f64 * BAR;
        let beside = match bar.beside.is_empty() {
            true => percent(bar.pct),
            false => format!("{} ({})", percent(bar.pct), bar.beside),
        };
        let width = px(x.at(bar.pct) - LEFT).max(0.5);
        let rect = classed("rect", &format!("bar {}", bar.class))
            .attr("x", LEFT)
            .attr("y", px(y + 0.75))
            .attr("width", width)
            .attr("height", BAR - 1.5);
        marks.push(rect.child(el("title").text(format!("{}: {beside}", bar.title))));
        marks.push(
            label(x.at(bar.pct) + 5.0, y + BAR - 2.5, "start", &beside).attr("class", bar.class),
        );
    }
    marks
}

fn axis(x: &Scale, bottom: f64) -> Vec<Element> {
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
    let title = "torque error, % of the measured torque (rms)";
    let middle = (LEFT + WIDTH - RIGHT) / 2.0;
    marks.push(label(middle, bottom + 27.0, "middle", title).attr("class", "axis"));
    marks
}
