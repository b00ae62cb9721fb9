//! How the hypotheses ranked, and what was not taken and why.

use super::super::errors::{Bar, grouped};
use super::super::figure;
use super::super::markup::{Element, classed, el};
use super::super::words::number;
use super::found::probability;
use crate::report::{Diagnosis, RankedEffect, RejectedEffect, place};

/// Width of the names, pixels.
const NAMES: f64 = 200.0;

/// Hypotheses drawn of each step.
const SHOWN: usize = 8;

/// The ranking of each step, and what was rejected; `None` if nothing was looked at.
pub(super) fn section(diagnosis: &Diagnosis) -> Option<Element> {
    if diagnosis.ranking.is_empty() && diagnosis.rejected.is_empty() {
        return None;
    }
    let last = diagnosis.ranking.iter().map(|ranked| ranked.step).max();
    let steps = (0..=last.unwrap_or(0)).filter_map(|step| of_step(diagnosis, step));
    let caption = "Fall of the weighted sum of squares on the training logs, in units of the \
                   noise\u{2019}s variance: what counts as evidence. Blue: taken; grey: beyond \
                   chance, and not taken; hollow: what so many parameters and so many hypotheses \
                   gain by chance. Nothing is taken that a log of another motion does not confirm.";
    let drawings = classed("div", "grid2").children(steps);
    let rejected = (!diagnosis.rejected.is_empty()).then(|| {
        let rows = diagnosis.rejected.iter().map(row);
        let head = ["effect", "where", "why not"].map(|title| el("th").text(title));
        let head = el("thead").child(el("tr").children(head));
        let table = el("table").child(head).child(el("tbody").children(rows));
        el("div")
            .child(el("h3").text("Looked at and not taken"))
            .child(classed("div", "wide").child(table))
    });
    Some(
        el("section")
            .child(el("h2").text("How the candidates ranked"))
            .child(figure([drawings], caption))
            .children(rejected),
    )
}

fn of_step(diagnosis: &Diagnosis, step: usize) -> Option<Element> {
    let ranked = diagnosis
        .ranking
        .iter()
        .filter(|ranked| ranked.step == step);
    let groups: Vec<(String, Vec<Bar>)> = ranked
        .take(SHOWN)
        .map(|ranked| (short_name(ranked), vec![bar(diagnosis, ranked)]))
        .collect();
    if groups.is_empty() {
        return None;
    }
    let title = match step {
        0 => "with the model as it is described".to_owned(),
        1 => "with the first effect in it".to_owned(),
        n => format!("with {n} effects in it"),
    };
    let words = format!("Ranking {title}");
    let drawing = grouped(
        &groups,
        NAMES,
        "evidence: fall of the sum of squares",
        &words,
    );
    Some(el("div").child(el("h3").text(title)).child(drawing))
}

fn bar(diagnosis: &Diagnosis, ranked: &RankedEffect) -> Bar {
    let own = (&ranked.effect, &ranked.joints);
    let mut found = diagnosis.effects.iter();
    let taken = found.any(|effect| (&effect.effect, &effect.joints) == own);
    Bar {
        class: match taken {
            true => "held",
            false if ranked.margin > 0.0 => "training",
            false => "chance",
        },
        title: format!(
            "{}{}",
            ranked.effect,
            place(ranked.joint.as_deref(), &ranked.joints)
        ),
        value: ranked.gain,
        beside: format!(
            "{}, p {}",
            number(ranked.gain, 3),
            probability(ranked.p_value)
        ),
    }
}

/// An effect and its joints in few letters.
fn short_name(ranked: &RankedEffect) -> String {
    let joints: Vec<String> = ranked.joints.iter().map(usize::to_string).collect();
    let name = ranked.effect.replace('_', " ");
    match joints.is_empty() {
        true => name,
        false => format!("{} {}", joints.join(","), name),
    }
}

fn row(rejected: &RejectedEffect) -> Element {
    let place = place(rejected.joint.as_deref(), &rejected.joints);
    el("tr")
        .child(classed("th", "name").text(&rejected.effect))
        .child(el("td").text(place.trim().trim_start_matches("on ").to_owned()))
        .child(el("td").text(&rejected.why))
}
