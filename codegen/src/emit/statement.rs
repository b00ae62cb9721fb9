//! Expressions of the graph as Rust expressions.

use std::collections::HashSet;

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::naming::Names;
use crate::expr::{Expr, Function, Graph, Input, Node, schedule};

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
#[derive(Debug)]
pub struct Writer<'a> {
    graph: &'a Graph,
    named: HashSet<usize>,
    /// Names given so far.
    pub names: Names,
}

impl<'a> Writer<'a> {
    /// Decides for a set of outputs: what is used once and is short stands where it is used.
    pub fn new(graph: &'a Graph, outputs: &[Expr]) -> Writer<'a> {
        let uses = schedule::uses(graph, outputs);
        let mut named = HashSet::new();
        let mut size = vec![0usize; graph.nodes().len()];
        for index in 0..graph.nodes().len() {
            if uses[index] == 0 {
                continue;
            }
            let node = graph.nodes()[index];
            let inner: usize = schedule::operands(node).map(|x| size[x.node()]).sum();
            let operation = matches!(
                node,
                Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Call(..)
            );
            size[index] = inner + usize::from(operation);
            let shared = operation && uses[index] > 1;
            if shared || size[index] >= LONG {
                named.insert(index);
                size[index] = 0;
            }
        }
        Writer {
            graph,
            named,
            names: Names::default(),
        }
    }

    /// Whether a node has a statement of its own.
    pub fn is_named(&self, node: usize) -> bool {
        self.named.contains(&node)
    }

    /// `let name = ...;` for a named node.
    pub fn binding(&mut self, node: usize) -> TokenStream {
        let value = self.node(node).0;
        let name = self.names.of(self.graph, node);
        quote! { let #name = #value; }
    }

    /// An expression with its sign.
    pub fn value(&mut self, x: Expr) -> TokenStream {
        self.signed(x).0
    }

    fn signed(&mut self, x: Expr) -> (TokenStream, Level) {
        if !x.is_negative() {
            return self.reference(x.node());
        }
        if let (Node::Sub(a, b), false) = (self.graph.nodes()[x.node()], self.is_named(x.node())) {
            return self.difference(b, a);
        }
        let (inner, level) = self.reference(x.node());
        match level {
            Level::Sum => (quote! { -(#inner) }, Level::Product),
            _ => (quote! { -#inner }, Level::Product),
        }
    }

    /// A node where it is used: by its name, or written out.
    fn reference(&mut self, node: usize) -> (TokenStream, Level) {
        match self.graph.nodes()[node] {
            Node::Input(input) => (self::input(input), Level::Atom),
            Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => self.leaf(node),
            _ if self.is_named(node) => {
                let name = self.names.of(self.graph, node);
                (quote! { #name }, Level::Atom)
            }
            _ => self.node(node),
        }
    }

    fn leaf(&mut self, node: usize) -> (TokenStream, Level) {
        if node == self.graph.zero().node() {
            return (quote! { T::splat(0.0) }, Level::Atom);
        }
        if node == self.graph.one().node() {
            return (quote! { T::splat(1.0) }, Level::Atom);
        }
        let name = self.names.of(self.graph, node);
        match self.graph.nodes()[node] {
            Node::Constant(_) => (quote! { #name }, Level::Atom),
            _ => (quote! { x.#name }, Level::Atom),
        }
    }

    fn node(&mut self, node: usize) -> (TokenStream, Level) {
        match self.graph.nodes()[node] {
            Node::Add(a, b) => {
                let a = self.signed(a).0;
                let (b, level) = self.signed(b);
                let b = if level == Level::Sum {
                    quote! { (#b) }
                } else {
                    b
                };
                (quote! { #a + #b }, Level::Sum)
            }
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => {
                let (a, b) = (self.factor(a), self.factor(b));
                (quote! { #a * #b }, Level::Product)
            }
            Node::Call(function, a) => {
                let inner = self.factor(a);
                let call = match function {
                    Function::Sign => quote! { #inner.sign() },
                    Function::Abs => quote! { #inner.abs() },
                    Function::Tanh => quote! { #inner.tanh() },
                    Function::Bell => quote! { #inner.bell() },
                    Function::Power(p) => {
                        let p = Literal::f64_unsuffixed(f64::from_bits(p));
                        quote! { #inner.abs_power(#p) }
                    }
                    Function::Sine => quote! { #inner.sin_cos().0 },
                    Function::Cosine => quote! { #inner.sin_cos().1 },
                };
                (call, Level::Atom)
            }
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => {
                self.reference(node)
            }
        }
    }

    fn difference(&mut self, a: Expr, b: Expr) -> (TokenStream, Level) {
        let a = self.signed(a).0;
        let (b, level) = self.signed(b);
        let b = if level == Level::Sum {
            quote! { (#b) }
        } else {
            b
        };
        (quote! { #a - #b }, Level::Sum)
    }

    fn factor(&mut self, x: Expr) -> TokenStream {
        let (inner, level) = self.signed(x);
        let product = matches!(self.graph.nodes()[x.node()], Node::Mul(..));
        match level {
            Level::Sum => quote! { (#inner) },
            // Grouped as the graph has it: rounding is the same in every reader of the graph.
            Level::Product if product && !self.is_named(x.node()) => quote! { (#inner) },
            _ => inner,
        }
    }
}

/// `x.q[1]`, `x.qd[1]`, `x.qdd[1]`, `x.slip[1]`.
fn input(input: Input) -> TokenStream {
    let place = |joint: usize| Literal::usize_unsuffixed(joint);
    match input {
        Input::Q(joint) => {
            let joint = place(joint);
            quote! { x.q[#joint] }
        }
        Input::Qd(joint) => {
            let joint = place(joint);
            quote! { x.qd[#joint] }
        }
        Input::Qdd(joint) => {
            let joint = place(joint);
            quote! { x.qdd[#joint] }
        }
        Input::Slip(joint) => {
            let joint = place(joint);
            quote! { x.slip[#joint] }
        }
    }
}
