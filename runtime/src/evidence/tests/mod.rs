//! A small robot of nothing but numbers, and random equations for it.

mod answers;
mod coverage;
mod essential;
mod file;
mod posterior;
mod refused;
mod speed;
mod spread;
mod triangle;

use std::borrow::Cow;

use super::{Candidate, Cut, Evidence};
use crate::model::{
    Column, ColumnKind, IdentificationModel, Joint, JointKind, Output, Pattern, States,
};
use crate::observe::{Equations, ModelKind, Observations};
use crate::settings::Settings;

/// Uniform numbers in -1..1 (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Standard normal: Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (0.5 * (self.next() + 1.0)).max(1e-300).ln()).sqrt();
        radius * (std::f64::consts::PI * self.next()).cos()
    }

    pub fn series(&mut self, len: usize) -> Vec<f64> {
        (0..len).map(|_| self.next()).collect()
    }
}

/// A robot with parameters X1, X2, ...
pub struct Numbers {
    name: &'static str,
    columns: Vec<Column>,
    joints: Vec<Joint>,
    pattern: Pattern,
    settings: Settings,
}

pub fn numbers(name: &'static str, np: usize, joints: usize) -> Numbers {
    let column = |k: usize| Column {
        name: format!("X{}", k + 1).into(),
        unit: Cow::Borrowed("kg m^2"),
        joint: 1,
        kind: ColumnKind::Inertial,
        meaning: Cow::Borrowed("a number"),
        relation: format!("{name}{k}").into(),
    };
    let joint = |j: usize| Joint {
        name: format!("joint{j}").into(),
        kind: JointKind::Revolute,
    };
    Numbers {
        name,
        columns: (0..np).map(column).collect(),
        joints: (0..joints).map(joint).collect(),
        pattern: Pattern {
            entries: Cow::Borrowed(&[]),
            signals: 0,
        },
        settings: Settings::default(),
    }
}

impl IdentificationModel for Numbers {
    fn name(&self) -> &str {
        self.name
    }
    fn joints(&self) -> &[Joint] {
        &self.joints
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, _output: Output) -> &Pattern {
        &self.pattern
    }
    fn settings(&self) -> &Settings {
        &self.settings
    }
    fn evaluate(&self, _output: Output, _states: &States<'_>, _signals: &mut [f64]) {}
}

/// Number of parameters and rows per joint of [`random`].
pub const NP: usize = 7;
pub const ROWS: usize = 403;

/// Three joints, each seeing fewer columns than the one before, in very different units and with
/// very different errors, correlated between joints.
pub fn random(seed: u64) -> Observations {
    let mut random = Random(seed);
    let common = random.series(ROWS);
    let blocks = (0..3).map(|joint| {
        let columns: Vec<usize> = (2 * joint..NP).collect();
        let scale = |c: &usize| 10f64.powi(*c as i32 - 3);
        let w: Vec<f64> = columns
            .iter()
            .flat_map(|c| {
                random
                    .series(ROWS)
                    .into_iter()
                    .map(|v| v * scale(c))
                    .collect::<Vec<_>>()
            })
            .collect();
        let mut equations = Equations {
            columns,
            rows: ROWS,
            w,
            y: None,
        };
        let truth: Vec<f64> = (0..NP).map(|k| (k as f64 + 1.0) / scale(&k)).collect();
        let level = 10f64.powi(-(joint as i32));
        let y = equations.product(&truth).into_iter().zip(&common);
        equations.y = Some(y.map(|(y, c)| y + level * (c + random.next())).collect());
        equations
    });
    Observations {
        model: ModelKind::Explicit,
        blocks: blocks.collect(),
    }
}

/// Rows `range` of the equations.
pub fn part(observations: &Observations, range: std::ops::Range<usize>) -> Observations {
    let cut = |equations: &Equations| Equations {
        columns: equations.columns.clone(),
        rows: range.len(),
        w: (0..equations.columns.len())
            .flat_map(|k| equations.column(k)[range.clone()].to_vec())
            .collect(),
        y: equations.y.as_ref().map(|y| y[range.clone()].to_vec()),
    };
    let blocks = observations.blocks.iter().map(cut).collect();
    Observations {
        model: observations.model,
        blocks,
    }
}

pub fn gather(observations: &Observations, cut: Cut) -> Evidence {
    let none: &[Candidate<'_>] = &[];
    Evidence::from_observations(&numbers("arm", NP, 3), observations, none, cut).unwrap()
}

/// Largest difference, relative to the value or to one part in a million of the largest.
#[track_caller]
pub fn assert_close(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (a, b) in a.iter().zip(b) {
        let size = a.abs().max(b.abs()).max(1e-6 * largest);
        assert!(
            (a - b).abs() <= tolerance * size,
            "{a} is not {b} to {tolerance}"
        );
    }
}
