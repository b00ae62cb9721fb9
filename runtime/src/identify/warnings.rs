//! What is to be said about logs and estimates, in full sentences.

use super::Plan;
use crate::estimate::{Dependency, Estimate};
use crate::log::Samples;
use crate::model::IdentificationModel;
use crate::observe::ModelKind;
use crate::report::ModelResult;

/// The power model is said to fail when its torque error exceeds the explicit one's this often.
const POWER_FAILS: f64 = 2.0;

/// A prior this many standard deviations from the log on average (root mean square) is
/// contradicted.
const CONTRADICTED: f64 = 3.0;

/// A named list longer than this is cut short.
pub(super) const LONGEST_LIST: usize = 12;

/// Warnings of the logs themselves, and of logs that do not go together.
pub(super) fn of_logs<L: Samples>(
    model: &dyn IdentificationModel,
    train: &[L],
    validate: &[L],
    plan: &Plan,
) -> Vec<String> {
    let alone = train.len() + validate.len() == 1;
    let named = |log: &L, warning: &String| match alone || warning.contains(log.name()) {
        true => warning.clone(),
        false => format!("{}: {warning}", log.name()),
    };
    let all = train.iter().chain(validate);
    let mut warnings: Vec<String> = all
        .flat_map(|log| {
            log.warnings()
                .iter()
                .map(move |warning| named(log, warning))
        })
        .collect();
    let Some(first) = train.first() else {
        return warnings;
    };
    for log in train.iter().chain(validate) {
        if (log.rate_hz() / first.rate_hz() - 1.0).abs() > 1e-6 {
            warnings.push(format!(
                "{} is sampled at {} Hz and {} at {} Hz; both are decimated by {}, so their \
                 parallel filters differ.",
                log.name(),
                log.rate_hz(),
                first.name(),
                first.rate_hz(),
                plan.filtering.nd
            ));
        }
    }
    if model.columns().is_empty() {
        warnings.push(format!("{} has no parameters to identify.", model.name()));
    }
    warnings
}

/// What the data do not determine, by cause.
pub(super) fn of_estimate(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    estimate: &Estimate,
    resting: &[usize],
) -> Vec<String> {
    let mut unseen = estimate.unseen.clone();
    let mut warnings = Vec::new();
    for &joint in resting {
        let of_joint = |c: &usize| {
            model
                .columns()
                .get(*c)
                .is_some_and(|c| c.joint == joint + 1)
        };
        let lost: Vec<usize> = unseen.iter().copied().filter(of_joint).collect();
        unseen.retain(|c| !of_joint(c));
        let end = match lost.is_empty() {
            true => String::new(),
            false => format!(": {} cannot be identified", names(model, &lost)),
        };
        warnings.push(format!("{} never moves{end}.", joint_name(model, joint)));
    }
    if !unseen.is_empty() {
        warnings.push(format!(
            "{} cannot be identified: nothing in these logs depends on them ({} model).",
            names(model, &unseen),
            kind.name()
        ));
    }
    warnings.extend(
        estimate
            .dependent
            .iter()
            .map(|group| dependency(model, kind, group)),
    );
    warnings
}

fn dependency(model: &dyn IdentificationModel, kind: ModelKind, group: &Dependency) -> String {
    format!(
        "{} cannot be identified one by one: these logs determine {} of the {} ({} model); \
         excite the robot differently.",
        names(model, &group.columns),
        match group.combinations {
            0 => "none".to_owned(),
            1 => "one combination".to_owned(),
            n => format!("{n} combinations"),
        },
        group.columns.len(),
        kind.name()
    )
}

/// What prior knowledge fills in, and a prior that the log contradicts.
pub(super) fn of_prior(found: &ModelResult) -> Vec<String> {
    let Some(with_prior) = &found.with_prior else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    let filled = found.parameters.iter();
    let filled = filled.filter(|p| p.with_prior.as_ref().is_some_and(|value| value.filled));
    let filled: Vec<&str> = filled.map(|p| p.name.as_str()).collect();
    if !filled.is_empty() {
        warnings.push(format!(
            "With the description's [prior], {} hold what the description says, as far as the log \
             leaves them open ({} model).",
            listed(filled),
            found.name.name()
        ));
    }
    if with_prior.misfit > CONTRADICTED {
        warnings.push(format!(
            "The log contradicts the description's [prior]: they are {:.1} standard deviations apart \
             on average ({} model). Check the tolerances, or whether the model misses an effect.",
            with_prior.misfit,
            found.name.name()
        ));
    }
    warnings
}

/// A power model that explains the power and not the torques.
pub(super) fn of_results(models: &[ModelResult]) -> Option<String> {
    let find = |kind| models.iter().find(|model| model.name == kind);
    let (explicit, power) = find(ModelKind::Explicit).zip(find(ModelKind::Power))?;
    let (torque, own) = (power.fit.total_pct, power.equation_pct);
    (torque > POWER_FAILS * explicit.fit.total_pct && torque > POWER_FAILS * own).then(|| {
        format!(
            "The power model explains the power to {own:.1} % but the torques only to {torque:.1} \
             %: its one equation for all joints does not separate the parameters on these logs \
             (condition {:.0}). Trust the other models, or give longer logs.",
            power.condition
        )
    })
}

/// Each sentence once, in the order of first appearance.
pub(super) fn once_each(warnings: Vec<String>) -> Vec<String> {
    let mut once: Vec<String> = Vec::with_capacity(warnings.len());
    for warning in warnings {
        if !once.contains(&warning) {
            once.push(warning);
        }
    }
    once
}

fn joint_name(model: &dyn IdentificationModel, joint: usize) -> String {
    let name = model.joints().get(joint).map_or("", |j| j.name.as_ref());
    format!("joint {} ({name})", joint + 1)
}

fn names(model: &dyn IdentificationModel, columns: &[usize]) -> String {
    let all = columns.iter().filter_map(|c| model.columns().get(*c));
    listed(all.map(|column| column.name.as_ref()).collect())
}

fn listed(mut list: Vec<&str>) -> String {
    let more = list.len().saturating_sub(LONGEST_LIST);
    list.truncate(LONGEST_LIST);
    match more {
        0 => list.join(", "),
        more => format!("{} and {more} more", list.join(", ")),
    }
}
