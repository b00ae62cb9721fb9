//! Logs as they really come: each defect is found and named, and nothing panics.

mod columns;
mod files;
mod fuzz;
mod real;
mod spec;
mod stamps;
mod values;

use std::path::PathBuf;

use super::*;
use crate::model::{Joint, JointKind};
use crate::settings::Drives;

pub(super) fn joints() -> Vec<Joint> {
    ["shoulder", "elbow"]
        .map(|name| Joint {
            name: name.into(),
            kind: JointKind::Revolute,
        })
        .to_vec()
}

/// A log file that lives as long as the test.
pub(super) struct File {
    _dir: tempfile::TempDir,
    pub path: PathBuf,
}

pub(super) fn file(name: &str, bytes: impl AsRef<[u8]>) -> File {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    File { _dir: dir, path }
}

type Outcome = Result<(Recording, Companion), LogError>;

fn read_part(file: &File, part: &str, drives: &Drives, options: &ReadOptions) -> Outcome {
    let spec: LogSpec = format!("{}{part}", file.path.display()).parse().unwrap();
    read(&spec, &joints(), drives, options)
}

fn outcome(text: &str) -> Outcome {
    read_part(
        &file("log.csv", text),
        "",
        &Drives::default(),
        &ReadOptions::default(),
    )
}

fn good(text: &str) -> Recording {
    outcome(text).unwrap().0
}

fn message(text: &str) -> String {
    outcome(text).unwrap_err().to_string()
}

#[track_caller]
fn assert_says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "expected `{part}` in: {text}");
    }
}

/// A clean log of 200 rows at 100 Hz; `edit` changes t, q1, q2, tau1, tau2 of a row (from 1).
fn log(edit: impl Fn(usize, &mut [String; 5])) -> String {
    let mut text = String::from("t,q1,q2,tau1,tau2\n");
    for row in 1..=200 {
        let t = (row - 1) as f64 * 0.01;
        let values = [
            0.5 * (3.0 * t).sin(),
            (2.0 * t).cos(),
            7.0 * (5.0 * t).sin(),
            t - 1.0,
        ];
        let mut fields = [
            format!("{t:.3}"),
            "".into(),
            "".into(),
            "".into(),
            "".into(),
        ];
        for (field, value) in fields[1..].iter_mut().zip(values) {
            *field = format!("{value:.6}");
        }
        edit(row, &mut fields);
        text += &(fields.join(",") + "\n");
    }
    text
}

fn clean() -> String {
    log(|_, _| {})
}
