//! Identifiers for the values of one function.

use std::collections::{HashMap, HashSet};

use proc_macro2::Ident;
use quote::format_ident;

use crate::expr::{AngleSum, Graph, Node};

/// Hands out one identifier per node, no two alike.
#[derive(Debug, Default)]
pub struct Names {
    given: HashMap<usize, Ident>,
    taken: HashSet<String>,
    counter: usize,
}

impl Names {
    /// The identifier of a node: the name it was given when it was derived, or `t1`, `t2`, ... for
    /// what several meanings share.
    pub fn of(&mut self, graph: &Graph, node: usize) -> Ident {
        if let Some(known) = self.given.get(&node) {
            return known.clone();
        }
        let wish = match graph.nodes()[node] {
            Node::Constant(bits) => constant(graph, node, f64::from_bits(bits)),
            Node::Sin(angle) => trig("s", graph.angle(angle)),
            Node::Cos(angle) => trig("c", graph.angle(angle)),
            _ => match graph.name_of(node) {
                Some(name) => name.to_owned(),
                None => {
                    self.counter += 1;
                    format!("t{}", self.counter)
                }
            },
        };
        let ident = self.unique(&wish);
        self.given.insert(node, ident.clone());
        ident
    }

    fn unique(&mut self, wish: &str) -> Ident {
        let mut name = wish.to_owned();
        let mut again = 2;
        while !self.taken.insert(name.clone()) {
            name = format!("{wish}_{again}");
            again += 1;
        }
        format_ident!("{name}")
    }
}

/// `s23` for sin(q2 + q3), `s2m3` for sin(q2 - q3), `s6o` with a constant offset.
pub fn trig(function: &str, angle: &AngleSum) -> String {
    let wide = angle.terms.iter().any(|&(joint, _)| joint >= 9);
    let mut name = function.to_owned();
    for (place, &(joint, sign)) in angle.terms.iter().enumerate() {
        if sign < 0 {
            name.push('m');
        } else if wide && place > 0 {
            name.push('_');
        }
        name.push_str(&(joint + 1).to_string());
    }
    if !angle.offset.is_zero() {
        name.push('o');
    }
    name
}

fn constant(graph: &Graph, node: usize, value: f64) -> String {
    // One node serves every meaning of a value; these two are hardly ever lengths.
    if value == 2.0 || value == 0.5 {
        return if value == 2.0 {
            "two".into()
        } else {
            "half".into()
        };
    }
    if let Some(name) = graph.name_of(node) {
        return name.to_owned();
    }
    let digits: String = format!("{value}")
        .chars()
        .map(|c| if c.is_ascii_digit() { c } else { '_' })
        .take(14)
        .collect();
    format!("k{}", digits.trim_end_matches('_'))
}
