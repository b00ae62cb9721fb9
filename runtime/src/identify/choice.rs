//! Filters chosen from the data, by the rules of Gautier 1996, section 6.

use rayon::prelude::*;

use super::{IdentifyError, excited};
use crate::log::{Recording, Samples};
use crate::observe::rests;
use crate::settings::{Derivatives, Edges};
use crate::signal::bandwidth;

/// Order of the Butterworth prefilter: more than 2, so that two differentiations stay band-pass
/// (section 6.2).
pub(super) const ORDER: usize = 4;

/// Cut-off of the prefilter over the band of the motion: \\( \omega_{fq} > 10\,\omega_{dyn} \\).
const FQ_OVER_DYN: f64 = 10.0;

/// Cut-off of the parallel filter over the band of the motion: \\( \omega_{fp} = 5\,\omega_{dyn} \\).
const FP_OVER_DYN: f64 = 5.0;

/// The prefilter stays below this share of half the sampling rate, where central differences
/// still are derivatives.
const FQ_OVER_NYQUIST: f64 = 0.4;

/// The same for differences of eighth order.
const FQ_OVER_NYQUIST_EIGHTH: f64 = 0.55;

/// Cut-off of the decimation's low-pass over half the decimated rate.
const FP_OVER_DECIMATED: f64 = 0.8;

/// Equations per parameter that decimation leaves at least, where the log allows it.
const ROWS_PER_PARAMETER: usize = 10;

/// Periods of the prefilter's cut-off that are cut off at either end.
const PERIODS: f64 = 2.0;

/// Decimated rows that the parallel filter's transient takes: its response is then below 1e-6.
const FEWEST_ROWS: usize = 10;

/// The filters, and which of them were chosen here.
pub(super) struct Chosen {
    pub fq_hz: f64,
    pub nd: usize,
    pub trim: usize,
    pub names: Vec<&'static str>,
}

/// Completes what is `given` (cut-off of the prefilter, ratio, trim) from the logs.
pub(super) fn from_logs(
    logs: &[&dyn Samples],
    looks: &[Recording],
    parameters: usize,
    (edges, derivatives): (Edges, Derivatives),
    given: (Option<f64>, Option<usize>, Option<usize>),
) -> Result<Chosen, IdentifyError> {
    let rate_hz = slowest_rate(logs)?;
    let (fq, nd, trim) = given;
    let dyn_hz = match (fq, nd) {
        (Some(_), Some(_)) => 0.0,
        _ => motion_band(looks)?,
    };
    let open = [
        ("fq_hz", fq.is_none()),
        ("nd", nd.is_none()),
        ("trim", trim.is_none()),
    ];
    let names = open
        .into_iter()
        .filter(|(_, is_open)| *is_open)
        .map(|(name, _)| name)
        .collect();
    let fq_hz = fq.unwrap_or_else(|| cut_off(dyn_hz, rate_hz, derivatives));
    let nd = nd.unwrap_or_else(|| ratio(dyn_hz, rate_hz, logs, parameters));
    let trim = trim.unwrap_or_else(|| edge(fq_hz, rate_hz, nd, edges));
    Ok(Chosen {
        fq_hz,
        nd,
        trim,
        names,
    })
}

/// What is looked at to judge the motion: all of a log, or some windows of a long one.
pub(super) fn looks(logs: &[&dyn Samples]) -> Result<Vec<Recording>, IdentifyError> {
    const WINDOW: usize = 1 << 15;
    const LOOKS: usize = 4;
    let mut looks = Vec::new();
    for log in logs {
        let len = log.len();
        if len <= LOOKS * WINDOW {
            looks.push(log.window(0..len)?);
            continue;
        }
        let window = |look: usize| {
            let start = look * (len - WINDOW) / (LOOKS - 1);
            log.window(start..start + WINDOW)
        };
        let windows = (0..LOOKS).into_par_iter().map(window);
        looks.extend(windows.collect::<Result<Vec<_>, _>>()?);
    }
    Ok(looks)
}

/// The lowest sampling rate of the logs, Hz.
fn slowest_rate(logs: &[&dyn Samples]) -> Result<f64, IdentifyError> {
    let is_rate = |rate_hz: f64| rate_hz > 0.0 && rate_hz.is_finite();
    if let Some(log) = logs.iter().find(|log| !is_rate(log.rate_hz())) {
        return Err(IdentifyError::Rate {
            log: log.name().to_owned(),
            rate_hz: log.rate_hz(),
        });
    }
    logs.iter()
        .map(|log| log.rate_hz())
        .reduce(f64::min)
        .ok_or(IdentifyError::NoLogs)
}

/// The widest band of any joint that moves in any log, \\( \omega_{dyn} \\) in Hz.
fn motion_band(logs: &[Recording]) -> Result<f64, IdentifyError> {
    let band = |log: &Recording| -> Option<f64> {
        let moving = log.q.iter().filter(|q| !rests(q));
        moving
            .filter_map(|q| bandwidth(q, log.rate_hz))
            .reduce(f64::max)
    };
    logs.iter()
        .filter_map(band)
        .reduce(f64::max)
        .ok_or_else(|| excited::nothing_moves(logs))
}

