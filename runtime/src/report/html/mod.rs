//! An identification as one self-contained page: it opens offline, prints, and asks nobody for
//! anything.
//!
//! Drawings are SVG elements made here, so that the page stays small, prints sharply, and can be
//! tested without a browser; the script adds a read-out under the pointer, and the page says the
//! same without it. `markup` is the only place that writes text and escapes it.

mod comparison;
mod errors;
mod gap;
mod markup;
mod panel;
mod scale;
mod settings;
mod summary;
#[cfg(test)]
mod tests;
mod torque;
mod trust;
mod whiteness;
mod words;

use super::{Diagnosis, Identification, LogSeries, ModelResult, Role};
pub use gap::diagnosis_html;
use markup::{Element, classed, el};

/// Points of all torque curves of a page together: about one megabyte.
const POINTS: usize = 90_000;

/// Points of one curve, at which each pixel column of a drawing has two.
const MOST_POINTS: usize = 1100;

/// Logs that are drawn; the errors of all of them are in the tables.
const MOST_LOGS: usize = 6;

/// The page allows its own style and script and nothing from anywhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// Renders an identification as a self-contained page of HTML, a function of the value alone.
/// Torque curves and spectra are there for the logs in [`Identification::series`].
pub fn html(identification: &Identification) -> String {
    page(&summary::title(identification), sections(identification))
}

/// A story of two parts on one page: what is missing, and before it, what is there. `about` are
/// paragraphs for the top.
pub fn story(
    title: &str,
    about: &[String],
    diagnosis: &Diagnosis,
    identification: &Identification,
) -> String {
    let link = |to: &str, text: &str| el("a").attr("href", to).text(text);
    let top = el("header")
        .child(el("h1").text(title))
        .children(about.iter().map(|text| classed("p", "answer").text(text)))
        .child(
            classed("p", "facts")
                .text("On this page: ")
                .child(link("#diagnosis", "what the model is missing"))
                .text(", ")
                .child(link("#identification", "the parameters by three models"))
                .text("."),
        );
    let part =
        |id: &str, sections: Vec<Element>| classed("div", "part").attr("id", id).children(sections);
    let parts = [
        top,
        part("diagnosis", gap::sections(diagnosis)),
        part("identification", sections(identification)),
    ];
    page(title, parts)
}

/// A page of that title with some parts.
fn page(title: &str, parts: impl IntoIterator<Item = Element>) -> String {
    let body = el("body")
        .child(el("main").children(parts))
        .child(
            classed("div", "readout")
                .attr("id", "readout")
                .attr("hidden", "hidden"),
        )
        .child(el("script").own(include_str!("page.js")));
    let mut page = String::from("<!DOCTYPE html>\n");
    el("html")
        .attr("lang", "en")
        .child(head(title))
        .child(body)
        .write(&mut page);
    page
}

fn head(title: &str) -> Element {
    let meta = |name: &str, content: &str| el("meta").attr("name", name).attr("content", content);
    el("head")
        .child(el("meta").attr("charset", "utf-8"))
        .child(
            el("meta")
                .attr("http-equiv", "Content-Security-Policy")
                .attr("content", POLICY),
        )
        .child(meta("viewport", "width=device-width, initial-scale=1"))
        .child(meta(
            "generator",
            concat!("idim ", env!("CARGO_PKG_VERSION")),
        ))
        .child(el("title").text(title))
        .child(el("style").own(include_str!("page.css")))
}

/// Everything about an identification.
fn sections(id: &Identification) -> Vec<Element> {
    let mut all = vec![summary::header(id)];
    match id.models.first() {
        None => all.push(el("p").text("No model was asked for.")),
        Some(model) => {
            all.push(first_screen(id, model));
            all.extend(torques(id, model));
            all.extend(residuals(id));
            all.push(models(id));
        }
    }
    all.push(provenance(id));
    all
}

/// The two questions that everybody asks first.
fn first_screen(id: &Identification, model: &ModelResult) -> Element {
    let truth = id.truth.as_ref().map(|truth| truth.values.as_slice());
    let rows = model.rows;
    let errors = format!(
        "Rms of measured minus predicted torque, as a share of the rms of the torque, and in \
         brackets in absolute terms; {} model. Blue: held-out logs, which the parameters have \
         never seen; grey: training ({rows} equations).",
        model.name.name(),
    );
    let mut bars = format!(
        "Each parameter's \u{b1}2\u{3c3} in percent of its value, the sharpest first ({} model, r = \
         {rows}). Filled dots: \u{3c3} up to 10 %; hollow: up to 50 %; crosses, in red: 2\u{3c3} \
         reaches zero. A doubtful parameter is one these logs hardly excite, or one that matters \
         little.",
        model.name.name()
    );
    if truth.is_some() {
        bars += " Diamonds: the true values.";
    }
    bars += match summary::corrected(id) {
        true => " \u{3c3} respects the autocorrelation of the residuals.",
        false => {
            " \u{3c3} assumes independent errors and is too small where residuals are not white."
        }
    };
    let mut trusted = summary::trusted(model);
    if let Some(errors) = summary::against_truth(id) {
        trusted = format!("{trusted} {errors}");
    }
    classed("section", "pair")
        .child(
            question(
                "Does the model explain the data?",
                &summary::explains(model),
            )
            .child(figure([errors::bars(model)], &errors)),
        )
        .child(
            question("Which parameters may be trusted?", &trusted)
                .child(figure([trust::error_bars(model, truth)], &bars)),
        )
}

