//! A log on its way to equations, without ever being in memory as a whole.

use std::ops::Range;

use rayon::prelude::*;

use super::equations::{rows_kept, touched};
use super::motion::{Motion, REST, taken_away};
use super::{Filtering, ObserveError, check, check_torque, slip};
use crate::log::Samples;
use crate::model::IdentificationModel;
use crate::signal::{Decimator, REACH, ZeroPhase, extent};

/// Samples that are looked at together.
pub(super) const WINDOW: usize = 8192;

/// A log and the filters that run along it: its motion in windows, and where its decimated rows
/// lie. Equal to [`Motion::trimmed`] of the whole log, to rounding.
pub(crate) struct Course<'a> {
    source: &'a dyn Samples,
    model: &'a dyn IdentificationModel,
    filtering: &'a Filtering,
    prefilter: ZeroPhase,
    pub decimator: Decimator,
    /// Joints that never move, counted from 0, and the positions they are held at.
    resting: Vec<(usize, f64)>,
    /// Mean square of what the prefilter takes away from each joint's position.
    taken: Vec<f64>,
    /// Presliding states at every [`WINDOW`]-th sample, joint by joint; empty without a memory.
    slips: Vec<Vec<f64>>,
    /// The samples between those cut off before the parallel filter.
    within: Range<usize>,
    /// The first sample that decimation keeps, counted in the whole log.
    first: usize,
    /// Number of decimated rows.
    rows: usize,
}

impl<'a> Course<'a> {
    /// Finds the joints that rest. Samples are checked where they are filtered.
    ///
    /// # Errors
    /// Those of [`Motion::trimmed`]; [`ObserveError::Unreadable`].
    pub fn new(
        source: &'a dyn Samples,
        model: &'a dyn IdentificationModel,
        filtering: &'a Filtering,
    ) -> Result<Self, ObserveError> {
        let (rate_hz, has) = (source.rate_hz(), source.len());
        let fail = ObserveError::filter(source.name(), "prefilter");
        let prefilter = filtering.prefilter(rate_hz).map_err(&fail)?;
        let fail = ObserveError::filter(source.name(), "parallel filter");
        let decimator = filtering.decimator(rate_hz).map_err(&fail)?;
        let (start, end) = filtering.cut_before();
        let cut = start.saturating_add(end);
        if cut >= has {
            return Err(ObserveError::NothingLeft {
                log: source.name().to_owned(),
                cut,
                has,
                unit: "samples",
            });
        }
        let within = start..has - end;
        let kept = decimator.kept(within.len());
        let mut course = Course {
            source,
            model,
            filtering,
            prefilter,
            decimator,
            resting: resting(source, model.joints().len())?,
            taken: Vec::new(),
            slips: Vec::new(),
            first: within.start + kept.first().copied().unwrap_or(0),
            rows: kept.len(),
            within,
        };
        course.taken = course.taken()?;
        course.slips = course.slips()?;
        Ok(course)
    }

    /// Number of decimated rows, those at the edges included.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Name of the log.
    pub fn name(&self) -> &str {
        self.source.name()
    }

    /// Sampling rate, Hz.
    pub fn rate_hz(&self) -> f64 {
        self.source.rate_hz()
    }

    /// Joints that never move, counted from 0.
    pub fn resting(&self) -> Vec<usize> {
        self.resting.iter().map(|(joint, _)| *joint).collect()
    }

    /// The sample that a row stands at, counted in the whole log.
    pub fn sample(&self, row: usize) -> usize {
        self.first + row * self.decimator.ratio()
    }

    /// Where the edges of the log reach: this many rows at either end.
    pub fn edge(&self) -> usize {
        self.decimator.look_ahead()
    }

    /// The samples that all rows are made of.
    pub fn samples(&self) -> Range<usize> {
        self.within.clone()
    }

    /// The motion at some samples, counted in the whole log.
    ///
    /// # Errors
    /// Those of [`check`] and [`check_torque`]; [`ObserveError::Unreadable`];
    /// [`ObserveError::NoVelocity`]; [`ObserveError::Filter`].
    pub fn motion(&self, range: Range<usize>) -> Result<Motion, ObserveError> {
        if self.slips.is_empty() {
            return self.filtered(range);
        }
        let known = (range.start / WINDOW).min(self.slips.len() - 1);
        let from = known * WINDOW;
        let mut motion = self.filtered(from..range.end)?;
        let begin = &self.slips[known];
        motion.slip = slip::along(self.model, &motion.qd, motion.rate_hz, begin);
        let keep = range.start - from..motion.len;
        Ok(motion.only(keep))
    }

