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
/// they are that link's.
pub fn priority(mechanism: &Mechanism, standard: &[Standard]) -> Vec<usize> {
    let mut columns: Vec<usize> = (0..standard.len()).collect();
    let links = mechanism.joints.len();
    columns.sort_by_key(|&column| {
        let parameter = &standard[column];
        let from_tip = links - parameter.link;
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
        (class, from_tip, column)
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

/// A relation as text: `ZZ1 + IA1 + 0.25*M2`.
pub fn relation(terms: &[(f64, String)]) -> String {
    let mut text = String::new();
    for (index, (coefficient, name)) in terms.iter().enumerate() {
        let sign = match (index, *coefficient < 0.0) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        text.push_str(sign);
        let size = coefficient.abs();
        if size != 1.0 {
            text.push_str(&format!("{size}*"));
        }
        text.push_str(name);
    }
    text
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
        let terms = [
            (1.0, "ZZ1".into()),
            (1.0, "IA1".into()),
            (-0.25, "M2".into()),
        ];
        assert_eq!(relation(&terms), "ZZ1 + IA1 - 0.25*M2");
    }
}
