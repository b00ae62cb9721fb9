//! A zero-phase low-pass taken apart into its decaying modes, for decimation without the samples
//! in between.
//!
//! Forward and backward filtering has the two-sided response
//! \\( h_m = c_0 \delta_m + \sum_k 2\,\mathrm{Re}\, r_k p_k^{|m|} \\), with the poles \\( p_k \\) of
//! the upper half plane and \\( r_k \\) from the residues of \\( H(z) H(1/z) \\) at them (Oppenheim
//! and Schafer, *Discrete-Time Signal Processing*, section 3.3). A geometric sum can be advanced by
//! n_d samples at once, so at the full rate there is nothing to do but two weighted sums per mode
//! over each n_d samples, one for the past and one for the future; the recursion itself runs at the
//! decimated rate. Away from the edges of a log the result is that of [`super::ZeroPhase`], to
//! rounding.

use faer::c64;

use super::cascade::{Cascade, Section};

/// Pole pairs of the decimation's low-pass, which has order 8.
pub(super) const PAIRS: usize = 4;

/// A complex number for each pair, real parts first.
pub(super) type State = [[f64; PAIRS]; 2];

/// The modes of a zero-phase low-pass of order 8.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Modes {
    pub poles: [c64; PAIRS],
    /// Twice \\( r_k \\): both poles of a pair.
    pub weights: [c64; PAIRS],
    /// \\( c_0 = H(0) H(\infty) \\).
    pub direct: f64,
}

impl Modes {
    /// Takes a cascade of [`PAIRS`] sections with complex poles apart; `None` for any other.
    pub fn of(cascade: &Cascade) -> Option<Self> {
        let sections: &[Section; PAIRS] = cascade.sections().try_into().ok()?;
        let complex = |s: &Section| (0.25 * s.a[0]).mul_add(-s.a[0], s.a[1]) > 0.0;
        if !sections.iter().all(complex) {
            return None;
        }
        let poles = sections.map(|s| pole(&s));
        let weight = |k: usize| 2.0 * residue(sections, &poles, k) / poles[k];
        Some(Modes {
            poles,
            weights: std::array::from_fn(weight),
            direct: sections.iter().map(|s| s.b[0] * s.b[2] / s.a[1]).product(),
        })
    }

    /// \\( p_k^m \\).
    pub fn powers(&self, m: usize) -> State {
        let powers = self.poles.map(|p| p.powu(m.min(u32::MAX as usize) as u32));
        [powers.map(|p| p.re), powers.map(|p| p.im)]
    }
}

/// The pole of a section in the upper half plane.
fn pole(section: &Section) -> c64 {
    let half = 0.5 * section.a[0];
    // Fused, since near 1 the difference is small against both.
    c64::new(-half, half.mul_add(-half, section.a[1]).sqrt())
}

/// Residue of \\( H(z) H(1/z) \\) at pole k. Denominators are products of distances between poles,
/// which keep their digits where polynomials lose them.
fn residue(sections: &[Section; PAIRS], poles: &[c64; PAIRS], k: usize) -> c64 {
    let p = poles[k];
    let mut value = c64::new(1.0, 0.0);
    for (j, section) in sections.iter().enumerate() {
        let [b0, b1, b2] = section.b;
        let (q, conjugate) = (poles[j], poles[j].conj());
        let here = if j == k {
            p - conjugate
        } else {
            (p - q) * (p - conjugate)
        };
        value *= (b0 * p * p + b1 * p + b2) / here;
        value *= (b0 + b1 * p + b2 * p * p) / ((1.0 - p * q) * (1.0 - p * conjugate));
    }
    value
}

#[cfg(test)]
mod tests {
    use super::super::{ZeroPhase, chebyshev1};
    use super::*;
    use crate::settings::Edges;

    /// The two-sided response, from the modes and by filtering an impulse. Rounding grows with the
    /// length of the response.
    #[test]
    fn modes_add_up_to_the_response_of_forward_and_backward_filtering() {
        for ratio in [2, 3, 10, 50, 400] {
            let cascade = chebyshev1(8, 0.05, 0.8 / ratio as f64, 2.0).unwrap();
            let modes = Modes::of(&cascade).unwrap();
            let filter = ZeroPhase::new(cascade, 8, Edges::Scipy);
            let half = filter.memory() + 100;
            let mut impulse = vec![0.0; 2 * half + 1];
            impulse[half] = 1.0;
            let response = &filter.filter(&[impulse]).unwrap()[0];
            for m in (0..half).step_by(1 + ratio / 7) {
                let term = |k: usize| (modes.weights[k] * modes.poles[k].powu(m as u32)).re;
                let direct = if m == 0 { modes.direct } else { 0.0 };
                let sum = direct + (0..PAIRS).map(term).sum::<f64>();
                for side in [response[half - m], response[half + m]] {
                    let error = (sum - side).abs() / response[half];
                    assert!(
                        error < 1e-14 * ratio as f64,
                        "1 in {ratio}, m {m}: {error:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn other_filters_are_refused() {
        assert!(Modes::of(&chebyshev1(7, 0.05, 0.1, 2.0).unwrap()).is_none());
        assert!(Modes::of(&chebyshev1(6, 0.05, 0.1, 2.0).unwrap()).is_none());
    }
}
