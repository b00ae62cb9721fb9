//! Functions of a robot beside its identification models: torques, mass matrix and gravity of
//! given base parameters, pose and Jacobian of its tips. In the graph of the models, and emitted
//! as they are; for those who ask.

pub mod composite;
pub mod dynamics;
pub mod kinematics;

use crate::base::BaseParameters;
use crate::derive::motion::Motions;
use crate::expr::{Expr, Graph};
use crate::mechanism::Mechanism;
use kinematics::Tip;

/// Functions that are asked for together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Inverse dynamics, mass matrix, gravity.
    Dynamics,
    /// Pose and Jacobian of every tip.
    Kinematics,
}

/// What a function computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// tau(q, qd, qdd, X) = D X.
    InverseDynamics,
    /// M(q, X).
    MassMatrix,
    /// g(q, X).
    Gravity,
    /// T(q), the homogeneous matrix of a tip.
    Pose,
    /// J(q), of the velocity of a tip's origin and its angular velocity.
    Jacobian,
}

/// How many rows or columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// As many as joints.
    Joints,
    /// As many as base parameters.
    Parameters,
    /// So many.
    Number(usize),
}

/// A function and its entries; all of them are written, also those that are always zero.
#[derive(Clone, Debug)]
pub struct Function {
    /// What it computes.
    pub quantity: Quantity,
    /// The tip it speaks of, if the robot has several.
    pub tip: Option<String>,
    /// The body of the description at that tip.
    pub body: Option<String>,
    /// By rows; a vector is one row.
    pub entries: Vec<Vec<Expr>>,
}

impl Function {
    /// Rows and columns; a vector has no rows.
    pub fn extents(&self) -> (Option<Extent>, Extent) {
        match self.quantity {
            Quantity::InverseDynamics | Quantity::Gravity => (None, Extent::Joints),
            Quantity::MassMatrix => (Some(Extent::Joints), Extent::Joints),
            Quantity::Pose => (Some(Extent::Number(4)), Extent::Number(4)),
            Quantity::Jacobian => (Some(Extent::Number(6)), Extent::Joints),
        }
    }

    /// Whether it takes base parameters.
    pub fn takes_parameters(&self) -> bool {
        !matches!(self.quantity, Quantity::Pose | Quantity::Jacobian)
    }

    /// The signals that it is a function of.
    pub fn signals(&self) -> &'static [&'static str] {
        match self.quantity {
            Quantity::InverseDynamics => &["q", "qd", "qdd"],
            _ => &["q"],
        }
    }

    /// What it returns, in one line.
    pub fn summary(&self) -> String {
        let tip = self.body.as_deref().unwrap_or_default();
        match self.quantity {
            Quantity::InverseDynamics => {
                "tau = D(q, qd, qdd) X by Newton and Euler, friction included".into()
            }
            Quantity::MassMatrix => "M(q) of X by composite bodies, rotors included".into(),
            Quantity::Gravity => {
                "g(q) of X, the torques that hold the links against gravity".into()
            }
            Quantity::Pose => format!("T(q), the homogeneous matrix of `{tip}` in the base frame"),
            Quantity::Jacobian => format!(
                "J(q) of `{tip}`: velocity of its origin, then angular velocity, in base axes"
            ),
        }
    }

    /// How it goes on where the motions of the links are known.
    pub fn course(&self) -> &'static str {
        match self.quantity {
            Quantity::InverseDynamics | Quantity::Gravity => {
                "Wrenches, handed back from the last link to the first."
            }
            Quantity::MassMatrix => "Composite bodies, from the last link to the first.",
            Quantity::Pose | Quantity::Jacobian => "Frames from the base to the tip.",
        }
    }

    /// Unit of its entries.
    pub fn unit(&self) -> &'static str {
        match self.quantity {
            Quantity::InverseDynamics | Quantity::Gravity => "N m or N",
            Quantity::MassMatrix => "kg m^2, kg m or kg",
            Quantity::Pose => "m in the last column",
            Quantity::Jacobian => "m/s or rad/s per unit of joint velocity",
        }
    }
}

/// Derives the functions of the groups.
pub fn derive(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    base: &BaseParameters,
    groups: &[Group],
) -> Vec<Function> {
    let base = &base.parameters;
    let mut functions = vec![];
    if groups.contains(&Group::Dynamics) {
        let tau = dynamics::inverse(graph, mechanism, motions, base);
        let matrix = dynamics::mass_matrix(graph, mechanism, motions, base);
        let gravity = dynamics::gravity(graph, mechanism, motions, base);
        functions.push(of(Quantity::InverseDynamics, vec![tau]));
        functions.push(of(Quantity::MassMatrix, matrix));
        functions.push(of(Quantity::Gravity, vec![gravity]));
    }
    if groups.contains(&Group::Kinematics) {
        let tips = kinematics::tips(mechanism);
        for tip in &tips {
            let pose = kinematics::pose(graph, mechanism, motions, tip);
            let jacobian = kinematics::jacobian(graph, mechanism, motions, tip);
            let both = [(Quantity::Pose, pose), (Quantity::Jacobian, jacobian)];
            functions.extend(both.map(|(quantity, entries)| Function {
                tip: (tips.len() > 1).then(|| suffix(&tips, tip)),
                body: Some(tip.name.clone()),
                ..of(quantity, entries)
            }));
        }
    }
    functions
}

fn of(quantity: Quantity, entries: Vec<Vec<Expr>>) -> Function {
    Function {
        quantity,
        tip: None,
        body: None,
        entries,
    }
}

/// The name of a tip as the end of an identifier; with the link's number where two are alike.
fn suffix(tips: &[Tip], tip: &Tip) -> String {
    let plain = |name: &str| -> String {
        let lower = name.to_lowercase();
        let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        lower.chars().map(letter).collect()
    };
    let name = plain(&tip.name);
    match tips
        .iter()
        .filter(|other| plain(&other.name) == name)
        .count()
    {
        1 => name,
        _ => format!("{name}_{}", tip.link + 1),
    }
}
