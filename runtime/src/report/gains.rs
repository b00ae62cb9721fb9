//! The result of an identification of drive gains, and its rendering.

use serde::Serialize;

use super::table::{Align, Table, optional, significant};
use super::{LoadParameter, Physical};
use crate::observe::Filtering;

/// What the logged torque of each joint must be multiplied with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriveGains {
    /// The robot's name.
    pub robot: String,
    /// Names of the logs without the load.
    pub unloaded: Vec<String>,
    /// Names of the logs with it.
    pub loaded: Vec<String>,
    /// The filters.
    pub filter: Filtering,
    /// Link that carries the load, counted from 1.
    pub link: usize,
    /// Known mass of the load, kg.
    pub mass: f64,
    /// Mass that the logs show if all their torques are taken as they are, kg; `None` if they do
    /// not tell.
    pub mass_as_logged: Option<f64>,
    /// Number of equations.
    pub rows: usize,
    /// Numerical rank of the last linearised equations.
    pub rank: usize,
    /// Their 2-norm condition number, weighted as they were solved.
    pub condition: f64,
    /// Times the equations were solved.
    pub rounds: usize,
    /// Whether the factors came to rest.
    pub converged: bool,
    /// By joint.
    pub factors: Vec<GainFactor>,
    /// The joints without a factor, counted from 1: what is known of the load does not reach them.
    pub not_reached: Vec<usize>,
    /// XX .. ZZ about the origin of the link frame, first moments, mass of the load; those that
    /// were given have no sigma.
    pub load: Vec<LoadParameter>,
    /// What a body of these parameters would be.
    pub physical: Physical,
    /// What was noticed.
    pub warnings: Vec<String>,
}

/// The factor of one joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GainFactor {
    /// Joint, counted from 1.
    pub joint: usize,
    /// Its name.
    pub name: String,
    /// True torque by logged torque; `None` if the logs do not determine it.
    pub factor: Option<f64>,
    /// Standard deviation for independent errors.
    pub sigma: Option<f64>,
    /// Standard deviation that respects the correlation of filtered residuals.
    pub sigma_corrected: Option<f64>,
    /// Norm of what is left of the logged torque, % of its own.
    pub error_pct: f64,
}

/// Renders drive gains: the factors, the load they were found with, and what to be careful with.
pub fn terminal(gains: &DriveGains) -> String {
    let mut align = vec![Align::Left, Align::Left];
    align.extend([Align::Right; 4]);
    let mut table = Table::new(align);
    let titles = ["joint", "", "factor", "sigma", "corr.", "error %"];
    table.row(titles.map(str::to_owned).to_vec());
    for found in &gains.factors {
        table.row(vec![
            found.joint.to_string(),
            found.name.clone(),
            optional(found.factor, 5),
            optional(found.sigma, 2),
            optional(found.sigma_corrected, 2),
            significant(found.error_pct, 3),
        ]);
    }
    let mut text = format!(
        "{}: what logged torques must be multiplied with, by {} kg on link {}\n\
         without it {}; with it {}; {} equations, condition {}\n\n{}\n",
        gains.robot,
        significant(gains.mass, 5),
        gains.link,
        gains.unloaded.join(", "),
        gains.loaded.join(", "),
        gains.rows,
        significant(gains.condition, 4),
        table.render(118)
    );
    if let Some(mass) = gains.mass_as_logged {
        let mass = significant(mass, 4);
        text.push_str(&format!(
            "with the torques as logged the load would weigh {mass} kg\n"
        ));
    }
    for warning in &gains.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}
