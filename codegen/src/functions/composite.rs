//! A rigid body of symbols: inertia about the origin of a frame, first moments, mass.

use crate::derive::coordinate::Coordinate;
use crate::expr::rotate::Turn;
use crate::expr::{Angle, Expr, Graph};
use crate::mechanism::{JointKind, Mechanism};

use crate::derive::motion::Motions;
use crate::derive::vector::{AXES, Screw, Vec3, add, constant, dot, out_of_frame};

/// A body in the frame of a link.
#[derive(Clone, Copy, Debug)]
pub struct Composite {
    /// The symmetric inertia, kg m^2.
    inertia: [Vec3; 3],
    /// First moments, kg m.
    moment: Vec3,
    /// Mass, kg.
    mass: Expr,
}

impl Composite {
    /// From XX XY XZ YY YZ ZZ MX MY MZ M.
    pub fn new(values: &[Expr; 10]) -> Composite {
        let &[xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = values;
        Composite {
            inertia: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
            moment: [mx, my, mz],
            mass,
        }
    }

    /// Two bodies as one.
    pub fn plus(&self, graph: &mut Graph, other: &Composite) -> Composite {
        let mut inertia = self.inertia;
        for (row, own) in inertia.iter_mut().enumerate() {
            *own = add(graph, *own, other.inertia[row]);
        }
        Composite {
            inertia,
            moment: add(graph, self.moment, other.moment),
            mass: graph.add(self.mass, other.mass),
        }
    }

    /// Momentum at unit velocity of the joint whose frame this is.
    pub fn momentum(&self, graph: &Graph, kind: JointKind) -> Screw {
        let [mx, my, _] = self.moment;
        let none = graph.zero();
        match kind {
            JointKind::Revolute => Screw {
                angular: self.inertia.map(|row| row[2]),
                linear: [-my, mx, none],
            },
            JointKind::Prismatic => Screw {
                angular: [my, -mx, none],
                linear: [none, none, self.mass],
            },
        }
    }

    /// The body in the frame of the antecedent of a joint that carries it.
    pub fn back(
        &self,
        graph: &mut Graph,
        mechanism: &Mechanism,
        motions: &mut Motions,
        index: usize,
    ) -> Composite {
        let joint = &mechanism.joints[index];
        let mut body = *self;
        let coordinate = Coordinate::of(mechanism, &motions.solved, index);
        let theta = coordinate.angle(joint);
        if joint.kind == JointKind::Prismatic {
            let (none, q) = (graph.zero(), coordinate.position(graph));
            body = body.moved(graph, [none, none, q]);
        }
        let angles = (joint.gamma, joint.alpha, &theta);
        body.moment = out_of_frame(graph, &mut motions.rotator, body.moment, angles);
        body.inertia = turned(graph, body.inertia, 2, &theta);
        body.inertia = turned(graph, body.inertia, 0, &Turn::constant(joint.alpha));
        body.inertia = turned(graph, body.inertia, 2, &Turn::constant(joint.gamma));
        let position = constant(graph, joint.position);
        body.moved(graph, position)
    }

    /// The body about an origin from which its own lies at `p` (parallel-axis theorem).
    fn moved(&self, graph: &mut Graph, p: Vec3) -> Composite {
        let shift = p.map(|x| graph.mul(self.mass, x));
        let half = shift.map(|x| graph.scale(0.5, x));
        let h = add(graph, self.moment, half);
        let hp = dot(graph, h, p);
        let mut inertia = self.inertia;
        for i in 0..3 {
            for j in i..3 {
                let (ij, ji) = (graph.mul(h[i], p[j]), graph.mul(h[j], p[i]));
                let sum = graph.add(ij, ji);
                let own = graph.sub(inertia[i][j], sum);
                let twice = graph.scale(2.0, hp);
                inertia[i][j] = if i == j { graph.add(own, twice) } else { own };
                inertia[j][i] = inertia[i][j];
            }
        }
        Composite {
            inertia,
            moment: add(graph, self.moment, shift),
            mass: self.mass,
        }
    }

    /// `jj3xy`, `mm3x`, `m3`: link 3 with all links behind it.
    pub fn name(&self, graph: &mut Graph, link: usize) {
        let k = link + 1;
        for (i, first) in AXES.iter().enumerate() {
            for (j, second) in AXES.iter().enumerate().skip(i) {
                graph.name(self.inertia[i][j], &format!("jj{k}{first}{second}"));
            }
            graph.name(self.moment[i], &format!("mm{k}{first}"));
        }
        graph.name(self.mass, &format!("m{k}"));
    }
}

/// R J R^T of a turn by an angle about an axis.
fn turned(graph: &mut Graph, inertia: [Vec3; 3], axis: usize, angle: &Turn) -> [Vec3; 3] {
    if *angle == Turn::constant(Angle::ZERO) {
        return inertia;
    }
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (s, c) = angle.sin_cos(graph);
    // (c x - s y, s x + c y)
    let mut turn = |x: Expr, y: Expr| {
        let (cx, sy) = (graph.mul(c, x), graph.mul(s, y));
        let (sx, cy) = (graph.mul(s, x), graph.mul(c, y));
        (graph.sub(cx, sy), graph.add(sx, cy))
    };
    let (ii, ij, jj) = (inertia[i][i], inertia[i][j], inertia[j][j]);
    let (ik, jk) = turn(inertia[i][axis], inertia[j][axis]);
    let (first, second) = (turn(ii, ij).0, turn(ij, jj).0);
    let (new_ii, new_ij) = turn(first, second);
    let trace = graph.add(ii, jj);
    let mut out = inertia;
    out[i][i] = new_ii;
    out[j][j] = graph.sub(trace, new_ii);
    for (a, b, value) in [(i, j, new_ij), (i, axis, ik), (j, axis, jk)] {
        out[a][b] = value;
        out[b][a] = value;
    }
    out
}
