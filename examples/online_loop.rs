//! A SCARA under its controller at 1 kHz: the recursion finds its parameters on line, then the robot
//! changes and the watchdog says so.
//!
//! `cargo run --release --example online_loop`

use std::error::Error;

use idim::demo;
use idim::robots::scara;
use idim::runtime::log::{Controller, Feedforward, Fourier, Law, Reference, Start};
use idim::runtime::model::IdentificationModel;
use idim::runtime::online::{Options, Recursion, Step, Stream, WatchOptions, Watchdog};
use idim::runtime::simulate::{self, ClosedLoop, Grid, Simulation, State};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

const RATE_HZ: f64 = 1000.0;

/// Step of the encoders, rad: 17 bits in front of a gear of 40.
const ENCODER: f64 = 1.2e-6;

/// Standard deviation of the torque signals' noise, N m.
const NOISE: [f64; 2] = [0.05, 0.005];

/// A cycle of the task, s.
const CYCLE_S: f64 = 5.0;

fn main() -> Result<(), Box<dyn Error>> {
    let model = scara::Model;
    let truth = demo::experiment()?.truth;
    let options = Options::at(RATE_HZ);
    let watch = WatchOptions {
        block_s: CYCLE_S,
        ..WatchOptions::default()
    };
    let mut stream = Stream::new(model, &options)?;
    // Weights: one over the noise; two minutes of memory.
    let forgetting = 1.0 - options.nd as f64 / (120.0 * RATE_HZ);
    let mut recursion = Recursion::new(&stream, &NOISE.map(f64::recip), forgetting)?;
    let mut watchdog = Watchdog::new(&stream, &truth, &watch)?;
    let mut robot = Robot::new(&truth);
    let mut solution = recursion.solution();

    println!(
        "instants come {:.0} ms after their motion",
        1e3 * stream.lag_s()
    );
    print!("{:>6}", "t, s");
    model
        .columns()
        .iter()
        .for_each(|c| print!("{:>17}", c.name));
    println!("   watchdog");
    for cycle in 1..=24 {
        if cycle == 18 {
            println!("-- 20 % more Coulomb friction in the elbow --");
            robot.parameters[place("FS2")] *= 1.2;
        }
        if cycle == 21 {
            println!("-- the elbow carries 0.02 kg m^2 more --");
            robot.parameters[place("ZZ2")] += 0.02;
            watchdog.acknowledge();
        }
        for (q, tau) in robot.cycle()? {
            if let Step::Equations(instant) = stream.push(&q, None, &tau)? {
                recursion.update(instant);
                watchdog.update(instant);
            }
        }
        watchdog.check();
        if [1, 2, 4, 8, 12].contains(&cycle) || cycle >= 16 {
            recursion.solve(&mut solution)?;
            print!("{:6.0}", cycle as f64 * CYCLE_S);
            for k in 0..model.columns().len() {
                match (solution.value(k), solution.sigma[k]) {
                    (Some(x), Some(sigma)) => print!("  {x:7.4} {sigma:7.5}"),
                    _ => print!("{:>17}", "not determined"),
                }
            }
            println!("   {}", words(&mut watchdog));
        }
    }
    print!("{:>6}", "true");
    robot
        .parameters
        .iter()
        .for_each(|x| print!("  {x:7.4}        "));
    println!();
    Ok(())
}

fn place(name: &str) -> usize {
    let columns = scara::Model.columns();
    columns.iter().position(|c| c.name == name).unwrap_or(0)
}

fn words(watchdog: &mut Watchdog) -> String {
    if watchdog.check().iter().any(|health| !health.learned) {
        return "learns".into();
    }
    match watchdog.worst() {
        None => "as learned".into(),
        Some((equation, alarm)) => format!(
            "{}: other {:?} since {:.0} s, {:.0} sigma",
            scara::Model.joints()[equation].name,
            alarm.deviation,
            alarm.since as f64 / RATE_HZ,
            alarm.sigma,
        )
        .to_lowercase(),
    }
}

/// What a loop reads: positions, rad, and torques, N m.
type Sample = ([f64; 2], [f64; 2]);

/// The simulated robot, its controller and its sensors.
struct Robot {
    parameters: Vec<f64>,
    reference: Reference,
    controller: Controller,
    state: Option<State>,
    random: Pcg64Mcg,
}

impl Robot {
    fn new(parameters: &[f64]) -> Robot {
        Robot {
            parameters: parameters.to_vec(),
            reference: Reference::Fourier(Fourier {
                f0_hz: 1.0 / CYCLE_S,
                periods: f64::MAX,
                center: vec![0.0, 0.0],
                sin: vec![vec![0.8, 0.0, 0.2, -0.1], vec![0.3, 0.9, 0.0, 0.15]],
                cos: vec![vec![0.0, 0.3, -0.15, 0.05], vec![0.2, -0.1, 0.2, 0.1]],
            }),
            controller: Controller {
                law: Law::Pd,
                kp: vec![5700.0, 120.0],
                kd: vec![210.0, 4.5],
                feedforward: Feedforward::None,
                velocity_filter_hz: Some(80.0),
                torque_limit: None,
                start: Start::Reference,
            },
            state: None,
            random: Pcg64Mcg::new(4),
        }
    }

    /// What the loop reads in one cycle: positions and torques, sample by sample.
    fn cycle(&mut self) -> Result<Vec<Sample>, Box<dyn Error>> {
        let len = (CYCLE_S * RATE_HZ) as usize;
        let plan = ClosedLoop {
            reference: &self.reference,
            controller: &self.controller,
            rigid: &[],
            grid: Grid {
                rate_hz: RATE_HZ,
                start: 0.0,
                len: len + 1,
            },
            start: self.state.as_ref(),
        };
        let own = simulate::Options {
            encoder_resolution: Some(ENCODER),
            ..simulate::Options::default()
        };
        let run = simulate::closed_loop(&scara::Model, &self.parameters, &plan, &own)?;
        let last = |series: &[Vec<f64>]| series.iter().map(|joint| joint[len]).collect();
        self.state = Some(State {
            q: last(&run.q),
            qd: last(&run.qd),
        });
        Ok((0..len).map(|i| self.read(&run, i)).collect())
    }

    fn read(&mut self, run: &Simulation, i: usize) -> Sample {
        let q = std::array::from_fn(|j| (run.q[j][i] / ENCODER).round() * ENCODER);
        let tau = std::array::from_fn(|j| run.tau[j][i] + NOISE[j] * normal(&mut self.random));
        (q, tau)
    }
}

/// About normal, of variance one: the sum of twelve uniform numbers.
fn normal(random: &mut Pcg64Mcg) -> f64 {
    let mut uniform = || f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5;
    (0..12).map(|_| uniform()).sum()
}
