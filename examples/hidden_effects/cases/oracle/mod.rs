//! What the truth would do: the described robot, with and without the structure that is hidden in
//! the individual, fitted to its log.

mod columns;
mod delivered;
mod rows;

use idim::runtime::log::Recording;
use idim::runtime::model::{ColumnKind, IdentificationModel};
use idim::runtime::observe::{Equations, Filtering, ModelKind, Motion, observe};
use idim::runtime::settings::{Derivatives, Edges, Velocity};
use idim::runtime::signal::{Decimator, ZeroPhase, butterworth};

use columns::product;
use delivered::{command, undo};
use rows::{Colour, Joint, autoregression, cholesky, dot, residual, rests, rms};

use super::hidden::Effect;
use super::logs::Simulated;
use super::machine::{Failure, Machine};
use super::motion::RATE_HZ;

/// Rows of every joint at 50 Hz, low-passed at 20 Hz.
fn filtering() -> Filtering {
    Filtering {
        fq_hz: 40.0,
        order: 4,
        nd: 20,
        trim: 200,
        border: (0, 0),
        edges: Edges::Scipy,
        derivatives: Derivatives::Central,
        velocity: Velocity::Derived,
        prefilter_torque: false,
        chosen: Vec::new(),
    }
}

/// A structure fitted to a log.
pub struct Fit {
    /// Parameters of the machine's model, then of the extra columns.
    x: Vec<f64>,
    /// Autoregression of each joint's residual and its innovation's standard deviation.
    noise: Vec<Colour>,
}

/// The described robot with some structure.
pub struct Oracle<'a> {
    machine: &'a Machine,
    effects: &'a [Effect],
}

