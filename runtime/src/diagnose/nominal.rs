//! What has changed on a robot whose parameters are known: they are kept as they are, and only what
//! differs from them is looked for.

use std::ops::Range;

use super::contact::{self, Window};
use super::joined::Joined;
use super::likelihood;
use super::linear::add_scaled;
use super::null::{Null, Prior, fit, parameters, unknown_noise};
use super::system::Sparse;
use super::track::Track;
use super::{Catalogue, DiagnoseError, Log, Options, Prediction, Searched, Tracked};
use super::{asked, first, searched};
use crate::identify::{IdentifyError, Progress};
use crate::model::IdentificationModel;
use crate::observe::Filtering;
use crate::report::{Changed, Diagnosis, Estimated, Located, Verdict};
use crate::signal::central_difference;

/// Information on a parameter that is known, SI: more than any log has.
const KNOWN: f64 = 1e9;

/// Rounds of looking for contact and for everything else without it.
const ROUNDS: usize = 3;

/// Share of the torque error of some joint that a change must take away to be told: a robot that has
/// warmed up is no news.
pub(super) const LEAST_GAIN: f64 = 0.1;

/// What is left out before and after a contact, rows.
const MARGIN: usize = 4;

/// Rows of a joint that must count for it to be looked at for anything but contact, and how many of
/// them for each column that its noise is told from.
const MOVING: usize = 100;
const ROWS_PER_COLUMN: usize = 2;

/// Rows without which not even contact is looked for.
const FEWEST: usize = 40;

/// Torque error of a joint from which something is open, times that of the same model with all its
/// parameters free.
const OPEN: f64 = 1.6;

/// Share of the squared error beyond that model's which what was found must take away, if something
/// is open.
const CLOSED: f64 = 0.9;

/// The known robot.
#[derive(Clone, Copy, Debug)]
pub struct Nominal<'a> {
    /// Where its parameters come from, for the report.
    pub source: &'a str,
    /// Its np parameters, SI.
    pub values: &'a [f64],
    /// Mass of the load that is at the tool, kg, if it is known: it sets the scale of the torques.
    pub load_mass: Option<f64>,
}

impl Nominal<'_> {
    /// Prior knowledge that no log moves.
    pub(super) fn prior(&self) -> Prior {
        let np = self.values.len();
        let unit = |k: usize| (0..np).map(|i| if i == k { KNOWN } else { 0.0 }).collect();
        Prior {
            columns: (0..np).map(unit).collect(),
            right: self.values.iter().map(|value| KNOWN * value).collect(),
        }
    }

    /// The known model along logs, and its noise: what the same model with free parameters leaves
    /// of each joint, since what its structure always lacked is no change.
    pub(super) fn null(
        &self,
        model: &dyn IdentificationModel,
        (joined, instruments): (&Joined, &Joined),
    ) -> Null {
        let product = joined.product(self.values);
        let mut noise = unknown_noise(joined);
        let free = free_columns(model, instruments, self.values);
        for (joint, noise) in noise.iter_mut().enumerate() {
            let y = joined.measured(joint);
            let mut left = y.clone();
            add_scaled(&mut left, -1.0, &product[joint]);
            let weights = &joined.weights[joint];
            let found = likelihood::noise(&free[joint], &left, weights, &joined.segments);
            *noise = found.credible(&y);
        }
        let whiten = |(joint, columns): (usize, Vec<Vec<f64>>)| -> Vec<Sparse> {
            let column = |rows: Vec<f64>| joined.whiten(&[(joint, rows)], &noise);
            columns.into_iter().map(column).collect()
        };
        Null {
            generic: free.into_iter().enumerate().map(whiten).collect(),
            system: fit(model, (joined, instruments), &noise, &self.prior()),
            noise,
            repeats: Vec::new(),
        }
    }

    fn check(&self, model: &dyn IdentificationModel) -> Result<(), DiagnoseError> {
        let needs = model.columns().len();
        match self.values.len() == needs {
            true => Ok(()),
            false => Err(IdentifyError::Parameters {
                robot: model.name().to_owned(),
                has: self.values.len(),
                needs,
            }
            .into()),
        }
    }
}

