//! The distinct values among the entries of an output.

use std::collections::HashMap;

use crate::expr::Expr;
use crate::robot::{Output, Robot};

/// The entries of an output, each with the signal it shares with equal entries, and for each
/// signal the first entry that holds it.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    /// (row, column, signal) by row, then by column.
    pub entries: Vec<(usize, usize, usize)>,
    /// (row, column) of the first entry of each signal.
    pub first: Vec<(usize, usize)>,
    /// The value of each signal.
    pub values: Vec<Expr>,
    /// What emitted code computes in the same function besides.
    pub others: Vec<Expr>,
}

/// Finds equal entries.
pub fn signals(robot: &Robot, output: Output) -> Signals {
    let mut known: HashMap<Expr, usize> = HashMap::new();
    let mut signals = Signals::default();
    for entry in robot.entries(output) {
        let signal = *known.entry(entry.value).or_insert_with(|| {
            signals.first.push((entry.row, entry.column));
            signals.values.push(entry.value);
            signals.first.len() - 1
        });
        signals.entries.push((entry.row, entry.column, signal));
    }
    let others = match output {
        Output::Momentum => robot.entries(Output::Rest),
        Output::Rest => robot.entries(Output::Momentum),
        Output::Explicit | Output::Energy | Output::Power => vec![],
    };
    signals.others = others.into_iter().map(|entry| entry.value).collect();
    signals
}
