//! The page of a real identification: complete, small, and the same every time. The data are read
//! from beside the checkout; without them the test says so and passes.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::Path;
use std::process::{Command, Output};

fn idim(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_idim"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

fn count(page: &str, piece: &str) -> usize {
    page.matches(piece).count()
}

#[test]
fn page_of_the_tx40_is_complete_and_below_two_megabytes() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/real/staubli_tx40");
    if !data.is_dir() {
        println!("skipped: the reference data are not beside this checkout");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let log = data.join("log.csv.gz").display().to_string();
    let (train, valid) = (format!("{log}@..5"), format!("{log}@5..7.5"));
    let arguments = [
        "identify",
        "tx40",
        &train,
        "--validate",
        &valid,
        "--html",
        "-",
    ];
    let first = idim(folder.path(), &arguments);
    assert!(first.status.success());
    let page = String::from_utf8(first.stdout).unwrap();
    assert!(page.len() < 2_000_000, "{}", page.len());
    // Six joints, held out and training.
    assert_eq!(count(&page, "class=\"curve explicit residual\""), 12);
    assert_eq!(count(&page, "class=\"bar held\""), 7);
    assert_eq!(count(&page, "class=\"whisker\""), 80);
    assert!(page.contains("joint_6") && page.contains("idim identify tx40"));
    let again = idim(folder.path(), &arguments);
    assert!(again.stdout == page.as_bytes(), "two pages differ");
}

#[test]
fn demo_writes_a_page_that_knows_the_truth() {
    let folder = tempfile::tempdir().unwrap();
    let output = idim(folder.path(), &["demo", "--quiet"]);
    assert!(output.status.success());
    let page = std::fs::read_to_string(folder.path().join("idim-demo/report.html")).unwrap();
    assert!(page.contains("SCARA") && page.contains("Largest error against the true values"));
    assert_eq!(count(&page, "class=\"truth\""), 8);
    assert!(page.contains("The model lacks stribeck on joint 1 (shoulder)"));
    assert!(
        page.contains("velocity of shoulder, rad/s"),
        "what explains the residual"
    );
    assert!(page.len() < 1_000_000, "{}", page.len());
    let json = std::fs::read_to_string(folder.path().join("idim-demo/result.json")).unwrap();
    assert!(
        !json.contains("\"series\""),
        "the curves belong to the page"
    );
}
