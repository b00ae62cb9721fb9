//! The presliding state of joints whose friction has a memory, run along a motion.

use crate::model::IdentificationModel;

/// z/zs of every joint along its velocity, from its state `begin` at the first sample, or from rest
/// in the middle of its range; zero for joints without a presliding state, nothing if there are
/// none.
pub(super) fn along(
    model: &dyn IdentificationModel,
    qd: &[Vec<f64>],
    rate_hz: f64,
    begin: &[f64],
) -> Vec<Vec<f64>> {
    let memories = model.presliding();
    if memories.is_empty() {
        return Vec::new();
    }
    let mut slip: Vec<Vec<f64>> = qd.iter().map(|qd| vec![0.0; qd.len()]).collect();
    for memory in memories {
        if let (Some(slip), Some(qd)) = (slip.get_mut(memory.joint), qd.get(memory.joint)) {
            let begin = begin.get(memory.joint).copied().unwrap_or(0.0);
            *slip = dahl(qd, rate_hz, memory.zs, begin);
        }
    }
    slip
}

/// \\( \dot z = \dot q - |\dot q| z / z_s \\) (Dahl 1968), as \\( z / z_s \\): exact for a velocity that
/// is constant over a sample, so that no step is too long for it. `zs` in rad or m, at the first
/// sample the state `begin`.
pub fn dahl(qd: &[f64], rate_hz: f64, zs: f64, begin: f64) -> Vec<f64> {
    let mut state = begin;
    let step = |(i, qd): (usize, &f64)| {
        if i > 0 {
            state = slipped(state, *qd, rate_hz, zs);
        }
        state
    };
    qd.iter().enumerate().map(step).collect()
}

/// The state of [`dahl`] one sample after `state`.
pub(crate) fn slipped(state: f64, qd: f64, rate_hz: f64, zs: f64) -> f64 {
    let kept = (-qd.abs() / (rate_hz * zs)).exp();
    let direction = if qd < 0.0 { -1.0 } else { 1.0 };
    direction + (state - direction) * kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_turns_round_over_its_displacement_whatever_the_rate() {
        for rate_hz in [10.0, 1000.0] {
            let velocity = |i: usize| if (i as f64) < rate_hz { 0.01 } else { -0.01 };
            let qd: Vec<f64> = (0..=(2.0 * rate_hz) as usize).map(velocity).collect();
            let state = dahl(&qd, rate_hz, 0.002, 0.0);
            // After 0.01 rad, five times zs, the joint slides; after 0.002 rad back, at 1.2 s, the
            // state has come from +1 towards -1 by 1 - 1/e.
            let at = |time: f64| state[(time * rate_hz) as usize];
            assert!(
                at(0.9) > 0.98 && at(1.95) < -0.97,
                "{} {}",
                at(0.9),
                at(1.95)
            );
            let back = -1.0 + 2.0 * (-1f64).exp();
            assert!(
                (at(1.2) - back).abs() < 0.45 * (10.0 / rate_hz) + 0.02,
                "{}",
                at(1.2)
            );
        }
    }

    #[test]
    fn a_joint_at_rest_keeps_its_state() {
        let state = dahl(&[0.1, 0.1, 0.0, 0.0], 10.0, 0.01, 0.0);
        assert_eq!(state[1], state[3]);
        assert!((-1.0..=1.0).contains(&state[3]));
        // However fast: the state never leaves its bounds.
        assert_eq!(dahl(&[0.0, 1e9, -1e9], 10.0, 1e-6, 0.0), [0.0, 1.0, -1.0]);
    }
}
