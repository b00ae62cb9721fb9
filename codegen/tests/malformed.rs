//! Descriptions as they should not be: `tests/malformed/NAME.*` with, beside each, what is expected
//! of it in `NAME.expected`.
//!
//! An expectation is one line per diagnostic, `error CODE LINE:COLUMN start of the message`; a file
//! that must be accepted has `ok NAME_OF_ROBOT` first, then its warnings and its snapped angles.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use idim_codegen::describe::{Description, Diagnostic, Kind, Severity, read_path, read_text};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// No description takes longer, on any machine: a guard against hanging, not a benchmark.
const PATIENCE: Duration = Duration::from_secs(5);

fn timely<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = run();
    let took = start.elapsed();
    assert!(took < PATIENCE, "{what} took {took:?}");
    result
}

fn line(one: &Diagnostic) -> String {
    let word = match one.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    format!(
        "{word} {} {}:{} {}",
        one.code, one.span.line, one.span.column, one.message
    )
}

fn report(result: &Result<Description, Vec<Diagnostic>>) -> Vec<String> {
    match result {
        Ok(robot) => {
            let snaps = robot
                .snaps
                .iter()
                .map(|snap| format!("snap {} {:.6} {}", snap.joint, snap.from, snap.to));
            let first = std::iter::once(format!("ok {}", robot.name));
            first
                .chain(robot.warnings.iter().map(line))
                .chain(snaps)
                .collect()
        }
        Err(errors) => errors.iter().map(line).collect(),
    }
}

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/malformed");
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "expected")
        })
        .collect();
    files.sort();
    files
}

/// The description that an expectation is about: the one other file of that name.
fn described(expected: &Path) -> PathBuf {
    ["urdf", "toml", "par", "xacro", "txt"]
        .iter()
        .map(|extension| expected.with_extension(extension))
        .find(|path| path.exists())
        .unwrap_or_else(|| panic!("nothing beside {}", expected.display()))
}

#[test]
fn read_path_corpus_gives_the_expected_diagnostics() {
    let expectations = corpus();
    assert!(
        expectations.len() > 150,
        "the corpus has {} files only",
        expectations.len()
    );
    let mut wrong = String::new();
    for expected in expectations {
        let file = described(&expected);
        let found = timely(&file.display().to_string(), || report(&read_path(&file)));
        let wanted = fs::read_to_string(&expected).unwrap();
        let wanted: Vec<&str> = wanted.lines().collect();
        let same = found.len() == wanted.len()
            && found
                .iter()
                .zip(&wanted)
                .all(|(found, wanted)| found.starts_with(wanted));
        if !same {
            let found = found.join("\n    ");
            wrong += &format!("\n{}:\n    {found}\n", file.display());
        }
    }
    assert!(wrong.is_empty(), "not as expected:{wrong}");
}

#[test]
fn read_path_corpus_errors_name_the_file_and_have_a_documented_code() {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/diagnostics.md");
    let book = fs::read_to_string(book).unwrap();
    for expected in corpus() {
        let file = described(&expected);
        let found = match read_path(&file) {
            Ok(robot) => robot.warnings,
            Err(errors) => errors,
        };
        for one in found {
            assert!(
                book.contains(&format!("| {} |", one.code)),
                "{} is in no table",
                one.code
            );
            assert!(one.file.contains("malformed"), "{one}");
        }
    }
}

fn read(text: &str, kind: Kind) -> Vec<String> {
    timely("a generated description", || {
        report(&read_text(text, "big", kind, &|_| {
            Err("nothing there".to_owned())
        }))
    })
}

/// A chain of links, written on one single line.
fn chain(links: usize) -> String {
    let mut text = "<robot name=\"chain\"><link name=\"l0\"/>".to_owned();
    for i in 1..links {
        let parent = i - 1;
        text += &format!(
            "<link name=\"l{i}\"/><joint name=\"j{i}\" type=\"continuous\"><parent \
             link=\"l{parent}\"/><child link=\"l{i}\"/><axis xyz=\"0 0 1\"/></joint>"
        );
    }
    text + "</robot>"
}

