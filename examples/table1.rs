//! Table 1 of Gautier 1996 over random trajectories: the largest error of any parameter that the
//! filters alone make, with the paper's recipe and with idim's own choices.
//!
//! `cargo run --release --example table1 [TRAJECTORIES]`

use std::error::Error;

use idim::study::{Errors, errors_of};

fn main() -> Result<(), Box<dyn Error>> {
    let count: u128 = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 200,
    };
    println!("largest parameter error, %, median (worst) of {count} trajectories");
    println!(
        "{:14} {:>18} {:>18} {:>18}",
        "", "explicit", "implicit", "power"
    );
    for (name, own) in [("paper's recipe", false), ("own choices", true)] {
        let all: Vec<Errors> = (0..count)
            .map(|seed| errors_of(seed, own))
            .collect::<Result<_, _>>()?;
        let column = |model: usize| {
            let mut errors: Vec<f64> = all.iter().map(|errors| errors[model]).collect();
            errors.sort_by(f64::total_cmp);
            let worst = errors.last().copied().unwrap_or(f64::NAN);
            format!("{:.3} ({worst:.3})", errors[errors.len() / 2])
        };
        println!(
            "{name:14} {:>18} {:>18} {:>18}",
            column(0),
            column(1),
            column(2)
        );
    }
    Ok(())
}
