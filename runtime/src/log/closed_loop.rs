//! What a log's controller was told and did: the reference motion and the control law.
//!
//! Kept for the closed-loop simulation; nothing here evaluates them.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::companion::{Mistake, positive};

/// The commanded motion of a log.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Reference {
    /// A truncated Fourier series per joint.
    Fourier(Fourier),
    /// Polynomials of degree five between points.
    ViaPoints(ViaPoints),
    /// The log's own `q1_ref..` columns.
    Sampled {
        /// One series per joint on the grid of the recording, rad or m.
        q: Vec<Vec<f64>>,
    },
}

impl Reference {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        match self {
            Reference::Fourier(fourier) => fourier.center.len(),
            Reference::ViaPoints(points) => points.q.len(),
            Reference::Sampled { q } => q.len(),
        }
    }

    /// How long the motion takes, s; `None` for a sampled one, which has as many samples as its log.
    pub fn seconds(&self) -> Option<f64> {
        match self {
            Reference::Fourier(fourier) => Some(fourier.periods / fourier.f0_hz),
            Reference::ViaPoints(points) => Some(points.periods * points.period_s()),
            Reference::Sampled { .. } => None,
        }
    }
}

/// \\( q_{ref}(t) = c + \sum_h s_h \sin(h \omega t) + k_h \cos(h \omega t) \\),
/// \\( \omega = 2 \pi f_0 \\), h = 1, 2, ..; one row per joint, every row as long.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fourier {
    /// Base frequency, Hz.
    pub f0_hz: f64,
    /// The same motion so many times.
    pub periods: f64,
    /// Centre of each joint's motion, rad or m.
    pub center: Vec<f64>,
    /// Sine coefficients, joint by joint, rad or m.
    pub sin: Vec<Vec<f64>>,
    /// Cosine coefficients, joint by joint, rad or m.
    pub cos: Vec<Vec<f64>>,
}

/// The polynomial of degree five between every two neighbouring points that has position, velocity
/// and acceleration of both; one row per joint, every row as long as `times`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViaPoints {
    /// When the points are passed, s, increasing from 0.
    pub times: Vec<f64>,
    /// The same motion so many times; afterwards the joints stay where they are.
    pub periods: f64,
    /// Positions, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Velocities.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations.
    pub qdd: Vec<Vec<f64>>,
}

impl ViaPoints {
    /// One period, s.
    pub fn period_s(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
}

/// The control law: the only one known so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// torque = kp (q_ref - q) + kd (qd_ref - qd) + feedforward, limited.
    Pd,
}

/// What the controller adds without looking at the measured motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Feedforward {
    /// Nothing.
    #[default]
    None,
    /// Gravity torque of the description at the reference.
    Gravity,
    /// Inverse dynamics of the description along the reference, without friction and rotor inertia.
    Rigid,
}

/// Where a simulation of the log begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Start {
    /// On the reference: q(0) = q_ref(0), qd(0) = qd_ref(0).
    #[default]
    Reference,
    /// Where the log begins.
    Log,
}

/// The controller that a log was made with; one entry per joint in each list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Controller {
    /// The control law.
    pub law: Law,
    /// Position gains, N m/rad or N/m.
    pub kp: Vec<f64>,
    /// Velocity gains, N m s/rad or N s/m.
    pub kd: Vec<f64>,
    /// Feedforward.
    pub feedforward: Feedforward,
    /// Cut-off of the first-order low-pass on the backward difference of q, Hz; absent: exact qd.
    pub velocity_filter_hz: Option<f64>,
    /// Largest torque, N m or N; absent: unlimited.
    pub torque_limit: Option<Vec<f64>>,
    /// Where a simulation begins.
    pub start: Start,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawController {
    law: Law,
    kp: Spanned<Vec<f64>>,
    kd: Spanned<Vec<f64>>,
    #[serde(default)]
    feedforward: Feedforward,
    velocity_filter_hz: Option<Spanned<f64>>,
    torque_limit: Option<Spanned<Vec<f64>>>,
    #[serde(default)]
    start: Start,
}

impl RawController {
    pub(super) fn check(self) -> Result<Controller, Mistake> {
        let joints = self.kp.get_ref().len();
        let lists = [
            ("kp", Some(&self.kp)),
            ("kd", Some(&self.kd)),
            ("torque_limit", self.torque_limit.as_ref()),
        ];
        for (key, list) in lists {
            let Some(list) = list else { continue };
            let (span, values) = (list.span(), list.get_ref());
            same_length(key, "entries", values.len(), joints, &span)?;
            finite(key, values, &span)?;
            if values.iter().any(|&value| value < 0.0) {
                return Err((span, format!("{key} holds a negative value")));
            }
        }
        Ok(Controller {
            law: self.law,
            kp: self.kp.into_inner(),
            kd: self.kd.into_inner(),
            feedforward: self.feedforward,
            velocity_filter_hz: self
                .velocity_filter_hz
                .map(|cut_off| positive("velocity_filter_hz", cut_off))
                .transpose()?,
            torque_limit: self.torque_limit.map(Spanned::into_inner),
            start: self.start,
        })
    }
}

pub(super) fn same_length(
    key: &str,
    what: &str,
    found: usize,
    expected: usize,
    span: &Range<usize>,
) -> Result<(), Mistake> {
    if found == expected {
        return Ok(());
    }
    Err((
        span.clone(),
        format!("{key} has {found} {what}, expected {expected}"),
    ))
}

pub(super) fn finite(key: &str, values: &[f64], span: &Range<usize>) -> Result<(), Mistake> {
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    Err((span.clone(), format!("{key} holds NaN or infinity")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn controller(text: &str) -> Result<Controller, String> {
        let raw = toml::from_str::<RawController>(text).map_err(|e| e.message().to_owned())?;
        raw.check().map_err(|(_, message)| message)
    }

    #[test]
    fn controller_with_only_gains_has_the_plain_defaults() {
        let found = controller("law = 'pd'\nkp = [1]\nkd = [0]").unwrap();
        assert_eq!(found.feedforward, Feedforward::None);
        assert_eq!((found.velocity_filter_hz, found.torque_limit), (None, None));
    }

    #[test]
    fn controller_with_a_wrong_list_is_refused() {
        for (text, message) in [
            (
                "law = 'pd'\nkp = [1]\nkd = [0, 1]",
                "kd has 2 entries, expected 1",
            ),
            (
                "law = 'pd'\nkp = [-1]\nkd = [0]",
                "kp holds a negative value",
            ),
            ("law = 'lqr'\nkp = [1]\nkd = [0]", "unknown variant `lqr`"),
            (
                "law = 'pd'\nkp = [1]\nkd = [0]\nki = [1]",
                "unknown field `ki`",
            ),
            (
                "law = 'pd'\nkp = [1]\nkd = [0]\nvelocity_filter_hz = -1",
                "greater than zero",
            ),
        ] {
            let found = controller(text).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
