//! One emitted function, language by language the same: sines and cosines, constants, then body by
//! body what is computed and what is stored. A long one comes in parts ([`super::parts`]).

use super::angles::{self, Trig};
use super::language::Language;
use super::parts;
use super::statement::Writer;
use crate::base::BaseParameter;
use crate::derive::ParameterKind;
use crate::expr::{Expr, Graph, Input, Node, schedule};
use crate::functions::Function;
use crate::robot::{Output, Robot};

/// An output of a function and the name of the argument it goes to.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The output.
    pub output: Output,
    /// Argument name, such as `d`.
    pub argument: &'static str,
}

/// What a function does, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// One, or several to be called one after the other.
    pub parts: Vec<Part>,
    /// Values that parts hand on to later ones at a time: the length of the scratch array.
    pub live: usize,
}

/// A function, or a part of a long one.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The inputs that it reads, ascending.
    pub inputs: Vec<Input>,
    /// The sines and cosines that it is the first to need.
    pub trig: Vec<Trig>,
    /// Loads, constants, values and stores.
    pub lines: Vec<Line>,
}

/// A line of a function.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// The share of a link begins, or that of the effects.
    Section(String),
    /// A value of an earlier part comes from the scratch array.
    Load {
        /// The name.
        name: String,
        /// Its place.
        place: usize,
    },
    /// A constant gets a name.
    Constant {
        /// The name.
        name: String,
        /// Its value, positive.
        value: f64,
    },
    /// A value gets a name.
    Value {
        /// The name.
        name: String,
        /// The value.
        value: String,
    },
    /// A value goes to the scratch array for a later part.
    Keep {
        /// The name.
        name: String,
        /// Its place.
        place: usize,
    },
    /// A value goes to an output.
    Store {
        /// Argument of the function.
        argument: &'static str,
        /// Row, if the output has more than one.
        row: Option<usize>,
        /// Column.
        column: usize,
        /// The value.
        value: String,
        /// Name of the parameter whose column it is, or nothing.
        parameter: String,
    },
}

/// A line with what the division into parts has to know of it.
#[derive(Clone, Debug)]
pub(super) struct Statement {
    pub line: Line,
    /// The node that it gives a name.
    pub defines: Option<usize>,
    /// Names, sines, cosines, constants and inputs that it reads, by node.
    pub reads: Vec<usize>,
    /// Sums and products.
    pub operations: usize,
}

impl Part {
    /// The arguments that it stores to, in the order of the first stores.
    pub fn outputs(&self) -> Vec<&'static str> {
        let mut outputs = vec![];
        for line in &self.lines {
            match line {
                Line::Store { argument, .. } if !outputs.contains(argument) => {
                    outputs.push(*argument);
                }
                _ => {}
            }
        }
        outputs
    }
}

impl Body {
    /// The inputs that any part reads, ascending.
    pub fn inputs(&self) -> Vec<Input> {
        let all = self.parts.iter().flat_map(|part| part.inputs.clone());
        let mut inputs: Vec<Input> = all.collect();
        inputs.sort_unstable();
        inputs.dedup();
        inputs
    }
}

/// Computes and stores all non-zero entries of the targets.
pub fn body(robot: &Robot, targets: &[Target], language: &dyn Language) -> Body {
    let sections = sections(robot, "");
    let stores: Vec<Store> = (targets.iter())
        .flat_map(|target| stores(robot, *target, &sections))
        .collect();
    write(robot, &sections, &stores, language)
}

/// Computes and stores all entries of a function beside the identification models.
pub fn body_of(
    robot: &Robot,
    function: &Function,
    argument: &'static str,
    language: &dyn Language,
) -> Body {
    let sections = sections(robot, function.course());
    let matrix = function.extents().0.is_some();
    let rows = function.entries.iter().enumerate();
    let stores: Vec<Store> = rows
        .flat_map(|(row, values)| {
            let values = values.iter().enumerate();
            values.map(move |(column, &value)| (row, column, value))
        })
        .map(|(row, column, value)| Store {
            argument,
            row: matrix.then_some(row),
            column,
            value,
            parameter: String::new(),
            section: robot.ends.len() + 1,
        })
        .collect();
    write(robot, &sections, &stores, language)
}

fn write(robot: &Robot, sections: &[Section], stores: &[Store], language: &dyn Language) -> Body {
    let outputs: Vec<Expr> = stores.iter().map(|store| store.value).collect();
    let mut needed = schedule::order(&robot.graph, &outputs);
    needed.sort_unstable();
    let mut writer = Writer::new(&robot.graph, &outputs, language);
    // Constants first: they have the first choice of names.
    let folded = [robot.graph.zero().node(), robot.graph.one().node()];
    for &node in needed.iter().filter(|node| !folded.contains(node)) {
        if matches!(robot.graph.nodes()[node], Node::Constant(_)) {
            writer.name(node);
        }
    }
    let statements = (sections.iter().enumerate())
        .flat_map(|(place, section)| {
            let stores = stores.iter().filter(|store| store.section == place);
            self::section(section, &needed, stores, &mut writer)
        })
        .collect();
    parts::divide(&robot.graph, statements, &mut writer, language)
}

