//! Effects that are to be told apart: the robot that has them, and their columns.

use idim::catalogue::{Effects, WidenError, Widened, entries};
use idim::codegen::Robot;
use idim::codegen::describe::EffectSpec;

use super::Failure;

/// A robot with further effects.
pub(super) struct Extended {
    pub robot: Robot,
    pub model: Widened,
    /// Its present parameters, zero where they are new; `None` where none are known.
    pub values: Option<Vec<f64>>,
    /// Columns of what is to be told apart, counted from 0.
    pub columns: Vec<usize>,
}

/// What is asked for: columns that are there, effects to add, or effects that only the catalogue has
/// columns of, on joints counted from 0.
enum Asked {
    Parameter(String),
    Effect(Vec<EffectSpec>),
    Columns(String, Vec<usize>),
}

/// The robot with all effects of a list, such as `stribeck@2`, `torque_ripple@elbow`, `FV2`,
/// `base_tilt`, for one of present `values`.
///
/// # Errors
/// [`Failure::Usage`] for an effect, joint or parameter that is not known, or an effect that is no
/// torque of the present state.
pub(super) fn extended(
    robot: &Robot,
    values: Option<&[f64]>,
    list: &[String],
) -> Result<Extended, Failure> {
    let catalogue = Effects::new(robot);
    let asked = list.iter().map(|item| asked(robot, &catalogue, item));
    let asked = asked.collect::<Result<Vec<Asked>, Failure>>()?;
    let specs: Vec<EffectSpec> = asked.iter().flat_map(specs).cloned().collect();
    let all = whole(&catalogue, &specs)?;
    let values = values.map(|values| renamed(robot, &all, values));
    let mut model = Widened::new(&all, values.as_deref());
    let mut columns = Vec::new();
    for (asked, item) in asked.iter().zip(list) {
        let found = match asked {
            Asked::Parameter(name) => place(&all, name).into_iter().collect(),
            Asked::Effect(specs) => {
                let names = added(robot, &whole(&catalogue, specs)?);
                names.iter().filter_map(|name| place(&all, name)).collect()
            }
            Asked::Columns(effect, joints) => model.add(effect, joints).map_err(refused)?,
        };
        if found.is_empty() {
            return Err(Failure::Usage {
                message: format!("`{item}` has no column of its own in the model of this robot"),
                help: "its parameter is regrouped with others: no motion tells them apart".into(),
            });
        }
        columns.extend(found);
    }
    columns.sort_unstable();
    columns.dedup();
    Ok(Extended {
        values: values.map(|_| model.parameters()),
        model,
        robot: all,
        columns,
    })
}

/// Parameters of one robot for one with more of them, which has zero for the others.
fn renamed(robot: &Robot, all: &Robot, values: &[f64]) -> Vec<f64> {
    let value = |name: &str| values.get(place(robot, name)?).copied();
    let parameters = all.base.parameters.iter();
    parameters
        .map(|parameter| value(&parameter.name).unwrap_or(0.0))
        .collect()
}

fn refused(error: WidenError) -> Failure {
    Failure::Usage {
        message: error.to_string(),
        help: match error {
            WidenError::NotOfTheState(_) => "`idim diagnose --list` says what it is and which log shows it",
            WidenError::NoParameters(_) => "such as the JSON of `idim identify --json`",
            WidenError::NotThere(..) => {
                "name a joint it may act on (link_length@2), or none for the whole robot (base_tilt)"
            }
        }
        .into(),
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
        Asked::Parameter(_) | Asked::Columns(..) => &[],
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
    let known = |effect: &str| entries().iter().any(|entry| entry.name == effect);
    let Some((effect, joint)) = item.split_once('@') else {
        return match place(robot, item) {
            Some(_) => Ok(Asked::Parameter(item.to_owned())),
            None if known(item) => Ok(Asked::Columns(item.to_owned(), Vec::new())),
            None => Err(Failure::Usage {
                message: format!("the model has no parameter `{item}`"),
                help: "name a parameter (`idim describe` lists them) or an effect at a joint, such as stribeck@2".into(),
            }),
        };
    };
    let joint = joint_of(robot, joint)?;
    if !known(effect) {
        let known: Vec<&str> = entries().iter().map(|entry| entry.name).collect();
        return Err(Failure::Usage {
            message: format!("there is no effect `{effect}`"),
            help: format!("the catalogue has {}", known.join(", ")),
        });
    }
    if catalogue.can_be_described(effect) {
        return described(catalogue, effect, joint, item);
    }
    Ok(Asked::Columns(effect.to_owned(), vec![joint]))
}

fn described(
    catalogue: &Effects,
    effect: &str,
    joint: usize,
    item: &str,
) -> Result<Asked, Failure> {
    let specs = catalogue.asked(effect, joint);
    match specs.is_empty() {
        true => Err(Failure::Usage {
            message: format!("`{item}` cannot be added to the model of this robot"),
            help: "the robot has it already: name its parameter".into(),
        }),
        false => Ok(Asked::Effect(specs)),
    }
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
