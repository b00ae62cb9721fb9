//! The outputs of a robot with fewer operations of equal value.

use crate::base::BaseParameter;
use crate::expr::substitute::substitute;
use crate::expr::{Expr, Graph};
use crate::robot::Output;

/// What is computed together: D; P and R; h and dh.
const FUNCTIONS: [&[Output]; 3] = [
    &[Output::Explicit],
    &[Output::Momentum, Output::Rest],
    &[Output::Energy, Output::Power],
];

/// Rewrites the entries of each function; those that turn out to be zero are dropped.
pub fn fewer(graph: &mut Graph, parameters: &mut [BaseParameter]) {
    for outputs in FUNCTIONS {
        let mut entries: Vec<&mut Expr> = parameters
            .iter_mut()
            .flat_map(|parameter| entries(parameter, outputs))
            .collect();
        let mut values: Vec<Expr> = entries.iter().map(|entry| **entry).collect();
        substitute(graph, &mut values);
        for (entry, value) in entries.iter_mut().zip(values) {
            **entry = value;
        }
    }
    for parameter in parameters {
        let columns = &mut parameter.columns;
        let lists = [
            &mut columns.explicit,
            &mut columns.momentum,
            &mut columns.rest,
        ];
        for list in lists {
            list.retain(|&(_, entry)| !graph.is_zero(entry));
        }
        for value in [&mut columns.energy, &mut columns.power] {
            *value = value.filter(|&entry| !graph.is_zero(entry));
        }
    }
}

fn entries<'a>(parameter: &'a mut BaseParameter, outputs: &[Output]) -> Vec<&'a mut Expr> {
    let columns = &mut parameter.columns;
    let lists = [
        (Output::Explicit, &mut columns.explicit),
        (Output::Momentum, &mut columns.momentum),
        (Output::Rest, &mut columns.rest),
    ];
    let single = [
        (Output::Energy, &mut columns.energy),
        (Output::Power, &mut columns.power),
    ];
    let lists = lists
        .into_iter()
        .filter(|(output, _)| outputs.contains(output));
    let single = single
        .into_iter()
        .filter(|(output, _)| outputs.contains(output));
    let of_lists = lists.flat_map(|(_, list)| list.iter_mut().map(|(_, entry)| entry));
    of_lists
        .chain(single.filter_map(|(_, value)| value.as_mut()))
        .collect()
}
