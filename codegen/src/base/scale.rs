//! Base parameters under another scale: the paper's LMX2 = L MX2.

use super::{BaseError, BaseParameter};
use crate::describe::ScaledParameter;
use crate::expr::{Expr, Graph, Node};

/// Renames and rescales parameters; their columns are divided by the factor.
///
/// # Errors
/// [`BaseError::Scaled`] for a parameter that is not in the base set.
pub fn apply(
    graph: &mut Graph,
    parameters: &mut [BaseParameter],
    scaled: &[ScaledParameter],
) -> Result<(), BaseError> {
    for wish in scaled {
        let known = || {
            parameters
                .iter()
                .map(|parameter| parameter.name.clone())
                .collect()
        };
        let index = parameters
            .iter()
            .position(|p| p.name == wish.parameter || p.relation[0].1 == wish.parameter)
            .ok_or_else(|| BaseError::Scaled {
                name: wish.name.clone(),
                parameter: wish.parameter.clone(),
                known: known(),
            })?;
        let parameter = &mut parameters[index];
        parameter.name = wish.name.clone();
        parameter.meaning = format!("{} times {}", parameter.meaning, wish.factor.text);
        for term in &mut parameter.relation {
            term.0 *= wish.factor.value;
        }
        divide(graph, parameter, wish.factor.value);
    }
    Ok(())
}

fn divide(graph: &mut Graph, parameter: &mut BaseParameter, factor: f64) {
    let name = parameter.name.to_lowercase();
    let columns = &mut parameter.columns;
    let lists = [
        ("d", &mut columns.explicit),
        ("p", &mut columns.momentum),
        ("r", &mut columns.rest),
    ];
    for (prefix, entries) in lists {
        for (joint, entry) in entries {
            *entry = scale(graph, *entry, 1.0 / factor);
            graph.name(*entry, &format!("{prefix}{}_{name}", *joint + 1));
        }
    }
    for entry in [&mut columns.energy, &mut columns.power]
        .into_iter()
        .flatten()
    {
        *entry = scale(graph, *entry, 1.0 / factor);
    }
}

/// `factor * x`; where x already carries constant factors they are multiplied instead, so that a
/// length that cancels leaves no operation behind.
fn scale(graph: &mut Graph, x: Expr, factor: f64) -> Expr {
    match absorbed(graph, x, factor) {
        Some(scaled) => scaled,
        None => graph.scale(factor, x),
    }
}

fn absorbed(graph: &mut Graph, x: Expr, factor: f64) -> Option<Expr> {
    let sign = |scaled: Expr| if x.is_negative() { -scaled } else { scaled };
    let scaled = match graph.nodes()[x.node()] {
        Node::Constant(bits) => graph.constant(factor * f64::from_bits(bits)),
        Node::Add(a, b) => {
            let (a, b) = (absorbed(graph, a, factor)?, absorbed(graph, b, factor)?);
            graph.add(a, b)
        }
        Node::Sub(a, b) => {
            let (a, b) = (absorbed(graph, a, factor)?, absorbed(graph, b, factor)?);
            graph.sub(a, b)
        }
        Node::Mul(a, b) => match absorbed(graph, a, factor) {
            Some(a) => graph.mul(a, b),
            None => {
                let b = absorbed(graph, b, factor)?;
                graph.mul(a, b)
            }
        },
        _ => return None,
    };
    Some(sign(scaled))
}
