//! Which parameters the data determine, which they do not, and why.

use faer::Mat;

use super::EstimateError;

/// A column this much smaller than the largest is rounding, such as the cosine of pi/2.
const UNSEEN: f64 = 1e-15;

/// Singular values of the normalised W below this share of the largest are rounding: the filters
/// leave about 1e-13, and base parameters on an exciting motion stay far above 1e-6.
const RANK: f64 = 1e-10;

/// A parameter with a smaller share in the null space of the normalised W is determined.
const INVOLVED: f64 = 1e-6;

/// Parameters that the data determine only in some combinations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dependency {
    /// The parameters, ascending.
    pub columns: Vec<usize>,
    /// How many independent combinations of them the data determine.
    pub combinations: usize,
}

/// What a triangular factor of W says about the parameters.
pub(crate) struct Identifiability {
    /// Parameters whose columns are zero.
    pub unseen: Vec<usize>,
    /// Groups of parameters that depend on each other in the data.
    pub dependent: Vec<Dependency>,
    /// A largest set of independent columns, ascending; its size is the rank.
    pub independent: Vec<usize>,
}

impl Identifiability {
    /// Numerical rank of W.
    pub fn rank(&self) -> usize {
        self.independent.len()
    }

    /// Whether the data determine parameter `column` by itself.
    pub fn determines(&self, column: usize) -> bool {
        !self.unseen.contains(&column)
            && !self
                .dependent
                .iter()
                .any(|group| group.columns.contains(&column))
    }
}

/// Finds rank, dependent groups and an independent set from W, or from the factor `r` of `[W | Y]`.
pub(crate) fn identifiability(r: &Mat<f64>, np: usize) -> Result<Identifiability, EstimateError> {
    let norms: Vec<f64> = (0..np).map(|c| r.col(c).norm_l2()).collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    let (seen, unseen): (Vec<usize>, Vec<usize>) =
        (0..np).partition(|c| norms[*c] > UNSEEN * largest);
    if seen.is_empty() {
        return Err(EstimateError::NothingMoves);
    }
    let normalised = Mat::from_fn(r.nrows(), seen.len(), |i, k| {
        r[(i, seen[k])] / norms[seen[k]]
    });
    let svd = normalised.svd().map_err(|_| EstimateError::Singular)?;
    let singular = svd.S().column_vector();
    let rank = (0..singular.nrows())
        .filter(|k| singular[*k] > RANK * singular[0])
        .count();
    let null_space = svd.V().get(.., rank..).to_owned();
    let dependent = groups(&seen, &null_space);
    let independent = match rank == seen.len() {
        true => seen,
        false => independent(&normalised, &null_space, &seen, rank),
    };
    Ok(Identifiability {
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
        normalised[(i, k)] * if involved(k) { 1.0 } else { 1e3 }
    });
    let qr = favoured.col_piv_qr();
    let (order, _) = qr.P().arrays();
    let mut first: Vec<usize> = order[..rank].iter().map(|k| seen[*k]).collect();
    first.sort_unstable();
    first
}

/// Groups of parameters linked through the null space: the projector onto it is block diagonal.
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

#[cfg(test)]
mod tests {
    use super::super::triangle::upper;
    use super::*;

    /// Factor of a matrix with the given columns and measurements of zero.
    fn factor(columns: &[&[f64]]) -> Mat<f64> {
        let np = columns.len();
        let entry = |i: usize, k: usize| if k < np { columns[k][i] } else { 0.0 };
        upper(Mat::from_fn(columns[0].len(), np + 1, entry))
    }

    #[test]
    fn independent_columns_are_all_determined() {
        let found = identifiability(&factor(&[&[1.0, 0.0, 2.0], &[0.0, 1e-6, 0.0]]), 2).unwrap();
        assert_eq!(found.rank(), 2);
        assert!(found.unseen.is_empty() && found.dependent.is_empty());
    }

    #[test]
    fn zero_and_dependent_columns_are_named() {
        let a = [1.0, 2.0, 3.0, 4.0, -1.0];
        let b = [0.5, 0.0, -3.0, 1.0, 2.0];
        let sum: Vec<f64> = a.iter().zip(b).map(|(a, b)| 1e4 * a - b).collect();
        let c = [0.0, 1.0, 0.0, 0.0, 1.0];
        let zero = [0.0; 5];
        let found = identifiability(&factor(&[&a, &zero, &c, &b, &sum]), 5).unwrap();
        assert_eq!(found.unseen, [1]);
        let group = Dependency {
            columns: vec![0, 3, 4],
            combinations: 2,
        };
        assert_eq!(found.dependent, [group]);
        assert_eq!(found.rank(), 3);
        assert!(found.independent.contains(&2));
        assert!(found.determines(2) && !found.determines(0) && !found.determines(1));
    }

    #[test]
    fn separate_dependencies_are_separate_groups() {
        let a = [1.0, 2.0, 3.0, 4.0];
        let b = [0.5, 0.0, -3.0, 1.0];
        let (a2, b2) = (a.map(|x| 2.0 * x), b.map(|x| -x));
        let found = identifiability(&factor(&[&a, &b, &a2, &b2]), 4).unwrap();
        let columns: Vec<&[usize]> = found
            .dependent
            .iter()
            .map(|g| g.columns.as_slice())
            .collect();
        assert_eq!(columns, [&[0, 2], &[1, 3]]);
        assert!(found.dependent.iter().all(|group| group.combinations == 1));
    }

    #[test]
    fn nothing_but_zeros_is_an_error() {
        let zero = factor(&[&[0.0, 0.0]]);
        assert!(matches!(
            identifiability(&zero, 1),
            Err(EstimateError::NothingMoves)
        ));
    }
}
