//! Filtered motion: position, velocity, acceleration and torque at the full rate.

use std::ops::Range;

use super::{Filtering, ObserveError, slip};
use crate::log::{Recording, within};
use crate::model::IdentificationModel;
use crate::settings::{Derivatives, Velocity};
use crate::signal::{all_finite, derivative, extent, uncertainty};

/// A joint whose position stays within this range, rad or m, is at rest: its velocity would be
/// nothing but sensor noise, and the sign of it a coin toss.
pub(super) const REST: f64 = 1e-5;

/// Joint states along a log at its full rate, filtered without phase shift (Gautier 1996,
/// section 6.2), one series per joint.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Name of the recording.
    pub log: String,
    /// Sampling rate, Hz.
    pub rate_hz: f64,
    /// Number of samples.
    pub len: usize,
    /// Filtered positions, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations, rad/s^2 or m/s^2.
    pub qdd: Vec<Vec<f64>>,
    /// Presliding states z/zs, run along the log; empty if the robot's friction has no memory.
    pub slip: Vec<Vec<f64>>,
    /// Torques, N m or N, if the log has them.
    pub tau: Option<Vec<Vec<f64>>>,
    /// Samples that cannot be believed, ascending and disjoint; see [`Recording::doubtful`].
    pub doubtful: Vec<Range<usize>>,
    /// Joints that never move, counted from 0; they are held at their mean position.
    pub resting: Vec<usize>,
}

impl Motion {
    /// Filters and differentiates a recording, without the samples at its edges that the filters
    /// falsify and [`Filtering`] gives up: ready to be observed.
    ///
    /// # Errors
    /// Those of [`Motion::full`], and [`ObserveError::NothingLeft`].
    pub fn trimmed(
        recording: &Recording,
        model: &dyn IdentificationModel,
        filtering: &Filtering,
    ) -> Result<Self, ObserveError> {
        Motion::full(recording, model, filtering)?.cut(filtering.cut_before())
    }

    /// Filters and differentiates a recording over its whole length.
    ///
    /// # Errors
    /// [`ObserveError::Joints`], [`ObserveError::Length`], [`ObserveError::NotFinite`] if the
    /// recording does not fit the robot; [`ObserveError::NoVelocity`];
    /// [`ObserveError::Filter`] if the log is too short or the cut-off impossible.
    pub fn full(
        recording: &Recording,
        model: &dyn IdentificationModel,
        filtering: &Filtering,
    ) -> Result<Self, ObserveError> {
        check(recording, model.joints().len())?;
        let mut motion = Motion::filtered(recording, filtering)?;
        if filtering.rests() {
            let taken = taken_away(&recording.q, &motion.q);
            motion.rest_below(&taken, filtering);
        }
        motion.hold(&resting(&recording.q));
        motion.slip = slip::along(model, &motion.qd, recording.rate_hz, &[]);
        Ok(motion)
    }

    /// Filters and differentiates a checked recording, or a window of one; the presliding states,
    /// which remember what came before, are left to the caller.
    pub(super) fn filtered(
        recording: &Recording,
        filtering: &Filtering,
    ) -> Result<Self, ObserveError> {
        let rate_hz = recording.rate_hz;
        let fail = ObserveError::filter(&recording.name, "prefilter");
        let prefilter = filtering.prefilter(rate_hz).map_err(&fail)?;
        let smooth = |series: &[Vec<f64>]| prefilter.filter(series).map_err(&fail);
        let q = smooth(&recording.q)?;
        let qd = match (filtering.velocity, &recording.qd) {
            (Velocity::Derived, _) => derivatives(&q, rate_hz, filtering.derivatives),
            (Velocity::Measured, Some(qd)) => smooth(qd)?,
            (Velocity::Measured, None) => {
                return Err(ObserveError::NoVelocity {
                    log: recording.name.clone(),
                });
            }
        };
        let tau = match &recording.tau {
            Some(tau) if filtering.prefilter_torque => Some(smooth(tau)?),
            tau => tau.clone(),
        };
        let (log, len) = (recording.name.clone(), recording.len);
        let qdd = derivatives(&qd, rate_hz, filtering.derivatives);
        Ok(Motion {
            log,
            rate_hz,
            len,
            q,
            qd,
            qdd,
            slip: Vec::new(),
            tau,
            doubtful: recording.doubtful.clone(),
            resting: Vec::new(),
        })
    }

    /// The motion without its first `start` and last `end` samples.
    fn cut(self, (start, end): (usize, usize)) -> Result<Self, ObserveError> {
        let cut = start.saturating_add(end);
        if cut >= self.len {
            let (log, has) = (self.log, self.len);
            return Err(ObserveError::NothingLeft {
                log,
                cut,
                has,
                unit: "samples",
            });
        }
        let keep = start..self.len - end;
        Ok(self.only(keep))
    }

    /// The samples `keep` of the motion.
    pub(super) fn only(mut self, keep: Range<usize>) -> Self {
        self.len = keep.len();
        self.doubtful = within(&self.doubtful, &keep);
        let states = self.q.iter_mut().chain(&mut self.qd).chain(&mut self.qdd);
        let series = states.chain(&mut self.slip);
        for values in series.chain(self.tau.iter_mut().flatten()) {
            values.truncate(keep.end);
            values.drain(..keep.start);
        }
        self
    }

