//! A closed loop as a ring of planar joints.
//!
//! With every joint at 0 the two branches of a loop end in two frames, which the positions of its
//! joints bring together. Along one branch out and the other back that is a product of rotations
//! about fixed points, and of translations, that equals a given displacement (product of
//! exponentials).

use nalgebra::Vector3;

use super::JointKind;
use super::frames::{Axis, SNAP};
use super::plane::{Algebra, Complex, Displacement};
use super::pose::Pose;
use crate::describe::Motion;

/// Beyond this (m) the frames of a loop lie in different planes.
const APART: f64 = 1e-6;

/// An end of a branch at q = 0.
#[derive(Clone, Debug)]
pub struct End {
    /// Pose in the frame of the base.
    pub pose: Pose,
    /// The axis that carries it.
    pub carrier: Option<usize>,
}

/// A loop of the description between axes.
#[derive(Clone, Debug)]
pub struct Closure {
    /// Its name.
    pub name: String,
    /// Kind of the joint that is cut.
    pub motion: Motion,
    /// Behind the cut joint, and as the other branch has it.
    pub ends: [End; 2],
    /// Whether the other of two assemblies is meant.
    pub flipped: bool,
}

/// How an element of a ring moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moves {
    /// Turns about a point.
    Turns(Complex<f64>),
    /// Slides along a direction.
    Slides(Complex<f64>),
}

/// A joint in a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// The joint; `None` for the one that is cut.
    pub joint: Option<usize>,
    /// 1 or -1: how its position enters.
    pub sign: f64,
    /// How it moves.
    pub motion: Moves,
}

/// A ring: the product of its elements is the target.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// In the order of the product.
    pub elements: Vec<Element>,
    /// What they multiply to.
    pub target: Displacement<f64>,
}

/// Why a loop is no planar ring.
#[derive(Clone, Debug, PartialEq)]
pub enum NoRing {
    /// An axis that is not that of the plane; the cut joint has no name.
    Tilted(Option<usize>),
    /// The cut joint slides.
    CutSlides,
    /// The ends lie in planes so far apart, m.
    Apart(f64),
    /// No joint of the tree turns in it.
    Empty,
}

/// The plane of a loop: its normal and two axes.
struct Plane {
    normal: Vector3<f64>,
    axes: [Vector3<f64>; 2],
}

impl Plane {
    fn new(normal: Vector3<f64>) -> Plane {
        let near = match normal.x.abs() < 0.9 {
            true => Vector3::x(),
            false => Vector3::y(),
        };
        let first = (near - normal * normal.dot(&near)).normalize();
        Plane {
            normal,
            axes: [first, normal.cross(&first)],
        }
    }

    fn point(&self, x: Vector3<f64>) -> Complex<f64> {
        Complex {
            re: self.axes[0].dot(&x),
            im: self.axes[1].dot(&x),
        }
    }

    fn element(&self, axes: &[Axis], joint: usize, sign: f64) -> Result<Element, NoRing> {
        let axis = &axes[joint];
        let z: Vector3<f64> = axis.frame.rotation.column(2).into();
        let along = z.dot(&self.normal);
        let across = z.cross(&self.normal).norm();
        let (sign, motion) = match axis.kind {
            JointKind::Revolute if across < SNAP => (
                sign * along.signum(),
                Moves::Turns(self.point(axis.frame.translation)),
            ),
            JointKind::Prismatic if along.abs() < SNAP => (sign, Moves::Slides(self.point(z))),
            _ => return Err(NoRing::Tilted(Some(joint))),
        };
        Ok(Element {
            joint: Some(joint),
            sign,
            motion,
        })
    }
}

impl Ring {
    /// The ring of a loop.
    ///
    /// # Errors
    /// [`NoRing`] if it is not planar.
    pub fn new(axes: &[Axis], closure: &Closure) -> Result<Ring, NoRing> {
        let [out, back] = branches(axes, closure);
        let turns = |joint: &&usize| axes[**joint].kind == JointKind::Revolute;
        let first = out.iter().chain(&back).find(turns).ok_or(NoRing::Empty)?;
        let plane = Plane::new(axes[*first].frame.rotation.column(2).into());
        let [end, other] = [0, 1].map(|side| &closure.ends[side].pose);
        let between = between(&plane, end, other)?;
        let a = &mut super::plane::Numbers(&[]);
        let mut elements = vec![];
        for &joint in &out {
            elements.push(plane.element(axes, joint, 1.0)?);
        }
        elements.extend(cut(&plane, closure)?);
        for &joint in back.iter().rev() {
            let mut element = plane.element(axes, joint, -1.0)?;
            element.motion = match element.motion {
                Moves::Turns(point) => Moves::Turns(between.of(point, a)),
                Moves::Slides(way) => Moves::Slides(between.turn.times(way, a)),
            };
            elements.push(element);
        }
        Ok(Ring {
            elements,
            target: between.inverse(a),
        })
    }

