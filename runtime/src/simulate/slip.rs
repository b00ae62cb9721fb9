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

    /// Their rates by Dahl's equation, \\( \dot z / z_s = (\dot q - |\dot q| z / z_s) / z_s \\), 1/s.
    pub(super) fn slip_rates(&self, qd: &[f64], slip: &[f64], rates: &mut [f64]) {
        let contacts = self.model.presliding().iter().zip(slip).zip(rates);
        for ((contact, z), rate) in contacts {
            let qd = qd[contact.joint];
            *rate = (qd - qd.abs() * z) / contact.zs;
        }
    }
}
