//! Closed loops, one after the other: each gives three joints without a drive their positions.
//!
//! Where those are sums of the driven joints' positions, as in a parallelogram, they are taken as
//! such: found at one posture, believed if it closes the loop at every other one.

use std::f64::consts::{PI, TAU};

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use super::JointKind;
use super::dyad::Dyad;
use super::follow::{Affine, Follow};
use super::frames::Axis;
use super::plane::Numbers;
use super::ring::{Closure, Element, NoRing, Ring};
use crate::describe::Drive;
use crate::expr::Angle;

/// Postures that are tried until one closes a loop.
const TRIES: usize = 4000;

/// Postures at which a parallelogram has to close.
const WITNESSES: usize = 24;

/// A ring is closed below this, m or rad.
const CLOSED: f64 = 1e-9;

/// Step of differences of joint positions, rad or m.
const STEP: f64 = 1e-4;

/// Why a closed loop is not modelled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopError {
    /// Not in a plane.
    #[error(
        "loop `{name}` is not planar: {what}; only loops in which all axes of rotation are \
             parallel are modelled yet"
    )]
    NotPlanar {
        /// The loop.
        name: String,
        /// What is out of the plane.
        what: String,
    },
    /// A joint without a drive slides.
    #[error(
        "loop `{name}`: {what} slides without a drive, which is not modelled yet; the joints \
             that a loop moves have to turn"
    )]
    Slides {
        /// The loop.
        name: String,
        /// The joint.
        what: String,
    },
    /// No freedom is left.
    #[error(
        "loop `{name}` is rigid: {unknown} of its joints are without a drive, the cut one included and \
         those aside that other loops move; a planar loop moves three"
    )]
    Rigid {
        /// The loop.
        name: String,
        /// Unknown joints, the cut one included.
        unknown: usize,
    },
    /// More joints than the loops determine.
    #[error("the closed loops do not say how {} move: a planar loop moves three joints, the cut \
             one included; give one of them a drive, or describe the loop that is missing",
             joints.join(", "))]
    Loose {
        /// The joints.
        joints: Vec<String>,
    },
    /// The links are too short or too far apart.
    #[error(
        "loop `{name}` closes at none of {tries} postures of its driven joints: check its \
             lengths, and the limits of sliding joints"
    )]
    Open {
        /// The loop.
        name: String,
        /// Postures that were tried.
        tries: usize,
    },
}

impl LoopError {
    /// The loop it is about, where it is about one.
    pub fn name(&self) -> Option<&str> {
        match self {
            LoopError::NotPlanar { name, .. }
            | LoopError::Slides { name, .. }
            | LoopError::Rigid { name, .. }
            | LoopError::Open { name, .. } => Some(name),
            LoopError::Loose { .. } => None,
        }
    }
}

/// How the axes follow, by axis; `None` for those with a drive.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// By axis.
    pub follows: Vec<Option<Follow>>,
    /// What they refer to, each after those that it needs.
    pub dyads: Vec<Dyad>,
}

/// Solves all loops of a robot.
///
/// # Errors
/// [`LoopError`] for the first that cannot be.
pub fn solve(
    axes: &[Axis],
    closures: &[Closure],
    follows: Vec<Option<Follow>>,
) -> Result<Solution, LoopError> {
    let mut state = State {
        axes,
        passive: axes
            .iter()
            .map(|axis| axis.drive == Drive::Passive)
            .collect(),
        solution: Solution {
            follows,
            dyads: vec![],
        },
    };
    let mut rings = vec![];
    for closure in closures {
        rings.push((
            closure,
            Ring::new(axes, closure).map_err(|why| not_planar(axes, closure, why))?,
        ));
    }
    while !rings.is_empty() {
        let next = rings.iter().position(|(_, ring)| state.unknown(ring) <= 3);
        let Some(next) = next else { break };
        let (closure, ring) = rings.remove(next);
        state.close(closure, ring)?;
    }
    let loose = axes
        .iter()
        .zip(&state.passive)
        .filter(|(_, passive)| **passive);
    let joints: Vec<String> = loose.map(|(axis, _)| format!("`{}`", axis.name)).collect();
    match joints.is_empty() && rings.is_empty() {
        true => Ok(state.solution),
        false => Err(LoopError::Loose { joints }),
    }
}