    /// Mean square of what the prefilter takes away, in some windows from end to end; nothing where
    /// nobody asks.
    fn taken(&self) -> Result<Vec<f64>, ObserveError> {
        const WINDOWS: usize = 8;
        if !self.filtering.rests() {
            return Ok(Vec::new());
        }
        let last = self.source.len().saturating_sub(WINDOW);
        let windows = (0..WINDOWS).into_par_iter().map(|k| {
            let start = k * last / (WINDOWS - 1);
            let recording = window(self.source, start..start + WINDOW)?;
            let motion = Motion::filtered(&recording, self.filtering)?;
            Ok(taken_away(&recording.q, &motion.q))
        });
        let windows: Vec<Vec<f64>> = windows.collect::<Result<_, ObserveError>>()?;
        let mut mean = vec![0.0; self.model.joints().len()];
        for taken in windows {
            mean.iter_mut()
                .zip(taken)
                .for_each(|(mean, taken)| *mean += taken / WINDOWS as f64);
        }
        Ok(mean)
    }

    /// The presliding states at the first sample and at every [`WINDOW`]-th after it.
    fn slips(&self) -> Result<Vec<Vec<f64>>, ObserveError> {
        if self.model.presliding().is_empty() {
            return Ok(Vec::new());
        }
        let mut states = vec![vec![0.0; self.model.joints().len()]];
        for start in (0..self.source.len().saturating_sub(WINDOW)).step_by(WINDOW) {
            let motion = self.filtered(start..start + WINDOW + 1)?;
            let begin = states.last().map_or(&[][..], Vec::as_slice);
            let along = slip::along(self.model, &motion.qd, motion.rate_hz, begin);
            let last = |joint: &Vec<f64>| joint.last().copied().unwrap_or(0.0);
            states.push(along.iter().map(last).collect());
        }
        Ok(states)
    }

    /// A motion that contains some samples, and where in it they begin.
    ///
    /// # Errors
    /// Those of [`Self::motion`].
    pub fn around(&self, range: Range<usize>) -> Result<(Motion, usize), ObserveError> {
        match self.slips.is_empty() {
            true => self.filtered_around(&range),
            false => Ok((self.motion(range)?, 0)),
        }
    }

    /// The motion at some samples, but for presliding states.
    fn filtered(&self, range: Range<usize>) -> Result<Motion, ObserveError> {
        let (motion, start) = self.filtered_around(&range)?;
        let end = range.end.min(self.source.len());
        Ok(motion.only(start..start + end.saturating_sub(range.start)))
    }

    /// The same with its surroundings, and where in it the samples begin.
    fn filtered_around(&self, range: &Range<usize>) -> Result<(Motion, usize), ObserveError> {
        // Two differences look further than the prefilter.
        let reach = self.prefilter.memory() + self.prefilter.extension() + 2 * REACH;
        let start = range.start.saturating_sub(reach);
        let end = range.end.saturating_add(reach).min(self.source.len());
        let recording = window(self.source, start..end)?;
        check(&recording, self.model.joints().len())?;
        check_torque(&recording)?;
        let mut motion = Motion::filtered(&recording, self.filtering)?;
        motion.rest_below(&self.taken, self.filtering);
        motion.hold(&self.resting);
        Ok((motion, range.start - start))
    }

    /// The rows that become equations, as ascending disjoint ranges: away from what is cut off
    /// after the parallel filter and from samples that cannot be believed.
    ///
    /// # Errors
    /// [`ObserveError::NothingLeft`], [`ObserveError::NothingBelieved`].
    pub fn believed(&self) -> Result<Vec<Range<usize>>, ObserveError> {
        let kept = rows_kept(self.name(), self.rows, self.filtering.cut_after())?;
        let doubtful = crate::log::within(self.source.doubtful(), &self.within);
        let touched = touched(&doubtful, self.filtering, self.source.rate_hz());
        let ratio = self.decimator.ratio();
        let offset = self.first - self.within.start;
        let row = |sample: usize| sample.saturating_sub(offset).div_ceil(ratio);
        let (mut believed, mut at) = (Vec::new(), kept.start);
        for lost in touched.iter().map(|r| row(r.start)..row(r.end)) {
            believed.push(at..lost.start.min(kept.end));
            at = at.max(lost.end);
        }
        believed.push(at..kept.end);
        believed.retain(|rows| rows.start < rows.end);
        match believed.is_empty() {
            true => Err(ObserveError::NothingBelieved {
                log: self.name().to_owned(),
            }),
            false => Ok(believed),
        }
    }
}

