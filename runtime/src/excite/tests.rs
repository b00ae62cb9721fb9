//! Searches on a planar arm of two links, written by hand from its textbook equations.

use super::*;
use crate::log::Reference;
use crate::model::{Column, ColumnKind, Entry, Joint, JointKind, Output, Pattern, States};
use crate::settings::Settings as Own;
use crate::simulate::{Grid, Trajectory};

const G: f64 = 9.81;

/// Two links of length 1 that swing in a vertical plane. Parameters: ZZ1 and MX1 of the first link
/// (with the second's mass in them), ZZ2, MX2 of the second, viscous and dry friction of both.
struct Arm {
    joints: Vec<Joint>,
    columns: Vec<Column>,
    pattern: Pattern,
    settings: Own,
}

type Formula = fn([f64; 2], [f64; 2], [f64; 2]) -> f64;

/// Row, column and value of every entry of D.
const ENTRIES: [(usize, usize, Formula); 11] = [
    (0, 0, |_, _, a| a[0]),
    (0, 1, |q, _, _| G * q[0].cos()),
    (0, 2, |_, _, a| a[0] + a[1]),
    (0, 3, |q, v, a| {
        (2.0 * a[0] + a[1]) * q[1].cos() - (2.0 * v[0] + v[1]) * v[1] * q[1].sin()
            + G * (q[0] + q[1]).cos()
    }),
    (0, 4, |_, v, _| v[0]),
    (0, 5, |_, v, _| v[0].signum()),
    (1, 2, |_, _, a| a[0] + a[1]),
    (1, 3, |q, v, a| {
        a[0] * q[1].cos() + v[0] * v[0] * q[1].sin() + G * (q[0] + q[1]).cos()
    }),
    (1, 6, |_, v, _| v[1]),
    (1, 7, |_, v, _| v[1].signum()),
    // A parameter that appears with the viscous friction of joint 2 only: not by itself.
    (1, 8, |_, v, _| 2.0 * v[1]),
];

const NAMES: [&str; 9] = [
    "ZZ1", "MX1", "ZZ2", "MX2", "FV1", "FS1", "FV2", "FS2", "TWIN2",
];

/// The arm with the first `columns` of its parameters.
fn arm(columns: usize) -> Arm {
    let column = |name: &&'static str| Column {
        name: (*name).into(),
        unit: "SI".into(),
        joint: 1,
        kind: ColumnKind::Inertial,
        meaning: "".into(),
        relation: "".into(),
    };
    let joint = |name: &'static str| Joint {
        name: name.into(),
        kind: JointKind::Revolute,
    };
    let entries = ENTRIES.iter().filter(|entry| entry.1 < columns).enumerate();
    let entry = |(signal, &(row, column, _)): (usize, &(usize, usize, Formula))| Entry {
        row,
        column,
        signal,
    };
    let entries: Vec<Entry> = entries.map(entry).collect();
    Arm {
        joints: ["upper", "fore"].map(joint).into(),
        columns: NAMES[..columns].iter().map(column).collect(),
        pattern: Pattern {
            signals: entries.len(),
            entries: entries.into(),
        },
        settings: Own::default(),
    }
}

impl IdentificationModel for Arm {
    fn name(&self) -> &str {
        "arm"
    }
    fn joints(&self) -> &[Joint] {
        &self.joints
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, _: Output) -> &Pattern {
        &self.pattern
    }
    fn settings(&self) -> &Own {
        &self.settings
    }
    fn evaluate(&self, _: Output, states: &States<'_>, signals: &mut [f64]) {
        let kept = ENTRIES.iter().filter(|entry| entry.1 < self.columns.len());
        for ((_, _, formula), signal) in kept.zip(signals.chunks_mut(states.len)) {
            for (i, value) in signal.iter_mut().enumerate() {
                let at = |series: &[f64]| [series[i], series[states.len + i]];
                *value = formula(at(states.q), at(states.qd), at(states.qdd));
            }
        }
    }
}

fn limits() -> [JointLimits; 2] {
    let one = |lower, upper, effort| JointLimits {
        lower,
        upper,
        velocity: 2.0,
        acceleration: 12.0,
        effort,
    };
    [one(-1.0, 2.0, 90.0), one(-2.0, 2.0, 40.0)]
}

const VALUES: [f64; 8] = [2.0, 3.0, 0.5, 1.0, 0.3, 0.8, 0.2, 0.5];

fn settings(family: Family, criterion: Criterion) -> Settings {
    Settings {
        family,
        start: Start::Rest,
        criterion,
        period_s: 6.0,
        periods: 2,
        search: Search {
            seed: 7,
            starts: 2,
            steps: 40,
        },
        noise: Noise {
            sigma: vec![0.5, 0.2],
            rate_hz: 200.0,
        },
        wanted_pct: None,
    }
}

