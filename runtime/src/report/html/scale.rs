//! From values to places on the page, and ticks that people can read.

/// Maps a range of values onto a range of pixels, linearly or by decades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    values: (f64, f64),
    pixels: (f64, f64),
    decades: bool,
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: String,
}

impl Scale {
    /// A linear scale from `values` to `pixels`.
    pub fn linear(values: (f64, f64), pixels: (f64, f64)) -> Self {
        Scale {
            values: apart(values),
            pixels,
            decades: false,
        }
    }

    /// A logarithmic scale; both `values` are positive.
    pub fn decades(values: (f64, f64), pixels: (f64, f64)) -> Self {
        let positive = |x: f64| x.max(f64::MIN_POSITIVE);
        Scale {
            values: (
                positive(values.0),
                positive(values.1).max(2.0 * positive(values.0)),
            ),
            pixels,
            decades: true,
        }
    }

    /// Place of a value; values out of range are drawn at its border.
    pub fn at(&self, value: f64) -> f64 {
        self.place(value, 0.0)
    }

    /// Place of a value, which may lie out of range by some ranges: what is drawn there is cut
    /// off, and not bent to the border.
    pub fn beyond(&self, value: f64) -> f64 {
        self.place(value, 9.0)
    }

    fn place(&self, value: f64, slack: f64) -> f64 {
        let (low, high) = (self.bent(self.values.0), self.bent(self.values.1));
        let share = ((self.bent(value) - low) / (high - low)).clamp(-slack, 1.0 + slack);
        // A value that is no number has no place; it is drawn where the axis begins.
        let share = if share.is_nan() { 0.0 } else { share };
        self.pixels.0 + share * (self.pixels.1 - self.pixels.0)
    }

    /// Whether a value lies within the range.
    pub fn holds(&self, value: f64) -> bool {
        (self.values.0..=self.values.1).contains(&value)
    }

    /// The range of values.
    pub fn range(&self) -> (f64, f64) {
        self.values
    }

    /// Whether the scale is logarithmic.
    pub fn is_logarithmic(&self) -> bool {
        self.decades
    }

    /// About `count` ticks: multiples of 1, 2 or 5 times a power of ten, or powers of ten.
    pub fn ticks(&self, count: usize) -> Vec<Tick> {
        match self.decades {
            true => self.powers(count),
            false => self.multiples(count),
        }
    }

    fn bent(&self, value: f64) -> f64 {
        match self.decades {
            true => value.max(f64::MIN_POSITIVE).log10(),
            false => value,
        }
    }

    fn multiples(&self, count: usize) -> Vec<Tick> {
        let (low, high) = self.values;
        let step = nice_step(high - low, count);
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let tick = |k: i64| {
            let value = k as f64 * step;
            Tick {
                value,
                label: minus(&format!("{value:.decimals$}")),
            }
        };
        (first..=last).take(64).map(tick).collect()
    }

    fn powers(&self, count: usize) -> Vec<Tick> {
        let (low, high) = (self.values.0.log10(), self.values.1.log10());
        let (first, last) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
        let every = ((last - first) as usize / count.max(1) + 1).max(1);
        let tick = |exponent: i32| Tick {
            value: 10f64.powi(exponent),
            label: power_of_ten(exponent),
        };
        (first..=last).step_by(every).map(tick).collect()
    }
}

/// The smallest range with round borders that holds the values.
pub(super) fn round_range(values: impl IntoIterator<Item = f64>, count: usize) -> (f64, f64) {
    let Some(range) = extent(values) else {
        return (0.0, 1.0);
    };
    let (low, high) = apart(range);
    let step = nice_step(high - low, count);
    ((low / step).floor() * step, (high / step).ceil() * step)
}

/// The range of the values, a little wider, so that no curve runs along the frame.
pub(super) fn padded_range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (low, high) = apart(extent(values).unwrap_or((0.0, 1.0)));
    let edge = 0.06 * (high - low);
    (low - edge, high + edge)
}

/// The least and the largest of the finite values, if there is one.
fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// 1, 2 or 5 times a power of ten, so that `span` has about `count` steps.
fn nice_step(span: f64, count: usize) -> f64 {
    let rough = span / count.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let share = rough / power;
    let multiple = match share {
        share if share <= 1.0 => 1.0,
        share if share <= 2.0 => 2.0,
        share if share <= 5.0 => 5.0,
        _ => 10.0,
    };
    multiple * power
}

/// A range that is not empty: about a single value, a tenth of it, or 1 about zero.
fn apart((low, high): (f64, f64)) -> (f64, f64) {
    let largest = low.abs().max(high.abs());
    match high - low > 1e-9 * largest {
        true => (low, high),
        false if largest > 0.0 => (low - 0.1 * largest, low + 0.1 * largest),
        false => (-1.0, 1.0),
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        -3..=4 => {
            let decimals = (-exponent).max(0) as usize;
            format!("{:.decimals$}", 10f64.powi(exponent))
        }
        _ => format!("1e{exponent}").replace('-', "\u{2212}"),
    }
}

/// A number with a minus sign as wide as its plus, and none before zero.
pub(super) fn minus(number: &str) -> String {
    let is_zero = number.chars().all(|c| matches!(c, '-' | '0' | '.'));
    match number.strip_prefix('-') {
        Some(digits) if is_zero => digits.to_owned(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => number.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, count: usize) -> Vec<String> {
        let ticks = scale.ticks(count).into_iter();
        ticks.map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round() {
        let scale = Scale::linear((-0.31, 0.3), (0.0, 100.0));
        assert_eq!(labels(scale, 4), ["\u{2212}0.2", "0.0", "0.2"]);
        let scale = Scale::linear((5.0, 7.5), (0.0, 100.0));
        assert_eq!(labels(scale, 5), ["5.0", "5.5", "6.0", "6.5", "7.0", "7.5"]);
        let scale = Scale::decades((0.004, 200.0), (0.0, 100.0));
        assert_eq!(labels(scale, 5), ["0.01", "0.1", "1", "10", "100"]);
    }

    #[test]
    fn values_have_places_within_the_frame() {
        let scale = Scale::linear((0.0, 10.0), (100.0, 0.0));
        assert_eq!(
            (scale.at(2.5), scale.at(99.0), scale.at(-1.0)),
            (75.0, 0.0, 100.0)
        );
        assert_eq!(scale.at(f64::NAN), 100.0);
        let scale = Scale::decades((0.01, 100.0), (0.0, 4.0));
        assert!((scale.at(1.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn ranges_hold_their_values_and_are_never_empty() {
        assert_eq!(round_range([0.13, 0.97], 5), (0.0, 1.0));
        assert_eq!(round_range([f64::NAN], 5), (0.0, 1.0));
        let (low, high) = round_range([3.0, 3.0], 5);
        assert!(low < 3.0 && high > 3.0);
        assert_eq!(padded_range([0.0, 100.0]), (-6.0, 106.0));
        assert!(padded_range([0.0]).0 < 0.0);
    }
}