    /// Sets velocities to zero that are no larger than what is uncertain of them, so that the sign
    /// of a joint at rest is zero and not a coin toss: the error of the difference, and the noise
    /// of the sensor, given by the mean square `taken` that the prefilter takes away from each joint.
    /// Nothing is changed where the settings ask for plain differences or measured velocities.
    pub(super) fn rest_below(&mut self, taken: &[f64], filtering: &Filtering) {
        if !filtering.rests() {
            return;
        }
        let noise = filtering.noise_speed(self.rate_hz);
        for ((qd, q), taken) in self.qd.iter_mut().zip(&self.q).zip(taken) {
            let floor = noise * taken.sqrt();
            for (qd, doubt) in qd.iter_mut().zip(uncertainty(q, self.rate_hz)) {
                if qd.abs() <= doubt.max(floor) {
                    *qd = 0.0;
                }
            }
        }
    }

    /// Holds joints, counted from 0, at positions, rad or m.
    pub(super) fn hold(&mut self, resting: &[(usize, f64)]) {
        for &(joint, position) in resting {
            self.q[joint].fill(position);
            self.qd[joint].fill(0.0);
            self.qdd[joint].fill(0.0);
            self.resting.push(joint);
        }
    }
}

/// The joints that never move, and their mean positions.
fn resting(q: &[Vec<f64>]) -> Vec<(usize, f64)> {
    let at_rest = q.iter().enumerate().filter(|(_, series)| rests(series));
    let mean = |series: &Vec<f64>| series.iter().sum::<f64>() / series.len() as f64;
    at_rest
        .map(|(joint, series)| (joint, mean(series)))
        .collect()
}

fn derivatives(series: &[Vec<f64>], rate_hz: f64, by: Derivatives) -> Vec<Vec<f64>> {
    series
        .iter()
        .map(|signal| derivative(signal, rate_hz, by))
        .collect()
}

/// Mean square of what the prefilter takes away from each position, rad^2 or m^2.
pub(super) fn taken_away(raw: &[Vec<f64>], filtered: &[Vec<f64>]) -> Vec<f64> {
    let mean_square = |(raw, filtered): (&Vec<f64>, &Vec<f64>)| {
        let squares = raw.iter().zip(filtered).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>() / raw.len().max(1) as f64
    };
    raw.iter().zip(filtered).map(mean_square).collect()
}

/// Whether a joint with these positions, rad or m, never moves.
pub(crate) fn rests(q: &[f64]) -> bool {
    let (low, high) = extent(q);
    high - low <= REST
}

/// Checks that a recording has, for each of `joints` joints, one finite position and velocity per
/// sample, and one torque. Torque may hold anything here, since it never enters W.
///
/// # Errors
/// [`ObserveError::Joints`], [`ObserveError::Length`], [`ObserveError::NotFinite`].
pub fn check(recording: &Recording, joints: usize) -> Result<(), ObserveError> {
    let channels = [("q", Some(&recording.q)), ("qd", recording.qd.as_ref())];
    for (name, series) in channels
        .into_iter()
        .chain([("tau", recording.tau.as_ref())])
    {
        let Some(series) = series else { continue };
        if series.len() != joints {
            let (log, has) = (recording.name.clone(), series.len());
            return Err(ObserveError::Joints {
                log,
                has,
                needs: joints,
            });
        }
        for (joint, values) in series.iter().enumerate() {
            check_series(recording, name, joint + 1, values)?;
        }
    }
    Ok(())
}

/// Checks that a recording has torque, and that all of it is finite.
///
/// # Errors
/// [`ObserveError::NoTorque`], [`ObserveError::NotFinite`].
pub fn check_torque(recording: &Recording) -> Result<(), ObserveError> {
    let Some(tau) = &recording.tau else {
        return Err(ObserveError::NoTorque {
            log: recording.name.clone(),
        });
    };
    for (joint, values) in tau.iter().enumerate() {
        check_finite(recording, "tau", joint + 1, values)?;
    }
    Ok(())
}

fn check_series(
    recording: &Recording,
    series: &'static str,
    joint: usize,
    values: &[f64],
) -> Result<(), ObserveError> {
    let (has, needs) = (values.len(), recording.len);
    if has != needs {
        let log = recording.name.clone();
        return Err(ObserveError::Length {
            log,
            series,
            joint,
            has,
            needs,
        });
    }
    match series {
        "tau" => Ok(()),
        _ => check_finite(recording, series, joint, values),
    }
}

fn check_finite(
    recording: &Recording,
    series: &'static str,
    joint: usize,
    values: &[f64],
) -> Result<(), ObserveError> {
    if all_finite(values) {
        return Ok(());
    }
    match values.iter().position(|x| !x.is_finite()) {
        Some(sample) => {
            let log = recording.name.clone();
            Err(ObserveError::NotFinite {
                log,
                series,
                joint,
                sample,
            })
        }
        None => Ok(()),
    }
}
