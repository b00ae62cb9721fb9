//! Simulated logs.

use std::fmt::Write;

use idim::runtime::log::{Controller, Feedforward, Fourier, Law, Reference, Start};
use idim::runtime::model::IdentificationModel;
use idim::runtime::settings::Edges;
use idim::runtime::signal::{ZeroPhase, butterworth};
use idim::runtime::simulate::{
    ClosedLoop, Grid, Method, Options, State, Trajectory, controlled, inverse_dynamics,
};

use super::hidden::{Effect, Hidden};
use super::machine::{Failure, Machine};
use super::motion::{RATE_HZ, samples};
use super::random::Random;
use super::robots::Rating;

/// Noise of a robot's logs.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Resolution of the encoders, rad or m.
    pub resolution: f64,
    /// White noise of the logged torque, N m or N, by joint.
    pub white: Vec<f64>,
    /// Slow torque from outside: standard deviation, N m or N, and time constant, s.
    pub slow: Vec<(f64, f64)>,
}

impl Noise {
    /// Of robots with these ratings.
    pub fn draw(ratings: &[Rating], random: &mut Random) -> Noise {
        let mut of = |low: f64, high: f64| -> Vec<f64> {
            let levels = ratings.iter();
            levels
                .map(|rating| rating.scale * random.ratio(low, high))
                .collect()
        };
        let (white, slow) = (of(0.006, 0.015), of(0.002, 0.005));
        Noise {
            white,
            slow: slow
                .into_iter()
                .map(|level| (level, random.ratio(0.03, 0.3)))
                .collect(),
            resolution: random.ratio(2e-6, 5e-5),
        }
    }
}

/// A log and what only the simulator knows.
pub struct Simulated {
    /// The commanded motion.
    pub reference: Fourier,
    /// Encoder readings, joint by joint.
    pub q: Vec<Vec<f64>>,
    /// Logged torques.
    pub tau: Vec<Vec<f64>>,
    /// True positions of all joints of the machine's model, hidden ones too.
    pub truth: Vec<Vec<f64>>,
    /// What of the logged torques is noise.
    pub noise: Vec<Vec<f64>>,
    /// Torques that the drives deliver, with the log's noise, and the standard deviation of what of
    /// the commands is above 20 Hz.
    pub delivered: Vec<Vec<f64>>,
    pub chatter: Vec<f64>,
}

/// PD control with rigid feedforward for the described robot.
pub fn controller(ratings: &[Rating], random: &mut Random) -> Controller {
    let rounded = |x: f64| (x * 1e3).round() * 1e-3;
    // Large drives are tuned to be stiffer, for what they are built for, than those of a wrist.
    let stiff = |rating: &Rating| if rating.scale > 30.0 { 1.0 } else { 0.55 };
    let kp: Vec<f64> = ratings
        .iter()
        .map(|rating| rounded(rating.scale * stiff(rating) * random.uniform(40.0, 60.0)))
        .collect();
    let per_damping = random.uniform(18.0, 22.0);
    Controller {
        law: Law::Pd,
        kd: kp.iter().map(|kp| rounded(kp / per_damping)).collect(),
        kp,
        feedforward: Feedforward::Rigid,
        velocity_filter_hz: Some(80.0),
        torque_limit: Some(ratings.iter().map(|rating| 4.0 * rating.scale).collect()),
        start: Start::Reference,
    }
}

/// Runs a machine with effects along a motion under the controller of the nominal one.
pub fn simulate(
    (machine, effects): (&Machine, &[Effect]),
    nominal: &Machine,
    (reference, controller): (&Fourier, &Controller),
    noise: &Noise,
    random: &mut Random,
) -> Result<Simulated, Failure> {
    let len = samples(reference);
    let grid = Grid {
        rate_hz: RATE_HZ,
        start: 0.0,
        len,
    };
    let mut disturbance = vec![Vec::new(); machine.model.joints().len()];
    for (&joint, &(level, time)) in machine.driven.iter().zip(&noise.slow) {
        disturbance[joint] = slow(len, level, time, random);
    }
    let plant = machine.plant(effects, noise.resolution, &disturbance)?;
    let fourier = Reference::Fourier(reference.clone());
    let plan = ClosedLoop {
        reference: &fourier,
        controller,
        rigid: &nominal.rigid,
        grid,
        start: Some(&beginning(machine, nominal, &fourier, (effects, &grid))?),
    };
    let options = Options {
        method: Method::Fixed {
            step_s: step(effects),
        },
        ..Options::default()
    };
    let run = controlled(plant, &nominal.model, &plan, &options)?;
    let chatter = chatter(&run.tau)?;
    let mut tau = run.tau;
    for effect in effects {
        if let Hidden::Late { by } = effect.hidden {
            tau = tau
                .iter()
                .map(|series| late(series, by * RATE_HZ))
                .collect();
        }
    }
    let (mut noise_of, mut delivered) = (Vec::new(), Vec::new());
    for (place, &joint) in machine.driven.iter().enumerate() {
        let white: Vec<f64> = (0..len)
            .map(|_| noise.white[place] * random.normal())
            .collect();
        for (value, white) in tau[place].iter_mut().zip(&white) {
            *value = round(*value + white, 1e-5);
        }
        let both = white.iter().zip(&disturbance[joint]);
        let applied = run.motion.tau[joint].iter().zip(&white);
        delivered.push(applied.map(|(tau, white)| tau + white).collect());
        noise_of.push(both.map(|(white, slow)| white - slow).collect());
    }
    Ok(Simulated {
        reference: reference.clone(),
        q: run
            .q
            .iter()
            .map(|q| q.iter().map(|q| round(*q, 1e-8)).collect())
            .collect(),
        tau,
        truth: run.motion.q,
        noise: noise_of,
        delivered,
        chatter,
    })
}

