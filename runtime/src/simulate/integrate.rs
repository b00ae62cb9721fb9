//! Explicit Runge-Kutta steps: the classical one of order 4, and Dormand-Prince 5(4).

use super::contact::Contact;
use super::dynamics::Dynamics;
use super::error::SimulateError;
use super::linear::add;

/// A position, m or rad, or velocity beyond this is no motion of a robot.
const BOUND: f64 = 1e6;

/// Coefficients of a method; `c` from the first stage, `a` from the second.
#[derive(Debug)]
pub(super) struct Tableau {
    c: &'static [f64],
    a: &'static [&'static [f64]],
    b: &'static [f64],
    /// b minus that of the embedded method; empty without one.
    error: &'static [f64],
}

/// Kutta's method of order 4.
pub(super) static RK4: Tableau = Tableau {
    c: &[0.0, 0.5, 0.5, 1.0],
    a: &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    b: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    error: &[],
};

/// J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", Journal of
/// Computational and Applied Mathematics 6, 1980: RK5(4)7M.
pub(super) static DORMAND_PRINCE: Tableau = Tableau {
    c: &[0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0],
    a: &[
        &[0.2],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
        ],
        &[
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
        ],
        &[
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ],
    b: &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
        0.0,
    ],
    error: &[
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ],
};

/// Torque of all joints at a time, written into the slice, N m or N.
pub(super) type Torque<'t> = &'t dyn Fn(f64, &mut [f64]);

/// Buffers of a method for n joints; a state is `[q, qd]`, 2 n values, and behind them the slip of
/// each joint whose contact yields before it slides.
#[derive(Debug)]
pub(super) struct Integrator {
    tableau: &'static Tableau,
    stages: Vec<f64>,
    point: Vec<f64>,
    tau: Vec<f64>,
    slip: Vec<f64>,
}

impl Integrator {
    pub(super) fn new(tableau: &'static Tableau, joints: usize, slips: usize) -> Self {
        Integrator {
            tableau,
            stages: vec![0.0; tableau.b.len() * 2 * joints],
            point: vec![0.0; 2 * joints],
            tau: vec![0.0; joints],
            slip: vec![0.0; slips],
        }
    }

    /// One step of length `h` from the state `x` at time `t`, with constant contacts.
    pub(super) fn step(
        &mut self,
        (dynamics, contacts): (&mut Dynamics<'_>, &[Contact]),
        torque: Torque<'_>,
        (t, h): (f64, f64),
        x: &[f64],
        next: &mut [f64],
    ) -> Result<(), SimulateError> {
        let n = self.tau.len();
        let size = 2 * n;
        let (x, before) = x.split_at(size);
        for stage in 0..self.tableau.b.len() {
            self.point.copy_from_slice(x);
            if stage > 0 {
                self.advance(self.tableau.a[stage - 1], h, size);
            }
            let time = t + self.tableau.c[stage] * h;
            bounded(dynamics, &self.point, time)?;
            torque(time, &mut self.tau);
            let (q, qd) = self.point.split_at(n);
            let rate = &mut self.stages[stage * size..][..size];
            rate[..n].copy_from_slice(qd);
            dynamics.slipped(before, (&x[..n], q), &mut self.slip);
            dynamics.deflect(time, &self.slip);
            dynamics.accelerate(contacts, q, qd, &self.tau, &mut rate[n..])?;
        }
        self.point.copy_from_slice(x);
        self.advance(self.tableau.b, h, size);
        bounded(dynamics, &self.point, t + h)?;
        next[..size].copy_from_slice(&self.point);
        dynamics.slipped(before, (&x[..n], &self.point[..n]), &mut next[size..]);
        Ok(())
    }

    /// Largest error of the last step in units of the tolerance; 0 without an estimate.
    pub(super) fn error(&self, h: f64, next: &[f64], relative: f64, absolute: f64) -> f64 {
        let size = self.point.len();
        let error = |i: usize| -> f64 {
            let terms = self.tableau.error.iter().enumerate();
            let sum: f64 = terms
                .map(|(stage, e)| e * self.stages[stage * size + i])
                .sum();
            (h * sum).abs() / (absolute + relative * next[i].abs())
        };
        (0..size).map(error).fold(0.0, f64::max)
    }

    /// Adds the stages, weighted, to the point.
    fn advance(&mut self, weights: &[f64], h: f64, size: usize) {
        for (stage, weight) in weights.iter().enumerate() {
            if *weight != 0.0 {
                add(
                    &mut self.point,
                    h * weight,
                    &self.stages[stage * size..][..size],
                );
            }
        }
    }
}

/// Whether a state is one that a robot can be in.
pub(super) fn bounded(
    dynamics: &Dynamics<'_>,
    state: &[f64],
    second: f64,
) -> Result<(), SimulateError> {
    // NaN is not within the bound either.
    let outside = |x: &f64| x.is_nan() || x.abs() > BOUND;
    let Some(place) = state.iter().position(outside) else {
        return Ok(());
    };
    let joint = dynamics.model.joints()[place % dynamics.joints()]
        .name
        .to_string();
    Err(SimulateError::Diverged {
        joint,
        what: "every bound",
        second,
    })
}
