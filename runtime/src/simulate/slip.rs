//! Contacts that yield before they slide: their states along a simulation.

use super::dynamics::Dynamics;

impl Dynamics<'_> {
    /// Takes over the time and the presliding states, in the order of
    /// [`crate::model::IdentificationModel::presliding`], before forces are asked for.
    pub(super) fn deflect(&mut self, t: f64, slip: &[f64]) {
        self.t = t;
        for (contact, z) in self.model.presliding().iter().zip(slip) {
            self.slip[contact.joint] = *z;
        }
    }

    /// Lets every contact slide.
    pub(super) fn slide(&mut self, qd: &[f64]) {
        for contact in self.model.presliding() {
            self.slip[contact.joint] = side(qd[contact.joint]);
        }
    }

    /// The states where all slide, of joints that move, and undeflected, of those at rest.
    pub(super) fn sliding(&self, qd: &[f64]) -> Vec<f64> {
        let contacts = self.model.presliding().iter();
        contacts.map(|contact| side(qd[contact.joint])).collect()
    }

    /// The states after a way: \\( dz = dq - |dq| z / z_s \\) (Dahl 1968) depends on the way alone,
    /// and along one that does not turn round its solution is exact for any step. From the states
    /// `before` at `from` to those at `to`, positions of all joints.
    pub(super) fn slipped(&self, before: &[f64], (from, to): (&[f64], &[f64]), after: &mut [f64]) {
        let contacts = self.model.presliding().iter().zip(before).zip(after);
        for ((contact, before), after) in contacts {
            let way = to[contact.joint] - from[contact.joint];
            let end = side(way);
            *after = end + (before - end) * (-way.abs() / contact.zs).exp();
        }
    }
}

/// -1, 0 or 1.
fn side(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}
