//! Which parameters may be trusted? Each with its error bar, the sharpest first.

use super::markup::{Element, classed, el};
use super::panel::{drawing, label, px};
use super::scale::{Scale, round_range};
use super::words::{plus_minus, short, unit};
use crate::report::{ModelResult, ParameterResult};

const WIDTH: f64 = 660.0;
const ROW: f64 = 15.0;
const TOP: f64 = 6.0;
/// With more parameters the figure has two columns.
const ONE_COLUMN: usize = 26;
/// Error bars beyond this, in percent of the value, end in arrows.
const WIDEST_PCT: f64 = 150.0;

/// How far a parameter may be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trust {
    /// Sigma of at most 10 % of the value, the usual mark of a well identified parameter.
    Sharp,
    /// Sigma of 10 to 50 %.
    Rough,
    /// 2 sigma exceed the value: not even the sign is sure.
    Doubtful,
    /// The logs do not determine it.
    Undetermined,
}

impl Trust {
    pub const ALL: [Trust; 4] = [
        Trust::Sharp,
        Trust::Rough,
        Trust::Doubtful,
        Trust::Undetermined,
    ];

    pub fn of(parameter: &ParameterResult) -> Self {
        match (parameter.value, relative(parameter)) {
            (None, _) => Trust::Undetermined,
            (_, Some(pct)) if pct <= 10.0 => Trust::Sharp,
            (_, Some(pct)) if pct <= 50.0 => Trust::Rough,
            _ => Trust::Doubtful,
        }
    }

    pub fn class(self) -> &'static str {
        match self {
            Trust::Sharp => "sharp",
            Trust::Rough => "rough",
            Trust::Doubtful => "doubtful",
            Trust::Undetermined => "undetermined",
        }
    }
}

/// The best sigma there is: corrected for autocorrelation, or else the classical one.
pub(super) fn sigma(parameter: &ParameterResult) -> Option<f64> {
    parameter.sigma_corrected.or(parameter.sigma)
}

/// [`sigma`] in percent of the value.
pub(super) fn relative(parameter: &ParameterResult) -> Option<f64> {
    let (value, sigma) = parameter.value.zip(sigma(parameter))?;
    let pct = 100.0 * sigma / value.abs();
    pct.is_finite().then_some(pct)
}

/// A parameter, where it is drawn, and where its true value lies, in percent of the value.
struct Row<'a> {
    parameter: &'a ParameterResult,
    truth_pct: Option<f64>,
}

/// Places of one column of the figure.
struct Column {
    left: f64,
    x: Scale,
    text: f64,
}

/// Error bars of all parameters of a model, sorted by relative sigma; with the truth if known.
pub(super) fn error_bars(model: &ModelResult, truth: Option<&[f64]>) -> Element {
    let rows = sorted(model, truth);
    let reach = reach(&rows);
    let columns = if rows.len() > ONE_COLUMN { 2 } else { 1 };
    let each = rows.len().div_ceil(columns).max(1);
    let bottom = TOP + each as f64 * ROW;
    let words = format!(
        "Parameters of the {} model with two sigma error bars in percent of the value",
        model.name.name()
    );
    let mut figure = drawing("trust", (WIDTH, bottom + 32.0), &words);
    for (k, rows) in rows.chunks(each).enumerate() {
        let column = Column::new(k, columns, reach);
        figure = figure.children(column.axis(bottom));
        let marks = rows.iter().enumerate();
        figure = figure.children(marks.map(|(k, row)| column.row(row, TOP + k as f64 * ROW)));
    }
    figure
}

fn sorted<'a>(model: &'a ModelResult, truth: Option<&[f64]>) -> Vec<Row<'a>> {
    let parameters = model.parameters.iter().enumerate();
    let mut rows: Vec<Row<'_>> = parameters
        .map(|(k, parameter)| {
            let truth = truth.and_then(|values| values.get(k).copied());
            let away = |(truth, value): (f64, f64)| 100.0 * (truth - value) / value.abs();
            Row {
                parameter,
                truth_pct: truth.zip(parameter.value).map(away),
            }
        })
        .collect();
    let key = |row: &Row<'_>| match row.parameter.value {
        None => f64::INFINITY,
        Some(_) => relative(row.parameter).unwrap_or(f64::MAX),
    };
    rows.sort_by(|a, b| key(a).total_cmp(&key(b)));
    rows
}

