//! Essential parameters: backward elimination of what the data do not need.

use super::{Evidence, EvidenceError, Fit, Question};

/// Result of a backward elimination.
#[derive(Clone, Debug, PartialEq)]
pub struct Essential {
    /// What is left to ask, with the weights of the full fit.
    pub question: Question,
    /// What was dropped, in this order.
    pub dropped: Vec<Dropped>,
}

/// A column that was dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dropped {
    /// The column, as the layout counts it.
    pub column: usize,
    /// Probability of as large a value if its parameter is zero, when it was dropped.
    pub p_value: f64,
}

impl Evidence {
    /// Drops one column after the other, always the one that is least needed, until each of those
    /// left is significant at `level` (0.01: one needless column in a hundred is kept). The tests
    /// are those of [`super::Covariance::zero`], which respect correlated residuals; columns that
    /// the data do not determine are neither tested nor dropped.
    ///
    /// # Errors
    /// Those of [`Evidence::fit`] and [`Evidence::corrected`].
    pub fn essential(&self, question: &Question, level: f64) -> Result<Essential, EvidenceError> {
        let mut fit = self.fit(question)?;
        let mut question = Question {
            columns: question.columns.clone(),
            weighting: fit.weighting(),
        };
        let mut dropped = Vec::new();
        while let Some(least) = self
            .least_needed(&fit)?
            .filter(|least| least.p_value > level)
        {
            question = question.without(&[least.column]);
            dropped.push(least);
            if question.columns.is_empty() {
                break;
            }
            fit = self.fit(&question)?;
        }
        Ok(Essential { question, dropped })
    }

    /// The column whose test has the largest p-value.
    fn least_needed(&self, fit: &Fit) -> Result<Option<Dropped>, EvidenceError> {
        let covariance = self.corrected(fit)?;
        let tests = fit.columns.iter().filter_map(|&column| {
            let test = covariance.zero(&fit.solution, &[column])?;
            Some(Dropped {
                column,
                p_value: test.p_value,
            })
        });
        Ok(tests.max_by(|a, b| a.p_value.total_cmp(&b.p_value)))
    }
}
