//! The torques of a state, and what friction does to an acceleration.

use super::contact::Contact;
use super::dynamics::Dynamics;
use super::linear::{add, dot, eliminate, solve};

impl Dynamics<'_> {
    /// Bias with the friction of all sliding surfaces and the middle of all others; their jumps.
    pub(super) fn forces(&mut self, contacts: &[Contact], q: &[f64], qd: &[f64]) {
        let mut len = 1;
        for ((surface, contact), place) in self.surfaces.iter().zip(contacts).zip(&mut self.places)
        {
            let states = contact.states(surface.speed(qd));
            *place = if states == 0 { 0 } else { len };
            len += states;
        }
        self.explicit.fill(len, q, qd);
        for ((surface, contact), &place) in self.surfaces.iter().zip(contacts).zip(&self.places) {
            match *contact {
                Contact::Slides(_) if place == 0 => {}
                Contact::Slides(side) => surface.side(&mut self.explicit, place, qd, side),
                Contact::Sticks | Contact::Holds(_) => {
                    surface.side(&mut self.explicit, place, qd, 1.0);
                    surface.side(&mut self.explicit, place + 1, qd, -1.0);
                }
            }
        }
        self.explicit.run(self.model, &self.slip);
        self.smooth_bias();
        for influence in &mut self.influences {
            influence.torque(self.t, q, qd, &mut self.bias);
        }
        (0..contacts.len()).for_each(|k| self.friction(k, contacts[k]));
    }

    /// Sum of the entries that jump nowhere, at the first state evaluated.
    pub(super) fn smooth_bias(&mut self) {
        self.bias.fill(0.0);
        for entry in &self.smooth {
            let value = self.explicit.signal(entry.signal, 0);
            self.bias[entry.row] += self.parameters[entry.column] * value;
        }
    }

    /// Adds the friction of a surface to the bias, or sets its jump.
    fn friction(&mut self, k: usize, contact: Contact) {
        let (n, place) = (self.bias.len(), self.places[k]);
        let jump = &mut self.jumps[k * n..][..n];
        jump.fill(0.0);
        for entry in &self.surfaces[k].entries {
            let parameter = self.parameters[entry.column];
            let here = self.explicit.signal(entry.signal, place);
            if let Contact::Slides(_) = contact {
                self.bias[entry.row] += parameter * here;
                continue;
            }
            let there = self.explicit.signal(entry.signal, place + 1);
            self.bias[entry.row] += parameter * 0.5 * (here + there);
            jump[entry.row] += parameter * 0.5 * (here - there);
        }
    }

    /// Acceleration that each active surface's jump would cause.
    pub(super) fn respond(&mut self) {
        let n = self.bias.len();
        for &k in &self.active {
            let response = &mut self.responses[k * n..][..n];
            response.copy_from_slice(&self.jumps[k * n..][..n]);
            solve(&self.factor, n, response);
        }
    }

    /// Acceleration across each active surface by the jump of each: count x count, row-major.
    pub(super) fn couple(&mut self) {
        let (n, count) = (self.bias.len(), self.active.len());
        for (i, &k) in self.active.iter().enumerate() {
            for (l, &other) in self.active.iter().enumerate() {
                let response = &self.responses[other * n..][..n];
                self.coupling[i * count + l] = dot(&self.surfaces[k].direction, response);
            }
        }
    }

    /// Takes the acceleration across the active surfaces away; `qdd` is that without their
    /// friction. The fractions of their friction that this takes are kept.
    pub(super) fn stick(&mut self, qdd: &mut [f64]) {
        let (n, count) = (self.bias.len(), self.active.len());
        for (i, &k) in self.active.iter().enumerate() {
            self.unknowns[i] = dot(&self.surfaces[k].direction, qdd);
        }
        eliminate(&mut self.coupling, count, &mut self.unknowns);
        for (i, &k) in self.active.iter().enumerate() {
            self.fractions[k] = self.unknowns[i];
            add(qdd, -self.unknowns[i], &self.responses[k * n..][..n]);
        }
        // What rounding leaves would let a joint at rest creep.
        for unit in self.basis[..self.rank * n].chunks_exact(n.max(1)) {
            let along = dot(unit, qdd);
            add(qdd, -along, unit);
        }
    }

    /// M^-1 (tau - bias) with the forces last evaluated.
    pub(super) fn release(&mut self, tau: &[f64]) {
        for ((free, tau), bias) in self.free.iter_mut().zip(tau).zip(&self.bias) {
            *free = tau - bias;
        }
        solve(&self.factor, self.bias.len(), &mut self.free);
    }
}
