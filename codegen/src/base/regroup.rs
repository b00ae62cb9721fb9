//! The regrouping relations: how dropped parameters enter the kept ones.

use nalgebra::DMatrix;

use super::rank::Split;
use super::{BaseParameter, names};
use crate::derive::Standard;

/// Coefficients below this are rounding of the least squares on columns of order 1.
const ROUNDING: f64 = 1e-9;

/// Builds the base parameters, link by link, inertial before drive before friction.
pub fn regroup(w: &DMatrix<f64>, split: &Split, standard: &[Standard]) -> Vec<BaseParameter> {
    let coefficients = coefficients(w, split);
    let mut order: Vec<usize> = (0..split.kept.len()).collect();
    order.sort_by_key(|&place| {
        let parameter = &standard[split.kept[place]];
        (parameter.link, parameter.kind, split.kept[place])
    });
    order
        .into_iter()
        .map(|place| {
            let parameter = &standard[split.kept[place]];
            let mut relation = vec![(1.0, parameter.name.clone())];
            let mut others: Vec<(usize, f64)> = Vec::new();
            for (index, &dependent) in split.dependent.iter().enumerate() {
                let coefficient = coefficients[(place, index)];
                if coefficient != 0.0 {
                    others.push((dependent, coefficient));
                }
            }
            others.sort_by_key(|&(dependent, _)| dependent);
            relation.extend(
                others.into_iter().map(|(dependent, coefficient)| {
                    (coefficient, standard[dependent].name.clone())
                }),
            );
            BaseParameter {
                name: names::base(&parameter.name, relation.len() > 1),
                unit: parameter.unit.to_owned(),
                meaning: parameter.meaning.clone(),
                link: parameter.link,
                kind: parameter.kind,
                relation,
                text: String::new(),
                columns: parameter.columns.clone(),
            }
        })
        .collect()
}

/// W_dependent = W_kept C by least squares, cleaned of rounding.
pub fn coefficients(w: &DMatrix<f64>, split: &Split) -> DMatrix<f64> {
    let kept = w.select_columns(&split.kept);
    let mut projected = w.select_columns(&split.dependent);
    let qr = kept.qr();
    qr.q_tr_mul(&mut projected);
    let projected = projected.rows(0, split.kept.len());
    let solution = qr.r().solve_upper_triangular(&projected);
    let mut c = solution.unwrap_or_else(|| DMatrix::zeros(split.kept.len(), split.dependent.len()));
    c.apply(|x| {
        // Twelve digits are certain; a number that short is what the lengths multiply to.
        let rounded = (*x * 1e12).round() / 1e12;
        *x = if x.abs() < ROUNDING { 0.0 } else { rounded };
    });
    c
}
