//! Every effect in the simulator is the one of the catalogue, and gears move as mechanics says.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[path = "../examples/hidden_effects/cases/mod.rs"]
#[allow(dead_code, reason = "the example uses the rest")]
mod cases;

use std::f64::consts::TAU;

use cases::hidden::{Effect, Hidden};
use cases::host::{Host, host_of};
use cases::kinds::KINDS;
use cases::logs::{Noise, Simulated, controller, simulate};
use cases::machine::Machine;
use cases::propose::propose;
use cases::random::Random;
use cases::robots::{Described, describe};
use idim::catalogue::Effects;
use idim::codegen::Robot;
use idim::codegen::builder::read_texts;
use idim::runtime::diagnose::{Catalogue, Hypothesis, Signals, TorqueColumn};
use idim::runtime::log::Fourier;
use idim::runtime::observe::dahl;
use idim::runtime::settings::Edges;
use idim::runtime::signal::{ZeroPhase, butterworth, central_difference};
use idim::runtime::simulate::{
    Grid, Method, Options, State, Trajectory, free_motion, inverse_dynamics,
};

const RATE_HZ: f64 = 1000.0;

/// Below this speed, rad/s, a difference of velocities may span a reversal.
const SLOW: f64 = 0.05;

/// An arm, what it is described as, and a motion of 4 s without noise.
struct Bench {
    described: Described,
    robot: Robot,
    bare: Machine,
    host: Host,
    motion: Fourier,
}

fn bench(kind: usize) -> Bench {
    let mut random = Random::new(11, kind as u64);
    let described = describe(&KINDS[kind], &mut random);
    let texts = [
        ("robot.toml", described.toml.as_str()),
        ("robot.urdf", &described.urdf),
    ];
    let robot = read_texts(&texts).unwrap();
    let bare = Machine::new(&robot.description, &[]).unwrap();
    let of = |part: f64| -> Vec<Vec<f64>> {
        let rows = described.ratings.iter().enumerate();
        rows.map(|(j, rating)| {
            let size = part * rating.reach;
            vec![0.5 * size, -0.2 * size * (1.0 + j as f64).cos(), 0.1 * size]
        })
        .collect()
    };
    let motion = Fourier {
        f0_hz: 0.25,
        periods: 1.0,
        center: described
            .ratings
            .iter()
            .map(|rating| rating.center)
            .collect(),
        sin: of(1.0),
        cos: of(-0.7),
    };
    let host = host_of(&robot.description, &bare, &described.ratings, &motion).unwrap();
    Bench {
        described,
        robot,
        bare,
        host,
        motion,
    }
}

impl Bench {
    fn run(&self, effects: &[Effect]) -> (Machine, Simulated) {
        let machine = Machine::new(&self.robot.description, effects).unwrap();
        let joints = self.described.ratings.len();
        let mut random = Random::new(12, 0);
        let quiet = Noise {
            resolution: 1e-9,
            white: vec![0.0; joints],
            slow: vec![(0.0, 1.0); joints],
        };
        let controller = controller(&self.described.ratings, &mut random);
        let plan = (&self.motion, &controller);
        let log = simulate((&machine, effects), &self.bare, plan, &quiet, &mut random).unwrap();
        (machine, log)
    }

    /// The true motion of the driven joints.
    fn motion_of(&self, machine: &Machine, log: &Simulated) -> Trajectory {
        let driven = machine.driven.iter();
        let q: Vec<Vec<f64>> = driven.map(|&joint| log.truth[joint].clone()).collect();
        let rate = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
            series
                .iter()
                .map(|q| central_difference(q, RATE_HZ))
                .collect()
        };
        let qd = rate(&q);
        Trajectory {
            qdd: rate(&qd),
            q,
            qd,
        }
    }

    /// What the links ask of their gears along it.
    fn rigid_load(&self, machine: &Machine, log: &Simulated) -> Vec<Vec<f64>> {
        let motion = self.motion_of(machine, log);
        inverse_dynamics(&self.bare.model, &self.bare.rigid, &motion).unwrap()
    }

    /// Torque of a log beyond that of the robot without anything hidden, along the true motion,
    /// joint by joint; and the motion.
    fn beyond(&self, log: &Simulated) -> (Vec<Vec<f64>>, Trajectory) {
        let motion = self.motion_of(&self.bare, log);
        let known = inverse_dynamics(&self.bare.model, &self.bare.values, &motion).unwrap();
        // Torques are held from sample to sample.
        let mean = |tau: &[f64], k: usize| 0.5 * (tau[k.saturating_sub(1)] + tau[k]);
        let difference = |(tau, known): (&Vec<f64>, &Vec<f64>)| {
            (0..tau.len()).map(|k| mean(tau, k) - known[k]).collect()
        };
        (log.tau.iter().zip(&known).map(difference).collect(), motion)
    }
}

