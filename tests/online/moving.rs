//! A robot on an exciting motion, sample by sample: torque from the model along sums of sines.

use idim::runtime::model::{ColumnKind, IdentificationModel, Output, States};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// Standard deviations of what sensors add, rad (or m) and N m (or N).
#[derive(Clone, Copy)]
pub struct Noise {
    pub q: f64,
    pub tau: f64,
}

impl Noise {
    pub const NONE: Noise = Noise { q: 0.0, tau: 0.0 };
}

pub struct Moving<'m> {
    model: &'m dyn IdentificationModel,
    noise: Noise,
    random: Pcg64Mcg,
    signals: Vec<f64>,
    time: u64,
    pub rate_hz: f64,
    /// The parameters, which may change on the way.
    pub truth: Vec<f64>,
    /// A joint that does not move.
    pub hold: Option<usize>,
    /// The last sample.
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub tau: Vec<f64>,
    qdd: Vec<f64>,
    slip: Vec<f64>,
}

impl<'m> Moving<'m> {
    pub fn new(model: &'m dyn IdentificationModel, rate_hz: f64, noise: Noise) -> Moving<'m> {
        let mut random = Pcg64Mcg::new(17);
        let value = |kind: ColumnKind, random: &mut Pcg64Mcg| match kind {
            ColumnKind::Inertial | ColumnKind::Drive => 1.0 + uniform(random),
            ColumnKind::Friction | ColumnKind::Effect => 0.5 + 0.2 * uniform(random),
        };
        let joints = model.joints().len();
        Moving {
            truth: model
                .columns()
                .iter()
                .map(|c| value(c.kind, &mut random))
                .collect(),
            signals: vec![0.0; model.pattern(Output::Explicit).signals],
            model,
            noise,
            random,
            time: 0,
            rate_hz,
            hold: None,
            q: vec![0.0; joints],
            qd: vec![0.0; joints],
            qdd: vec![0.0; joints],
            tau: vec![0.0; joints],
            slip: vec![
                0.0;
                if model.presliding().is_empty() {
                    0
                } else {
                    joints
                }
            ],
        }
    }

    #[allow(dead_code, reason = "not every test has robots without friction")]
    pub fn without_friction(mut self) -> Self {
        for (value, column) in self.truth.iter_mut().zip(self.model.columns()) {
            if column.kind == ColumnKind::Friction {
                *value = 0.0;
            }
        }
        self
    }

    /// Positions and torques of the next sample.
    pub fn sample(&mut self) -> (&[f64], &[f64]) {
        let t = self.time as f64 / self.rate_hz;
        self.time += 1;
        for j in 0..self.q.len() {
            let [mut q, mut qd, mut qdd] = [0.0; 3];
            for m in 0..4 {
                let omega = std::f64::consts::TAU * (0.11 + 0.23 * m as f64 + 0.037 * j as f64);
                let size = 0.5 / (1.0 + m as f64);
                let phase = (1.7 * m as f64 + 0.9 * j as f64) + omega * t;
                q += size * phase.sin();
                qd += size * omega * phase.cos();
                qdd -= size * omega * omega * phase.sin();
            }
            let state = match self.hold == Some(j) {
                true => [0.3, 0.0, 0.0],
                false => [q, qd, qdd],
            };
            [self.q[j], self.qd[j], self.qdd[j]] = state;
        }
        self.slide();
        self.torque();
        let noise = self.noise;
        for (q, tau) in self.q.iter_mut().zip(&mut self.tau) {
            *q += noise.q * normal(&mut self.random);
            *tau += noise.tau * normal(&mut self.random);
        }
        (&self.q, &self.tau)
    }

    /// Contacts that yield: the solution of Dahl's equation for a velocity that is constant over a
    /// sample.
    fn slide(&mut self) {
        for memory in self.model.presliding() {
            let qd = self.qd[memory.joint];
            let end = if qd < 0.0 { -1.0 } else { 1.0 };
            let kept = (-qd.abs() / (self.rate_hz * memory.zs)).exp();
            let state = &mut self.slip[memory.joint];
            *state = end + (*state - end) * kept;
        }
    }

    fn torque(&mut self) {
        let states = States {
            len: 1,
            q: &self.q,
            qd: &self.qd,
            qdd: &self.qdd,
            slip: &self.slip,
        };
        self.model
            .evaluate(Output::Explicit, &states, &mut self.signals);
        self.tau.fill(0.0);
        for entry in self.model.pattern(Output::Explicit).entries.iter() {
            self.tau[entry.row] += self.truth[entry.column] * self.signals[entry.signal];
        }
    }
}

/// Uniform in -1..1.
pub fn uniform(random: &mut Pcg64Mcg) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// About normal, variance one: the sum of twelve uniform numbers.
pub fn normal(random: &mut Pcg64Mcg) -> f64 {
    (0..12).map(|_| 0.5 * uniform(random)).sum()
}
