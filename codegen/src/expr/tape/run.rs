//! A tape at work, on the widest vectors of the machine.

use idim_lanes::{Lane, Simd, Vector, WithSimd};

use super::{Batch, Op, Step, Tape, WIDTH};
use crate::expr::graph::{Function, Input};

/// States that one instruction of the widest machines works on.
const LANES: usize = 8;

/// Values of [`WIDTH`] states, where cache lines begin.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Register([[f64; LANES]; WIDTH / LANES]);

impl Register {
    pub(super) const ZERO: Register = Register([[0.0; LANES]; WIDTH / LANES]);

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Register {
        Register(self.0.map(|lanes| lanes.map(&f)))
    }
}

/// A tape on its way along a batch.
pub(super) struct Run<'a> {
    pub tape: &'a Tape,
    pub batch: &'a Batch<'a>,
    pub registers: Vec<Register>,
    pub out: &'a mut [f64],
}

impl WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let mut start = 0;
        while start < self.batch.len {
            let width = WIDTH.min(self.batch.len - start);
            for step in &self.tape.steps {
                self.step(simd, step, start, width);
            }
            start += width;
        }
    }
}

impl Run<'_> {
    #[inline(always)]
    fn step<S: Simd>(&mut self, simd: S, step: &Step, start: usize, width: usize) {
        let target = step.target;
        match step.op {
            Op::Constant(value) => self.registers[target] = Register::ZERO.map(|_| value),
            Op::Input(input) => self.registers[target] = read(self.batch, input, start, width),
            Op::SinCos(angle, cosine) => {
                let angle = self.angle(angle, start, width);
                let (sin, cos) = sin_cos(simd, &angle, width);
                self.registers[cosine] = cos;
                self.registers[target] = sin;
            }
            Op::Add(a, b) => self.combine(target, [a, b, b], width, |x, y, _| x + y),
            Op::Sub(a, b) => self.combine(target, [a, b, b], width, |x, y, _| x - y),
            Op::Mul(a, b) => self.combine(target, [a, b, b], width, |x, y, _| x * y),
            Op::MulAdd(a, b, c) => self.combine(target, [a, b, c], width, |x, y, z| x * y + z),
            Op::MulSub(a, b, c) => self.combine(target, [a, b, c], width, |x, y, z| x * y - z),
            Op::SubMul(a, b, c) => self.combine(target, [a, b, c], width, |x, y, z| z - x * y),
            Op::Call(Function::Sine, a) => {
                self.registers[target] = sin_cos(simd, &self.registers[a], width).0;
            }
            Op::Call(Function::Cosine, a) => {
                self.registers[target] = sin_cos(simd, &self.registers[a], width).1;
            }
            Op::Call(Function::Sign, a) => {
                self.combine(target, [a; 3], width, |x, _, _| sign(x));
            }
            Op::Call(function, a) => {
                self.registers[target] = self.registers[a].map(|x| call(function, x));
            }
            Op::Store(a, output, sign) => {
                let place = &mut self.out[output * self.batch.len + start..][..width];
                for (to, from) in place.iter_mut().zip(self.registers[a].0.as_flattened()) {
                    *to = sign * from;
                }
            }
        }
    }

    /// The values of three registers, state by state, for the first `width` states. The target may
    /// be one of them.
    #[inline(always)]
    fn combine(
        &mut self,
        target: usize,
        from: [usize; 3],
        width: usize,
        f: impl Fn(f64, f64, f64) -> f64,
    ) {
        // Whole registers, of a length known beforehand, run without a loop.
        match width {
            WIDTH => self.side_by_side(target, from, WIDTH / LANES, f),
            _ => self.side_by_side(target, from, width.div_ceil(LANES), f),
        }
    }

    #[inline(always)]
    fn side_by_side(
        &mut self,
        target: usize,
        [a, b, c]: [usize; 3],
        groups: usize,
        f: impl Fn(f64, f64, f64) -> f64,
    ) {
        let registers = &mut self.registers[..];
        for k in 0..groups {
            let (x, y, z) = (registers[a].0[k], registers[b].0[k], registers[c].0[k]);
            let places = registers[target].0[k].iter_mut();
            for (((place, x), y), z) in places.zip(x).zip(y).zip(z) {
                *place = f(x, y, z);
            }
        }
    }

    #[inline(always)]
    fn angle(&self, index: usize, start: usize, width: usize) -> Register {
        let (terms, offset) = &self.tape.angles[index];
        let mut sum = Register::ZERO;
        for (place, &(joint, sign)) in terms.iter().enumerate() {
            let q = read(self.batch, Input::Q(joint), start, width);
            for (s, q) in sum.0.as_flattened_mut().iter_mut().zip(q.0.as_flattened()) {
                *s = if place == 0 { sign * q } else { *s + sign * q };
            }
        }
        match *offset {
            0.0 => sum,
            offset => sum.map(|sum| sum + offset),
        }
    }
}

#[inline(always)]
fn read(batch: &Batch<'_>, input: Input, start: usize, width: usize) -> Register {
    let (series, joint) = match input {
        Input::Q(joint) => (batch.q, joint),
        Input::Qd(joint) => (batch.qd, joint),
        Input::Qdd(joint) => (batch.qdd, joint),
        Input::Slip(joint) if batch.slip.is_empty() => {
            return read_series(batch, batch.qd, joint, start, width).map(sign);
        }
        Input::Slip(joint) => (batch.slip, joint),
        Input::Parameter(_) => return Register::ZERO,
    };
    read_series(batch, series, joint, start, width)
}

#[inline(always)]
fn read_series(
    batch: &Batch<'_>,
    series: &[f64],
    joint: usize,
    start: usize,
    width: usize,
) -> Register {
    let mut register = Register::ZERO;
    let from = &series[joint * batch.len + start..][..width];
    register.0.as_flattened_mut()[..width].copy_from_slice(from);
    register
}

/// Sines and cosines of the first `width` values.
#[inline(always)]
fn sin_cos<S: Simd>(simd: S, angles: &Register, width: usize) -> (Register, Register) {
    let (mut sin, mut cos) = (*angles, *angles);
    let lanes = S::F64_LANES;
    let sines = sin.0.as_flattened_mut().chunks_exact_mut(lanes);
    let cosines = cos.0.as_flattened_mut().chunks_exact_mut(lanes);
    for (sin, cos) in sines.zip(cosines).take(width.div_ceil(lanes)) {
        let (s, c) = Vector::from_slice(simd, sin).sin_cos();
        sin.copy_from_slice(s.values());
        cos.copy_from_slice(c.values());
    }
    (sin, cos)
}

#[inline(always)]
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0 * x
    }
}

fn call(function: Function, x: f64) -> f64 {
    match function {
        Function::Sign => sign(x),
        Function::Abs => x.abs(),
        Function::Tanh => x.tanh(),
        Function::Bell => (-x * x).exp(),
        Function::Power(p) => x.abs_power(f64::from_bits(p)),
        Function::Sine => x.sin(),
        Function::Cosine => x.cos(),
        Function::Reciprocal => x.recip(),
        Function::Root => x.sqrt(),
        Function::RootOfOpposite => (-x).sqrt(),
    }
}
