//! Families of motions that are linear in their coefficients: truncated Fourier series and quintic
//! splines through points.

use std::f64::consts::TAU;

use serde::Serialize;

/// Family of a motion. The position of a joint is its centre plus a sum of functions of time, each
/// times a coefficient; all functions have exact derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Family {
    /// \\( \sum_h s_h \sin(h \omega t) + k_h \cos(h \omega t) \\), \\( \omega = 2 \pi / T \\)
    /// (Swevers, Ganseman, Tukel, De Schutter and Van Brussel 1997).
    Fourier {
        /// Number of harmonics.
        harmonics: usize,
    },
    /// Polynomials of degree five between points at equal distances in time, with free position,
    /// velocity and acceleration at each (Gautier and Khalil 1992).
    ViaPoints {
        /// Number of points between start and end.
        points: usize,
    },
}

/// How a motion begins and ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// At the centre, without velocity and acceleration. Of a Fourier series this takes three of the
    /// coefficients of each joint: \\( \sum k_h = \sum h s_h = \sum h^2 k_h = 0 \\).
    #[default]
    Rest,
    /// Moving, for a robot that runs into the periodic motion. Splines begin at rest all the same.
    Moving,
}

/// Position, velocity and acceleration.
type Derivatives = [f64; 3];

/// A family over a period, with what is left of its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Basis {
    pub family: Family,
    pub period_s: f64,
    /// Each free direction: its share of every coefficient of the family.
    pub directions: Vec<Vec<f64>>,
}

/// The free functions at instants: function k at instant i is at `k * len + i`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sampled {
    pub len: usize,
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
}

impl Basis {
    pub fn new(family: Family, start: Start, period_s: f64) -> Basis {
        let directions = match (family, start) {
            (Family::Fourier { harmonics }, Start::Rest) => at_rest(harmonics),
            (Family::Fourier { harmonics }, Start::Moving) => moving(harmonics),
            (Family::ViaPoints { points }, _) => identity(3 * points),
        };
        Basis {
            family,
            period_s,
            directions,
        }
    }

    /// Number of free coefficients of a joint.
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// The coefficients of the family, from the free ones.
    pub fn coefficients(&self, free: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.directions.first().map_or(0, Vec::len)];
        for (factor, direction) in free.iter().zip(&self.directions) {
            let pairs = all.iter_mut().zip(direction);
            pairs.for_each(|(sum, share)| *sum += factor * share);
        }
        all
    }

    /// The free functions at `len` instants: the middles of equal parts of the period, or, with
    /// `ends`, from its start to its end.
    pub fn sample(&self, len: usize, ends: bool) -> Sampled {
        let instant = |i: usize| match ends {
            true => self.period_s * i as f64 / (len - 1).max(1) as f64,
            false => self.period_s * (i as f64 + 0.5) / len as f64,
        };
        let values: Vec<Vec<Derivatives>> = (0..len).map(|i| self.values(instant(i))).collect();
        let gather = |order: usize| -> Vec<f64> {
            (0..self.len())
                .flat_map(|k| values.iter().map(move |at| at[k][order]))
                .collect()
        };
        Sampled {
            len,
            q: gather(0),
            qd: gather(1),
            qdd: gather(2),
        }
    }

    /// All free functions at an instant.
    fn values(&self, t: f64) -> Vec<Derivatives> {
        let raw = self.raw(t);
        let sum = |direction: &Vec<f64>| {
            let pairs = direction.iter().zip(&raw);
            pairs.fold([0.0; 3], |sum, (share, value)| {
                [0, 1, 2].map(|order| sum[order] + share * value[order])
            })
        };
        self.directions.iter().map(sum).collect()
    }

    /// The functions of the family at an instant.
    fn raw(&self, t: f64) -> Vec<Derivatives> {
        match self.family {
            Family::Fourier { harmonics } => fourier(harmonics, TAU / self.period_s, t),
            Family::ViaPoints { points } => {
                let d = self.period_s / (points + 1) as f64;
                let place = |m: usize| t / d - m as f64;
                (1..=points).flat_map(|m| quintic(place(m), d)).collect()
            }
        }
    }
}

/// sin(h w t) of all harmonics, then cos(h w t).
fn fourier(harmonics: usize, w: f64, t: f64) -> Vec<Derivatives> {
    let sin = (1..=harmonics).map(|h| {
        let w = h as f64 * w;
        let (s, c) = (w * t).sin_cos();
        [s, w * c, -w * w * s]
    });
    let cos = (1..=harmonics).map(|h| {
        let w = h as f64 * w;
        let (s, c) = (w * t).sin_cos();
        [c, -w * s, -w * w * c]
    });
    sin.chain(cos).collect()
}