fn question(title: &str, answer: &str) -> Element {
    classed("div", "question")
        .child(el("h2").text(title))
        .child(classed("p", "answer").text(answer))
}

fn figure(drawings: impl IntoIterator<Item = Element>, caption: &str) -> Element {
    el("figure")
        .children(drawings)
        .child(el("figcaption").text(caption))
}

/// The logs to draw: held-out ones, and then those of the training.
fn drawn(id: &Identification) -> Vec<&LogSeries> {
    let of = |role| id.series.iter().filter(move |log| log.role == role);
    of(Role::Validation)
        .chain(of(Role::Training))
        .take(MOST_LOGS)
        .collect()
}

/// Measured and predicted torque: one section, a fold for each log, the first one open.
fn torques(id: &Identification, model: &ModelResult) -> Option<Element> {
    let logs = drawn(id);
    let first = logs.first()?;
    let curves: usize = logs
        .iter()
        .map(|log| log.joints.len() * (2 * id.models.len() + 1))
        .sum();
    let points = (POINTS / curves.max(1)).clamp(50, MOST_POINTS);
    let section = el("section")
        .child(el("h2").text("Measured and predicted torque"))
        .child(torque::switches(first));
    let folds = logs.iter().enumerate().map(|(k, log)| {
        let caption = format!(
            "{} rows at {} Hz per joint of {}, after the filters that the parameters were identified \
             with{}. Below each, the residual: measured minus predicted; grey band: \u{b1}2 rms of \
             the training residual, in which 95 % of a residual like that of the training stays. \
             The power model's parameters predict through the explicit model.",
            log.rows,
            words::number(log.rate_hz, 4),
            log.log,
            thinning(log, points)
        );
        let grid = classed("div", "grid2").children(torque::joints(log, Some(&model.fit), points));
        fold(log, k == 0).child(figure([grid], &caption))
    });
    let missing = id.series.len() - logs.len();
    let note = (missing > 0).then(|| {
        el("p").text(format!(
            "{} more are not drawn.",
            words::count(missing, "log")
        ))
    });
    Some(section.children(folds).children(note))
}

/// What is said about points that are not drawn.
fn thinning(log: &LogSeries, points: usize) -> String {
    match log.rows > points {
        true => format!(" (drawn with at most {points} points, every peak kept)"),
        false => String::new(),
    }
}

fn fold(log: &LogSeries, open: bool) -> Element {
    let role = match log.role {
        Role::Training => "Training",
        Role::Validation => "Held out",
    };
    let details = match open {
        true => el("details").attr("open", "open"),
        false => el("details"),
    };
    details.child(el("summary").text(format!("{role}: {}", log.log)))
}

/// Spectra and autocorrelations: a fold for each log, the first one open.
fn residuals(id: &Identification) -> Option<Element> {
    let logs = drawn(id);
    let answer = summary::white(id)?;
    let folds = logs.iter().enumerate().map(|(k, log)| {
        let caption = format!(
            "Left: amplitude density of the measured torque and of the residual; grey band: where \
             95 % would lie if the residual of the same rms were white; dashed line: cut-off of \
             the parallel filter. Where the residual comes near the torque, the model explains \
             nothing. Right: autocorrelation of the residual; grey band: \u{b1}{} for white noise \
             (n = {} rows of {}). Slow decay is structure that is left over: friction or an effect that the \
             model lacks.",
            words::number(whiteness::white_band(log.rows), 2),
            log.rows,
            log.log
        );
        let grid = classed("div", "grid2").children(whiteness::joints(log));
        fold(log, k == 0).child(figure([grid], &caption))
    });
    Some(
        el("section")
            .child(el("h2").text("Is the residual noise?"))
            .child(classed("p", "answer").text(answer))
            .children(folds),
    )
}

/// The models side by side.
fn models(id: &Identification) -> Element {
    let differ = "differ: the distance of two models in standard deviations of the difference, as \
                  if their errors were independent; given beyond 2. Values with 2\u{3c3}; SI units.";
    let wide =
        |table: Element, caption: &str| classed("div", "wide").child(figure([table], caption));
    let errors = "Torque errors on the filtered, decimated signals; in brackets the rms.";
    el("section")
        .child(el("h2").text("The models side by side"))
        .child(classed("p", "answer").text(summary::agree(id)))
        .child(wide(comparison::parameters(id), differ))
        .child(wide(comparison::equations(id), errors))
}

/// Warnings, settings, and the command line.
fn provenance(id: &Identification) -> Element {
    let command = settings::command(id).map(|command| {
        el("div")
            .child(el("h2").text("The command that gives this page"))
            .child(command)
    });
    el("section")
        .child(el("h2").attr("id", "warnings").text("Warnings"))
        .child(settings::warnings(id))
        .child(el("h2").text("Filters and settings"))
        .child(classed("div", "wide").child(settings::table(id)))
        .children(command)
}
