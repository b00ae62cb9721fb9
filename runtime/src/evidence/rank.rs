//! Which columns the data determine, which they do not, and why.

use faer::Mat;

use super::Triangle;
use crate::estimate::{Dependency, EstimateError};

/// A column this much smaller than the largest is rounding, not data.
const UNSEEN: f64 = 1e-13;

/// Singular values of the normalised W below this share of the largest are rounding: the filters
/// leave about 1e-13, and base parameters on an exciting motion stay far above 1e-6.
const RANK: f64 = 1e-10;

/// A column with a smaller share in the null space of the normalised W is determined.
const INVOLVED: f64 = 1e-6;

/// How much larger the pivots of determined columns are made than those of the others.
const FAVOUR: f64 = 1e3;

/// What a factor says about its columns, counted from 0 without the measurements.
pub(super) struct Rank {
    /// Columns that are zero.
    pub unseen: Vec<usize>,
    /// Groups of columns that depend on each other in the data.
    pub dependent: Vec<Dependency>,
    /// A largest set of independent columns, ascending; its size is the rank.
    pub independent: Vec<usize>,
}

impl Rank {
    /// Whether the data determine the parameter of column `k` by itself.
    pub fn determines(&self, k: usize) -> bool {
        let tied = self
            .dependent
            .iter()
            .any(|group| group.columns.contains(&k));
        !self.unseen.contains(&k) && !tied
    }
}

/// Rank, dependent groups and an independent set, from the singular values and the null space of
/// the columns, each divided by its norm.
///
/// # Errors
/// [`EstimateError::NothingMoves`], [`EstimateError::Singular`].
pub(super) fn rank(factor: &Triangle) -> Result<Rank, EstimateError> {
    let columns = factor.width() - 1;
    let norms: Vec<f64> = (0..columns).map(|k| factor.column_norm(k)).collect();
    if norms.iter().any(|norm| !norm.is_finite()) {
        return Err(EstimateError::Singular);
    }
    let largest = norms.iter().copied().fold(0.0, f64::max);
    let (seen, unseen): (Vec<usize>, Vec<usize>) =
        (0..columns).partition(|k| norms[*k] > UNSEEN * largest);
    if seen.is_empty() {
        return Err(EstimateError::NothingMoves);
    }
    let entry = |i: usize, k: usize| factor.entry(i, seen[k]) / norms[seen[k]];
    let normalised = Mat::from_fn(columns, seen.len(), entry);
    let svd = normalised.svd().map_err(|_| EstimateError::Singular)?;
    let singular = svd.S().column_vector();
    let rank = (0..seen.len())
        .filter(|k| singular[*k] > RANK * singular[0])
        .count();
    let null_space = svd.V().get(.., rank..).to_owned();
    let dependent = groups(&seen, &null_space);
    let independent = match rank == seen.len() {
        true => seen,
        false => independent(&normalised, &null_space, &seen, rank),
    };
    Ok(Rank {
        unseen,
        dependent,
        independent,
    })
}

/// The first `rank` columns of a pivoted factorisation, in their own order. Columns outside the
/// null space come first whatever their pivots: they are determined.
fn independent(
    normalised: &Mat<f64>,
    null_space: &Mat<f64>,
    seen: &[usize],
    rank: usize,
) -> Vec<usize> {
    let involved = |k: usize| null_space.row(k).norm_l2() > INVOLVED;
    let favoured = Mat::from_fn(normalised.nrows(), seen.len(), |i, k| {
        normalised[(i, k)] * if involved(k) { 1.0 } else { FAVOUR }
    });
    let qr = favoured.col_piv_qr();
    let (order, _) = qr.P().arrays();
    let mut first: Vec<usize> = order[..rank].iter().map(|k| seen[*k]).collect();
    first.sort_unstable();
    first
}

/// Groups of columns linked through the null space: the projector onto it is block diagonal.
fn groups(seen: &[usize], null_space: &Mat<f64>) -> Vec<Dependency> {
    let projector = null_space * null_space.transpose();
    let mut left: Vec<usize> = (0..seen.len())
        .filter(|k| null_space.row(*k).norm_l2() > INVOLVED)
        .collect();
    let mut groups = Vec::new();
    while let Some(first) = left.first().copied() {
        let mut members = vec![first];
        left.retain(|k| *k != first);
        let mut next = 0;
        while let Some(member) = members.get(next).copied() {
            let linked = |k: &usize| projector[(*k, member)].abs() > INVOLVED * INVOLVED;
            members.extend(left.iter().copied().filter(linked));
            left.retain(|k| !linked(k));
            next += 1;
        }
        members.sort_unstable();
        let lost: f64 = members.iter().map(|k| projector[(*k, *k)]).sum();
        groups.push(Dependency {
            combinations: members.len() - (lost.round() as usize).min(members.len()),
            columns: members.into_iter().map(|k| seen[k]).collect(),
        });
    }
    groups
}