/// What position, velocity times d and acceleration times d^2 at a point contribute at a distance of
/// s intervals d from it: quintic Hermite polynomials, zero beyond the neighbouring points.
fn quintic(s: f64, d: f64) -> [Derivatives; 3] {
    if s.abs() >= 1.0 {
        return [[0.0; 3]; 3];
    }
    let (side, s) = (if s < 0.0 { -1.0 } else { 1.0 }, s.abs());
    let polynomials: [[f64; 6]; 3] = [
        [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
        [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
        [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
    ];
    let mut values = polynomials.map(|p| {
        let at = |order: usize| {
            let term = |k: usize| {
                let falling: f64 = (0..order).map(|i| (k - i) as f64).product();
                falling * p[k] * s.powi((k - order) as i32)
            };
            (order..6).map(term).sum::<f64>()
        };
        [at(0), side * at(1) / d, at(2) / (d * d)]
    });
    // Velocity is odd in time: before its point it contributes with the other sign.
    values[1] = values[1].map(|value| side * value);
    values
}

/// Directions of a Fourier series at rest at its centre: orthonormal among the sines and among the
/// cosines, the latter with a factor 1/h so that harmonics are equally fast.
fn at_rest(harmonics: usize) -> Vec<Vec<f64>> {
    let h = |power: i32| -> Vec<f64> {
        (1..=harmonics)
            .map(|h| f64::from(h as u32).powi(power))
            .collect()
    };
    // In units of equal speed, s_h = a_h / h: sum h s_h = sum a_h.
    let sines = complement(&[h(0)], harmonics);
    let cosines = complement(&[h(-1), h(1)], harmonics);
    let slowed = |place: usize, unit: Vec<f64>| -> Vec<f64> {
        let mut all = vec![0.0; 2 * harmonics];
        let parts = unit.iter().enumerate();
        parts.for_each(|(k, share)| all[place * harmonics + k] = share / (k + 1) as f64);
        all
    };
    let sines = sines.into_iter().map(|unit| slowed(0, unit));
    let cosines = cosines.into_iter().map(|unit| slowed(1, unit));
    sines.chain(cosines).collect()
}

/// Every coefficient of a Fourier series, in units of equal speed.
fn moving(harmonics: usize) -> Vec<Vec<f64>> {
    let mut directions = identity(2 * harmonics);
    for (k, direction) in directions.iter_mut().enumerate() {
        direction[k] = 1.0 / (k % harmonics + 1) as f64;
    }
    directions
}

fn identity(n: usize) -> Vec<Vec<f64>> {
    (0..n)
        .map(|k| (0..n).map(|i| f64::from(u8::from(i == k))).collect())
        .collect()
}

/// Orthonormal vectors of length n that are orthogonal to all of some vectors (Gram and Schmidt,
/// twice for digits).
fn complement(to: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = Vec::new();
    for vector in to.iter().cloned().chain(identity(n)) {
        let mut rest = vector;
        for _ in 0..2 {
            for unit in &all {
                let share: f64 = unit.iter().zip(&rest).map(|(a, b)| a * b).sum();
                let pairs = rest.iter_mut().zip(unit);
                pairs.for_each(|(value, unit)| *value -= share * unit);
            }
        }
        let norm = rest.iter().map(|value| value * value).sum::<f64>().sqrt();
        if norm > 1e-9 && all.len() < n {
            all.push(rest.iter().map(|value| value / norm).collect());
        }
    }
    all.split_off(to.len().min(all.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn families() -> [Basis; 3] {
        let fourier = Family::Fourier { harmonics: 5 };
        [
            Basis::new(fourier, Start::Rest, 8.0),
            Basis::new(fourier, Start::Moving, 8.0),
            Basis::new(Family::ViaPoints { points: 4 }, Start::Rest, 8.0),
        ]
    }

    #[test]
    fn derivatives_are_those_of_the_positions() {
        let step = 1e-4;
        for basis in families() {
            for t in [0.3, 1.7, 3.19, 5.9, 7.7] {
                let [before, at, after] = [t - step, t, t + step].map(|t| basis.values(t));
                for k in 0..basis.len() {
                    let qd = (after[k][0] - before[k][0]) / (2.0 * step);
                    let qdd = (after[k][1] - before[k][1]) / (2.0 * step);
                    assert!((qd - at[k][1]).abs() < 1e-5, "{:?} {k}", basis.family);
                    assert!((qdd - at[k][2]).abs() < 1e-5, "{:?} {k}", basis.family);
                }
            }
        }
    }

    #[test]
    fn motions_at_rest_begin_and_end_at_the_centre_without_velocity_and_acceleration() {
        let [fourier, _, points] = families();
        assert_eq!((fourier.len(), points.len()), (2 * 5 - 3, 3 * 4));
        for basis in [fourier, points] {
            for t in [0.0, 8.0] {
                let worst = basis.values(t).into_iter().flatten().map(f64::abs);
                assert!(worst.fold(0.0, f64::max) < 1e-11, "{:?}", basis.family);
            }
        }
    }

    #[test]
    fn spline_has_its_values_at_its_points_and_is_twice_smooth_there() {
        let [_, _, basis] = families();
        let d = 8.0 / 5.0;
        let units = [1.0, 1.0 / d, 1.0 / (d * d)];
        for (k, side) in (0..12).flat_map(|k| [(k, -1e-9), (k, 1e-9)]) {
            let point = k / 3 + 1;
            let at = basis.values(d * point as f64 + side)[k];
            for order in 0..3 {
                let expected = if order == k % 3 { units[order] } else { 0.0 };
                assert!((at[order] - expected).abs() < 1e-6, "{k} {order}: {at:?}");
            }
        }
    }
}