    /// The same ring with its first element last.
    pub fn shifted(mut self) -> Ring {
        if self.elements.is_empty() {
            return self;
        }
        let a = &mut super::plane::Numbers(&[]);
        let back = self.target.inverse(a);
        let mut first = self.elements.remove(0);
        first.motion = match first.motion {
            Moves::Turns(point) => Moves::Turns(back.of(point, a)),
            Moves::Slides(way) => Moves::Slides(back.turn.times(way, a)),
        };
        self.elements.push(first);
        self
    }
}

/// The joints from where two branches part to their ends.
fn branches(axes: &[Axis], closure: &Closure) -> [Vec<usize>; 2] {
    let mut chains = closure.ends.each_ref().map(|end| {
        let mut chain = vec![];
        let mut at = end.carrier;
        while let Some(axis) = at {
            chain.push(axis);
            at = axes[axis].parent;
        }
        chain.reverse();
        chain
    });
    let pairs = chains[0].iter().zip(&chains[1]);
    let common = pairs.take_while(|(a, b)| a == b).count();
    chains.iter_mut().for_each(|chain| {
        chain.drain(..common);
    });
    chains
}

/// The displacement that takes the second end to the first.
fn between(plane: &Plane, end: &Pose, other: &Pose) -> Result<Displacement<f64>, NoRing> {
    let turn = end.rotation * other.rotation.transpose();
    if (turn * plane.normal - plane.normal).norm() > SNAP {
        return Err(NoRing::Tilted(None));
    }
    let apart = plane.normal.dot(&(end.translation - other.translation));
    if apart.abs() > APART {
        return Err(NoRing::Apart(apart.abs()));
    }
    let seen = plane.point(turn * plane.axes[0]);
    let size = seen.re.hypot(seen.im);
    let turn = Complex {
        re: seen.re / size,
        im: seen.im / size,
    };
    let a = &mut super::plane::Numbers(&[]);
    let from = turn.times(plane.point(other.translation), a);
    let shift = plane.point(end.translation).minus(from, a);
    Ok(Displacement { turn, shift })
}

/// The joint that is cut; none where the ends are welded.
fn cut(plane: &Plane, closure: &Closure) -> Result<Option<Element>, NoRing> {
    let pose = &closure.ends[0].pose;
    let z: Vector3<f64> = pose.rotation.column(2).into();
    match closure.motion {
        Motion::Fixed => Ok(None),
        Motion::Prismatic => Err(NoRing::CutSlides),
        Motion::Revolute if z.cross(&plane.normal).norm() > SNAP => Err(NoRing::Tilted(None)),
        Motion::Revolute => Ok(Some(Element {
            joint: None,
            sign: z.dot(&plane.normal).signum(),
            motion: Moves::Turns(plane.point(pose.translation)),
        })),
    }
}

impl Element {
    /// The displacement at the joint's position.
    pub fn moved<A: Algebra>(&self, joint: usize, a: &mut A) -> Displacement<A::Value> {
        match self.motion {
            Moves::Turns(_) => {
                let turn = a.turn(joint);
                self.turned(
                    Complex {
                        im: a.scale(self.sign, turn.im),
                        ..turn
                    },
                    a,
                )
            }
            Moves::Slides(way) => {
                let by = a.position(joint);
                let by = a.scale(self.sign, by);
                let way = way.constant(a);
                Displacement {
                    turn: Displacement::NONE.turn.constant(a),
                    shift: way.scaled(by, a),
                }
            }
        }
    }

    /// The displacement of a turn about its point.
    pub fn turned<A: Algebra>(&self, turn: Complex<A::Value>, a: &mut A) -> Displacement<A::Value> {
        let point = self.point().constant(a);
        let moved = turn.times(point, a);
        Displacement {
            turn,
            shift: point.minus(moved, a),
        }
    }

    /// The point it turns about.
    pub fn point(&self) -> Complex<f64> {
        match self.motion {
            Moves::Turns(point) => point,
            Moves::Slides(_) => Displacement::NONE.shift,
        }
    }
}
