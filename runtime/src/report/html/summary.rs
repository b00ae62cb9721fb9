//! The verdicts at the top of the page, in sentences.

use super::comparison::contradictions;
use super::markup::{Element, classed, el};
use super::settings::{logs, samples};
use super::trust::Trust;
use super::whiteness::white_band;
use super::words::{count, list, number, percent};
use crate::report::{Fit, Identification, ModelResult};

/// A joint whose error exceeds this part of its torque, in percent, is said to be badly explained.
const BAD_PCT: f64 = 30.0;

/// Held-out errors up to this many times the training error: the parameters carry over.
const CARRIES: f64 = 1.25;

/// Beyond this many times they do not.
const FAILS: f64 = 2.0;

/// Names in a sentence.
const NAMES: usize = 6;

/// Robot, logs, and what was done.
pub(super) fn header(id: &Identification) -> Element {
    let about = id.truth.as_ref().map(|truth| el("p").text(&truth.about));
    let facts = format!("{} of {}", samples(id), logs(id));
    let models: Vec<String> = id
        .models
        .iter()
        .map(|model| format!("{} {}", model.name.name(), model.rows))
        .collect();
    let size = id.models.first().map_or(0, |model| model.parameters.len());
    let equations = format!(
        "{} from these numbers of equations: {}.",
        count(size, "parameter"),
        models.join(", ")
    );
    let warnings = (!id.warnings.is_empty()).then(|| {
        let link = el("a")
            .attr("href", "#warnings")
            .text(count(id.warnings.len(), "warning"));
        classed("span", "warned").text(" ").child(link)
    });
    el("header")
        .child(el("h1").text(title(id)))
        .children(about)
        .child(
            classed("p", "facts")
                .text(format!("{facts}. {equations}"))
                .children(warnings),
        )
}

/// The page's title.
pub(super) fn title(id: &Identification) -> String {
    match &id.truth {
        Some(truth) => truth.title.clone(),
        None => format!("{}: identified dynamic parameters", id.robot),
    }
}

/// Whether the model explains the data, from held-out logs if there are any.
pub(super) fn explains(model: &ModelResult) -> String {
    let training = percent(model.fit.total_pct);
    let name = model.name.name();
    let worst = model
        .validation
        .iter()
        .max_by(|a, b| a.fit.total_pct.total_cmp(&b.fit.total_pct));
    let Some(worst) = worst else {
        let bad = badly(&model.fit);
        return format!(
            "The {name} model leaves {training} of the training torque unexplained. No log was \
             held out, so this says nothing about other motions.{bad}"
        );
    };
    let ratio = worst.fit.total_pct / model.fit.total_pct;
    let judged = match ratio {
        ratio if ratio <= CARRIES => "the parameters carry over to motions they have not seen",
        ratio if ratio <= FAILS => {
            "the parameters carry over in part; expect the held-out error, not that of the training"
        }
        _ => "the parameters do not carry over: too little excitation, or a missing effect",
    };
    let (held, ratio) = (percent(worst.fit.total_pct), number(ratio, 3));
    let which = match model.validation.len() {
        1 => "the held-out log".to_owned(),
        n => format!("the worst of {n} held-out logs"),
    };
    format!(
        "On {which} the {name} model leaves {held} of the torque unexplained, {ratio} times the \
         training error of {training}: {judged}.{}",
        badly(&worst.fit)
    )
}

fn badly(fit: &Fit) -> String {
    let joints = fit.joints.iter().filter(|joint| joint.rel_pct > BAD_PCT);
    let names: Vec<String> = joints
        .map(|joint| format!("{} ({})", joint.name, percent(joint.rel_pct)))
        .collect();
    match names.is_empty() {
        true => String::new(),
        false => format!(
            " More than {BAD_PCT} % is missing at {}: small torques, or something the model does \
             not have.",
            list(&names, NAMES)
        ),
    }
}

