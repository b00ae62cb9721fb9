//! The graph as a tape that runs on batches: the interpreter, and the numbers behind the rank.
//!
//! A tape computes a set of outputs for many states at once. Values of [`WIDTH`] states live side
//! by side in a register; registers are reused as soon as their last reader is done, so the
//! working set stays in cache. Sines and cosines are those of the lanes that emitted code runs on,
//! and every operation is grouped and fused as there: both readers of the graph give the same bits.

mod assembler;
mod run;

use std::cell::RefCell;

use idim_lanes::Arch;

use super::fusion::fused;
use super::graph::{Expr, Function, Graph, Input};
use super::schedule::{order, uses};
use assembler::Assembler;
use run::{Register, Run};

/// States per register: long enough to amortise the dispatch, short enough for the cache.
pub const WIDTH: usize = 128;

thread_local! {
    /// Registers of the tapes that this thread ran: to clear them anew for each batch would cost.
    static REGISTERS: RefCell<Vec<Register>> = const { RefCell::new(Vec::new()) };
}

#[derive(Clone, Copy, Debug)]
enum Op {
    Constant(f64),
    Input(Input),
    /// Sine and cosine of an angle; the cosine goes to the register named here.
    SinCos(usize, usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    /// `a * b + c`.
    MulAdd(usize, usize, usize),
    /// `a * b - c`.
    MulSub(usize, usize, usize),
    /// `c - a * b`.
    SubMul(usize, usize, usize),
    Call(Function, usize),
    /// Stores the target register.
    Store(Place),
}

impl Op {
    /// Whether the values of registers are combined, state by state.
    fn is_arithmetic(self) -> bool {
        match self {
            Op::Add(..) | Op::Sub(..) | Op::Mul(..) => true,
            Op::MulAdd(..) | Op::MulSub(..) | Op::SubMul(..) => true,
            Op::Call(function, _) => function == Function::Sign,
            Op::Constant(_) | Op::Input(_) | Op::SinCos(..) | Op::Store(_) => false,
        }
    }
}

/// Where a value goes to beside its register.
#[derive(Clone, Copy, Debug)]
struct Place {
    output: usize,
    sign: f64,
    /// Whether the register is read again.
    kept: bool,
}

#[derive(Clone, Copy, Debug)]
struct Step {
    op: Op,
    target: usize,
    /// An output that is stored as soon as computed.
    output: Option<Place>,
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
        Tape::among(graph, outputs, &[])
    }

    /// The same with each operation rounded by itself, as emitted C and Python say it.
    pub fn plain(graph: &Graph, outputs: &[Expr]) -> Tape {
        let apart = vec![false; graph.nodes().len()];
        Tape::assembled(graph, outputs, apart)
    }

    /// The same, rounded as in a function that computes other outputs besides: a product that these
    /// use, too, is rounded by itself.
    pub fn among(graph: &Graph, outputs: &[Expr], others: &[Expr]) -> Tape {
        let uses = uses(graph, &[outputs, others].concat());
        Tape::assembled(graph, outputs, fused(graph, &uses))
    }

    fn assembled(graph: &Graph, outputs: &[Expr], fused: Vec<bool>) -> Tape {
        let mut assembler = Assembler::new(graph, outputs, fused);
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

    /// The same of a robot whose base parameters have these values; they are zero before.
    #[must_use]
    pub fn with_parameters(mut self, values: &[f64]) -> Tape {
        for step in &mut self.steps {
            if let Op::Input(Input::Parameter(column)) = step.op {
                step.op = Op::Constant(values.get(column).copied().unwrap_or(0.0));
            }
        }
        self
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Runs the tape: output `k` at sample `i` goes to `out[k * batch.len + i]`.
    ///
    /// The widest vectors of the machine are used; all machines that multiply and add in one
    /// instruction agree to the bit.
    pub fn run(&self, batch: &Batch<'_>, out: &mut [f64]) {
        REGISTERS.with_borrow_mut(|registers| {
            let count = registers.len().max(self.registers);
            registers.resize(count, Register::ZERO);
            Arch::new().dispatch(Run {
                tape: self,
                batch,
                registers,
                out,
            });
        });
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
