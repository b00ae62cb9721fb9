//! Estimates with prior knowledge as text, beside the classical ones.

use super::ModelResult;
use super::table::{Align, Table, optional, shorten, significant};
use super::terminal::side_by_side;

/// Parameters and quality of the estimates with prior knowledge; nothing if there are none.
pub(super) fn tables(models: &[ModelResult], width: usize) -> String {
    let models: Vec<&ModelResult> = models.iter().filter(|m| m.with_prior.is_some()).collect();
    if models.is_empty() {
        return String::new();
    }
    format!(
        "\n{}\n{}",
        parameters(&models).render(width),
        quality(&models).render(width)
    )
}

/// Described value and tolerance, then mean and sigma of each model; `*` marks what the log alone
/// leaves open.
fn parameters(models: &[&ModelResult]) -> Table {
    let mut align = vec![Align::Left, Align::Left, Align::Right, Align::Right];
    let mut names = ["with prior", "", "described", ""]
        .map(str::to_owned)
        .to_vec();
    let mut titles = ["parameter", "unit", "value", "sigma"]
        .map(str::to_owned)
        .to_vec();
    for model in models {
        align.extend([Align::Right, Align::Right]);
        names.extend([model.name.name().to_owned(), String::new()]);
        titles.extend(["value".to_owned(), "sigma".to_owned()]);
    }
    let mut table = Table::new(align);
    table.row(names);
    table.row(titles);
    let first = models.first().map_or(&[][..], |model| &model.parameters);
    for (k, parameter) in first.iter().enumerate() {
        let before = parameter.with_prior.as_ref().and_then(|p| p.sigma_before);
        let mut row = vec![
            parameter.name.clone(),
            parameter.unit.clone(),
            optional(parameter.nominal, 5),
            optional(before, 2),
        ];
        row.extend(models.iter().flat_map(|model| cells(model, k)));
        table.row(row);
    }
    table
}

/// Mean and sigma of parameter `k`.
fn cells(model: &ModelResult, k: usize) -> [String; 2] {
    let found = model.parameters.get(k).and_then(|p| p.with_prior.as_ref());
    let mark = if found.is_some_and(|p| p.filled) {
        "*"
    } else {
        ""
    };
    [
        format!("{mark}{}", optional(found.and_then(|p| p.value), 5)),
        optional(found.and_then(|p| p.sigma), 2),
    ]
}

fn quality(models: &[&ModelResult]) -> Table {
    let mut table = side_by_side(models.iter().copied(), 1, "with prior (* open in the log)");
    let found: Vec<_> = models
        .iter()
        .filter_map(|m| m.with_prior.as_ref())
        .collect();
    let np = models.first().map_or(0, |model| model.parameters.len());
    let mut line = |title: String, cells: Vec<String>| {
        table.row(std::iter::once(title).chain(cells).collect());
    };
    let decided = found.iter().map(|p| format!("{:.1} of {np}", p.from_prior));
    line("decided by the prior".into(), decided.collect());
    let misfit = found.iter().map(|p| significant(p.misfit, 2));
    line("log from prior, sigma".into(), misfit.collect());
    let training = found.iter().map(|p| significant(p.fit.total_pct, 3));
    line("training, %".into(), training.collect());
    let logs = found.first().map_or(&[][..], |p| &p.validation);
    for (k, log) in logs.iter().enumerate() {
        let totals = found.iter().filter_map(|p| p.validation.get(k));
        let totals = totals.map(|v| significant(v.fit.total_pct, 3));
        line(
            shorten(&format!("validation {}, %", log.log), 50),
            totals.collect(),
        );
    }
    table
}
