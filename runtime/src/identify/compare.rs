//! The models against each other: where they disagree beyond their standard deviations, the filters
//! or the model are wrong, since the three are one model of one robot (Gautier 1996, section 8).

use super::warnings::LONGEST_LIST;
use crate::report::{Disagreement, ModelResult};

/// Models disagree on a parameter if it differs by this many standard deviations, those of both
/// together. Their errors have the same cause and differ less than independent ones would, so that
/// true models seldom come near.
const BEYOND: f64 = 3.0;

/// A smaller share of a parameter than this is no disagreement worth a word, however sharp both
/// models are: logs without noise have no standard deviations to speak of.
const WORTH: f64 = 1e-3;

/// Every parameter on which two models disagree, by the standard deviations that respect correlated
/// residuals where there are any. The worst first.
pub(super) fn disagreements(models: &[ModelResult]) -> Vec<Disagreement> {
    let mut all = Vec::new();
    for (place, first) in models.iter().enumerate() {
        for second in &models[place + 1..] {
            let pairs = first.parameters.iter().zip(&second.parameters);
            all.extend(pairs.filter_map(|(a, b)| {
                let sigma = |p: &crate::report::ParameterResult| p.sigma_corrected.or(p.sigma);
                let (x, y) = (a.value?, b.value?);
                let sigmas = (x - y).abs() / sigma(a)?.hypot(sigma(b)?);
                let worth = (x - y).abs() > WORTH * x.abs().max(y.abs());
                (sigmas > BEYOND && worth).then(|| Disagreement {
                    parameter: a.name.clone(),
                    models: [first.name, second.name],
                    values: [x, y],
                    sigmas,
                })
            }));
        }
    }
    all.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
    all
}

/// A sentence for each pair of models that disagree.
pub(super) fn sentences(all: &[Disagreement]) -> Vec<String> {
    let mut pairs: Vec<_> = all.iter().map(|d| d.models).collect();
    pairs.sort();
    pairs.dedup();
    let sentence = |pair: [crate::observe::ModelKind; 2]| {
        let own = all.iter().filter(|d| d.models == pair);
        let mut names: Vec<String> = own
            .map(|d| format!("{} ({:.0} sigma)", d.parameter, d.sigmas))
            .collect();
        let more = names.len().saturating_sub(LONGEST_LIST);
        names.truncate(LONGEST_LIST);
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        format!(
            "The {} and the {} model disagree on {}{more}: the filters falsify one of them, or \
             something is missing in both.",
            pair[0].name(),
            pair[1].name(),
            names.join(", ")
        )
    };
    pairs.into_iter().map(sentence).collect()
}
