//! Forward dynamics: from torque to acceleration with the parameters of an identified model.

use super::contact::Contact;
use super::error::SimulateError;
use super::influence::Influence;
use super::lanes::Lanes;
use super::linear::{add, factor, solve};
use super::surface::{Surface, find, slips};
use crate::model::{Entry, IdentificationModel, Output};

/// A robot with its parameters, ready to be accelerated. Nothing is allocated after [`Dynamics::new`]
/// (the interpreter of a description allocates inside its own evaluation).
pub struct Dynamics<'a> {
    pub(super) model: &'a dyn IdentificationModel,
    pub(super) parameters: Vec<f64>,
    momentum: Lanes,
    inertia: Vec<Entry>,
    pub(super) explicit: Lanes,
    pub(super) smooth: Vec<Entry>,
    pub(super) surfaces: Vec<Surface>,
    /// First state of each surface in `explicit`.
    pub(super) places: Vec<usize>,
    /// M, n x n, row-major, and its Cholesky factor.
    mass: Vec<f64>,
    pub(super) factor: Vec<f64>,
    pub(super) bias: Vec<f64>,
    /// Half the jump of the torque on each surface that is not slid on, and M^-1 times it; K x n.
    pub(super) jumps: Vec<f64>,
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
    /// Orthonormal directions that all surfaces that stick span, as rows; their number.
    pub(super) basis: Vec<f64>,
    pub(super) rank: usize,
    /// Time, s, for what depends on it.
    pub(super) t: f64,
    /// Presliding states z/zs, one per joint; empty for a model without any.
    pub(super) slip: Vec<f64>,
    /// What acts beyond the columns of the model.
    pub(super) influences: Vec<Box<dyn Influence + 'a>>,
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
            rank: 0,
            t: 0.0,
            slip: slips(model),
            influences: Vec::new(),
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
        self.explicit.run(self.model, &self.slip);
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
        self.slide(qd);
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
        self.momentum.run(self.model, &self.slip);
        self.mass.fill(0.0);
        for entry in &self.inertia {
            let parameter = self.parameters[entry.column];
            for (j, element) in self.mass[entry.row * n..][..n].iter_mut().enumerate() {
                *element += parameter * self.momentum.signal(entry.signal, j);
            }
        }
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
