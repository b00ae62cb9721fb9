//! Reference logs, read without the readers of the crate.

use std::io::Read;
use std::path::PathBuf;

use crate::log::Recording;

/// A reference file, or `None` with a note on stderr where the reference data are absent.
pub fn reference(path: &str) -> Option<PathBuf> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared")
        .join(path);
    if !file.exists() {
        eprintln!("skipped: {} is not there", file.display());
        return None;
    }
    Some(file)
}

/// Numeric columns `q1.., tau1..` of a gzipped CSV file, on the grid of the given rate.
pub fn recording(path: &str, joints: usize, rate_hz: f64) -> Option<Recording> {
    let mut text = String::new();
    let file = std::fs::File::open(reference(path)?).unwrap();
    flate2::read::GzDecoder::new(file)
        .read_to_string(&mut text)
        .unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    let column = |name: String| -> Vec<f64> {
        let k = header.iter().position(|h| *h == name).unwrap();
        rows.iter().map(|row| row[k]).collect()
    };
    let series = |prefix: &str| {
        (1..=joints)
            .map(|j| column(format!("{prefix}{j}")))
            .collect()
    };
    Some(Recording {
        doubtful: vec![],
        name: path.to_owned(),
        stem: "log".to_owned(),
        rate_hz,
        start: 0.0,
        len: rows.len(),
        q: series("q"),
        qd: None,
        tau: Some(series("tau")),
        stamps: column("t".to_owned()),
        warnings: Vec::new(),
    })
}

/// A JSON file of the reference data.
pub fn json(path: &str) -> Option<serde_json::Value> {
    let text = std::fs::read_to_string(reference(path)?).unwrap();
    Some(serde_json::from_str(&text).unwrap())
}
