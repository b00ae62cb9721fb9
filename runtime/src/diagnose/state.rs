//! The model with the effects that it has by now, fitted.

use super::catalogue::{Catalogue, ColumnsAlong, EntryKind, Hypothesis};
use super::instruments::SMOOTH_HZ;
use super::joined::Joined;
use super::linear::add_scaled;
use super::noise::Noise;
use super::system::{Pair, Sparse, System};
use super::track::{Decimated, Instead, Predicted, Track};
use crate::model::IdentificationModel;

/// Rounds in which columns that depend on the model are rebuilt.
const ROUNDS: usize = 2;

/// An effect in the model.
#[derive(Clone, Debug)]
pub(super) struct Effect {
    /// Place in the list of hypotheses.
    pub number: usize,
    pub shape: Vec<f64>,
    /// Names and units of its parameters, and their values.
    pub names: Vec<(String, &'static str)>,
    pub values: Vec<f64>,
    pub sigmas: Vec<Option<f64>>,
    pairs: Vec<Pair>,
}

impl Effect {
    /// Its columns along the instruments' motions.
    pub fn instruments(&self) -> Vec<Sparse> {
        self.pairs.iter().map(|(_, z)| z.clone()).collect()
    }
}

/// What every step of the search needs.
#[derive(Clone, Copy)]
pub(super) struct Bench<'a> {
    pub model: &'a dyn IdentificationModel,
    pub catalogue: &'a dyn Catalogue,
    pub hypotheses: &'a [Hypothesis],
    pub train: &'a Joined,
    /// The same rows along motions without noise.
    pub instruments: &'a Joined,
    pub noise: &'a [Noise],
    /// The null model alone.
    pub null: &'a System,
    /// Share of the torque error of some joint that an effect must take away.
    pub least_gain: f64,
    /// Whether the instruments are the log's own other periods, which show how links move against
    /// their drives.
    pub repeated: bool,
}

/// The columns of the catalogue along the motions that a hypothesis is asked on.
pub(super) struct Asking<'b> {
    instruments: Vec<ColumnsAlong<'b>>,
    measured: Vec<ColumnsAlong<'b>>,
}

/// The model with some effects.
#[derive(Clone)]
pub(super) struct State {
    pub system: System,
    pub parameters: Vec<f64>,
    pub effects: Vec<Effect>,
    /// What it predicts.
    pub predicted: Predictions,
}

/// Predictions along the training logs and along their instruments' motions, log by log.
#[derive(Clone, Debug)]
pub(super) struct Predictions {
    pub train: Vec<Predicted>,
    pub instruments: Vec<Predicted>,
}

