//! The sines and cosines of a set of values.

use super::naming;
use crate::expr::{AngleSum, Graph, Node};

/// An angle of which the sine, the cosine or both are needed.
#[derive(Clone, Debug, PartialEq)]
pub struct Trig {
    /// The angle.
    pub angle: AngleSum,
    /// Name of its sine, if that is needed.
    pub sine: Option<String>,
    /// Name of its cosine, if that is needed.
    pub cosine: Option<String>,
}

/// The angles behind some nodes, in the order of the nodes.
pub fn trig(graph: &Graph, nodes: &[usize]) -> Vec<Trig> {
    let names = naming::angles(graph);
    let mut places: Vec<usize> = Vec::new();
    let mut table: Vec<Trig> = Vec::new();
    for &node in nodes {
        let (angle, sine) = match graph.nodes()[node] {
            Node::Sin(angle) => (angle, true),
            Node::Cos(angle) => (angle, false),
            _ => continue,
        };
        let known = places.iter().position(|&place| place == angle);
        let place = known.unwrap_or_else(|| {
            places.push(angle);
            table.push(Trig {
                angle: graph.angle(angle).clone(),
                sine: None,
                cosine: None,
            });
            table.len() - 1
        });
        match sine {
            true => table[place].sine = Some(format!("s{}", names[angle])),
            false => table[place].cosine = Some(format!("c{}", names[angle])),
        }
    }
    table
}

impl Trig {
    /// The angle as code: a sum of positions as `position` spells them and a constant as `number`
    /// does.
    pub fn code(
        &self,
        position: impl Fn(usize) -> String,
        number: impl Fn(f64) -> String,
    ) -> String {
        let mut text = String::new();
        for &(joint, factor) in &self.angle.terms {
            text.push_str(operator(text.is_empty(), factor < 0.0));
            if factor.abs() != 1.0 {
                text.push_str(&format!("{} * ", number(factor.abs())));
            }
            text.push_str(&position(joint));
        }
        if !self.angle.offset.is_zero() {
            let value = self.angle.offset.value();
            text.push_str(operator(false, value < 0.0));
            text.push_str(&number(value.abs()));
        }
        text
    }

    /// The angle as a person writes it, such as `q2 + q3 + pi/2`.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for &(joint, factor) in &self.angle.terms {
            text.push_str(operator(text.is_empty(), factor < 0.0));
            if factor.abs() != 1.0 {
                text.push_str(&format!("{} ", factor.abs()));
            }
            text.push_str(&format!("q{}", joint + 1));
        }
        if !self.angle.offset.is_zero() {
            text.push_str(&format!(" + {}", self.angle.offset.text()));
        }
        text
    }
}

fn operator(first: bool, negative: bool) -> &'static str {
    match (first, negative) {
        (true, false) => "",
        (true, true) => "-",
        (false, false) => " + ",
        (false, true) => " - ",
    }
}
