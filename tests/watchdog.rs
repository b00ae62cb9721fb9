//! The watchdog: silent over coloured noise, awake when the robot changes.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[path = "online/moving.rs"]
mod moving;

use idim::robots;
use idim::runtime::model::IdentificationModel;
use idim::runtime::online::{
    Deviation, OnlineError, Options, Step, Stream, WatchOptions, Watchdog,
};
use moving::{Moving, Noise, normal};
use rand_pcg::Pcg64Mcg;

const RATE_HZ: f64 = 200.0;

/// A tenth of the coloured noise's standard deviation is a friction of 1 %.
const NOISE: f64 = 0.05;

/// The SCARA at 200 Hz with torque noise that remembers 0.1 s, its stream and its watchdog.
struct Watched<'m> {
    moving: Moving<'m>,
    stream: Stream<robots::scara::Model>,
    watchdog: Watchdog,
    random: Pcg64Mcg,
    colour: [f64; 2],
    size: f64,
}

impl Watched<'_> {
    fn new(seed: u128) -> Self {
        let model = &robots::scara::Model;
        let options = Options {
            fq_hz: 40.0,
            fp_hz: 16.0,
            nd: 5,
            ..Options::at(RATE_HZ)
        };
        let moving = Moving::new(model, RATE_HZ, Noise::NONE);
        let stream = Stream::new(robots::scara::Model, &options).unwrap();
        let watchdog = Watchdog::new(&stream, &moving.truth, &WatchOptions::default()).unwrap();
        Watched {
            moving,
            stream,
            watchdog,
            random: Pcg64Mcg::new(seed),
            colour: [0.0; 2],
            size: NOISE,
        }
    }

    /// Runs one block's time and checks.
    fn block(&mut self) {
        for _ in 0..(10.0 * RATE_HZ) as usize {
            let (q, tau) = self.moving.sample();
            let mut tau = [tau[0], tau[1]];
            for (tau, colour) in tau.iter_mut().zip(&mut self.colour) {
                // exp(-1 / (0.1 s * 200 Hz)), of variance one.
                *colour = 0.951 * *colour + 0.309 * normal(&mut self.random);
                *tau += self.size * *colour;
            }
            if let Step::Equations(instant) = self.stream.push(q, None, &tau).unwrap() {
                self.watchdog.update(instant);
            }
        }
        self.watchdog.check();
    }

    fn learn(&mut self) {
        for blocks in 1.. {
            self.block();
            if self.watchdog.check().iter().all(|health| health.learned) {
                assert!((12..15).contains(&blocks), "{blocks}");
                break;
            }
        }
    }

    fn place(&self, name: &str) -> usize {
        let columns = robots::scara::Model.columns();
        columns.iter().position(|c| c.name == name).unwrap()
    }
}

#[test]
fn two_hundred_windows_of_coloured_noise_raise_no_alarm() {
    let mut watched = Watched::new(3);
    watched.learn();
    for health in watched.watchdog.check() {
        assert!(health.from_stored.abs() < 4.0, "{health:?}");
    }
    let (mut most, mut above) = (0.0f64, 0);
    for _ in 0..200 {
        watched.block();
        for health in watched.watchdog.check() {
            let sigma = health.parameters.max(health.residuals);
            most = most.max(sigma);
            above += usize::from(sigma > 3.0);
        }
    }
    println!("largest of 200 windows of two joints: {most:.2} sigma, {above} above 3");
    assert_eq!(watched.watchdog.worst(), None);
    // Of the largest of twelve related numbers, one in a hundred may be above 3.
    assert!(above <= 20, "{above}");
}

