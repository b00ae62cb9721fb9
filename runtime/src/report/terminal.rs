//! An identification as text for a terminal, about 110 characters wide.

use std::fmt::Write;

use super::table::{Align, Table, optional, shorten, significant};
use super::{Fit, Identification, ModelResult, ParameterResult};
use super::{instrumented, prior};
use crate::settings::{Derivatives, Edges, Velocity, Weights};

/// No line but a warning is longer.
const WIDTH: usize = 118;

/// Renders an identification: what was done, the parameters of the models side by side, how well
/// each explains the torque, and what to know. A function of the value alone.
pub fn terminal(identification: &Identification) -> String {
    let mut text = heading(identification);
    text.push('\n');
    text.push_str(&parameters(identification).render(WIDTH));
    text.push_str(&prior::tables(&identification.models, WIDTH));
    text.push_str(&instrumented::tables(&identification.models, WIDTH));
    text.push('\n');
    text.push_str(&equations(&identification.models).render(WIDTH));
    text.push('\n');
    text.push_str(&errors(&identification.models).render(WIDTH));
    for (k, warning) in identification.warnings.iter().enumerate() {
        let gap = if k == 0 { "\n" } else { "" };
        // Writing to a String does not fail.
        let _ = writeln!(text, "{gap}warning: {warning}");
    }
    text
}

/// Robot, logs, filters.
fn heading(id: &Identification) -> String {
    let first = format!(
        "{}: {} samples at {} Hz ({} s) of {}",
        id.robot,
        id.samples,
        id.rate_hz,
        significant(id.samples as f64 / id.rate_hz, 3),
        id.logs.join(", ")
    );
    let second = [prefilter(id), decimation(id), trim(id), words(id)].join(", ");
    let mut lines = vec![shorten(&first, WIDTH), shorten(&second, WIDTH)];
    if !id.filter.chosen.is_empty() {
        lines.push(format!(
            "chosen from the data: {}",
            id.filter.chosen.join(", ")
        ));
    }
    lines.join("\n") + "\n"
}

fn prefilter(id: &Identification) -> String {
    let signals = if id.filter.prefilter_torque {
        "q and tau"
    } else {
        "q"
    };
    format!(
        "{signals} below {} Hz (Butterworth {})",
        id.filter.fq_hz, id.filter.order
    )
}

fn decimation(id: &Identification) -> String {
    match id.filter.nd {
        1 => "all kept".to_owned(),
        nd => {
            let low_pass = significant(0.4 * id.rate_hz / nd.max(1) as f64, 3);
            format!("1 in {nd} kept (below {low_pass} Hz)")
        }
    }
}

fn trim(id: &Identification) -> String {
    let unit = match id.filter.edges {
        Edges::Scipy => "samples",
        Edges::Matlab => "rows",
    };
    let border = match id.filter.border {
        (0, 0) => String::new(),
        (start, end) => format!(" and {start} + {end} samples"),
    };
    format!("{} {unit}{border} trimmed", id.filter.trim)
}

fn words(id: &Identification) -> String {
    let velocity = match id.filter.velocity {
        Velocity::Derived if id.filter.derivatives == Derivatives::Eighth => {
            "qd from q (8th order)"
        }
        Velocity::Derived => "qd from q",
        Velocity::Measured => "qd measured",
    };
    let weights = match id.weights {
        Weights::None => "not weighted",
        Weights::Joint => "weighted by joint",
        Weights::Robust => "robust weights",
    };
    format!("{velocity}, {weights}")
}

/// One row per parameter: name, unit, value, sigma, corrected sigma ("corr.": holds although
/// residuals are correlated) and %sigma of each model, relation.
fn parameters(id: &Identification) -> Table {
    let mut align = vec![Align::Left, Align::Left];
    let (mut models, mut titles) = (
        vec![String::new(); 2],
        vec!["parameter".into(), "unit".into()],
    );
    // Three models leave no room for percentages; they are in the JSON.
    let cells = if id.models.len() > 2 { 3 } else { 4 };
    for model in &id.models {
        align.extend(vec![Align::Right; cells]);
        models.push(model.name.name().to_owned());
        models.extend(vec![String::new(); cells - 1]);
        titles.extend(
            ["value", "sigma", "corr.", "%"]
                .iter()
                .take(cells)
                .map(ToString::to_string),
        );
    }
    align.push(Align::Left);
    titles.push("relation".to_owned());
    let mut table = Table::new(align);
    table.row(models);
    table.row(titles);
    let first = id.models.first().map_or(&[][..], |model| &model.parameters);
    for (k, parameter) in first.iter().enumerate() {
        let mut row = vec![parameter.name.clone(), parameter.unit.clone()];
        for model in &id.models {
            row.extend(estimate(model.parameters.get(k)).into_iter().take(cells));
        }
        row.push(parameter.relation.clone());
        table.row(row);
    }
    table
}

