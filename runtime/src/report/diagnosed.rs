//! A diagnosis as text for a terminal.

use std::fmt::Write;

use super::changed::glance;
use super::table::significant;
use super::{Diagnosis, EffectParameter, FoundEffect, RejectedEffect, Verdict};

/// Renders a diagnosis: the verdict, each effect with its parameters and how sure it is, where the
/// gap is, how it shrinks, what was rejected. A function of the value alone.
pub fn diagnosed(diagnosis: &Diagnosis) -> String {
    let mut text = match &diagnosis.changed {
        Some(changed) => glance(diagnosis, changed),
        None => format!("{}: {}\n", diagnosis.robot, sentence(diagnosis)),
    };
    for effect in &diagnosis.effects {
        text.push('\n');
        text.push_str(&named(effect));
    }
    located(&mut text, diagnosis);
    smooths(&mut text, diagnosis);
    gap(&mut text, diagnosis);
    if !diagnosis.rejected.is_empty() {
        text.push_str("\nlooked at and not taken\n");
    }
    // What one reason speaks against stands together. Writing to a String does not fail.
    for alike in diagnosis.rejected.chunk_by(|a, b| a.why == b.why) {
        let name = |rejected: &RejectedEffect| {
            let place = place(rejected.joint.as_deref(), &rejected.joints);
            format!("{}{place}", rejected.effect)
        };
        let names: Vec<String> = alike.iter().map(name).collect();
        let _ = writeln!(text, "  {}: {}", names.join(", "), alike[0].why);
    }
    for (k, warning) in diagnosis.warnings.iter().enumerate() {
        let gap = if k == 0 { "\n" } else { "" };
        let _ = writeln!(text, "{gap}warning: {warning}");
    }
    text
}

fn sentence(diagnosis: &Diagnosis) -> &'static str {
    match (diagnosis.verdict, diagnosis.effects.len()) {
        (Verdict::Nothing, _) => "nothing is missing that this log could show",
        (Verdict::Named, 1) => "one effect is missing, and it explains the gap",
        (Verdict::Named, _) => "effects are missing, and they explain the gap",
        (Verdict::Unknown, 0) => "something is missing that the catalogue does not know",
        (Verdict::Unknown, _) => {
            "something is missing; what was found is a hint and does not settle what it is"
        }
    }
}

fn named(effect: &FoundEffect) -> String {
    let place = place(effect.joint.as_deref(), &effect.joints);
    let mut text = format!(
        "{}{place}: {}\n  torque {}\n",
        effect.effect, effect.meaning, effect.formula
    );
    for found in &effect.parameters {
        let _ = writeln!(text, "  {}", parameter(found));
    }
    for (name, value) in &effect.shape {
        let _ = writeln!(text, "  {name} = {}", significant(*value, 4));
    }
    let _ = writeln!(
        text,
        "  lowers the torque error by {} %; by chance with probability {}",
        significant(effect.gain_pct, 3),
        probability(effect.p_value)
    );
    let rivals: Vec<String> = effect
        .alternatives
        .iter()
        .filter(|other| !other.separable)
        .map(|other| {
            format!(
                "{}{}",
                other.effect,
                self::place(other.joint.as_deref(), &other.joints)
            )
        })
        .collect();
    if !rivals.is_empty() {
        let _ = writeln!(
            text,
            "  cannot be told on these logs from {}\n  to tell: {}",
            rivals.join(", "),
            effect.experiment
        );
    }
    text
}

/// A parameter of an effect in words: `FST3 = 1.204 +- 0.031 N m`.
pub fn parameter(found: &EffectParameter) -> String {
    let sigma = found.sigma.map_or_else(
        || " (not determined)".to_owned(),
        |sigma| format!(" +- {}", significant(sigma, 2)),
    );
    let value = significant(found.value, 4);
    format!("{} = {value}{sigma} {}", found.name, found.unit)
}

/// Where an effect acts, in words, to follow its name: ` on joint 3 (elbow)`; nothing for the whole
/// robot.
pub fn place(joint: Option<&str>, joints: &[usize]) -> String {
    match (joint, joints) {
        (Some(name), [number]) => format!(" on joint {number} ({name})"),
        (_, []) => String::new(),
        (_, many) => {
            let many: Vec<String> = many.iter().map(usize::to_string).collect();
            format!(" on joints {}", many.join(" and "))
        }
    }
}

fn located(text: &mut String, diagnosis: &Diagnosis) {
    if !diagnosis.located.is_empty() {
        text.push_str("\nwhere the gap is\n");
    }
    for joint in &diagnosis.located {
        let with = match joint.varies_with.is_empty() {
            true => String::new(),
            false => format!(", varies with {}", joint.varies_with.join(", ")),
        };
        let _ = writeln!(
            text,
            "  {}: {} % of the residual is no noise{with}",
            joint.joint,
            significant(joint.unexplained_pct, 2)
        );
    }
}

/// What has no name, in a line each.
fn smooths(text: &mut String, diagnosis: &Diagnosis) {
    if !diagnosis.smooths.is_empty() {
        text.push_str("\nwhat it looks like\n");
    }
    for smooth in &diagnosis.smooths {
        let [one, other] = &smooth.variables;
        let proven = smooth.proven_pct.map_or(String::new(), |share| {
            format!(", {} % on data that were not used", significant(share, 2))
        });
        let _ = writeln!(
            text,
            "  {}: a smooth function of {} and {} explains {} % of what is left{proven} \
             (rms {} -> {} {})",
            smooth.joint,
            one.name,
            other.name,
            significant(smooth.explained_pct, 2),
            significant(smooth.rmse.before, 3),
            significant(smooth.rmse.after, 3),
            smooth.unit
        );
    }
}

fn gap(text: &mut String, diagnosis: &Diagnosis) {
    let gap = &diagnosis.gap;
    if gap.torque.before.total_pct == 0.0 && diagnosis.changed.is_some() {
        // No joint moves enough for its torque to be predicted.
        return;
    }
    let _ = writeln!(text, "\ntorque error on {}", gap.on);
    let (before, after) = (&gap.torque.before, &gap.torque.after);
    let total = (
        significant(before.total_pct, 3),
        significant(after.total_pct, 3),
    );
    let _ = writeln!(text, "  all joints: {} % -> {} %", total.0, total.1);
    let pairs = before.joints.iter().zip(&after.joints);
    // Joints at rest have no torque that a model predicts.
    let counted = |before: f64| before > 0.0 || diagnosis.changed.is_none();
    for (before, after) in pairs.filter(|(before, _)| counted(before.rmse)) {
        let _ = writeln!(
            text,
            "  {}: {} -> {} {}",
            before.name,
            significant(before.rmse, 3),
            significant(after.rmse, 3),
            before.unit
        );
    }
    if let Some(simulation) = &gap.simulation {
        let rms = |values: &[f64]| -> String {
            values
                .iter()
                .map(|v| significant(*v, 3))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let _ = writeln!(
            text,
            "simulated position, rms of each joint: {} -> {}",
            rms(&simulation.before.rms),
            rms(&simulation.after.rms)
        );
    }
}

/// A probability; below what numbers can hold it is no zero.
fn probability(p: f64) -> String {
    match p > 0.0 {
        true => format!("{p:.1e}"),
        false => "below 1e-300".to_owned(),
    }
}
