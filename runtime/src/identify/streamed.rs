//! Evidence of a log of any length: each time block is worked off from window to window by one
//! thread, the blocks side by side, and no row is kept.

use std::ops::Range;

use rayon::prelude::*;

use super::IdentifyError;
use crate::estimate::EstimateError;
use crate::evidence::{Cut, Evidence, Fold, Layout, Triangle};
use crate::model::IdentificationModel;
use crate::observe::{Course, ModelKind, Observations, stretch};
use crate::signal::all_finite;

/// Evidence of some models along a log, in their order. It does not depend on the number of
/// threads.
///
/// # Errors
/// [`IdentifyError::Observe`]; [`IdentifyError::Estimate`] if an equation is not finite.
pub(super) fn streamed(
    model: &dyn IdentificationModel,
    course: &Course<'_>,
    kinds: &[ModelKind],
    cut: Cut,
) -> Result<Vec<Evidence>, IdentifyError> {
    let layouts = kinds
        .iter()
        .map(|&kind| {
            Layout::new(model, &Observations::none(model, kind), &[])
                .map_err(IdentifyError::evidence(kind))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let believed = course.believed()?;
    let blocks: Vec<Vec<Vec<Triangle>>> = cuts(&believed, cut)
        .into_par_iter()
        .map(|rows| block(model, course, &layouts, rows, &believed))
        .collect::<Result<_, _>>()?;
    let mut evidence: Vec<Evidence> = layouts.into_iter().map(Evidence::empty).collect();
    for block in blocks {
        for (evidence, factors) in evidence.iter_mut().zip(block) {
            let kind = evidence.layout().model;
            evidence
                .push(factors)
                .map_err(IdentifyError::evidence(kind))?;
        }
    }
    Ok(evidence)
}

/// The rows of each time block: equal numbers of believed rows.
fn cuts(believed: &[Range<usize>], cut: Cut) -> Vec<Range<usize>> {
    let total = believed.iter().map(Range::len).sum();
    let place = |mut count: usize| {
        for range in believed {
            match count < range.len() {
                true => return range.start + count,
                false => count -= range.len(),
            }
        }
        believed.last().map_or(0, |range| range.end)
    };
    let ranges = cut.ranges(total).into_iter();
    ranges
        .map(|range| place(range.start)..place(range.end - 1) + 1)
        .collect()
}

/// The factors of one time block, by model and joint.
fn block(
    model: &dyn IdentificationModel,
    course: &Course<'_>,
    layouts: &[Layout],
    rows: Range<usize>,
    believed: &[Range<usize>],
) -> Result<Vec<Vec<Triangle>>, IdentifyError> {
    let kinds: Vec<ModelKind> = layouts.iter().map(|layout| layout.model).collect();
    let fold = |columns: &Vec<usize>| Fold::new(columns.len() + 1);
    let mut folds: Vec<Vec<Fold>> = layouts
        .iter()
        .map(|layout| layout.joints.iter().map(fold).collect())
        .collect();
    let (row, mut broken) = (rows.start, None);
    stretch(
        course,
        model,
        &kinds,
        rows,
        believed,
        &mut |kind, joint, columns| {
            if broken.is_none() && !columns.iter().all(|column| all_finite(column)) {
                broken = Some((kind, joint));
            }
            let place = kinds.iter().position(|k| *k == kind).unwrap_or(0);
            if let Some(fold) = folds
                .get_mut(place)
                .and_then(|joints| joints.get_mut(joint))
            {
                fold.rows(columns);
            }
        },
    )?;
    match broken {
        Some((model, joint)) => Err(IdentifyError::Estimate {
            model,
            source: EstimateError::NotFinite {
                what: "an equation",
                block: joint + 1,
                row,
            },
        }),
        None => {
            let finish = |joints: Vec<Fold>| joints.into_iter().map(Fold::finish).collect();
            Ok(folds.into_iter().map(finish).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::tests::hand_written::scara;
    use crate::identify::tests::synthetic::{motion, options};
    use crate::observe::{Motion, observe};
    use crate::settings::Edges;

    /// The largest entry of a factor, and by how much two factors differ in its units.
    fn difference(a: &Triangle, b: &Triangle) -> f64 {
        let largest = a.packed().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let pairs = a.packed().iter().zip(b.packed());
        pairs
            .map(|(a, b)| (a - b).abs() / largest)
            .fold(0.0, f64::max)
    }

    #[test]
    fn evidence_of_a_stream_is_that_of_the_whole_log() {
        let model = scara();
        let mut log = motion("long", 0.0, 30_000);
        log.tau = Some(log.q.clone());
        log.doubtful = vec![4_000..4_400, 20_000..20_001];
        for (edges, nd, trim) in [
            (Edges::Scipy, 5, 30),
            (Edges::Matlab, 7, 12),
            (Edges::Scipy, 1, 0),
        ] {
            let mut choices = options();
            (choices.edges, choices.nd, choices.trim) = (Some(edges), Some(nd), Some(trim));
            let plan = choices.resolve(&model, std::slice::from_ref(&log)).unwrap();
            let course = Course::new(&log, &model, &plan.filtering).unwrap();
            let streams = streamed(&model, &course, &ModelKind::ALL, Cut::default()).unwrap();
            let motion = Motion::trimmed(&log, &model, &plan.filtering).unwrap();
            for (kind, stream) in ModelKind::ALL.into_iter().zip(&streams) {
                let rows = observe(&model, kind, &motion, &plan.filtering).unwrap();
                let whole =
                    Evidence::from_observations(&model, &rows, &[], Cut::default()).unwrap();
                assert_eq!(whole.layout(), stream.layout());
                assert_eq!(
                    whole.joint_rows(),
                    stream.joint_rows(),
                    "{edges:?} {kind:?}"
                );
                for block in 0..whole.blocks() {
                    for (a, b) in whole.factors(block).iter().zip(stream.factors(block)) {
                        assert_eq!(a.rows(), b.rows());
                        let error = difference(a, b);
                        assert!(
                            error < 1e-11,
                            "{edges:?} {kind:?}, block {block}: {error:e}"
                        );
                    }
                }
            }
        }
    }
}
