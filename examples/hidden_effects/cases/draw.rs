//! Cases drawn from a seed.

use idim::codegen::builder::read_texts;
use idim::codegen::describe::{Description, Geometry};
use idim::runtime::log::{Controller, Reference};
use idim::runtime::simulate::{Grid, Trajectory, inverse_dynamics};
use serde::{Deserialize, Serialize};

use super::hidden::{Effect, Hidden};
use super::logs::{Noise, Simulated, controller, simulate};
use super::machine::{Failure, Machine, individual};
use super::motion::{RATE_HZ, samples, training, validation};
use super::oracle::{Fit, Oracle, evidence, rmse};
use super::propose::{Host, NAMES, outside, propose};
use super::random::Random;
use super::robots::{Described, KINDS, Rating, describe};

/// What a case is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Category {
    /// One effect of the catalogue.
    One,
    /// Two of them.
    Two,
    /// Nothing hidden.
    Nothing,
    /// Something that the catalogue has not.
    Outside,
}

/// What is known of a case that no diagnosis may read.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Truth {
    /// Its name.
    pub case: String,
    /// Its kind of robot.
    pub robot: String,
    /// What it is for.
    pub category: Category,
    /// What is hidden, the strongest first.
    pub effects: Vec<TrueEffect>,
    /// Whether the training motion repeats itself.
    pub repeats: bool,
    /// Torque that each joint is built for, N m or N.
    pub scale: Vec<f64>,
    /// Standard deviations that the true structure gains on the training log.
    pub evidence: f64,
    /// RMSE on validation of the described robot refitted, of the true structure refitted, and of the
    /// noise: 20 Hz, by joint.
    pub rmse_null: Vec<f64>,
    pub rmse_oracle: Vec<f64>,
    pub rmse_floor: Vec<f64>,
    /// Position error of the true robot, simulated without noise along the validation motion, rad or
    /// m, by joint.
    pub position_best: Vec<f64>,
}

/// A hidden effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TrueEffect {
    /// Name.
    pub effect: String,
    /// Joints, from 1; empty for the whole robot.
    pub joints: Vec<usize>,
    /// Standard deviations that it gains beyond the other.
    pub evidence: f64,
    /// What it is, in full.
    pub hidden: String,
}

/// A case: what is written, and the truth.
pub struct Case {
    /// The robot's description.
    pub described: Described,
    /// Its controller and noise.
    pub controller: Controller,
    pub noise: Noise,
    /// The two logs.
    pub train: Simulated,
    pub valid: Simulated,
    /// The truth.
    pub truth: Truth,
}

/// Evidence that an effect has at least, alone and in a pair; excess of the error that something
/// outside has at least.
const FAINTEST: f64 = 5.0;
const FAINTEST_OF_TWO: f64 = 9.0;
const VISIBLE: f64 = 1.7;

/// What is seen better than this many times the least is too easy.
const MUCH: f64 = 20.0;

/// Attempts at a case; each draws another robot.
const ATTEMPTS: usize = 25;

/// Draws a case. `only` restricts what it is for: a category or the name of an effect.
pub fn draw(seed: u64, number: usize, only: Option<&str>) -> Result<Case, Failure> {
    let mut random = Random::new(seed, number as u64);
    let (category, name) = purpose(seed, number, only);
    let mut strength = match category {
        Category::One => random.ratio(0.25, 1.6),
        _ => random.ratio(0.9, 1.6),
    };
    for _ in 0..ATTEMPTS {
        let scene = Scene::new(&mut random)?;
        let Some(effects) = scene.effects(category, name, strength, &mut random) else {
            continue;
        };
        // A loop that an effect makes unstable is no log.
        let Ok(stage) = scene.stage(&effects, &mut random) else {
            continue;
        };
        let seen = stage.seen(&scene, category)?;
        if (1.0..MUCH).contains(&seen) {
            return stage.finish(scene, category, number, &mut random);
        }
        strength *= if seen < 1.0 {
            1.5
        } else {
            random.uniform(0.15, 0.9) * MUCH / seen
        };
    }
    Err(format!("case {number} of seed {seed}: no robot shows {category:?} {name}").into())
}