/// Samples at which every joint moves, and their neighbours.
fn moving(motion: &Trajectory) -> Vec<usize> {
    let len = motion.q[0].len();
    let fast = |k: usize| motion.qd.iter().all(|qd| qd[k].abs() > SLOW);
    (100..len - 100)
        .filter(|&k| (k - 4..k + 5).all(fast))
        .collect()
}

/// Root mean square of differences at some samples, relative to that of the second.
fn relative(one: &[f64], other: &[f64], at: &[usize]) -> f64 {
    let sum = |f: &dyn Fn(usize) -> f64| at.iter().map(|&k| f(k).powi(2)).sum::<f64>();
    (sum(&|k| one[k] - other[k]) / sum(&|k| other[k])).sqrt()
}

#[test]
fn static_effects_add_their_column_times_their_parameter() {
    let bench = bench(1);
    let catalogue = Effects::new(&bench.robot);
    let names = [
        "torque_offset",
        "viscous_asymmetry",
        "stribeck",
        "nonlinear_viscous",
        "position_dependent_friction",
        "torque_ripple",
        "spring",
        "end_stop",
        "transmission_coupling",
    ];
    for (number, name) in names.into_iter().enumerate() {
        let mut random = Random::new(13, number as u64);
        let effect = propose(name, 1.5, &bench.host, &mut random).unwrap();
        let (_, log) = bench.run(std::slice::from_ref(&effect));
        let (beyond, motion) = bench.beyond(&log);
        let expected = column_times_parameter(&catalogue, &bench, &effect, &motion);
        let at = moving(&motion);
        assert!(at.len() > 500, "{name}: {}", at.len());
        let loudest = (0..3).max_by(|a, b| {
            let size = |j: usize| at.iter().map(|&k| expected[j][k].powi(2)).sum::<f64>();
            size(*a).total_cmp(&size(*b))
        });
        let joint = loudest.unwrap();
        // A shaft that two joints turn reverses where neither does.
        let top = expected[joint]
            .iter()
            .fold(0.0, |top: f64, x| top.max(x.abs()));
        let jumps = |k: usize| (expected[joint][k] - expected[joint][k - 1]).abs() > 0.2 * top;
        let smooth: Vec<usize> = at
            .iter()
            .copied()
            .filter(|&k| !(k - 4..k + 5).any(jumps))
            .collect();
        let error = relative(&beyond[joint], &expected[joint], &smooth);
        assert!(error < 0.03, "{name} on joint {joint}: {error}");
    }
}

/// The columns of the catalogue for an effect along a motion: on each joint, per unit of their
/// parameters.
fn columns(
    catalogue: &Effects,
    bench: &Bench,
    (name, joints, shape): (&str, &[usize], &[f64]),
    motion: &Trajectory,
) -> Vec<Vec<Vec<f64>>> {
    let len = motion.q[0].len();
    let t: Vec<f64> = (0..len).map(|k| k as f64 / RATE_HZ).collect();
    let zero = vec![vec![0.0; len]; motion.q.len()];
    let signals = Signals {
        rate_hz: RATE_HZ,
        t: &t,
        q: &motion.q,
        qd: &motion.qd,
        qdd: &motion.qdd,
        tau_model: &zero,
        tau_rigid: &zero,
        parameters: &bench.bare.values,
        dead_band: &[],
    };
    let entry = catalogue
        .entries()
        .iter()
        .position(|entry| entry.name == name);
    let hypothesis = Hypothesis {
        entry: entry.unwrap(),
        joints: joints.to_vec(),
        grid: vec![],
        bounds: vec![],
        least: 0.0,
    };
    let on_joints = |column: TorqueColumn| {
        let mut all = zero.clone();
        column
            .torque
            .into_iter()
            .for_each(|(joint, torque)| all[joint] = torque);
        all
    };
    let made = catalogue.columns(&hypothesis, shape, &signals);
    made.into_iter().map(on_joints).collect()
}