impl<'a> Oracle<'a> {
    /// `machine` is the described robot with the structure of `effects`.
    pub fn new(machine: &'a Machine, effects: &'a [Effect]) -> Oracle<'a> {
        Oracle { machine, effects }
    }

    /// Fits the parameters, twice: with plain rows, then with those whitened by what is left.
    pub fn fit(&self, log: &Simulated) -> Result<Fit, Failure> {
        let joints = self.equations(log)?;
        let white: Vec<Colour> = joints
            .iter()
            .map(|joint| (Vec::new(), 0.01 * rms(&joint.y).max(f64::MIN_POSITIVE)))
            .collect();
        let mut x = self.solve(&joints, &white);
        let mut noise = white;
        for _ in 0..2 {
            noise = joints
                .iter()
                .map(|joint| autoregression(&residual(joint, &x), &joint.rests))
                .collect();
            x = self.solve(&joints, &noise);
        }
        Ok(Fit { x, noise })
    }

    /// Sum of squares that the best fit under a given noise leaves, in units of the noise, prior
    /// rows included.
    pub fn left(&self, log: &Simulated, noise: &[Colour]) -> Result<f64, Failure> {
        let joints = self.equations(log)?;
        let x = self.solve(&joints, noise);
        let rows = joints.iter().zip(noise).map(|(joint, noise)| {
            let white = joint.whiten(&residual(joint, &x), noise);
            white.iter().map(|r| r * r).sum::<f64>()
        });
        let prior = self.prior().into_iter().map(|(row, right)| {
            let value: f64 = row.iter().map(|&(k, a)| a * x[k]).sum();
            (value - right).powi(2)
        });
        Ok(rows.sum::<f64>() + prior.sum::<f64>())
    }

    /// Torque predicted along a log at its full rate, one series per driven joint.
    pub fn predict(&self, fit: &Fit, log: &Simulated) -> Result<Vec<Vec<f64>>, Failure> {
        let motion = Motion::full(&self.recording(log), &self.machine.model, &filtering())?;
        let mut tau = product(&self.machine.model, &fit.x, &motion);
        let np = self.machine.values.len();
        for (extra, column) in self.extra(&motion, 0.0).iter().enumerate() {
            for (joint, torque) in column {
                let pairs = tau[*joint].iter_mut().zip(torque);
                pairs.for_each(|(tau, c)| *tau += fit.x[np + extra] * c);
            }
        }
        let driven = self.machine.driven.iter();
        let mut tau: Vec<Vec<f64>> = driven
            .map(|&joint| std::mem::take(&mut tau[joint]))
            .collect();
        for effect in self.effects {
            command(&effect.hidden, log, &mut tau);
        }
        Ok(tau)
    }

    /// The log as the structure explains it: true hidden joints, encoders put right, torques as
    /// the drives delivered them.
    fn recording(&self, log: &Simulated) -> Recording {
        let joints = self.machine.model.joints().len();
        let len = log.q[0].len();
        let mut q = log.truth.clone();
        let mut tau = vec![vec![0.0; len]; joints];
        let (mut seen, mut delivered) = (log.q.clone(), log.tau.clone());
        for effect in self.effects {
            undo(&effect.hidden, log, &mut seen, &mut delivered);
        }
        // A robot without hidden joints was told nothing of them.
        q.resize(joints, vec![0.0; len]);
        for (place, &joint) in self.machine.driven.iter().enumerate() {
            q[joint] = std::mem::take(&mut seen[place]);
            tau[joint] = std::mem::take(&mut delivered[place]);
        }
        Recording {
            name: "simulated".into(),
            stem: "simulated".into(),
            rate_hz: RATE_HZ,
            start: 0.0,
            len,
            q,
            qd: None,
            tau: Some(tau),
            doubtful: Vec::new(),
            stamps: (0..len).map(|k| k as f64 / RATE_HZ).collect(),
            warnings: Vec::new(),
        }
    }

    fn equations(&self, log: &Simulated) -> Result<Vec<Joint>, Failure> {
        let model = &self.machine.model;
        let motion = Motion::trimmed(&self.recording(log), model, &filtering())?;
        let all = observe(model, ModelKind::Explicit, &motion, &filtering())?;
        let begin = filtering().trim as f64 / RATE_HZ;
        let extra = self.extra(&motion, begin);
        let decimator = Decimator::new(filtering().nd, RATE_HZ, Edges::Scipy)?;
        let kept = decimator.kept(motion.len);
        let mut decimated = Vec::new();
        for (number, column) in extra.into_iter().enumerate() {
            let (joints, series): (Vec<usize>, Vec<Vec<f64>>) = column.into_iter().unzip();
            let rows = decimator.values(series.as_slice(), &kept)?;
            decimated.extend(
                joints
                    .into_iter()
                    .zip(rows)
                    .map(|(joint, rows)| (number, joint, rows)),
            );
        }
        let np = self.machine.values.len();
        let joint = |&driven: &usize| {
            let block: &Equations = &all.blocks[driven];
            let own = block.columns.iter().enumerate();
            let mut columns: Vec<(usize, Vec<f64>)> = own
                .map(|(k, &column)| (column, block.column(k).to_vec()))
                .collect();
            let on_joint = decimated.iter().filter(|(_, joint, _)| *joint == driven);
            columns.extend(on_joint.map(|(number, _, rows)| (np + number, rows.clone())));
            let y = block.y.clone().unwrap_or_default();
            Joint {
                columns,
                y,
                rests: rests(&motion.qd[driven], &kept),
            }
        };
        Ok(self.machine.driven.iter().map(joint).collect())
    }

    /// What the description knows, as rows of sparse factors; friction is left open.
    fn prior(&self) -> Vec<(Vec<(usize, f64)>, f64)> {
        let model = &self.machine.model;
        let np = self.machine.values.len();
        let rows = model.knowledge().prior.chunks_exact(np + 1);
        let sparse = rows.map(|row| {
            let factors = row[..np].iter().copied().enumerate();
            let used: Vec<(usize, f64)> = factors.filter(|(_, a)| *a != 0.0).collect();
            (used, row[np])
        });
        let open = |column: usize| model.columns()[column].kind == ColumnKind::Friction;
        sparse
            .filter(|(row, _)| row.iter().any(|&(k, _)| !open(k)))
            .collect()
    }

    /// Weighted least squares with the prior, by normal equations of scaled columns.
    fn solve(&self, joints: &[Joint], noise: &[Colour]) -> Vec<f64> {
        let extra = joints
            .iter()
            .flat_map(|joint| joint.columns.iter().map(|c| c.0 + 1))
            .max();
        let size = self.machine.values.len().max(extra.unwrap_or(0));
        let mut normal = vec![0.0; size * size];
        let mut right = vec![0.0; size];
        for (joint, noise) in joints.iter().zip(noise) {
            let white: Vec<(usize, Vec<f64>)> = joint
                .columns
                .iter()
                .map(|(k, rows)| (*k, joint.whiten(rows, noise)))
                .collect();
            let y = joint.whiten(&joint.y, noise);
            for (a, (k, rows)) in white.iter().enumerate() {
                right[*k] += dot(rows, &y);
                for (l, other) in &white[..=a] {
                    let product = dot(rows, other);
                    normal[k * size + l] += product;
                    if k != l {
                        normal[l * size + k] += product;
                    }
                }
            }
        }
        for (row, b) in self.prior() {
            for &(k, a) in &row {
                right[k] += a * b;
                row.iter()
                    .for_each(|&(l, other)| normal[k * size + l] += a * other);
            }
        }
        cholesky(normal, right)
    }
}

/// How many standard deviations a structure gains on a log over the described robot without it.
pub fn evidence(
    null: &Oracle<'_>,
    truth: &Oracle<'_>,
    fit: &Fit,
    log: &Simulated,
) -> Result<f64, Failure> {
    let gain = null.left(log, &fit.noise)? - truth.left(log, &fit.noise)?;
    Ok(gain.max(0.0).sqrt())
}

/// RMSE of each joint's torque behind a zero-phase low-pass of 20 Hz, without the first and the
/// last half second.
pub fn rmse(measured: &[Vec<f64>], predicted: &[Vec<f64>]) -> Result<Vec<f64>, Failure> {
    let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a - b).collect();
    let errors: Vec<Vec<f64>> = measured.iter().zip(predicted).map(difference).collect();
    let low_pass = ZeroPhase::new(butterworth(4, 20.0, RATE_HZ)?, 4, Edges::Scipy);
    let smooth = low_pass.filter(&errors)?;
    let edge = (0.5 * RATE_HZ) as usize;
    Ok(smooth
        .iter()
        .map(|e| rms(&e[edge..e.len() - edge]))
        .collect())
}
