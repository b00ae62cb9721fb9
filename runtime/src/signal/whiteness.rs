//! What a series looks like against white noise: amplitude density and autocorrelation.

use std::f64::consts::PI;

use super::bandwidth::fourier;

/// Amplitude density of a series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Density {
    /// Distance of two values, Hz; the first value stands at this frequency.
    pub step_hz: f64,
    /// Windows averaged.
    pub windows: usize,
    /// Unit of the series per square root of Hz.
    pub values: Vec<f64>,
}

/// One-sided amplitude density of a series about its mean (Welch 1967): Hann windows of at most
/// `longest` samples, a power of two, that overlap by half. Empty for fewer than 8 samples.
pub(crate) fn density(series: &[f64], rate_hz: f64, longest: usize) -> Density {
    let size = window_length(series.len(), longest);
    let step_hz = rate_hz / size.max(1) as f64;
    let starts: Vec<usize> = match size {
        0..8 => Vec::new(),
        _ => (0..=series.len() - size).step_by(size / 2).collect(),
    };
    let mut power = vec![0.0; size / 2];
    let centre = mean(series);
    for start in &starts {
        let (re, im) = transformed(&series[*start..start + size], centre);
        for (k, sum) in power.iter_mut().enumerate() {
            *sum += re[k + 1].powi(2) + im[k + 1].powi(2);
        }
    }
    // The sum of the squared Hann window is 3/8 of its length; two sides are folded into one,
    // but half the rate is there only once.
    let scale = 2.0 / (rate_hz * 0.375 * size as f64 * starts.len().max(1) as f64);
    let nyquist = size / 2;
    let side = |k: usize| if k + 1 == nyquist { 0.5 } else { 1.0 };
    let values = power.iter().enumerate();
    Density {
        step_hz,
        windows: starts.len(),
        values: match starts.is_empty() {
            true => Vec::new(),
            false => values.map(|(k, p)| (p * scale * side(k)).sqrt()).collect(),
        },
    }
}

/// Autocorrelation of a series about its mean at lags 1 to `lags`; zeros for a constant series,
/// none for lags beyond a quarter of it.
pub(crate) fn autocorrelation(series: &[f64], lags: usize) -> Vec<f64> {
    let centre = mean(series);
    let deviation: Vec<f64> = series.iter().map(|x| x - centre).collect();
    let product = |lag: usize| -> f64 {
        let pairs = deviation.iter().zip(&deviation[lag..]);
        pairs.map(|(x, y)| x * y).sum()
    };
    let variance = product(0);
    (1..=lags.min(series.len() / 4))
        .map(|lag| match variance > 0.0 {
            true => product(lag) / variance,
            false => 0.0,
        })
        .collect()
}

/// A power of two of which about eight windows fit, where the series is long enough.
fn window_length(samples: usize, longest: usize) -> usize {
    let wanted = (samples / 4).clamp(8, longest.max(8));
    match samples {
        0..8 => 0,
        _ => 1 << wanted.ilog2(),
    }
}

fn mean(series: &[f64]) -> f64 {
    series.iter().sum::<f64>() / series.len().max(1) as f64
}

/// Fourier transform of a Hann-windowed series about a value.
fn transformed(series: &[f64], centre: f64) -> (Vec<f64>, Vec<f64>) {
    let hann = |i: usize| (PI * i as f64 / series.len() as f64).sin().powi(2);
    let samples = series.iter().enumerate();
    let mut re: Vec<f64> = samples.map(|(i, x)| (x - centre) * hann(i)).collect();
    let mut im = vec![0.0; series.len()];
    fourier(&mut re, &mut im);
    (re, im)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of -1, 0 and 1 that follow no pattern (a linear congruential generator).
    fn noise(samples: usize) -> Vec<f64> {
        let mut state = 7u64;
        let next = |_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % 3) as f64 - 1.0
        };
        (0..samples).map(next).collect()
    }

    #[test]
    fn density_integrates_to_the_variance() {
        let series = noise(40_000);
        let found = density(&series, 50.0, 256);
        assert_eq!((found.values.len(), found.step_hz), (128, 50.0 / 256.0));
        let power: f64 = found.values.iter().map(|a| a * a * found.step_hz).sum();
        let variance = series.iter().map(|x| x * x).sum::<f64>() / 40_000.0;
        assert!((power / variance - 1.0).abs() < 0.03, "{power} {variance}");
    }

    #[test]
    fn a_sine_stands_at_its_frequency() {
        let wave: Vec<f64> = (0..4000)
            .map(|i| 5.0 + (f64::from(i) * 0.5).sin())
            .collect();
        let found = density(&wave, 100.0, 512);
        let peak =
            (0..found.values.len()).max_by(|a, b| found.values[*a].total_cmp(&found.values[*b]));
        let hz = (peak.unwrap() + 1) as f64 * found.step_hz;
        assert!(
            (hz - 50.0 / std::f64::consts::TAU).abs() < found.step_hz,
            "{hz}"
        );
    }

    #[test]
    fn white_noise_stays_in_the_white_band() {
        let found = autocorrelation(&noise(10_000), 100);
        let outside = found.iter().filter(|r| r.abs() > 1.96 / 100.0).count();
        assert!(outside <= 12, "{outside}");
    }

    #[test]
    fn a_ramp_remembers_and_a_constant_has_nothing_to_say() {
        let ramp: Vec<f64> = (0..100).map(f64::from).collect();
        assert!(autocorrelation(&ramp, 1)[0] > 0.95);
        assert_eq!(autocorrelation(&[2.0; 40], 3), [0.0; 3]);
        assert!(autocorrelation(&[1.0, 2.0], 5).is_empty());
        assert!(density(&[1.0; 5], 10.0, 64).values.is_empty());
    }
}