/// The inputs among the nodes that are read, and those behind the sines and cosines.
pub(super) fn inputs(graph: &Graph, read: &[usize], trig: &[Trig]) -> Vec<Input> {
    let read = read.iter().filter_map(|&node| match graph.nodes()[node] {
        Node::Input(input) => Some(input),
        _ => None,
    });
    let angles = trig.iter().flat_map(|trig| &trig.angle.terms);
    let turned = angles.map(|&(joint, _)| Input::Q(joint));
    let mut inputs: Vec<Input> = read.chain(turned).collect();
    inputs.sort_unstable();
    inputs.dedup();
    inputs
}

struct Store {
    argument: &'static str,
    row: Option<usize>,
    column: usize,
    value: Expr,
    parameter: String,
    section: usize,
}

fn stores(robot: &Robot, target: Target, sections: &[Section]) -> Vec<Store> {
    let matrix = target.output.is_matrix();
    let of_column = |column: usize| sections.iter().position(|s| s.columns.contains(&column));
    let entries = robot.entries(target.output).into_iter();
    entries
        .map(|entry| Store {
            argument: target.argument,
            row: matrix.then_some(entry.row),
            column: entry.column,
            value: entry.value,
            parameter: robot.base.parameters[entry.column].name.clone(),
            section: of_column(entry.column).unwrap_or(robot.ends.len()),
        })
        .collect()
}

/// A part of the function: the share of one link, or what comes after all links.
struct Section {
    title: String,
    nodes: Vec<usize>,
    columns: Vec<usize>,
}

/// One section per link from the base outwards, then one for the effects, then one for what is
/// beside the models. A column belongs to the first section at whose end all its entries are known.
fn sections(robot: &Robot, course: &str) -> Vec<Section> {
    let (joints, order) = (&robot.mechanism.joints, &robot.mechanism.order);
    let links = order.iter().map(|&link| (link, &joints[link]));
    let mut sections: Vec<Section> = links
        .map(|(link, joint)| format!("Link {}, carried by {}.", link + 1, joint.name))
        .chain(["Drives, friction and other effects.".to_owned()])
        .chain([course.to_owned()])
        .map(|title| Section {
            title,
            nodes: vec![],
            columns: vec![],
        })
        .collect();
    let places = places(robot);
    for (node, &place) in places.iter().enumerate() {
        sections[place].nodes.push(node);
    }
    for (column, parameter) in robot.base.parameters.iter().enumerate() {
        let place = match parameter.kind {
            ParameterKind::Inertial(_) => {
                let known = values(parameter).map(|value| places[value.node()]).max();
                let own = order.iter().position(|&link| link == parameter.link);
                known.max(own).unwrap_or(0)
            }
            _ => robot.ends.len(),
        };
        sections[place].columns.push(column);
    }
    sections
}

/// The section of every node: the link in whose share it was derived; what was rewritten later
/// goes with the last of its operands.
fn places(robot: &Robot) -> Vec<usize> {
    let graph = &robot.graph;
    let mut places: Vec<usize> = Vec::with_capacity(graph.nodes().len());
    for (index, &node) in graph.nodes().iter().enumerate() {
        let link = robot.ends.iter().position(|&end| index < end);
        let beside = (index >= robot.models_end).then_some(robot.ends.len() + 1);
        let operands = schedule::operands(node).map(|operand| places[operand.node()]);
        let place = link.or(beside).or(operands.max());
        places.push(place.unwrap_or(robot.ends.len()));
    }
    places
}

fn values(parameter: &BaseParameter) -> impl Iterator<Item = Expr> + '_ {
    let columns = &parameter.columns;
    let lists = [&columns.explicit, &columns.momentum, &columns.rest];
    let entries = lists.into_iter().flatten().map(|&(_, entry)| entry);
    entries.chain(columns.energy).chain(columns.power)
}

fn section<'a>(
    section: &Section,
    needed: &[usize],
    stores: impl Iterator<Item = &'a Store>,
    writer: &mut Writer<'_>,
) -> Vec<Statement> {
    let mut statements = Vec::new();
    for &node in &section.nodes {
        if needed.binary_search(&node).is_ok() && writer.is_named(node) {
            let value = writer.definition(node);
            let name = writer.name(node);
            statements.push(writer.statement(Line::Value { name, value }, Some(node)));
        }
    }
    for store in stores {
        let line = Line::Store {
            argument: store.argument,
            row: store.row,
            column: store.column,
            value: writer.value(store.value),
            parameter: store.parameter.clone(),
        };
        statements.push(writer.statement(line, None));
    }
    if !statements.is_empty() {
        let title = Line::Section(section.title.clone());
        statements.insert(0, writer.statement(title, None));
    }
    statements
}

/// The sines and cosines among some nodes.
pub(super) fn trig(graph: &Graph, nodes: &[usize]) -> Vec<Trig> {
    angles::trig(graph, nodes)
}