/// What a case is for: the shares hold in every stretch of cases, the entries take turns.
fn purpose(seed: u64, number: usize, only: Option<&str>) -> (Category, &'static str) {
    let turn = |k: usize| NAMES[(7 * k + 5 * seed as usize) % NAMES.len()];
    match only {
        Some("nothing") => return (Category::Nothing, ""),
        Some("outside") => return (Category::Outside, ""),
        Some("two") => return (Category::Two, turn(number)),
        Some("one") => return (Category::One, turn(number)),
        Some(name) => {
            let known = NAMES.iter().find(|known| **known == name);
            return (Category::One, known.copied().unwrap_or(NAMES[0]));
        }
        None => {}
    }
    let category = |number: usize| {
        let place = (number as f64 * 0.618_033_988_749_894_9 + seed as f64 * 0.377).fract();
        match place {
            p if p < 0.65 => Category::One,
            p if p < 0.73 => Category::Two,
            p if p < 0.93 => Category::Nothing,
            _ => Category::Outside,
        }
    };
    let own = category(number);
    let before = (0..number).filter(|&other| category(other) == own).count();
    (own, turn(before))
}

/// A robot with its controller and motions, nothing hidden yet.
struct Scene {
    described: Described,
    nominal: Description,
    individual: Description,
    controller: Controller,
    noise: Noise,
    repeats: bool,
    host: Host,
    motions: [idim::runtime::log::Fourier; 2],
    bare: Machine,
}

impl Scene {
    fn new(random: &mut Random) -> Result<Scene, Failure> {
        let described = describe(&KINDS[random.whole(0, KINDS.len() - 1)], random);
        let texts = [
            ("robot.toml", described.toml.as_str()),
            ("robot.urdf", &described.urdf),
        ];
        let nominal = read_texts(&texts)?.description;
        let individual = individual(&nominal, random);
        let bare = Machine::new(&nominal, &[])?;
        let repeats = random.uniform(0.0, 1.0) < 0.65;
        let motions = [
            training(&described.ratings, repeats, random),
            validation(&described.ratings, random),
        ];
        let own = Machine::new(&individual, &[])?;
        Ok(Scene {
            controller: controller(&described.ratings, random),
            noise: Noise::draw(&described.ratings, random),
            host: host_of(&individual, &own, &described.ratings, &motions[0])?,
            described,
            nominal,
            individual,
            repeats,
            motions,
            bare,
        })
    }

    fn effects(
        &self,
        category: Category,
        name: &'static str,
        strength: f64,
        random: &mut Random,
    ) -> Option<Vec<Effect>> {
        match category {
            Category::Nothing => Some(Vec::new()),
            Category::Outside => Some(vec![outside(&self.host, random)?]),
            Category::One => Some(vec![propose(name, strength, &self.host, random)?]),
            Category::Two => {
                let other = random.one_of(&NAMES);
                let all = [name, other].map(|name| propose(name, strength, &self.host, random));
                let [first, second] = all;
                let (first, second) = (first?, second?);
                (first.name != second.name && !entangled(&first, &second))
                    .then(|| vec![first, second])
            }
        }
    }

    /// The individual with effects, its training log and the true structure fitted to it.
    fn stage(&self, effects: &[Effect], random: &mut Random) -> Result<Stage, Failure> {
        let machine = Machine::new(&self.individual, effects)?;
        let truth = Machine::new(&self.nominal, effects)?;
        let train = self.log(&machine, effects, 0, random)?;
        let fit = Oracle::new(&truth, effects).fit(&train)?;
        Ok(Stage {
            effects: effects.to_vec(),
            machine,
            truth,
            train,
            fit,
        })
    }

    fn log(
        &self,
        machine: &Machine,
        effects: &[Effect],
        motion: usize,
        random: &mut Random,
    ) -> Result<Simulated, Failure> {
        let plan = (&self.motions[motion], &self.controller);
        simulate((machine, effects), &self.bare, plan, &self.noise, random)
    }
}

