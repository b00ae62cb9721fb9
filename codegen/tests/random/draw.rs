//! Random robots: serial or branched, revolute and prismatic, with right and with arbitrary
//! angles, links on fixed joints and links without inertia between.

use std::f64::consts::{FRAC_PI_2, PI};

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::vector::{Matrix, Vector, of_rpy, product, transposed};

/// A joint together with the link that it carries; `parent` counts links, 0 is the root.
#[derive(Clone, Debug)]
pub struct Joint {
    pub kind: Kind,
    pub parent: usize,
    pub rpy: Vector,
    pub xyz: Vector,
    pub axis: Vector,
    pub inertial: Option<Inertial>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Revolute,
    Prismatic,
    Fixed,
}

/// As in a URDF: about the centre of mass, in the axes of a frame of its own.
#[derive(Clone, Copy, Debug)]
pub struct Inertial {
    pub mass: f64,
    pub xyz: Vector,
    pub rpy: Vector,
    /// Rows of the symmetric matrix.
    pub inertia: Matrix,
}

/// A robot; joint k carries link k + 1.
#[derive(Clone, Debug)]
pub struct Robot {
    pub joints: Vec<Joint>,
    pub gravity: Vector,
}

impl Robot {
    /// Places of the moving joints.
    pub fn moving(&self) -> Vec<usize> {
        let joints = 0..self.joints.len();
        joints
            .filter(|&joint| self.joints[joint].kind != Kind::Fixed)
            .collect()
    }
}

/// A row of a modified Denavit-Hartenberg table; `ant` counts rows from 1, 0 is the base.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub kind: Kind,
    pub ant: usize,
    pub gamma: f64,
    pub b: f64,
    pub alpha: f64,
    pub d: f64,
    pub theta: f64,
    pub r: f64,
}

/// A generator of its own for every case, so that one case can be repeated alone.
pub struct Draw(Pcg64Mcg);

impl Draw {
    pub fn new(case: u64) -> Draw {
        Draw(Pcg64Mcg::seed_from_u64(0x1d1a_0000 + case))
    }

    pub fn unit(&mut self) -> f64 {
        self.0.random_range(-1.0..1.0)
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.0.random_bool(probability)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.0.next_u64() % count as u64) as usize
    }

    /// A right angle more often than not.
    fn angle(&mut self) -> f64 {
        match self.below(8) {
            0 | 1 => 0.0,
            2 => FRAC_PI_2,
            3 => -FRAC_PI_2,
            4 => PI,
            _ => PI * self.unit(),
        }
    }

    fn length(&mut self) -> f64 {
        match self.chance(0.4) {
            true => 0.0,
            false => 0.6 * self.unit(),
        }
    }

    fn vector(&mut self, mut one: impl FnMut(&mut Draw) -> f64) -> Vector {
        [one(self), one(self), one(self)]
    }

    fn axis(&mut self) -> Vector {
        let sign = if self.chance(0.3) { -1.0 } else { 1.0 };
        match self.below(5) {
            0 => [sign, 0.0, 0.0],
            1 => [0.0, sign, 0.0],
            2 | 3 => [0.0, 0.0, sign],
            _ => loop {
                let axis = self.vector(Draw::unit);
                let norm = super::vector::dot(axis, axis).sqrt();
                if (0.3..1.0).contains(&norm) {
                    break axis.map(|x| x / norm);
                }
            },
        }
    }

    fn kind(&mut self) -> Kind {
        match self.chance(0.75) {
            true => Kind::Revolute,
            false => Kind::Prismatic,
        }
    }

    /// A body that can exist: its principal moments are those of an ellipsoid.
    fn inertial(&mut self) -> Inertial {
        let mass = 0.2 + 4.0 * self.unit().abs();
        let [a, b, c] = self.vector(|draw| 0.05 + 0.3 * draw.unit().abs());
        let [a, b, c] = [a * a, b * b, c * c].map(|square| mass * square / 5.0);
        let principal = [[b + c, 0.0, 0.0], [0.0, a + c, 0.0], [0.0, 0.0, a + b]];
        let turn = of_rpy(self.vector(|draw| PI * draw.unit()));
        Inertial {
            mass,
            xyz: self.vector(Draw::length),
            rpy: self.vector(Draw::angle),
            inertia: product(turn, product(principal, transposed(turn))),
        }
    }

    fn joint(&mut self, kind: Kind, parent: usize) -> Joint {
        let bare = match kind {
            Kind::Fixed => 0.4,
            _ => 0.0,
        };
        Joint {
            kind,
            parent,
            rpy: self.vector(Draw::angle),
            xyz: self.vector(Draw::length),
            axis: self.axis(),
            inertial: (!self.chance(bare)).then(|| self.inertial()),
        }
    }

    /// A robot of 2 to 8 moving joints, small ones more often; every third is branched, every
    /// fourth has fixed joints between.
    pub fn robot(&mut self) -> Robot {
        let count = self.count();
        let (branched, mounted) = (self.chance(0.33), self.chance(0.25));
        let mut joints: Vec<Joint> = Vec::new();
        for _ in 0..count {
            let mut parent = match branched && self.chance(0.5) {
                true => self.below(joints.len() + 1),
                false => joints.len(),
            };
            if mounted && self.chance(0.4) {
                joints.push(self.joint(Kind::Fixed, parent));
                parent = joints.len();
            }
            let kind = self.kind();
            joints.push(self.joint(kind, parent));
        }
        if mounted {
            joints.push(self.joint(Kind::Fixed, joints.len()));
        }
        Robot {
            joints,
            gravity: match self.chance(0.7) {
                true => [0.0, 0.0, -9.81],
                false => self.vector(|draw| 9.81 * draw.unit()),
            },
        }
    }

    /// The same with a last axis that is tilted a little against the one before, by 10 to 40 mrad.
    pub fn tilted(&mut self) -> Robot {
        let mut robot = self.robot();
        robot.joints.retain(|joint| joint.kind != Kind::Fixed);
        for (index, joint) in robot.joints.iter_mut().enumerate() {
            joint.parent = index;
        }
        if let [.., before, last] = &mut robot.joints[..] {
            before.axis = [0.0, 0.0, 1.0];
            last.axis = [0.0, 0.0, self.unit().signum()];
            last.rpy = [0.01 + 0.03 * self.unit().abs(), 0.0, PI * self.unit()];
        }
        robot
    }

    fn count(&mut self) -> usize {
        let (a, b) = (self.below(7), self.below(7));
        2 + a.min(b)
    }

    /// A table of 2 to 8 rows. Antecedents are those of a walk that finishes one branch before the
    /// next, which is the order in which a URDF is walked.
    pub fn table(&mut self) -> Vec<Row> {
        let count = self.count();
        let branched = self.chance(0.4);
        let mut rows: Vec<Row> = Vec::new();
        for index in 0..count {
            let mut ant = index;
            while branched && ant > 0 && self.chance(0.3) {
                ant = rows[ant - 1].ant;
            }
            // gamma and b are needed where a frame has a second child.
            let second = rows.iter().any(|row| row.ant == ant);
            rows.push(Row {
                kind: self.kind(),
                ant,
                gamma: if second { self.angle() } else { 0.0 },
                b: if second { self.length() } else { 0.0 },
                alpha: self.angle(),
                d: self.length(),
                theta: self.angle(),
                r: self.length(),
            });
        }
        rows
    }
}
