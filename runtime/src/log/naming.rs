//! What the columns of a log are called, and which name is near to another.

use super::unit::Quantity;
use crate::model::Joint;

/// What a family of columns is called, and what it holds.
pub(super) struct Family {
    pub prefix: &'static str,
    pub suffix: &'static str,
    /// The joint's bare name will do as well.
    bare: bool,
    pub quantity: Quantity,
    pub motor: bool,
}

const fn family(prefix: &'static str, quantity: Quantity, motor: bool) -> Family {
    Family {
        prefix,
        suffix: "",
        bare: false,
        quantity,
        motor,
    }
}

pub(super) const Q: Family = Family {
    bare: true,
    ..family("q", Quantity::Position, false)
};
pub(super) const QM: Family = family("qm", Quantity::Position, true);
pub(super) const QD: Family = family("qd", Quantity::Velocity, false);
pub(super) const TAU: Family = family("tau", Quantity::Torque, false);
pub(super) const CURRENT: Family = family("i", Quantity::Drive, true);
pub(super) const VOLTAGE: Family = family("u", Quantity::Drive, true);
pub(super) const Q_REF: Family = Family {
    suffix: "_ref",
    ..Q
};
pub(super) const FAMILIES: [&Family; 7] = [&Q, &QM, &QD, &TAU, &CURRENT, &VOLTAGE, &Q_REF];

pub(super) const TIME: [&str; 2] = ["t", "time"];

impl Family {
    /// The names that a joint's column may have, the usual one first.
    pub fn names(&self, joint: usize, joints: &[Joint]) -> Vec<String> {
        let (prefix, suffix) = (self.prefix, self.suffix);
        let number = joint + 1;
        let mut names = vec![
            format!("{prefix}{number}{suffix}"),
            format!("{prefix}_{number}{suffix}"),
        ];
        if let Some(joint) = joints.get(joint) {
            names.push(format!("{prefix}_{}{suffix}", joint.name));
            if self.bare {
                names.push(format!("{}{suffix}", joint.name));
            }
        }
        names
    }
}

/// Every name that a column in use may have.
pub(super) fn canonical(joints: &[Joint]) -> Vec<String> {
    let of_joints = (0..joints.len()).flat_map(|j| {
        FAMILIES
            .iter()
            .flat_map(move |family| family.names(j, joints))
    });
    TIME.iter()
        .map(|&name| name.to_owned())
        .chain(of_joints)
        .collect()
}

/// Edit distance between two names, capitals and what follows `[` or `(` left out.
pub(super) fn distance(column: &str, name: &str) -> usize {
    let plain = |text: &str| -> Vec<char> {
        let end = text.find(['[', '(']).unwrap_or(text.len());
        text.get(..end)
            .unwrap_or(text)
            .trim()
            .to_lowercase()
            .chars()
            .take(64)
            .collect()
    };
    let (column, name) = (plain(column), plain(name));
    let mut row: Vec<usize> = (0..=name.len()).collect();
    for (i, a) in column.iter().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (b, above) in name.iter().zip(row.iter_mut().skip(1)) {
            left = (diagonal + usize::from(a != b))
                .min(left + 1)
                .min(*above + 1);
            diagonal = std::mem::replace(above, left);
        }
    }
    if column.is_empty() {
        name.len()
    } else {
        row.last().copied().unwrap_or(column.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::JointKind;

    #[test]
    fn names_of_a_joint_begin_with_its_number() {
        let joints = [Joint {
            name: "elbow".into(),
            kind: JointKind::Revolute,
        }];
        assert_eq!(Q.names(0, &joints), ["q1", "q_1", "q_elbow", "elbow"]);
        assert_eq!(
            Q_REF.names(0, &joints),
            ["q1_ref", "q_1_ref", "q_elbow_ref", "elbow_ref"]
        );
        assert_eq!(TAU.names(0, &joints), ["tau1", "tau_1", "tau_elbow"]);
        assert!(canonical(&joints).contains(&"i_elbow".to_owned()));
    }

    #[test]
    fn distance_counts_edits_and_overlooks_units_and_capitals() {
        for (column, name, expected) in [
            ("tau1", "tau1", 0),
            ("Torque1", "tau1", 4),
            ("Q1 [rad]", "q1", 0),
            ("q0", "q1", 1),
        ] {
            assert_eq!(distance(column, name), expected, "{column} {name}");
        }
        assert_eq!(distance("", "q1"), 2);
    }
}