/// Which parameters may be trusted.
pub(super) fn trusted(model: &ModelResult) -> String {
    let of = |trust: Trust| -> Vec<String> {
        let found = model.parameters.iter().filter(|p| Trust::of(p) == trust);
        found.map(|parameter| parameter.name.clone()).collect()
    };
    let [sharp, rough, doubtful, lost] = Trust::ALL.map(of);
    let mut text = format!(
        "Of {} in the {} model, {} have \u{3c3} of at most 10 % of their value",
        count(model.parameters.len(), "parameter"),
        model.name.name(),
        sharp.len()
    );
    if !rough.is_empty() {
        text += &format!(", {} of 10 to 50 %", rough.len());
    }
    text += match doubtful.is_empty() {
        true => ". None is doubtful.".to_owned(),
        false => format!(
            ". {} doubtful, their 2\u{3c3} reaching zero: {}.",
            verb(doubtful.len()),
            list(&doubtful, NAMES)
        ),
    }
    .as_str();
    if !lost.is_empty() {
        text += &format!(" Not determined by these logs: {}.", list(&lost, NAMES));
    }
    text
}

fn verb(n: usize) -> String {
    match n {
        1 => "1 is".to_owned(),
        n => format!("{n} are"),
    }
}

/// Whether the models agree.
pub(super) fn agree(id: &Identification) -> String {
    let mut found: Vec<_> = contradictions(id).into_iter().flatten().collect();
    if id.models.len() < 2 {
        return "One model only: nothing to compare.".to_owned();
    }
    found.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
    let names: Vec<String> = found
        .iter()
        .map(|f| {
            format!(
                "{} ({} / {}, {}\u{3c3})",
                f.parameter,
                f.models[0],
                f.models[1],
                number(f.sigmas, 2)
            )
        })
        .collect();
    match names.is_empty() {
        true => "No parameter differs by more than 2\u{3c3} between the models.".to_owned(),
        false => format!(
            "{} by more than 2\u{3c3} between the models, which points at the filters or at an \
             effect that the model lacks: {}.",
            count(names.len(), "parameter")
                + if names.len() == 1 {
                    " differs"
                } else {
                    " differ"
                },
            list(&names, NAMES)
        ),
    }
}

/// Whether the parameters have a sigma that respects autocorrelation.
pub(super) fn corrected(id: &Identification) -> bool {
    let mut parameters = id.models.iter().flat_map(|model| &model.parameters);
    parameters.any(|parameter| parameter.sigma_corrected.is_some())
}

/// The largest error of each model against the truth, where it is known.
pub(super) fn against_truth(id: &Identification) -> Option<String> {
    let truth = id.truth.as_ref()?;
    let worst = |model: &ModelResult| -> Option<String> {
        let errors = model.parameters.iter().zip(&truth.values);
        let errors = errors.filter(|(_, truth)| **truth != 0.0);
        let errors = errors.map(|(p, truth)| (&p.name, 100.0 * (p.solution / truth - 1.0).abs()));
        let (name, pct) = errors.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(format!("{} {} ({name})", model.name.name(), percent(pct)))
    };
    let models: Vec<String> = id.models.iter().filter_map(worst).collect();
    Some(format!(
        "Largest error against the true values: {}.",
        models.join(", ")
    ))
}

/// Joints whose residual remembers, with how many lags leave the band of white noise.
pub(super) fn white(id: &Identification) -> Option<String> {
    let log = super::drawn(id).into_iter().next()?;
    let band = white_band(log.rows);
    let mut coloured = Vec::new();
    for joint in &log.joints {
        let lags = &joint.models.first()?.autocorrelation;
        let outside = lags.iter().filter(|r| f64::from(r.abs()) > band).count();
        // One lag in twenty leaves the band by chance.
        if outside * 10 > lags.len() {
            coloured.push(format!("{} ({outside} of {})", joint.name, lags.len()));
        }
    }
    Some(match coloured.is_empty() {
        true => format!("On {}, the residuals look white.", log.log),
        false => format!(
            "On {}, the residuals are not white; lags outside the band: {}. What is left has \
             structure{}.",
            log.log,
            list(&coloured, 12),
            match corrected(id) {
                true => ", which the corrected \u{3c3} allow for",
                false => ", and \u{3c3} for independent errors is too small",
            }
        ),
    })
}
