//! A search's outcome in words and numbers.

use std::collections::BTreeMap;

use super::absorbed::absorbed;
use super::bursts;
use super::catalogue::Hypothesis;
use super::joined::Joined;
use super::null::Null;
use super::periods::unrepeated;
use super::picture::{self, Drawn};
use super::smooth::smooths;
use super::state::{Bench, Effect, State};
use super::stepwise::{Named, Outcome};
use super::{Log, doubts, proof, verdict};
use crate::observe::Filtering;
use crate::report::{
    Alternative, Change, Diagnosis, EffectParameter, Estimated, FoundEffect, Gap, Located,
    RankedEffect, Refitted, RejectedEffect, Verdict,
};

/// What was asked.
pub(super) struct Asked<'a> {
    /// To fit on, and of other motions.
    pub logs: (&'a [Log], &'a [Log]),
    /// Whether a part of the logs to fit on was kept, to confirm and prove.
    pub kept: bool,
    pub filtering: &'a Filtering,
    /// Whether curves are wanted.
    pub draw: bool,
}

/// Puts an outcome into a [`Diagnosis`].
pub(super) fn diagnosis(
    bench: &Bench<'_>,
    null: &Null,
    (before, outcome): (&State, &Outcome),
    proof: Option<&Joined>,
    asked: &Asked<'_>,
) -> Diagnosis {
    let (train, validate) = asked.logs;
    let lacks = verdict::lacks(bench, null, before);
    let left = verdict::lacks(bench, null, &outcome.state);
    let bursts = match outcome.named.is_empty() && !verdict::open(&lacks) {
        true => bursts::bursts(bench, before),
        false => Vec::new(),
    };
    let unrepeated = unrepeated(bench, outcome);
    let verdict = match outcome.named.is_empty() {
        true if verdict::open(&lacks) || !bursts.is_empty() => Verdict::Unknown,
        true => Verdict::Nothing,
        false if verdict::closed(&lacks, &left) && unrepeated.is_empty() => Verdict::Named,
        false => Verdict::Unknown,
    };
    let mut located = verdict::located(bench, &lacks, before);
    let in_time = |b: &bursts::Bursts| (b.joint, 100.0 * b.share, vec!["time"]);
    located.extend(bursts.iter().map(in_time));
    let lacking: Vec<usize> = match verdict {
        Verdict::Unknown => located.iter().map(|(joint, ..)| *joint).collect(),
        _ => Vec::new(),
    };
    let located = located
        .into_iter()
        .map(|(joint, unexplained_pct, varies_with)| Located {
            joint: bench.model.joints()[joint].name.to_string(),
            unexplained_pct,
            varies_with: varies_with.into_iter().map(str::to_owned).collect(),
        });
    let on = proof.unwrap_or(bench.train);
    let names = |logs: &[Log]| logs.iter().map(|log| log.recording.name.clone()).collect();
    let (order, effects) = effects(bench, outcome);
    let states = (before, &outcome.state);
    let drawn = Drawn {
        order: &order,
        lacking: &lacking,
    };
    Diagnosis {
        robot: bench.model.name().to_owned(),
        logs: names(train),
        validation: names(validate),
        filter: asked.filtering.clone(),
        verdict,
        effects,
        ranking: ranking(bench, outcome),
        rejected: rejected(bench, before, outcome),
        located: located.collect(),
        smooths: smooths(bench, &outcome.state, &lacking, proof),
        gap: Gap {
            torque: Change {
                before: proof::fit(bench, before, on),
                after: proof::fit(bench, &outcome.state, on),
            },
            simulation: None,
            on: place(on, proof.is_some(), doubts::fresh(asked.logs).len()),
        },
        parameters: refitted(bench, before, &outcome.state),
        changed: None,
        warnings: [
            doubts::warnings(asked.logs, asked.kept),
            bursts.iter().map(|b| b.sentence(bench.model)).collect(),
            unrepeated.iter().map(|u| u.sentence(bench.model)).collect(),
        ]
        .concat(),
        command: None,
        pictures: asked
            .draw
            .then(|| picture::pictures(bench, states, &drawn, on)),
    }
}

/// The model's own parameters in two states.
fn refitted(bench: &Bench<'_>, before: &State, after: &State) -> Vec<Refitted> {
    let columns = bench.model.columns();
    let estimated = |state: &State| -> Vec<Estimated> {
        let more: usize = state.effects.iter().map(|effect| effect.values.len()).sum();
        let sigmas = state.system.sigmas(columns.len() + more);
        let values = state.parameters.iter().zip(sigmas);
        values
            .map(|(&value, sigma)| Estimated { value, sigma })
            .collect()
    };
    let pairs = estimated(before).into_iter().zip(estimated(after));
    columns
        .iter()
        .zip(pairs)
        .map(|(column, (before, after))| Refitted {
            name: column.name.to_string(),
            unit: column.unit.to_string(),
            before,
            after,
        })
        .collect()
}

