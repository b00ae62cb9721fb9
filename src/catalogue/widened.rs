//! A robot with columns that no description can ask for: what the catalogue adds at each state.

use idim_codegen::Robot;
use idim_runtime::diagnose::{Catalogue, Hypothesis, Signals, TorqueColumn};
use idim_runtime::knowledge::Knowledge;
use idim_runtime::model::{
    Column, ColumnKind, Entry, IdentificationModel, Joint, Output, Pattern, Presliding, States,
};
use idim_runtime::settings::Settings;

use super::Effects;
use crate::interpreted::Interpreter;

/// Effects that a description cannot ask for and whose torque follows from the state and the
/// present parameters alone, and whether it needs these.
const AT_STATES: [(&str, bool); 7] = [
    ("external_force", false),
    ("base_tilt", true),
    ("load_dependent_friction", true),
    ("drive_gain", true),
    ("drive_saturation", true),
    ("link_length", true),
    ("encoder_eccentricity", true),
];

/// States of a motion that shows where effects may act.
const STATES: usize = 64;

/// Why an effect has no columns.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WidenError {
    /// It has a memory, depends on derivatives of the torque, or is a part of the model.
    #[error(
        "`{0}` is no torque of the present state that can be added to the model: no motion is looked \
         for by it"
    )]
    NotOfTheState(String),
    /// Its torque is a share of the model's own.
    #[error("the torque of `{0}` follows from that of the robot; give its present --parameters")]
    NoParameters(String),
    /// It does not act there.
    #[error("`{0}` does not act on {1} of this robot")]
    NotThere(String, String),
}

/// An effect on joints with its shape, and the places of its columns.
#[derive(Debug)]
struct Wanted {
    hypothesis: Hypothesis,
    shape: Vec<f64>,
    /// Columns of the wider model.
    columns: Vec<usize>,
}

/// A model whose explicit form has further columns, which are zero in the other forms: to look for
/// motions, not to identify.
#[derive(Debug)]
pub struct Widened {
    model: Interpreter,
    effects: Effects,
    parameters: Vec<f64>,
    dead_band: Vec<f64>,
    wanted: Vec<Wanted>,
    columns: Vec<Column>,
    explicit: Pattern,
}

impl Widened {
    /// The model of a robot with its present parameters, without further columns yet.
    pub fn new(robot: &Robot, parameters: Option<&[f64]>) -> Widened {
        let model = Interpreter::new(robot);
        Widened {
            effects: Effects::new(robot),
            parameters: parameters.map_or(Vec::new(), <[f64]>::to_vec),
            dead_band: vec![0.0; model.joints().len()],
            wanted: Vec::new(),
            columns: model.columns().to_vec(),
            explicit: model.pattern(Output::Explicit).clone(),
            model,
        }
    }

    /// Adds the columns of an effect on joints, counted from 0; of the whole robot where there are
    /// none. Its shape is the one in the middle of those that a diagnosis would try. Returns the
    /// places of the columns.
    ///
    /// # Errors
    /// [`WidenError`].
    pub fn add(&mut self, name: &str, joints: &[usize]) -> Result<Vec<usize>, WidenError> {
        let known = AT_STATES.iter().find(|known| known.0 == name);
        let Some((_, of_torque)) = known else {
            return Err(WidenError::NotOfTheState(name.to_owned()));
        };
        if *of_torque && self.parameters.is_empty() {
            return Err(WidenError::NoParameters(name.to_owned()));
        }
        let (hypothesis, torque) = self.probed(name, joints).ok_or_else(|| {
            let place = match joints {
                [] => "the whole".to_owned(),
                joints => format!("joint {}", joints[0] + 1),
            };
            WidenError::NotThere(name.to_owned(), place)
        })?;
        let columns: Vec<usize> = torque.iter().map(|column| self.place(column)).collect();
        self.wanted.push(Wanted {
            shape: middle(&hypothesis),
            hypothesis,
            columns: columns.clone(),
        });
        self.explicit
            .entries
            .to_mut()
            .sort_by_key(|entry| (entry.row, entry.column));
        Ok(columns)
    }

    /// Present parameters, zero in the new columns; empty if they are not known.
    pub fn parameters(&self) -> Vec<f64> {
        let mut all = self.parameters.clone();
        if !all.is_empty() {
            all.resize(self.columns.len(), 0.0);
        }
        all
    }

    /// The hypothesis on these joints and its columns, if it may act there.
    fn probed(&self, name: &str, joints: &[usize]) -> Option<(Hypothesis, Vec<TorqueColumn>)> {
        let entry = self.effects.entries().iter().position(|e| e.name == name)?;
        let n = self.dead_band.len();
        // Turns of all joints at speeds that share no period.
        let phase = |k: usize| 0.7 * (k % STATES) as f64 * ((k / STATES + 2) as f64).sqrt();
        let series = |shift: f64| -> Vec<f64> {
            (0..n * STATES).map(|k| (phase(k) + shift).sin()).collect()
        };
        let (q, qd, qdd) = (series(0.0), series(1.0), series(2.0));
        let states = States {
            len: STATES,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            slip: &[],
        };
        self.along(&states, |signals| {
            let mut all = self.effects.hypotheses(signals).into_iter();
            let found = all.find(|h| h.entry == entry && h.joints == joints)?;
            let columns = self.effects.columns(&found, &middle(&found), signals);
            (!columns.is_empty()).then_some((found, columns))
        })
    }

