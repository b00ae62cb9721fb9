//! The names of logs and their parts.

use std::path::Path;

use super::*;

fn parse(text: &str) -> LogSpec {
    text.parse().unwrap()
}

#[test]
fn spec_with_seconds_includes_the_first_and_excludes_the_last() {
    let spec = parse("dir/log.csv.gz@5..7.5");
    assert_eq!(spec.path, Path::new("dir/log.csv.gz"));
    assert_eq!(
        spec.part,
        Part::Seconds {
            from: Some(5.0),
            to: Some(7.5)
        }
    );
    let inside: Vec<bool> = [4.9998, 5.0, 7.4998, 7.5]
        .iter()
        .map(|&t| spec.part.contains(1, t))
        .collect();
    assert_eq!(inside, [false, true, true, false]);
}

#[test]
fn spec_with_rows_counts_from_zero_as_slices_do() {
    let part = parse("log.csv@#635..3510").part;
    assert!(!part.contains(634, 0.0) && part.contains(635, 0.0));
    assert!(part.contains(3509, 0.0) && !part.contains(3510, 0.0));
    assert!(!part.ends_before(3509) && part.ends_before(3510));
    let first = parse("log.csv@#0..5").part;
    assert!(first.contains(0, 0.0) && first.contains(4, 0.0) && !first.contains(5, 0.0));
}

#[test]
fn spec_with_an_open_end_reaches_the_end_of_the_log() {
    assert_eq!(
        parse("a.csv@5..").part,
        Part::Seconds {
            from: Some(5.0),
            to: None
        }
    );
    assert_eq!(
        parse("a.csv@..7.5").part,
        Part::Seconds {
            from: None,
            to: Some(7.5)
        }
    );
    assert_eq!(
        parse("a.csv@#..9").part,
        Part::Rows {
            from: None,
            to: Some(9)
        }
    );
    assert_eq!(
        parse("a.csv@-1e-1...5").part,
        Part::Seconds {
            from: Some(-0.1),
            to: Some(0.5)
        }
    );
}

#[test]
fn spec_with_an_at_sign_in_the_path_is_still_a_path() {
    for text in ["me@lab/log.csv", "run@2.csv", "run@5..7.csv.gz"] {
        let spec = parse(text);
        assert_eq!(
            (spec.path.as_path(), spec.part),
            (Path::new(text), Part::Whole)
        );
    }
    assert_eq!(
        parse("me@lab/log.csv@1..2").path,
        Path::new("me@lab/log.csv")
    );
}

#[test]
fn stem_of_any_spec_has_no_extension_and_no_part() {
    for (text, stem) in [
        ("dir/log.csv.gz@5..7.5", "log"),
        ("a.b.csv", "a.b"),
        ("LOG.CSV.GZ", "LOG"),
        ("log", "log"),
        ("dir.d/ptp.parquet@#1..2", "ptp"),
        (".csv", ".csv"),
    ] {
        assert_eq!(parse(text).stem(), stem, "{text}");
    }
    assert_eq!(
        parse("d/log.csv.gz@1..").companion_path(),
        Path::new("d/log.toml")
    );
}

#[test]
fn spec_with_a_malformed_part_says_what_is_wrong() {
    for (text, part_of_message) in [
        ("log.csv@5-7", "names no part"),
        ("log.csv@", "names no part"),
        ("log.csv@..", "names no part"),
        ("log.csv@#..", "names no part"),
        ("log.csv@a..7", "`a` is not a time in seconds"),
        ("log.csv@1..nan", "`nan` is not a time"),
        ("log.csv@1..inf", "`inf` is not a time"),
        ("log.csv@#1.5..7", "`1.5` is not a row number"),
        ("log.csv@7.5..5", "not after its start 7.5"),
        ("log.csv@#7..7", "not after its start 7"),
        ("@5..7", "no file"),
        ("", "no file"),
    ] {
        let message = text.parse::<LogSpec>().unwrap_err().to_string();
        assert!(message.contains(part_of_message), "{text}: {message}");
    }
}

#[test]
fn part_shown_parses_back_to_itself() {
    for text in ["x@5..7.5", "x@#635..3510", "x@5..", "x@#..3510"] {
        assert_eq!(format!("x{}", parse(text).part), text);
    }
}