#[test]
fn read_text_thousands_of_links_are_read_and_more_are_refused() {
    assert_eq!(read(&chain(10_000), Kind::Urdf)[0], "ok chain");
    let refused = read(&chain(20_000), Kind::Urdf);
    assert!(refused[0].starts_with("error IDIM013 1:"), "{refused:?}");
    assert!(
        refused[0].contains("more than 10000 <link> elements"),
        "{refused:?}"
    );
}

#[test]
fn read_text_thousands_of_mistakes_are_cut_short() {
    let unknown = chain(10_000).replace("<parent link=\"l", "<parent link=\"k");
    let found = read(&unknown, Kind::Urdf);
    assert_eq!(found.len(), 50);
    let effects = "[[effect]]\nkind = \"colomb\"\njoint = \"x\"\n".repeat(20_000);
    assert_eq!(read(&effects, Kind::Toml).len(), 50);
    let rows = "[[joint]]\nkind = \"revolute\"\n".repeat(20_000);
    assert_eq!(read(&rows, Kind::Toml)[0], "ok big");
}

#[test]
fn read_text_deep_or_wide_xml_is_refused_before_it_is_parsed() {
    for (text, start) in [
        ("<robot>".repeat(16_000), "error IDIM011 1:449 "),
        (
            format!("<robot{}/>", " a=\"b\"".repeat(1_000_000)),
            "error IDIM013 1:1 ",
        ),
        (
            format!("<robot{}/>", " xmlns:a=\"b\"".repeat(100_000)),
            "error IDIM013 1:1 ",
        ),
        (
            format!("<robot>{}</robot>", "<a/>".repeat(3_000_000)),
            "error IDIM013 ",
        ),
        ("<!-- ".repeat(1_000_000), "error IDIM010 "),
        ("<".repeat(1_000_000), "error IDIM010 "),
        ("<a '".repeat(1_000_000), "error IDIM013 "),
    ] {
        let found = read(&text, Kind::Urdf);
        assert!(found[0].starts_with(start), "{start}: {found:?}");
    }
}

#[test]
fn read_text_deep_or_huge_toml_is_refused() {
    for (text, start) in [
        (
            format!("gravity = {}", "[".repeat(1_000_000)),
            "error IDIM050 1:",
        ),
        (
            format!("gravity = {}", "{a=".repeat(1_000_000)),
            "error IDIM050 1:",
        ),
        (
            format!("{}a = 1", "a.".repeat(1_000_000)),
            "error IDIM050 1:",
        ),
        (
            format!("name = \"{}\"", "x".repeat(5 << 20)),
            "error IDIM002 0:0 ",
        ),
    ] {
        let found = read(&text, Kind::Toml);
        assert!(found[0].starts_with(start), "{start}: {found:?}");
    }
}

#[test]
fn read_path_files_of_gigabytes_and_files_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let huge = folder.path().join("huge.urdf");
    // Sparse: nothing is written to the disk, and nothing must be read from it.
    fs::File::create(&huge).unwrap().set_len(2 << 30).unwrap();
    let report = |path: &Path| timely("a strange file", || report(&read_path(path)));
    assert!(report(&huge)[0].starts_with("error IDIM002 0:0 larger than 64 MiB"));
    assert!(report(folder.path())[0].starts_with("error IDIM001 0:0 this is a folder"));
    assert!(report(&folder.path().join("none.urdf"))[0].starts_with("error IDIM001 0:0 "));
    let longest = folder.path().join("x".repeat(5000));
    assert!(report(&longest)[0].starts_with("error IDIM001 0:0 "));
}

#[cfg(unix)]
#[test]
fn read_path_endless_devices_and_loops_of_links_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (
        folder.path().join("one.urdf"),
        folder.path().join("other.urdf"),
    );
    std::os::unix::fs::symlink(&one, &other).unwrap();
    std::os::unix::fs::symlink(&other, &one).unwrap();
    let companion = folder.path().join("loop.toml");
    fs::write(&companion, "urdf = \"one.urdf\"\n").unwrap();
    let report = |path: &Path| timely("a strange file", || report(&read_path(path)));
    assert!(report(&one)[0].starts_with("error IDIM001 0:0 "));
    assert!(report(&companion)[0].starts_with("error IDIM001 1:8 cannot read `one.urdf`: "));
    if Path::new("/dev/zero").exists() {
        assert!(report(Path::new("/dev/zero"))[0].starts_with("error IDIM002 0:0 "));
    }
}
