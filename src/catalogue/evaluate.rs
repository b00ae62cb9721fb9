//! Expressions of the graph along signals, block by block.

use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::expr::{Expr, Graph};

/// Samples that a tape runs over at once, so that its outputs stay in cache.
const BLOCK: usize = 512;

/// A change of the motion of one joint, the others as they are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shift {
    /// Adds to the position, rad or m.
    Position(usize, f64),
    /// Adds to the velocity.
    Velocity(usize, f64),
    /// Adds to the acceleration.
    Acceleration(usize, f64),
}

/// A motion of all joints, one series per joint, all of one length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<'a> {
    /// Positions, rad or m.
    pub q: &'a [Vec<f64>],
    /// Velocities.
    pub qd: &'a [Vec<f64>],
    /// Accelerations.
    pub qdd: &'a [Vec<f64>],
    /// The presliding state of a joint.
    pub slip: Option<(usize, &'a [f64])>,
    /// Whether the joints stand still at every position.
    pub still: bool,
    /// What is changed.
    pub shift: Option<Shift>,
}

impl Motion<'_> {
    fn len(&self) -> usize {
        self.q.first().map_or(0, Vec::len)
    }

    /// One block of states, structure of arrays.
    fn pack(&self, start: usize, len: usize, states: &mut [Vec<f64>; 4]) {
        let block = start..start + len;
        let [q, qd, qdd, slip] = states;
        for (to, from, moves) in [
            (&mut *q, self.q, true),
            (&mut *qd, self.qd, !self.still),
            (&mut *qdd, self.qdd, !self.still),
        ] {
            to.clear();
            match moves {
                true => from
                    .iter()
                    .for_each(|series| to.extend_from_slice(&series[block.clone()])),
                false => to.resize(from.len() * len, 0.0),
            }
        }
        slip.clear();
        if let Some((joint, state)) = self.slip {
            slip.resize(q.len(), 0.0);
            slip[joint * len..(joint + 1) * len].copy_from_slice(&state[block]);
        }
        let (series, joint, by) = match self.shift {
            Some(Shift::Position(joint, by)) => (q, joint, by),
            Some(Shift::Velocity(joint, by)) => (qd, joint, by),
            Some(Shift::Acceleration(joint, by)) => (qdd, joint, by),
            None => return,
        };
        series[joint * len..(joint + 1) * len]
            .iter_mut()
            .for_each(|x| *x += by);
    }

    /// Runs a tape along the motion; `each` gets the first sample, the number of samples and the
    /// outputs, output by output.
    fn run(&self, tape: &Tape, mut each: impl FnMut(usize, usize, &[f64])) {
        let mut out = Vec::new();
        let mut states = <[Vec<f64>; 4]>::default();
        for start in (0..self.len()).step_by(BLOCK) {
            let len = BLOCK.min(self.len() - start);
            self.pack(start, len, &mut states);
            let [q, qd, qdd, slip] = &states;
            out.resize(tape.outputs() * len, 0.0);
            let batch = Batch {
                len,
                q,
                qd,
                qdd,
                slip,
            };
            tape.run(&batch, &mut out);
            each(start, len, &out);
        }
    }
}

/// Torques that are linear in parameters: tau_j = sum of entries (j, k) times x_k.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    tape: Tape,
    /// (joint, parameter, output of the tape).
    entries: Vec<(usize, usize, usize)>,
    joints: usize,
}

impl Linear {
    /// From the columns of parameters, each its number and its entries (joint, expression).
    pub fn new<'c>(
        graph: &Graph,
        joints: usize,
        columns: impl IntoIterator<Item = (usize, &'c [(usize, Expr)])>,
    ) -> Linear {
        let mut values: Vec<Expr> = Vec::new();
        let mut entries = Vec::new();
        for (parameter, column) in columns {
            for &(joint, value) in column {
                entries.push((joint, parameter, values.len()));
                values.push(value);
            }
        }
        Linear {
            tape: Tape::new(graph, &values),
            entries,
            joints,
        }
    }

    /// The torque of every joint along a motion, with parameters `x`.
    pub fn torque(&self, motion: &Motion<'_>, x: &[f64]) -> Vec<Vec<f64>> {
        let mut torque = vec![vec![0.0; motion.len()]; self.joints];
        let value = |parameter: usize| x.get(parameter).copied().unwrap_or(0.0);
        motion.run(&self.tape, |start, len, out| {
            for &(joint, parameter, signal) in &self.entries {
                let factor = value(parameter);
                let from = &out[signal * len..(signal + 1) * len];
                let to = &mut torque[joint][start..start + len];
                to.iter_mut()
                    .zip(from)
                    .for_each(|(to, from)| *to += factor * from);
            }
        });
        torque
    }

    /// The columns along a motion, by parameter: for each the joints it acts on.
    pub fn columns(&self, motion: &Motion<'_>) -> Vec<Vec<(usize, Vec<f64>)>> {
        let count = self.entries.iter().map(|entry| entry.1 + 1).max();
        let mut columns = vec![Vec::new(); count.unwrap_or(0)];
        let mut series = vec![Vec::with_capacity(motion.len()); self.tape.outputs()];
        motion.run(&self.tape, |_, len, out| {
            for (series, out) in series.iter_mut().zip(out.chunks(len)) {
                series.extend_from_slice(out);
            }
        });
        for &(joint, parameter, signal) in &self.entries {
            columns[parameter].push((joint, std::mem::take(&mut series[signal])));
        }
        columns
    }
}
