//! The models side by side: parameters, where they contradict one another, and the equations.

use super::markup::{Element, classed, el};
use super::trust::{Trust, sigma};
use super::words::{number, percent, plus_minus, unit};
use crate::report::{Fit, Identification, ModelResult, ParameterResult};

/// Two models that contradict each other about a parameter.
pub(super) struct Contradiction {
    pub parameter: String,
    pub models: [&'static str; 2],
    /// Distance of the two values over the standard deviation of two independent estimates.
    pub sigmas: f64,
}

/// Where two models differ by more than 2 sigma, the worst pair for each parameter. Both come
/// from the same log, so their errors go along; the sigma of independent ones is too large, and
/// what differs by 2 of it differs indeed.
pub(super) fn contradictions(id: &Identification) -> Vec<Option<Contradiction>> {
    let count = id.models.first().map_or(0, |model| model.parameters.len());
    (0..count).map(|k| contradiction(&id.models, k)).collect()
}

fn contradiction(models: &[ModelResult], k: usize) -> Option<Contradiction> {
    let mut worst: Option<Contradiction> = None;
    for (i, one) in models.iter().enumerate() {
        for other in &models[i + 1..] {
            let (a, b) = (one.parameters.get(k)?, other.parameters.get(k)?);
            let Some(sigmas) = distance(a, b) else {
                continue;
            };
            if sigmas > 2.0 && worst.as_ref().is_none_or(|worst| sigmas > worst.sigmas) {
                worst = Some(Contradiction {
                    parameter: a.name.clone(),
                    models: [one.name.name(), other.name.name()],
                    sigmas,
                });
            }
        }
    }
    worst
}

fn distance(a: &ParameterResult, b: &ParameterResult) -> Option<f64> {
    let difference = (a.value? - b.value?).abs();
    let sigma = sigma(a)?.hypot(sigma(b)?);
    (sigma > 0.0).then(|| difference / sigma)
}

/// Values of all models, what they stand for, and how they differ.
pub(super) fn parameters(id: &Identification) -> Element {
    let truth = id.truth.as_ref().map(|truth| truth.values.as_slice());
    let mut head = el("tr").children(["parameter", "unit"].map(|title| el("th").text(title)));
    if truth.is_some() {
        head = head.child(classed("th", "number").text("true"));
    }
    for model in &id.models {
        let name = model.name.name();
        head = head.child(classed("th", "number").text(format!("{name}, \u{b1} 2\u{3c3}")));
        let share = if truth.is_some() { "error" } else { "%\u{3c3}" };
        head = head.child(classed("th", "number").text(share));
    }
    head = head.children(["differ", "stands for"].map(|title| el("th").text(title)));
    let contradictions = contradictions(id);
    let first = id.models.first().map_or(&[][..], |model| &model.parameters);
    let rows = first.iter().enumerate().map(|(k, parameter)| {
        row(
            id,
            k,
            parameter,
            truth.and_then(|truth| truth.get(k)),
            contradictions.get(k),
        )
    });
    el("table")
        .child(el("thead").child(head))
        .child(el("tbody").children(rows))
}

fn row(
    id: &Identification,
    k: usize,
    parameter: &ParameterResult,
    truth: Option<&f64>,
    differ: Option<&Option<Contradiction>>,
) -> Element {
    let mut row = el("tr")
        .child(classed("th", "name").text(&parameter.name))
        .child(classed("td", "unit").text(unit(&parameter.unit)));
    row = row.children(truth.map(|truth| cell(number(*truth, 5))));
    for parameter in id.models.iter().filter_map(|model| model.parameters.get(k)) {
        row = row.children(estimate(parameter, truth));
    }
    let differ = differ.and_then(Option::as_ref).map(|found| {
        format!(
            "{} / {}: {}\u{3c3}",
            found.models[0],
            found.models[1],
            number(found.sigmas, 2)
        )
    });
    let class = if differ.is_some() { "differs" } else { "" };
    row.child(classed("td", class).text(differ.unwrap_or_default()))
        .child(classed("td", "relation").text(parameter.relation.replace('*', "\u{b7}")))
}

/// Value with 2 sigma, then %sigma, or the error where the truth is known.
fn estimate(parameter: &ParameterResult, truth: Option<&f64>) -> [Element; 2] {
    let class = format!("number {}", Trust::of(parameter).class());
    let Some(value) = parameter.value else {
        let text = classed("td", &class).text("not determined");
        return [text, cell(String::new())];
    };
    let share = match truth {
        Some(truth) => percent(100.0 * (value - truth) / truth.abs()),
        None => super::trust::relative(parameter).map_or_else(String::new, percent),
    };
    let spread = sigma(parameter).unwrap_or(0.0);
    [
        classed("td", &class).text(plus_minus(value, spread)),
        cell(share),
    ]
}

fn cell(text: String) -> Element {
    classed("td", "number").text(text)
}

/// A table with a line per quantity and a column per model.
struct Lines<'a> {
    models: &'a [ModelResult],
    rows: Vec<Element>,
}

impl Lines<'_> {
    fn line(&mut self, title: &str, of: impl Fn(&ModelResult) -> String) {
        let cells = self.models.iter().map(|model| cell(of(model)));
        let row = el("tr").child(el("th").text(title)).children(cells);
        self.rows.push(row);
    }

    /// The torque errors of one kind of log: all joints, then each.
    fn errors(&mut self, title: &str, fit: impl Fn(&ModelResult) -> Option<&Fit>) {
        let total = |fit: &Fit| percent(fit.total_pct);
        self.line(&format!("torque error, {title}"), |model| {
            fit(model).map_or_else(String::new, total)
        });
        let joints = self.models.first().and_then(&fit);
        let names = joints.map_or(&[][..], |fit| &fit.joints).iter();
        let names: Vec<String> = names.map(|joint| joint.name.clone()).collect();
        for (j, name) in names.iter().enumerate() {
            self.line(&format!("\u{2003}{name}"), |model| {
                let joint = fit(model).and_then(|fit| fit.joints.get(j));
                joint.map_or_else(String::new, |joint| {
                    let (pct, rmse) = (percent(joint.rel_pct), number(joint.rmse, 3));
                    format!("{pct} ({rmse} {})", joint.unit)
                })
            });
        }
    }
}

/// Size, rank, condition and torque errors of the models.
pub(super) fn equations(id: &Identification) -> Element {
    let names = id.models.iter().map(|model| model.name.name());
    let head = el("tr").child(el("th").text("model"));
    let head = head.children(names.map(|name| classed("th", "number").text(name)));
    let mut lines = Lines {
        models: &id.models,
        rows: Vec::new(),
    };
    lines.line("equations r", |m| m.rows.to_string());
    lines.line("rank of W", |m| {
        format!("{} of {}", m.rank, m.parameters.len())
    });
    lines.line("condition of W, as weighted", |m| number(m.condition, 4));
    lines.line("digits that are numerically certain", |m| {
        format!("{:.1}", m.certified_digits)
    });
    lines.line("residual of its own equations", |m| percent(m.equation_pct));
    lines.errors("training", |model| Some(&model.fit));
    let logs = id.models.first().map_or(&[][..], |model| &model.validation);
    for (k, log) in logs.iter().enumerate() {
        lines.errors(&log.log, |model| {
            model.validation.get(k).map(|log| &log.fit)
        });
    }
    el("table")
        .child(el("thead").child(head))
        .child(el("tbody").children(lines.rows))
}
