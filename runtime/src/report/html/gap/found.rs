//! What was found, effect by effect: how it looks, how large it is, what else it could be.

use super::super::figure;
use super::super::markup::{Element, classed, el};
use super::super::words::{number, percent, plus_minus, unit};
use super::verdict::name;
use super::{map, signature};
use crate::report::{Alternative, Diagnosis, FoundEffect, place};

/// A fall of the torque error, percent, that is hardly one.
const HARDLY: f64 = 1.0;

/// The effects, and what the residual that nothing explains looks like.
pub(super) fn sections(diagnosis: &Diagnosis) -> Vec<Element> {
    let effects = diagnosis.effects.iter().enumerate();
    let effects: Vec<Element> = effects.map(|(k, e)| one(diagnosis, k, e)).collect();
    let found = (!effects.is_empty()).then(|| {
        let section = el("section").child(el("h2").text("What was found"));
        section.children(effects)
    });
    let drawn = signature::unnamed(diagnosis);
    let maps = map::maps(diagnosis);
    let left = (!drawn.is_empty() || !maps.is_empty()).then(|| {
        let title = match found.is_some() {
            true => "What is left without a name",
            false => "What it looks like",
        };
        let caption = "Measured minus predicted torque on data that were not used to fit, over the \
                       variable that explains most of it; line: its mean.";
        let grid = classed("div", "grid2").children(drawn);
        let maps = (!maps.is_empty()).then(|| {
            let caption = "The same as a smooth function of the two variables that explain most of \
                           it; blank where the logs were not.";
            figure([classed("div", "grid2").children(maps)], caption)
        });
        el("section")
            .child(el("h2").text(title))
            .child(figure([grid], caption))
            .children(maps)
    });
    found.into_iter().chain(left).collect()
}

fn one(diagnosis: &Diagnosis, k: usize, effect: &FoundEffect) -> Element {
    let meaning = el("p")
        .text(format!("{}: torque ", effect.meaning))
        .child(el("code").text(&effect.formula));
    let lowers = match effect.gain_pct > HARDLY {
        true => format!(
            "It lowers the torque error by {} of what the model without it leaves",
            percent(effect.gain_pct)
        ),
        false => {
            "The torque error as such hardly changes; weighted by the noise of each joint and \
                  against what is known of the parameters it is there all the same"
                .to_owned()
        }
    };
    let gain = format!(
        "{lowers}: a gain of its size comes by chance with probability {}.",
        probability(effect.p_value)
    );
    let drawn = signature::of_effect(diagnosis, k).map(|drawing| {
        let caption = "Measured minus predicted torque on data that were not used to find it, over \
                       the variable that explains it; left without the effect and everything else \
                       refitted, right with it; lines: means.";
        figure([drawing], caption)
    });
    let beside = el("div")
        .child(meaning)
        .child(parameters(effect))
        .child(el("p").text(gain))
        .children(alternatives(effect));
    el("div")
        .child(el("h3").text(name(effect)))
        .child(classed("div", "pair").child(beside).children(drawn))
}

/// Parameters and shape with their error bars.
fn parameters(effect: &FoundEffect) -> Element {
    let head = ["parameter", "value \u{b1} 2\u{3c3}", "unit"];
    let head = el("tr").children(head.map(|title| el("th").text(title)));
    let value = effect.parameters.iter().map(|found| {
        let value = match found.sigma {
            Some(sigma) => plus_minus(found.value, sigma),
            None => format!("{} (not determined)", number(found.value, 4)),
        };
        row(&found.name, value, unit(&found.unit))
    });
    let shape = effect
        .shape
        .iter()
        .map(|(name, value)| row(name, number(*value, 4), "shape, SI".to_owned()));
    el("table")
        .child(el("thead").child(head))
        .child(el("tbody").children(value.chain(shape)))
}

fn row(name: &str, value: String, unit: String) -> Element {
    el("tr")
        .child(classed("th", "name").text(name))
        .child(classed("td", "number").text(value))
        .child(el("td").text(unit))
}

/// What else it could be, and the experiment that tells.
fn alternatives(effect: &FoundEffect) -> Vec<Element> {
    let words = |other: &Alternative| {
        let place = place(other.joint.as_deref(), &other.joints);
        let p = probability(other.p_value);
        match other.separable {
            true => format!("{}{place}: explains less (p {p})", other.effect),
            false => format!(
                "{}{place}: these logs do not tell it apart (p {p})",
                other.effect
            ),
        }
    };
    let to_tell = el("p").text(format!("The experiment that tells: {}.", effect.experiment));
    if effect.alternatives.is_empty() {
        return vec![
            el("p").text("No other entry of the catalogue comes near."),
            to_tell,
        ];
    }
    let items = effect.alternatives.iter();
    let items = items.map(|other| {
        let class = if other.separable { "" } else { "differs" };
        classed("li", class).text(words(other))
    });
    vec![
        el("p").text("What else it could be:"),
        el("ul").children(items),
        to_tell,
    ]
}

/// A probability; below what numbers can hold it is no zero.
pub(super) fn probability(p: f64) -> String {
    match p > 0.0 {
        true if p >= 0.001 => number(p, 2),
        true => format!("{p:.0e}").replace("e-", "e\u{2212}"),
        false => "below 1e\u{2212}300".to_owned(),
    }
}
