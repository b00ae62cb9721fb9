//! Cases drawn from a seed.

use super::machine::Failure;
use super::propose::NAMES;
use super::random::Random;
use super::scene::Scene;
use super::truth::{Case, Category};

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
