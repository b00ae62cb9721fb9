//! Cases as files: what a diagnosis reads, and apart from it the truth.

use std::fs;
use std::path::Path;

use idim::runtime::log;

use super::logs::{Simulated, companion};
use super::machine::Failure;
use super::motion::RATE_HZ;
use super::truth::{Case, Truth};

/// Writes `cases/NAME/` and `truth/NAME.json` under a folder.
pub fn write(folder: &Path, case: &Case) -> Result<(), Failure> {
    let own = folder.join("cases").join(&case.truth.case);
    fs::create_dir_all(&own)?;
    fs::write(own.join("robot.urdf"), &case.described.urdf)?;
    fs::write(own.join("robot.toml"), &case.described.toml)?;
    for (name, simulated) in [("train", &case.train), ("valid", &case.valid)] {
        let text = companion(&simulated.reference, &case.controller, &case.noise);
        fs::write(own.join(format!("{name}.toml")), text)?;
        write_log(&own.join(format!("{name}.csv.gz")), simulated)?;
    }
    let truth = folder.join("truth");
    fs::create_dir_all(&truth)?;
    let text = serde_json::to_string_pretty(&case.truth)?;
    fs::write(truth.join(format!("{}.json", case.truth.case)), text)?;
    Ok(())
}

/// The truth of the cases in a folder, in the order of their names.
pub fn truths(folder: &Path) -> Result<Vec<Truth>, Failure> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder.join("truth"))? {
        all.push(serde_json::from_str::<Truth>(&fs::read_to_string(
            entry?.path(),
        )?)?);
    }
    all.sort_by(|a, b| a.case.cmp(&b.case));
    Ok(all)
}

fn write_log(path: &Path, simulated: &Simulated) -> Result<(), Failure> {
    let len = simulated.q.first().map_or(0, Vec::len);
    // A clock in milliseconds.
    let t: Vec<f64> = (0..len).map(|k| k as f64 / RATE_HZ).collect();
    let names = |symbol: &'static str, series: &[Vec<f64>]| -> Vec<String> {
        (1..=series.len())
            .map(|number| format!("{symbol}{number}"))
            .collect()
    };
    let (q, tau) = (names("q", &simulated.q), names("tau", &simulated.tau));
    let mut columns: Vec<(&str, &[f64])> = vec![("t", &t)];
    columns.extend(
        q.iter()
            .map(String::as_str)
            .zip(simulated.q.iter().map(Vec::as_slice)),
    );
    columns.extend(
        tau.iter()
            .map(String::as_str)
            .zip(simulated.tau.iter().map(Vec::as_slice)),
    );
    log::write(path, &columns)?;
    Ok(())
}
