//! Files, dialects and parts.

use super::*;

#[test]
fn log_that_is_clean_is_read_without_a_word() {
    let log = good(&clean());
    assert_eq!((log.rate_hz, log.start, log.len), (100.0, 0.0, 200));
    assert_eq!(log.warnings, Vec::<String>::new());
    assert_eq!(
        (log.q.len(), log.tau.as_ref().map(Vec::len), log.qd),
        (2, Some(2), None)
    );
    assert_eq!((log.stem.as_str(), log.stamps.len()), ("log", 200));
}

#[test]
fn log_in_another_dialect_is_the_same_log() {
    let reference = good(&clean());
    for text in [
        clean().replace(',', ";").replace('.', ","),
        clean().replace(',', " , ").replace('\n', "\r\n"),
        clean().replace(',', "\t"),
        format!("\u{feff}{}", clean()),
        clean()
            .replace("q1,q2", "q_shoulder,Elbow")
            .replace("tau2", "TAU_2"),
        clean().replace('\n', ",\n"),
        clean() + "\n\n  \n",
        clean().replace("\n0.5", "\n# a remark, with commas\n% another\n\n0.5"),
        format!(
            "# t,q1,q2,tau1,tau2\n{}",
            &clean()["t,q1,q2,tau1,tau2\n".len()..]
        ),
        "\"".to_owned() + &clean().replace(',', "\",\"").replace('\n', "\"\n\"") + "\"",
        "\"".to_owned()
            + &clean()
                .replace(',', "\",\"")
                .replace('.', ",")
                .replace('\n', "\"\r\n\"")
            + "\"",
    ] {
        let found = good(&text);
        assert_eq!(
            (found.q, found.tau),
            (reference.q.clone(), reference.tau.clone()),
            "{text:.60}"
        );
        assert_eq!(found.warnings, Vec::<String>::new());
    }
}

#[test]
fn log_in_another_encoding_is_the_same_log() {
    let expected = good(&clean()).q;
    let tabs = clean().replace(',', "\t").replace('.', ",");
    let utf16 = |order: fn(u16) -> [u8; 2], text: &str| -> Vec<u8> {
        text.encode_utf16().flat_map(order).collect()
    };
    let latin1 = clean()
        .replacen("tau2", "tau2,\u{fc}", 1)
        .replace('\n', ",\u{e9}\n");
    for bytes in [
        utf16(u16::to_le_bytes, &format!("\u{feff}{tabs}")),
        utf16(u16::to_be_bytes, &format!("\u{feff}{tabs}")),
        utf16(u16::to_le_bytes, &tabs.replace('\n', "\r\n")),
        latin1
            .replacen(",\u{e9}", "", 1)
            .chars()
            .map(|c| c as u8)
            .collect(),
    ] {
        let file = file("log.txt", bytes);
        let found = read_part(&file, "", &Drives::default(), &ReadOptions::default());
        assert_eq!(found.unwrap().0.q, expected);
    }
}

#[test]
fn parts_of_a_log_follow_each_other_without_overlap() {
    let file = file("log.csv", clean());
    let part = |part: &str| {
        let options = ReadOptions::default();
        read_part(&file, part, &Drives::default(), &options)
            .unwrap()
            .0
    };
    let (first, second) = (part("@..0.5"), part("@0.5..1"));
    assert_eq!((first.len, second.len, second.start), (50, 50, 0.5));
    assert_eq!(part("@#50..100").q, second.q);
    assert_eq!(part("@#0..50").q, first.q);
    let error = read_part(&file, "@7..8", &Drives::default(), &ReadOptions::default());
    assert_says(
        &error.unwrap_err().to_string(),
        &["0 rows are too few", "t from 0 to 1.99 s"],
    );
}

#[test]
fn last_row_cut_short_is_left_out_and_one_inside_is_an_error() {
    let text = clean();
    let cut = good(&text[..text.len() - 30]);
    assert_eq!(cut.len, 199);
    assert_says(
        &cut.warnings.join("\n"),
        &["Row 199 (line 201), the last one"],
    );
    let lines: Vec<&str> = text.lines().collect();
    let inside = text.replace(lines[20], "0.19,0.2");
    assert_says(
        &message(&inside),
        &["row 19 (line 21) has 2 fields, the header has 5"],
    );
}

#[test]
fn file_that_is_no_log_is_an_error_that_says_so() {
    let read = |name: &str, bytes: &[u8]| {
        let file = file(name, bytes);
        let outcome = read_part(&file, "", &Drives::default(), &ReadOptions::default());
        outcome.unwrap_err().to_string()
    };
    assert_says(&read("log.csv", b""), &["log.csv: is empty"]);
    assert_says(
        &read("log.csv", b"t,q1,q2,tau1,tau2\n"),
        &["0 rows are too few"],
    );
    assert_says(
        &read("log.csv", b"0.0,1.0,2.0\n0.1,1.0,2.0\n"),
        &["add a header"],
    );
    assert_says(
        &read("log.csv", b"\x89PNG\r\n\x1a\n\0\0"),
        &["is not a text file"],
    );
    let parquet = read("log.parquet", b"PAR1");
    if cfg!(feature = "parquet") {
        assert_says(&parquet, &["cannot be read"]);
    } else {
        assert_says(
            &parquet,
            &["Parquet needs a build with the feature `parquet`"],
        );
    }
    assert_says(
        &read("log.csv.gz", &[0x1f, 0x8b, 8, 0, 0]),
        &["cannot be read"],
    );
    let missing = "no/such/log.csv".parse().unwrap();
    let missing = super::read(
        &missing,
        &joints(),
        &Drives::default(),
        &ReadOptions::default(),
    );
    assert_says(
        &missing.unwrap_err().to_string(),
        &["no/such/log.csv: cannot be opened"],
    );
    let here = std::env::temp_dir().into();
    let here = super::read(
        &here,
        &joints(),
        &Drives::default(),
        &ReadOptions::default(),
    );
    assert_says(&here.unwrap_err().to_string(), &["is a directory"]);
}

#[test]
fn gzip_that_is_truncated_says_how_far_it_was_read() {
    use std::io::Write;
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(clean().as_bytes()).unwrap();
    let bytes = gzip.finish().unwrap();
    let whole = file("log.csv.gz", &bytes);
    let read = |file: &File| read_part(file, "", &Drives::default(), &ReadOptions::default());
    assert_eq!(read(&whole).unwrap().0.q, good(&clean()).q);
    let cut = file("log.csv.gz", &bytes[..bytes.len() / 2]);
    assert_says(
        &read(&cut).unwrap_err().to_string(),
        &["cannot be read beyond row", "truncated"],
    );
}

#[test]
fn predictions_written_and_read_again_cover_the_same_rows() {
    let log = good(&clean());
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("log_explicit.csv.gz");
    let tau = log.tau.clone().unwrap();
    write(
        &path,
        &[
            ("t", &log.stamps),
            ("q1", &log.q[0]),
            ("q2", &log.q[1]),
            ("tau1", &tau[0]),
            ("tau2", &tau[1]),
        ],
    )
    .unwrap();
    let again = read(
        &path.into(),
        &joints(),
        &Drives::default(),
        &ReadOptions::default(),
    );
    let again = again.unwrap().0;
    assert_eq!(
        (again.q, again.tau, again.stamps),
        (log.q, log.tau, log.stamps)
    );
}
