//! From a gap between model and measurement to a named effect.
//!
//! The way: logs -> `track` rows at a rate that shows colour, and beside them those along a motion
//! without noise (`instruments`, `closed_loop`) -> `null` model and its noise, from what does not
//! repeat (`repeats`) or around a generic model (`generic`,
//! `likelihood`) -> `screen` every hypothesis of a [`Catalogue`] -> `stepwise` search,
//! confirmed on another motion -> `verdict` -> `proof` on data that neither fitted nor
//! confirmed. This room knows no effect by name; torque never enters a column.

mod absorbed;
mod bursts;
mod catalogue;
mod closed_loop;
mod confirm;
mod contact;
mod doubts;
mod generic;
mod instruments;
mod joined;
mod lasting;
mod likelihood;
mod linear;
pub(crate) mod noise;
mod nominal;
mod null;
mod options;
mod periods;
mod picture;
mod proof;
mod repeats;
mod rest;
mod rounding;
mod screen;
mod settled;
mod shape;
mod smooth;
mod state;
mod stepwise;
mod still;
mod summary;
mod system;
mod thin;
mod track;
mod verdict;

pub use catalogue::{Catalogue, ColumnsAlong, Entry, EntryKind, Hypothesis, Signals, TorqueColumn};
pub use nominal::{Nominal, changes};
pub use options::{DiagnoseError, Log, Options};

use crate::identify::{self, Progress};
use crate::log::Recording;
use crate::model::IdentificationModel;
use crate::observe::Filtering;
use crate::report::Diagnosis;
use crate::settings::Derivatives;
use joined::Joined;
use noise::Noise;
use null::{Null, Prior};
use repeats::own_noise;
use state::{Bench, Predictions, State};
use stepwise::Stepwise;
use summary::Asked;
use track::Track;

/// Cut-off of the prefilter, Hz, and rate of the rows, Hz, where the robot does not say.
const CUT_OFF: f64 = 50.0;
const ROWS_HZ: f64 = 50.0;

/// The prefilter stays below this share of half the sampling rate.
const BELOW_NYQUIST: f64 = 0.4;

/// Rows needed for every parameter.
const ROWS_PER_PARAMETER: usize = 3;

/// Torque predicted along a validation log at every sample, without and with what was found; one
/// series per joint, N m or N.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Of the model as it is described, refitted.
    pub before: Vec<Vec<f64>>,
    /// With the effects.
    pub after: Vec<Vec<f64>>,
}

/// Asks of a robot's logs what its model lacks: which effects of a catalogue, if any.
///
/// Parameters are fitted on `train`. Half of the only log of `validate`, or all but the last,
/// confirm what is found; the rest proves it.
///
/// # Errors
/// [`DiagnoseError`]: no logs, logs that do not fit the robot or each other, too little data.
pub fn diagnose(
    model: &dyn IdentificationModel,
    catalogue: &dyn Catalogue,
    (train, validate): (&[Log], &[Log]),
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Diagnosis, Vec<Prediction>), DiagnoseError> {
    let filtering = filtering(model, (train, validate), options)?;
    let read = Tracked::new(model, (train, validate), (filtering, options), progress)?;
    check_length(model, &read.train)?;
    let searched = searched(model, catalogue, &read, None, progress)?;
    Ok((searched.diagnosis, searched.predictions))
}

/// Logs as rows.
struct Tracked<'a> {
    /// To fit on, and of other motions.
    logs: (&'a [Log], &'a [Log]),
    train: Joined,
    other: Joined,
    /// Whether the other motion is the second half of the logs to fit on.
    kept: bool,
    filtering: Filtering,
    /// Whether curves are wanted.
    draw: bool,
}

impl<'a> Tracked<'a> {
    fn new(
        model: &dyn IdentificationModel,
        (train, validate): (&'a [Log], &'a [Log]),
        (filtering, options): (Filtering, &Options),
        progress: &dyn Progress,
    ) -> Result<Self, DiagnoseError> {
        let tracks = |logs: &[Log]| -> Result<Joined, DiagnoseError> {
            let track = |log: &Log| {
                progress.step(&format!("filtering {}", log.recording.name));
                Ok(Track::new(
                    model,
                    &log.recording,
                    &log.companion,
                    &filtering,
                )?)
            };
            let tracks: Result<Vec<Track>, DiagnoseError> = logs.iter().map(track).collect();
            Ok(Joined::new(tracks?))
        };
        Ok(Tracked {
            train: tracks(train)?,
            other: tracks(validate)?,
            logs: (train, validate),
            kept: false,
            filtering,
            draw: options.draw,
        })
    }

    /// What confirms and what proves, of rows of the other motions.
    fn parts(&self, other: &Joined) -> (Option<Joined>, Option<Joined>) {
        match self.kept {
            true => (Some(other.part(0.5..0.75)), Some(other.part(0.75..1.0))),
            false => split(&other.only(&doubts::fresh(self.logs))),
        }
    }
}

/// What a search comes to.
struct Searched {
    diagnosis: Diagnosis,
    predictions: Vec<Prediction>,
    /// Torque predicted along the rows to fit on, and along those of other motions, by joint.
    rows: (Vec<Vec<f64>>, Vec<Vec<f64>>),
    noise: Vec<Noise>,
}

