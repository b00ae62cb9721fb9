//! The verdict in sentences.

use super::super::markup::{Element, classed, el};
use super::super::words::{count, list, number, percent};
use crate::report::{Changed, Diagnosis, FoundEffect, Verdict, changed, place as acting};

/// A torque error that falls by less stays.
const STAYS: f64 = 0.98;

/// Names in a sentence.
const NAMES: usize = 6;

/// Title of the page.
pub(super) fn title(diagnosis: &Diagnosis) -> String {
    let robot = &diagnosis.robot;
    if let Some(changed) = &diagnosis.changed {
        return format!("{robot}: {}", changed::sentence(diagnosis, changed));
    }
    match diagnosis.verdict {
        Verdict::Nothing => format!("{robot}: nothing is missing that these logs could show"),
        Verdict::Named => format!("{robot}: {}", names(diagnosis)),
        Verdict::Unknown if diagnosis.effects.is_empty() => {
            format!("{robot}: something is missing that has no name")
        }
        Verdict::Unknown => format!("{robot}: something is missing that is not explained"),
    }
}

/// The effects and where they act.
fn names(diagnosis: &Diagnosis) -> String {
    let names: Vec<String> = diagnosis.effects.iter().map(name).collect();
    list(&names, NAMES)
}

/// An effect and where it acts.
pub(super) fn name(effect: &FoundEffect) -> String {
    let place = acting(effect.joint.as_deref(), &effect.joints);
    format!("{}{place}", effect.effect.replace('_', " "))
}

/// Title, verdict, and what was looked at.
pub(super) fn header(diagnosis: &Diagnosis) -> Element {
    let class = match diagnosis.verdict {
        Verdict::Named => "verdict named",
        Verdict::Nothing => "verdict nothing",
        Verdict::Unknown => "verdict unknown",
    };
    let warnings = (!diagnosis.warnings.is_empty()).then(|| {
        let link = el("a")
            .attr("href", "#doubts")
            .text(count(diagnosis.warnings.len(), "warning"));
        classed("span", "warned").text(" ").child(link)
    });
    let confirmed = match (&diagnosis.changed, diagnosis.validation.is_empty()) {
        (Some(known), _) => format!("the parameters are known from {}", known.against),
        (None, true) => "no log of another motion confirms it".to_owned(),
        (None, false) => format!("confirmed and proven on {}", logs(&diagnosis.validation)),
    };
    let facts = format!("Fitted on {}; {confirmed}.", logs(&diagnosis.logs));
    el("header")
        .child(el("h1").text(title(diagnosis)))
        .child(classed("p", class).text(sentence(diagnosis)))
        .child(classed("p", "facts").text(facts).children(warnings))
}

/// What it comes to.
fn sentence(diagnosis: &Diagnosis) -> String {
    let before = percent(diagnosis.gap.torque.before.total_pct);
    let after = percent(diagnosis.gap.torque.after.total_pct);
    if let Some(changed) = &diagnosis.changed {
        return against(diagnosis, changed);
    }
    match (diagnosis.verdict, diagnosis.effects.is_empty()) {
        (Verdict::Nothing, _) => format!(
            "The model explains these logs down to their noise; it leaves {before} of the torque."
        ),
        (Verdict::Named, _) => lacking(diagnosis),
        (Verdict::Unknown, true) => "Something is there that no entry of the catalogue explains. \
             Below is where it is and what it varies with."
            .to_owned(),
        (Verdict::Unknown, false) => format!(
            "Something is missing. {} helps ({before} to {after}) and does not settle what it is: \
             take the name for a hint, not for the cause.",
            names(diagnosis)
        ),
    }
}

/// What has changed against known parameters, and what that does to the torque error.
fn against(diagnosis: &Diagnosis, known: &Changed) -> String {
    let (before, after) = totals(diagnosis);
    let falls = format!(
        "With it the torque error falls from {} to {} on {}.",
        percent(before),
        percent(after),
        on(diagnosis)
    );
    let contacts = match known.contacts.len() {
        0 => String::new(),
        n => format!(" Something touched the robot: {}.", count(n, "contact")),
    };
    match diagnosis.effects.is_empty() {
        true if diagnosis.verdict == Verdict::Unknown => format!(
            "The known parameters do not explain these logs, and none of the changes looked for \
             does.{contacts}"
        ),
        true if before == 0.0 => {
            format!("No joint moves enough for anything but contact to be looked for.{contacts}")
        }
        true => format!(
            "The known parameters explain these logs as well as free ones; they leave {} of the \
             torque.{contacts}",
            percent(before)
        ),
        false => format!("Changed: {}. {falls}{contacts}", names(diagnosis)),
    }
}

