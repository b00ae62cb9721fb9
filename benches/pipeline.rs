//! From a log to a result: the TX40 log (45 000 samples, 6 joints, 61 parameters) where it lies
//! beside the checkout, and the simulated SCARA.
//!
//! `cargo bench --bench pipeline`

use std::path::Path;

use idim::demo;
use idim::robots;
use idim::runtime::identify::{Options, identify};
use idim::runtime::log::{self, LogSpec, ReadOptions, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;

fn main() {
    divan::main();
}

fn tx40(log: &str) -> Option<Recording> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data/real/staubli_tx40")
        .join(log);
    let spec: LogSpec = path.display().to_string().parse().ok()?;
    let model = robots::tx40::Model;
    let drives = &model.settings().drives;
    log::read(&spec, model.joints(), drives, &ReadOptions::default())
        .ok()
        .map(|read| read.0)
}

/// Load the whole log and identify with all three models.
#[divan::bench]
fn tx40_from_file_three_models(bencher: divan::Bencher<'_, '_>) {
    run_tx40(bencher, Options::default());
}

/// The same with the explicit model alone.
#[divan::bench]
fn tx40_from_file_explicit_model(bencher: divan::Bencher<'_, '_>) {
    run_tx40(
        bencher,
        Options {
            models: vec![ModelKind::Explicit],
            ..Options::default()
        },
    );
}

fn run_tx40(bencher: divan::Bencher<'_, '_>, options: Options) {
    if tx40("log.csv.gz").is_none() {
        println!("skipped: the TX40 log is not beside this checkout");
        return;
    }
    bencher.bench(|| {
        let log = tx40("log.csv.gz")?;
        identify(&robots::tx40::Model, &[log], &[], &options, &()).ok()
    });
}

/// 42 s of the SCARA at 100 Hz, all three models.
#[divan::bench]
fn scara_three_models(bencher: divan::Bencher<'_, '_>) {
    let Ok(experiment) = demo::experiment() else {
        return;
    };
    let train = std::slice::from_ref(&experiment.recording);
    bencher.bench(|| identify(&robots::scara::Model, train, &[], &Options::default(), &()).ok());
}
