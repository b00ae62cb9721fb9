//! The graph as a tape that runs on batches: the interpreter, and the numbers behind the rank.
//!
//! A tape computes a set of outputs for many states at once. Values of [`WIDTH`] states live side
//! by side in a register; registers are reused as soon as their last reader is done, so the
//! working set stays in cache. Sines and cosines are those of the lanes that emitted code runs on,
//! and every operation is grouped as there: both readers of the graph give the same bits.

use wide::f64x4;

use super::graph::{Expr, Function, Graph, Input, Node};
use super::schedule::{operands, order};

/// States per register: long enough to amortise the dispatch, short enough for the cache.
pub const WIDTH: usize = 64;

type Register = [f64; WIDTH];

#[derive(Clone, Copy, Debug)]
enum Op {
    Constant(f64),
    Input(Input),
    Sin(usize),
    Cos(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Call(Function, usize),
    /// Stores `sign * register` as output `index`.
    Store(usize, usize, f64),
}

#[derive(Clone, Copy, Debug)]
struct Step {
    op: Op,
    target: usize,
}

/// A compiled set of outputs.
#[derive(Clone, Debug)]
pub struct Tape {
    steps: Vec<Step>,
    angles: Vec<(Vec<(usize, f64)>, f64)>,
    registers: usize,
    outputs: usize,
}

/// States to run on, structure of arrays: joint `j` at sample `i` is `q[j * len + i]`.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    /// Samples.
    pub len: usize,
    /// Positions.
    pub q: &'a [f64],
    /// Velocities.
    pub qd: &'a [f64],
    /// Accelerations.
    pub qdd: &'a [f64],
    /// Presliding states; empty for those of sliding, the signs of the velocities.
    pub slip: &'a [f64],
}

impl Tape {
    /// Compiles the outputs in the order given.
    pub fn new(graph: &Graph, outputs: &[Expr]) -> Tape {
        let mut assembler = Assembler::new(graph, outputs);
        for index in order(graph, outputs) {
            assembler.compute(index);
        }
        let angles = assembler.angles();
        Tape {
            steps: assembler.steps,
            angles,
            registers: assembler.registers,
            outputs: outputs.len(),
        }
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Runs the tape: output `k` at sample `i` goes to `out[k * batch.len + i]`.
    pub fn run(&self, batch: &Batch<'_>, out: &mut [f64]) {
        let mut registers = vec![[0.0; WIDTH]; self.registers];
        let mut start = 0;
        while start < batch.len {
            let width = WIDTH.min(batch.len - start);
            for step in &self.steps {
                self.step(step, batch, start, width, &mut registers, out);
            }
            start += width;
        }
    }

    fn step(
        &self,
        step: &Step,
        batch: &Batch<'_>,
        start: usize,
        width: usize,
        registers: &mut [Register],
        out: &mut [f64],
    ) {
        let value = match step.op {
            Op::Constant(value) => [value; WIDTH],
            Op::Input(input) => read(batch, input, start, width),
            Op::Sin(angle) => lanes(self.angle(batch, angle, start, width), width, f64x4::sin),
            Op::Cos(angle) => lanes(self.angle(batch, angle, start, width), width, f64x4::cos),
            Op::Add(a, b) => zip(&registers[a], &registers[b], width, |x, y| x + y),
            Op::Sub(a, b) => zip(&registers[a], &registers[b], width, |x, y| x - y),
            Op::Mul(a, b) => zip(&registers[a], &registers[b], width, |x, y| x * y),
            Op::Call(Function::Sine, a) => lanes(registers[a], width, f64x4::sin),
            Op::Call(Function::Cosine, a) => lanes(registers[a], width, f64x4::cos),
            Op::Call(function, a) => registers[a].map(|x| call(function, x)),
            Op::Store(a, output, sign) => {
                let place = &mut out[output * batch.len + start..][..width];
                for (to, from) in place.iter_mut().zip(&registers[a]) {
                    *to = sign * from;
                }
                return;
            }
        };
        registers[step.target] = value;
    }

    fn angle(&self, batch: &Batch<'_>, index: usize, start: usize, width: usize) -> Register {
        let (terms, offset) = &self.angles[index];
        let mut sum = [0.0; WIDTH];
        for (place, &(joint, sign)) in terms.iter().enumerate() {
            let q = read(batch, Input::Q(joint), start, width);
            sum = zip(&sum, &q, width, |s, q| {
                if place == 0 { sign * q } else { s + sign * q }
            });
        }
        match *offset {
            0.0 => sum,
            offset => sum.map(|sum| sum + offset),
        }
    }
}

fn read(batch: &Batch<'_>, input: Input, start: usize, width: usize) -> Register {
    let (series, joint) = match input {
        Input::Q(joint) => (batch.q, joint),
        Input::Qd(joint) => (batch.qd, joint),
        Input::Qdd(joint) => (batch.qdd, joint),
        Input::Slip(joint) if batch.slip.is_empty() => {
            return read(batch, Input::Qd(joint), start, width).map(|qd| call(Function::Sign, qd));
        }
        Input::Slip(joint) => (batch.slip, joint),
    };
    let mut register = [0.0; WIDTH];
    register[..width].copy_from_slice(&series[joint * batch.len + start..][..width]);
    register
}

/// The first `width` values of two registers, pair by pair: a single state costs one operation,
/// not a register full of them.
#[inline(always)]
fn zip(a: &Register, b: &Register, width: usize, f: impl Fn(f64, f64) -> f64) -> Register {
    // Whole registers, of a length known beforehand, run through the vector units.
    if width == WIDTH {
        return std::array::from_fn(|i| f(a[i], b[i]));
    }
    let mut out = [0.0; WIDTH];
    for ((out, a), b) in out.iter_mut().zip(a).zip(b).take(width) {
        *out = f(*a, *b);
    }
    out
}

/// A function of four lanes at a time.
fn lanes(register: Register, width: usize, f: impl Fn(f64x4) -> f64x4) -> Register {
    let mut out = register;
    for four in out.chunks_exact_mut(4).take(width.div_ceil(4)) {
        if let Ok(values) = <[f64; 4]>::try_from(&*four) {
            four.copy_from_slice(&f(f64x4::from(values)).to_array());
        }
    }
    out
}

fn call(function: Function, x: f64) -> f64 {
    match function {
        Function::Sign if x > 0.0 => 1.0,
        Function::Sign if x < 0.0 => -1.0,
        Function::Sign => 0.0 * x,
        Function::Abs => x.abs(),
        Function::Tanh => x.tanh(),
        Function::Bell => (-x * x).exp(),
        Function::Power(p) => x.abs().powf(f64::from_bits(p)),
        Function::Sine => x.sin(),
        Function::Cosine => x.cos(),
    }
}

/// Assigns registers while walking the order.
struct Assembler<'a> {
    graph: &'a Graph,
    remaining: Vec<usize>,
    stores: Vec<Vec<(usize, f64)>>,
    place: Vec<usize>,
    free: Vec<usize>,
    registers: usize,
    steps: Vec<Step>,
}

