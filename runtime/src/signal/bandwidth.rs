//! The band in which a joint really moves, from the spectrum of its velocity.

use std::f64::consts::{PI, TAU};

/// Share of the velocity's power that the band holds.
const SHARE: f64 = 0.999;

/// Fewest samples whose spectrum says anything.
const FEWEST: usize = 32;

/// Estimates \\( \omega_{dyn} \\) (Gautier 1996, section 6.1), in Hz: the frequency below which
/// 99.9 % of the velocity's power lies, after noise is set aside.
///
/// Differentiation amplifies the noise of a position sensor with frequency, so going up from the
/// strongest octave the power falls with the motion and rises again with the noise; what lies
/// above the weakest octave is noise. `None` for a signal too short, without motion, or strongest
/// in its highest octave: that is noise alone.
pub fn bandwidth(position: &[f64], rate_hz: f64) -> Option<f64> {
    if position.len() < FEWEST {
        return None;
    }
    let power = velocity_power(position);
    let motion = &power[..noise_begins(&power)?];
    let total: f64 = motion.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mut sum = 0.0;
    let bin = motion.iter().position(|p| {
        sum += p;
        sum >= SHARE * total
    })?;
    Some((bin.max(1) as f64) * rate_hz / (2.0 * power.len() as f64))
}

/// Power spectrum of the Hann-windowed first differences, from zero to half the rate.
fn velocity_power(position: &[f64]) -> Vec<f64> {
    let samples = position.len() - 1;
    let size = samples.next_power_of_two();
    let mut re: Vec<f64> = position
        .windows(2)
        .enumerate()
        .map(|(i, pair)| {
            let window = (PI * (i as f64 + 0.5) / samples as f64).sin();
            (pair[1] - pair[0]) * window * window
        })
        .collect();
    re.resize(size, 0.0);
    let mut im = vec![0.0; size];
    fourier(&mut re, &mut im);
    (0..size / 2)
        .map(|k| re[k] * re[k] + im[k] * im[k])
        .collect()
}

/// First bin above the weakest octave on the high side of the strongest octave; `None` if there
/// is no octave above the strongest.
fn noise_begins(power: &[f64]) -> Option<usize> {
    let octaves: Vec<(usize, f64)> = std::iter::successors(Some(1), |low| Some(low * 2))
        .take_while(|low| *low < power.len())
        .map(|low| (2 * low, power[low..(2 * low).min(power.len())].iter().sum()))
        .collect();
    let by_power = |a: &&(usize, f64), b: &&(usize, f64)| a.1.total_cmp(&b.1);
    let strongest = octaves.iter().max_by(by_power)?.0;
    let above = octaves.iter().filter(|octave| octave.0 > strongest);
    above
        .min_by(by_power)
        .map(|octave| octave.0.min(power.len()))
}

/// Discrete Fourier transform in place; the length is a power of two (Cooley and Tukey 1965).
pub(super) fn fourier(re: &mut [f64], im: &mut [f64]) {
    let size = re.len();
    let bits = size.trailing_zeros();
    for i in 1..size {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            re.swap(i, j);
            im.swap(i, j);
        }
    }
    let mut half = 1;
    while half < size {
        for k in 0..half {
            let (sin, cos) = (-TAU * k as f64 / (2 * half) as f64).sin_cos();
            for low in (k..size).step_by(2 * half) {
                let high = low + half;
                let turned = (
                    re[high] * cos - im[high] * sin,
                    re[high] * sin + im[high] * cos,
                );
                (re[high], im[high]) = (re[low] - turned.0, im[low] - turned.1);
                re[low] += turned.0;
                im[low] += turned.1;
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fourier_agrees_with_its_definition() {
        let x: Vec<f64> = (0..16).map(|i| f64::from((i * 7) % 11)).collect();
        let (mut re, mut im) = (x.clone(), vec![0.0; 16]);
        fourier(&mut re, &mut im);
        for k in 0..16 {
            let sum = |f: fn(f64) -> f64| -> f64 {
                x.iter()
                    .enumerate()
                    .map(|(i, x)| x * f(TAU * (i * k) as f64 / 16.0))
                    .sum()
            };
            assert!((re[k] - sum(f64::cos)).abs() < 1e-12);
            assert!((im[k] + sum(f64::sin)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_sine_has_the_band_of_its_frequency() {
        let wave: Vec<f64> = (0..5000)
            .map(|i| (TAU * 2.0 * f64::from(i) / 1000.0).sin())
            .collect();
        let band = bandwidth(&wave, 1000.0).unwrap();
        assert!((1.9..2.6).contains(&band), "{band}");
    }

    #[test]
    fn sensor_noise_is_set_aside() {
        // Position noise of 0.1 % holds nearly all of the velocity's power at 1 kHz.
        let mut state = 1u64;
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let wave: Vec<f64> = (0..8000)
            .map(|i| (TAU * 0.5 * f64::from(i) / 1000.0).sin() + 1e-3 * noise())
            .collect();
        let band = bandwidth(&wave, 1000.0).unwrap();
        assert!((0.4..3.0).contains(&band), "{band}");
    }

    #[test]
    fn noise_alone_has_no_band() {
        let jitter: Vec<f64> = (0..4000)
            .map(|i| f64::from((i * 7919) % 13) * 1e-6)
            .collect();
        assert_eq!(bandwidth(&jitter, 1000.0), None);
    }

    #[test]
    fn a_joint_at_rest_has_no_band() {
        assert_eq!(bandwidth(&[0.3; 100], 100.0), None);
        assert_eq!(bandwidth(&[0.0, 1.0], 100.0), None);
    }
}
