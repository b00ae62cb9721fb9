//! `docs/whole-way.md` as it stands: its files are written, its commands run, and what it promises
//! of them is looked at.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::fs;
use std::path::Path;
use std::process::Command;

use idim::codegen::builder;
use serde_json::Value;

/// A fenced block of the page: what stands behind its fence, and its lines.
fn blocks(page: &str) -> Vec<(String, Vec<&str>)> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, Vec<&str>)> = None;
    for line in page.lines() {
        match (line.strip_prefix("```"), open.as_mut()) {
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(info), None) => open = Some((info.to_owned(), Vec::new())),
            (None, Some((_, lines))) => lines.push(line),
            (None, None) => {}
        }
    }
    blocks
}

/// Runs a command line of the page in a folder; what it prints.
fn run(folder: &Path, line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words[0], "idim");
    let output = Command::new(env!("CARGO_BIN_EXE_idim"))
        .args(&words[1..])
        .current_dir(folder)
        .output()
        .unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}: {complaint}");
    String::from_utf8(output.stdout).unwrap()
}

fn explicit(folder: &Path, file: &str) -> Value {
    let json: Value =
        serde_json::from_str(&fs::read_to_string(folder.join(file)).unwrap()).unwrap();
    json["models"][0].clone()
}

fn error(model: &Value) -> f64 {
    model["validation"][0]["fit"]["total_pct"]
        .as_f64()
        .or_else(|| model["validation"][0]["total_pct"].as_f64())
        .unwrap()
}

#[test]
fn every_file_and_command_of_the_page_does_what_it_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/whole-way.md")).unwrap();
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let mut said = Vec::new();
    for (info, lines) in blocks(&page) {
        let text = lines.join("\n") + "\n";
        if let Some(names) = info.strip_prefix("toml >> ") {
            for name in names.split_whitespace() {
                let before = fs::read_to_string(folder.join(name)).unwrap();
                fs::write(folder.join(name), format!("{before}\n{text}")).unwrap();
            }
        } else if let Some(name) = info.strip_prefix("toml ") {
            fs::write(folder.join(name), text).unwrap();
        } else {
            let commands = lines.iter().filter_map(|line| line.strip_prefix("$ "));
            commands.for_each(|line| said.push((line, run(folder, line))));
        }
    }
    assert_eq!(said.len(), 10, "commands of the page");
    let diagnosed = said
        .iter()
        .find(|(line, _)| line.starts_with("idim diagnose"));
    let diagnosed = &diagnosed.unwrap().1;
    assert!(diagnosed.contains("one effect is missing"), "{diagnosed}");
    assert!(
        diagnosed.contains("stribeck on joint 1 (shoulder)"),
        "{diagnosed}"
    );
    let (found, better) = (
        explicit(folder, "found.json"),
        explicit(folder, "better.json"),
    );
    // What is left are rests at reversals and ends, where friction is any torque below its limit.
    assert!(error(&better) < error(&found));
    // As the robot has them.
    for (name, truth) in [
        ("ZZR1", 3.5),
        ("MXR1", 6.0),
        ("ZZ2", 0.4),
        ("MX2", 1.2),
        ("FV1", 4.0),
    ] {
        let parameters = better["parameters"].as_array().unwrap().iter();
        let mut named = parameters.filter(|p| p["name"] == name);
        let value = named.next().unwrap()["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.03, "{name}: {value}");
    }
    // The diagnosis, which weighs rows near rest by what they can tell, has the friction itself.
    let written = builder::read(&folder.join("better.toml")).unwrap().robot;
    let parameters = &written.description.parameters;
    let (_, friction) = parameters.iter().find(|(name, _)| name == "FST1").unwrap();
    assert!((friction / 2.5 - 1.0).abs() < 0.01, "FST1: {friction}");
    let arm = builder::read(&folder.join("arm.urdf")).unwrap().robot;
    assert_eq!(arm.mechanism.joints.len(), 2);
    let replayed = &said.last().unwrap().1;
    assert!(replayed.contains("rms distance from log"), "{replayed}");
}
