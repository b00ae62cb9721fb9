//! From a description to code, as a build script goes: a 7R arm and a humanoid of thirty joints.
//!
//! `cargo bench -p idim-codegen --bench generate`

#![allow(clippy::unwrap_used, reason = "a benchmark fails by panicking")]

use std::path::Path;

use idim_codegen::describe::{self, Description};
use idim_codegen::expr::Graph;
use idim_codegen::mechanism::Mechanism;
use idim_codegen::{Robot, base, builder, derive, emit};

#[path = "../tests/robots/humanoid.rs"]
mod humanoid;

fn main() {
    divan::main();
}

/// File name and text of the robots by name.
fn text(name: &str) -> (String, String) {
    if name == "humanoid" {
        return ("humanoid.urdf".to_owned(), humanoid::urdf());
    }
    let file = format!("{name}.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let text = std::fs::read_to_string(path.join(&file)).unwrap();
    (file, text)
}

fn description(name: &str) -> Description {
    let (file, text) = text(name);
    let kind = describe::kind_of(Path::new(&file), &text).unwrap();
    describe::read_text(&text, &file, kind, &|_| Err("not there".into())).unwrap()
}

const ROBOTS: [&str; 2] = ["panda", "humanoid"];

/// Everything: text in, Rust out.
#[divan::bench(args = ROBOTS, max_time = 5)]
fn description_to_rust(bencher: divan::Bencher<'_, '_>, name: &str) {
    let (file, text) = text(name);
    bencher.bench(|| {
        let robot = builder::read_texts(&[(&file, &text)]).unwrap();
        emit::rust(&robot).unwrap()
    });
}

/// The expressions of all standard parameters alone.
#[divan::bench(args = ROBOTS, max_time = 5)]
fn standard_model(bencher: divan::Bencher<'_, '_>, name: &str) {
    let mechanism = Mechanism::new(&description(name));
    bencher.bench(|| derive::standard(&mut Graph::new(), &mechanism));
}

/// The base parameters alone.
#[divan::bench(args = ROBOTS, max_time = 5)]
fn base_parameters(bencher: divan::Bencher<'_, '_>, name: &str) {
    let description = description(name);
    let mechanism = Mechanism::new(&description);
    let mut graph = Graph::new();
    let standard = derive::standard(&mut graph, &mechanism).parameters;
    bencher
        .with_inputs(|| (graph.clone(), standard.clone()))
        .bench_values(|(mut graph, standard)| {
            base::parameters(&mut graph, &mechanism, standard, &description)
        });
}

/// Base parameters and placement: everything before the text.
#[divan::bench(args = ROBOTS, max_time = 5)]
fn derivation(bencher: divan::Bencher<'_, '_>, name: &str) {
    let description = description(name);
    bencher
        .with_inputs(|| description.clone())
        .bench_values(Robot::new);
}

/// The text of Rust alone.
#[divan::bench(args = ROBOTS, max_time = 5)]
fn emission_of_rust(bencher: divan::Bencher<'_, '_>, name: &str) {
    let robot = Robot::new(description(name)).unwrap();
    bencher.bench(|| emit::rust(&robot).unwrap());
}