/// Whether two effects act on one joint through its drive, encoder or gear, where the simulator
/// has room for one.
fn entangled(first: &Effect, second: &Effect) -> bool {
    let place = |effect: &Effect| match effect.hidden {
        Hidden::Drive { joint, .. } => Some((0, joint)),
        Hidden::Elastic { joint, .. } | Hidden::Backlash { joint, .. } => Some((1, joint)),
        Hidden::Load { joint, .. } | Hidden::Drift { joint, .. } => Some((2, joint)),
        _ => None,
    };
    place(first).is_some() && place(first) == place(second)
}

/// An individual with its training log.
struct Stage {
    effects: Vec<Effect>,
    machine: Machine,
    truth: Machine,
    train: Simulated,
    fit: Fit,
}

impl Stage {
    /// How well what is hidden can be seen, in units of the least.
    fn seen(&self, scene: &Scene, category: Category) -> Result<f64, Failure> {
        let least = |all: Vec<f64>| all.into_iter().fold(f64::INFINITY, f64::min);
        Ok(match category {
            Category::Nothing => 1.0,
            Category::One => self.evidence(scene)? / FAINTEST,
            Category::Two => least(self.evidences(scene)?) / FAINTEST_OF_TWO,
            Category::Outside => {
                let null = Oracle::new(&scene.bare, &[]);
                let predicted = null.predict(&null.fit(&self.train)?, &self.train)?;
                let errors = rmse(&self.train.tau, &predicted)?;
                let zero = vec![vec![0.0; self.train.tau[0].len()]; errors.len()];
                let floor = rmse(&self.train.noise, &zero)?;
                let ratios = errors
                    .iter()
                    .zip(&floor)
                    .map(|(error, floor)| error / floor);
                ratios.fold(0.0, f64::max) / VISIBLE
            }
        })
    }

    /// Position error of the robot itself without noise; none where it cannot be simulated.
    fn position(&self, scene: &Scene, valid: &Simulated, random: &mut Random) -> Vec<f64> {
        let quiet = Noise {
            white: vec![0.0; valid.q.len()],
            slow: vec![(0.0, 1.0); valid.q.len()],
            ..scene.noise
        };
        let plan = (&scene.motions[1], &scene.controller);
        let own = (&self.machine, self.effects.as_slice());
        let Ok(again) = simulate(own, &scene.bare, plan, &quiet, random) else {
            return Vec::new();
        };
        let pairs = again.q.iter().zip(&valid.q);
        let rms = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / a.len() as f64).sqrt()
        };
        pairs.map(rms).collect()
    }

    /// Of the whole structure.
    fn evidence(&self, scene: &Scene) -> Result<f64, Failure> {
        let truth = Oracle::new(&self.truth, &self.effects);
        evidence(
            &Oracle::new(&scene.bare, &[]),
            &truth,
            &self.fit,
            &self.train,
        )
    }

    /// Of each effect beyond the others.
    fn evidences(&self, scene: &Scene) -> Result<Vec<f64>, Failure> {
        if self.effects.len() < 2 {
            return Ok(vec![self.evidence(scene)?; self.effects.len()]);
        }
        let truth = Oracle::new(&self.truth, &self.effects);
        let without = |left_out: usize| {
            let mut others = self.effects.clone();
            others.remove(left_out);
            let machine = Machine::new(&scene.nominal, &others)?;
            evidence(
                &Oracle::new(&machine, &others),
                &truth,
                &self.fit,
                &self.train,
            )
        };
        (0..self.effects.len()).map(without).collect()
    }

    fn finish(
        self,
        scene: Scene,
        category: Category,
        number: usize,
        random: &mut Random,
    ) -> Result<Case, Failure> {
        let valid = scene.log(&self.machine, &self.effects, 1, random)?;

        let (null, truth) = (
            Oracle::new(&scene.bare, &[]),
            Oracle::new(&self.truth, &self.effects),
        );
        let null_fit = null.fit(&self.train)?;
        let rmse_null = rmse(&valid.tau, &null.predict(&null_fit, &valid)?)?;
        let rmse_oracle = rmse(&valid.tau, &truth.predict(&self.fit, &valid)?)?;
        let zero = vec![vec![0.0; valid.tau[0].len()]; valid.tau.len()];
        let mut effects: Vec<TrueEffect> = self
            .effects
            .iter()
            .zip(self.evidences(&scene)?)
            .map(|(effect, evidence)| TrueEffect {
                effect: effect.name.into(),
                joints: effect.joints.iter().map(|joint| joint + 1).collect(),
                evidence,
                hidden: format!("{:?}", effect.hidden),
            })
            .collect();
        effects.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        Ok(Case {
            truth: Truth {
                case: format!("case_{number:04}"),
                robot: scene.described.kind.into(),
                category,
                effects,
                repeats: scene.repeats,
                scale: scene
                    .described
                    .ratings
                    .iter()
                    .map(|rating| rating.scale)
                    .collect(),
                evidence: self.evidence(&scene)?,
                rmse_null,
                rmse_oracle,
                rmse_floor: rmse(&valid.noise, &zero)?,
                position_best: match self.effects.is_empty() {
                    true => Vec::new(),
                    false => self.position(&scene, &valid, random),
                },
            },
            described: scene.described,
            controller: scene.controller,
            noise: scene.noise,
            train: self.train,
            valid,
        })
    }
}

