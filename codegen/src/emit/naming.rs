//! Identifiers for the values of one function.

use std::collections::{HashMap, HashSet};

use crate::expr::{AngleSum, Graph, Node};

/// Hands out one identifier per node, no two alike.
#[derive(Debug, Default)]
pub struct Names {
    given: HashMap<usize, String>,
    taken: HashSet<String>,
    angles: Vec<String>,
    counter: usize,
}

impl Names {
    /// No names given yet; none will be one of the reserved words.
    pub fn new(graph: &Graph, reserved: Vec<String>) -> Names {
        let angles = angles(graph);
        let trig = angles
            .iter()
            .flat_map(|angle| ["s", "c"].map(|function| format!("{function}{angle}")));
        Names {
            taken: reserved.into_iter().chain(trig).collect(),
            angles,
            ..Names::default()
        }
    }

    /// The identifier of a node: the name it was given when it was derived, or `t1`, `t2`, ... for
    /// what several meanings share.
    pub fn of(&mut self, graph: &Graph, node: usize) -> String {
        if let Some(known) = self.given.get(&node) {
            return known.clone();
        }
        let wish = match graph.nodes()[node] {
            Node::Sin(angle) => return format!("s{}", self.angles[angle]),
            Node::Cos(angle) => return format!("c{}", self.angles[angle]),
            Node::Constant(bits) => constant(graph, node, f64::from_bits(bits)),
            _ => match graph.name_of(node) {
                Some(name) => name.to_owned(),
                None => {
                    self.counter += 1;
                    format!("t{}", self.counter)
                }
            },
        };
        let name = unique(&mut self.taken, &wish);
        self.given.insert(node, name.clone());
        name
    }
}

fn unique(taken: &mut HashSet<String>, wish: &str) -> String {
    let mut name = wish.to_owned();
    let mut again = 2;
    while !taken.insert(name.clone()) {
        name = format!("{wish}_{again}");
        again += 1;
    }
    name
}

/// The name of every angle of a graph, to go behind `s` or `c`: `23` for q2 + q3, `2m3` for
/// q2 - q3, `6o` with a constant offset, `1x0_5` for half of q1.
pub fn angles(graph: &Graph) -> Vec<String> {
    let mut taken = HashSet::new();
    (0..graph.angle_count())
        .map(|index| unique(&mut taken, &angle(graph.angle(index))))
        .collect()
}

fn angle(angle: &AngleSum) -> String {
    let wide = angle.terms.iter().any(|&(joint, _)| joint >= 9);
    let mut name = String::new();
    let mut after_factor = false;
    for (place, &(joint, factor)) in angle.terms.iter().enumerate() {
        if factor < 0.0 {
            name.push('m');
        } else if place > 0 && (wide || after_factor) {
            name.push('_');
        }
        name.push_str(&(joint + 1).to_string());
        after_factor = factor.abs() != 1.0;
        if after_factor {
            let digits = factor
                .abs()
                .to_string()
                .replace(|c: char| !c.is_ascii_digit(), "_");
            name.push_str(&format!("x{digits}"));
        }
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
