//! The page of the demo in a real browser: it loads without a word on the console, and its plots
//! have marks. Without Chromium the test says so and passes.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::Path;
use std::process::{Command, Output};

/// Names that Chromium goes by.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// Runs a page in a browser: what it renders to, and what it says.
fn rendered(page: &Path, profile: &Path) -> Option<Output> {
    let run = |browser: &&str| {
        Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
            .arg("--enable-logging=stderr")
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(format!("file://{}", page.display()))
            .output()
            .ok()
    };
    BROWSERS.iter().find_map(run)
}

/// Lengths of the drawings of a class.
fn drawn(page: &str, class: &str) -> Vec<usize> {
    let start = format!("class=\"{class}\" d=\"");
    let paths = page.split(&start).skip(1);
    paths
        .map(|rest| rest.split('"').next().unwrap_or("").len())
        .collect()
}

#[test]
fn the_page_of_the_demo_runs_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let demo = Command::new(env!("CARGO_BIN_EXE_idim"))
        .current_dir(folder.path())
        .args(["demo", "--quiet"])
        .status()
        .unwrap();
    assert!(demo.success());
    let page = folder.path().join("idim-demo/report.html");
    let Some(output) = rendered(&page, &folder.path().join("profile")) else {
        println!("skipped: there is no Chromium here");
        return;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    let console: Vec<&str> = said.lines().filter(|l| l.contains("CONSOLE")).collect();
    assert!(console.is_empty(), "{console:?}");
    let page = String::from_utf8(output.stdout).unwrap();
    assert!(page.contains("stribeck on joint 1 (shoulder)"), "{said}");
    for class in ["dots before", "dots after", "curve before mean"] {
        assert!(
            drawn(&page, class).iter().all(|length| *length > 200),
            "{class}"
        );
        assert_eq!(drawn(&page, class).len(), 1, "{class}");
    }
    // Two joints each; at least torque, perhaps the simulated motion too.
    for class in ["curve before residual", "curve after residual"] {
        let curves = drawn(&page, class);
        assert!(curves.len() >= 2, "{class}");
        assert!(
            curves.iter().all(|length| *length > 2000),
            "{class}: {curves:?}"
        );
    }
    // The script has run: it made nothing visible before a pointer came.
    assert!(page.contains("id=\"readout\" hidden"));
}
