//! From the graph to steps: registers are assigned while walking the order.

use super::{Op, Place, Step};
use crate::expr::graph::{Expr, Graph, Node};
use crate::expr::schedule::{operands, uses};

/// Assigns registers while walking the order.
pub(super) struct Assembler<'a> {
    graph: &'a Graph,
    remaining: Vec<usize>,
    stores: Vec<Vec<(usize, f64)>>,
    place: Vec<usize>,
    /// The nodes of each angle's sine and cosine.
    pairs: Vec<[usize; 2]>,
    /// The products that are computed together with the one sum they enter.
    fused: Vec<bool>,
    free: Vec<usize>,
    pub(super) registers: usize,
    pub(super) steps: Vec<Step>,
}

impl<'a> Assembler<'a> {
    pub(super) fn new(graph: &'a Graph, outputs: &[Expr], fused: Vec<bool>) -> Self {
        let count = graph.nodes().len();
        let mut stores = vec![Vec::new(); count];
        for (index, output) in outputs.iter().enumerate() {
            let sign = if output.is_negative() { -1.0 } else { 1.0 };
            stores[output.node()].push((index, sign));
        }
        let mut pairs = vec![[0; 2]; graph.angle_count()];
        for (index, node) in graph.nodes().iter().enumerate() {
            match *node {
                Node::Sin(angle) => pairs[angle][0] = index,
                Node::Cos(angle) => pairs[angle][1] = index,
                _ => {}
            }
        }
        let remaining = uses(graph, outputs);
        Assembler {
            graph,
            fused,
            remaining,
            stores,
            place: vec![usize::MAX; count],
            pairs,
            free: Vec::new(),
            registers: 0,
            steps: Vec::new(),
        }
    }

    pub(super) fn compute(&mut self, index: usize) {
        match self.graph.nodes()[index] {
            Node::Sin(angle) | Node::Cos(angle) => self.sin_cos(angle, index),
            Node::Constant(bits) => self.push(index, Op::Constant(f64::from_bits(bits))),
            Node::Input(input) => self.push(index, Op::Input(input)),
            Node::Add(a, b) => self.push(index, self.sum(a, b)),
            Node::Sub(a, b) => self.push(index, self.difference(a, b)),
            Node::Mul(..) if self.fused[index] => {}
            Node::Mul(a, b) => self.push(index, Op::Mul(self.at(a), self.at(b))),
            Node::Call(function, a) => self.push(index, Op::Call(function, self.at(a))),
        }
        for (output, sign) in std::mem::take(&mut self.stores[index]) {
            self.release(index);
            self.store(index, output, sign);
        }
    }

    /// Stores a value as soon as it is computed, in the same step if that can be.
    fn store(&mut self, index: usize, output: usize, sign: f64) {
        let target = self.place[index];
        let kept = self.remaining[index] > 0;
        let place = Place { output, sign, kept };
        match self.steps.last_mut() {
            Some(step)
                if step.target == target && step.op.is_arithmetic() && step.output.is_none() =>
            {
                step.output = Some(place);
            }
            _ => self.push_step(Op::Store(place), target),
        }
    }

    fn push_step(&mut self, op: Op, target: usize) {
        self.steps.push(Step {
            op,
            target,
            output: None,
        });
    }

    fn at(&self, expr: Expr) -> usize {
        self.place[expr.node()]
    }

    fn sum(&self, a: Expr, b: Expr) -> Op {
        match (self.product(a), self.product(b)) {
            (Some((x, y)), _) => Op::MulAdd(x, y, self.at(b)),
            (_, Some((x, y))) => Op::MulAdd(x, y, self.at(a)),
            _ => Op::Add(self.at(a), self.at(b)),
        }
    }

    fn difference(&self, a: Expr, b: Expr) -> Op {
        match (self.product(a), self.product(b)) {
            (Some((x, y)), _) => Op::MulSub(x, y, self.at(b)),
            (_, Some((x, y))) => Op::SubMul(x, y, self.at(a)),
            _ => Op::Sub(self.at(a), self.at(b)),
        }
    }

    /// The factors of a product that is computed together with the sum it enters.
    fn product(&self, expr: Expr) -> Option<(usize, usize)> {
        match self.graph.nodes()[expr.node()] {
            Node::Mul(a, b) if self.fused[expr.node()] => Some((self.at(a), self.at(b))),
            _ => None,
        }
    }

    fn push(&mut self, index: usize, op: Op) {
        // A step reads its operands before it writes, so the target may be one of them.
        for operand in operands(self.graph.nodes()[index]) {
            match self.fused[operand.node()] {
                true => operands(self.graph.nodes()[operand.node()])
                    .for_each(|factor| self.release(factor.node())),
                false => self.release(operand.node()),
            }
        }
        let target = self.register(index);
        self.push_step(op, target);
    }

    /// Sine and cosine cost little more than one of them: the other one waits in its register.
    fn sin_cos(&mut self, angle: usize, index: usize) {
        if self.place[index] != usize::MAX {
            return;
        }
        let pair = self.pairs[angle];
        let [target, cosine] = pair.map(|index| self.register(index));
        let op = Op::SinCos(angle, cosine);
        self.push_step(op, target);
        let unused = pair.into_iter().filter(|&index| self.remaining[index] == 0);
        self.free.extend(unused.map(|index| self.place[index]));
    }

    fn register(&mut self, index: usize) -> usize {
        let register = self.free.pop().unwrap_or_else(|| {
            self.registers += 1;
            self.registers - 1
        });
        self.place[index] = register;
        register
    }

    fn release(&mut self, index: usize) {
        self.remaining[index] -= 1;
        if self.remaining[index] == 0 {
            self.free.push(self.place[index]);
        }
    }

    pub(super) fn angles(&self) -> Vec<(Vec<(usize, f64)>, f64)> {
        (0..self.graph.angle_count())
            .map(|index| {
                let angle = self.graph.angle(index);
                (angle.terms.clone(), angle.offset.value())
            })
            .collect()
    }
}
