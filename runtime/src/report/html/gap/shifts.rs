//! The parameters of the model with their error bars, refitted without and with what was found.

use super::super::figure;
use super::super::markup::{Element, classed, el};
use super::super::panel::{drawing, label, px};
use super::super::scale::Scale;
use super::super::words::{count, list, number, plus_minus, short, unit};
use crate::report::{Diagnosis, Estimated, Refitted};

const WIDTH: f64 = 660.0;
const ROW: f64 = 15.0;
const TOP: f64 = 6.0;

/// With more parameters the figure has two columns.
const ONE_COLUMN: usize = 26;

/// Half the width of the axis, in standard deviations.
const REACH: f64 = 12.0;

/// Beyond this many standard deviations a parameter has moved.
const MOVED: f64 = 3.0;

/// Names in a sentence.
const NAMES: usize = 8;

/// The parameters: a drawing of how they move, and a table.
pub(super) fn section(diagnosis: &Diagnosis) -> Element {
    let found = !diagnosis.effects.is_empty();
    let section = el("section")
        .child(el("h2").text("The parameters"))
        .child(classed("p", "answer").text(sentence(diagnosis)));
    let drawn = found.then(|| {
        let caption = "Each parameter as it is refitted with what was found (blue, \u{b1}2\u{3c3}), \
                       and where it was without (orange, \u{b1}2\u{3c3}), in standard deviations of \
                       the new value; arrows: further away than is drawn.";
        figure([shifts(&diagnosis.parameters)], caption)
    });
    let table = classed("div", "wide").child(table(diagnosis, found));
    let fold = el("details").child(el("summary").text("All values"));
    section.children(drawn).child(fold.child(table))
}

fn sentence(diagnosis: &Diagnosis) -> String {
    let all = &diagnosis.parameters;
    let refitted = format!(
        "{} refitted on the training logs",
        count(all.len(), "parameter")
    );
    if diagnosis.effects.is_empty() {
        return format!("{refitted}.");
    }
    let moved = all
        .iter()
        .filter(|p| shift(p).is_some_and(|s| s.abs() > MOVED));
    let moved: Vec<String> = moved.map(|p| p.name.clone()).collect();
    match moved.is_empty() {
        true => format!(
            "{refitted}, without and with what was found: none moves by more than {MOVED} \u{3c3}."
        ),
        false => format!(
            "{refitted}. Without what was found these had taken some of it upon themselves, and \
             move by more than {MOVED} \u{3c3}: {}.",
            list(&moved, NAMES)
        ),
    }
}

/// Distance of the value without the effects from that with them, in standard deviations of it.
fn shift(parameter: &Refitted) -> Option<f64> {
    let sigma = parameter.after.sigma.filter(|sigma| *sigma > 0.0)?;
    let shift = (parameter.before.value - parameter.after.value) / sigma;
    shift.is_finite().then_some(shift)
}

fn shifts(parameters: &[Refitted]) -> Element {
    let columns = if parameters.len() > ONE_COLUMN { 2 } else { 1 };
    let rows = parameters.len().div_ceil(columns);
    let bottom = TOP + rows as f64 * ROW;
    let width = WIDTH / columns as f64;
    let drawing = drawing(
        "trust",
        (WIDTH, bottom + 30.0),
        "How far each parameter moves with what was found",
    );
    let column = |k: usize| {
        let left = k as f64 * width;
        let x = Scale::linear((-REACH, REACH), (left + 70.0, left + width - 16.0));
        let own = parameters.iter().skip(k * rows).take(rows).enumerate();
        let rows = own.map(|(row, p)| one(p, &x, (left, TOP + row as f64 * ROW)));
        el("g").children(axis(&x, bottom)).children(rows)
    };
    drawing.children((0..columns).map(column))
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
    let middle = x.at(0.0);
    let title = "standard deviations from the new value";
    marks.push(label(middle, bottom + 27.0, "middle", title).attr("class", "axis"));
    marks
}

fn one(parameter: &Refitted, x: &Scale, (left, top): (f64, f64)) -> Element {
    let y = top + ROW / 2.0;
    let name = label(left + 2.0, y + 3.5, "start", &short(&parameter.name, 9));
    let words = format!(
        "{}: {} before, {} after, {}",
        parameter.name,
        value(&parameter.before),
        value(&parameter.after),
        unit(&parameter.unit)
    );
    let group = el("g").child(el("title").text(words)).child(name);
    let Some(shift) = shift(parameter) else {
        return group.child(label(x.at(0.0), y + 3.5, "middle", "not determined"));
    };
    let wide = match (parameter.before.sigma, parameter.after.sigma) {
        (Some(before), Some(after)) => 2.0 * before / after,
        _ => 0.0,
    };
    group
        .child(whisker(x, (shift - wide, shift + wide), y, "before"))
        .child(dot(x, shift, y, "before"))
        .child(whisker(x, (-2.0, 2.0), y, "after"))
        .child(dot(x, 0.0, y, "after"))
}

fn whisker(x: &Scale, (low, high): (f64, f64), y: f64, class: &str) -> Element {
    let d = format!("M{} {}H{}", px(x.at(low)), px(y), px(x.at(high)));
    classed("path", &format!("whisker {class}")).attr("d", d)
}

/// A dot, or an arrow where the value lies outside.
fn dot(x: &Scale, value: f64, y: f64, class: &str) -> Element {
    let class = format!("dot {class}");
    if x.holds(value) {
        return classed("circle", &class)
            .attr("cx", px(x.at(value)))
            .attr("cy", px(y))
            .attr("r", 2.8);
    }
    let at = px(x.at(value));
    let back = px(x.at(value) - 6.0 * value.signum());
    let d = format!(
        "M{back} {}L{at} {}L{back} {}Z",
        px(y - 3.5),
        px(y),
        px(y + 3.5)
    );
    classed("path", &class).attr("d", d)
}

fn value(estimated: &Estimated) -> String {
    match estimated.sigma {
        Some(sigma) => plus_minus(estimated.value, sigma),
        None => format!("{} (not determined)", number(estimated.value, 4)),
    }
}

fn table(diagnosis: &Diagnosis, found: bool) -> Element {
    let mut titles = vec!["parameter", "unit"];
    titles.extend(match found {
        true => &[
            "before \u{b1} 2\u{3c3}",
            "after \u{b1} 2\u{3c3}",
            "moves by",
        ][..],
        false => &["value \u{b1} 2\u{3c3}"][..],
    });
    let head = el("tr").children(titles.into_iter().map(|title| el("th").text(title)));
    let cell = |text: String| classed("td", "number").text(text);
    let row = |parameter: &Refitted| {
        let mut row = el("tr")
            .child(classed("th", "name").text(&parameter.name))
            .child(classed("td", "unit").text(unit(&parameter.unit)))
            .child(cell(value(&parameter.before)));
        if found {
            let moved = shift(parameter).filter(|shift| shift.abs() > 0.05);
            let moved = moved.map(|shift| format!("{} \u{3c3}", number(-shift, 2)));
            row = row
                .child(cell(value(&parameter.after)))
                .child(cell(moved.unwrap_or_default()));
        }
        row
    };
    el("table")
        .child(el("thead").child(head))
        .child(el("tbody").children(diagnosis.parameters.iter().map(row)))
}