impl<'a> Assembler<'a> {
    fn new(graph: &'a Graph, outputs: &[Expr]) -> Self {
        let count = graph.nodes().len();
        let mut stores = vec![Vec::new(); count];
        for (index, output) in outputs.iter().enumerate() {
            let sign = if output.is_negative() { -1.0 } else { 1.0 };
            stores[output.node()].push((index, sign));
        }
        Assembler {
            graph,
            remaining: super::schedule::uses(graph, outputs),
            stores,
            place: vec![usize::MAX; count],
            free: Vec::new(),
            registers: 0,
            steps: Vec::new(),
        }
    }

    fn compute(&mut self, index: usize) {
        let node = self.graph.nodes()[index];
        let place = |expr: Expr| self.place[expr.node()];
        let op = match node {
            Node::Constant(bits) => Op::Constant(f64::from_bits(bits)),
            Node::Input(input) => Op::Input(input),
            Node::Sin(angle) => Op::Sin(angle),
            Node::Cos(angle) => Op::Cos(angle),
            Node::Add(a, b) => Op::Add(place(a), place(b)),
            Node::Sub(a, b) => Op::Sub(place(a), place(b)),
            Node::Mul(a, b) => Op::Mul(place(a), place(b)),
            Node::Call(function, a) => Op::Call(function, place(a)),
        };
        // A step reads its operands before it writes, so the target may be one of them.
        for operand in operands(node) {
            self.release(operand.node());
        }
        let target = self.free.pop().unwrap_or_else(|| {
            self.registers += 1;
            self.registers - 1
        });
        self.place[index] = target;
        self.steps.push(Step { op, target });
        for (output, sign) in std::mem::take(&mut self.stores[index]) {
            self.steps.push(Step {
                op: Op::Store(target, output, sign),
                target,
            });
            self.release(index);
        }
    }

    fn release(&mut self, index: usize) {
        self.remaining[index] -= 1;
        if self.remaining[index] == 0 {
            self.free.push(self.place[index]);
        }
    }

    fn angles(&self) -> Vec<(Vec<(usize, f64)>, f64)> {
        (0..self.graph.angle_count())
            .map(|index| {
                let angle = self.graph.angle(index);
                let terms = angle
                    .terms
                    .iter()
                    .map(|&(joint, sign)| (joint, f64::from(sign)));
                (terms.collect(), angle.offset.value())
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::angle::{Angle, AngleSum};
    use super::*;

    #[test]
    fn tape_computes_what_the_graph_says_across_register_boundaries() {
        let mut graph = Graph::new();
        let (s, c) = graph.sin_cos(&AngleSum::joint(0, Angle::radians(0.25)));
        let qd = graph.input(Input::Qd(0));
        let product = graph.mul(s, qd);
        let sum = graph.sub(product, c);
        let sign = graph.call(Function::Sign, qd);
        let outputs = [sum, -product, sign, graph.zero(), sum];
        let tape = Tape::new(&graph, &outputs);

        let len = 2 * WIDTH + 7;
        let q: Vec<f64> = (0..len).map(|i| 0.1 * i as f64 - 3.0).collect();
        let qd: Vec<f64> = (0..len).map(|i| 1.51 - 0.02 * i as f64).collect();
        let mut out = vec![f64::NAN; outputs.len() * len];
        tape.run(
            &Batch {
                len,
                q: &q,
                qd: &qd,
                qdd: &qd,
                slip: &[],
            },
            &mut out,
        );
        for i in 0..len {
            let (s, c) = (q[i] + 0.25).sin_cos();
            let expected = [s * qd[i] - c, -(s * qd[i]), qd[i].signum(), 0.0];
            for (k, value) in expected.into_iter().enumerate() {
                assert!(
                    (out[k * len + i] - value).abs() <= 1e-15,
                    "output {k}, sample {i}"
                );
            }
            assert_eq!(out[4 * len + i], out[i]);
        }
    }
}
