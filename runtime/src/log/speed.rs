//! Measured velocities against the positions beside them: one of the two in another unit or with
//! another sign shows.

use crate::model::JointKind;

const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

/// Steps of q and integrals of qd that are less alike than this correlation prove nothing.
const ALIKE: f64 = 0.9;

/// A ratio this near to that of two units is theirs.
const NEAR: f64 = 0.05;

/// Position and velocity of one joint, and which of them has a unit in the companion.
pub(super) struct Pair<'a> {
    /// Such as ``Joint 1 (`shoulder`)``.
    pub name: String,
    pub kind: JointKind,
    pub q: &'a mut [f64],
    pub qd: &'a mut [f64],
    pub q_stated: bool,
    pub qd_stated: bool,
}

impl Pair<'_> {
    /// Puts a channel that is plainly in degrees (or millimetres) and whose unit nobody stated into
    /// SI; a sentence about that, or about any other way in which the two do not belong together.
    pub(super) fn settle(self, stamps: &[f64]) -> Option<String> {
        let ratio = ratio(stamps, self.q, self.qd)?;
        let (unit, per_si) = match self.kind {
            JointKind::Revolute => ("deg", DEGREES_PER_RADIAN),
            JointKind::Prismatic => ("mm", 1e3),
        };
        let near = |value: f64| (ratio / value - 1.0).abs() < NEAR;
        let name = self.name;
        let said = format!("{name}: q changes {ratio:.3} times as fast as qd says: ");
        let (channel, unit, series) = if near(per_si) && !self.q_stated {
            ("q", unit.to_owned(), self.q)
        } else if near(1.0 / per_si) && !self.qd_stated {
            ("qd", format!("{unit}/s"), self.qd)
        } else {
            let cause = match ratio {
                0.5..2.0 => return None,
                _ if near(-1.0) => {
                    "they have opposite signs; write gain = -1 for one of them under [columns] of \
                     the log companion"
                }
                _ => {
                    "their units, or their joints, do not belong together; state them under \
                     [columns] of the log companion"
                }
            };
            return Some(format!("{said}{cause}."));
        };
        series.iter_mut().for_each(|value| *value /= per_si);
        Some(format!(
            "{said}{channel} was taken to be in {unit}; confirm it with unit = \"{unit}\" for \
             {channel} under [columns] of the log companion."
        ))
    }
}

/// How many times larger the steps of q are than the integral of qd, by least squares; `None`
/// where noise hides how the two belong together.
fn ratio(stamps: &[f64], q: &[f64], qd: &[f64]) -> Option<f64> {
    let (mut cross, mut of_qd, mut of_q) = (0.0, 0.0, 0.0);
    for ((t, q), qd) in stamps.windows(2).zip(q.windows(2)).zip(qd.windows(2)) {
        let expected = 0.5 * (qd[0] + qd[1]) * (t[1] - t[0]);
        let step = q[1] - q[0];
        cross += expected * step;
        of_qd += expected * expected;
        of_q += step * step;
    }
    let alike = cross * cross >= ALIKE * ALIKE * of_qd * of_q;
    (alike && of_qd > 0.0).then_some(cross / of_qd)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f64 = 100.0;

    /// Position and velocity of a joint in the given units, settled: factors on both, sentence.
    fn settled(q_unit: f64, qd_unit: f64, stated: (bool, bool)) -> (f64, f64, Option<String>) {
        let t: Vec<f64> = (0..500).map(|k| f64::from(k) / RATE_HZ).collect();
        let mut q: Vec<f64> = t.iter().map(|t| q_unit * (3.0 * t).sin()).collect();
        let mut qd: Vec<f64> = t.iter().map(|t| qd_unit * 3.0 * (3.0 * t).cos()).collect();
        let before = (q[10], qd[10]);
        let pair = Pair {
            name: "Joint 1 (`shoulder`)".into(),
            kind: JointKind::Revolute,
            q: &mut q,
            qd: &mut qd,
            q_stated: stated.0,
            qd_stated: stated.1,
        };
        let said = pair.settle(&t);
        (q[10] / before.0, qd[10] / before.1, said)
    }

    #[test]
    fn channel_in_degrees_is_put_into_radians() {
        let rad = 1.0 / DEGREES_PER_RADIAN;
        let (q, qd, said) = settled(DEGREES_PER_RADIAN, 1.0, (false, false));
        assert!((q - rad).abs() < 1e-12 && qd == 1.0);
        assert!(said.unwrap().contains("q was taken to be in deg;"));
        let (q, qd, said) = settled(1.0, DEGREES_PER_RADIAN, (true, false));
        assert!((qd - rad).abs() < 1e-12 && q == 1.0);
        assert!(said.unwrap().contains("qd was taken to be in deg/s"));
    }

    #[test]
    fn unit_of_the_companion_is_not_changed() {
        let (q, qd, said) = settled(DEGREES_PER_RADIAN, 1.0, (true, false));
        assert_eq!((q, qd), (1.0, 1.0));
        assert!(said.unwrap().contains("do not belong together"));
    }

    #[test]
    fn channels_that_agree_are_left_alone_and_others_are_said_to_differ() {
        assert_eq!(settled(1.0, 1.0, (false, false)), (1.0, 1.0, None));
        let both = DEGREES_PER_RADIAN;
        assert_eq!(settled(both, both, (false, false)), (1.0, 1.0, None));
        let (.., said) = settled(1.0, -1.0, (false, false));
        assert!(said.unwrap().contains("opposite signs"));
        let (q, qd, said) = settled(1.0, 1e-3, (false, false));
        assert_eq!((q, qd), (1.0, 1.0));
        assert!(said.unwrap().contains("do not belong together"));
    }
}
