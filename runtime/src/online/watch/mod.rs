//! The watchdog: does the running robot leave its stored model, which joint, and since when?
//!
//! For each equation (joint) the residuals under the stored parameters are first listened to, to
//! learn their colour as an autoregression; then their rows `[w | e]`, whitened by it, are folded
//! into a reference and into blocks, whose differences among each other say how much a healthy
//! robot varies. From then on the newest blocks, one, two, three ... together, are compared with the
//! reference: whether they have the same parameters (Chow 1960) and residuals of the same size. The
//! number of blocks that differs most clearly says since when (the generalised likelihood ratio of
//! Willsky and Jones, IEEE Trans. Automatic Control 21, 1976). Nothing is compared sample by sample,
//! so coloured noise raises no alarm, and a model that never fitted exactly does not either, as
//! long as it goes on to fit as it did.

mod change;
mod colour;
mod options;
mod spread;
mod watched;

pub use options::WatchOptions;

use super::{Instant, OnlineError, Stream};
use crate::model::IdentificationModel;
use watched::Watched;

/// In what the robot deviates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// Other parameters describe it now: payload, friction, a drive's gain.
    Parameters,
    /// No parameters describe it as well as before: a contact, play, noise.
    Residuals,
}

/// An equation that has left its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alarm {
    /// In what.
    pub deviation: Deviation,
    /// How far, in standard deviations.
    pub sigma: f64,
    /// Since which sample of the stream, to a block.
    pub since: u64,
    /// The sample at which it was noticed.
    pub noticed: u64,
}

/// What is known of one equation. Standard deviations: 0 means as expected, larger ones are
/// exceeded by chance as rarely as by a standard normal number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Health {
    /// Whether learning has ended; before, nothing is compared.
    pub learned: bool,
    /// How far the parameters in the reference lay from the stored ones, standard deviations, the
    /// stored ones taken as exact.
    pub from_stored: f64,
    /// How far the parameters of the last blocks lie from those of the reference.
    pub parameters: f64,
    /// How much larger than those of the reference the residuals of the last blocks are.
    pub residuals: f64,
    /// The first alarm since the last [`Watchdog::acknowledge`].
    pub alarm: Option<Alarm>,
    /// The clearest deviation now: in what, standard deviations, since which sample.
    largest: Option<(Deviation, f64, u64)>,
}

/// Watches the equations of a stream.
#[derive(Clone, Debug)]
pub struct Watchdog {
    sigma: f64,
    nd: u64,
    now: u64,
    watched: Vec<Watched>,
    health: Vec<Health>,
}

impl Watchdog {
    /// A watchdog over the stored np `parameters` of the stream's robot.
    ///
    /// # Errors
    /// [`OnlineError::Parameters`], [`OnlineError::NotFinite`], [`OnlineError::Block`],
    /// [`OnlineError::Blocks`], [`OnlineError::Level`].
    pub fn new<M: IdentificationModel>(
        stream: &Stream<M>,
        parameters: &[f64],
        options: &WatchOptions,
    ) -> Result<Watchdog, OnlineError> {
        let columns = stream.model().columns();
        let (has, needs) = (parameters.len(), columns.len());
        if has != needs {
            return Err(OnlineError::Parameters { has, needs });
        }
        if let Some(k) = parameters.iter().position(|x| !x.is_finite()) {
            let name = columns[k].name.to_string();
            return Err(OnlineError::NotFinite { name });
        }
        let equations = stream.equations();
        let per_second = stream.options().rate_hz / stream.options().nd as f64;
        let widest = equations.iter().map(|e| e.columns.len()).max();
        let rows = options.rows(per_second, widest.unwrap_or(0))?;
        let watched = equations.iter();
        Ok(Watchdog {
            sigma: options.sigma,
            nd: stream.options().nd as u64,
            now: 0,
            watched: watched
                .map(|equation| Watched::new(equation, parameters, rows, options))
                .collect(),
            health: vec![Health::default(); equations.len()],
        })
    }

    /// Takes the equations of an instant: two factors are updated while the reference is learned,
    /// one before and after.
    pub fn update(&mut self, instant: Instant<'_>) {
        self.now = instant.sample;
        for (watched, equation) in self.watched.iter_mut().zip(instant.equations) {
            watched.add(equation, instant.sample, self.nd);
        }
    }

    /// Compares the last blocks with what was learned: the health of every equation, in the order
    /// of the joints (a single one for the power model). To be called about once per block; costs as
    /// much as some tens of updates, in memory taken at set-up. A loop that cannot wait hands a clone
    /// to another thread.
    pub fn check(&mut self) -> &[Health] {
        for (watched, health) in self.watched.iter_mut().zip(&mut self.health) {
            watched.check(health);
            let largest = health.largest.filter(|largest| largest.1 >= self.sigma);
            let Some((deviation, sigma, since)) = largest else {
                continue;
            };
            let alarm = health.alarm.get_or_insert(Alarm {
                deviation,
                sigma,
                since,
                noticed: self.now,
            });
            if sigma > alarm.sigma {
                (alarm.deviation, alarm.sigma) = (deviation, sigma);
            }
        }
        &self.health
    }

    /// The equation that deviates most clearly among those with an alarm, from 0, and its alarm.
    pub fn worst(&self) -> Option<(usize, Alarm)> {
        let alarms = self.health.iter().enumerate();
        let alarms = alarms.filter_map(|(k, health)| Some((k, health.alarm?)));
        alarms.max_by(|a, b| a.1.sigma.total_cmp(&b.1.sigma))
    }

    /// Takes back all alarms; what still deviates raises a new one at the next check.
    pub fn acknowledge(&mut self) {
        self.health
            .iter_mut()
            .for_each(|health| health.alarm = None);
    }
}
