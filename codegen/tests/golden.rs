//! The generated code of small robots, read line by line before it is accepted.

use std::path::PathBuf;

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
fn emission_of_the_same_robot_gives_the_same_bytes() {
    assert_eq!(robot("robots/puma560.toml"), robot("robots/puma560.toml"));
}