const FOURIER: Family = Family::Fourier { harmonics: 5 };
const POINTS: Family = Family::ViaPoints { points: 4 };

fn find(criterion: Criterion, family: Family) -> Excitation {
    let (model, limits) = (arm(8), limits());
    let task = Task {
        model: &model,
        limits: &limits,
        center: None,
        parameters: Some(&VALUES),
    };
    excite(&task, &settings(family, criterion), &|| ()).unwrap()
}

/// The path of a motion at the rate of a controller.
fn along(motion: &Reference) -> Trajectory {
    let seconds = motion.seconds().unwrap();
    let grid = Grid {
        rate_hz: 997.0,
        start: 0.0,
        len: (997.0 * seconds) as usize,
    };
    Trajectory::of(motion, &grid).unwrap()
}

#[test]
fn every_limit_holds_along_the_motion_that_is_written() {
    for family in [FOURIER, POINTS] {
        let found = find(Criterion::Condition, family);
        let path = along(&found.motion);
        let tau = crate::simulate::inverse_dynamics(&arm(8), &VALUES, &path).unwrap();
        for (joint, limits) in limits().into_iter().enumerate() {
            let inside = |q: &f64| limits.lower <= *q && *q <= limits.upper;
            assert!(path.q[joint].iter().all(inside), "{family:?}");
            assert!(path.qd[joint].iter().all(|v| v.abs() <= limits.velocity));
            assert!(
                path.qdd[joint]
                    .iter()
                    .all(|a| a.abs() <= limits.acceleration)
            );
            assert!(tau[joint].iter().all(|tau| tau.abs() <= limits.effort));
            let start = [path.qd[joint][0], path.qdd[joint][0]];
            assert!(start.iter().all(|rate| rate.abs() < 1e-9));
            assert!((path.q[joint][0] - found.joints[joint].center).abs() < 1e-9);
        }
    }
}

#[test]
fn search_is_far_better_than_chance_and_the_same_for_a_seed() {
    for criterion in [
        Criterion::Condition,
        Criterion::Scaled,
        Criterion::Determinant,
    ] {
        let found = find(criterion.clone(), FOURIER);
        let chance = found.by_chance;
        assert!(chance.motions > 50, "{chance:?}");
        // A condition number cannot be below 1; of the volume, the criterion is the eighth root.
        let measure = |value: f64| match criterion {
            Criterion::Condition | Criterion::Scaled => value - 1.0,
            _ => value.powi(8),
        };
        let above = measure(chance.found);
        let [best, median] = [chance.best, chance.median].map(|value| measure(value.unwrap()));
        assert!(
            above < 0.8 * best && above < 0.5 * median,
            "{criterion:?} {chance:?}"
        );
        assert_eq!(found, find(criterion, FOURIER));
    }
}

#[test]
fn each_criterion_is_best_at_its_own() {
    let condition = find(Criterion::Condition, FOURIER);
    let scaled = find(Criterion::Scaled, FOURIER);
    assert!(condition.condition < scaled.condition);
    assert!(scaled.condition_scaled < condition.condition_scaled);
    let columns = vec![4, 5];
    let separate = find(Criterion::Separate { columns }, FOURIER);
    let product =
        |it: &Excitation| it.parameters[4].sigma.unwrap() * it.parameters[5].sigma.unwrap();
    assert!(product(&separate) < product(&condition).min(product(&scaled)));
}

#[test]
fn slopes_of_the_cost_are_those_of_differences() {
    let (model, limits) = (arm(8), limits());
    let task = Task {
        model: &model,
        limits: &limits,
        center: None,
        parameters: Some(&VALUES),
    };
    let settings = settings(FOURIER, Criterion::Determinant);
    let within = Within::new(&task).unwrap();
    let basis = Basis::new(FOURIER, Start::Rest, settings.period_s);
    let space = Space::new(basis, &limits, None);
    let cost = Cost {
        sampled: instants(&space, INSTANTS, false),
        regressor: regressor(&task, &settings, &within, true),
        space: &space,
        criterion: &settings.criterion,
        separate: Vec::new(),
        parameters: task.parameters,
    };
    let mut random = random::Random::new(3, 3);
    // Beyond the limits of position, velocity and effort.
    let z: Vec<f64> = (0..space.len()).map(|_| 1.4 * random.symmetric()).collect();
    let stage = cost::Stage {
        sharpness: 3.0,
        penalty: 5.0,
    };
    let (_, slopes) = cost.slopes(&z, stage).unwrap();
    let step = 1e-6;
    for k in 0..z.len() {
        let at = |side: f64| {
            let mut z = z.clone();
            z[k] += side * step;
            cost.value(&z, stage).unwrap()
        };
        let found = (at(1.0) - at(-1.0)) / (2.0 * step);
        let size = slopes.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(
            (found - slopes[k]).abs() < 1e-4 * size,
            "{k}: {found} {}",
            slopes[k]
        );
    }
}