/// How far commands jump about their mean.
fn chatter(tau: &[Vec<f64>]) -> Result<Vec<f64>, Failure> {
    let low_pass = ZeroPhase::new(butterworth(4, 20.0, RATE_HZ)?, 4, Edges::Scipy);
    let smooth = low_pass.filter(tau)?;
    let of_joint = |(tau, smooth): (&Vec<f64>, &Vec<f64>)| {
        let squares = tau.iter().zip(smooth).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / tau.len() as f64).sqrt()
    };
    Ok(tau.iter().zip(&smooth).map(of_joint).collect())
}

fn round(x: f64, step: f64) -> f64 {
    (x / step).round() * step
}

/// Gears against stops need shorter steps.
fn step(effects: &[Effect]) -> f64 {
    let stops = |effect: &Effect| matches!(effect.hidden, Hidden::Backlash { .. });
    if effects.iter().any(stops) {
        2.5e-4
    } else {
        1e-3
    }
}

/// On the reference; behind a gear that yields, where the load pulls the link to.
fn beginning(
    machine: &Machine,
    nominal: &Machine,
    reference: &Reference,
    (effects, grid): (&[Effect], &Grid),
) -> Result<State, Failure> {
    let first = Grid { len: 8, ..*grid };
    let trajectory = Trajectory::of(reference, &first)?;
    let load = inverse_dynamics(&nominal.model, &nominal.rigid, &trajectory)?;
    let joints = machine.model.joints().len();
    let mut start = State {
        q: vec![0.0; joints],
        qd: vec![0.0; joints],
    };
    for (place, &joint) in machine.driven.iter().enumerate() {
        start.q[joint] = trajectory.q[place][0];
        start.qd[joint] = trajectory.qd[place][0];
    }
    for effect in effects {
        let (joint, bend) = match effect.hidden {
            Hidden::Elastic {
                joint, stiffness, ..
            } => (joint, load[joint][0] / stiffness),
            Hidden::Backlash {
                joint,
                gap,
                stiffness,
                ..
            } => {
                let load = load[joint][0];
                (joint, load / stiffness + 0.5 * gap * load.signum())
            }
            _ => continue,
        };
        let at = machine.driven[joint];
        start.q[at + 1] = -bend;
    }
    Ok(start)
}

/// First-order coloured noise.
fn slow(len: usize, level: f64, time: f64, random: &mut Random) -> Vec<f64> {
    let keep = (-1.0 / (time * RATE_HZ)).exp();
    let drive = level * (1.0 - keep * keep).sqrt();
    let mut now = level * random.normal();
    (0..len)
        .map(|_| {
            now = keep * now + drive * random.normal();
            now
        })
        .collect()
}

/// A series so many samples later, linear in between.
pub fn late(series: &[f64], by: f64) -> Vec<f64> {
    let value = |k: usize| {
        let at = (k as f64 - by).clamp(0.0, (series.len() - 1) as f64);
        let (low, part) = (at as usize, at.fract());
        let high = (low + 1).min(series.len() - 1);
        series[low] + part * (series[high] - series[low])
    };
    (0..series.len()).map(value).collect()
}

/// The companion of a log.
pub fn companion(reference: &Fourier, controller: &Controller, noise: &Noise) -> String {
    let mut text = format!(
        "rate_hz = {RATE_HZ:.0}\nencoder_resolution = {:.9e}\n\n[reference]\nkind = \
         \"fourier\"\nf0_hz = {:?}\nperiods = {}\ncenter = {:?}\n",
        noise.resolution, reference.f0_hz, reference.periods, reference.center
    );
    for (name, rows) in [("sin", &reference.sin), ("cos", &reference.cos)] {
        let _ = writeln!(text, "{name} = [");
        for row in rows {
            let row: Vec<String> = row.iter().map(|x| format!("{x:.6}")).collect();
            let _ = writeln!(text, "  [{}],", row.join(", "));
        }
        text += "]\n";
    }
    let _ = write!(
        text,
        "\n[controller]\nlaw = \"pd\"\nkp = {:?}\nkd = {:?}\nfeedforward = \
         \"rigid\"\nvelocity_filter_hz = {:?}\ntorque_limit = {:?}\nstart = \"reference\"\n",
        controller.kp,
        controller.kd,
        controller.velocity_filter_hz.unwrap_or(80.0),
        controller.torque_limit.as_deref().unwrap_or(&[]),
    );
    text
}