fn not_planar(axes: &[Axis], closure: &Closure, why: NoRing) -> LoopError {
    let name = closure.name.clone();
    let what = match why {
        NoRing::Tilted(Some(joint)) => format!("the axis of `{}` is tilted", axes[joint].name),
        NoRing::Tilted(None) => "the two sides of its cut are tilted".to_owned(),
        NoRing::Apart(by) => {
            format!("the two sides of its cut are {by:.3e} m apart along its axes")
        }
        NoRing::Empty => "none of its joints turns".to_owned(),
        NoRing::CutSlides => {
            let what = "its cut joint".to_owned();
            return LoopError::Slides { name, what };
        }
    };
    LoopError::NotPlanar { name, what }
}

struct State<'a> {
    axes: &'a [Axis],
    /// Joints that no loop has moved yet.
    passive: Vec<bool>,
    solution: Solution,
}

impl State<'_> {
    fn is_unknown(&self, element: &Element) -> bool {
        element.joint.is_none_or(|joint| self.passive[joint])
    }

    fn unknown(&self, ring: &Ring) -> usize {
        let elements = ring.elements.iter();
        elements.filter(|element| self.is_unknown(element)).count()
    }

    fn close(&mut self, closure: &Closure, ring: Ring) -> Result<(), LoopError> {
        let name = || closure.name.clone();
        let unknown = self.unknown(&ring);
        let side = if closure.flipped { -1.0 } else { 1.0 };
        let slides = ring.elements.iter().find(|element| {
            let slides = |&joint: &usize| self.axes[joint].kind == JointKind::Prismatic;
            self.is_unknown(element) && element.joint.as_ref().is_some_and(slides)
        });
        if let Some(joint) = slides.and_then(|element| element.joint) {
            let what = format!("`{}`", self.axes[joint].name);
            return Err(LoopError::Slides { name: name(), what });
        }
        let dyad = Dyad::new(ring, |element| self.is_unknown(element), side);
        let mut dyad = dyad.ok_or(LoopError::Rigid {
            name: name(),
            unknown,
        })?;
        dyad.drivers = self.drivers(&dyad);
        if dyad.drivers.is_empty() {
            return Err(LoopError::Rigid {
                name: name(),
                unknown,
            });
        }
        let tries = TRIES;
        let postures = self.postures(&dyad);
        let posture = postures.ok_or(LoopError::Open {
            name: name(),
            tries,
        })?;
        let sums = match closure.flipped {
            true => None,
            false => self.sums(&dyad, &posture),
        };
        let place = self.solution.dyads.len();
        for (index, joint) in dyad.joints().into_iter().enumerate() {
            let Some(joint) = joint else { continue };
            self.passive[joint] = false;
            self.solution.follows[joint] = Some(match &sums {
                Some(sums) => Follow::Sum(sums[index].clone()),
                None => Follow::Dyad { dyad: place, index },
            });
        }
        if sums.is_none() {
            self.solution.dyads.push(dyad);
        }
        Ok(())
    }

    /// The driven axes behind the known joints of a ring.
    fn drivers(&self, dyad: &Dyad) -> Vec<usize> {
        let mut all: Vec<usize> = dyad
            .known()
            .flat_map(|joint| match &self.solution.follows[joint] {
                None => vec![joint],
                Some(Follow::Sum(sum)) => sum.terms.iter().map(|&(driven, _)| driven).collect(),
                Some(Follow::Dyad { dyad, .. }) => self.solution.dyads[*dyad].drivers.clone(),
            })
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Positions of the axes as far as they are known.
    fn positions(&self, drivers: &[usize], values: &[f64]) -> Vec<f64> {
        let mut q = vec![f64::NAN; self.axes.len()];
        for (&driver, &value) in drivers.iter().zip(values) {
            q[driver] = value;
        }
        self.solution.positions(&mut q);
        q
    }

    fn draw(&self, drivers: &[usize], unit: &mut impl FnMut() -> f64) -> Vec<f64> {
        drivers
            .iter()
            .map(|&driver| range(&self.axes[driver]).at(unit()))
            .collect()
    }

    /// Of random postures that close the ring the one that is furthest from a straight dyad.
    fn postures(&self, dyad: &Dyad) -> Option<Vec<f64>> {
        let mut unit = unit();
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..TRIES {
            let values = self.draw(&dyad.drivers, &mut unit);
            let q = self.positions(&dyad.drivers, &values);
            let [first, second, _] = dyad.turns(&mut Numbers(&q));
            let bend = bend(dyad, &q);
            let closes = first.re.is_finite() && second.re.is_finite();
            if closes && best.as_ref().is_none_or(|(most, _)| bend > *most) {
                best = Some((bend, values));
            }
        }
        best.map(|(_, values)| values)
    }

    /// The three positions as sums, on either side, the one with more terms if both are.
    fn sums(&self, dyad: &Dyad, posture: &[f64]) -> Option<[Affine; 3]> {
        let sides = [1.0, -1.0].map(|side| dyad.on_side(side));
        let found = sides.iter().filter_map(|dyad| {
            let sums = self.tangent(dyad, posture)?;
            self.close_everywhere(dyad, &sums).then_some(sums)
        });
        let terms = |sums: &[Affine; 3]| sums.iter().map(|sum| sum.terms.len()).sum::<usize>();
        found.reduce(|a, b| if terms(&b) > terms(&a) { b } else { a })
    }

    /// The sums that touch the positions at a posture, if their factors are whole numbers.
    fn tangent(&self, dyad: &Dyad, posture: &[f64]) -> Option<[Affine; 3]> {
        let at = |values: &[f64]| {
            let q = self.positions(&dyad.drivers, values);
            let turns = dyad.turns(&mut Numbers(&q));
            turns.map(|turn| turn.angle())
        };
        let here = at(posture);
        let mut sums = here.map(|value| Affine {
            terms: vec![],
            offset: value,
        });
        for (place, &driver) in dyad.drivers.iter().enumerate() {
            let moved = |by: f64| {
                let mut values = posture.to_vec();
                values[place] += by;
                at(&values)
            };
            let (ahead, behind) = (moved(STEP), moved(-STEP));
            for (index, sum) in sums.iter_mut().enumerate() {
                let step = (ahead[index] - behind[index] + PI).rem_euclid(TAU) - PI;
                let slope = step / (2.0 * STEP);
                if (slope - slope.round()).abs() > 1e-4 {
                    return None;
                }
                if slope.round() != 0.0 {
                    sum.terms.push((driver, slope.round()));
                    sum.offset -= slope.round() * posture[place];
                }
            }
        }
        for sum in &mut sums {
            sum.offset = Angle::radians(sum.offset).value();
        }
        Some(sums)
    }

    fn close_everywhere(&self, dyad: &Dyad, sums: &[Affine; 3]) -> bool {
        let mut unit = unit();
        (0..WITNESSES).all(|_| {
            let values = self.draw(&dyad.drivers, &mut unit);
            let q = self.positions(&dyad.drivers, &values);
            let unknown = [0, 1, 2].map(|index| sums[index].at(|driver| q[driver]));
            let known_elsewhere = dyad.known().all(|joint| q[joint].is_finite());
            !known_elsewhere || dyad.gap(unknown, &mut Numbers(&q)) < CLOSED
        })
    }
}

