//! Effects that no log of this kind can show: the parameters of the model take them up.

use super::catalogue::Hypothesis;
use super::state::{Bench, State};
use super::stepwise::Refused;

/// Hypotheses of which the null model (with what is known of its parameters) leaves nothing along
/// the training logs: with them or without, the same torque is predicted.
pub(super) fn absorbed(bench: &Bench<'_>, before: &State) -> Vec<Refused> {
    if bench.knows_parameters() {
        return Vec::new();
    }
    let entry = |hypothesis: &Hypothesis| &bench.catalogue.entries()[hypothesis.entry];
    let numbered = bench.hypotheses.iter().enumerate();
    let hidden: Vec<usize> = numbered
        .filter(|(_, hypothesis)| entry(hypothesis).hidden_by_parameters)
        .map(|(number, _)| number)
        .collect();
    let candidates = bench.candidates(&hidden, &bench.asking(&before.predicted));
    let taken_up = candidates.into_iter().filter(|candidate| {
        let acts = !candidate.columns.is_empty();
        acts && bench
            .contend(candidate.clone(), &before.system)
            .gain
            .columns()
            == 0
    });
    taken_up
        .map(|candidate| Refused {
            number: candidate.number,
            why: "not distinguishable: the base parameters absorb it on any log; only described \
                  values with tolerances ([prior]) can tell"
                .to_owned(),
        })
        .collect()
}
