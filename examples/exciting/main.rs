//! Condition numbers that the search for exciting motions reaches, beside published ones: the same
//! robot, parameters, time and number of harmonics, and limits that are those of the published
//! motion.
//!
//! `cargo run --release --example exciting [STARTS [STEPS]]`

mod cases;

use std::error::Error;
use std::time::Instant;

use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::runtime::excite::{Task, excite};
use idim::runtime::model::IdentificationModel;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let starts = arguments.next().transpose()?.unwrap_or(16);
    let steps = arguments.next().transpose()?.unwrap_or(400);
    for case in cases::all() {
        let (file, text) = &case.robot;
        let model = Interpreter::new(&builder::read_texts(&[(file, text)])?);
        let task = Task {
            model: &model,
            limits: &case.limits,
            center: case.center.as_deref(),
            parameters: None,
        };
        let settings = case.settings(starts, steps);
        let clock = Instant::now();
        let found = excite(&task, &settings, &|| ())?;
        let chance = found.by_chance;
        println!("{} ({} columns)", case.name, model.columns().len());
        let own = case.condition.map(|it| format!("; {it} on idim's columns"));
        println!("  published {}{}", case.published, own.unwrap_or_default());
        println!(
            "  found {:.2} in {:.1} s; by chance best {:.1}, median {:.1} of {}",
            found.condition,
            clock.elapsed().as_secs_f64(),
            chance.best.unwrap_or(f64::NAN),
            chance.median.unwrap_or(f64::NAN),
            chance.motions
        );
    }
    Ok(())
}
