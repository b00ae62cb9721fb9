//! The motion of every link in its own frame, and the screws of the joints that move it.

use crate::expr::rotate::Rotator;
use crate::expr::{Angle, Expr, Graph};
use crate::mechanism::{Joint, JointKind, Mechanism};

use super::closed::{self, Closed};
use super::coordinate::Coordinate;
use super::vector::{AXES, Screw, Vec3, add, constant, cross, into_frame, zero};

/// The motion of a link, components in its frame, about the origin of its frame.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Angular velocity, rad/s.
    pub w: Vec3,
    /// Angular acceleration, rad/s^2.
    pub wd: Vec3,
    /// Acceleration of the origin minus gravity, m/s^2.
    pub a: Vec3,
    /// U = [wd]x + [w]x[w]x, row by row: the acceleration of a point p is a + U p.
    pub u: [Vec3; 3],
    /// Velocity of the origin, m/s.
    pub v: Vec3,
    /// Gravity, m/s^2.
    pub g: Vec3,
    /// Potential of the origin per unit mass, m^2/s^2.
    pub potential: Expr,
}

/// A driven joint that moves a link, itself and through the joints that follow it: its screw and
/// the rate of that screw, in the frame of the link.
#[derive(Clone, Copy, Debug)]
pub struct Mover {
    /// The driven joint.
    pub joint: usize,
    /// Twist of the link per unit velocity of the joint.
    pub screw: Screw,
    /// V x S, so that dE/dq_j = <rate, momentum> (screw rates vanish in the joint's own frame
    /// except through the motion of that frame).
    pub rate: Screw,
}

/// The motions of the links, from the base outwards.
#[derive(Clone, Debug, Default)]
pub struct Motions {
    /// Per link.
    pub links: Vec<Motion>,
    /// Per link, the driven joints that move it.
    pub movers: Vec<Vec<Mover>>,
    /// What was turned by which angle so far.
    pub rotator: Rotator,
    /// The joints that closed loops move.
    pub solved: Vec<[Closed; 3]>,
}

impl Motions {
    /// Room for every link; each stands still until it is pushed.
    pub fn new(graph: &mut Graph, mechanism: &Mechanism) -> Motions {
        let count = mechanism.joints.len();
        Motions {
            links: vec![still(graph); count],
            movers: vec![vec![]; count],
            rotator: Rotator::default(),
            solved: closed::solved(graph, mechanism),
        }
    }

    /// Computes the motion of a link from that of its antecedent, which comes first.
    pub fn push(&mut self, graph: &mut Graph, mechanism: &Mechanism, index: usize) {
        let joint = &mechanism.joints[index];
        let mut step = Step {
            graph,
            rotator: &mut self.rotator,
            joint,
            index,
            coordinate: Coordinate::of(mechanism, &self.solved, index),
        };
        let parent = match joint.parent {
            Some(parent) => self.links[parent],
            None => step.base(),
        };
        step.name_constants();
        let motion = step.motion(&parent);
        let above = joint.parent.map_or(&[][..], |parent| &self.movers[parent]);
        let movers = step.movers(above, &motion);
        self.links[index] = motion;
        self.movers[index] = movers;
    }
}

/// The step from an antecedent's frame to the frame of one joint.
struct Step<'a> {
    graph: &'a mut Graph,
    rotator: &'a mut Rotator,
    joint: &'a Joint,
    index: usize,
    coordinate: Coordinate,
}

