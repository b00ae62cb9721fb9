//! What every switching surface of dry friction is doing: slide or stick.

use super::dynamics::Dynamics;
use super::error::SimulateError;
use super::linear::{add, dot};

/// Below this speed, rad/s or m/s, a surface is at rest: motion is stopped exactly there, so that
/// only rounding has to be told from motion.
const REST: f64 = 1e-9;

/// Friction above this fraction of its limit is at its limit.
const LIMIT: f64 = 1.0 + 1e-9;

/// Sweeps over the resting surfaces; each costs a few products, and most need below 20.
const SWEEPS: usize = 2000;

/// A direction that is this close to the span of others, of unit length, depends on them.
const DEPENDENT: f64 = 1e-6;

/// State of one surface, kept over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Contact {
    /// Moves to this side, +1 or -1.
    Slides(f64),
    /// At rest: the friction is what it takes.
    Sticks,
    /// At rest because others stick that it depends on: the friction is this fraction of its limit.
    Holds(f64),
}

impl Contact {
    /// How many states of its own the friction has to be evaluated at, at a given speed.
    pub(super) fn states(self, speed: f64) -> usize {
        match self {
            Contact::Slides(side) if side * speed > 0.0 => 0,
            Contact::Slides(_) => 1,
            Contact::Sticks | Contact::Holds(_) => 2,
        }
    }

    /// How far the surface is from its next event: negative when a sliding one has reversed, or a
    /// sticking one takes more than its friction.
    pub(super) fn margin(self, speed: f64, fraction: f64) -> f64 {
        match self {
            // Leaving rest, the first speeds are rounding.
            Contact::Slides(side) => side * speed + 1e-13,
            Contact::Sticks => LIMIT - fraction.abs(),
            Contact::Holds(_) => f64::INFINITY,
        }
    }
}

impl Dynamics<'_> {
    /// Decides for every surface whether it slides or sticks under a torque, and stops those at
    /// rest exactly. To be called whenever the torque jumps and after every event.
    ///
    /// On the surfaces at rest, the friction fractions f are found by projected Gauss-Seidel:
    /// \\( |f| \le 1 \\), no acceleration across a surface with \\( |f| < 1 \\), and otherwise one
    /// that the friction opposes.
    pub(super) fn settle(
        &mut self,
        contacts: &mut [Contact],
        q: &[f64],
        qd: &mut [f64],
        tau: &[f64],
    ) -> Result<(), SimulateError> {
        self.resting.clear();
        for (k, surface) in self.surfaces.iter().enumerate() {
            let speed = surface.speed(qd);
            contacts[k] = if speed.abs() > REST {
                Contact::Slides(speed.signum())
            } else {
                self.resting.push(k);
                surface.project(qd);
                Contact::Sticks
            };
        }
        self.rank = 0;
        if self.resting.is_empty() {
            return Ok(());
        }
        self.active.clone_from(&self.resting);
        self.factor_mass(q)?;
        self.forces(contacts, q, qd);
        self.release(tau);
        self.respond();
        self.couple();
        self.sweep();
        for i in 0..self.active.len() {
            let k = self.active[i];
            contacts[k] = self.resting(i, self.fractions[k]);
        }
        self.confirm(contacts);
        Ok(())
    }

    /// Projected Gauss-Seidel over the active surfaces, beginning with the last fractions.
    fn sweep(&mut self) {
        let (n, count) = (self.joints(), self.active.len());
        for _ in 0..SWEEPS {
            let mut change: f64 = 0.0;
            for i in 0..count {
                let k = self.active[i];
                let own = self.coupling[i * count + i];
                if own <= 0.0 {
                    // Friction that drives instead of braking cannot hold anything.
                    let free = dot(&self.surfaces[k].direction, &self.free[..n]);
                    self.fractions[k] = 1.0f64.copysign(free);
                    continue;
                }
                let row = &self.coupling[i * count..][..count];
                let braked = |(a, &other): (&f64, &usize)| a * self.fractions[other];
                let braked: f64 = row.iter().zip(&self.active).map(braked).sum();
                let across = dot(&self.surfaces[k].direction, &self.free) - braked;
                let fraction = (self.fractions[k] + across / own).clamp(-1.0, 1.0);
                change = change.max((fraction - self.fractions[k]).abs());
                self.fractions[k] = fraction;
            }
            if change < 1e-13 {
                break;
            }
        }
    }

    fn resting(&self, i: usize, fraction: f64) -> Contact {
        let brakes = self.coupling[i * self.active.len() + i] > 0.0;
        if brakes && fraction.abs() < 1.0 {
            Contact::Sticks
        } else {
            Contact::Slides(fraction.signum())
        }
    }

    /// Of sticking surfaces that depend on each other (both joints of a wrist and their sum), the
    /// later ones keep their present friction: their sum is all that the motion can tell. Keeps an
    /// orthonormal basis of the directions that stick.
    fn keep_independent(&mut self, contacts: &mut [Contact]) {
        let n = self.joints();
        self.rank = 0;
        for &k in &self.resting {
            if contacts[k] != Contact::Sticks {
                continue;
            }
            let (basis, rest) = self.basis.split_at_mut(self.rank * n);
            let residual = &mut rest[..n];
            residual.copy_from_slice(&self.surfaces[k].direction);
            for unit in basis.chunks_exact(n) {
                let along = dot(unit, residual);
                add(residual, -along, unit);
            }
            let norm = dot(residual, residual).sqrt();
            if norm < DEPENDENT {
                contacts[k] = Contact::Holds(self.fractions[k]);
                continue;
            }
            residual.iter_mut().for_each(|x| *x /= norm);
            self.rank += 1;
        }
    }

    /// Solves for the friction of the sticking surfaces exactly, and lets those slide that would
    /// take more than they have.
    fn confirm(&mut self, contacts: &mut [Contact]) {
        let n = self.joints();
        let mut qdd = std::mem::take(&mut self.trial);
        for _ in 0..=self.resting.len() {
            self.keep_independent(contacts);
            qdd.copy_from_slice(&self.free);
            self.active.clear();
            for &k in &self.resting {
                let fraction = match contacts[k] {
                    Contact::Slides(side) => side,
                    Contact::Holds(fraction) => fraction,
                    Contact::Sticks => {
                        self.active.push(k);
                        continue;
                    }
                };
                add(&mut qdd, -fraction, &self.responses[k * n..][..n]);
            }
            self.couple();
            self.stick(&mut qdd);
            let over = |k: &&usize| self.fractions[**k].abs() > LIMIT;
            let Some(&k) = self.active.iter().find(over) else {
                break;
            };
            contacts[k] = Contact::Slides(self.fractions[k].signum());
        }
        self.trial = qdd;
    }
}