/// What the catalogue says that an effect adds along a motion.
fn column_times_parameter(
    catalogue: &Effects,
    bench: &Bench,
    effect: &Effect,
    motion: &Trajectory,
) -> Vec<Vec<f64>> {
    let Hidden::Columns(hidden) = &effect.hidden else {
        panic!("{} is no column", effect.name);
    };
    let values = hidden
        .iter()
        .flat_map(|column| &column.values)
        .map(|(_, value)| *value);
    let what = (effect.name, &*hidden[0].joints, &*hidden[0].shape);
    let all = columns(catalogue, bench, what, motion);
    let mut torque = vec![vec![0.0; motion.q[0].len()]; motion.q.len()];
    for (column, value) in all.iter().zip(values) {
        for (sum, unit) in torque.iter_mut().flatten().zip(column.iter().flatten()) {
            *sum += value * unit;
        }
    }
    torque
}

#[test]
fn contact_that_yields_follows_the_dahl_state_of_the_catalogue() {
    let bench = bench(0);
    let zs = 0.03;
    let coulomb = bench.host.coulomb[0];
    let column = cases::hidden::Column {
        kind: idim::codegen::catalogue::EffectKind::Presliding,
        joints: vec![0],
        shape: vec![zs],
        values: vec![("FP", coulomb)],
    };
    let effect = Effect {
        name: "presliding",
        joints: vec![0],
        hidden: Hidden::Columns(vec![column]),
    };
    let (_, log) = bench.run(&[effect]);
    let (beyond, motion) = bench.beyond(&log);
    let slip = dahl(&motion.qd[0], RATE_HZ, zs, motion.qd[0][0].signum());
    let pairs = slip.iter().zip(&motion.qd[0]);
    let expected: Vec<f64> = pairs.map(|(z, qd)| coulomb * (z - qd.signum())).collect();
    let error = relative(&beyond[0], &expected, &moving(&motion));
    assert!(error < 0.05, "{error}");
}

#[test]
fn link_behind_a_locked_drive_swings_at_its_frequency() {
    let bench = bench(0);
    let (stiffness, damping) = (400.0, 0.0);
    let effect = Effect {
        name: "joint_elasticity",
        joints: vec![1],
        hidden: Hidden::Elastic {
            joint: 1,
            stiffness,
            damping,
        },
    };
    let mut description = bench.robot.description.clone();
    for (name, value) in &mut description.parameters {
        *value = if name.starts_with("IA") { 1e7 } else { 0.0 };
    }
    let machine = Machine::new(&description, &[effect]).unwrap();
    assert_eq!(machine.driven, [0, 1]);
    let start = State {
        q: vec![0.1, 0.3, 0.01],
        qd: vec![0.0; 3],
    };
    let grid = Grid {
        rate_hz: RATE_HZ,
        start: 0.0,
        len: 2001,
    };
    let options = Options {
        method: Method::Fixed { step_s: 1e-3 },
        ..Options::default()
    };
    let swing = free_motion(&machine.model, &machine.values, (&start, grid), &options).unwrap();
    let link = &swing.q[2];
    let crossings: Vec<usize> = (1..link.len())
        .filter(|&k| link[k - 1] > 0.0 && link[k] <= 0.0)
        .collect();
    let periods = (crossings.len() - 1) as f64;
    let measured = periods * RATE_HZ / (crossings[crossings.len() - 1] - crossings[0]) as f64;
    let expected = (stiffness / bench.host.carried[1]).sqrt() / TAU;
    assert!(
        (measured / expected - 1.0).abs() < 0.005,
        "{measured} {expected}"
    );
    // Nothing is lost.
    let top = link[1000..]
        .iter()
        .fold(0.0, |top: f64, x| top.max(x.abs()));
    assert!((top / 0.01 - 1.0).abs() < 1e-3, "{top}");
}

#[test]
fn stiff_gear_bends_by_its_load_over_its_stiffness() {
    let bench = bench(1);
    let stiffness = 4e4;
    let effect = Effect {
        name: "joint_elasticity",
        joints: vec![1],
        hidden: Hidden::Elastic {
            joint: 1,
            stiffness,
            damping: 40.0,
        },
    };
    let (machine, log) = bench.run(&[effect]);
    let bent = &log.truth[machine.driven[1] + 1];
    let (load, motion) = (
        bench.rigid_load(&machine, &log),
        bench.motion_of(&machine, &log),
    );
    let expected: Vec<f64> = load[1].iter().map(|load| -load / stiffness).collect();
    let error = relative(bent, &expected, &moving(&motion));
    assert!(error < 0.05, "{error}");
}