/// What the model lacks, and what that does to the torque error.
fn lacking(diagnosis: &Diagnosis) -> String {
    let (before, after) = totals(diagnosis);
    let (what, with, shows) = match diagnosis.effects.len() {
        1 => (String::new(), "it", "it shows"),
        n => (format!("{n} effects: "), "them", "they show"),
    };
    let names = names(diagnosis);
    if after > STAYS * before {
        return format!(
            "The model lacks {what}{names}. Refitted parameters can imitate {with}, so the torque \
             error stays at {}; {shows} against what is known of the parameters.",
            percent(after)
        );
    }
    let proven = match diagnosis.validation.is_empty() {
        true => "on the logs that were used to find it: nothing else proves it".to_owned(),
        false => format!("on data that were not used to find {with}"),
    };
    format!(
        "The model lacks {what}{names}. With {with} the torque error falls from {} to {}, {proven}.",
        percent(before),
        percent(after)
    )
}

/// Torque error of all joints before and after, percent.
fn totals(diagnosis: &Diagnosis) -> (f64, f64) {
    let gap = &diagnosis.gap.torque;
    (gap.before.total_pct, gap.after.total_pct)
}

/// How the gap shrinks.
pub(super) fn gap(diagnosis: &Diagnosis) -> String {
    let (before, after) = totals(diagnosis);
    let on = on(diagnosis);
    if diagnosis.effects.is_empty() {
        return format!(
            "Of the torque on {on}, {} is not predicted.",
            percent(before)
        );
    }
    let gap = &diagnosis.gap.torque;
    let joints = gap.before.joints.iter().zip(&gap.after.joints);
    let falls = joints.filter(|(b, a)| a.rmse < STAYS * b.rmse);
    let most = falls.max_by(|(b, a), (d, c)| (b.rmse / a.rmse).total_cmp(&(d.rmse / c.rmse)));
    let joint = most.map_or_else(String::new, |(before, after)| {
        format!(
            " It shrinks most at {}: {} to {} {} rms.",
            before.name,
            number(before.rmse, 3),
            number(after.rmse, 3),
            before.unit
        )
    });
    format!(
        "On {on} the torque error goes from {} to {}.{joint}",
        percent(before),
        percent(after)
    )
}

/// Logs without their folders.
fn logs(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| without_folders(name)).collect();
    list(&names, 3)
}

/// What the gap was measured on, without folders.
pub(super) fn on(diagnosis: &Diagnosis) -> String {
    let words = diagnosis.gap.on.split(' ').map(without_folders);
    words.collect::<Vec<_>>().join(" ")
}

fn without_folders(name: &str) -> String {
    name.rsplit('/').next().unwrap_or(name).to_owned()
}

/// Where the gap is.
pub(super) fn place(diagnosis: &Diagnosis) -> String {
    if diagnosis.located.is_empty() && diagnosis.changed.is_some() {
        return "At no joint is the torque error far above that of the same model with all its \
                parameters free."
            .to_owned();
    }
    if diagnosis.located.is_empty() {
        let plain =
            "At no joint does the residual hold more than noise, so far as these logs can tell.";
        return match diagnosis.effects.is_empty() {
            true => plain.to_owned(),
            false => format!("{plain} What was found shows against the described values."),
        };
    }
    let joints: Vec<String> = diagnosis
        .located
        .iter()
        .map(|joint| {
            let with = match joint.varies_with.is_empty() {
                true => String::new(),
                false => format!(", which varies with {}", joint.varies_with.join(" and ")),
            };
            format!(
                "{} ({} no noise{with})",
                joint.joint,
                percent(joint.unexplained_pct)
            )
        })
        .collect();
    format!(
        "The residual is more than noise at {}.",
        list(&joints, NAMES)
    )
}
