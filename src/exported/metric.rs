//! The metric of an estimate: the inverse covariance of its parameters.

use idim_runtime::report::ModelResult;

use super::Identified;

impl Identified {
    /// The parameters of an explicit model with the metric of its log.
    pub fn of(model: &ModelResult) -> Identified {
        let each = |of: fn(&idim_runtime::report::ParameterResult) -> Option<f64>| {
            model.parameters.iter().map(of).collect::<Vec<_>>()
        };
        let sigmas = (each(|p| p.sigma), each(|p| p.sigma_corrected));
        let values = model.parameters.iter().map(|p| p.solution).collect();
        Identified::new(values, (&sigmas.0, &sigmas.1), &model.precision)
    }

    /// np values with standard deviations for independent errors and corrected ones, and the lower
    /// triangle of the inverse covariance by rows.
    ///
    /// The metric is that of the torque, so that what bodies cannot have costs as little torque as it
    /// may; it is stretched as a whole by the median of what the corrected standard deviations are
    /// larger. Without a triangle of np rows, errors are taken for independent; nothing is known of what has no
    /// standard deviation.
    pub fn new(
        parameters: Vec<f64>,
        (plain, corrected): (&[Option<f64>], &[Option<f64>]),
        lower: &[Vec<f64>],
    ) -> Identified {
        let np = parameters.len();
        let pairs = plain.iter().zip(corrected);
        let whole =
            lower.len() == np && lower.iter().enumerate().all(|(k, row)| row.len() == k + 1);
        let mut precision = vec![0.0; np * np];
        if !whole {
            for (k, (plain, corrected)) in pairs.enumerate() {
                let sigma = corrected.or(*plain).filter(|sigma| *sigma > 0.0);
                precision[k * np + k] = sigma.map_or(0.0, |sigma| sigma.powi(-2));
            }
            return Identified {
                parameters,
                precision,
            };
        }
        let ratios = pairs.filter_map(|(plain, corrected)| Some((*plain)? / (*corrected)?));
        let mut ratios: Vec<f64> = ratios.filter(|ratio| ratio.is_finite()).collect();
        ratios.sort_by(f64::total_cmp);
        let shrink = ratios
            .get(ratios.len() / 2)
            .map_or(1.0, |ratio| ratio * ratio);
        for (i, row) in lower.iter().enumerate() {
            for (k, value) in row.iter().enumerate() {
                let value = value * shrink;
                precision[i * np + k] = value;
                precision[k * np + i] = value;
            }
        }
        Identified {
            parameters,
            precision,
        }
    }
}