#[test]
fn a_friction_change_of_a_fifth_is_noticed_within_two_blocks() {
    for (seed, name, joint) in [(5, "FS2", 1), (6, "FS1", 0), (7, "FV2", 1)] {
        let mut watched = Watched::new(seed);
        watched.learn();
        (0..5).for_each(|_| watched.block());
        assert_eq!(watched.watchdog.worst(), None, "{name}");
        let changed = watched.stream.samples();
        let place = watched.place(name);
        watched.moving.truth[place] *= 1.2;
        watched.block();
        watched.block();
        let (worst, alarm) = watched.watchdog.worst().unwrap();
        println!("{name}: {alarm:?}, changed at {changed}");
        assert_eq!(worst, joint, "{name}");
        assert_eq!(alarm.deviation, Deviation::Parameters);
        assert!(
            watched.watchdog.check()[1 - joint].alarm.is_none(),
            "{name}"
        );
        // To a block of 10 s, of which the filters' delay is a small part.
        let apart = alarm.since as f64 - changed as f64;
        assert!(apart.abs() <= 11.0 * RATE_HZ, "{name}: {apart}");
        watched.moving.truth[place] /= 1.2;
        (0..7).for_each(|_| watched.block());
        watched.watchdog.acknowledge();
        watched.block();
        assert_eq!(watched.watchdog.worst(), None, "{name} is as before");
    }
}

#[test]
fn a_payload_shows_in_both_joints_and_trouble_without_a_name_as_residuals() {
    let mut watched = Watched::new(9);
    watched.learn();
    let place = watched.place("ZZ2");
    watched.moving.truth[place] *= 1.1;
    (0..2).for_each(|_| watched.block());
    let health = watched.watchdog.check().to_vec();
    assert!(
        health.iter().all(|health| health.alarm.is_some()),
        "{health:?}"
    );

    let mut watched = Watched::new(10);
    watched.learn();
    watched.size = 1.5 * NOISE;
    (0..2).for_each(|_| watched.block());
    for health in watched.watchdog.check() {
        assert_eq!(health.alarm.unwrap().deviation, Deviation::Residuals);
    }
}

#[test]
fn wrong_stored_parameters_show_when_learning_ends() {
    let mut watched = Watched::new(11);
    let mut stored = watched.moving.truth.clone();
    stored[watched.place("FS2")] *= 0.9;
    watched.watchdog = Watchdog::new(&watched.stream, &stored, &WatchOptions::default()).unwrap();
    watched.learn();
    let health = watched.watchdog.check();
    assert!(
        health[0].from_stored < 4.0 && health[1].from_stored > 6.0,
        "{health:?}"
    );
}

#[test]
fn what_cannot_be_watched_says_so() {
    let stream = Stream::new(robots::scara::Model, &Options::at(1000.0)).unwrap();
    let usual = WatchOptions::default();
    let set_up = |parameters: &[f64], options: WatchOptions| {
        Watchdog::new(&stream, parameters, &options).map(|_| ())
    };
    assert_eq!(
        set_up(&[1.0; 3], usual.clone()),
        Err(OnlineError::Parameters { has: 3, needs: 8 })
    );
    let mut unknown = [1.0; 8];
    unknown[2] = f64::NAN;
    assert!(matches!(
        set_up(&unknown, usual.clone()),
        Err(OnlineError::NotFinite { .. })
    ));
    let with = |change: fn(&mut WatchOptions)| {
        let mut options = usual.clone();
        change(&mut options);
        set_up(&[1.0; 8], options)
    };
    assert!(matches!(
        with(|o| o.block_s = 0.1),
        Err(OnlineError::Block { rows: 4, .. })
    ));
    assert!(matches!(
        with(|o| o.block_s = f64::NAN),
        Err(OnlineError::Block { .. })
    ));
    assert!(matches!(
        with(|o| o.reference = 1),
        Err(OnlineError::Blocks { blocks: 1, .. })
    ));
    assert!(matches!(
        with(|o| o.window = 0),
        Err(OnlineError::Blocks { .. })
    ));
    assert_eq!(
        with(|o| o.sigma = 0.0),
        Err(OnlineError::Level { sigma: 0.0 })
    );
}
