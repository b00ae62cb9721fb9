//! A link behind its drive: how far it lags, and what that costs.
//!
//! With the drive where it is measured and the link z behind it, the gear carries the torque of the
//! links at q - z. To first order in z, and with the whole of its dynamics,
//!
//! M z'' + C z' + K z + c(z, z') = tau_links(q),
//!
//! where M, C, K are how that torque changes with acceleration, velocity and position of the joint
//! along the motion, and c is what the gear answers: a spring and a damper, or the stops of its
//! play.

use super::along::{Along, Displacement};

/// Samples over which M, C and K are taken as constant.
const HELD: usize = 8;

/// M is at least this share of its median: the parameters of a wrong model may make it negative.
const LEAST_MASS: f64 = 0.1;

/// A link and the torque that its gear has to carry along a motion.
pub(super) struct Link<'a> {
    /// tau_links, N m or N.
    load: &'a [f64],
    rate_hz: f64,
    /// M, C, K for every [`HELD`] samples.
    held: Vec<[f64; 3]>,
    /// Median of M, kg m^2 or kg.
    pub mass: f64,
}

impl<'a> Link<'a> {
    /// The link of a joint; `None` if it has no inertia that its drive could feel.
    pub fn of(along: &'a Along<'_>, joint: usize) -> Option<Link<'a>> {
        let load = along.carried().get(joint)?;
        let carried = along.carried_by(joint);
        let mut held: Vec<[f64; 3]> = (0..load.len()).step_by(HELD).map(carried).collect();
        let mut masses: Vec<f64> = held.iter().map(|[m, ..]| *m).collect();
        let middle = masses.len() / 2;
        if masses.is_empty() {
            return None;
        }
        let mass = *masses.select_nth_unstable_by(middle, f64::total_cmp).1;
        held.iter_mut()
            .for_each(|[m, ..]| *m = m.max(LEAST_MASS * mass));
        (mass > 0.0).then(|| Link {
            load,
            rate_hz: along.signals.rate_hz,
            held,
            mass,
        })
    }

    /// How far it lies behind, rad or m, with a gear of a `stiffness` (N m/rad) and a `damping`
    /// (N m s/rad), from rest under its load at the first sample.
    pub fn yields(&self, stiffness: f64, damping: f64) -> Displacement {
        let mut behind = Displacement::with_capacity(self.load.len());
        let (mut at, mut before) = (None, 0.0);
        for (part, [m, c, k]) in self.load.chunks(HELD).zip(&self.held) {
            let whole = (k + stiffness).max(LEAST_MASS * stiffness);
            let w = (whole / m).sqrt();
            let swing = Swing::new(w, 0.5 * (c + damping) / (w * m), self.rate_hz);
            for load in part {
                let u = load / whole;
                let [y, slope] = match at {
                    None => [u, 0.0],
                    Some(state) => swing.next(state, [before, u]),
                };
                (at, before) = (Some([y, slope]), u);
                let fall = w * w * (u - y) - 2.0 * swing.damping * w * slope;
                behind.push(y, slope, fall);
            }
        }
        behind
    }

    /// How far it lies behind in a gear with a play of `gap` (rad or m) whose stops do not throw it
    /// back: it leans on one until its load pulls it off, and flies to the other.
    pub fn plays(&self, gap: f64) -> Displacement {
        let mut behind = Displacement::with_capacity(self.load.len());
        let (half, dt) = (0.5 * gap, 1.0 / self.rate_hz);
        let first = self.load.first().copied().unwrap_or(0.0);
        let (mut z, mut speed) = (half * first.signum(), 0.0);
        for (part, [m, c, k]) in self.load.chunks(HELD).zip(&self.held) {
            for load in part {
                let pull = load - k * z - c * speed;
                let leans = z.abs() >= half && pull * z > 0.0;
                let next = if leans { 0.0 } else { speed + dt * pull / m };
                let far = z + dt * next;
                let lands = !leans && far.abs() >= half;
                // Where it lands it comes to rest.
                let next = if lands { 0.0 } else { next };
                behind.push(z, 0.5 * (speed + next), (next - speed) / dt);
                (z, speed) = (far.clamp(-half, half), next);
            }
        }
        behind
    }
}

/// A resonance, y'' + 2 damping w y' + w^2 y = w^2 u, sample by sample: exact for an input that is
/// linear between samples.
pub(super) struct Swing {
    w: f64,
    damping: f64,
    rate_hz: f64,
    /// y and y' after a sample by y, by y'/w before it, of what swings freely.
    free: [[f64; 2]; 2],
}

impl Swing {
    /// `w` in rad/s; a damping is taken between 0 and 1.
    pub fn new(w: f64, damping: f64, rate_hz: f64) -> Swing {
        let damping = damping.clamp(0.0, 0.999);
        let decay = damping * w;
        let own = w * (1.0 - damping * damping).sqrt();
        let (sin, cos) = (own / rate_hz).sin_cos();
        let fade = (-decay / rate_hz).exp();
        let [cos, sin] = [fade * cos, fade * sin / own];
        Swing {
            w,
            damping,
            rate_hz,
            free: [[cos + decay * sin, sin], [-w * w * sin, cos - decay * sin]],
        }
    }

    /// y and y' a sample later, while u goes from the one to the other.
    pub fn next(&self, [y, slope]: [f64; 2], [from, to]: [f64; 2]) -> [f64; 2] {
        // The response to a ramp runs behind it; what is left swings.
        let rise = (to - from) * self.rate_hz;
        let behind = 2.0 * self.damping * rise / self.w;
        let (z, zd) = (y - (from - behind), slope - rise);
        let [swing, rate] = self.free.map(|[by_y, by_slope]| by_y * z + by_slope * zd);
        [to - behind + swing, rise + rate]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link<'a>(load: &'a [f64], mass: f64, rate_hz: f64) -> Link<'a> {
        Link {
            load,
            rate_hz,
            held: vec![[mass, 0.0, 0.0]; load.len().div_ceil(HELD)],
            mass,
        }
    }

    #[test]
    fn a_load_that_turns_round_carries_the_link_across_its_play() {
        // From rest under a load s t: z = s t^3 / (6 M) reaches the gap after (6 M gap / s)^(1/3).
        let (rate, slope, mass, gap) = (1e4, 80.0, 0.7, 2e-3);
        let load: Vec<f64> = (0..6000)
            .map(|i| slope * (f64::from(i) / rate - 0.2))
            .collect();
        let behind = link(&load, mass, rate).plays(gap);
        let crossing = (6.0 * mass * gap / slope).cbrt();
        let at = |t: f64| behind.position[((0.2 + t) * rate) as usize];
        assert_eq!(at(-0.1), -0.5 * gap);
        assert!((at(0.5 * crossing) + 0.5 * gap - gap / 8.0).abs() < 0.01 * gap);
        assert!(at(0.99 * crossing) < 0.5 * gap);
        assert_eq!(at(1.01 * crossing), 0.5 * gap);
        // What it gains in flight it loses at the stop: the torque that the gear saves and then
        // costs leaves no momentum behind.
        let momentum: f64 = behind.acceleration.iter().sum();
        assert!(momentum.abs() < 1e-6, "{momentum}");
    }

    #[test]
    fn a_gear_under_a_steady_load_yields_by_it_over_its_stiffness() {
        let load = vec![12.0; 500];
        let behind = link(&load, 0.5, 1e3).yields(3000.0, 1.0);
        for (z, fall) in behind.position.iter().zip(&behind.acceleration) {
            assert!((z - 0.004).abs() < 1e-15 && fall.abs() < 1e-9);
        }
    }
}
