//! From chunks of states to lanes and back: the driver of emitted models.
//!
//! Emitted functions run on the widest vectors of the machine, whatever the program was compiled
//! for.

use std::marker::PhantomData;

use crate::lane::{Arch, Lane, Simd, Vector, WithSimd};
use crate::model::{Output, States};

/// The functions of an emitted module of N joints and P parameters.
///
/// Each is always inlined into the function that has the instructions of its lanes.
pub trait Functions<const N: usize, const P: usize> {
    /// D of the explicit model.
    fn explicit<T: Lane>(motion: Motion<T, N>, d: &mut [[T; P]; N]);
    /// P and R of the implicit model.
    fn implicit<T: Lane>(motion: Motion<T, N>, p: &mut [[T; P]; N], r: &mut [[T; P]; N]);
    /// h of the power model.
    fn energy<T: Lane>(motion: Motion<T, N>, h: &mut [T; P]);
    /// dh of the power model.
    fn power<T: Lane>(motion: Motion<T, N>, dh: &mut [T; P]);
}

/// Positions, velocities, accelerations and presliding states of N joints, sample by sample in
/// lanes.
#[derive(Clone, Copy, Debug)]
pub struct Motion<T, const N: usize> {
    /// Joint positions, rad or m.
    pub q: [T; N],
    /// Joint velocities.
    pub qd: [T; N],
    /// Joint accelerations.
    pub qdd: [T; N],
    /// Presliding states z/zs; the signs of the velocities in sliding.
    pub slip: [T; N],
}

impl<S: Simd, const N: usize> Motion<Vector<S>, N> {
    /// The states from sample `start` on, as many as there are lanes. If there are fewer, the last
    /// one fills up, so that no lane ever computes on undefined numbers.
    #[inline(always)]
    fn load(simd: S, states: &States<'_>, start: usize) -> Self {
        let len = states.len;
        let qd = load(simd, states.qd, len, start);
        Motion {
            q: load(simd, states.q, len, start),
            qd,
            qdd: load(simd, states.qdd, len, start),
            slip: match states.slip.is_empty() {
                true => signs(qd),
                false => load(simd, states.slip, len, start),
            },
        }
    }
}

// Loops, no closures: only what is always inlined has the instructions of its caller.

/// The series of each joint from sample `start` on.
#[inline(always)]
fn load<S: Simd, const N: usize>(
    simd: S,
    series: &[f64],
    len: usize,
    start: usize,
) -> [Vector<S>; N] {
    let mut lanes = [Vector::splat(simd, 0.0); N];
    for (joint, lanes) in lanes.iter_mut().enumerate() {
        *lanes = Vector::from_slice(simd, &series[joint * len..][start..len]);
    }
    lanes
}

#[inline(always)]
fn signs<T: Lane, const N: usize>(mut lanes: [T; N]) -> [T; N] {
    for lane in &mut lanes {
        *lane = lane.sign();
    }
    lanes
}

/// Evaluates an output of an emitted module on a chunk of states.
///
/// `places` are the entries, (row, column), that are its signals 0, 1, ...; `signals` is as in
/// [`crate::model::IdentificationModel::evaluate`].
pub fn evaluate<F: Functions<N, P>, const N: usize, const P: usize>(
    output: Output,
    places: &[(usize, usize)],
    states: &States<'_>,
    signals: &mut [f64],
) {
    let arch = Arch::new();
    match output {
        Output::Explicit => arch.dispatch(Pass::<F, Explicit, N, P>::new(places, states, signals)),
        Output::Momentum => arch.dispatch(Pass::<F, Momentum, N, P>::new(places, states, signals)),
        Output::Rest => arch.dispatch(Pass::<F, Rest, N, P>::new(places, states, signals)),
        Output::Energy => arch.dispatch(Pass::<F, Energy, N, P>::new(places, states, signals)),
        Output::Power => arch.dispatch(Pass::<F, Power, N, P>::new(places, states, signals)),
    }
}

/// What a pass along a chunk computes of each block of samples.
trait Rows<const N: usize, const P: usize> {
    fn fill<F: Functions<N, P>, T: Lane>(motion: Motion<T, N>, rows: &mut [[T; P]; N]);
}

macro_rules! rows {
    ($($name:ident = |$motion:ident, $rows:ident| $call:expr;)*) => {$(
        struct $name;
        impl<const N: usize, const P: usize> Rows<N, P> for $name {
            #[inline(always)]
            fn fill<F: Functions<N, P>, T: Lane>($motion: Motion<T, N>, $rows: &mut [[T; P]; N]) {
                $call
            }
        }
    )*};
}

rows! {
    Explicit = |motion, rows| F::explicit(motion, rows);
    Momentum = |motion, rows| F::implicit(motion, rows, &mut [[motion.q[0]; P]; N]);
    Rest = |motion, rows| F::implicit(motion, &mut [[motion.q[0]; P]; N], rows);
    Energy = |motion, rows| F::energy(motion, &mut rows[0]);
    Power = |motion, rows| F::power(motion, &mut rows[0]);
}

/// A pass along a chunk of states.
struct Pass<'a, F, R, const N: usize, const P: usize> {
    places: &'a [(usize, usize)],
    states: &'a States<'a>,
    signals: &'a mut [f64],
    functions: PhantomData<(F, R)>,
}

impl<'a, F, R, const N: usize, const P: usize> Pass<'a, F, R, N, P> {
    fn new(places: &'a [(usize, usize)], states: &'a States<'a>, signals: &'a mut [f64]) -> Self {
        Pass {
            places,
            states,
            signals,
            functions: PhantomData,
        }
    }

    /// Stores the entries of a block at their places in the signals.
    #[inline(always)]
    fn store<S: Simd>(&mut self, rows: &[[Vector<S>; P]; N], start: usize) {
        let (rows, len) = (rows.as_flattened(), self.states.len);
        let count = S::F64_LANES.min(len - start);
        let signals = self.signals[start..].chunks_mut(len);
        for (signal, &(row, column)) in signals.zip(self.places) {
            let values = rows[row * P + column].values();
            match count == S::F64_LANES {
                true => signal[..S::F64_LANES].copy_from_slice(values),
                false => signal[..count].copy_from_slice(&values[..count]),
            }
        }
    }
}

impl<F: Functions<N, P>, R: Rows<N, P>, const N: usize, const P: usize> WithSimd
    for Pass<'_, F, R, N, P>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let mut rows = [[Vector::splat(simd, 0.0); P]; N];
        for start in (0..self.states.len).step_by(S::F64_LANES) {
            R::fill::<F, _>(Motion::load(simd, self.states, start), &mut rows);
            self.store(&rows, start);
        }
    }
}