impl<'a> Bench<'a> {
    /// The columns of the catalogue, where the model predicts this.
    pub fn asking<'b>(&self, predicted: &'b Predictions) -> Asking<'b>
    where
        'a: 'b,
    {
        Asking {
            instruments: self
                .instruments
                .along(self.catalogue, &predicted.instruments),
            measured: self.train.along(self.catalogue, &predicted.train),
        }
    }

    /// Whether only the measured motion shows an effect: it has no other instruments.
    pub fn only_measured(&self, number: usize) -> bool {
        !self.repeated && self.kind(number) == EntryKind::Yielding
    }

    /// The columns of a hypothesis for each of `shapes`, along its instruments.
    pub fn instruments_of(
        &self,
        number: usize,
        shapes: &[Vec<f64>],
        asking: &Asking<'_>,
    ) -> Vec<Vec<Decimated>> {
        let (joined, along) = match self.only_measured(number) {
            true => (self.train, &asking.measured),
            false => (self.instruments, &asking.instruments),
        };
        joined.columns(along, &self.hypotheses[number], shapes)
    }

    /// Whether the parameters of the model are known and stay as they are.
    pub fn knows_parameters(&self) -> bool {
        self.least_gain > f64::NEG_INFINITY
    }

    pub fn kind(&self, number: usize) -> EntryKind {
        self.catalogue.entries()[self.hypotheses[number].entry].kind
    }

    /// Where only the measured motion shows a hypothesis, its columns along the instruments as well.
    pub fn beside_measured(
        &self,
        number: usize,
        shapes: &[Vec<f64>],
        asking: &Asking<'_>,
    ) -> Vec<Vec<Decimated>> {
        match self.only_measured(number) {
            true => {
                let hypothesis = &self.hypotheses[number];
                let along = &asking.instruments;
                self.instruments.columns(along, hypothesis, shapes)
            }
            false => Vec::new(),
        }
    }

    /// The null model with effects (number and shape), starting from what `before` predicts.
    pub fn settle(&self, chosen: &[(usize, Vec<f64>)], before: &Predictions) -> State {
        let mut predicted = before.clone();
        let dependent = chosen
            .iter()
            .any(|(number, _)| self.kind(*number) != EntryKind::Static);
        let mut state = self.fitted(chosen, predicted.clone());
        for _ in 0..if dependent { ROUNDS } else { 1 } {
            predicted = self.predictions(&state.parameters, &state.effects);
            if dependent {
                state = self.fitted(chosen, predicted.clone());
            }
        }
        state.predicted = predicted;
        state
    }

    fn fitted(&self, chosen: &[(usize, Vec<f64>)], predicted: Predictions) -> State {
        let mut effects: Vec<Effect> = Vec::new();
        let asking = self.asking(&predicted);
        for (number, shape) in chosen {
            let hypothesis = &self.hypotheses[*number];
            let shapes = std::slice::from_ref(shape);
            let made = self.train.columns(&asking.measured, hypothesis, shapes);
            let made: Vec<_> = made.into_iter().flatten().collect();
            let instruments = self.instruments_of(*number, shapes, &asking);
            let white = |column: &Decimated| self.train.whiten(&column.torque, self.noise);
            let pairs = made.iter().zip(instruments.iter().flatten());
            let pairs: Vec<Pair> = pairs.map(|(w, z)| (white(w), white(z))).collect();
            effects.push(Effect {
                number: *number,
                shape: shape.clone(),
                names: made
                    .into_iter()
                    .map(|column| (column.name, column.unit))
                    .collect(),
                values: Vec::new(),
                sigmas: Vec::new(),
                pairs,
            });
        }
        drop(asking);
        let all: Vec<Pair> = effects.iter().flat_map(|e| e.pairs.clone()).collect();
        let system = self.null.with(&all);
        let np = self.model.columns().len();
        let mut solution = system.solution();
        let added = solution.split_off(np + self.model.joints().len());
        solution.truncate(np);
        let sigmas = system.sigmas(added.len());
        let mut first = 0;
        for effect in &mut effects {
            let own = first..first + effect.pairs.len();
            first = own.end;
            effect.values = added[own.clone()].to_vec();
            effect.sigmas = sigmas[own].to_vec();
        }
        State {
            system,
            parameters: solution,
            effects,
            predicted,
        }
    }

    /// What a model with effects predicts along the training logs and beside them.
    pub fn predictions(&self, parameters: &[f64], effects: &[Effect]) -> Predictions {
        Predictions {
            train: self.predicted(self.train, parameters, effects),
            instruments: self.predicted(self.instruments, parameters, effects),
        }
    }

    /// What a model with effects predicts along logs at their full rate. Those effects that are
    /// made of this prediction are left out of it.
    pub fn predicted(
        &self,
        joined: &Joined,
        parameters: &[f64],
        effects: &[Effect],
    ) -> Vec<Predicted> {
        let of_track = |track: &Track| {
            let mut predicted = track.predict(self.model, parameters);
            let plain = predicted.clone();
            let own = |effect: &&Effect| self.kind(effect.number) != EntryKind::ModelDependent;
            let effects = effects.iter().filter(own);
            self.add(track, effects, &plain, &mut predicted.model);
            predicted
        };
        joined.tracks.iter().map(of_track).collect()
    }

    /// Adds the torque of effects along a track, at its full rate.
    fn add<'e>(
        &self,
        track: &Track,
        effects: impl Iterator<Item = &'e Effect>,
        predicted: &Predicted,
        to: &mut [Vec<f64>],
    ) {
        let along = self.catalogue.along(track.signals(predicted));
        for effect in effects {
            let columns = along(&self.hypotheses[effect.number], &effect.shape);
            for (column, value) in columns.iter().zip(&effect.values) {
                for (joint, torque) in &column.torque {
                    add_scaled(&mut to[*joint], *value, torque);
                }
            }
        }
    }

    /// Decimated torque that a state predicts along other logs, by joint.
    pub fn rows(&self, state: &State, joined: &Joined) -> Vec<Vec<f64>> {
        let mut rows = joined.product(&state.parameters);
        if state.effects.is_empty() {
            return rows;
        }
        let predicted = self.predicted(joined, &state.parameters, &state.effects);
        let along = joined.along(self.catalogue, &predicted);
        for effect in &state.effects {
            let hypothesis = &self.hypotheses[effect.number];
            let shapes = std::slice::from_ref(&effect.shape);
            let made = joined.columns(&along, hypothesis, shapes);
            for (column, value) in made.iter().flatten().zip(&effect.values) {
                for (joint, torque) in &column.torque {
                    add_scaled(&mut rows[*joint], *value, torque);
                }
            }
        }
        rows
    }

    /// Torque that a state predicts along a track at its full rate, by joint. Columns that
    /// differentiate the model's torque, or have a memory, follow the smooth part of the motion, but
    /// for links that swing beyond it.
    pub fn torque(&self, state: &State, track: &Track) -> Vec<Vec<f64>> {
        let len = track.source.recording.len;
        let torque = self.thinned_torque(state, track);
        let spread = torque
            .into_iter()
            .map(|torque| track.thin.spread(torque, len));
        spread.collect()
    }

    fn thinned_torque(&self, state: &State, track: &Track) -> Vec<Vec<f64>> {
        let mut torque = track.predict(self.model, &state.parameters).model;
        let smooth = track.beside(self.model, &Instead::Below(SMOOTH_HZ));
        let smooth = smooth.unwrap_or_else(|_| track.clone());
        let (plain, other): (Vec<&Effect>, Vec<&Effect>) =
            state.effects.iter().partition(|effect| {
                let kind = self.kind(effect.number);
                matches!(kind, EntryKind::Static | EntryKind::Yielding)
            });
        for (along, effects) in [(track, plain), (&smooth, other)] {
            let one = Joined::new(vec![along.clone()]);
            let predicted = self.predicted(&one, &state.parameters, &state.effects);
            for predicted in &predicted {
                self.add(along, effects.iter().copied(), predicted, &mut torque);
            }
        }
        torque.iter_mut().for_each(|torque| track.as_logged(torque));
        torque
    }
}