/// The columns of each joint with its own parameters all free, with what turns round at reversals
/// and what a shift in time does.
fn free_columns(
    model: &dyn IdentificationModel,
    joined: &Joined,
    parameters: &[f64],
) -> Vec<Vec<Vec<f64>>> {
    let mut all: Vec<Vec<Vec<f64>>> = vec![Vec::new(); joined.joints()];
    let base = (0..model.columns().len()).flat_map(|k| joined.base(k));
    base.for_each(|(joint, rows)| all[joint].push(rows));
    let rates = |track: &Track| {
        let predicted = track.predict(model, parameters).model;
        let rate = |torque: &Vec<f64>| central_difference(torque, track.motion.rate_hz);
        track.decimate(&predicted.iter().map(rate).collect::<Vec<_>>())
    };
    let rates: Vec<_> = joined.tracks.iter().map(rates).collect();
    for (joint, pulses) in joined.reversals().into_iter().enumerate() {
        let rate = rates.iter().flat_map(|rates| rates[joint].iter().copied());
        all[joint].extend([pulses, rate.collect()]);
    }
    all
}

/// Asks of logs what has changed on a robot whose parameters are known: which effects of a
/// catalogue, with the parameters kept as they are, and when something touched it.
///
/// # Errors
/// [`IdentifyError::Parameters`] for another number of parameters than the robot has; those of
/// [`super::diagnose`].
pub fn changes(
    model: &dyn IdentificationModel,
    catalogue: &dyn Catalogue,
    nominal: &Nominal<'_>,
    (train, validate): (&[Log], &[Log]),
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Diagnosis, Vec<Prediction>), DiagnoseError> {
    nominal.check(model)?;
    let filtering = filtering(model, (train, validate), options)?;
    let whole = Tracked::new(model, (train, validate), (filtering, options), progress)?;
    check_length(&whole)?;
    let whole = keeping(whole);
    let looks = [
        contact::Look::new(model, &whole.train, nominal.values),
        contact::Look::new(model, &whole.other, nominal.values),
    ];
    let find =
        |train: &[Vec<f64>], other: &[Vec<f64>]| [looks[0].windows(train), looks[1].windows(other)];
    let mut windows = [Vec::new(), Vec::new()];
    let mut round = 1;
    let searched = loop {
        progress.step("searching what changed");
        let read = whole.without(&windows);
        let searched = searched(model, catalogue, &read, Some(nominal), progress)?;
        let again = find(&searched.rows.0, &searched.rows.1);
        let same = places(&again) == places(&windows);
        windows = again;
        if same || round == ROUNDS {
            break searched;
        }
        round += 1;
    };
    let read = whole.without(&windows);
    let located = open(model, nominal, &read.train, &searched);
    let Searched {
        mut diagnosis,
        predictions,
        ..
    } = searched;
    let pairs = looks.iter().zip(&windows);
    let pairs = pairs.take(if whole.kept { 1 } else { 2 });
    let contacts = pairs.flat_map(|(look, windows)| look.contacts(windows));
    let known: Vec<(&str, f64)> = model
        .columns()
        .iter()
        .map(|c| c.name.as_ref())
        .zip(nominal.values.iter().copied())
        .collect();
    let changed = Changed::new(
        nominal.source,
        &known,
        &diagnosis.effects,
        contacts.collect(),
    );
    diagnosis.verdict = match (located.is_empty(), changed.is_empty()) {
        (false, _) => Verdict::Unknown,
        (true, true) => Verdict::Nothing,
        (true, false) => Verdict::Named,
    };
    diagnosis.located = located;
    for (parameter, &value) in diagnosis.parameters.iter_mut().zip(nominal.values) {
        let known = Estimated { value, sigma: None };
        (parameter.before, parameter.after) = (known, known);
    }
    diagnosis.changed = Some(changed);
    if let Some(mass) = nominal.load_mass {
        scale(&mut diagnosis, mass);
    }
    Ok((diagnosis, predictions))
}

/// The scale of the torques, if there is a load of known mass.
fn scale(diagnosis: &mut Diagnosis, mass: f64) {
    let Some(changed) = &mut diagnosis.changed else {
        return;
    };
    changed.torque_scale = changed.payload.as_ref().map(|load| load.scale(mass));
    if changed.torque_scale.is_none() {
        diagnosis.warnings.push(format!(
            "no load was found at the tool, so its mass of {mass} kg says nothing about the scale \
             of the torques"
        ));
    }
}

