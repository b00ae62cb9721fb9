//! The arena of hash-consed nodes and its smart constructors.
//!
//! Signs live on the edges: an [`Expr`] is a node and a sign, so that `-(a*b)` and `a*b` are one
//! node and a negation costs nothing. Constructors fold 0, 1, -1 and constants, order commutative
//! operands and merge what is written twice. What has two forms that no constructor can see to be
//! equal is found later, by value ([`substitute`](super::substitute)).

use std::collections::HashMap;

use super::angle::{Angle, AngleSum};

/// A node of the graph, or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Expr {
    node: u32,
    negative: bool,
}

impl Expr {
    /// The node of an index.
    pub(super) fn of(node: usize) -> Expr {
        Expr {
            node: node as u32,
            negative: false,
        }
    }

    /// Index of the node in the arena.
    pub fn node(self) -> usize {
        self.node as usize
    }

    /// Whether the edge carries a minus sign.
    pub fn is_negative(self) -> bool {
        self.negative
    }

    /// The same node without its sign.
    pub fn positive(self) -> Expr {
        Expr {
            negative: false,
            ..self
        }
    }

    /// The same, or its negative.
    pub(super) fn signed(self, negative: bool) -> Expr {
        Expr {
            negative: self.negative ^ negative,
            ..self
        }
    }
}

impl std::ops::Neg for Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        self.signed(true)
    }
}

/// What the graph is a function of; joints count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// Position of a joint.
    Q(usize),
    /// Velocity of a joint.
    Qd(usize),
    /// Acceleration of a joint.
    Qdd(usize),
    /// Presliding state of a joint, z/zs: between -1 and 1, the sign of the velocity in sliding.
    Slip(usize),
    /// A base parameter, by its column.
    Parameter(usize),
}

/// Functions that are neither sums nor products. All but roots are odd or even.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// Sign, 0 at 0 (odd).
    Sign,
    /// Absolute value (even).
    Abs,
    /// Hyperbolic tangent (odd).
    Tanh,
    /// exp(-x^2) (even).
    Bell,
    /// |x|^p (even); p > 0 by its bits.
    Power(u64),
    /// Sine of any expression (odd); angles of joints are [`Node::Sin`].
    Sine,
    /// Cosine of any expression (even).
    Cosine,
    /// 1/x (odd).
    Reciprocal,
    /// Square root; NaN below 0. Neither odd nor even.
    Root,
    /// Square root of -x: what a root becomes whose operand's sign is pulled out.
    RootOfOpposite,
}

impl Function {
    /// Whether f(-x) = -f(x); the others have f(-x) = f(x).
    fn is_odd(self) -> bool {
        use Function::{Reciprocal, Sign, Sine, Tanh};
        matches!(self, Sign | Tanh | Sine | Reciprocal)
    }
}

/// A node. Operands of sums and products are positive: signs are pulled out to the edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A non-negative constant, by its bits.
    Constant(u64),
    /// An input.
    Input(Input),
    /// Sine of an angle, by its index in the graph's table of angles.
    Sin(usize),
    /// Cosine of an angle.
    Cos(usize),
    /// `a + b`, the node of a before that of b.
    Add(Expr, Expr),
    /// `a - b`.
    Sub(Expr, Expr),
    /// `a * b`, the node of a not after that of b.
    Mul(Expr, Expr),
    /// A function of a positive operand.
    Call(Function, Expr),
}

/// The arena. Operands of a node always have smaller indices than the node.
#[derive(Clone, Debug)]
pub struct Graph {
    nodes: Vec<Node>,
    known: HashMap<Node, u32>,
    angles: Vec<AngleSum>,
    names: HashMap<u32, String>,
    zero: Expr,
    one: Expr,
}

impl Default for Graph {
    fn default() -> Self {
        Graph::new()
    }
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Graph {
        let placeholder = Expr {
            node: 0,
            negative: false,
        };
        let mut graph = Graph {
            nodes: Vec::new(),
            known: HashMap::new(),
            angles: Vec::new(),
            names: HashMap::new(),
            zero: placeholder,
            one: placeholder,
        };
        graph.zero = graph.intern(Node::Constant(0.0_f64.to_bits()));
        graph.one = graph.intern(Node::Constant(1.0_f64.to_bits()));
        graph
    }

    /// All nodes; operands before the nodes that use them.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The angle that a sine or cosine node speaks of.
    pub fn angle(&self, index: usize) -> &AngleSum {
        &self.angles[index]
    }

    /// Number of distinct angles.
    pub fn angle_count(&self) -> usize {
        self.angles.len()
    }

