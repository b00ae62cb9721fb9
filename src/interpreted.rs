//! A robot that was never compiled in: the same graph as the emitted code, run as a tape.

use std::borrow::Cow;

use idim_codegen::derive::ParameterKind;
use idim_codegen::describe::{Description, EdgesSpec, FreedomSpec, VelocitySpec, WeightsSpec};
use idim_codegen::emit::signals::{Signals, signals};
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::knowledge;
use idim_codegen::mechanism::{self, Mechanism};
use idim_codegen::robot::{self, Robot};
use idim_runtime::knowledge::{Knowledge, Term};
use idim_runtime::model::{
    Column, ColumnKind, Entry, IdentificationModel, Joint, JointKind, Output, Pattern, Presliding,
    States,
};
use idim_runtime::settings::{Drives, Edges, Freedom, Settings, Velocity, Weights};

/// One output as a tape.
#[derive(Clone, Debug)]
struct Compiled {
    pattern: Pattern,
    tape: Tape,
}

/// The interpreter of a robot.
#[derive(Clone, Debug)]
pub struct Interpreter {
    name: String,
    joints: Vec<Joint>,
    columns: Vec<Column>,
    settings: Settings,
    knowledge: Knowledge,
    presliding: Vec<Presliding>,
    outputs: [Compiled; 5],
}

impl Interpreter {
    /// Compiles the tapes of all outputs.
    pub fn new(robot: &Robot) -> Interpreter {
        let compiled = |output| compile(robot, &signals(robot, output));
        Interpreter {
            name: robot.mechanism.name.clone(),
            joints: joints(&robot.mechanism),
            columns: robot.base.parameters.iter().map(column).collect(),
            settings: settings(robot),
            knowledge: knowledge(robot),
            presliding: presliding(robot),
            outputs: robot::Output::ALL.map(compiled),
        }
    }

    fn output(&self, output: Output) -> &Compiled {
        let place = match output {
            Output::Explicit => 0,
            Output::Momentum => 1,
            Output::Rest => 2,
            Output::Energy => 3,
            Output::Power => 4,
        };
        &self.outputs[place]
    }
}

impl IdentificationModel for Interpreter {
    fn name(&self) -> &str {
        &self.name
    }
    fn joints(&self) -> &[Joint] {
        &self.joints
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, output: Output) -> &Pattern {
        &self.output(output).pattern
    }
    fn settings(&self) -> &Settings {
        &self.settings
    }
    fn knowledge(&self) -> &Knowledge {
        &self.knowledge
    }
    fn presliding(&self) -> &[Presliding] {
        &self.presliding
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        let States {
            len,
            q,
            qd,
            qdd,
            slip,
        } = *states;
        let batch = Batch {
            len,
            q,
            qd,
            qdd,
            slip,
        };
        self.output(output).tape.run(&batch, signals);
    }
}

fn compile(robot: &Robot, signals: &Signals) -> Compiled {
    let entry = |&(row, column, signal): &(usize, usize, usize)| Entry {
        row,
        column,
        signal,
    };
    let entries: Vec<Entry> = signals.entries.iter().map(entry).collect();
    Compiled {
        pattern: Pattern {
            entries: Cow::Owned(entries),
            signals: signals.values.len(),
        },
        tape: Tape::among(&robot.graph, &signals.values, &signals.others),
    }
}

/// The driven joints, in the order of a log's columns.
pub fn joints(mechanism: &Mechanism) -> Vec<Joint> {
    let joint = |joint: &mechanism::Joint| Joint {
        name: Cow::Owned(joint.name.clone()),
        kind: match joint.kind {
            mechanism::JointKind::Revolute => JointKind::Revolute,
            mechanism::JointKind::Prismatic => JointKind::Prismatic,
        },
    };
    mechanism.driven().iter().map(joint).collect()
}

/// What leads from the drives to the joints.
pub fn drives(description: &Description) -> Drives {
    Drives {
        gains: Cow::Owned(description.drives.gains.clone()),
        coupling: Cow::Owned(description.drives.coupling.clone()),
    }
}

fn column(parameter: &idim_codegen::base::BaseParameter) -> Column {
    let kind = match parameter.kind {
        ParameterKind::Inertial(_) => ColumnKind::Inertial,
        ParameterKind::Drive => ColumnKind::Drive,
        ParameterKind::Friction => ColumnKind::Friction,
        ParameterKind::Effect => ColumnKind::Effect,
    };
    Column {
        name: Cow::Owned(parameter.name.clone()),
        unit: Cow::Owned(parameter.unit.clone()),
        joint: parameter.link + 1,
        kind,
        meaning: Cow::Owned(parameter.meaning.clone()),
        relation: Cow::Owned(parameter.relation_text()),
    }
}

fn presliding(robot: &Robot) -> Vec<Presliding> {
    let joints = robot.mechanism.presliding();
    joints.map(|(joint, zs)| Presliding { joint, zs }).collect()
}

fn settings(robot: &Robot) -> Settings {
    let spec = &robot.description.identify;
    Settings {
        fq_hz: spec.fq_hz,
        order: spec.order,
        nd: spec.nd,
        trim: spec.trim,
        border: spec.border,
        edges: spec.edges.map(|edges| match edges {
            EdgesSpec::Matlab => Edges::Matlab,
            EdgesSpec::Scipy => Edges::Scipy,
        }),
        weights: spec.weights.map(|weights| match weights {
            WeightsSpec::None => Weights::None,
            WeightsSpec::Joint => Weights::Joint,
            WeightsSpec::Robust => Weights::Robust,
        }),
        velocity: spec.velocity.map(|velocity| match velocity {
            VelocitySpec::Derived => Velocity::Derived,
            VelocitySpec::Measured => Velocity::Measured,
        }),
        prefilter_torque: spec.prefilter_torque,
        degrees_of_freedom: spec.degrees_of_freedom.map(|freedom| match freedom {
            FreedomSpec::Parameters => Freedom::Parameters,
            FreedomSpec::Mean => Freedom::Mean,
        }),
        drives: drives(&robot.description),
    }
}

fn knowledge(robot: &Robot) -> Knowledge {
    let known = knowledge::Knowledge::of(robot);
    let term = |term: &knowledge::Term| Term {
        column: term.column,
        link: term.link,
        parameter: term.parameter,
        factor: term.factor,
    };
    Knowledge {
        nominal: Cow::Owned(known.nominal),
        rigid: Cow::Owned(known.rigid),
        terms: known.terms.iter().map(term).collect(),
        prior: Cow::Owned(known.prior.concat()),
    }
}
