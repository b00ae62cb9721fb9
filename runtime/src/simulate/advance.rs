//! From sample to sample: steps of the integrator, cut where a surface stops or starts to slide.

use super::contact::Contact;
use super::dynamics::Dynamics;
use super::error::SimulateError;
use super::influence::Moment;
use super::integrate::{DORMAND_PRINCE, Integrator, RK4, Torque, bounded};
use super::options::{Method, State};

/// Events that are located between two samples; beyond that (Zeno) steps go on without.
const EVENTS: usize = 32;

/// Trial steps to locate one event; each third one halves the interval.
const TRIALS: usize = 60;

/// Smallest step, s.
const SMALLEST: f64 = 1e-12;

/// A robot in motion.
pub(super) struct Simulator<'a> {
    pub(super) dynamics: Dynamics<'a>,
    integrator: Integrator,
    method: Method,
    contacts: Vec<Contact>,
    /// `[q, qd]` and presliding states now, and after a trial step.
    state: Vec<f64>,
    next: Vec<f64>,
    tau: Vec<f64>,
    qdd: Vec<f64>,
    /// Next step of the variable-step method, s.
    step: f64,
    /// Time and velocities at the sample before.
    before: Option<(f64, Vec<f64>)>,
}

impl<'a> Simulator<'a> {
    pub(super) fn new(dynamics: Dynamics<'a>, method: Method, start: &State) -> Simulator<'a> {
        let (n, slips) = (dynamics.joints(), dynamics.model.presliding().len());
        let tableau = match method {
            Method::Fixed { .. } => &RK4,
            Method::Adaptive { .. } => &DORMAND_PRINCE,
        };
        Simulator {
            integrator: Integrator::new(tableau, n, slips),
            method,
            contacts: vec![Contact::Sticks; dynamics.surfaces.len()],
            state: [start.q.as_slice(), &start.qd, &dynamics.sliding(&start.qd)].concat(),
            next: vec![0.0; 2 * n + slips],
            before: None,
            tau: vec![0.0; n],
            qdd: vec![0.0; n],
            step: 1e-3,
            dynamics,
        }
    }

    /// Present positions.
    pub(super) fn q(&self) -> &[f64] {
        &self.state[..self.tau.len()]
    }

    /// Present velocities.
    pub(super) fn qd(&self) -> &[f64] {
        let n = self.tau.len();
        &self.state[n..2 * n]
    }

    /// Tells everything that acts on the robot that a sample begins.
    pub(super) fn begin(&mut self, t: f64) {
        let n = self.tau.len();
        let (q, qd) = (&self.state[..n], &self.state[n..2 * n]);
        let qdd = match &self.before {
            Some((then, last)) => {
                let pairs = qd.iter().zip(last);
                pairs.map(|(qd, last)| (qd - last) / (t - then)).collect()
            }
            None => vec![0.0; n],
        };
        let moment = Moment {
            t,
            q,
            qd,
            qdd: &qdd,
        };
        for influence in &mut self.dynamics.influences {
            influence.begin(&moment, &mut self.dynamics.parameters);
        }
        self.before = Some((t, qd.to_vec()));
    }

    /// Moves from time `from` to `to` under a torque that is smooth in between.
    pub(super) fn advance(
        &mut self,
        torque: Torque<'_>,
        from: f64,
        to: f64,
    ) -> Result<(), SimulateError> {
        let interval = to - from;
        if let Method::Fixed { step_s } = self.method {
            self.step = interval / (interval / step_s - 1e-9).ceil().max(1.0);
        }
        if self.step < SMALLEST {
            return Err(SimulateError::StepTooSmall { second: from });
        }
        bounded(&self.dynamics, &self.state, from)?;
        let mut t = from;
        let mut events = 0;
        self.settle(torque, t)?;
        while to - t > 1e-12 * interval {
            let remaining = to - t;
            let h = if remaining <= self.step * (1.0 + 1e-9) {
                remaining
            } else {
                self.step
            };
            self.integrate(torque, t, h)?;
            if !self.accept(t, h, remaining)? {
                continue;
            }
            if events < EVENTS && self.margin(torque, t + h)? < 0.0 {
                t += self.locate(torque, t, h)?;
                events += 1;
                self.commit();
                self.settle(torque, t)?;
            } else {
                t += h;
                self.commit();
            }
        }
        Ok(())
    }

    fn commit(&mut self) {
        std::mem::swap(&mut self.state, &mut self.next);
    }

    fn integrate(&mut self, torque: Torque<'_>, t: f64, h: f64) -> Result<(), SimulateError> {
        let parts = (&mut self.dynamics, self.contacts.as_slice());
        self.integrator
            .step(parts, torque, (t, h), &self.state, &mut self.next)
    }

    /// Whether the trial step is accurate enough; chooses the next one.
    fn accept(&mut self, t: f64, h: f64, remaining: f64) -> Result<bool, SimulateError> {
        let Method::Adaptive { relative, absolute } = self.method else {
            return Ok(true);
        };
        let error = self.integrator.error(h, &self.next, relative, absolute);
        let factor = (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
        if error > 1.0 {
            self.step = h * factor.min(0.9);
            if self.step < SMALLEST {
                return Err(SimulateError::StepTooSmall { second: t });
            }
            return Ok(false);
        }
        // A step that was cut at a sample says little about the next one.
        if h < remaining || h >= self.step {
            self.step = h * factor;
        }
        Ok(true)
    }

    fn settle(&mut self, torque: Torque<'_>, t: f64) -> Result<(), SimulateError> {
        torque(t, &mut self.tau);
        let n = self.tau.len();
        let (q, rest) = self.state.split_at_mut(n);
        let (qd, slip) = rest.split_at_mut(n);
        self.dynamics.deflect(t, slip);
        self.dynamics.settle(&mut self.contacts, q, qd, &self.tau)
    }

    /// How far the trial state is from an event; negative beyond it.
    fn margin(&mut self, torque: Torque<'_>, t: f64) -> Result<f64, SimulateError> {
        let n = self.tau.len();
        let (q, rest) = self.next.split_at(n);
        let (qd, slip) = rest.split_at(n);
        if self.contacts.contains(&Contact::Sticks) {
            torque(t, &mut self.tau);
            self.dynamics.deflect(t, slip);
            self.dynamics
                .accelerate(&self.contacts, q, qd, &self.tau, &mut self.qdd)?;
        }
        let surfaces = self.dynamics.surfaces.iter().zip(&self.dynamics.fractions);
        let margins = surfaces
            .zip(&self.contacts)
            .map(|((surface, fraction), contact)| contact.margin(surface.speed(qd), *fraction));
        Ok(margins.fold(f64::INFINITY, f64::min))
    }

    /// Finds the first event within a step of length `h` by false position (Illinois) on steps of
    /// other lengths; leaves the state just after it in `next` and returns the step that leads there.
    fn locate(&mut self, torque: Torque<'_>, t: f64, h: f64) -> Result<f64, SimulateError> {
        let mut high = (h, self.margin(torque, t + h)?);
        self.next.copy_from_slice(&self.state);
        let mut low = (0.0, self.margin(torque, t)?.max(0.0));
        // Whether the last trial moved the upper end, once there was one.
        let mut moved = None;
        for trial in 0..TRIALS {
            let cut = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let inside = cut > low.0 && cut < high.0 && trial % 3 != 2;
            let length = if inside { cut } else { 0.5 * (low.0 + high.0) };
            self.integrate(torque, t, length)?;
            let margin = self.margin(torque, t + length)?;
            // Right at the start, a surface that leaves rest has no speed yet: that is no event.
            if margin.abs() <= 1e-12 && length > 1e-6 * h {
                return Ok(length);
            }
            let beyond = margin < 0.0;
            let (end, other) = if beyond {
                (&mut high, &mut low)
            } else {
                (&mut low, &mut high)
            };
            *end = (length, margin);
            if moved == Some(beyond) {
                other.1 *= 0.5;
            }
            moved = Some(beyond);
            if high.0 - low.0 <= 1e-13 * h {
                break;
            }
        }
        self.integrate(torque, t, high.0)?;
        Ok(high.0)
    }
}
