//! Memory is bounded without a trace in the numbers.

use super::hand_written::{HandWritten, scara};
use super::synthetic::{motion, options};
use crate::model::{IdentificationModel, Output, States};
use crate::observe::{ModelKind, Motion, Treatment, observe};
use crate::settings::Edges;
use crate::signal::Decimator;

#[test]
fn a_long_log_in_windows_gives_what_it_gives_at_once() {
    let model = scara();
    let long = motion("long", 0.0, 60_000);
    let plan = options()
        .resolve(&model, std::slice::from_ref(&long))
        .unwrap();
    let motion = Motion::trimmed(&long, &model, &plan.filtering).unwrap();
    for kind in ModelKind::ALL {
        let rows = observe(&model, kind, &motion, &plan.filtering).unwrap();
        for &(output, treatment) in kind.terms() {
            let whole = at_once(&model, output, treatment, &motion);
            for entry in model.pattern(output).entries.iter() {
                if shares_column(kind, &model, entry.row, entry.column) {
                    continue;
                }
                let block = &rows.blocks[entry.row];
                let k = block.columns.binary_search(&entry.column).unwrap();
                for (a, b) in block.column(k).iter().zip(&whole[entry.signal]) {
                    assert!(
                        (a - b).abs() < 1e-11 * b.abs().max(1.0),
                        "{output:?}: {a} against {b}"
                    );
                }
            }
        }
    }
}

/// Whether two terms of a model add to the same column.
fn shares_column(kind: ModelKind, model: &HandWritten, row: usize, column: usize) -> bool {
    let has = |output| {
        let entries = model.pattern(output).entries.iter();
        entries
            .filter(|e| (e.row, e.column) == (row, column))
            .count()
    };
    kind.terms().iter().map(|term| has(term.0)).sum::<usize>() > 1
}

/// The decimated signals of an output, filtered over the whole motion.
fn at_once(
    model: &HandWritten,
    output: Output,
    treatment: Treatment,
    motion: &Motion,
) -> Vec<Vec<f64>> {
    let flat = |series: &[Vec<f64>]| series.concat();
    let (q, qd, qdd) = (flat(&motion.q), flat(&motion.qd), flat(&motion.qdd));
    let states = States {
        len: motion.len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let mut signals = vec![0.0; model.pattern(output).signals * motion.len];
    model.evaluate(output, &states, &mut signals);
    let series: Vec<Vec<f64>> = signals.chunks(motion.len).map(<[f64]>::to_vec).collect();
    let decimator = Decimator::new(5, motion.rate_hz, Edges::Scipy).unwrap();
    let kept = decimator.kept(motion.len);
    match treatment {
        Treatment::Value => decimator.values(series.as_slice(), &kept).unwrap(),
        Treatment::Rate => decimator.rates(series.as_slice(), &kept).unwrap(),
    }
}
