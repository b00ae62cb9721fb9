//! A robot with its controller and motions.

use idim::codegen::builder::read_texts;
use idim::codegen::describe::Description;
use idim::runtime::log::{Controller, Fourier};

use super::hidden::{Effect, Hidden};
use super::host::{Host, host_of};
use super::kinds::KINDS;
use super::logs::{Noise, Simulated, controller, simulate};
use super::machine::{Failure, Machine, individual};
use super::motion::{training, validation};
use super::oracle::Oracle;
use super::outside::outside;
use super::propose::{NAMES, propose};
use super::random::Random;
use super::robots::{Described, describe};
use super::stage::Stage;
use super::truth::Category;

/// A robot with its controller and motions, nothing hidden yet.
pub struct Scene {
    pub described: Described,
    pub nominal: Description,
    pub individual: Description,
    pub controller: Controller,
    pub noise: Noise,
    pub repeats: bool,
    pub host: Host,
    pub motions: [Fourier; 2],
    pub bare: Machine,
}

impl Scene {
    /// Draws one.
    pub fn new(random: &mut Random) -> Result<Scene, Failure> {
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

    /// Effects of a strength, where this robot can have them.
    pub fn effects(
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
    pub fn stage(&self, effects: &[Effect], random: &mut Random) -> Result<Stage, Failure> {
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

    /// A log of a machine along the first or the second motion.
    pub fn log(
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