    /// Makes room for a column.
    fn place(&mut self, column: &TorqueColumn) -> usize {
        let place = self.columns.len();
        for (row, _) in &column.torque {
            let signal = self.explicit.signals;
            self.explicit.signals += 1;
            self.explicit.entries.to_mut().push(Entry {
                row: *row,
                column: place,
                signal,
            });
        }
        let joint = column.torque.first().map_or(0, |(joint, _)| *joint);
        self.columns.push(Column {
            name: column.name.clone().into(),
            unit: column.unit.into(),
            joint: joint + 1,
            kind: ColumnKind::Effect,
            meaning: "effect of the catalogue".into(),
            relation: column.name.clone().into(),
        });
        place
    }

    /// Something of the catalogue's signals at states.
    fn along<T>(&self, states: &States<'_>, use_of: impl FnOnce(&Signals<'_>) -> T) -> T {
        let series = |values: &[f64]| -> Vec<Vec<f64>> {
            let joints = values.chunks(states.len.max(1));
            joints.map(<[f64]>::to_vec).collect()
        };
        let (q, qd, qdd) = (series(states.q), series(states.qd), series(states.qdd));
        let [all, rigid] = self.torque(states);
        let signals = Signals {
            rate_hz: 1.0,
            t: &vec![0.0; states.len],
            q: &q,
            qd: &qd,
            qdd: &qdd,
            tau_model: &all,
            tau_rigid: &rigid,
            parameters: &self.parameters,
            dead_band: &self.dead_band,
        };
        use_of(&signals)
    }

    /// Torque of the present parameters, and its rigid-body part with the rotors.
    fn torque(&self, states: &States<'_>) -> [Vec<Vec<f64>>; 2] {
        let pattern = self.model.pattern(Output::Explicit);
        let mut torque = [(); 2].map(|()| vec![vec![0.0; states.len]; self.dead_band.len()]);
        if self.parameters.is_empty() {
            return torque;
        }
        let mut signals = vec![0.0; pattern.signals * states.len];
        self.model.evaluate(Output::Explicit, states, &mut signals);
        for entry in pattern.entries.iter() {
            let kind = self.columns[entry.column].kind;
            let rigid = matches!(kind, ColumnKind::Inertial | ColumnKind::Drive);
            let factor = self.parameters[entry.column];
            let from = &signals[entry.signal * states.len..][..states.len];
            let parts = if rigid { 2 } else { 1 };
            for part in &mut torque[..parts] {
                let to = part[entry.row].iter_mut().zip(from);
                to.for_each(|(to, from)| *to += factor * from);
            }
        }
        torque
    }

    /// The columns of all effects at states, behind the signals of the model.
    fn widen(&self, states: &States<'_>, signals: &mut [f64]) {
        self.along(states, |along| {
            for wanted in &self.wanted {
                let Wanted {
                    hypothesis,
                    shape,
                    columns,
                } = wanted;
                let torque = self.effects.columns(hypothesis, shape, along);
                for (column, place) in torque.iter().zip(columns) {
                    let own = self.explicit.entries.iter().filter(|e| e.column == *place);
                    for entry in own {
                        let series = column.torque.iter().find(|(row, _)| *row == entry.row);
                        if let Some((_, series)) = series {
                            let to = &mut signals[entry.signal * states.len..][..states.len];
                            to.copy_from_slice(series);
                        }
                    }
                }
            }
        });
    }
}

/// The shape in the middle of those that a diagnosis tries.
fn middle(hypothesis: &Hypothesis) -> Vec<f64> {
    let place = hypothesis.grid.len().saturating_sub(1) / 2;
    hypothesis.grid.get(place).cloned().unwrap_or_default()
}

impl IdentificationModel for Widened {
    fn name(&self) -> &str {
        self.model.name()
    }
    fn joints(&self) -> &[Joint] {
        self.model.joints()
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, output: Output) -> &Pattern {
        match output {
            Output::Explicit => &self.explicit,
            other => self.model.pattern(other),
        }
    }
    fn settings(&self) -> &Settings {
        self.model.settings()
    }
    fn knowledge(&self) -> &Knowledge {
        self.model.knowledge()
    }
    fn presliding(&self) -> &[Presliding] {
        self.model.presliding()
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        let own = self.model.pattern(output).signals * states.len;
        self.model.evaluate(output, states, &mut signals[..own]);
        if output == Output::Explicit && !self.wanted.is_empty() {
            self.widen(states, signals);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use idim_codegen::builder::read_texts;

    const ARM: &str = "[[joint]]\nname = \"a\"\nkind = \"revolute\"\nalpha = \"pi/2\"\n\
        [[joint]]\nname = \"b\"\nkind = \"revolute\"\nd = 0.4\n";

    fn states<'a>(q: &'a [f64], qd: &'a [f64], qdd: &'a [f64]) -> States<'a> {
        States {
            len: 1,
            q,
            qd,
            qdd,
            slip: &[],
        }
    }

