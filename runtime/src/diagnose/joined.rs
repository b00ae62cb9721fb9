//! Several logs as one stack of rows.

use std::ops::Range;

use super::catalogue::{Catalogue, ColumnsAlong, Hypothesis};
use super::noise::Noise;
use super::system::Sparse;
use super::track::{Decimated, Predicted, Track};
use crate::model::IdentificationModel;

/// Logs one after the other; filters and whiteners never reach across a boundary.
#[derive(Clone, Debug)]
pub(super) struct Joined {
    pub tracks: Vec<Track>,
    /// Rows of each log.
    pub segments: Vec<Range<usize>>,
    /// What each row counts for, by joint.
    pub weights: Vec<Vec<f64>>,
}

impl Joined {
    pub fn new(tracks: Vec<Track>) -> Joined {
        let mut segments = Vec::with_capacity(tracks.len());
        let mut end = 0;
        for track in &tracks {
            segments.push(end..end + track.rows());
            end += track.rows();
        }
        let joints = tracks.first().map_or(0, |track| track.weights.len());
        let weights = (0..joints)
            .map(|joint| {
                tracks
                    .iter()
                    .flat_map(|track| track.weights[joint].clone())
                    .collect()
            })
            .collect();
        Joined {
            tracks,
            segments,
            weights,
        }
    }

    /// The same logs, counting only the rows of a share of each, from 0 at its beginning to 1 at
    /// its end.
    pub fn part(&self, share: Range<f64>) -> Joined {
        let mut part = self.clone();
        for weights in &mut part.weights {
            for segment in &self.segments {
                let at =
                    |share: f64| segment.start + (share * segment.len() as f64).round() as usize;
                let inside = at(share.start)..at(share.end);
                let outside = segment.clone().filter(|row| !inside.contains(row));
                outside.for_each(|row| weights[row] = 0.0);
            }
        }
        part
    }

    /// Some of the logs, by their places, each row counting what it does.
    pub fn only(&self, places: &[usize]) -> Joined {
        let tracks = places.iter().filter_map(|&place| self.tracks.get(place));
        let mut only = Joined::new(tracks.cloned().collect());
        for (own, all) in only.weights.iter_mut().zip(&self.weights) {
            let rows = places.iter().filter_map(|&place| self.segments.get(place));
            *own = rows.flat_map(|rows| all[rows.clone()].to_vec()).collect();
        }
        only
    }

    /// Rows of each joint.
    pub fn rows(&self) -> usize {
        self.segments.last().map_or(0, |segment| segment.end)
    }

    pub fn joints(&self) -> usize {
        self.weights.len()
    }

    /// Measured torque of a joint.
    pub fn measured(&self, joint: usize) -> Vec<f64> {
        self.tracks
            .iter()
            .flat_map(|track| track.measured(joint).to_vec())
            .collect()
    }

    /// Column `k` of W on each joint that it acts on.
    pub fn base(&self, k: usize) -> Vec<(usize, Vec<f64>)> {
        let on = |joint: usize| -> Option<(usize, Vec<f64>)> {
            let mut rows = Vec::with_capacity(self.rows());
            for track in &self.tracks {
                let equations = &track.equations[joint];
                let place = equations.columns.iter().position(|&column| column == k)?;
                rows.extend_from_slice(equations.column(place));
            }
            Some((joint, rows))
        };
        (0..self.joints()).filter_map(on).collect()
    }

    /// Pulses at the reversals of each joint.
    pub fn reversals(&self) -> Vec<Vec<f64>> {
        let mut all = vec![Vec::with_capacity(self.rows()); self.joints()];
        for track in &self.tracks {
            let of_track = all.iter_mut().zip(track.reversals());
            of_track.for_each(|(all, more)| all.extend(more));
        }
        all
    }

    /// Sum of the squared torque errors of a joint over the rows that count.
    pub fn square_error(&self, joint: usize, predicted: &[Vec<f64>]) -> f64 {
        let measured = self.measured(joint);
        let pairs = measured.iter().zip(&predicted[joint]);
        let weighted = self.weights[joint].iter().zip(pairs);
        weighted.map(|(w, (y, p))| w * (y - p).powi(2)).sum()
    }

    /// \\( W X \\) of each joint.
    pub fn product(&self, parameters: &[f64]) -> Vec<Vec<f64>> {
        let of_joint = |joint: usize| {
            let tracks = self.tracks.iter();
            tracks
                .flat_map(|track| track.equations[joint].product(parameters))
                .collect()
        };
        (0..self.joints()).map(of_joint).collect()
    }

    /// Torques that a model predicts, log by log.
    pub fn predict(&self, model: &dyn IdentificationModel, parameters: &[f64]) -> Vec<Predicted> {
        self.tracks
            .iter()
            .map(|track| track.predict(model, parameters))
            .collect()
    }

    /// The columns of a catalogue along each log.
    pub fn along<'a>(
        &'a self,
        catalogue: &'a dyn Catalogue,
        predicted: &'a [Predicted],
    ) -> Vec<ColumnsAlong<'a>> {
        let pairs = self.tracks.iter().zip(predicted);
        pairs
            .map(|(track, predicted)| catalogue.along(track.signals(predicted)))
            .collect()
    }

    /// Columns of a hypothesis for each of `shapes`, over all logs.
    pub fn columns(
        &self,
        along: &[ColumnsAlong<'_>],
        hypothesis: &Hypothesis,
        shapes: &[Vec<f64>],
    ) -> Vec<Vec<Decimated>> {
        let of_track =
            |(track, along): (&Track, &ColumnsAlong<'_>)| track.columns(along, hypothesis, shapes);
        let mut of_tracks = self.tracks.iter().zip(along).map(of_track);
        let mut all = of_tracks.next().unwrap_or_default();
        for more in of_tracks {
            for (column, more) in all.iter_mut().flatten().zip(more.into_iter().flatten()) {
                for ((_, rows), (_, more)) in column.torque.iter_mut().zip(more.torque) {
                    rows.extend(more);
                }
            }
        }
        all
    }

    /// Whitens the rows of joints.
    pub fn whiten(&self, torque: &[(usize, Vec<f64>)], noise: &[Noise]) -> Sparse {
        let part = |(joint, rows): &(usize, Vec<f64>)| {
            let white = noise[*joint].whiten(rows, &self.weights[*joint], &self.segments);
            (*joint, white)
        };
        Sparse(torque.iter().map(part).collect())
    }
}
