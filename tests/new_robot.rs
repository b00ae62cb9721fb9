//! A new robot: its URDF is dropped into `robots/` of a copy of the project, and a rebuild is all
//! it takes.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// A URDF as it comes: names that are no identifiers, axes that are not z, a fixed flange, a
/// link without inertial, rpy with few digits.
const URDF: &str = r#"<?xml version="1.0"?>
<robot name="Lab-Arm 4">
  <link name="world"/>
  <link name="column"><inertial><origin xyz="0 0 0.2"/><mass value="6.5"/>
    <inertia ixx="0.09" ixy="0" ixz="0" iyy="0.09" iyz="0" izz="0.02"/></inertial></link>
  <link name="boom"><inertial><origin xyz="0.3 0 0"/><mass value="4.0"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.13" iyz="0" izz="0.13"/></inertial></link>
  <link name="fore arm"><inertial><origin xyz="0.2 0.01 0"/><mass value="2.1"/>
    <inertia ixx="0.004" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.04"/></inertial></link>
  <link name="quill"/>
  <link name="flange"><inertial><origin xyz="0 0 -0.05"/><mass value="0.4"/>
    <inertia ixx="0.0004" ixy="0" ixz="0" iyy="0.0004" iyz="0" izz="0.0002"/></inertial></link>
  <joint name="turn table" type="continuous">
    <parent link="world"/><child link="column"/><origin xyz="0 0 0.4"/><axis xyz="0 0 1"/></joint>
  <joint name="luff" type="revolute">
    <parent link="column"/><child link="boom"/><origin xyz="0.05 0 0.3" rpy="1.5708 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1.5" effort="200" velocity="2"/></joint>
  <joint name="elbow" type="revolute">
    <parent link="boom"/><child link="fore arm"/><origin xyz="0.6 0 0"/>
    <axis xyz="0 0 -1"/><limit lower="-2" upper="2" effort="100" velocity="3"/></joint>
  <joint name="plunge" type="prismatic">
    <parent link="fore arm"/><child link="quill"/><origin xyz="0.4 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.2" effort="50" velocity="0.5"/></joint>
  <joint name="mount" type="fixed">
    <parent link="quill"/><child link="flange"/><origin xyz="0.05 0 0" rpy="0 1.57 0"/></joint>
</robot>
"#;

fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        std::fs::create_dir_all(to).unwrap();
        for item in std::fs::read_dir(from).unwrap() {
            let item = item.unwrap();
            copy(&item.path(), &to.join(item.file_name()));
        }
    } else {
        std::fs::copy(from, to).unwrap();
    }
}

#[test]
fn urdf_dropped_into_robots_becomes_a_built_in_robot() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    for part in [
        "Cargo.lock",
        "build.rs",
        "src",
        "codegen",
        "lanes",
        "runtime",
        "robots",
        "benches",
        "examples",
    ] {
        copy(&project.join(part), &folder.path().join(part));
    }
    // Another name for the program: the copy shares the target folder, so that its dependencies
    // need not be built again, and must not replace the program under test.
    let manifest = std::fs::read_to_string(project.join("Cargo.toml")).unwrap();
    let manifest = manifest.replace("name = \"idim\"\npath = \"src/main.rs\"", COPY);
    assert!(manifest.contains(COPY));
    // And another version, as good as its own: a package of the same name, version and place in its workspace would
    // replace that of the program under test.
    let own = format!("\nversion = \"{}\"", env!("CARGO_PKG_VERSION"));
    assert_eq!(manifest.matches(&own).count(), 1);
    let [major, minor] = [
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR"),
    ];
    let manifest = manifest.replace(&own, &format!("\nversion = \"{major}.{minor}.999\""));
    std::fs::write(folder.path().join("Cargo.toml"), manifest).unwrap();
    std::fs::write(folder.path().join("robots/lab_arm.urdf"), URDF).unwrap();

    let program = build(folder.path());
    let described = run(&program, &["describe", "lab_arm_4", "--json", "-"]);
    let json: Value = serde_json::from_str(&described).unwrap();
    assert_eq!(json["joints"].as_array().unwrap().len(), 4);
    assert_eq!(json["joints"][3]["kind"], "prismatic");
    let parameters = json["base_parameters"].as_array().unwrap();
    let count = |kind: &str| parameters.iter().filter(|p| p["kind"] == kind).count();
    // Viscous, Coulomb, offset for each joint.
    assert_eq!(count("friction"), 12);
    assert!(count("inertial") > 10);
    let code = run(&program, &["generate", "lab_arm_4"]);
    assert!(code.contains("pub fn explicit<T: Lane>"));
}

const COPY: &str = "name = \"idim-with-a-new-robot\"\npath = \"src/main.rs\"";

fn build(project: &Path) -> PathBuf {
    let debug = Path::new(env!("CARGO_BIN_EXE_idim")).parent().unwrap();
    let profile = debug.file_name().unwrap().to_str().unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([
        "build",
        "--quiet",
        "--offline",
        "--bin",
        "idim-with-a-new-robot",
    ]);
    if profile == "release" {
        cargo.arg("--release");
    }
    let status = cargo
        .current_dir(project)
        .env("CARGO_TARGET_DIR", debug.parent().unwrap())
        .status();
    assert!(status.unwrap().success());
    debug.join("idim-with-a-new-robot")
}

fn run(program: &Path, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}
