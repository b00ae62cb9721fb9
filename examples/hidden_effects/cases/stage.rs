//! An individual with something hidden, its log, and how well it can be seen.

use super::hidden::Effect;
use super::logs::{Noise, Simulated, simulate};
use super::machine::{Failure, Machine};
use super::oracle::{Fit, Oracle, evidence, rmse};
use super::random::Random;
use super::scene::Scene;
use super::truth::{Case, Category, TrueEffect, Truth};

/// Evidence that an effect has at least, alone and in a pair; excess of the error that something
/// outside has at least.
const FAINTEST: f64 = 5.0;
const FAINTEST_OF_TWO: f64 = 9.0;
const VISIBLE: f64 = 1.7;

/// An individual with its training log.
pub struct Stage {
    pub effects: Vec<Effect>,
    /// The individual, and the described robot with the true structure.
    pub machine: Machine,
    pub truth: Machine,
    pub train: Simulated,
    /// The true structure fitted to the log.
    pub fit: Fit,
}

impl Stage {
    /// How well what is hidden can be seen, in units of the least.
    pub fn seen(&self, scene: &Scene, category: Category) -> Result<f64, Failure> {
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

    /// The case, with its validation log.
    pub fn finish(
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
