//! Joints without a drive: how they follow those that have one.
//!
//! The positions of all joints of the tree are a function of those of the driven ones,
//! \\( q_{tree} = g(q) \\). With G = dg/dq the models in the driven joints are
//! \\( D = G^T D_{tree} \\) at \\( \ddot q_{tree} = G \ddot q + \dot G \dot q \\),
//! \\( P = G^T P_{tree} \\), \\( R = G^T R_{tree} - \dot G^T P_{tree} \\), and h as it is.

use std::collections::BTreeMap;

use super::dyad::Dyad;
use super::frames::Axis;
use super::loops::{self, LoopError};
use super::plane::Numbers;
use super::ring::Closure;
use super::{Joint, Mechanism};
use crate::describe::Drive;

/// A position as a sum of positions of driven joints, each times its factor, plus a constant:
/// what mimic joints and parallelograms make of it. G is constant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// Driven joints and their factors, ascending, no factor 0.
    pub terms: Vec<(usize, f64)>,
    /// Constant, rad or m.
    pub offset: f64,
}

/// How a joint without a drive moves.
#[derive(Clone, Debug, PartialEq)]
pub enum Follow {
    /// As a sum of positions.
    Sum(Affine),
    /// As one of the three unknown joints of a closed loop.
    Dyad {
        /// Place in [`Mechanism::dyads`].
        dyad: usize,
        /// Which of the three.
        index: usize,
    },
}

impl Affine {
    /// The position of a joint itself.
    pub fn own(joint: usize) -> Affine {
        Affine {
            terms: vec![(joint, 1.0)],
            offset: 0.0,
        }
    }

    /// `factor` times this position plus `offset`.
    pub fn scaled(&self, factor: f64, offset: f64) -> Affine {
        let terms = self.terms.iter().map(|&(joint, by)| (joint, factor * by));
        Affine {
            terms: terms.filter(|&(_, by)| by != 0.0).collect(),
            offset: factor * self.offset + offset,
        }
    }

    /// The same with other numbers for the joints.
    pub fn renumbered(&self, number: impl Fn(usize) -> usize) -> Affine {
        let terms = self.terms.iter();
        let by_number: BTreeMap<usize, f64> =
            terms.map(|&(joint, by)| (number(joint), by)).collect();
        Affine {
            terms: by_number.into_iter().collect(),
            offset: self.offset,
        }
    }

    /// Its value, rad or m.
    pub fn at(&self, q: impl Fn(usize) -> f64) -> f64 {
        let terms = self.terms.iter();
        terms.fold(self.offset, |sum, &(joint, by)| sum + by * q(joint))
    }
}

impl Mechanism {
    /// The joints with a drive of their own: the rows of every output.
    pub fn driven(&self) -> &[Joint] {
        &self.joints[..self.driven]
    }

    /// How a joint moves; one with a drive as itself.
    pub fn follow(&self, joint: usize) -> Follow {
        match joint.checked_sub(self.driven) {
            Some(place) => self.follows[place].clone(),
            None => Follow::Sum(Affine::own(joint)),
        }
    }

    /// The driven joints that a joint moves with.
    pub fn moves_with(&self, joint: usize) -> Vec<usize> {
        match self.follow(joint) {
            Follow::Sum(sum) => sum.terms.into_iter().map(|(driven, _)| driven).collect(),
            Follow::Dyad { dyad, .. } => self.dyads[dyad].drivers.clone(),
        }
    }

