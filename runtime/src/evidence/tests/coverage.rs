//! Do intervals hold what they promise? Regressions with known truth and coloured errors.

use super::super::{Cut, Evidence, Question, Weighting};
use super::{Random, numbers};
use crate::observe::{Equations, ModelKind, Observations};

const ROWS: usize = 1600;
const NP: usize = 5;
const REPLICATIONS: usize = 600;
const TRUTH: [f64; NP] = [2.0, -0.5, 0.3, 1.0, 0.1];

/// Two joints on a periodic motion: accelerations, velocities, signs of velocity and an offset,
/// as a robot's equations have them.
fn motion() -> Vec<Equations> {
    let wave =
        |i: usize, f: f64, p: f64| (std::f64::consts::TAU * f * i as f64 / ROWS as f64 + p).sin();
    let velocity = |i: usize| wave(i, 10.0, 0.3) + 0.6 * wave(i, 26.0, 1.1);
    let columns: [Box<dyn Fn(usize) -> f64>; NP] = [
        Box::new(|i| 10.0 * wave(i, 10.0, 1.9) + 15.6 * wave(i, 26.0, 2.7)),
        Box::new(|i| 3.0 * wave(i, 17.0, 0.4) + wave(i, 4.0, 0.0)),
        Box::new(velocity),
        Box::new(|i| velocity(i).signum()),
        Box::new(|_| 1.0),
    ];
    let block = |columns_seen: Vec<usize>, shift: usize| Equations {
        w: columns_seen
            .iter()
            .flat_map(|c| {
                (0..ROWS)
                    .map(|i| columns[*c](i + shift))
                    .collect::<Vec<_>>()
            })
            .collect(),
        columns: columns_seen,
        rows: ROWS,
        y: None,
    };
    vec![block(vec![0, 1, 2, 3, 4], 0), block(vec![1, 2, 3], 131)]
}

/// First-order autoregressive errors of unit variance.
fn coloured(random: &mut Random, phi: f64) -> Vec<f64> {
    let mut state = random.normal();
    let step = (1.0 - phi * phi).sqrt();
    (0..ROWS)
        .map(|_| {
            state = phi * state + step * random.normal();
            state
        })
        .collect()
}

/// Share of intervals that hold the truth, per parameter: classical, corrected, bootstrap.
fn coverage(phi: f64, resamples: usize, replications: usize) -> [[f64; NP]; 3] {
    let robot = numbers("arm", NP, 2);
    let mut blocks = motion();
    let clean: Vec<Vec<f64>> = blocks.iter().map(|block| block.product(&TRUTH)).collect();
    let mut random = Random(20_260_101);
    let mut hits = [[0.0; NP]; 3];
    for _ in 0..replications {
        // Errors of the joints at the same time are correlated.
        let common = coloured(&mut random, phi);
        for (joint, block) in blocks.iter_mut().enumerate() {
            let level = [0.5, 0.2][joint];
            let own = coloured(&mut random, phi);
            let error = common
                .iter()
                .zip(own)
                .map(|(a, b)| level * (0.6 * a + 0.8 * b));
            block.y = Some(clean[joint].iter().zip(error).map(|(y, e)| y + e).collect());
        }
        let observations = Observations {
            model: ModelKind::Explicit,
            blocks: blocks.clone(),
        };
        let evidence =
            Evidence::from_observations(&robot, &observations, &[], Cut::default()).unwrap();
        let question = Question::parameters(&evidence, Weighting::Residual);
        let fit = evidence.fit(&question).unwrap();
        let corrected = evidence.corrected(&fit).unwrap();
        let resampling = super::super::Resampling {
            replications: resamples,
            ..Default::default()
        };
        let bootstrap = (resamples > 0).then(|| evidence.bootstrap(&fit, &resampling).unwrap());
        for k in 0..NP {
            let half = [
                1.96 * fit.sigma[k].unwrap(),
                corrected.half_width(k, 0.95).unwrap(),
                bootstrap
                    .as_ref()
                    .map_or(0.0, |b| b.covariance.half_width(k, 0.95).unwrap()),
            ];
            for (hits, half) in hits.iter_mut().zip(half) {
                let inside = (fit.solution[k] - TRUTH[k]).abs() <= half;
                hits[k] += if inside {
                    100.0 / replications as f64
                } else {
                    0.0
                };
            }
        }
    }
    hits
}

#[test]
fn corrected_intervals_hold_the_truth_where_classical_ones_do_not() {
    for phi in [0.0, 0.8, 0.95] {
        let [classical, corrected, _] = coverage(phi, 0, REPLICATIONS);
        println!("phi {phi}: classical {classical:.1?} %, corrected {corrected:.1?} %");
        assert!(
            corrected.iter().all(|share| (92.0..=98.0).contains(share)),
            "{corrected:?}"
        );
        let least = classical.iter().copied().fold(100.0, f64::min);
        assert_eq!(least < 75.0, phi > 0.0, "{classical:?}");
    }
}

#[test]
fn bootstrap_intervals_hold_the_truth() {
    let [_, _, bootstrap] = coverage(0.8, 199, 200);
    println!("bootstrap {bootstrap:.1?} %");
    assert!(bootstrap.iter().all(|share| *share > 90.0), "{bootstrap:?}");
}