    /// Says what a value is, for readers of emitted code; the first name stays. A negated value
    /// gets the name with `neg_` before it, since the node is the positive one.
    pub fn name(&mut self, x: Expr, name: &str) {
        let leaf = match self.nodes[x.node()] {
            Node::Input(Input::Parameter(_)) => false,
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) => true,
            _ => false,
        };
        if leaf || x.node == self.zero.node || x.node == self.one.node {
            return;
        }
        let prefix = if x.negative { "neg_" } else { "" };
        self.names
            .entry(x.node)
            .or_insert_with(|| format!("{prefix}{name}"));
    }

    /// Gives a value the name of the node that it takes the place of.
    pub fn rename(&mut self, node: usize, x: Expr) {
        let Some(name) = self.name_of(node).map(str::to_owned) else {
            return;
        };
        match name.strip_prefix("neg_") {
            Some(name) => self.name(-x, name),
            None => self.name(x, &name),
        }
    }

    /// What the positive node of an expression was named.
    pub fn name_of(&self, node: usize) -> Option<&str> {
        self.names.get(&(node as u32)).map(String::as_str)
    }

    /// The constant 0.
    pub fn zero(&self) -> Expr {
        self.zero
    }

    /// The constant 1.
    pub fn one(&self) -> Expr {
        self.one
    }

    /// Whether the expression is the constant 0.
    pub fn is_zero(&self, x: Expr) -> bool {
        x.node == self.zero.node
    }

    /// The value of a constant expression.
    pub fn value(&self, x: Expr) -> Option<f64> {
        match self.nodes[x.node()] {
            Node::Constant(bits) => {
                let value = f64::from_bits(bits);
                Some(if x.negative { -value } else { value })
            }
            _ => None,
        }
    }

    /// A constant; NaN is not a constant of any robot and becomes 0.
    pub fn constant(&mut self, value: f64) -> Expr {
        if value == 0.0 || value.is_nan() {
            return self.zero;
        }
        self.intern(Node::Constant(value.abs().to_bits()))
            .signed(value < 0.0)
    }

    /// An input.
    pub fn input(&mut self, input: Input) -> Expr {
        self.intern(Node::Input(input))
    }

    /// Sine and cosine of a sum of joint angles. Right-angle offsets and leading signs are pulled
    /// out, so that q and pi/2 - q share their two nodes.
    pub fn sin_cos(&mut self, angle: &AngleSum) -> (Expr, Expr) {
        if angle.terms.is_empty() {
            let (s, c) = angle.offset.sin_cos();
            return (self.constant(s), self.constant(c));
        }
        if angle.terms[0].1 < 0.0 {
            let (s, c) = self.sin_cos(&angle.negated());
            return (-s, c);
        }
        let rest = Angle::radians(angle.offset.rest());
        let quarters = (angle.offset + -rest).right().unwrap_or(0);
        let index = self.angle_index(AngleSum {
            terms: angle.terms.clone(),
            offset: rest,
        });
        let s = self.intern(Node::Sin(index));
        let c = self.intern(Node::Cos(index));
        match quarters {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }

    fn angle_index(&mut self, angle: AngleSum) -> usize {
        match self.angles.iter().position(|known| *known == angle) {
            Some(index) => index,
            None => {
                self.angles.push(angle);
                self.angles.len() - 1
            }
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) {
            return b;
        }
        if self.is_zero(b) {
            return a;
        }
        if let (Some(x), Some(y)) = (self.value(a), self.value(b)) {
            return self.constant(x + y);
        }
        if a.node == b.node {
            if a.negative != b.negative {
                return self.zero;
            }
            let two = self.constant(2.0);
            return self.mul(two, a);
        }
        // The lower node goes first and lends its sign to the sum.
        let (first, second) = if a.node < b.node { (a, b) } else { (b, a) };
        let node = if first.negative == second.negative {
            Node::Add(first.positive(), second.positive())
        } else {
            Node::Sub(first.positive(), second.positive())
        };
        self.intern(node).signed(first.negative)
    }

    /// `a - b`.
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.add(a, -b)
    }

    /// `a * b`.
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        let negative = a.negative ^ b.negative;
        let (a, b) = (a.positive(), b.positive());
        if self.is_zero(a) || self.is_zero(b) {
            return self.zero;
        }
        if a == self.one {
            return b.signed(negative);
        }
        if b == self.one {
            return a.signed(negative);
        }
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => return self.constant(x * y).signed(negative),
            (Some(x), None) => {
                if let Some(product) = self.absorb(x, b) {
                    return product.signed(negative);
                }
            }
            (None, Some(y)) => {
                if let Some(product) = self.absorb(y, a) {
                    return product.signed(negative);
                }
            }
            (None, None) => {}
        }
        let (first, second) = if a.node <= b.node { (a, b) } else { (b, a) };
        self.intern(Node::Mul(first, second)).signed(negative)
    }

    /// `factor * (constant * x)` as one product.
    fn absorb(&mut self, factor: f64, product: Expr) -> Option<Expr> {
        let Node::Mul(a, b) = self.nodes[product.node()] else {
            return None;
        };
        let (known, other) = match (self.value(a), self.value(b)) {
            (Some(known), _) => (known, b),
            (_, Some(known)) => (known, a),
            _ => return None,
        };
        let merged = self.constant(factor * known);
        Some(self.mul(merged, other))
    }

    /// `factor * x`.
    pub fn scale(&mut self, factor: f64, x: Expr) -> Expr {
        let factor = self.constant(factor);
        self.mul(factor, x)
    }

    /// The sum of several terms.
    pub fn sum(&mut self, terms: &[Expr]) -> Expr {
        terms
            .iter()
            .fold(self.zero, |sum, &term| self.add(sum, term))
    }

    /// A function of `x`; the sign of the operand is pulled out.
    pub fn call(&mut self, function: Function, x: Expr) -> Expr {
        if let Some(value) = self.value(x) {
            match function {
                Function::Reciprocal => return self.constant(value.recip()),
                Function::Root => return self.constant(value.sqrt()),
                _ => {}
            }
        }
        if self.is_zero(x) {
            return match function {
                Function::Bell | Function::Cosine => self.one,
                _ => self.zero,
            };
        }
        let odd = function.is_odd();
        let function = match function {
            Function::Root if x.negative => Function::RootOfOpposite,
            function => function,
        };
        self.intern(Node::Call(function, x.positive()))
            .signed(odd && x.negative)
    }

    fn intern(&mut self, node: Node) -> Expr {
        let next = self.nodes.len() as u32;
        let index = *self.known.entry(node).or_insert(next);
        if index == next {
            self.nodes.push(node);
        }
        Expr {
            node: index,
            negative: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(graph: &mut Graph) -> (Expr, Expr) {
        (graph.input(Input::Qd(0)), graph.input(Input::Qd(1)))
    }

    #[test]
    fn sums_written_in_any_order_and_sign_are_one_node() {
        let mut graph = Graph::new();
        let (a, b) = inputs(&mut graph);
        assert_eq!(graph.add(a, b), graph.add(b, a));
        assert_eq!(graph.add(-a, -b), -graph.add(a, b));
        assert_eq!(graph.sub(b, a), -graph.sub(a, b));
        assert_eq!(graph.sub(a, a), graph.zero());
    }

    #[test]
    fn products_pull_signs_out_and_fold_constants() {
        let mut graph = Graph::new();
        let (a, b) = inputs(&mut graph);
        assert_eq!(graph.mul(-a, b), -graph.mul(b, a));
        assert_eq!(graph.mul(a, graph.zero()), graph.zero());
        assert_eq!(graph.mul(-graph.one(), b), -b);
        let double = graph.scale(2.0, a);
        assert_eq!(graph.scale(-3.0, double), -graph.scale(6.0, a));
        assert_eq!(graph.add(a, a), double);
    }

    #[test]
    fn sines_of_shifted_and_negated_angles_share_nodes() {
        let mut graph = Graph::new();
        let (s, c) = graph.sin_cos(&AngleSum::joint(0, Angle::ZERO));
        assert_eq!(
            graph.sin_cos(&AngleSum::joint(0, Angle::quarters(1))),
            (c, -s)
        );
        assert_eq!(
            graph.sin_cos(&AngleSum::joint(0, Angle::quarters(2))),
            (-s, -c)
        );
        let reflected = AngleSum::joint(0, Angle::ZERO).negated();
        assert_eq!(graph.sin_cos(&reflected), (-s, c));
    }

    #[test]
    fn odd_functions_pull_the_sign_out_and_even_ones_drop_it() {
        let mut graph = Graph::new();
        let (a, _) = inputs(&mut graph);
        assert_eq!(
            graph.call(Function::Sign, -a),
            -graph.call(Function::Sign, a)
        );
        assert_eq!(
            graph.call(Function::Sine, -a),
            -graph.call(Function::Sine, a)
        );
        let power = Function::Power(1.5f64.to_bits());
        for even in [Function::Abs, Function::Bell, Function::Cosine, power] {
            assert_eq!(graph.call(even, -a), graph.call(even, a));
        }
        let zero = graph.zero();
        assert_eq!(graph.call(Function::Bell, zero), graph.one());
        assert_eq!(graph.call(power, zero), zero);
    }
}
