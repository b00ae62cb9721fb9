//! Long functions in parts, so that the time to compile them grows with their length alone.
//!
//! Compilers take more than twice as long for a function of twice the length. A function is cut
//! where the share of a link ends; what later parts need goes through a scratch array, whose
//! places are used again as soon as the last reader of a value is done.

use std::collections::{HashMap, HashSet};

use super::function::{Body, Line, Part, Statement, inputs, trig};
use super::language::Language;
use super::statement::Writer;
use crate::expr::{Graph, Input, Node};

/// Operations up to which a function stays in one piece: those of an arm of seven joints.
const WHOLE: usize = 1500;

/// Operations from which on a part ends with the share of a link.
const ENOUGH: usize = 500;

/// Most operations of a part; a longer share of a link is cut within.
const MOST: usize = 1000;

/// Divides the statements of a function, and adds what hands values on.
pub(super) fn divide(
    graph: &Graph,
    statements: Vec<Statement>,
    writer: &mut Writer<'_>,
    language: &dyn Language,
) -> Body {
    let pieces = cut(statements);
    let mut scratch = Scratch::new(graph, &pieces, language.computes_trig());
    let pieces = pieces.into_iter().enumerate();
    let parts =
        pieces.map(|(index, piece)| part(graph, index, piece, &mut scratch, writer, language));
    Body {
        parts: parts.collect(),
        live: scratch.length,
    }
}

fn cut(statements: Vec<Statement>) -> Vec<Vec<Statement>> {
    let total: usize = statements.iter().map(|s| s.operations).sum();
    if total <= WHOLE {
        return vec![statements];
    }
    let mut pieces = vec![vec![]];
    let mut operations = 0;
    for statement in statements {
        let link_ends = matches!(statement.line, Line::Section(_)) && operations >= ENOUGH;
        if link_ends || operations + statement.operations > MOST {
            pieces.push(vec![]);
            operations = 0;
        }
        operations += statement.operations;
        if let Some(piece) = pieces.last_mut() {
            piece.push(statement);
        }
    }
    pieces
}

/// Which values live in the scratch array, and where.
struct Scratch {
    /// The last part that reads a value of an earlier one.
    last: HashMap<usize, usize>,
    /// The part that has a value first.
    first: HashMap<usize, usize>,
    places: HashMap<usize, usize>,
    free: Vec<usize>,
    length: usize,
}

impl Scratch {
    fn new(graph: &Graph, pieces: &[Vec<Statement>], trig: bool) -> Scratch {
        let mut first = HashMap::new();
        let mut last = HashMap::new();
        for (index, piece) in pieces.iter().enumerate() {
            for statement in piece {
                for &node in &statement.reads {
                    // A sine or cosine that is no field of the state belongs to its first reader.
                    let computed =
                        trig && matches!(graph.nodes()[node], Node::Sin(_) | Node::Cos(_));
                    let home = match computed {
                        true => Some(*first.entry(node).or_insert(index)),
                        false => first.get(&node).copied(),
                    };
                    if home.is_some_and(|home| home < index) {
                        last.insert(node, index);
                    }
                }
                if let Some(node) = statement.defines {
                    first.insert(node, index);
                }
            }
        }
        Scratch {
            last,
            first,
            places: HashMap::new(),
            free: vec![],
            length: 0,
        }
    }

    /// The place of a value that a part has first, if a later one reads it.
    fn keep(&mut self, node: usize) -> Option<usize> {
        self.last.get(&node)?;
        let place = self.free.pop().unwrap_or_else(|| {
            self.length += 1;
            self.length - 1
        });
        self.places.insert(node, place);
        Some(place)
    }

    /// The place of a value of an earlier part; free again if this part is its last reader.
    fn load(&mut self, node: usize, part: usize) -> Option<usize> {
        let place = *self.places.get(&node)?;
        if self.last.get(&node) == Some(&part) {
            self.free.push(place);
        }
        Some(place)
    }

    /// Whether the part is the first to need a sine or cosine that it has to compute.
    fn computes(&self, node: usize, part: usize) -> bool {
        self.first.get(&node) == Some(&part)
    }
}

fn part(
    graph: &Graph,
    index: usize,
    statements: Vec<Statement>,
    scratch: &mut Scratch,
    writer: &mut Writer<'_>,
    language: &dyn Language,
) -> Part {
    let read = read(&statements);
    let is_trig = |node: &usize| matches!(graph.nodes()[*node], Node::Sin(_) | Node::Cos(_));
    let computed = |node: &usize| is_trig(node) && scratch.computes(*node, index);
    let own: Vec<usize> = read.iter().copied().filter(computed).collect();
    let defined: HashSet<usize> = statements.iter().filter_map(|s| s.defines).collect();
    let mut lines = vec![];
    // All loads come before what may take their places.
    for &node in read
        .iter()
        .filter(|node| !defined.contains(node) && !own.contains(node))
    {
        if let Some(place) = scratch.load(node, index) {
            let name = writer.name(node);
            lines.push(Line::Load { name, place });
        }
    }
    let mut keep = |node: usize, writer: &mut Writer<'_>| {
        let place = scratch.keep(node)?;
        let name = writer.name(node);
        Some(Line::Keep { name, place })
    };
    for &node in &own {
        lines.extend(keep(node, writer));
    }
    lines.extend(constants(graph, &read, writer));
    for &node in &read {
        if let Node::Input(input @ Input::Parameter(_)) = graph.nodes()[node] {
            let (name, value) = (writer.name(node), language.input(input));
            lines.push(Line::Value { name, value });
        }
    }
    for statement in statements {
        lines.push(statement.line);
        lines.extend(statement.defines.and_then(|node| keep(node, writer)));
    }
    let trig = trig(graph, &own);
    Part {
        inputs: inputs(graph, &read, &trig),
        trig,
        lines,
    }
}

/// What the statements read, ascending.
fn read(statements: &[Statement]) -> Vec<usize> {
    let mut read: Vec<usize> = statements.iter().flat_map(|s| s.reads.clone()).collect();
    read.sort_unstable();
    read.dedup();
    read
}

fn constants(graph: &Graph, read: &[usize], writer: &mut Writer<'_>) -> Vec<Line> {
    let known = [graph.zero().node(), graph.one().node()];
    let constant = |&node: &usize| match graph.nodes()[node] {
        Node::Constant(bits) if !known.contains(&node) => Some(Line::Constant {
            name: writer.name(node),
            value: f64::from_bits(bits),
        }),
        _ => None,
    };
    read.iter().filter_map(constant).collect()
}
