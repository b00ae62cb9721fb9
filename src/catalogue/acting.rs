//! Columns of the catalogue that act on a simulated robot.

use idim_runtime::diagnose::{Catalogue, Hypothesis, Signals};
use idim_runtime::simulate::{Influence, Moment};

use super::Effects;

/// The torque of an effect at the state of each sample, held until the next: its columns, as the
/// diagnosis fitted them, times its parameters.
pub(super) struct Acting<'a> {
    pub effects: &'a Effects,
    pub hypothesis: Hypothesis,
    pub shape: Vec<f64>,
    /// Values of its parameters.
    pub values: Vec<f64>,
    /// For each joint of the described robot those of the simulated one that turn it.
    pub places: Vec<Vec<usize>>,
    /// Velocity under which a sign is not certain.
    pub dead_band: Vec<f64>,
    /// By joint of the described robot; none yet.
    pub held: Vec<f64>,
}

impl Influence for Acting<'_> {
    fn begin(&mut self, moment: &Moment<'_>, _: &mut [f64]) {
        let of = |series: &[f64]| -> Vec<Vec<f64>> {
            let joint = |places: &Vec<usize>| vec![places.iter().map(|&k| series[k]).sum()];
            self.places.iter().map(joint).collect()
        };
        let (q, qd, qdd) = (of(moment.q), of(moment.qd), of(moment.qdd));
        let still = vec![vec![0.0]; q.len()];
        let signals = Signals {
            rate_hz: 1.0,
            t: &[moment.t],
            q: &q,
            qd: &qd,
            qdd: &qdd,
            tau_model: &still,
            tau_rigid: &still,
            parameters: &[],
            dead_band: &self.dead_band,
        };
        let columns = self
            .effects
            .columns(&self.hypothesis, &self.shape, &signals);
        self.held = vec![0.0; q.len()];
        for (column, value) in columns.iter().zip(&self.values) {
            for (joint, torque) in &column.torque {
                self.held[*joint] += value * torque.first().copied().unwrap_or(0.0);
            }
        }
    }

    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], torque: &mut [f64]) {
        for (places, held) in self.places.iter().zip(&self.held) {
            places.iter().for_each(|&k| torque[k] += held);
        }
    }
}