/// Sine of the angle of the middle joint's links, without a sign: 0 where they are in line.
fn bend(dyad: &Dyad, q: &[f64]) -> f64 {
    dyad.bend(&mut Numbers(q)).abs()
}

/// Where a joint without a loop may be, rad or m.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    lower: f64,
    upper: f64,
}

impl Range {
    /// At -1 the lower end, at 1 the upper.
    pub fn at(&self, unit: f64) -> f64 {
        0.5 * ((1.0 - unit) * self.lower + (1.0 + unit) * self.upper)
    }
}

/// The limits of a joint, or a full turn, or a metre either way.
fn range(axis: &Axis) -> Range {
    range_of(axis.kind, axis.limits.lower, axis.limits.upper)
}

/// Limits where both are stated, or a full turn, or a metre either way.
pub fn range_of(kind: JointKind, lower: Option<f64>, upper: Option<f64>) -> Range {
    let most = match kind {
        JointKind::Revolute => PI,
        JointKind::Prismatic => 1.0,
    };
    match (lower, upper) {
        (Some(lower), Some(upper)) => Range { lower, upper },
        _ => Range {
            lower: -most,
            upper: most,
        },
    }
}

/// Numbers in [-1, 1), the same ones on every run.
fn unit() -> impl FnMut() -> f64 {
    let mut generator = Pcg64Mcg::new(0x6c6f_6f70);
    move || (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

impl Solution {
    /// Fills in what follows from the positions of the driven axes.
    pub fn positions(&self, q: &mut [f64]) {
        for (joint, follow) in self.follows.iter().enumerate() {
            if let Some(Follow::Sum(sum)) = follow {
                q[joint] = sum.at(|driver| q[driver]);
            }
        }
        for (place, dyad) in self.dyads.iter().enumerate() {
            let turns = dyad.turns(&mut Numbers(q));
            for (joint, follow) in self.follows.iter().enumerate() {
                if let Some(Follow::Dyad { dyad, index }) = follow
                    && *dyad == place
                {
                    q[joint] = turns[*index].angle();
                }
            }
        }
    }
}