    /// Value of an entry of D.
    fn entry(model: &dyn IdentificationModel, at: (usize, usize), states: &States<'_>) -> f64 {
        let pattern = model.pattern(Output::Explicit);
        let mut signals = vec![0.0; pattern.signals];
        model.evaluate(Output::Explicit, states, &mut signals);
        let own = pattern.entries.iter().filter(|e| (e.row, e.column) == at);
        own.map(|entry| signals[entry.signal]).sum()
    }

    #[test]
    fn columns_are_the_torque_they_are_shares_of() {
        let robot = read_texts(&[("arm.toml", ARM)]).unwrap();
        let n = robot.base.parameters.len();
        let values: Vec<f64> = (0..n).map(|k| 0.5 + 0.1 * k as f64).collect();
        let mut model = Widened::new(&robot, Some(&values));
        let gain = model.add("drive_gain", &[1]).unwrap();
        let load = model.add("load_dependent_friction", &[0]).unwrap();
        assert_eq!((gain, load), (vec![n], vec![n + 1]));
        assert_eq!(model.parameters().len(), n + 2);
        let states = states(&[0.3, -0.7], &[-0.9, 1.1], &[2.0, -1.5]);
        let torque = |row: usize, wanted: fn(ColumnKind) -> bool| -> f64 {
            let columns = model.columns().iter().enumerate().take(n);
            let wanted = columns.filter(|(_, column)| wanted(column.kind));
            wanted
                .map(|(k, _)| values[k] * entry(&model, (row, k), &states))
                .sum()
        };
        let all = torque(1, |_| true);
        assert!((entry(&model, (1, n), &states) - all).abs() < 1e-12);
        assert_eq!(entry(&model, (0, n), &states), 0.0);
        let rigid = torque(0, |kind| {
            matches!(kind, ColumnKind::Inertial | ColumnKind::Drive)
        });
        // The first joint turns backwards.
        assert!((entry(&model, (0, n + 1), &states) + rigid.abs()).abs() < 1e-12);
    }

    #[test]
    fn tilted_base_is_the_torque_of_turned_gravity_to_first_order() {
        let robot = read_texts(&[("arm.toml", ARM)]).unwrap();
        let angle: f64 = 1e-5;
        let (sin, cos) = angle.sin_cos();
        // Gravity as a base turned about x by the angle sees it.
        let gravity = format!("gravity = [0.0, {}, {}]\n{ARM}", -9.81 * sin, -9.81 * cos);
        let tilted = read_texts(&[("arm.toml", gravity.as_str())]).unwrap();
        let n = robot.base.parameters.len();
        let values: Vec<f64> = (0..n).map(|k| 0.5 + 0.1 * k as f64).collect();
        let mut model = Widened::new(&robot, Some(&values));
        let columns = model.add("base_tilt", &[]).unwrap();
        let states = states(&[0.3, -0.7], &[0.0; 2], &[0.0; 2]);
        let torque = |model: &dyn IdentificationModel, row: usize| -> f64 {
            let all = values.iter().enumerate();
            all.map(|(k, x)| x * entry(model, (row, k), &states)).sum()
        };
        let other = Interpreter::new(&tilted);
        let names = |model: &dyn IdentificationModel| -> Vec<String> {
            let columns = model.columns().iter().take(n);
            columns.map(|column| column.name.to_string()).collect()
        };
        assert_eq!(names(&other), names(&model));
        for row in 0..2 {
            let change = (torque(&other, row) - torque(&model, row)) / angle;
            let column = entry(&model, (row, columns[0]), &states);
            assert!(
                (change.abs() - column.abs()).abs() < 1e-3,
                "{change} {column}"
            );
        }
    }

    #[test]
    fn what_has_no_column_at_a_state_is_said() {
        let robot = read_texts(&[("arm.toml", ARM)]).unwrap();
        let mut bare = Widened::new(&robot, None);
        let refused = bare.add("drive_gain", &[0]).unwrap_err();
        assert_eq!(refused, WidenError::NoParameters("drive_gain".into()));
        let refused = bare.add("backlash", &[0]).unwrap_err();
        assert!(matches!(refused, WidenError::NotOfTheState(_)));
        let refused = bare.add("external_force", &[0]).unwrap_err();
        let wanted = WidenError::NotThere("external_force".into(), "joint 1".into());
        assert_eq!(refused, wanted);
        // FX, FY, FZ need no parameters; no motion of a planar arm shows all three.
        let columns = bare.add("external_force", &[]).unwrap();
        assert_eq!(columns.len(), 3);
    }
}