/// Value, classical and corrected sigma, classical %sigma of a parameter.
fn estimate(parameter: Option<&ParameterResult>) -> [String; 4] {
    let get = |field: fn(&ParameterResult) -> Option<f64>| parameter.and_then(field);
    [
        optional(get(|p| p.value), 5),
        optional(get(|p| p.sigma), 2),
        optional(get(|p| p.sigma_corrected), 2),
        optional(get(|p| p.sigma_pct), 2),
    ]
}

/// Size and quality of the systems of equations.
fn equations(models: &[ModelResult]) -> Table {
    let mut table = side_by_side(models, 1, "equations");
    let mut line = |title: &str, cell: &dyn Fn(&ModelResult) -> String| {
        table.row(
            std::iter::once(title.to_owned())
                .chain(models.iter().map(cell))
                .collect(),
        );
    };
    line("rows", &|m| m.rows.to_string());
    line("rank", &|m| format!("{} of {}", m.rank, m.parameters.len()));
    line("condition", &|m| significant(m.condition, 4));
    line("certain digits", &|m| format!("{:.1}", m.certified_digits));
    line("residual, %", &|m| significant(m.equation_pct, 3));
    line("below 2 sigma", &|m| {
        format!("{} of {}", insignificant(m), m.parameters.len())
    });
    table
}

/// Parameters that differ from zero by less than two standard deviations.
fn insignificant(model: &ModelResult) -> usize {
    let within = |p: &&ParameterResult| p.sigma_pct.is_some_and(|pct| pct > 50.0);
    model.parameters.iter().filter(within).count()
}

/// Torque error of each joint, on the training and on each validation log.
fn errors(models: &[ModelResult]) -> Table {
    let mut table = side_by_side(models, 2, "torque error");
    let fits: Vec<&Fit> = models.iter().map(|model| &model.fit).collect();
    section(&mut table, "training", &fits);
    let logs = models.first().map_or(&[][..], |model| &model.validation);
    for (k, log) in logs.iter().enumerate() {
        let fits: Vec<&Fit> = models
            .iter()
            .filter_map(|m| m.validation.get(k))
            .map(|v| &v.fit)
            .collect();
        section(&mut table, &format!("validation {}", log.log), &fits);
    }
    table
}

/// A line per joint and one for all joints: percent and root mean square for each model.
fn section(table: &mut Table, title: &str, fits: &[&Fit]) {
    let units = fits
        .iter()
        .flat_map(|_| ["%".to_owned(), "rmse".to_owned()]);
    table.row(std::iter::once(shorten(title, 40)).chain(units).collect());
    let joints = fits.first().map_or(0, |fit| fit.joints.len());
    for joint in 0..joints {
        let rows: Vec<_> = fits
            .iter()
            .filter_map(|fit| fit.joints.get(joint))
            .collect();
        let name = rows
            .first()
            .map_or(String::new(), |row| format!("  {}, {}", row.name, row.unit));
        let cells = rows
            .iter()
            .flat_map(|r| [significant(r.rel_pct, 3), significant(r.rmse, 3)]);
        table.row(std::iter::once(name).chain(cells).collect());
    }
    let totals = fits
        .iter()
        .flat_map(|fit| [significant(fit.total_pct, 3), String::new()]);
    table.row(
        std::iter::once("  all joints".to_owned())
            .chain(totals)
            .collect(),
    );
}

/// A table with a title column and `cells` right-aligned columns per model, under their names.
pub(super) fn side_by_side<'a>(
    models: impl IntoIterator<Item = &'a ModelResult>,
    cells: usize,
    title: &str,
) -> Table {
    let mut align = vec![Align::Left];
    let mut names = vec![title.to_owned()];
    for model in models {
        align.extend(std::iter::repeat_n(Align::Right, cells));
        names.push(model.name.name().to_owned());
        names.extend(std::iter::repeat_n(String::new(), cells - 1));
    }
    let mut table = Table::new(align);
    table.row(names);
    table
}
