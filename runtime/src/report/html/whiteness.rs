//! What the residual of a log looks like against white noise.

use super::markup::{Element, el};
use super::panel::{Curve, Frame, Panel, drawing, label};
use super::words::short;
use crate::report::{JointSeries, LogSeries, Spectrum};

const SIZE: (f64, f64) = (620.0, 168.0);
const DENSITY: Frame = Frame {
    left: 56.0,
    top: 22.0,
    width: 244.0,
    height: 108.0,
};
const MEMORY: Frame = Frame {
    left: 362.0,
    top: 22.0,
    width: 250.0,
    height: 108.0,
};

/// Pass-band of the parallel filter, as a part of half the decimated rate.
const PASSED: f64 = 0.8;

/// Half the width of the interval that holds 95 % of a normal distribution.
const Z95: f64 = 1.96;

/// Autocorrelations of white noise lie within this of zero, 95 % of them.
pub(super) fn white_band(rows: usize) -> f64 {
    Z95 / (rows.max(1) as f64).sqrt()
}

/// A drawing per joint: spectrum of torque and residual, autocorrelation of the residual.
pub(super) fn joints(log: &LogSeries) -> Vec<Element> {
    log.joints.iter().map(|joint| one(log, joint)).collect()
}

fn one(log: &LogSeries, joint: &JointSeries) -> Element {
    let words = format!(
        "Spectrum and autocorrelation of the residual of {}",
        joint.name
    );
    let name = label(DENSITY.left, 14.0, "start", &short(&joint.name, 36)).attr("class", "name");
    drawing("plot", SIZE, &words)
        .child(name.child(el("title").text(&joint.name)))
        .children(density(log, joint))
        .child(memory(log, joint))
}

fn density(log: &LogSeries, joint: &JointSeries) -> Option<Element> {
    let first = joint.models.first()?;
    let nyquist = log.rate_hz / 2.0;
    let passed: Vec<f64> = [&joint.spectrum, &first.spectrum]
        .into_iter()
        .flat_map(|spectrum| below(spectrum, PASSED * nyquist))
        .collect();
    let range = decades(&passed)?;
    let mut panel = Panel::new(DENSITY, (0.0, nyquist), range).logarithmic(range);
    let (low, high) = white_density(&first.spectrum, first.rmse, log.rate_hz);
    panel.band(low, high);
    panel.upright(PASSED * nyquist, "limit");
    let mut draw = |class: &str, spectrum: &Spectrum, name: String| {
        let x: Vec<f64> = (1..=spectrum.density.len())
            .map(|k| k as f64 * spectrum.step_hz)
            .collect();
        let y: Vec<f64> = spectrum.density.iter().map(|&y| f64::from(y)).collect();
        panel.curve(&Curve {
            class,
            name,
            x: &x,
            y: &y,
            points: y.len(),
        });
    };
    draw("measured", &joint.spectrum, "measured".to_owned());
    for model in &joint.models {
        let name = format!("{} residual", model.model.name());
        draw(model.model.name(), &model.spectrum, name);
    }
    let unit = format!("{}/\u{221a}Hz", joint.unit);
    Some(panel.finish(Some("frequency, Hz"), &unit, &unit))
}

/// The densities of a spectrum below a frequency.
fn below(spectrum: &Spectrum, hz: f64) -> impl Iterator<Item = f64> {
    let inside = (hz / spectrum.step_hz).floor() as usize;
    let values = spectrum.density.iter().take(inside);
    values.map(|&y| f64::from(y)).filter(|y| *y > 0.0)
}

/// The decades that hold the values; at most eight, the lowest being left out.
fn decades(values: &[f64]) -> Option<(f64, f64)> {
    let high = values.iter().copied().reduce(f64::max)?;
    let low = values.iter().copied().reduce(f64::min)?.max(1e-8 * high);
    Some((
        10f64.powf(low.log10().floor()),
        10f64.powf(high.log10().ceil()),
    ))
}

/// Where 95 % of the densities of white noise of that root mean square lie. Windows that overlap
/// by half give 36 K^2 / (19 K - 1) degrees of freedom (Welch 1967); their chi-square
/// distribution is approximated after Wilson and Hilferty (1931).
fn white_density(spectrum: &Spectrum, rmse: f64, rate_hz: f64) -> (f64, f64) {
    let level = rmse * (2.0 / rate_hz).sqrt();
    let windows = spectrum.windows.max(1) as f64;
    let freedom = 36.0 * windows * windows / (19.0 * windows - 1.0);
    let share = |z: f64| {
        let spread = 2.0 / (9.0 * freedom);
        (1.0 - spread + z * spread.sqrt()).max(0.0).powi(3).sqrt()
    };
    (level * share(-Z95), level * share(Z95))
}

fn memory(log: &LogSeries, joint: &JointSeries) -> Element {
    let band = white_band(log.rows);
    let lags = joint
        .models
        .iter()
        .map(|model| model.autocorrelation.len())
        .max();
    let longest = lags.unwrap_or(0).max(1) as f64 / log.rate_hz;
    let mut panel = Panel::new(MEMORY, (0.0, longest), (-1.0, 1.0));
    panel.band(-band, band);
    for model in &joint.models {
        let y: Vec<f64> = model
            .autocorrelation
            .iter()
            .map(|&r| f64::from(r))
            .collect();
        let x: Vec<f64> = (1..=y.len()).map(|lag| lag as f64 / log.rate_hz).collect();
        panel.stems(&Curve {
            class: model.model.name(),
            name: format!("{} residual", model.model.name()),
            x: &x,
            y: &y,
            points: y.len(),
        });
    }
    panel.finish(Some("lag, s"), "autocorrelation", "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_noise_has_the_density_that_gives_its_variance() {
        let spectrum = Spectrum {
            step_hz: 1.0,
            windows: 400,
            density: vec![],
        };
        let (low, high) = white_density(&spectrum, 3.0, 100.0);
        // Over half the rate the squared density adds up to the variance.
        let level = 3.0 / 50f64.sqrt();
        assert!(low < level && level < high && high / low < 1.2);
    }

    #[test]
    fn one_window_says_little() {
        let spectrum = Spectrum {
            step_hz: 1.0,
            windows: 1,
            density: vec![],
        };
        let (low, high) = white_density(&spectrum, 1.0, 2.0);
        // Chi-square with two degrees of freedom: 95 % lie between 0.0506 and 7.38.
        assert!((high - (7.38f64 / 2.0).sqrt()).abs() < 0.05, "{high}");
        assert!(low < 0.2, "{low}");
    }
}
