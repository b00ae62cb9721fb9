//! The generated code of small robots, read line by line before it is accepted.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::PathBuf;

use idim_codegen::expr::Operations;
use idim_codegen::{builder, emit};

fn robot(file: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(file);
    let source = builder::read(&path).unwrap();
    emit::rust(&source.robot).unwrap()
}

#[test]
fn scara_module_reads_like_the_paper() {
    insta::assert_snapshot!(robot("robots/scara.toml"));
}

#[test]
fn emps_module_is_one_axis() {
    insta::assert_snapshot!(robot("robots/emps.toml"));
}

#[test]
fn arm_of_a_urdf_has_a_module_to_be_read() {
    insta::assert_snapshot!(robot("examples/controller/robots/arm.urdf"));
}

#[test]
fn scara_header_tells_a_c_programmer_everything() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots/scara.toml");
    let [header, _] = emit::c(&builder::read(&path).unwrap().robot);
    insta::assert_snapshot!(header.text);
}

#[test]
fn scara_source_in_c_reads_like_the_paper() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots/scara.toml");
    let [_, source] = emit::c(&builder::read(&path).unwrap().robot);
    insta::assert_snapshot!(source.text);
}

#[test]
fn scara_python_module_reads_like_the_paper() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots/scara.toml");
    insta::assert_snapshot!(emit::python(&builder::read(&path).unwrap().robot).text);
}

/// A worse kernel is a red test: multiplications/additions/sines and cosines of the inertial
/// columns, and the number of parameters.
#[test]
fn operation_counts_of_the_built_in_robots_do_not_grow_unseen() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let listing = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = listing.map(|item| item.unwrap().path()).collect();
    paths.sort();
    let mut table = String::new();
    for path in paths {
        let robot = builder::read(&path).unwrap().robot;
        let counts = robot.counts();
        let text = |c: Operations| format!("{}/{}/{}", c.mul, c.add, c.trig);
        table.push_str(&format!(
            "{:<8} {:>2} parameters, D {}, P+R {}, h {}\n",
            robot.mechanism.name,
            robot.base.parameters.len(),
            text(counts.explicit),
            text(counts.implicit),
            text(counts.energy)
        ));
    }
    insta::assert_snapshot!(table);
}

#[test]
fn emission_of_the_same_robot_gives_the_same_bytes() {
    assert_eq!(robot("robots/puma560.toml"), robot("robots/puma560.toml"));
}