#[test]
fn sigma_falls_with_the_root_of_the_periods_and_the_wanted_one_is_met() {
    let (model, limits) = (arm(8), limits());
    let task = Task {
        model: &model,
        limits: &limits,
        center: None,
        parameters: Some(&VALUES),
    };
    let mut settings = settings(FOURIER, Criterion::Condition);
    settings.wanted_pct = Some(0.5);
    let run = |periods: usize| {
        let settings = Settings {
            periods,
            ..settings.clone()
        };
        excite(&task, &settings, &|| ()).unwrap()
    };
    let one = run(1);
    for (k, parameter) in one.parameters.iter().enumerate() {
        let periods = parameter.periods.unwrap() as usize;
        let reached = run(periods).parameters[k].sigma_pct.unwrap();
        assert!(reached <= 0.5, "{}: {reached}", parameter.name);
        let ratio = parameter.sigma_pct.unwrap() / reached;
        assert!((ratio / (periods as f64).sqrt() - 1.0).abs() < 1e-9);
        if periods > 1 {
            assert!(run(periods - 1).parameters[k].sigma_pct.unwrap() > 0.5);
        }
    }
}

#[test]
fn parameters_that_no_motion_determines_are_named() {
    let (model, limits) = (arm(9), limits());
    let task = Task {
        model: &model,
        limits: &limits,
        center: None,
        parameters: None,
    };
    let found = excite(&task, &settings(FOURIER, Criterion::Condition), &|| ()).unwrap();
    assert_eq!(found.undetermined.len(), 1);
    assert_eq!(found.undetermined[0].names, ["FV2", "TWIN2"]);
    assert_eq!(found.undetermined[0].known, 1);
    let sigma = |name: &str| {
        found
            .parameters
            .iter()
            .find(|it| it.name == name)
            .unwrap()
            .sigma
    };
    assert!(sigma("TWIN2").is_none() && sigma("FV2").is_none() && sigma("FV1").is_some());
    let separate = settings(FOURIER, Criterion::Separate { columns: vec![6] });
    let error = excite(&task, &separate, &|| ()).unwrap_err();
    assert_eq!(error, ExciteError::Inseparable { name: "FV2".into() });
}

/// The error of a task and settings that are changed first.
fn refused(change: impl Fn(&mut [JointLimits; 2], &mut Settings)) -> String {
    let (model, mut limits) = (arm(8), limits());
    let mut settings = settings(FOURIER, Criterion::Condition);
    change(&mut limits, &mut settings);
    let task = Task {
        model: &model,
        limits: &limits,
        center: Some(&[0.1, 0.2]),
        parameters: Some(&VALUES),
    };
    excite(&task, &settings, &|| ()).unwrap_err().to_string()
}

#[test]
fn what_no_motion_can_do_is_refused_in_words() {
    type Change = fn(&mut [JointLimits; 2], &mut Settings);
    let cases: [(Change, &str); 11] = [
        (
            |l, _| l[1].lower = 2.0,
            "joint `fore` cannot move: its lower limit 2",
        ),
        (
            |l, _| l[0].velocity = 0.0,
            "the velocity limit of joint `upper` is 0",
        ),
        (
            |l, _| l[0].acceleration = f64::NAN,
            "the acceleration limit of joint `upper`",
        ),
        (
            |l, _| l[0].effort = 0.0,
            "the effort limit of joint `upper` is 0",
        ),
        (
            |l, _| l[0].effort = 20.0,
            "holding joint `upper` still at the centre",
        ),
        (
            |l, _| l[1].lower = 0.3,
            "the centre of joint `fore`, 0.2, is not between",
        ),
        (
            |_, s| s.family = Family::Fourier { harmonics: 2 },
            "2 harmonics leave",
        ),
        (|_, s| s.period_s = -1.0, "the period is -1"),
        (
            |_, s| s.noise.sigma[1] = 0.0,
            "the noise of joint `fore` is 0",
        ),
        (|_, s| s.noise.rate_hz = 1.0, "fewer than the 8"),
        (
            |_, s| s.wanted_pct = Some(1e-6),
            "cannot be reached for any parameter",
        ),
    ];
    for (change, message) in cases {
        let found = refused(change);
        assert!(found.contains(message), "{found}");
    }
}
