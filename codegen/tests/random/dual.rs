//! The graph read with dual numbers: values and their exact derivatives in time.

use std::ops::{Add, Mul, Neg, Sub};

use idim_codegen::expr::{Expr, Function, Graph, Input, Node};

/// A value and its derivative in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual(pub f64, pub f64);

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        Dual(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual(self.0 * other.0, self.0 * other.1 + self.1 * other.0)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0, -self.1)
    }
}

/// Values of all nodes at a state; accelerations are taken as constant.
pub struct Values(Vec<Dual>);

impl Values {
    pub fn at(graph: &Graph, q: &[f64], qd: &[f64], qdd: &[f64]) -> Values {
        let mut values = Values(Vec::with_capacity(graph.nodes().len()));
        for node in graph.nodes() {
            let value = match *node {
                Node::Constant(bits) => Dual(f64::from_bits(bits), 0.0),
                Node::Input(Input::Q(joint)) => Dual(q[joint], qd[joint]),
                Node::Input(Input::Qd(joint)) => Dual(qd[joint], qdd[joint]),
                Node::Input(Input::Qdd(joint)) => Dual(qdd[joint], 0.0),
                Node::Input(Input::Slip(joint)) => Dual(qd[joint].signum(), 0.0),
                Node::Input(Input::Parameter(_)) => Dual(0.0, 0.0),
                Node::Sin(index) => sin_cos(graph, index, q, qd).0,
                Node::Cos(index) => sin_cos(graph, index, q, qd).1,
                Node::Add(a, b) => values.of(a) + values.of(b),
                Node::Sub(a, b) => values.of(a) - values.of(b),
                Node::Mul(a, b) => values.of(a) * values.of(b),
                Node::Call(Function::Abs, a) => {
                    let Dual(x, rate) = values.of(a);
                    Dual(x.abs(), x.signum() * rate)
                }
                Node::Call(Function::Sign, a) => Dual(values.of(a).0.signum(), 0.0),
                Node::Call(function, _) => panic!("{function:?} has no derivative here"),
            };
            values.0.push(value);
        }
        values
    }

    pub fn of(&self, x: Expr) -> Dual {
        match x.is_negative() {
            true => -self.0[x.node()],
            false => self.0[x.node()],
        }
    }
}

fn sin_cos(graph: &Graph, index: usize, q: &[f64], qd: &[f64]) -> (Dual, Dual) {
    let angle = graph.angle(index);
    let (mut value, mut rate) = (angle.offset.value(), 0.0);
    for &(joint, sign) in &angle.terms {
        value += sign * q[joint];
        rate += sign * qd[joint];
    }
    let (s, c) = value.sin_cos();
    (Dual(s, c * rate), Dual(c, -s * rate))
}