/// What the gap was measured on.
fn place(on: &Joined, proven: bool, validation: usize) -> String {
    let names: Vec<&str> = on
        .tracks
        .iter()
        .map(|track| track.motion.log.as_str())
        .collect();
    let names = names.join(" + ");
    match (proven, validation) {
        (false, _) => format!("{names} (the training log itself: nothing is proven)"),
        (true, 0) => format!("last quarter of {names}, kept for this"),
        (true, 1) => format!("second half of {names}"),
        (true, _) => names,
    }
}

/// The effects, strongest first, and the place of each in the state.
fn effects(bench: &Bench<'_>, outcome: &Outcome) -> (Vec<usize>, Vec<FoundEffect>) {
    let all = proof::fit(bench, &outcome.state, bench.train).total_pct;
    let mut found: Vec<(f64, usize, FoundEffect)> = Vec::new();
    let pairs = outcome.named.iter().zip(&outcome.state.effects);
    for (place, (named, effect)) in pairs.enumerate() {
        let others = outcome
            .state
            .effects
            .iter()
            .filter(|other| other.number != named.number);
        let others: Vec<(usize, Vec<f64>)> = others
            .map(|other| (other.number, other.shape.clone()))
            .collect();
        let without = bench.settle(&others, &outcome.state.predicted);
        let gain = without.system.gain(&effect.instruments(), &[]).square;
        let error = proof::fit(bench, &without, bench.train).total_pct;
        found.push((
            gain,
            place,
            effect_in_words(bench, named, effect, 100.0 * (1.0 - all / error)),
        ));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
        .into_iter()
        .map(|(_, place, effect)| (place, effect))
        .unzip()
}

fn effect_in_words(
    bench: &Bench<'_>,
    named: &Named,
    effect: &Effect,
    gain_pct: f64,
) -> FoundEffect {
    let hypothesis = &bench.hypotheses[named.number];
    let entry = &bench.catalogue.entries()[hypothesis.entry];
    let (joint, joints) = joints(bench, hypothesis);
    let parameters = effect
        .names
        .iter()
        .zip(effect.values.iter().zip(&effect.sigmas));
    let parameter =
        |((name, unit), (value, sigma)): (&(String, &str), (&f64, &Option<f64>))| EffectParameter {
            name: name.clone(),
            unit: (*unit).to_owned(),
            value: *value,
            sigma: *sigma,
        };
    let shape = entry.shape.iter().zip(&named.shape);
    let alternative = |rival: &super::stepwise::Rival| {
        let hypothesis = &bench.hypotheses[rival.number];
        let (joint, joints) = self::joints(bench, hypothesis);
        Alternative {
            effect: bench.catalogue.entries()[hypothesis.entry].name.to_owned(),
            joint,
            joints,
            p_value: rival.p_value,
            separable: rival.separable,
        }
    };
    FoundEffect {
        effect: entry.name.to_owned(),
        joint,
        joints,
        meaning: entry.meaning.to_owned(),
        formula: entry.formula.to_owned(),
        parameters: parameters.map(parameter).collect(),
        shape: shape
            .map(|((name, _), value)| ((*name).to_owned(), *value))
            .collect::<BTreeMap<_, _>>(),
        p_value: named.p_value,
        gain_pct,
        alternatives: named.rivals.iter().map(alternative).collect(),
        experiment: entry.experiment.to_owned(),
    }
}

/// What came nearest in each step.
fn ranking(bench: &Bench<'_>, outcome: &Outcome) -> Vec<RankedEffect> {
    let ranked = outcome.ranked.iter();
    ranked
        .map(|ranked| {
            let hypothesis = &bench.hypotheses[ranked.number];
            let (joint, joints) = joints(bench, hypothesis);
            RankedEffect {
                step: ranked.step,
                effect: bench.catalogue.entries()[hypothesis.entry].name.to_owned(),
                joint,
                joints,
                gain: ranked.gain,
                margin: ranked.margin,
                p_value: ranked.p_value,
            }
        })
        .collect()
}

/// What the search refused, and what it could not ask for.
fn rejected(bench: &Bench<'_>, before: &State, outcome: &Outcome) -> Vec<RejectedEffect> {
    let absorbed = absorbed(bench, before);
    let refused = outcome.refused.iter().chain(&absorbed);
    refused
        .map(|refused| {
            let hypothesis = &bench.hypotheses[refused.number];
            let (joint, joints) = joints(bench, hypothesis);
            RejectedEffect {
                effect: bench.catalogue.entries()[hypothesis.entry].name.to_owned(),
                joint,
                joints,
                why: refused.why.clone(),
            }
        })
        .collect()
}

/// Name of the only joint, and all joints counted from 1.
fn joints(bench: &Bench<'_>, hypothesis: &Hypothesis) -> (Option<String>, Vec<usize>) {
    let name = match hypothesis.joints[..] {
        [joint] => bench
            .model
            .joints()
            .get(joint)
            .map(|joint| joint.name.to_string()),
        _ => None,
    };
    (
        name,
        hypothesis.joints.iter().map(|joint| joint + 1).collect(),
    )
}