/// What has to be known of an individual along its training motion.
pub fn host_of(
    description: &Description,
    machine: &Machine,
    ratings: &[Rating],
    motion: &idim::runtime::log::Fourier,
) -> Result<Host, Failure> {
    let of = |symbol: &str| -> Vec<f64> {
        (1..=ratings.len())
            .map(|number| known(description, &format!("{symbol}{number}")))
            .collect()
    };
    let rotor = of("IA");
    let centers: Vec<f64> = ratings.iter().map(|rating| rating.center).collect();
    let inertias = machine.inertias(&centers)?;
    let grid = Grid {
        rate_hz: RATE_HZ,
        start: 0.0,
        len: samples(motion),
    };
    let trajectory = Trajectory::of(&Reference::Fourier(motion.clone()), &grid)?;
    let torque = inverse_dynamics(&machine.model, &machine.values, &trajectory)?;
    let ends = |q: &Vec<f64>| {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        q.iter()
            .fold(nothing, |(low, high), q| (low.min(*q), high.max(*q)))
    };
    let (mut lengths, mut mass) = (Vec::new(), 0.0);
    if let Geometry::Urdf(tree) = &description.geometry {
        let moving = tree
            .joints
            .iter()
            .filter(|joint| joint.name.starts_with("joint"));
        let length = |at: [f64; 3]| at.iter().map(|x| x * x).sum::<f64>().sqrt();
        lengths = moving.map(|joint| length(joint.origin.xyz)).collect();
        mass = tree
            .links
            .iter()
            .filter_map(|link| link.inertial)
            .map(|body| body.mass)
            .sum();
    }
    if let Some(first) = lengths.first_mut() {
        *first = 0.0;
    }
    Ok(Host {
        ratings: ratings.to_vec(),
        coulomb: of("FS"),
        viscous: of("FV"),
        carried: inertias
            .iter()
            .zip(&rotor)
            .map(|(all, rotor)| (all - rotor).max(1e-4))
            .collect(),
        rotor,
        peak: torque
            .iter()
            .map(|tau| tau.iter().fold(0.0, |a: f64, x| a.max(x.abs())))
            .collect(),
        range: trajectory.q.iter().map(ends).collect(),
        lengths,
        mass,
    })
}

fn known(description: &Description, name: &str) -> f64 {
    let all = &description.parameters;
    all.iter()
        .find(|(other, _)| other == name)
        .map_or(0.0, |(_, value)| *value)
}
