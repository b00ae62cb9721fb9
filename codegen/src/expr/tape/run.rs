//! A tape at work, on the widest vectors of the machine.

use std::array::from_fn;

use idim_lanes::{Lane, Simd, Vector, WithSimd};

use super::{Batch, Op, Place, Step, Tape, WIDTH};
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
    fn values(&mut self) -> &mut [f64] {
        self.0.as_flattened_mut()
    }
}

/// A tape on its way along a batch.
pub(super) struct Run<'a> {
    pub tape: &'a Tape,
    pub batch: &'a Batch<'a>,
    /// As many as the tape asks for; what they hold at first does not matter.
    pub registers: &'a mut [Register],
    pub out: &'a mut [f64],
}

/// The states of the batch that the registers hold.
#[derive(Clone, Copy)]
struct Window {
    start: usize,
    width: usize,
}

impl Window {
    /// Values in use, those that fill the last group up included.
    #[inline(always)]
    fn padded(self) -> usize {
        self.width.next_multiple_of(LANES)
    }
}

impl WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for start in (0..self.batch.len).step_by(WIDTH) {
            let width = WIDTH.min(self.batch.len - start);
            for step in &self.tape.steps {
                self.step(simd, step, Window { start, width });
            }
        }
    }
}

impl Run<'_> {
    #[inline(always)]
    fn step<S: Simd>(&mut self, simd: S, step: &Step, window: Window) {
        let target = step.target;
        match step.op {
            Op::Constant(value) => self.values(target, window).fill(value),
            Op::Input(input) => self.read(input, target, window),
            Op::SinCos(angle, cosine) => {
                self.angle(angle, target, window);
                self.sin_cos(simd, target, [Some(target), Some(cosine)], window.width);
            }
            Op::Add(a, b) => self.combine(step, [a, b, b], window, |x, y, _| x + y),
            Op::Sub(a, b) => self.combine(step, [a, b, b], window, |x, y, _| x - y),
            Op::Mul(a, b) => self.combine(step, [a, b, b], window, |x, y, _| x * y),
            Op::MulAdd(a, b, c) => self.combine(step, [a, b, c], window, |x, y, z| {
                Vector::<S>::fuse(x, y, z)
            }),
            Op::MulSub(a, b, c) => self.combine(step, [a, b, c], window, |x, y, z| {
                Vector::<S>::fuse(x, y, -z)
            }),
            Op::SubMul(a, b, c) => self.combine(step, [a, b, c], window, |x, y, z| {
                Vector::<S>::fuse(-x, y, z)
            }),
            Op::Call(Function::Sine, a) => {
                self.sin_cos(simd, a, [Some(target), None], window.width);
            }
            Op::Call(Function::Cosine, a) => {
                self.sin_cos(simd, a, [None, Some(target)], window.width);
            }
            Op::Call(Function::Sign, a) => {
                self.combine(step, [a; 3], window, |x, _, _| sign(x));
            }
            Op::Call(function, a) => {
                self.registers[target] = self.registers[a];
                let values = &mut self.registers[target].values()[..window.width];
                values.iter_mut().for_each(|x| *x = call(function, *x));
            }
            Op::Store(place) => self.store(target, place, window),
        }
    }

    /// The values of a register that are in use.
    #[inline(always)]
    fn values(&mut self, register: usize, window: Window) -> &mut [f64] {
        &mut self.registers[register].values()[..window.padded()]
    }

    /// The values of three registers, state by state. The target may be one of them.
    #[inline(always)]
    fn combine(
        &mut self,
        step: &Step,
        from: [usize; 3],
        window: Window,
        f: impl Fn(f64, f64, f64) -> f64,
    ) {
        // Whole registers, of a length known beforehand, run without a loop.
        match (window.width, step.output) {
            (WIDTH, None) => self.side_by_side(step.target, from, WIDTH / LANES, f),
            (WIDTH, Some(place)) => self.stored(step, from, place, window.start, f),
            (width, place) => {
                self.side_by_side(step.target, from, width.div_ceil(LANES), f);
                if let Some(place) = place {
                    self.store(step.target, place, window);
                }
            }
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
            registers[target].0[k] = from_fn(|i| f(x[i], y[i], z[i]));
        }
    }

    /// The same of whole registers into an output, and into the target if it is read again.
    #[inline(always)]
    fn stored(
        &mut self,
        step: &Step,
        [a, b, c]: [usize; 3],
        place: Place,
        start: usize,
        f: impl Fn(f64, f64, f64) -> f64,
    ) {
        let registers = &mut self.registers[..];
        let out = &mut self.out[place.output * self.batch.len + start..][..WIDTH];
        for (k, out) in out.chunks_exact_mut(LANES).enumerate() {
            let (x, y, z) = (registers[a].0[k], registers[b].0[k], registers[c].0[k]);
            let values: [f64; LANES] = from_fn(|i| f(x[i], y[i], z[i]));
            if place.kept {
                registers[step.target].0[k] = values;
            }
            for (out, value) in out.iter_mut().zip(values) {
                *out = place.sign * value;
            }
        }
    }

    #[inline(always)]
    fn store(&mut self, register: usize, place: Place, window: Window) {
        let out = &mut self.out[place.output * self.batch.len + window.start..][..window.width];
        for (to, from) in out
            .iter_mut()
            .zip(self.registers[register].0.as_flattened())
        {
            *to = place.sign * from;
        }
    }

    #[inline(always)]
    fn read(&mut self, input: Input, target: usize, window: Window) {
        let presliding = !self.batch.slip.is_empty();
        let batch = self.batch;
        let values = self.values(target, window);
        let Some(series) = series(batch, input, window) else {
            values.fill(0.0);
            return;
        };
        let (held, rest) = values.split_at_mut(series.len());
        held.copy_from_slice(series);
        rest.fill(0.0);
        if matches!(input, Input::Slip(_)) && !presliding {
            held.iter_mut().for_each(|v| *v = sign(*v));
        }
    }

    #[inline(always)]
    fn angle(&mut self, index: usize, target: usize, window: Window) {
        let (batch, tape) = (self.batch, self.tape);
        let (terms, offset) = &tape.angles[index];
        let sum = self.values(target, window);
        sum.fill(0.0);
        for (place, &(joint, sign)) in terms.iter().enumerate() {
            let q = series(batch, Input::Q(joint), window).unwrap_or_default();
            for (s, q) in sum.iter_mut().zip(q) {
                *s = if place == 0 { sign * q } else { *s + sign * q };
            }
        }
        if *offset != 0.0 {
            sum.iter_mut().for_each(|sum| *sum += offset);
        }
    }

    /// Sines and cosines of the first `width` values, into the registers that want them.
    #[inline(always)]
    fn sin_cos<S: Simd>(
        &mut self,
        simd: S,
        angle: usize,
        targets: [Option<usize>; 2],
        width: usize,
    ) {
        let lanes = S::F64_LANES;
        for start in (0..width).step_by(lanes) {
            let lanes = start..start + lanes;
            let angle = &self.registers[angle].values()[lanes.clone()];
            let (s, c) = Vector::from_slice(simd, angle).sin_cos();
            for (target, found) in targets.into_iter().zip([s, c]) {
                if let Some(target) = target {
                    let place = &mut self.registers[target].values()[lanes.clone()];
                    place.copy_from_slice(found.values());
                }
            }
        }
    }
}

/// What the batch says of an input; `None` of what it does not hold.
#[inline(always)]
fn series<'a>(batch: &Batch<'a>, input: Input, window: Window) -> Option<&'a [f64]> {
    let (series, joint) = match input {
        Input::Q(joint) => (batch.q, joint),
        Input::Qd(joint) => (batch.qd, joint),
        Input::Qdd(joint) => (batch.qdd, joint),
        Input::Slip(joint) if batch.slip.is_empty() => (batch.qd, joint),
        Input::Slip(joint) => (batch.slip, joint),
        Input::Parameter(_) => return None,
    };
    Some(&series[joint * batch.len + window.start..][..window.width])
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