    /// Positions of all joints, rad or m, of those of the driven ones; NaN where a loop cannot
    /// close.
    pub fn positions(&self, q: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.joints.len()];
        for (place, &value) in all[..self.driven].iter_mut().zip(q) {
            *place = value;
        }
        for (place, follow) in self.follows.iter().enumerate() {
            if let Follow::Sum(sum) = follow {
                all[self.driven + place] = sum.at(|joint| q.get(joint).copied().unwrap_or(0.0));
            }
        }
        for (number, dyad) in self.dyads.iter().enumerate() {
            let turns = dyad.turns(&mut Numbers(&all));
            for (place, follow) in self.follows.iter().enumerate() {
                if let Follow::Dyad { dyad, index } = follow
                    && *dyad == number
                {
                    all[self.driven + place] = turns[*index].angle();
                }
            }
        }
        all
    }

    /// How far the closed loops are from their singular postures: the least sine of the angle
    /// between the two links that close one; 1 without loops, 0 where one cannot close.
    pub fn bend(&self, q: &[f64]) -> f64 {
        let all = self.positions(q);
        let bends = self.dyads.iter();
        let bends = bends.map(|dyad| dyad.bend(&mut Numbers(&all)).abs());
        bends.fold(1.0, |least, bend| match bend < least || bend.is_nan() {
            true => {
                if bend.is_nan() {
                    0.0
                } else {
                    bend
                }
            }
            false => least,
        })
    }

    /// The link that a tool is on: the last one; where joints follow others, the one with the most
    /// joints between it and the base.
    pub fn tool(&self) -> Option<usize> {
        if self.driven == self.joints.len() {
            return self.joints.len().checked_sub(1);
        }
        let depth = |&link: &usize| self.chain(link).len();
        let deepest = self.order.iter().map(depth).max()?;
        self.order
            .iter()
            .copied()
            .find(|link| depth(link) == deepest)
    }
}

/// The joints by number: those with a drive first, in the order of the axes, then the others.
#[derive(Clone, Debug)]
pub struct Numbering {
    /// Number of each axis.
    pub numbers: Vec<usize>,
    /// How many have a drive.
    pub driven: usize,
    /// How the others follow, in numbers.
    pub follows: Vec<Follow>,
    /// What follows from closed loops, in numbers.
    pub dyads: Vec<Dyad>,
}

/// Numbers the axes. Of a description that was not checked, joints in loops that are not modelled
/// count as driven.
pub fn numbering(axes: &[Axis], closures: &[Closure]) -> Numbering {
    let solved = solve(axes, closures).unwrap_or_else(|_| loops::Solution {
        follows: mimics(axes),
        dyads: vec![],
    });
    let is_own = |axis: &usize| solved.follows[*axis].is_none();
    let (driven, others): (Vec<usize>, Vec<usize>) = (0..axes.len()).partition(is_own);
    let mut numbers = vec![0; axes.len()];
    for (number, &axis) in driven.iter().chain(&others).enumerate() {
        numbers[axis] = number;
    }
    let follow = |&axis: &usize| match solved.follows[axis].clone() {
        Some(Follow::Sum(sum)) => Follow::Sum(sum.renumbered(|known| numbers[known])),
        Some(dyad) => dyad,
        None => Follow::Sum(Affine::own(axis)),
    };
    let dyads = solved.dyads.iter();
    Numbering {
        follows: others.iter().map(follow).collect(),
        dyads: dyads
            .map(|dyad| dyad.renumbered(|axis| vec![numbers[axis]]))
            .collect(),
        driven: driven.len(),
        numbers,
    }
}

/// How the axes follow, by axis.
///
/// # Errors
/// [`LoopError`] of the first closed loop that is not modelled.
pub fn solve(axes: &[Axis], closures: &[Closure]) -> Result<loops::Solution, LoopError> {
    loops::solve(axes, closures, mimics(axes))
}

/// Mimic joints alone.
fn mimics(axes: &[Axis]) -> Vec<Option<Follow>> {
    (0..axes.len())
        .map(|axis| position(axes, axis).map(Follow::Sum))
        .collect()
}

/// The position of an axis without a drive in those of driven axes; a mimic of a mimic is resolved.
fn position(axes: &[Axis], axis: usize) -> Option<Affine> {
    let mut found = Affine::own(axis);
    let mut at = axis;
    for _ in 0..axes.len() {
        let Drive::Mimic(mimic) = &axes[at].drive else {
            return (at != axis).then_some(found);
        };
        let next = axes.iter().position(|known| known.name == mimic.joint)?;
        let factor = found.terms.first().map_or(0.0, |&(_, by)| by);
        // found = factor * q_at + offset, and q_at = multiplier * q_next + own offset.
        found = Affine::own(next).scaled(
            factor * mimic.multiplier,
            found.offset + factor * mimic.offset,
        );
        at = next;
    }
    None
}
