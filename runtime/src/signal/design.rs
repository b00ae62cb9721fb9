//! Low-pass filter design: analog prototype, bilinear transform with prewarping, second-order
//! sections paired like SciPy's `zpk2sos`, so that coefficients agree section by section.

use std::f64::consts::PI;

use super::SignalError;
use super::cascade::{Cascade, Section};

/// Below this share of half the sampling rate, poles are so close to 1 that rounding moves them.
const LOWEST: f64 = 1e-5;

/// Beyond this order the rounding of the sections outweighs the sharper cut.
const MAX_ORDER: usize = 24;

/// Digital Butterworth low-pass, like `scipy.signal.butter(order, cutoff, fs=rate, output="sos")`.
///
/// `cutoff_hz` is the -3 dB frequency of one pass, `rate_hz` the sampling rate.
///
/// # Errors
/// [`SignalError::Order`], [`SignalError::CutOff`].
pub fn butterworth(order: usize, cutoff_hz: f64, rate_hz: f64) -> Result<Cascade, SignalError> {
    let warped = warp(order, cutoff_hz, rate_hz)?;
    let poles = half_plane_angles(order)
        .map(|angle| Complex {
            re: -angle.cos(),
            im: angle.sin(),
        })
        .collect();
    Ok(bilinear(poles, 1.0, warped))
}

/// Digital Chebyshev type I low-pass, like
/// `scipy.signal.cheby1(order, ripple, cutoff, fs=rate, output="sos")`.
///
/// `ripple_db` is the pass-band ripple in dB; `cutoff_hz` is where the gain leaves the ripple.
///
/// # Errors
/// [`SignalError::Order`], [`SignalError::CutOff`].
pub fn chebyshev1(
    order: usize,
    ripple_db: f64,
    cutoff_hz: f64,
    rate_hz: f64,
) -> Result<Cascade, SignalError> {
    let warped = warp(order, cutoff_hz, rate_hz)?;
    let ripple = (10f64.powf(0.1 * ripple_db) - 1.0).sqrt();
    let mu = (1.0 / ripple).asinh() / order as f64;
    let poles: Vec<Complex> = half_plane_angles(order)
        .map(|angle| Complex {
            re: -mu.sinh() * angle.cos(),
            im: mu.cosh() * angle.sin(),
        })
        .collect();
    // The prototype's gain is 1 at zero frequency for odd orders and the ripple's floor for even.
    let at_zero = poles.iter().map(|p| p.negated_product()).product::<f64>();
    let gain = if order.is_multiple_of(2) {
        at_zero / (1.0 + ripple * ripple).sqrt()
    } else {
        at_zero
    };
    Ok(bilinear(poles, gain, warped))
}

/// Cut-off of the analog prototype, for a bilinear transform at 2 samples per second.
fn warp(order: usize, cutoff_hz: f64, rate_hz: f64) -> Result<f64, SignalError> {
    if order == 0 || order > MAX_ORDER {
        return Err(SignalError::Order {
            order,
            max: MAX_ORDER,
        });
    }
    let nyquist_hz = rate_hz / 2.0;
    let lowest_hz = LOWEST * nyquist_hz;
    if !(cutoff_hz >= lowest_hz && cutoff_hz < nyquist_hz) {
        return Err(SignalError::CutOff {
            cutoff_hz,
            lowest_hz,
            nyquist_hz,
        });
    }
    Ok(4.0 * (PI * (cutoff_hz / nyquist_hz) / 2.0).tan())
}

/// Angles, from the negative real axis, of the prototype's poles in the upper half plane; the
/// real pole of an odd order comes first.
fn half_plane_angles(order: usize) -> impl Iterator<Item = f64> {
    let first = if order.is_multiple_of(2) { 1 } else { 0 };
    (first..order)
        .step_by(2)
        .map(move |m| PI * m as f64 / (2.0 * order as f64))
}

/// Maps the prototype to second-order sections. `poles` are those with `im >= 0`; all zeros of a
/// low-pass lie at infinity and map to -1.
fn bilinear(poles: Vec<Complex>, gain: f64, warped: f64) -> Cascade {
    const FS2: f64 = 4.0;
    let mut digital = Vec::with_capacity(poles.len());
    let mut scale = gain;
    for pole in poles {
        let pole = pole.scaled(warped);
        let denominator = Complex {
            re: FS2 - pole.re,
            im: -pole.im,
        };
        digital.push(
            Complex {
                re: FS2 + pole.re,
                im: pole.im,
            }
            .divided_by(denominator),
        );
        scale *= match pole.is_real() {
            true => warped / denominator.re,
            false => warped * warped / denominator.negated_product(),
        };
    }
    pair(digital, scale)
}

