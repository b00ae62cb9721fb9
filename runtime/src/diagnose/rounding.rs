//! Rounding that repeats: where a motion comes back exactly, its encoders make the same errors in
//! every period, and what differs between periods does not show them.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use super::joined::Joined;
use super::repeats::{find, own_noise};
use super::track::{Instead, Track};
use crate::model::IdentificationModel;

/// The rows along positions that were rounded once more, at random: what the model makes of the
/// difference is what it makes of the first rounding.
pub(super) struct Rounding {
    again: Joined,
    /// What the difference counts for at each row: a mean over periods leaves it as it is, where
    /// it makes noise smaller by the root of their number.
    counts: Vec<f64>,
}

impl Rounding {
    /// `None` if no log repeats its rounding.
    pub fn of(model: &dyn IdentificationModel, joined: &Joined) -> Option<Rounding> {
        let periods = |track: &Track| match own_noise(track) {
            Some(_) => None,
            None => find(track, 0..track.rows()).map(|r| track.rows() as f64 / r.period as f64),
        };
        let mut again = joined.clone();
        let mut counts = vec![0.0; joined.rows()];
        for (track, rows) in again.tracks.iter_mut().zip(joined.segments.clone()) {
            let Some(periods) = periods(track) else {
                continue;
            };
            let along = track.beside(model, &Instead::Positions(rounded_again(track)));
            if let Ok(along) = along {
                *track = along;
                counts[rows].fill(periods.sqrt());
            }
        }
        let any = counts.iter().any(|count| *count > 0.0);
        any.then_some(Rounding { again, counts })
    }

    /// The part of a joint's noise that its rows do not show, under np parameters with which the
    /// model predicts `product`.
    pub fn hidden(&self, parameters: &[f64], product: &[Vec<f64>], joint: usize) -> Vec<f64> {
        let again = self.again.product(parameters);
        let pairs = again[joint].iter().zip(&product[joint]).zip(&self.counts);
        pairs.map(|((a, b), count)| count * (a - b)).collect()
    }
}

/// Positions with an error that is uniform over a step of their encoder.
fn rounded_again(track: &Track) -> Vec<Vec<f64>> {
    let mut generator = Pcg64Mcg::new(1);
    let mut uniform = || generator.next_u64() as f64 / u64::MAX as f64 - 0.5;
    let joints = track.source.recording.q.iter().zip(&track.steps);
    let moved = |(q, step): (&Vec<f64>, &f64)| q.iter().map(|q| q + step * uniform()).collect();
    joints.map(moved).collect()
}
