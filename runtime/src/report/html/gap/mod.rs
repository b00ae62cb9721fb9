//! A diagnosis as one self-contained page: what is missing, where, how sure that is, and how the
//! gap shrinks.

mod changed;
mod curves;
mod evidence;
mod found;
mod map;
mod shifts;
mod signature;
#[cfg(test)]
mod tests;
mod verdict;

use super::errors;
use super::markup::{Element, classed, el};
use super::{figure, page, question, settings};
use crate::report::{Diagnosis, Verdict};

/// Renders a diagnosis as a self-contained page of HTML, a function of the value alone. Curves are
/// there if the diagnosis has [`crate::report::Pictures`].
pub fn diagnosis_html(diagnosis: &Diagnosis) -> String {
    page(&verdict::title(diagnosis), sections(diagnosis))
}

/// Everything about a diagnosis.
pub(super) fn sections(diagnosis: &Diagnosis) -> Vec<Element> {
    let mut all = vec![verdict::header(diagnosis)];
    all.extend(changed::section(diagnosis));
    // Known parameters predict nothing of joints at rest.
    let at_rest = diagnosis.changed.is_some() && diagnosis.gap.torque.before.total_pct == 0.0;
    all.extend((!at_rest).then(|| first_screen(diagnosis)));
    all.extend(found::sections(diagnosis));
    all.extend(curves::torque(diagnosis));
    all.extend(curves::motion(diagnosis));
    all.extend(evidence::section(diagnosis));
    // Known parameters do not shift.
    all.extend((diagnosis.changed.is_none()).then(|| shifts::section(diagnosis)));
    all.push(provenance(diagnosis));
    all
}

/// How large the gap is, and where.
fn first_screen(diagnosis: &Diagnosis) -> Element {
    let (before, after) = (&diagnosis.gap.torque.before, &diagnosis.gap.torque.after);
    let model = match diagnosis.changed {
        Some(_) => "the known parameters",
        None => "the model as it is described",
    };
    let fits = match diagnosis.effects.is_empty() {
        true => vec![("training", model.to_owned(), before)],
        false => vec![
            ("before", format!("before: {model}"), before),
            ("held", "after: with what was found".to_owned(), after),
        ],
    };
    let caption = format!(
        "Rms of measured minus predicted torque, as a share of the rms of the torque, and in \
         brackets in absolute terms, on {}. {}",
        verdict::on(diagnosis),
        match diagnosis.effects.is_empty() {
            _ if diagnosis.changed.is_some() => {
                "Orange: the known parameters; blue: with what has changed."
            }
            true => "The parameters were refitted on the training logs.",
            false => {
                "Orange: the model as it is described, its parameters refitted; blue: refitted \
                 with what was found."
            }
        }
    );
    let words = "Torque error of each joint before and after, percent";
    let gap = question("How large is the gap?", &verdict::gap(diagnosis))
        .child(figure([errors::fits_side_by_side(&fits, words)], &caption));
    classed("section", "pair")
        .child(gap)
        .child(place(diagnosis))
}

/// Where the gap is.
fn place(diagnosis: &Diagnosis) -> Element {
    let about = question("Where is it?", &verdict::place(diagnosis));
    if diagnosis.located.is_empty() {
        return about;
    }
    let bar = |joint: &crate::report::Located| {
        let bar = errors::Bar {
            class: "before",
            title: "not explained".to_owned(),
            value: joint.unexplained_pct,
            beside: joint.varies_with.join(", "),
        };
        (joint.joint.clone(), vec![bar])
    };
    let groups: Vec<_> = diagnosis.located.iter().map(bar).collect();
    let axis = "share of the residual\u{2019}s variance that is no noise, %";
    let words = "What of the residual of each joint is no noise";
    let caption = match diagnosis.changed {
        Some(_) => {
            "With what has changed, on the logs that it was found on. Noise is what the same model \
             leaves when all its parameters are free."
        }
        None => {
            "Of the model as it is described, on the training logs; beside each bar what the \
             unexplained part varies with, the strongest first. Noise is what does not \
             repeat from one period of the motion to the next, or, where nothing repeats, \
             what a generic model of the joint leaves."
        }
    };
    about.child(figure(
        [errors::grouped(&groups, errors::NAMES, axis, words)],
        caption,
    ))
}

/// Warnings, filters, and the command lines.
fn provenance(diagnosis: &Diagnosis) -> Element {
    let warnings = match diagnosis.warnings.is_empty() {
        true => el("p").text("None."),
        false => el("ul").children(diagnosis.warnings.iter().map(|text| el("li").text(text))),
    };
    let section = el("section")
        .child(el("h2").attr("id", "doubts").text("Warnings"))
        .child(warnings)
        .child(el("h2").text("Logs and filters"))
        .child(classed("div", "wide").child(settings::of_diagnosis(diagnosis)));
    let Some(command) = &diagnosis.command else {
        return section;
    };
    let mut commands = command.clone();
    if diagnosis.verdict != Verdict::Nothing && !command.contains(" --write ") {
        commands += "\n# the same, and the description with what was found:\n";
        commands += command;
        commands += " --write found.toml";
    }
    section
        .child(el("h2").text("The command that gives this page"))
        .child(el("pre").child(el("code").text(commands)))
}