impl Step<'_> {
    /// The lengths of the step by their Denavit-Hartenberg names where they have one.
    fn name_constants(&mut self) {
        let number = self.index + 1;
        let right = self.joint.gamma.is_zero();
        for (axis, &value) in self.joint.position.iter().enumerate() {
            let name = match axis {
                0 if right => format!("d{number}"),
                _ if right => format!("r{number}"),
                _ => format!("p{number}{}", AXES[axis]),
            };
            let constant = self.graph.constant(value.abs());
            self.graph.name(constant, &name);
        }
        for value in self.joint.gravity.unwrap_or_default() {
            let constant = self.graph.constant(value.abs());
            self.graph.name(constant, "gravity");
        }
    }

    fn base(&mut self) -> Motion {
        let g = constant(self.graph, self.joint.gravity.unwrap_or_default());
        Motion {
            a: g.map(|x| -x),
            g,
            ..still(self.graph)
        }
    }

    fn motion(&mut self, parent: &Motion) -> Motion {
        let p = constant(self.graph, self.joint.position);
        let turned = Motion {
            w: self.turn(parent.w),
            wd: self.turn(parent.wd),
            a: {
                let up = parent.u.map(|row| super::vector::dot(self.graph, row, p));
                let moved = add(self.graph, parent.a, up);
                self.turn(moved)
            },
            v: {
                let wp = cross(self.graph, parent.w, p);
                let moved = add(self.graph, parent.v, wp);
                self.turn(moved)
            },
            g: self.turn(parent.g),
            potential: {
                let gp = super::vector::dot(self.graph, parent.g, p);
                self.graph.sub(parent.potential, gp)
            },
            u: parent.u,
        };
        match self.joint.kind {
            JointKind::Revolute => self.revolute(turned),
            JointKind::Prismatic => self.prismatic(turned),
        }
    }

    fn revolute(&mut self, mut m: Motion) -> Motion {
        let qd = self.coordinate.velocity(self.graph);
        let qdd = self.coordinate.acceleration(self.graph);
        let wyqd = self.graph.mul(m.w[1], qd);
        let wxqd = self.graph.mul(m.w[0], qd);
        m.wd = add(self.graph, m.wd, [wyqd, -wxqd, qdd]);
        m.w[2] = self.graph.add(m.w[2], qd);
        m.u = u(self.graph, m.w, m.wd);
        m
    }

    fn prismatic(&mut self, mut m: Motion) -> Motion {
        let q = self.coordinate.position(self.graph);
        let qd = self.coordinate.velocity(self.graph);
        let qdd = self.coordinate.acceleration(self.graph);
        m.u = u(self.graph, m.w, m.wd);
        // Acceleration of the sliding origin: U (0, 0, q) + 2 w x (0, 0, qd) + (0, 0, qdd).
        let zero = self.graph.zero();
        let slid = m.u.map(|row| self.graph.mul(row[2], q));
        let twice = self.graph.scale(2.0, qd);
        let coriolis = cross(self.graph, m.w, [zero, zero, twice]);
        m.a = add(self.graph, m.a, slid);
        m.a = add(self.graph, m.a, coriolis);
        m.a[2] = self.graph.add(m.a[2], qdd);
        let swept = cross(self.graph, m.w, [zero, zero, q]);
        m.v = add(self.graph, m.v, swept);
        m.v[2] = self.graph.add(m.v[2], qd);
        let fallen = self.graph.mul(m.g[2], q);
        m.potential = self.graph.sub(m.potential, fallen);
        m
    }

    fn movers(&mut self, above: &[Mover], motion: &Motion) -> Vec<Mover> {
        let mut movers: Vec<Mover> = above
            .iter()
            .map(|mover| Mover {
                joint: mover.joint,
                screw: self.carry(&mover.screw),
                rate: self.carry(&mover.rate),
            })
            .collect();
        let (screw, rate) = self.own(motion);
        for share in self.coordinate.shares(self.graph) {
            // The rate of G S is G dS/dt + dG/dt S.
            let swept = screw.times(self.graph, share.rate);
            let screw = screw.times(self.graph, share.ratio);
            let rate = rate.times(self.graph, share.ratio);
            let rate = rate.plus(self.graph, &swept);
            match movers.iter_mut().find(|mover| mover.joint == share.joint) {
                Some(mover) => {
                    mover.screw = mover.screw.plus(self.graph, &screw);
                    mover.rate = mover.rate.plus(self.graph, &rate);
                }
                None => movers.push(Mover {
                    joint: share.joint,
                    screw,
                    rate,
                }),
            }
        }
        movers
    }

    /// The joint's own screw and its rate ((wy, -wx, 0), (vy, -vx, 0)).
    fn own(&mut self, m: &Motion) -> (Screw, Screw) {
        let (none, one) = (self.graph.zero(), self.graph.one());
        let z = [none, none, one];
        let still = zero(self.graph);
        let turning = [m.w[1], -m.w[0], none];
        match self.joint.kind {
            JointKind::Revolute => (
                Screw {
                    angular: z,
                    linear: still,
                },
                Screw {
                    angular: turning,
                    linear: [m.v[1], -m.v[0], none],
                },
            ),
            JointKind::Prismatic => (
                Screw {
                    angular: still,
                    linear: z,
                },
                Screw {
                    angular: still,
                    linear: turning,
                },
            ),
        }
    }

    /// A motion screw of the antecedent's frame in this one.
    fn carry(&mut self, screw: &Screw) -> Screw {
        let p = constant(self.graph, self.joint.position);
        let swept = cross(self.graph, screw.angular, p);
        let moved = add(self.graph, screw.linear, swept);
        let angular = self.turn(screw.angular);
        let mut linear = self.turn(moved);
        if self.joint.kind == JointKind::Prismatic {
            let zero = self.graph.zero();
            let q = self.coordinate.position(self.graph);
            let slid = cross(self.graph, angular, [zero, zero, q]);
            linear = add(self.graph, linear, slid);
        }
        Screw { angular, linear }
    }

    fn turn(&mut self, vector: Vec3) -> Vec3 {
        let (gamma, alpha): (Angle, Angle) = (self.joint.gamma, self.joint.alpha);
        let theta = self.coordinate.angle(self.joint);
        into_frame(self.graph, self.rotator, vector, (gamma, alpha, &theta))
    }
}

/// A link that does not move, without gravity.
fn still(graph: &Graph) -> Motion {
    let none = zero(graph);
    Motion {
        w: none,
        wd: none,
        a: none,
        u: [none; 3],
        v: none,
        g: none,
        potential: graph.zero(),
    }
}

/// U = [wd]x + [w]x[w]x.
fn u(graph: &mut Graph, w: Vec3, wd: Vec3) -> [Vec3; 3] {
    let mut product = |i: usize, j: usize| graph.mul(w[i], w[j]);
    let (xx, yy, zz) = (product(0, 0), product(1, 1), product(2, 2));
    let (xy, xz, yz) = (product(0, 1), product(0, 2), product(1, 2));
    [
        [
            -graph.add(yy, zz),
            graph.sub(xy, wd[2]),
            graph.add(xz, wd[1]),
        ],
        [
            graph.add(xy, wd[2]),
            -graph.add(xx, zz),
            graph.sub(yz, wd[0]),
        ],
        [
            graph.sub(xz, wd[1]),
            graph.add(yz, wd[0]),
            -graph.add(xx, yy),
        ],
    ]
}
