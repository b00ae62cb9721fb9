//! The result of a payload identification, and its rendering.

use faer::{Mat, Side};
use serde::Serialize;

use super::Fit;
use super::table::{Align, Table, optional, significant};
use crate::observe::Filtering;

/// The ten standard parameters of a load, in the frame of the link that carries it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Payload {
    /// The robot's name.
    pub robot: String,
    /// Names of the logs with the load.
    pub logs: Vec<String>,
    /// The filters.
    pub filter: Filtering,
    /// Link that carries the load, counted from 1.
    pub link: usize,
    /// Number of equations.
    pub rows: usize,
    /// Numerical rank of the load's regressor, 10 if everything is determined.
    pub rank: usize,
    /// Its 2-norm condition number, weighted as it was solved.
    pub condition: f64,
    /// XX .. ZZ about the origin of the link frame, first moments, mass.
    pub parameters: Vec<LoadParameter>,
    /// What a body of these parameters would be.
    pub physical: Physical,
    /// Torque error with the parameters of the robot without load.
    pub before: Fit,
    /// Torque error with the load.
    pub after: Fit,
    /// What was noticed in the logs.
    pub warnings: Vec<String>,
}

/// One parameter of a load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadParameter {
    /// Name, such as `MX`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Value; `None` if the logs do not determine it.
    pub value: Option<f64>,
    /// Standard deviation for independent errors.
    pub sigma: Option<f64>,
    /// Standard deviation that respects the correlation of filtered residuals.
    pub sigma_corrected: Option<f64>,
}

/// The body that ten parameters describe, if they are all known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Physical {
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass in the link frame, m.
    pub com: Option<[f64; 3]>,
    /// Principal moments about it, ascending, kg m^2.
    pub moments: Option<[f64; 3]>,
    /// What no body can have, each a phrase; empty for a possible body.
    pub violations: Vec<String>,
}

impl Physical {
    /// Mass positive, principal moments positive, none larger than the sum of the others.
    pub fn of(parameters: &[LoadParameter]) -> Physical {
        let value = |k: usize| parameters.get(k).and_then(|p| p.value);
        let mass = value(9);
        let mut violations = Vec::new();
        if mass.is_some_and(|mass| mass <= 0.0) {
            violations.push("the mass is not positive".to_owned());
        }
        let heavy = mass.filter(|mass| *mass > 0.0);
        let com = heavy.and_then(|m| Some([value(6)? / m, value(7)? / m, value(8)? / m]));
        let moments = heavy.zip(com).and_then(|(mass, com)| {
            let j: Option<Vec<f64>> = (0..6).map(value).collect();
            principal(&j?, mass, com)
        });
        if let Some([least, middle, most]) = moments {
            if least <= 0.0 {
                violations.push("a principal moment of inertia is not positive".to_owned());
            } else if most > least + middle {
                violations.push(
                    "a principal moment of inertia is larger than the sum of the others".to_owned(),
                );
            }
        }
        Physical {
            mass,
            com,
            moments,
            violations,
        }
    }
}

/// Principal moments about the centre of mass, ascending.
fn principal(j: &[f64], mass: f64, com: [f64; 3]) -> Option<[f64; 3]> {
    const PLACE: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
    let square: f64 = com.iter().map(|c| c * c).sum();
    let central = Mat::from_fn(3, 3, |i, k| {
        let own = if i == k { square } else { 0.0 };
        j[PLACE[i][k]] - mass * (own - com[i] * com[k])
    });
    let moments = central.self_adjoint_eigenvalues(Side::Lower).ok()?;
    <[f64; 3]>::try_from(moments).ok()
}

/// Renders a payload: the ten parameters, the body, and how well the load explains the torque.
pub fn terminal(payload: &Payload) -> String {
    let mut align = vec![Align::Left, Align::Left];
    align.extend([Align::Right; 3]);
    let mut table = Table::new(align);
    let titles = ["load", "unit", "value", "sigma", "corr."];
    table.row(titles.map(str::to_owned).to_vec());
    for parameter in &payload.parameters {
        table.row(vec![
            parameter.name.clone(),
            parameter.unit.clone(),
            optional(parameter.value, 5),
            optional(parameter.sigma, 2),
            optional(parameter.sigma_corrected, 2),
        ]);
    }
    let mut text = format!(
        "{}: load on link {}, {} equations of {}, condition {}\n\n{}\n",
        payload.robot,
        payload.link,
        payload.rows,
        payload.logs.join(", "),
        significant(payload.condition, 4),
        table.render(118)
    );
    text.push_str(&body(&payload.physical));
    text.push_str(&format!(
        "torque error {} % without the load, {} % with it\n",
        significant(payload.before.total_pct, 3),
        significant(payload.after.total_pct, 3)
    ));
    for warning in &payload.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}

fn body(physical: &Physical) -> String {
    let list = |values: [f64; 3]| values.map(|x| significant(x, 4)).join(", ");
    let mut text = String::new();
    if let Some(mass) = physical.mass {
        text.push_str(&format!("mass {} kg", significant(mass, 4)));
    }
    if let Some(com) = physical.com {
        text.push_str(&format!(", centre of mass ({}) m", list(com)));
    }
    if let Some(moments) = physical.moments {
        text.push_str(&format!(", principal moments ({}) kg m^2", list(moments)));
    }
    text.push('\n');
    for violation in &physical.violations {
        text.push_str(&format!("no body is like that: {violation}\n"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(values: [f64; 10]) -> Vec<LoadParameter> {
        let parameter = |value| LoadParameter {
            name: String::new(),
            unit: String::new(),
            value: Some(value),
            sigma: None,
            sigma_corrected: None,
        };
        values.map(parameter).to_vec()
    }

    #[test]
    fn a_ball_away_from_the_frame_has_its_own_moments() {
        // 2 kg at (0.1, 0, 0.2) with 0.01 kg m^2 about its centre.
        let [xx, yy, zz] = [0.01 + 2.0 * 0.04, 0.01 + 2.0 * 0.05, 0.01 + 2.0 * 0.01];
        let found = load([xx, 0.0, -0.04, yy, 0.0, zz, 0.2, 0.0, 0.4, 2.0]);
        let physical = Physical::of(&found);
        assert!(physical.violations.is_empty(), "{physical:?}");
        assert_eq!(physical.com, Some([0.1, 0.0, 0.2]));
        for moment in physical.moments.unwrap() {
            assert!((moment - 0.01).abs() < 1e-15);
        }
    }

    #[test]
    fn impossible_bodies_are_named() {
        let says = |values, words: &str| {
            let violations = Physical::of(&load(values)).violations;
            assert!(
                violations.iter().any(|v| v.contains(words)),
                "{violations:?}"
            );
        };
        let body = |xx, yy, zz, mass| [xx, 0.0, 0.0, yy, 0.0, zz, 0.0, 0.0, 0.0, mass];
        says(body(1.0, 1.0, 1.0, -1.0), "mass is not positive");
        says(
            body(-0.1, 1.0, 1.0, 1.0),
            "moment of inertia is not positive",
        );
        says(body(1.0, 1.0, 3.0, 1.0), "larger than the sum");
    }
}
