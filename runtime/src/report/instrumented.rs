//! Estimates with instrumental variables as text, beside least squares.

use super::table::{Align, Table, optional, significant};
use super::{InstrumentedValue, ModelResult};

/// Parameters by instruments, how far least squares are from them, and what that means; nothing if
/// there are none.
pub(super) fn tables(models: &[ModelResult], width: usize) -> String {
    let mut text = String::new();
    for model in models {
        let Some(fit) = &model.instrumented else {
            continue;
        };
        text.push('\n');
        text.push_str(&parameters(model).render(width));
        let verdict = match fit.biased.len() {
            0 => "least squares are not biased beyond a sigma".to_owned(),
            _ => format!(
                "least squares are biased by more than a sigma in {}",
                fit.biased.join(", ")
            ),
        };
        let settled = if fit.converged {
            "settled"
        } else {
            "not settled"
        };
        let error = significant(fit.fit.total_pct, 3);
        text.push_str(&format!(
            "{verdict} (Durbin-Wu-Hausman, 5 % over all)\n{settled} after {} simulations, \
             training error {error} %\n",
            fit.simulations
        ));
    }
    text
}

/// Value, sigmas, and the distance of least squares in percent with its significance.
fn parameters(model: &ModelResult) -> Table {
    let mut align = vec![Align::Left, Align::Left];
    align.extend([Align::Right; 5]);
    let mut table = Table::new(align);
    let title = format!("instruments, {}", model.name.name());
    let titles = [
        title.as_str(),
        "unit",
        "value",
        "sigma",
        "corr.",
        "LS off by",
        "p",
    ];
    table.row(titles.map(str::to_owned).to_vec());
    for parameter in &model.parameters {
        let Some(found) = &parameter.instrumented else {
            continue;
        };
        let mut row = vec![parameter.name.clone(), parameter.unit.clone()];
        row.extend(cells(found));
        table.row(row);
    }
    table
}

fn cells(found: &InstrumentedValue) -> [String; 5] {
    let mark = if found.biased { "*" } else { "" };
    [
        optional(found.value, 5),
        optional(found.sigma, 2),
        optional(found.sigma_corrected, 2),
        optional(found.difference, 2),
        format!("{mark}{}", optional(found.p_value, 2)),
    ]
}