/// Half the width of the axis, percent: all bars and truths fit in, or the widest bars are cut.
fn reach(rows: &[Row<'_>]) -> f64 {
    let spreads = rows
        .iter()
        .filter_map(|row| relative(row.parameter))
        .map(|pct| 2.0 * pct);
    let truths = rows.iter().filter_map(|row| row.truth_pct).map(f64::abs);
    let all = spreads.chain(truths).map(|pct| pct.min(WIDEST_PCT));
    round_range(all.chain([0.0]), 3).1
}

impl Column {
    fn new(k: usize, columns: usize, reach: f64) -> Self {
        let width = WIDTH / columns as f64;
        let left = k as f64 * width;
        let (name, text) = if columns == 1 {
            (90.0, 200.0)
        } else {
            (58.0, 152.0)
        };
        let pixels = (left + name, left + width - text - 10.0);
        Column {
            left,
            x: Scale::linear((-reach, reach), pixels),
            text: left + width - text,
        }
    }

    fn axis(&self, bottom: f64) -> Vec<Element> {
        let (low, high) = (self.x.range().0, self.x.range().1);
        let mut marks = Vec::new();
        for (value, sign) in [(low, "\u{2212}"), (0.0, ""), (high, "+")] {
            let at = px(self.x.at(value));
            let class = if value == 0.0 { "grid zero" } else { "grid" };
            marks.push(classed("path", class).attr("d", format!("M{at} 2V{}", px(bottom))));
            let text = match value {
                0.0 => "value".to_owned(),
                value => format!("{sign}{} %", value.abs()),
            };
            marks.push(label(at, bottom + 13.0, "middle", &text));
        }
        if low < -100.0 {
            let at = px(self.x.at(-100.0));
            marks.push(classed("path", "nought").attr("d", format!("M{at} 2V{}", px(bottom))));
            marks.push(label(at, bottom + 26.0, "middle", "zero"));
        }
        marks
    }

    fn row(&self, row: &Row<'_>, top: f64) -> Element {
        let parameter = row.parameter;
        let trust = Trust::of(parameter);
        let y = top + ROW / 2.0;
        let unit = unit(&parameter.unit);
        let text = match (parameter.value, sigma(parameter)) {
            (None, _) => "not determined".to_owned(),
            (Some(value), sigma) => format!("{} {unit}", plus_minus(value, sigma.unwrap_or(0.0))),
        };
        let title = format!("{} = {}: {text}", parameter.name, parameter.relation);
        let mut group = el("g")
            .attr("class", trust.class())
            .child(el("title").text(title))
            .child(label(
                self.left + 2.0,
                y + 3.5,
                "start",
                &short(&parameter.name, 9),
            ))
            .child(label(self.text, y + 3.5, "start", &short(&text, 34)));
        if let Some(pct) = relative(parameter) {
            group = group
                .child(self.whisker(2.0 * pct, y))
                .child(self.dot(trust, y));
        }
        let truth = row.truth_pct.map(|pct| diamond(self.x.at(pct), y));
        group.children(truth)
    }

    /// The error bar, with ends, or arrows where it leaves the axis.
    fn whisker(&self, pct: f64, y: f64) -> Element {
        let (low, high) = (px(self.x.at(-pct)), px(self.x.at(pct)));
        let (up, down) = (px(y - 3.0), px(y + 3.0));
        let y = px(y);
        let ends = match self.x.holds(pct) {
            true => format!("M{low} {up}V{down}M{high} {up}V{down}"),
            false => {
                let (left, right) = (px(low + 5.0), px(high - 5.0));
                format!(
                    "M{left} {up}L{low} {y}L{left} {down}M{right} {up}L{high} {y}L{right} {down}"
                )
            }
        };
        classed("path", "whisker").attr("d", format!("M{low} {y}H{high}{ends}"))
    }

    /// The value: filled where it is sharp, hollow where rough, a cross where doubtful.
    fn dot(&self, trust: Trust, y: f64) -> Element {
        let x = self.x.at(0.0);
        match trust {
            Trust::Doubtful | Trust::Undetermined => {
                let (left, right, up, down) = (px(x - 3.0), px(x + 3.0), px(y - 3.0), px(y + 3.0));
                let d = format!("M{left} {up}L{right} {down}M{left} {down}L{right} {up}");
                classed("path", "dot").attr("d", d)
            }
            Trust::Sharp | Trust::Rough => classed("circle", "dot")
                .attr("cx", px(x))
                .attr("cy", px(y))
                .attr("r", 2.8),
        }
    }
}

/// The mark of a true value.
fn diamond(x: f64, y: f64) -> Element {
    let (left, right, up, down) = (px(x - 4.0), px(x + 4.0), px(y - 4.0), px(y + 4.0));
    let (x, y) = (px(x), px(y));
    classed("path", "truth").attr("d", format!("M{left} {y}L{x} {up}L{right} {y}L{x} {down}Z"))
}
