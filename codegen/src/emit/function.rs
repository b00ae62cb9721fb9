//! One emitted function: constants, then body by body what is computed and what is stored.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::comment;
use super::statement::Writer;
use crate::base::BaseParameter;
use crate::derive::ParameterKind;
use crate::expr::{Expr, Node, schedule};
use crate::robot::{Entry, Output, Robot};

/// An output of a function and the name of the argument it goes to.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The output.
    pub output: Output,
    /// Argument name: `d`, `p`, `r`, `h`, `dh`.
    pub argument: &'static str,
}

/// Statements that compute and store all non-zero entries of the targets.
pub fn body(robot: &Robot, targets: &[Target]) -> TokenStream {
    let stores: Vec<Store> = targets
        .iter()
        .flat_map(|target| {
            let argument = format_ident!("{}", target.argument);
            let matrix = !matches!(target.output, Output::Energy | Output::Power);
            robot
                .entries(target.output)
                .into_iter()
                .map(move |entry| Store {
                    argument: argument.clone(),
                    matrix,
                    entry,
                })
        })
        .collect();
    let outputs: Vec<Expr> = stores.iter().map(|store| store.entry.value).collect();
    let mut needed = schedule::order(&robot.graph, &outputs);
    needed.sort_unstable();
    let mut writer = Writer::new(&robot.graph, &outputs);
    let constants = constants(robot, &needed, &mut writer);
    let mut statements = TokenStream::new();
    for section in sections(robot) {
        statements.extend(self::section(
            robot,
            &section,
            &needed,
            &stores,
            &mut writer,
        ));
    }
    quote! { #constants #statements }
}

struct Store {
    argument: Ident,
    matrix: bool,
    entry: Entry,
}

/// A part of the function: the share of one link, or what comes after all links.
struct Section {
    title: String,
    nodes: Vec<usize>,
    columns: Vec<usize>,
}

/// One section per link, then one for the effects. A column belongs to the first section at whose
/// end all its entries are known.
fn sections(robot: &Robot) -> Vec<Section> {
    let links = robot.mechanism.joints.iter().enumerate();
    let mut sections: Vec<Section> = links
        .map(|(link, joint)| format!("Link {}, carried by {}.", link + 1, joint.name))
        .chain(["Drives, friction and other effects.".to_owned()])
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
                known.unwrap_or(0).max(parameter.link)
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
        let operands = schedule::operands(node).map(|operand| places[operand.node()]);
        let place = link.or(operands.max()).unwrap_or(robot.ends.len());
        places.push(place);
    }
    places
}

fn values(parameter: &BaseParameter) -> impl Iterator<Item = Expr> + '_ {
    let columns = &parameter.columns;
    let lists = [&columns.explicit, &columns.momentum, &columns.rest];
    let entries = lists.into_iter().flatten().map(|&(_, entry)| entry);
    entries.chain(columns.energy).chain(columns.power)
}

fn section(
    robot: &Robot,
    section: &Section,
    needed: &[usize],
    stores: &[Store],
    writer: &mut Writer<'_>,
) -> TokenStream {
    let mut statements = TokenStream::new();
    for &node in &section.nodes {
        if needed.binary_search(&node).is_ok() && writer.is_named(node) {
            statements.extend(writer.binding(node));
        }
    }
    for store in stores
        .iter()
        .filter(|store| section.columns.contains(&store.entry.column))
    {
        let value = writer.value(store.entry.value);
        let (argument, row, column) = (
            &store.argument,
            Literal::usize_unsuffixed(store.entry.row),
            Literal::usize_unsuffixed(store.entry.column),
        );
        let note = comment::note(&robot.base.parameters[store.entry.column].name);
        statements.extend(match store.matrix {
            true => quote! { #argument[#row][#column] = #value; #note },
            false => quote! { #argument[#column] = #value; #note },
        });
    }
    if statements.is_empty() {
        return statements;
    }
    let title = comment::comment(&section.title);
    quote! { #title #statements }
}

fn constants(robot: &Robot, needed: &[usize], writer: &mut Writer<'_>) -> TokenStream {
    let (zero, one) = (robot.graph.zero().node(), robot.graph.one().node());
    let mut statements = TokenStream::new();
    for &node in needed {
        if let Node::Constant(bits) = robot.graph.nodes()[node] {
            if node == zero || node == one {
                continue;
            }
            let name = writer.names.of(&robot.graph, node);
            let value = Literal::f64_unsuffixed(f64::from_bits(bits));
            statements.extend(quote! { let #name = T::splat(#value); });
        }
    }
    statements
}
