//! Operation counts of the generated models beside those of the references.
//!
//! `cargo run -p idim-codegen --example operation_counts`
//!
//! Counted in the emitted code: a product of k factors is k-1 multiplications, a square one, a
//! factor -1 none, a sum of k terms k-1 additions; sines and cosines are not listed. The models are
//! D, P with R, and h on the inertial base columns.

#![allow(clippy::unwrap_used, reason = "an example fails by panicking")]

#[path = "../tests/robots/mod.rs"]
mod robots;

use std::collections::BTreeMap;
use std::time::Instant;

use idim_codegen::emit;
use idim_codegen::robot::Robot;
use robots::{description, gravity, reference};

fn main() {
    let Some(geometry) = reference("mdh_geometry.json") else {
        return;
    };
    let references = references();
    println!("multiplications/additions; `-`: not in the references\n");
    println!(
        "{:<15} {:<10} {:>9} {:>9} {:>9} {:>12} {:>12}",
        "robot", "model", "ours", "prototype", "searched", "OpenSYMORO", "SymPyBotics"
    );
    for (name, source) in geometry["robots"].as_object().unwrap() {
        let serial = references
            .keys()
            .any(|key| key.0 == *name && key.1 == "prototype");
        if !serial {
            continue;
        }
        let start = Instant::now();
        let robot = Robot::new(description(name, source, gravity(source), &[])).unwrap();
        let took = start.elapsed();
        let code = emit::rust(&robot).unwrap();
        for (model, function, prototype) in [
            ("D", "explicit", "D"),
            ("P and R", "implicit", "PR"),
            ("h", "energy", "h"),
        ] {
            let (mul, add) = operations(&code, function);
            let of = |tool: &str, model: &str, variant: &str| {
                let key = (
                    name.clone(),
                    tool.to_owned(),
                    model.to_owned(),
                    variant.to_owned(),
                );
                references.get(&key).map_or("-", String::as_str).to_owned()
            };
            let searched = if prototype == "PR" {
                "P_and_R"
            } else {
                prototype
            };
            let (symoro, sympybotics) = match model {
                "D" => ("dyn_ident_base", "regressor_base"),
                _ => ("none", "none"),
            };
            println!(
                "{name:<15} {model:<10} {:>9} {:>9} {:>9} {:>12} {:>12}",
                format!("{mul}/{add}"),
                of("prototype", prototype, "base columns"),
                of("prototype", searched, "searched"),
                of("OpenSYMORO", symoro, "dce"),
                of("SymPyBotics", sympybotics, "generated"),
            );
        }
        println!("{:<15} derived in {:.0} ms\n", "", 1e3 * took.as_secs_f64());
    }
}

/// Binary operators in the body of a function of the emitted module; `.times(` is one of them.
fn operations(code: &str, function: &str) -> (usize, usize) {
    let head = format!("pub fn {function}<");
    let body = code.split_once(&head).map_or("", |(_, rest)| rest);
    let body = body.split_once("\n}").map_or("", |(body, _)| body);
    let statements = body.split_once('{').map_or("", |(_, rest)| rest);
    let lines = statements
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let text: String = lines.collect::<Vec<_>>().join(" ");
    let words = || text.split_whitespace();
    let count = |operator: &str| words().filter(|&word| word == operator).count();
    let fused = text.matches(".times(").count();
    (count("*") + fused, count("+") + count("-"))
}

type Key = (String, String, String, String);

/// Counts by robot, tool, model and variant.
fn references() -> BTreeMap<Key, String> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../shared/reference/generators/op_counts.csv"
    );
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let rows = text.lines().skip(1).filter_map(|line| {
        // The variant may hold a comma; the last five cells are numbers.
        let (head, numbers) = (line.splitn(4, ','), line.rsplitn(6, ','));
        let [robot, tool, model, rest] = head.collect::<Vec<_>>().try_into().ok()?;
        let [_, _, _, add, mul, _] = numbers.collect::<Vec<_>>().try_into().ok()?;
        let variant = match rest.contains("search") {
            true => "searched",
            false => rest.split(',').next().unwrap_or_default(),
        };
        let key = [robot, tool, model, variant].map(str::to_owned);
        Some((key.into(), format!("{mul}/{add}")))
    });
    rows.collect()
}
