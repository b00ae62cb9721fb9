//! Expressions of the graph as text.

use std::collections::HashSet;
use std::mem::take;

use super::function::{Line, Statement};
use super::language::Language;
use super::naming::Names;
use crate::expr::{Expr, Graph, Input, Node, fusion, schedule};

/// Operations in one expression beyond which a value gets a name of its own.
const LONG: usize = 5;

/// How tightly an expression binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Atom,
}

/// Which values of a function are named, and which stand inside the expression that uses them.
pub struct Writer<'a> {
    graph: &'a Graph,
    language: &'a dyn Language,
    named: HashSet<usize>,
    /// Products that the sum they enter rounds.
    fused: Vec<bool>,
    names: Names,
    /// Since the last statement: what was read, and the operations that were written.
    reads: Vec<usize>,
    operations: usize,
}

impl<'a> Writer<'a> {
    /// Decides for a set of outputs: what is used once and is short stands where it is used.
    pub fn new(graph: &'a Graph, outputs: &[Expr], language: &'a dyn Language) -> Writer<'a> {
        let uses = schedule::uses(graph, outputs);
        let fused = match language.fuses() {
            true => fusion::fused(graph, &uses),
            false => vec![false; uses.len()],
        };
        Writer {
            graph,
            language,
            named: named(graph, &uses, &fused),
            fused,
            names: Names::new(graph, language.reserved()),
            reads: vec![],
            operations: 0,
        }
    }

    /// A line with what was read and computed since the last one.
    pub(super) fn statement(&mut self, line: Line, defines: Option<usize>) -> Statement {
        Statement {
            line,
            defines,
            reads: take(&mut self.reads),
            operations: take(&mut self.operations),
        }
    }

    /// Whether a node has a statement of its own.
    pub fn is_named(&self, node: usize) -> bool {
        self.named.contains(&node)
    }

    /// The name of a node.
    pub fn name(&mut self, node: usize) -> String {
        self.names.of(self.graph, node)
    }

    /// The value of a named node, written out.
    pub fn definition(&mut self, node: usize) -> String {
        self.node(node).0
    }

    /// An expression with its sign.
    pub fn value(&mut self, x: Expr) -> String {
        self.signed(x).0
    }

    fn signed(&mut self, x: Expr) -> (String, Level) {
        if !x.is_negative() {
            return self.reference(x.node());
        }
        if let (Node::Sub(a, b), false) = (self.graph.nodes()[x.node()], self.is_named(x.node())) {
            return self.difference(b, a);
        }
        let (inner, level) = self.reference(x.node());
        match level {
            Level::Sum => (format!("-({inner})"), Level::Product),
            _ => (format!("-{inner}"), Level::Product),
        }
    }

    /// A node where it is used: by its name, or written out.
    fn reference(&mut self, node: usize) -> (String, Level) {
        let text = match self.graph.nodes()[node] {
            Node::Input(Input::Parameter(_)) => self.name(node),
            Node::Input(input) => self.language.input(input),
            Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => self.leaf(node),
            _ if self.is_named(node) => self.name(node),
            _ => return self.node(node),
        };
        self.reads.push(node);
        (text, Level::Atom)
    }

    fn leaf(&mut self, node: usize) -> String {
        if node == self.graph.zero().node() {
            return self.language.number(0.0);
        }
        if node == self.graph.one().node() {
            return self.language.number(1.0);
        }
        let name = self.name(node);
        match self.graph.nodes()[node] {
            Node::Constant(_) => name,
            _ => self.language.trig(&name),
        }
    }

    fn node(&mut self, node: usize) -> (String, Level) {
        self.operations += 1;
        match self.graph.nodes()[node] {
            Node::Add(a, b) => {
                let a = self.signed(a).0;
                (format!("{a} + {}", self.term(b)), Level::Sum)
            }
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => (self.product(node, a, b), Level::Product),
            Node::Call(function, a) => {
                let (bare, factor) = (self.signed(a).0, self.factor(a));
                (self.language.call(function, &bare, &factor), Level::Atom)
            }
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => {
                self.reference(node)
            }
        }
    }

    fn product(&mut self, node: usize, a: Expr, b: Expr) -> String {
        let first = self.factor(a);
        if self.fused[node] {
            let second = self.signed(b).0;
            return self.language.times(&first, &second);
        }
        format!("{first} * {}", self.factor(b))
    }

    fn difference(&mut self, a: Expr, b: Expr) -> (String, Level) {
        let a = self.signed(a).0;
        (format!("{a} - {}", self.term(b)), Level::Sum)
    }

    /// An expression after a plus or a minus.
    fn term(&mut self, x: Expr) -> String {
        let (inner, level) = self.signed(x);
        match level {
            Level::Sum => format!("({inner})"),
            _ => inner,
        }
    }

    fn factor(&mut self, x: Expr) -> String {
        let (inner, level) = self.signed(x);
        let product = matches!(self.graph.nodes()[x.node()], Node::Mul(..));
        match level {
            Level::Sum => format!("({inner})"),
            // Grouped as the graph has it: rounding is the same in every reader of the graph.
            Level::Product if product && !self.is_named(x.node()) => format!("({inner})"),
            _ => inner,
        }
    }
}

/// The nodes with a name of their own.
fn named(graph: &Graph, uses: &[usize], fused: &[bool]) -> HashSet<usize> {
    let mut named = HashSet::new();
    let mut size = vec![0usize; graph.nodes().len()];
    for (index, &node) in graph.nodes().iter().enumerate() {
        if uses[index] == 0 {
            continue;
        }
        let inner: usize = schedule::operands(node).map(|x| size[x.node()]).sum();
        let operation = matches!(
            node,
            Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Call(..)
        );
        size[index] = inner + usize::from(operation);
        let shared = operation && uses[index] > 1;
        if !shared && size[index] < LONG {
            continue;
        }
        // A product that its sum rounds stands there: its longer factor gets a name instead.
        let longer = schedule::operands(node).max_by_key(|x| size[x.node()]);
        let longer = longer.filter(|_| fused[index]).map(Expr::node);
        named.insert(longer.unwrap_or(index));
        size[index] -= longer.map_or(size[index], |factor| take(&mut size[factor]));
    }
    named
}