/// A window of a log.
fn window(
    source: &dyn Samples,
    range: Range<usize>,
) -> Result<crate::log::Recording, ObserveError> {
    source
        .window(range)
        .map_err(|error| ObserveError::Unreadable {
            log: source.name().to_owned(),
            message: error.to_string(),
        })
}

/// What a look through a log finds of a joint.
#[derive(Clone, Copy)]
struct Extent {
    low: f64,
    high: f64,
    /// Sum of its positions, if it rests.
    sum: f64,
}

impl Extent {
    fn of(q: &[f64]) -> Extent {
        let (low, high) = extent(q);
        let sum = match high - low <= REST {
            true => q.iter().sum(),
            false => 0.0,
        };
        Extent { low, high, sum }
    }
}

/// The joints that never move, and their mean positions.
fn resting(source: &dyn Samples, joints: usize) -> Result<Vec<(usize, f64)>, ObserveError> {
    let len = source.len();
    check(&window(source, 0..1)?, joints)?;
    if let Some(ranges) = source.ranges()
        && ranges.iter().all(|(low, high)| high - low > REST)
    {
        return Ok(Vec::new());
    }
    let starts: Vec<usize> = (0..len).step_by(WINDOW).collect();
    let parts = starts.into_par_iter().map(|start| {
        let recording = window(source, start..(start + WINDOW).min(len))?;
        Ok(recording.q.iter().map(|q| Extent::of(q)).collect())
    });
    let parts: Vec<Vec<Extent>> = parts.collect::<Result<_, ObserveError>>()?;
    let of_joint = |joint: usize| {
        let each = parts.iter().map(|part| part[joint]);
        each.reduce(|a, b| Extent {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
            sum: a.sum + b.sum,
        })
    };
    let extents = (0..joints).filter_map(|joint| Some((joint, of_joint(joint)?)));
    let at_rest = extents.filter(|(_, extent)| extent.high - extent.low <= REST);
    Ok(at_rest
        .map(|(joint, extent)| (joint, extent.sum / len as f64))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::tests::hand_written::scara;
    use crate::identify::tests::synthetic::{motion, options};
    use crate::model::{Column, Joint, Output, Pattern, Presliding, States};
    use crate::settings::Settings;

    /// A robot whose second joint does not slide at once.
    struct Sticky<T>(T);

    impl<T: IdentificationModel> IdentificationModel for Sticky<T> {
        fn name(&self) -> &str {
            self.0.name()
        }
        fn joints(&self) -> &[Joint] {
            self.0.joints()
        }
        fn columns(&self) -> &[Column] {
            self.0.columns()
        }
        fn pattern(&self, output: Output) -> &Pattern {
            self.0.pattern(output)
        }
        fn settings(&self) -> &Settings {
            self.0.settings()
        }
        fn presliding(&self) -> &[Presliding] {
            &[Presliding { joint: 1, zs: 0.05 }]
        }
        fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
            self.0.evaluate(output, states, signals);
        }
    }

    #[test]
    fn friction_remembers_across_windows() {
        let model = Sticky(scara());
        let mut log = motion("long", 0.0, 3 * WINDOW + 500);
        log.tau = Some(log.q.clone());
        let plan = options()
            .resolve(&model, std::slice::from_ref(&log))
            .unwrap();
        let whole = Motion::full(&log, &model, &plan.filtering).unwrap();
        let course = Course::new(&log, &model, &plan.filtering).unwrap();
        assert!(whole.slip[0].iter().all(|slip| *slip == 0.0));
        let reached = |limit: f64| {
            whole.slip[1]
                .iter()
                .any(|slip| slip * limit.signum() > limit.abs())
        };
        assert!(reached(0.9) && reached(-0.9));
        for range in [0..10, 100..9000, WINDOW..WINDOW + 5, 20_000..log.len] {
            let part = course.motion(range.clone()).unwrap();
            assert_eq!(part.len, range.len());
            for (a, b) in part.slip[1].iter().zip(&whole.slip[1][range.clone()]) {
                assert!((a - b).abs() < 1e-9, "{range:?}: {a} {b}");
            }
        }
    }
}