/// Cut-off of the prefilter, Hz, to two digits.
fn cut_off(dyn_hz: f64, rate_hz: f64, derivatives: Derivatives) -> f64 {
    let highest = match derivatives {
        Derivatives::Central => FQ_OVER_NYQUIST,
        Derivatives::Eighth => FQ_OVER_NYQUIST_EIGHTH,
    };
    two_digits((FQ_OVER_DYN * dyn_hz).min(highest * rate_hz / 2.0))
}

fn two_digits(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    let rounded = (x / unit).round() * unit;
    // Through text, so that 0.1 * 87 prints as 8.7.
    format!("{rounded:.12e}").parse().unwrap_or(rounded)
}

/// Decimation ratio: \\( n_d = 0.8 (\omega_c / 2) / \omega_{fp} \\), less if too few rows remain.
fn ratio(dyn_hz: f64, rate_hz: f64, logs: &[&dyn Samples], parameters: usize) -> usize {
    let by_band = FP_OVER_DECIMATED * rate_hz / 2.0 / (FP_OVER_DYN * dyn_hz);
    let samples: usize = logs.iter().map(|log| log.len()).sum();
    let by_rows = samples / (ROWS_PER_PARAMETER * parameters.max(1));
    (by_band.floor().min(1e6) as usize).min(by_rows).max(1)
}

/// What to cut off at either end: the prefilter's transient, in samples; or in decimated rows,
/// and then the transient of the parallel filter too.
fn edge(fq_hz: f64, rate_hz: f64, nd: usize, edges: Edges) -> usize {
    let samples = (PERIODS * rate_hz / fq_hz.max(f64::MIN_POSITIVE))
        .ceil()
        .clamp(0.0, 1e9) as usize;
    match edges {
        Edges::Scipy => samples,
        Edges::Matlab => samples.div_ceil(nd.max(1)).max(FEWEST_ROWS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(logs: &[Recording]) -> Vec<&dyn Samples> {
        logs.iter().map(|log| log as &dyn Samples).collect()
    }

    fn log(hz: f64, rate_hz: f64, len: usize) -> Recording {
        let wave = |i| (std::f64::consts::TAU * hz * i as f64 / rate_hz).sin();
        Recording {
            doubtful: vec![],
            name: "log.csv".into(),
            stem: "log".into(),
            rate_hz,
            start: 0.0,
            len,
            q: vec![(0..len).map(wave).collect()],
            qd: None,
            tau: None,
            stamps: Vec::new(),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn filters_follow_the_band_of_the_motion() {
        let logs = [log(2.0, 1000.0, 10_000)];
        let chosen = from_logs(
            &sources(&logs),
            &logs,
            5,
            (Edges::Scipy, Derivatives::Central),
            (None, None, None),
        )
        .unwrap();
        assert!((20.0..25.0).contains(&chosen.fq_hz), "{}", chosen.fq_hz);
        assert!((32..=40).contains(&chosen.nd), "{}", chosen.nd);
        assert_eq!(chosen.names, ["fq_hz", "nd", "trim"]);
    }

    #[test]
    fn given_choices_are_kept() {
        let logs = [log(2.0, 1000.0, 10_000)];
        let chosen = from_logs(
            &sources(&logs),
            &logs,
            5,
            (Edges::Matlab, Derivatives::Central),
            (Some(7.0), Some(3), Some(0)),
        )
        .unwrap();
        assert_eq!((chosen.fq_hz, chosen.nd, chosen.trim), (7.0, 3, 0));
        assert!(chosen.names.is_empty());
    }

    #[test]
    fn a_short_log_is_decimated_less() {
        let logs = [log(1.0, 1000.0, 3000)];
        let chosen = from_logs(
            &sources(&logs),
            &logs,
            30,
            (Edges::Scipy, Derivatives::Central),
            (None, None, None),
        )
        .unwrap();
        assert_eq!(chosen.nd, 10);
    }

    #[test]
    fn two_digits_read_well() {
        assert_eq!(two_digits(8.7449), 8.7);
        assert_eq!(two_digits(123.4), 120.0);
        assert_eq!(two_digits(0.0345), 0.035);
    }

    #[test]
    fn logs_without_motion_or_rate_are_errors() {
        let logs = [log(0.0, 100.0, 500)];
        let error = from_logs(
            &sources(&logs),
            &logs,
            5,
            (Edges::Scipy, Derivatives::Central),
            (None, None, None),
        )
        .err();
        assert_eq!(
            error,
            Some(IdentifyError::NothingMoves {
                logs: "log.csv".into(),
                seen: "q1 constant".into(),
            })
        );
        let error = from_logs(
            &[],
            &[],
            5,
            (Edges::Scipy, Derivatives::Central),
            (None, None, None),
        )
        .err();
        assert_eq!(error, Some(IdentifyError::NoLogs));
        let logs = [Recording {
            rate_hz: f64::NAN,
            ..log(1.0, 100.0, 500)
        }];
        let error = from_logs(
            &sources(&logs),
            &logs,
            5,
            (Edges::Scipy, Derivatives::Central),
            (None, None, None),
        )
        .err();
        assert!(matches!(error, Some(IdentifyError::Rate { .. })));
    }
}
