//! Forward dynamics: from torque to acceleration with the parameters of an identified model.

use super::contact::Contact;
use super::error::SimulateError;
use super::lanes::Lanes;
use super::linear::{add, dot, eliminate, factor, solve};
use super::surface::{Surface, find};
use crate::model::{Entry, IdentificationModel, Output};

/// A robot with its parameters, ready to be accelerated. Nothing is allocated after [`Dynamics::new`]
/// (the interpreter of a description allocates inside its own evaluation).
pub struct Dynamics<'a> {
    pub(super) model: &'a dyn IdentificationModel,
    parameters: Vec<f64>,
    momentum: Lanes,
    inertia: Vec<Entry>,
    explicit: Lanes,
    smooth: Vec<Entry>,
    pub(super) surfaces: Vec<Surface>,
    /// First state of each surface in `explicit`.
    places: Vec<usize>,
    /// M, n x n, row-major, and its Cholesky factor.
    mass: Vec<f64>,
    factor: Vec<f64>,
    bias: Vec<f64>,
    /// Half the jump of the torque on each surface that is not slid on, and M^-1 times it; K x n.
    jumps: Vec<f64>,
    pub(super) responses: Vec<f64>,
    /// Friction on each surface as a fraction of its half jump, -1 to 1 where it sticks.
    pub(super) fractions: Vec<f64>,
    /// Surfaces at rest; those of them that are being solved for, and their K x K equations.
    pub(super) resting: Vec<usize>,
    pub(super) active: Vec<usize>,
    pub(super) coupling: Vec<f64>,
    pub(super) unknowns: Vec<f64>,
    pub(super) free: Vec<f64>,
    pub(super) trial: Vec<f64>,
    /// Orthonormal directions, K x n.
    pub(super) basis: Vec<f64>,
}