#[test]
fn gear_with_play_rests_on_either_side_of_its_gap() {
    let bench = bench(0);
    let (gap, stiffness) = (4e-3, 2e4);
    let effect = Effect {
        name: "backlash",
        joints: vec![0],
        hidden: Hidden::Backlash {
            joint: 0,
            gap,
            stiffness,
            damping: 4.0,
        },
    };
    let (machine, log) = bench.run(&[effect]);
    let play = &log.truth[machine.driven[0] + 1];
    let deepest = bench.host.peak[0] / stiffness;
    let (low, high) = play.iter().fold((0.0, 0.0), |(low, high): (f64, f64), x| {
        (low.min(*x), high.max(*x))
    });
    assert!(
        high > 0.5 * gap && high < 0.5 * gap + 2.0 * deepest,
        "{high}"
    );
    assert!(
        -low > 0.5 * gap && -low < 0.5 * gap + 2.0 * deepest,
        "{low}"
    );
    // Under load the link leans on the stop that carries it, but for a bounce.
    let load = bench.rigid_load(&machine, &log);
    let loaded = (0..play.len()).filter(|&k| load[0][k].abs() > 0.25 * bench.host.peak[0]);
    let (count, leaning) = loaded.fold((0, 0), |(count, leaning), k| {
        let leans = play[k] * load[0][k] < 0.0 && play[k].abs() >= 0.5 * gap;
        (count + 1, leaning + usize::from(leans))
    });
    assert!(
        count > 500 && leaning * 100 > count * 95,
        "{leaning} of {count}"
    );
}

/// What a gear costs beyond the rigid model, against its column; both as the diagnosis sees them,
/// without what is faster than 20 Hz: what is left of it, and what there is, root of sums of squares.
fn cost_of_gear(kind: usize, effect: Effect, shape: &[f64], parameter: f64) -> [f64; 2] {
    let bench = bench(kind);
    let catalogue = Effects::new(&bench.robot);
    let (machine, log) = bench.run(std::slice::from_ref(&effect));
    let motion = bench.motion_of(&machine, &log);
    let known = inverse_dynamics(&bench.bare.model, &bench.bare.values, &motion).unwrap();
    let what = (effect.name, &*effect.joints, shape);
    let column = columns(&catalogue, &bench, what, &motion).remove(0);
    let cascade = butterworth(4, 20.0, RATE_HZ).unwrap();
    let low_pass = ZeroPhase::new(cascade, 4, Edges::Scipy);
    // Neither where dry friction turns nor where the start still rings.
    let at = moving(&motion);
    let [mut left, mut there] = [0.0, 0.0];
    for joint in 0..column.len() {
        let mean = |k: usize| 0.5 * (log.tau[joint][k.saturating_sub(1)] + log.tau[joint][k]);
        let beyond: Vec<f64> = (0..known[joint].len())
            .map(|k| mean(k) - known[joint][k])
            .collect();
        let modelled: Vec<f64> = column[joint].iter().map(|unit| parameter * unit).collect();
        let smooth = low_pass.filter(&[beyond, modelled]).unwrap();
        for &k in at.iter().filter(|&&k| k > 600) {
            left += (smooth[0][k] - smooth[1][k]).powi(2);
            there += smooth[0][k].powi(2);
        }
    }
    [left.sqrt(), there.sqrt()]
}

#[test]
fn gear_that_yields_costs_its_column_over_its_stiffness() {
    let (stiffness, damping) = (900.0, 3.0);
    let carried = bench(0).host.carried[1];
    let w = (stiffness / carried).sqrt();
    let effect = Effect {
        name: "joint_elasticity",
        joints: vec![1],
        hidden: Hidden::Elastic {
            joint: 1,
            stiffness,
            damping,
        },
    };
    let shape = [w / TAU, 0.5 * damping / (w * carried)];
    let [left, there] = cost_of_gear(0, effect, &shape, 1.0 / stiffness);
    // To first order in what it yields, and but for the turns of friction beside it.
    assert!(left < 0.15 * there, "{left} of {there}");
}
