//! Effects that are to be told apart: the robot that has them, and their columns.

use idim::catalogue::{Effects, entries};
use idim::codegen::Robot;
use idim::codegen::describe::EffectSpec;
use idim::interpreted::Interpreter;
use idim::runtime::model::IdentificationModel;

use super::Failure;

/// A robot with further effects.
pub(super) struct Extended {
    pub robot: Robot,
    pub model: Interpreter,
    /// Columns of what is to be told apart, counted from 0.
    pub columns: Vec<usize>,
}

/// What is asked for: columns that are there, or effects to add.
enum Asked {
    Parameter(String),
    Effect(Vec<EffectSpec>),
}

/// The robot with all effects of a list, such as `stribeck@2`, `torque_ripple@elbow`, `FV2`.
///
/// # Errors
/// [`Failure::Usage`] for an effect, joint or parameter that is not known, or an effect that no
/// description can ask for.
pub(super) fn extended(robot: &Robot, list: &[String]) -> Result<Extended, Failure> {
    let catalogue = Effects::new(robot);
    let asked = list.iter().map(|item| asked(robot, &catalogue, item));
    let asked = asked.collect::<Result<Vec<Asked>, Failure>>()?;
    let specs: Vec<EffectSpec> = asked.iter().flat_map(specs).cloned().collect();
    let all = whole(&catalogue, &specs)?;
    let mut columns = Vec::new();
    for (asked, item) in asked.iter().zip(list) {
        let names = match asked {
            Asked::Parameter(name) => vec![name.clone()],
            Asked::Effect(specs) => added(robot, &whole(&catalogue, specs)?),
        };
        let places = names.iter().filter_map(|name| place(&all, name));
        let before = columns.len();
        columns.extend(places);
        if columns.len() == before {
            return Err(Failure::Usage {
                message: format!("`{item}` has no column of its own in the model of this robot"),
                help: "its parameter is regrouped with others: no motion tells them apart".into(),
            });
        }
    }
    columns.sort_unstable();
    columns.dedup();
    Ok(Extended {
        model: Interpreter::new(&all),
        robot: all,
        columns,
    })
}

impl Extended {
    /// Parameters of the robot without the effects for the one with them, which has zero for them.
    pub fn values(&self, model: &dyn IdentificationModel, values: &[f64]) -> Vec<f64> {
        let columns = model.columns();
        let value = |name: &str| {
            let place = columns.iter().position(|column| column.name == name);
            place.and_then(|place| values.get(place)).copied()
        };
        let all = self.model.columns().iter();
        all.map(|column| value(&column.name).unwrap_or(0.0))
            .collect()
    }
}

fn whole(catalogue: &Effects, specs: &[EffectSpec]) -> Result<Robot, Failure> {
    catalogue.extended(specs).map_err(|error| Failure::Usage {
        message: error.to_string(),
        help: "ask for fewer effects, or for others".into(),
    })
}

fn specs(asked: &Asked) -> &[EffectSpec] {
    match asked {
        Asked::Parameter(_) => &[],
        Asked::Effect(specs) => specs,
    }
}

/// Names of the parameters that one robot has and another has not.
fn added(robot: &Robot, extended: &Robot) -> Vec<String> {
    let names = extended.base.parameters.iter().map(|it| it.name.clone());
    names.filter(|name| place(robot, name).is_none()).collect()
}

fn place(robot: &Robot, name: &str) -> Option<usize> {
    let mut parameters = robot.base.parameters.iter();
    parameters.position(|parameter| parameter.name == name)
}

fn asked(robot: &Robot, catalogue: &Effects, item: &str) -> Result<Asked, Failure> {
    let Some((effect, joint)) = item.split_once('@') else {
        return match place(robot, item) {
            Some(_) => Ok(Asked::Parameter(item.to_owned())),
            None => Err(Failure::Usage {
                message: format!("the model has no parameter `{item}`"),
                help: "name a parameter (`idim describe` lists them) or an effect at a joint, such as stribeck@2".into(),
            }),
        };
    };
    let joint = joint_of(robot, joint)?;
    if !entries().iter().any(|entry| entry.name == effect) {
        let known: Vec<&str> = entries().iter().map(|entry| entry.name).collect();
        return Err(Failure::Usage {
            message: format!("there is no effect `{effect}`"),
            help: format!("the catalogue has {}", known.join(", ")),
        });
    }
    let specs = catalogue.asked(effect, joint);
    if specs.is_empty() {
        return Err(Failure::Usage {
            message: format!("`{item}` cannot be added to the model of this robot"),
            help: "the robot has it already (then name its parameter), or it is no column that a \
                   description can ask for"
                .into(),
        });
    }
    Ok(Asked::Effect(specs))
}

/// A joint by its number, from 1, or its name; counted from 0.
fn joint_of(robot: &Robot, text: &str) -> Result<usize, Failure> {
    let driven = robot.mechanism.driven;
    let joints = &robot.mechanism.joints[..driven];
    let number = text.parse::<usize>().ok().and_then(|k| k.checked_sub(1));
    let named = || joints.iter().position(|joint| joint.name == text);
    let found = number.or_else(named).filter(|joint| *joint < joints.len());
    found.ok_or_else(|| {
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        Failure::Usage {
            message: format!("there is no joint `{text}`"),
            help: format!("joints are 1 to {}: {}", joints.len(), names.join(", ")),
        }
    })
}
