//! What is known of a case: what is written, and the truth.

use idim::runtime::log::Controller;
use serde::{Deserialize, Serialize};

use super::logs::{Noise, Simulated};
use super::robots::Described;

/// What a case is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Category {
    /// One effect of the catalogue.
    One,
    /// Two of them.
    Two,
    /// Nothing hidden.
    Nothing,
    /// Something that the catalogue has not.
    Outside,
}

/// What is known of a case that no diagnosis may read.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Truth {
    /// Its name.
    pub case: String,
    /// Its kind of robot.
    pub robot: String,
    /// What it is for.
    pub category: Category,
    /// What is hidden, the strongest first.
    pub effects: Vec<TrueEffect>,
    /// Whether the training motion repeats itself.
    pub repeats: bool,
    /// Torque that each joint is built for, N m or N.
    pub scale: Vec<f64>,
    /// Standard deviations that the true structure gains on the training log.
    pub evidence: f64,
    /// RMSE on validation of the described robot refitted, of the true structure refitted, and of the
    /// noise: 20 Hz, by joint.
    pub rmse_null: Vec<f64>,
    pub rmse_oracle: Vec<f64>,
    pub rmse_floor: Vec<f64>,
    /// Position error of the true robot, simulated without noise along the validation motion, rad or
    /// m, by joint.
    pub position_best: Vec<f64>,
}

/// A hidden effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TrueEffect {
    /// Name.
    pub effect: String,
    /// Joints, from 1; empty for the whole robot.
    pub joints: Vec<usize>,
    /// Standard deviations that it gains beyond the other.
    pub evidence: f64,
    /// What it is, in full.
    pub hidden: String,
}

/// A case: what is written, and the truth.
pub struct Case {
    /// The robot's description.
    pub described: Described,
    /// Its controller and noise.
    pub controller: Controller,
    pub noise: Noise,
    /// The two logs.
    pub train: Simulated,
    pub valid: Simulated,
    /// The truth.
    pub truth: Truth,
}