/// Fits the null model, or takes the known one as it is, and searches what it lacks.
fn searched(
    model: &dyn IdentificationModel,
    catalogue: &dyn Catalogue,
    read: &Tracked<'_>,
    known: Option<&Nominal<'_>>,
    progress: &dyn Progress,
) -> Result<Searched, DiagnoseError> {
    let (joined, other) = (&read.train, &read.other);
    let (confirm, proof) = read.parts(other);
    progress.step("simulating the motion without noise");
    let prior = match known {
        Some(known) => known.prior(),
        None => Prior::of(model, model.knowledge()),
    };
    let guess = null::first_guess(model, joined, &prior);
    let instruments = instruments::beside(model, joined, &guess);
    progress.step("fitting the null model and its noise");
    let null = match known {
        Some(known) => known.null(model, (joined, &instruments)),
        None => null::null(model, (joined, &instruments), &prior),
    };
    let Null { noise, system, .. } = &null;
    let parameters = null::parameters(model, system);
    let predicted = Predictions {
        train: joined.predict(model, &parameters),
        instruments: instruments.predict(model, &parameters),
    };
    let hypotheses = predicted
        .train
        .first()
        .map(|predicted| catalogue.hypotheses(&joined.tracks[0].signals(predicted)))
        .unwrap_or_default();
    let bench = Bench {
        model,
        catalogue,
        hypotheses: &hypotheses,
        train: joined,
        instruments: &instruments,
        noise,
        null: system,
        least_gain: known.map_or(f64::NEG_INFINITY, |_| nominal::LEAST_GAIN),
        repeated: joined.tracks.iter().all(|track| own_noise(track).is_some()),
    };
    let before = State {
        system: system.clone(),
        parameters,
        effects: Vec::new(),
        predicted,
    };
    if known.is_none() {
        doubts::check(&bench, &before, other)?;
    }
    progress.step(&format!("screening {} hypotheses", hypotheses.len()));
    let beside = instruments::beside(model, other, &before.parameters);
    let confirm = confirm.zip(read.parts(&beside).0);
    let confirm = confirm.as_ref().map(|(own, beside)| (own, beside));
    let search = Stepwise::new(bench, confirm, &before);
    let mut outcome = search.run(before.clone());
    if known.is_some() {
        lasting::widen(&mut outcome.state, joined);
    }
    progress.step("proving what was found");
    let predictions = other
        .tracks
        .iter()
        .map(|track| Prediction {
            before: bench.torque(&before, track),
            after: bench.torque(&outcome.state, track),
        })
        .collect();
    let asked = Asked {
        logs: read.logs,
        // Known parameters without a change need no proof.
        kept: read.kept || known.is_some() && outcome.named.is_empty(),
        filtering: &read.filtering,
        draw: read.draw,
    };
    let diagnosis = summary::diagnosis(&bench, &null, (&before, &outcome), proof.as_ref(), &asked);
    let along = |joined: &Joined| bench.rows(&outcome.state, joined);
    Ok(Searched {
        rows: (along(joined), along(other)),
        noise: null.noise.clone(),
        diagnosis,
        predictions,
    })
}

/// The filters, as the user or the robot says, and otherwise fast.
fn filtering(
    model: &dyn IdentificationModel,
    logs: (&[Log], &[Log]),
    options: &Options,
) -> Result<Filtering, DiagnoseError> {
    let first = first(logs)?;
    let asked = asked(model, first, options);
    Ok(asked.resolve(model, std::slice::from_ref(first))?.filtering)
}

/// The first log; all others must have its rate.
fn first<'a>((train, validate): (&'a [Log], &[Log])) -> Result<&'a Recording, DiagnoseError> {
    let Some(Log {
        recording: first, ..
    }) = train.first()
    else {
        return Err(DiagnoseError::NoLogs);
    };
    let other = train
        .iter()
        .chain(validate)
        .find(|log| (log.recording.rate_hz / first.rate_hz - 1.0).abs() > 1e-3);
    match other {
        Some(Log { recording, .. }) => Err(DiagnoseError::Rates {
            log: recording.name.clone(),
            rate_hz: recording.rate_hz,
            first: first.name.clone(),
            first_hz: first.rate_hz,
        }),
        None => Ok(first),
    }
}

/// What is asked of the filters.
fn asked(
    model: &dyn IdentificationModel,
    first: &Recording,
    options: &Options,
) -> identify::Options {
    let set = model.settings();
    let fq_hz = options
        .fq_hz
        .or(set.fq_hz)
        .unwrap_or(CUT_OFF.min(0.5 * BELOW_NYQUIST * first.rate_hz));
    let nd = options
        .nd
        .unwrap_or((first.rate_hz / ROWS_HZ).round().max(1.0) as usize);
    identify::Options {
        fq_hz: Some(fq_hz),
        nd: Some(nd),
        // Velocities near rest are treated here, and otherwise.
        derivatives: Some(Derivatives::Central),
        ..identify::Options::default()
    }
}

fn check_length(model: &dyn IdentificationModel, joined: &Joined) -> Result<(), DiagnoseError> {
    let parameters = model.columns().len();
    let needs = (ROWS_PER_PARAMETER * parameters).max(100);
    let rows = joined.rows();
    if rows >= needs {
        return Ok(());
    }
    let step = joined.tracks.first().map_or(0.0, Track::step);
    let motions = joined.tracks.iter().map(|track| &track.motion);
    let all: f64 = motions.map(|m| m.len as f64 / m.rate_hz).sum();
    Err(DiagnoseError::TooShort {
        // What the filters need at the ends comes on top.
        seconds: all + (needs - rows) as f64 * step,
        rows,
        step_ms: 1e3 * step,
        needs,
        parameters,
    })
}

/// What confirms and what proves.
fn split(validate: &Joined) -> (Option<Joined>, Option<Joined>) {
    match validate.tracks.len() {
        0 => (None, None),
        1 => (Some(validate.part(0.0..0.5)), Some(validate.part(0.5..1.0))),
        count => (
            Some(validate.only(&(0..count - 1).collect::<Vec<_>>())),
            Some(validate.only(&[count - 1])),
        ),
    }
}