impl<'a> Dynamics<'a> {
    /// Sets up the forward dynamics of a model with the np `parameters`, in the order of its
    /// columns, and finds its switching surfaces.
    ///
    /// # Errors
    /// [`SimulateError::Parameters`], [`SimulateError::NotFinite`].
    pub fn new(
        model: &'a dyn IdentificationModel,
        parameters: &[f64],
    ) -> Result<Dynamics<'a>, SimulateError> {
        check_parameters(model, parameters)?;
        let n = model.joints().len();
        let (surfaces, smooth) = find(model, parameters);
        let k = surfaces.len();
        let used = |entry: &&Entry| parameters[entry.column] != 0.0;
        let pattern = model.pattern(Output::Momentum);
        Ok(Dynamics {
            model,
            parameters: parameters.to_vec(),
            momentum: Lanes::new(model, Output::Momentum, n),
            inertia: pattern.entries.iter().filter(used).copied().collect(),
            explicit: Lanes::new(model, Output::Explicit, 1 + 2 * k),
            smooth,
            places: vec![0; k],
            mass: vec![0.0; n * n],
            factor: vec![0.0; n * n],
            bias: vec![0.0; n],
            jumps: vec![0.0; k * n],
            responses: vec![0.0; k * n],
            fractions: vec![0.0; k],
            resting: Vec::with_capacity(k),
            active: Vec::with_capacity(k),
            coupling: vec![0.0; k * k],
            unknowns: vec![0.0; k],
            free: vec![0.0; n],
            trial: vec![0.0; n],
            basis: vec![0.0; k * n],
            surfaces,
        })
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.bias.len()
    }

    /// Mass matrix M(q), n x n, row-major, kg m^2 (kg, kg m): column j is P(q, e_j) X.
    ///
    /// # Errors
    /// [`SimulateError::Joints`] if `q` is not n long.
    pub fn mass(&mut self, q: &[f64]) -> Result<&[f64], SimulateError> {
        self.check("position", q)?;
        self.evaluate_mass(q);
        Ok(&self.mass)
    }

    /// Torque without acceleration and without dry friction, n values, N m or N: the entries of
    /// D(q, qd, 0) X that jump nowhere. Stribeck and other friction that jumps is dry friction.
    ///
    /// # Errors
    /// [`SimulateError::Joints`] if `q` or `qd` is not n long.
    pub fn bias(&mut self, q: &[f64], qd: &[f64]) -> Result<&[f64], SimulateError> {
        self.check("position", q)?;
        self.check("velocity", qd)?;
        self.explicit.fill(1, q, qd);
        self.explicit.run(self.model);
        self.smooth_bias();
        Ok(&self.bias)
    }

    /// Acceleration \\( \ddot q = M^{-1} (\tau - N) \\), written to `qdd`, rad/s^2 or m/s^2. A joint
    /// whose speed is below 1e-9 rad/s (m/s) sticks if its dry friction can hold it.
    ///
    /// # Errors
    /// [`SimulateError::Joints`] if a slice is not n long, [`SimulateError::NotPositiveDefinite`].
    pub fn acceleration(
        &mut self,
        q: &[f64],
        qd: &[f64],
        tau: &[f64],
        qdd: &mut [f64],
    ) -> Result<(), SimulateError> {
        let slices = [
            ("position", q),
            ("velocity", qd),
            ("torque", tau),
            ("acceleration", &*qdd),
        ];
        for (what, slice) in slices {
            self.check(what, slice)?;
        }
        let mut contacts = vec![Contact::Sticks; self.surfaces.len()];
        let mut at_rest = qd.to_vec();
        self.settle(&mut contacts, q, &mut at_rest, tau)?;
        self.accelerate(&contacts, q, &at_rest, tau, qdd)
    }

    /// Acceleration with given contacts: friction on sliding surfaces is that of their side even
    /// where the velocity is not, so that it is smooth over a step.
    pub(super) fn accelerate(
        &mut self,
        contacts: &[Contact],
        q: &[f64],
        qd: &[f64],
        tau: &[f64],
        qdd: &mut [f64],
    ) -> Result<(), SimulateError> {
        self.factor_mass(q)?;
        self.forces(contacts, q, qd);
        let n = self.joints();
        for ((qdd, tau), bias) in qdd.iter_mut().zip(tau).zip(&self.bias) {
            *qdd = tau - bias;
        }
        for (k, contact) in contacts.iter().enumerate() {
            if let Contact::Holds(fraction) = contact {
                add(qdd, -fraction, &self.jumps[k * n..][..n]);
            }
        }
        solve(&self.factor, n, qdd);
        self.active.clear();
        let sticking = contacts
            .iter()
            .enumerate()
            .filter(|(_, c)| **c == Contact::Sticks);
        self.active.extend(sticking.map(|(k, _)| k));
        self.respond();
        self.couple();
        self.stick(qdd);
        Ok(())
    }

    /// Evaluates and factors M.
    pub(super) fn factor_mass(&mut self, q: &[f64]) -> Result<(), SimulateError> {
        self.evaluate_mass(q);
        self.factor.copy_from_slice(&self.mass);
        factor(&mut self.factor, self.bias.len()).map_err(|(row, pivot)| {
            let joint = self.model.joints()[row].name.to_string();
            SimulateError::NotPositiveDefinite {
                joint,
                pivot,
                q: q.to_vec(),
            }
        })
    }

    fn evaluate_mass(&mut self, q: &[f64]) {
        let n = self.joints();
        self.trial.fill(0.0);
        self.momentum.fill(n, q, &self.trial);
        (0..n).for_each(|j| self.momentum.set_velocity(j, j, 1.0));
        self.momentum.run(self.model);
        self.mass.fill(0.0);
        for entry in &self.inertia {
            let parameter = self.parameters[entry.column];
            for (j, element) in self.mass[entry.row * n..][..n].iter_mut().enumerate() {
                *element += parameter * self.momentum.signal(entry.signal, j);
            }
        }
    }

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
        self.explicit.run(self.model);
        self.smooth_bias();
        (0..contacts.len()).for_each(|k| self.friction(k, contacts[k]));
    }

    fn smooth_bias(&mut self) {
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
        self.active
            .iter()
            .for_each(|&k| self.surfaces[k].project(qdd));
    }

    /// M^-1 (tau - bias) with the forces last evaluated.
    pub(super) fn release(&mut self, tau: &[f64]) {
        for ((free, tau), bias) in self.free.iter_mut().zip(tau).zip(&self.bias) {
            *free = tau - bias;
        }
        solve(&self.factor, self.bias.len(), &mut self.free);
    }

    fn check(&self, what: &'static str, values: &[f64]) -> Result<(), SimulateError> {
        check_joints(self.model, what, values.len())
    }
}

/// Whether something is for as many joints as the robot has.
pub(super) fn check_joints(
    model: &dyn IdentificationModel,
    what: &'static str,
    has: usize,
) -> Result<(), SimulateError> {
    let needs = model.joints().len();
    if has == needs {
        return Ok(());
    }
    Err(SimulateError::Joints {
        what,
        has,
        robot: model.name().to_owned(),
        needs,
    })
}

/// Whether parameters are as many as the columns, and finite.
pub(super) fn check_parameters(
    model: &dyn IdentificationModel,
    parameters: &[f64],
) -> Result<(), SimulateError> {
    let (has, needs) = (parameters.len(), model.columns().len());
    if has != needs {
        let robot = model.name().to_owned();
        return Err(SimulateError::Parameters { robot, has, needs });
    }
    for (column, &value) in model.columns().iter().zip(parameters) {
        if !value.is_finite() {
            return Err(SimulateError::NotFinite {
                name: column.name.to_string(),
                value,
            });
        }
    }
    Ok(())
}