/// Second-order sections after `zpk2sos(pairing="nearest")`: the pole nearest the unit circle
/// goes last, each with the zeros nearest to it; the whole gain sits in the first section.
fn pair(mut poles: Vec<Complex>, gain: f64) -> Cascade {
    let odd = poles.iter().any(Complex::is_real);
    let sections = poles.len();
    // An odd order gets a pole and a zero at the origin; that pole joins the real one.
    let mut zero_at_origin = odd;
    poles.sort_by(|p, q| p.distance_to_circle().total_cmp(&q.distance_to_circle()));
    let mut cascade: Vec<Section> = Vec::with_capacity(sections);
    for pole in poles {
        let origin_is_nearer = pole.magnitude()
            < Complex {
                re: pole.re + 1.0,
                ..pole
            }
            .magnitude();
        let b = match zero_at_origin && (origin_is_nearer || cascade.len() + 1 == sections) {
            true => {
                zero_at_origin = false;
                [1.0, 1.0, 0.0]
            }
            false => [1.0, 2.0, 1.0],
        };
        let a = match pole.is_real() {
            true => [-pole.re, 0.0],
            false => [-2.0 * pole.re, pole.negated_product()],
        };
        cascade.push(Section { b, a });
    }
    cascade.reverse();
    if let Some(first) = cascade.first_mut() {
        first.b = first.b.map(|b| b * gain);
    }
    Cascade::new(cascade)
}

/// The little complex arithmetic that design needs.
#[derive(Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn is_real(&self) -> bool {
        self.im == 0.0
    }

    fn magnitude(&self) -> f64 {
        self.re.hypot(self.im)
    }

    fn distance_to_circle(&self) -> f64 {
        (1.0 - self.magnitude()).abs()
    }

    /// Product of -p over the pole and its conjugate; a real pole stands for itself alone.
    fn negated_product(&self) -> f64 {
        match self.is_real() {
            true => -self.re,
            false => self.re * self.re + self.im * self.im,
        }
    }

    fn scaled(self, by: f64) -> Self {
        Complex {
            re: self.re * by,
            im: self.im * by,
        }
    }

    fn divided_by(self, by: Complex) -> Self {
        let square = by.re * by.re + by.im * by.im;
        Complex {
            re: (self.re * by.re + self.im * by.im) / square,
            im: (self.im * by.re - self.re * by.im) / square,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::{BUTTERWORTH, CHEBYSHEV};
    use super::*;

    fn assert_sections(cascade: &Cascade, expected: &[[f64; 6]]) {
        assert_eq!(cascade.sections().len(), expected.len());
        for (section, row) in cascade.sections().iter().zip(expected) {
            let own = [
                section.b[0],
                section.b[1],
                section.b[2],
                1.0,
                section.a[0],
                section.a[1],
            ];
            for (x, y) in own.iter().zip(row) {
                assert!((x - y).abs() <= 1e-12 * y.abs(), "{own:?} against {row:?}");
            }
        }
    }

    #[test]
    fn butterworth_agrees_with_scipy() {
        for (order, normalised, expected) in BUTTERWORTH {
            let cascade = butterworth(*order, *normalised, 2.0).unwrap();
            assert_sections(&cascade, expected);
        }
    }

    #[test]
    fn chebyshev_agrees_with_scipy() {
        for (order, normalised, expected) in CHEBYSHEV {
            let cascade = chebyshev1(*order, 0.05, *normalised, 2.0).unwrap();
            assert_sections(&cascade, expected);
        }
    }

    #[test]
    fn butterworth_is_3_db_down_at_its_cut_off() {
        for order in 1..=10 {
            let cascade = butterworth(order, 8.0, 100.0).unwrap();
            assert!((cascade.gain(8.0 / 100.0) - 0.5f64.sqrt()).abs() < 1e-10);
            assert!((cascade.gain(0.0) - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn chebyshev_stays_inside_its_ripple_up_to_the_cut_off() {
        let floor = 10f64.powf(-0.05 / 20.0);
        for order in 1..=9 {
            let cascade = chebyshev1(order, 0.05, 4.0, 100.0).unwrap();
            for i in 0..=100 {
                let gain = cascade.gain(0.04 * f64::from(i) / 100.0);
                assert!(
                    gain < 1.0 + 1e-9 && gain > floor - 1e-9,
                    "order {order}: {gain}"
                );
            }
            assert!((cascade.gain(0.04) - floor).abs() < 1e-9);
        }
    }

    #[test]
    fn impossible_designs_are_errors() {
        let nyquist = SignalError::CutOff {
            cutoff_hz: 50.0,
            lowest_hz: 5e-4,
            nyquist_hz: 50.0,
        };
        assert_eq!(butterworth(4, 50.0, 100.0).unwrap_err(), nyquist);
        assert!(matches!(
            butterworth(4, f64::NAN, 100.0),
            Err(SignalError::CutOff { .. })
        ));
        assert!(matches!(
            butterworth(0, 5.0, 100.0),
            Err(SignalError::Order { .. })
        ));
        assert!(matches!(
            chebyshev1(99, 0.05, 5.0, 100.0),
            Err(SignalError::Order { .. })
        ));
    }
}
