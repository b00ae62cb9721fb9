//! The regressor of all standard parameters on seeded random states.

use nalgebra::DMatrix;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use crate::derive::Standard;
use crate::expr::tape::{Batch, Tape};
use crate::expr::{Expr, Graph};
use crate::mechanism::loops::{self, Range};
use crate::mechanism::{JointKind, Mechanism};

/// Fixed, so that names and relations are the same on every run.
const SEED: u128 = 0x6964_696d;

/// Postures that are tried for a sample of a robot with closed loops.
const POSTURES: usize = 2000;

/// Sine of the angle between the two links of a loop that is far enough from a line.
const BEND: f64 = 0.2;

/// Columns of D, one per standard parameter, rows joint by joint on enough states that random
/// coincidence cannot hide a rank.
pub fn explicit(graph: &Graph, mechanism: &Mechanism, standard: &[Standard]) -> DMatrix<f64> {
    let n = mechanism.driven;
    let len = 2 * standard.len() / n + 20;
    let states = States::random(mechanism, len);
    let entries: Vec<(usize, usize, Expr)> = standard
        .iter()
        .enumerate()
        .flat_map(|(column, parameter)| {
            parameter
                .columns
                .explicit
                .iter()
                .map(move |&(joint, entry)| (joint, column, entry))
        })
        .collect();
    let outputs: Vec<Expr> = entries.iter().map(|&(_, _, entry)| entry).collect();
    let mut values = vec![0.0; outputs.len() * len];
    Tape::new(graph, &outputs).run(&states.batch(), &mut values);
    let mut w = DMatrix::zeros(n * len, standard.len());
    for (index, &(joint, column, _)) in entries.iter().enumerate() {
        for sample in 0..len {
            w[(joint * len + sample, column)] = values[index * len + sample];
        }
    }
    w
}

/// Positions at which the closed loops close well, within the limits that are stated.
fn postures(mechanism: &Mechanism, len: usize, unit: &mut impl FnMut() -> f64) -> Vec<f64> {
    let ranges: Vec<Range> = mechanism
        .driven()
        .iter()
        .map(|joint| loops::range_of(joint.kind, joint.limits.lower, joint.limits.upper))
        .collect();
    let mut q = vec![0.0; ranges.len() * len];
    let (mut sample, mut best) = (0, 0.0);
    let mut kept: Vec<f64> = vec![];
    for attempt in 1..=POSTURES * len {
        let drawn: Vec<f64> = ranges.iter().map(|range| range.at(unit())).collect();
        let bend = mechanism.bend(&drawn);
        if bend > best {
            (best, kept) = (bend, drawn.clone());
        }
        let enough = bend > BEND;
        // What never closes well is taken as well as it closes.
        if enough || attempt >= POSTURES * (sample + 1) {
            let taken = if enough { &drawn } else { &kept };
            for (joint, &value) in taken.iter().enumerate() {
                q[joint * len + sample] = value;
            }
            (sample, best) = (sample + 1, 0.0);
        }
        if sample == len {
            break;
        }
    }
    q
}

/// Random states, structure of arrays.
#[derive(Clone, Debug)]
pub struct States {
    len: usize,
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    slip: Vec<f64>,
}

impl States {
    /// Angles over the full turn, displacements within 1 m; speeds and accelerations of order 1,
    /// so that inertial and gravity terms have the same weight.
    pub fn random(mechanism: &Mechanism, len: usize) -> States {
        let mut generator = Pcg64Mcg::new(SEED);
        // 53 bits fill the mantissa; the range is [-1, 1).
        let mut unit = || (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        let mut states = States {
            len,
            q: vec![],
            qd: vec![],
            qdd: vec![],
            slip: vec![],
        };
        for joint in mechanism.driven() {
            let range = match joint.kind {
                JointKind::Revolute => std::f64::consts::PI,
                JointKind::Prismatic => 1.0,
            };
            for _ in 0..len {
                states.q.push(range * unit());
                states.qd.push(3.0 * unit());
                states.qdd.push(5.0 * unit());
            }
        }
        if !mechanism.dyads.is_empty() {
            states.q = postures(mechanism, len, &mut unit);
        }
        // Drawn last, so that the other numbers are the same with and without them.
        states.slip = (0..mechanism.driven * len).map(|_| unit()).collect();
        states
    }

    /// For a tape.
    pub fn batch(&self) -> Batch<'_> {
        Batch {
            len: self.len,
            q: &self.q,
            qd: &self.qd,
            qdd: &self.qdd,
            slip: &self.slip,
        }
    }
}
