//! What the truth would do: the described robot, with and without the structure that is hidden in
//! the individual, fitted to its log.

use idim::runtime::log::Recording;
use idim::runtime::model::{ColumnKind, IdentificationModel, Output, States};
use idim::runtime::observe::{Equations, Filtering, ModelKind, Motion, observe};
use idim::runtime::settings::{Derivatives, Edges, Velocity};
use idim::runtime::signal::{Decimator, ZeroPhase, butterworth};

use super::hidden::{Effect, Hidden};
use super::logs::Simulated;
use super::machine::{Failure, Machine};
use super::motion::RATE_HZ;

/// Order of the residuals' autoregression.
const ORDER: usize = 4;

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
    noise: Vec<(Vec<f64>, f64)>,
}

/// The described robot with some structure.
pub struct Oracle<'a> {
    machine: &'a Machine,
    effects: &'a [Effect],
}

/// Equations of a joint, with the columns beyond the model's at the end.
struct Joint {
    columns: Vec<(usize, Vec<f64>)>,
    y: Vec<f64>,
    /// Rows at which the joint may stand still: what friction does there, no log tells.
    rests: Vec<bool>,
}

impl<'a> Oracle<'a> {
    /// `machine` is the described robot with the structure of `effects`.
    pub fn new(machine: &'a Machine, effects: &'a [Effect]) -> Oracle<'a> {
        Oracle { machine, effects }
    }

    /// Fits the parameters, twice: with plain rows, then with those whitened by what is left.
    pub fn fit(&self, log: &Simulated) -> Result<Fit, Failure> {
        let joints = self.equations(log)?;
        let white: Vec<(Vec<f64>, f64)> = joints
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
    pub fn left(&self, log: &Simulated, noise: &[(Vec<f64>, f64)]) -> Result<f64, Failure> {
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
            command(&effect.hidden, &mut tau);
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
            undo(&effect.hidden, &mut seen, &mut delivered);
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

    /// Columns that the model has not: joint of the model and torque, along a motion that begins at
    /// a time of the log, s.
    fn extra(&self, motion: &Motion, begin: f64) -> Vec<Vec<(usize, Vec<f64>)>> {
        let mut columns = Vec::new();
        for effect in self.effects {
            match effect.hidden {
                Hidden::Drift { joint, time, .. } => {
                    let at = self.machine.driven[joint];
                    let warm = |k: usize| -(-(begin + k as f64 / RATE_HZ) / time).exp_m1();
                    let qd = &motion.qd[at];
                    columns.push(vec![(
                        at,
                        (0..qd.len()).map(|k| warm(k) * sign(qd[k])).collect(),
                    )]);
                    columns.push(vec![(at, (0..qd.len()).map(|k| warm(k) * qd[k]).collect())]);
                }
                Hidden::Load { joint, .. } => {
                    let at = self.machine.driven[joint];
                    let load = product(&self.machine.model, &self.rigid_values(), motion);
                    let pairs = load[at].iter().zip(&motion.qd[at]);
                    columns.push(vec![(
                        at,
                        pairs.map(|(load, qd)| load.abs() * sign(*qd)).collect(),
                    )]);
                }
                _ => {}
            }
        }
        for (model, values, window) in &self.machine.forces {
            let still = Motion {
                qd: motion.qd.iter().map(|qd| vec![0.0; qd.len()]).collect(),
                qdd: motion.qd.iter().map(|qd| vec![0.0; qd.len()]).collect(),
                ..motion.clone()
            };
            let within = |k: usize| {
                let t = begin + k as f64 / RATE_HZ;
                window.as_ref().is_none_or(|window| window.contains(&t))
            };
            let mut torque = product(model, values, &still);
            for series in &mut torque {
                let outside = series.iter_mut().enumerate().filter(|(k, _)| !within(*k));
                outside.for_each(|(_, torque)| *torque = 0.0);
            }
            columns.push(torque.into_iter().enumerate().collect());
        }
        columns
    }

    /// The described rigid bodies and rotors alone.
    fn rigid_values(&self) -> Vec<f64> {
        let columns = self
            .machine
            .model
            .columns()
            .iter()
            .zip(&self.machine.values);
        columns
            .map(|(column, value)| match column.kind {
                ColumnKind::Inertial | ColumnKind::Drive => *value,
                ColumnKind::Friction | ColumnKind::Effect => 0.0,
            })
            .collect()
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
    fn solve(&self, joints: &[Joint], noise: &[(Vec<f64>, f64)]) -> Vec<f64> {
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

/// Turns what drives deliver into what is logged.
fn command(hidden: &Hidden, tau: &mut [Vec<f64>]) {
    match *hidden {
        Hidden::Late { by } => {
            for series in tau {
                *series = super::logs::late(series, by * RATE_HZ);
            }
        }
        Hidden::Drive { joint, drive } => {
            let rate = idim::runtime::signal::central_difference(&tau[joint], RATE_HZ);
            for (tau, rate) in tau[joint].iter_mut().zip(rate) {
                let needed = *tau + drive.lag * rate;
                let size = match drive.saturation {
                    Some((level, share)) if needed.abs() > level => {
                        level + (needed.abs() - level) / share
                    }
                    _ => needed.abs(),
                };
                let width = 0.02 * drive.dead_zone.max(f64::MIN_POSITIVE);
                let lost = drive.dead_zone * (needed / width).tanh().abs();
                *tau = (size + lost).copysign(needed) / drive.gain;
            }
        }
        _ => {}
    }
}

/// Turns what is logged into what happened.
fn undo(hidden: &Hidden, q: &mut [Vec<f64>], tau: &mut [Vec<f64>]) {
    match *hidden {
        Hidden::Late { by } => {
            for series in tau {
                *series = super::logs::late(series, -by * RATE_HZ);
            }
        }
        Hidden::Drive { joint, drive } => {
            let keep = match drive.lag > 0.0 {
                true => (-1.0 / (drive.lag * RATE_HZ)).exp(),
                false => 0.0,
            };
            let mut now = tau[joint]
                .first()
                .map_or(0.0, |first| drive.delivers(*first));
            for value in &mut tau[joint] {
                let before = now;
                now = drive.delivers(*value) + keep * (now - drive.delivers(*value));
                // The state at a sample is where the command before it has led.
                *value = if drive.lag > 0.0 { before } else { now };
            }
        }
        Hidden::Eccentric {
            joint,
            wave: (times, sine, cosine),
        } => {
            for q in &mut q[joint] {
                let (sin, cos) = (times * *q).sin_cos();
                *q -= sine * sin + cosine * cos;
            }
        }
        _ => {}
    }
}

/// D X along a motion.
fn product(model: &dyn IdentificationModel, x: &[f64], motion: &Motion) -> Vec<Vec<f64>> {
    const BLOCK: usize = 512;
    let pattern = model.pattern(Output::Explicit);
    let mut tau = vec![vec![0.0; motion.len]; model.joints().len()];
    let mut signals = Vec::new();
    for start in (0..motion.len).step_by(BLOCK) {
        let end = motion.len.min(start + BLOCK);
        let part = |series: &[Vec<f64>]| -> Vec<f64> {
            series
                .iter()
                .flat_map(|s| &s[start..end])
                .copied()
                .collect()
        };
        let [q, qd, qdd, slip] =
            [&motion.q, &motion.qd, &motion.qdd, &motion.slip].map(|s| part(s));
        let len = end - start;
        signals.resize(pattern.signals * len, 0.0);
        let states = States {
            len,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            slip: &slip,
        };
        model.evaluate(Output::Explicit, &states, &mut signals);
        for entry in pattern.entries.iter() {
            let signal = &signals[entry.signal * len..][..len];
            let sums = tau[entry.row][start..end].iter_mut().zip(signal);
            sums.for_each(|(sum, value)| *sum += x[entry.column] * value);
        }
    }
    tau
}

fn residual(joint: &Joint, x: &[f64]) -> Vec<f64> {
    let mut left = joint.y.clone();
    for (k, rows) in &joint.columns {
        left.iter_mut()
            .zip(rows)
            .for_each(|(left, w)| *left -= x[*k] * w);
    }
    left
}

impl Joint {
    /// Innovations that count.
    fn whiten(&self, series: &[f64], noise: &(Vec<f64>, f64)) -> Vec<f64> {
        let mut white = whiten(series, noise);
        white
            .iter_mut()
            .zip(&self.rests)
            .filter(|(_, rests)| **rests)
            .for_each(|(w, _)| *w = 0.0);
        white
    }
}

/// Rows within the reach of the filters of a reversal, or of a velocity that is not certain.
fn rests(qd: &[f64], kept: &[usize]) -> Vec<bool> {
    const REACH: usize = 40;
    let still = |k: usize| k > 0 && (qd[k] == 0.0 || qd[k] * qd[k - 1] < 0.0);
    let mut rests = vec![false; kept.len()];
    for k in (0..qd.len()).filter(|&k| still(k)) {
        let from = kept.partition_point(|&at| at + REACH < k);
        let to = kept.partition_point(|&at| at <= k + REACH);
        rests[from..to].fill(true);
    }
    rests
}

/// Least-squares autoregression of what counts.
fn autoregression(series: &[f64], rests: &[bool]) -> (Vec<f64>, f64) {
    let counted: Vec<f64> = series
        .iter()
        .zip(rests)
        .map(|(value, rests)| if *rests { 0.0 } else { *value })
        .collect();
    let lag = |k: usize| &counted[ORDER - k..series.len() - k];
    let mut normal = vec![0.0; ORDER * ORDER];
    let mut right = vec![0.0; ORDER];
    for a in 0..ORDER {
        right[a] = dot(lag(a + 1), lag(0));
        for b in 0..ORDER {
            normal[a * ORDER + b] = dot(lag(a + 1), lag(b + 1));
        }
    }
    let factors = cholesky(normal, right);
    let mut left = whiten(series, &(factors.clone(), 1.0));
    let mut k = 0;
    left.retain(|_| {
        k += 1;
        k > ORDER && !rests[k - 1]
    });
    (factors, rms(&left).max(f64::MIN_POSITIVE))
}

/// Innovations in units of their standard deviation; the first rows, which have no past, are zero.
fn whiten(series: &[f64], (factors, sigma): &(Vec<f64>, f64)) -> Vec<f64> {
    let order = factors.len();
    let mut white = vec![0.0; series.len()];
    for k in order..series.len() {
        let past = factors.iter().enumerate();
        let expected: f64 = past
            .map(|(back, factor)| factor * series[k - 1 - back])
            .sum();
        white[k] = (series[k] - expected) / sigma;
    }
    white
}

/// Solves symmetric equations; a parameter that nothing determines is zero.
fn cholesky(mut a: Vec<f64>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    let scale: Vec<f64> = (0..n).map(|i| a[i * n + i].max(0.0).sqrt()).collect();
    let factor = |i: usize| if scale[i] > 0.0 { 1.0 / scale[i] } else { 0.0 };
    for i in 0..n {
        b[i] *= factor(i);
        (0..n).for_each(|j| a[i * n + j] *= factor(i) * factor(j));
        a[i * n + i] += 1e-11;
    }
    for j in 0..n {
        let square: f64 = (0..j).map(|k| a[j * n + k] * a[j * n + k]).sum();
        let root = (a[j * n + j] - square).max(1e-13).sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let product: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            a[i * n + j] = (a[i * n + j] - product) / root;
        }
    }
    for i in 0..n {
        let known: f64 = (0..i).map(|k| a[i * n + k] * b[k]).sum();
        b[i] = (b[i] - known) / a[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[k * n + i] * b[k]).sum();
        b[i] = (b[i] - known) / a[i * n + i];
    }
    (0..n).map(|i| b[i] * factor(i)).collect()
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn rms(series: &[f64]) -> f64 {
    (dot(series, series) / series.len().max(1) as f64).sqrt()
}