/// The joints whose torque error is still far above that of the same model with all parameters
/// free, and nine tenths of it not closed.
fn open(
    model: &dyn IdentificationModel,
    nominal: &Nominal<'_>,
    train: &Joined,
    searched: &Searched,
) -> Vec<Located> {
    let system = fit(model, (train, train), &searched.noise, &Prior::default());
    let free = train.product(&parameters(model, &system));
    let before = train.product(nominal.values);
    let errors = |joint: usize| {
        let rows = [&before, &searched.rows.0, &free];
        let [before, after, free] = rows.map(|rows| train.square_error(joint, rows));
        // What so many free parameters take away by chance.
        let counted = train.weights[joint].iter().filter(|w| **w > 0.0).count() as f64;
        let left = 1.0 - system.leverage(joint) / counted.max(1.0);
        [before, after, free / left.max(0.1)]
    };
    let is_open = |&joint: &usize| {
        let [before, after, free] = errors(joint);
        after > OPEN * OPEN * free && after - free > (1.0 - CLOSED) * (before - free)
    };
    let located = |joint: usize| {
        let name = model.joints()[joint].name.to_string();
        let [_, after, free] = errors(joint);
        let mut known = searched.diagnosis.located.iter();
        let known = known.find(|located| located.joint == name);
        Located {
            unexplained_pct: 100.0 * (1.0 - free / after),
            varies_with: known.map(|l| l.varies_with.clone()).unwrap_or_default(),
            joint: name,
        }
    };
    (0..train.joints()).filter(is_open).map(located).collect()
}

fn check_length(whole: &Tracked<'_>) -> Result<(), DiagnoseError> {
    let rows = whole.train.rows();
    match rows >= FEWEST {
        true => Ok(()),
        false => Err(DiagnoseError::Short {
            rows,
            step_ms: 1e3 * whole.train.tracks.first().map_or(0.0, Track::step),
            needs: FEWEST,
        }),
    }
}

/// The filters, as the user or the robot says: what was known before was found with them. Nothing
/// needs to move.
fn filtering(
    model: &dyn IdentificationModel,
    logs: (&[Log], &[Log]),
    options: &Options,
) -> Result<Filtering, DiagnoseError> {
    let first = first(logs)?;
    let nd = options.nd.or(model.settings().nd);
    let options = Options {
        nd,
        ..options.clone()
    };
    let asked = asked(model, first, &options);
    let plan = asked.resolve_at_rest(model, std::slice::from_ref(first))?;
    Ok(plan.filtering)
}

/// Without logs of other motions, the second half of the only ones confirms and proves.
fn keeping(mut whole: Tracked<'_>) -> Tracked<'_> {
    if whole.train.rows() >= 4 * MOVING && whole.logs.1.is_empty() {
        whole.other = whole.train.clone();
        whole.kept = true;
    }
    whole
}

/// Where contacts are.
fn places(windows: &[Vec<Window>; 2]) -> Vec<Range<usize>> {
    let all = windows.iter().flatten();
    all.map(|window| window.rows.clone()).collect()
}

impl Tracked<'_> {
    /// The same logs, counting no rows with contact and none of joints that hardly move.
    fn without(&self, [train, other]: &[Vec<Window>; 2]) -> Tracked<'_> {
        let part = match self.kept {
            true => self.train.part(0.0..0.5),
            false => self.train.clone(),
        };
        Tracked {
            logs: self.logs,
            train: counting(part, train),
            other: counting(self.other.clone(), other),
            kept: self.kept,
            filtering: self.filtering.clone(),
            draw: self.draw,
        }
    }
}

fn counting(mut joined: Joined, windows: &[Window]) -> Joined {
    let columns = joined.tracks.first().map_or(0, |t| {
        t.equations
            .iter()
            .map(|e| e.columns.len())
            .max()
            .unwrap_or(0)
    });
    let rows = joined.rows();
    let moving = contact::moving(&joined);
    for (weights, moving) in joined.weights.iter_mut().zip(moving) {
        for window in windows {
            let from = window.rows.start.saturating_sub(MARGIN);
            weights[from..(window.rows.end + MARGIN).min(rows)].fill(0.0);
        }
        let counts = weights.iter().zip(moving);
        let counts = counts.filter(|(weight, moving)| **weight >= 1.0 && *moving);
        if counts.count() < MOVING.max(ROWS_PER_COLUMN * columns) {
            weights.fill(0.0);
        }
    }
    joined
}
