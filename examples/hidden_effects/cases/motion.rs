//! The motions of the logs: Fourier series within the joints' ranges and speeds.

use std::f64::consts::TAU;

use idim::runtime::log::Fourier;

use super::random::Random;
use super::robots::Rating;

/// Samples per second.
pub const RATE_HZ: f64 = 1000.0;

/// 24 s: three periods of 8 s, or one long motion.
pub fn training(ratings: &[Rating], repeats: bool, random: &mut Random) -> Fourier {
    match repeats {
        true => series(ratings, (8.0, 3.0, 8), random),
        false => series(ratings, (24.0, 1.0, 22), random),
    }
}

/// 12 s of another motion.
pub fn validation(ratings: &[Rating], random: &mut Random) -> Fourier {
    series(ratings, (12.0, 1.0, 11), random)
}

/// Number of samples of a motion.
pub fn samples(motion: &Fourier) -> usize {
    (motion.periods / motion.f0_hz * RATE_HZ).round() as usize
}

fn series(
    ratings: &[Rating],
    (period, periods, orders): (f64, f64, usize),
    random: &mut Random,
) -> Fourier {
    let mut motion = Fourier {
        f0_hz: 1.0 / period,
        periods,
        center: Vec::new(),
        sin: Vec::new(),
        cos: Vec::new(),
    };
    for rating in ratings {
        // How fast the harmonics fade: from lively to smooth.
        let fade = random.uniform(0.25, 0.9);
        let mut row = || -> Vec<f64> {
            (1..=orders)
                .map(|h| random.normal() / (1.0 + 8.0 * h as f64 / period).powf(fade))
                .collect()
        };
        let (mut sin, mut cos) = (row(), row());
        let (reach, speed) = extremes(&sin, &cos, period);
        let factor = (rating.reach / reach).min(rating.speed / speed) * random.uniform(0.8, 1.0);
        for x in sin.iter_mut().chain(&mut cos) {
            // As it is written.
            *x = (*x * factor * 1e6).round() * 1e-6;
        }
        motion.center.push(rating.center);
        motion.sin.push(sin);
        motion.cos.push(cos);
    }
    motion
}

/// Largest distance from the centre and largest speed.
fn extremes(sin: &[f64], cos: &[f64], period: f64) -> (f64, f64) {
    let at = |k: usize| {
        let (mut q, mut qd) = (0.0, 0.0);
        for (h, (a, b)) in sin.iter().zip(cos).enumerate() {
            let w = TAU * (h + 1) as f64 / period;
            let (s, c) = (w * k as f64 * period / 2000.0).sin_cos();
            q += a * s + b * c;
            qd += w * (a * c - b * s);
        }
        (q, qd)
    };
    (0..2000).map(at).fold(
        (0.0, 0.0),
        |(reach, speed): (f64, f64), (q, qd): (f64, f64)| (reach.max(q.abs()), speed.max(qd.abs())),
    )
}
