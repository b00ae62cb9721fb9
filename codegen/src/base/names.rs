//! Classical names and choices (Khalil, Gautier).

use crate::derive::{ParameterKind, Standard};
use crate::mechanism::{JointKind, Mechanism};

/// Places in [`crate::mechanism::inertia::NAMES`].
const YY: usize = 3;
const MZ: usize = 8;
const M: usize = 9;

/// Columns in the order in which they are kept if independent: friction and other effects, then
/// from the last link to the first what is usually identified, then what is usually regrouped
/// (YY, MZ, M of a revolute link, the tensor of a prismatic one), and rotor inertias last. The
/// first moments of a prismatic link come between: along the axis of the link that carries it
/// they are that link's. Among equals, links behind joints that follow others come last.
pub fn priority(mechanism: &Mechanism, standard: &[Standard]) -> Vec<usize> {
    let mut columns: Vec<usize> = (0..standard.len()).collect();
    let links = mechanism.joints.len();
    let place = |link: usize| {
        mechanism
            .order
            .iter()
            .position(|&at| at == link)
            .unwrap_or(link)
    };
    columns.sort_by_key(|&column| {
        let parameter = &standard[column];
        let from_tip = links - place(parameter.link);
        let follows = parameter.link >= mechanism.driven;
        let class = match parameter.kind {
            ParameterKind::Friction | ParameterKind::Effect => 0,
            ParameterKind::Inertial(index) => match mechanism.joints[parameter.link].kind {
                JointKind::Revolute if [YY, MZ, M].contains(&index) => 3,
                JointKind::Revolute => 1,
                JointKind::Prismatic if index == M => 1,
                JointKind::Prismatic if index < 6 => 3,
                JointKind::Prismatic => 2,
            },
            ParameterKind::Drive => 4,
        };
        (class, follows, from_tip, column)
    });
    columns
}

/// The name of a base parameter: `ZZ1` becomes `ZZR1` when others are regrouped into it.
pub fn base(name: &str, regrouped: bool) -> String {
    if !regrouped {
        return name.to_owned();
    }
    let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
    let symbol = &name[..name.len() - digits.len()];
    format!("{symbol}R{digits}")
}

/// A term of a relation: whether it is subtracted, its coefficient without the sign (empty for
/// 1), and the parameter.
pub type Term<'a> = (bool, String, &'a str);

/// A relation as text: `ZZ1 + IA1 + L^2*(M2 + M3)`.
pub fn relation(terms: &[Term<'_>]) -> String {
    let mut text = String::new();
    let same = |a: &Term<'_>, b: &Term<'_>| !a.1.is_empty() && (a.0, &a.1) == (b.0, &b.1);
    for (index, group) in terms.chunk_by(same).enumerate() {
        let (negative, coefficient, first) = &group[0];
        text.push_str(match (index, negative) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        let names: Vec<&str> = group.iter().map(|&(_, _, name)| name).collect();
        text.push_str(&match (coefficient.as_str(), names.len()) {
            ("", _) => (*first).to_owned(),
            (_, 1) => format!("{coefficient}*{first}"),
            _ => format!("{coefficient}*({})", names.join(" + ")),
        });
    }
    text
}

/// A coefficient as a number: whether it is negative, and its size (empty for 1).
pub fn number(coefficient: f64) -> (bool, String) {
    let size = coefficient.abs();
    let text = match size == 1.0 {
        true => String::new(),
        false => size.to_string(),
    };
    (coefficient < 0.0, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_regrouped_parameters_carry_an_r() {
        assert_eq!(base("ZZ1", true), "ZZR1");
        assert_eq!(base("MX12", true), "MXR12");
        assert_eq!(base("FV3", false), "FV3");
    }

    #[test]
    fn relations_read_like_sums() {
        let terms = [(1.0, "ZZ1"), (1.0, "IA1"), (-0.25, "M2"), (-0.25, "M3")];
        let terms = terms.map(|(coefficient, name)| {
            let (negative, text) = number(coefficient);
            (negative, text, name)
        });
        assert_eq!(relation(&terms), "ZZ1 + IA1 - 0.25*(M2 + M3)");
        assert_eq!(relation(&terms[..3]), "ZZ1 + IA1 - 0.25*M2");
    }
}
