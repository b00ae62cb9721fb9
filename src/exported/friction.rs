//! Viscous and Coulomb friction of the joints, as a URDF has it.

use idim_codegen::emit::urdf::{Dynamics, dynamics};
use idim_codegen::mechanism::Mechanism;

use super::ExportError;

/// FV and FS of every joint that has them, by the name of the joint. A negative estimate becomes
/// zero; what of it a URDF cannot say goes among the warnings.
///
/// # Errors
/// [`ExportError::NoFriction`].
pub(super) fn of(
    mechanism: &Mechanism,
    names: &[String],
    values: &[f64],
    warnings: &mut Vec<String>,
) -> Result<Vec<(String, Dynamics)>, ExportError> {
    let mut written = Vec::new();
    for (number, joint) in (1..).zip(&mechanism.joints) {
        let mut value = |symbol: &str, word: &str| {
            let name = format!("{symbol}{number}");
            let place = names.iter().position(|known| *known == name)?;
            let value = *values.get(place)?;
            if value < 0.0 {
                warnings.push(format!(
                    "{name} of `{}` was identified as {value:.4}, which no friction is: its {word} \
                     is written as 0.",
                    joint.name
                ));
            }
            Some(value.max(0.0))
        };
        let dynamics = Dynamics {
            damping: value("FV", "damping"),
            friction: value("FS", "friction"),
        };
        if dynamics != Dynamics::default() {
            written.push((joint.name.clone(), dynamics));
        } else {
            warnings.push(format!(
                "No friction of `{}` was identified: what the URDF says of it stays.",
                joint.name
            ));
        }
    }
    warnings.extend(left_out(names));
    match written.is_empty() {
        true => Err(ExportError::NoFriction),
        false => Ok(written),
    }
}

/// What there is of friction beside, in a sentence: the names of all friction begin with F.
fn left_out(names: &[String]) -> Option<String> {
    let other = |name: &&String| {
        let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
        symbol.starts_with('F') && !["FV", "FS"].contains(&symbol)
    };
    let others: Vec<&str> = names.iter().filter(other).map(String::as_str).collect();
    (!others.is_empty()).then(|| {
        format!(
            "A URDF has no words for {}: FV and FS of these joints are only a part of their friction. \
             Identify with viscous and Coulomb friction alone for the whole of it in two numbers.",
            others.join(", ")
        )
    })
}

/// Whether a reader of the written text finds this friction.
///
/// # Errors
/// [`ExportError::Defect`].
pub(super) fn reads_back(text: &str, wanted: &[(String, Dynamics)]) -> Result<(), ExportError> {
    let found = dynamics(text)?;
    for (number, (name, wanted)) in (1..).zip(wanted) {
        let found = found.iter().find(|(known, _)| known == name);
        let same = found.is_some_and(|(_, found)| {
            let pairs = [
                (wanted.damping, found.damping),
                (wanted.friction, found.friction),
            ];
            pairs.into_iter().all(|(w, f)| w.is_none() || w == f)
        });
        if !same {
            return Err(ExportError::Defect(number));
        }
    }
    Ok(())
}
