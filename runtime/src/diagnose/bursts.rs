//! What comes in bursts is no noise, even where it does not repeat and no variable of the joint
//! explains it: friction that comes and goes, a base that rocks, play elsewhere.

use super::state::{Bench, State};
use super::verdict::whole_weights;
use crate::model::IdentificationModel;

/// Kurtosis of whitened rows beyond which they are more than noise. That of Gaussian noise is 3; in
/// 742 joints of simulated robots without anything hidden it reached 4.2, but for one.
const BURSTS: f64 = 5.0;

/// Fewer rows than this say nothing of a fourth power.
const FEWEST: usize = 200;

/// Median of the absolute value of a standard normal variable.
const MEDIAN: f64 = 0.674_489_75;

/// Whitened rows of a joint that are small most of the time and far larger at times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bursts {
    pub joint: usize,
    /// Fourth moment over the square of the second one.
    pub kurtosis: f64,
    /// Share of the square of the rows that is more than noise of the usual size.
    pub share: f64,
}

impl Bursts {
    /// What is to be seen, and where to look.
    pub fn sentence(&self, model: &dyn IdentificationModel) -> String {
        format!(
            "What is left of joint `{}` comes in bursts (kurtosis {:.1}; noise has 3) and is no \
             noise: something comes and goes there that does not repeat with the motion. Look at \
             its residual over time.",
            model.joints()[self.joint].name,
            self.kurtosis
        )
    }
}

/// The joints whose residual comes in bursts.
pub(super) fn bursts(bench: &Bench<'_>, state: &State) -> Vec<Bursts> {
    let joints = 0..bench.train.joints();
    let of_joint = |joint: usize| {
        let weights = whole_weights(bench, joint);
        let rows = state.system.residual(joint).iter().zip(weights);
        let whole = rows.filter(|(_, weight)| *weight >= 1.0);
        let rows: Vec<f64> = whole.map(|(row, _)| *row).collect();
        let (kurtosis, share) = heavy(rows)?;
        Some(Bursts {
            joint,
            kurtosis,
            share,
        })
    };
    joints.filter_map(of_joint).collect()
}

/// Kurtosis of rows, and the share that is more than noise, if that is what they are.
fn heavy(mut rows: Vec<f64>) -> Option<(f64, f64)> {
    if rows.len() < FEWEST {
        return None;
    }
    let moment = |power: i32| rows.iter().map(|x| x.powi(power)).sum::<f64>() / rows.len() as f64;
    let (second, fourth) = (moment(2), moment(4));
    let kurtosis = fourth / (second * second);
    rows.iter_mut().for_each(|x| *x = x.abs());
    let middle = rows.len() / 2;
    let (_, median, _) = rows.select_nth_unstable_by(middle, f64::total_cmp);
    let usual = (*median / MEDIAN).powi(2);
    // Rows of zeros have no kurtosis, and are noise.
    (kurtosis > BURSTS).then_some((kurtosis, (1.0 - usual / second).max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::Pcg64Mcg;
    use rand_pcg::rand_core::Rng;

    /// Normal noise, as sums of twelve uniform values.
    fn normal(random: &mut Pcg64Mcg) -> f64 {
        let mut uniform = || random.next_u32() as f64 / f64::from(u32::MAX);
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    #[test]
    fn noise_has_no_bursts_and_noise_that_swells_has() {
        let mut random = Pcg64Mcg::new(0xcafe_f00d_d15e_a5e5);
        let noise: Vec<f64> = (0..20_000).map(|_| normal(&mut random)).collect();
        assert_eq!(heavy(noise.clone()), None);
        // Five times as large through a tenth of the log: a variance of 3.4. Half of the absolute values
        // are below 0.743, where 0.9 erf(x / sqrt 2) + 0.1 erf(x / 5 sqrt 2) = 1/2.
        let swells = noise.iter().enumerate();
        let swells = swells.map(|(t, x)| if t % 1000 < 100 { 5.0 * x } else { *x });
        let (kurtosis, share) = heavy(swells.collect()).unwrap();
        assert!(kurtosis > 10.0, "{kurtosis}");
        let usual = (0.743 / MEDIAN).powi(2);
        assert!((share - (1.0 - usual / 3.4)).abs() < 0.03, "{share}");
    }

    #[test]
    fn uniform_values_and_rows_without_any_noise_have_none() {
        let steps = (0..1000).map(|t| f64::from(t % 17) - 8.0).collect();
        assert_eq!(heavy(steps), None);
        assert_eq!(heavy(vec![0.0; 1000]), None);
        assert_eq!(heavy(vec![1e3, 0.0, 0.0]), None);
    }
}
