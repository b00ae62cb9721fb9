//! Stamps: order, repetition, gaps, rates, units.

use super::*;

#[test]
fn time_that_goes_back_is_located_and_can_be_cut_around() {
    let text = log(|row, fields| {
        if row == 60 {
            fields[0] = "3048.1".into();
        }
    });
    assert_says(
        &message(&text),
        &["from 3048.1 s to 0.6 s at row 60 (line 62)"],
    );
    let file = file("log.csv", &text);
    let read = |part: &str| read_part(&file, part, &Drives::default(), &ReadOptions::default());
    // Cutting by time cannot hide a hole that the bad stamp leaves.
    assert_says(
        &read("@0.2..1").unwrap_err().to_string(),
        &["time goes back"],
    );
    let before = read("@0.2..0.5").unwrap().0;
    assert_says(
        &before.warnings.join("\n"),
        &["Outside this part, time goes back", "row 60"],
    );
    let after = read("@#60..").unwrap().0;
    assert_eq!((after.len, after.warnings.len()), (140, 0));
}

#[test]
fn stamp_that_repeats_is_left_out_and_reported() {
    let mut lines: Vec<String> = clean().lines().map(String::from).collect();
    lines.insert(31, lines[30].clone());
    let log = good(&lines.join("\n"));
    assert_eq!((log.len, log.rate_hz, log.stamps.len()), (200, 100.0, 201));
    assert_eq!(log.q, good(&clean()).q);
    assert_says(
        &log.warnings.join("\n"),
        &[
            "stamp of the row before are left out: 1, of which 0",
            "row 30",
        ],
    );
    // Predictions still have one value per row.
    assert_eq!(onto_stamps(&log, &log.q[0]).len(), 201);
}

#[test]
fn stamps_too_coarse_for_the_rate_need_the_companion() {
    let text = log(|row, fields| fields[0] = format!("{:.1}", (row - 1) as f64 * 0.01));
    assert_says(
        &message(&text),
        &["carry the stamp of the row before", "give rate_hz"],
    );
    let file = file("log.csv", &text);
    std::fs::write(file.path.with_file_name("log.toml"), "rate_hz = 100\n").unwrap();
    let log = read_part(&file, "", &Drives::default(), &ReadOptions::default())
        .unwrap()
        .0;
    assert_eq!((log.rate_hz, log.len), (100.0, 200));
    assert_eq!(log.q, good(&clean()).q);
    assert_eq!(onto_stamps(&log, &log.q[1]), log.q[1]);
}

#[test]
fn stamps_printed_with_few_decimals_keep_their_samples() {
    // 120 Hz with milliseconds: steps of 8 and 9 ms.
    let text = log(|row, fields| fields[0] = format!("{:.3}", (row - 1) as f64 / 120.0));
    let log = good(&text);
    assert_eq!((log.rate_hz, log.len, log.warnings.len()), (120.0, 200, 0));
    assert_eq!(log.q, good(&clean()).q);
    // An odd rate is not bent to a round one: 1024 Hz.
    let text = self::log(|row, fields| fields[0] = format!("{:.9}", (row - 1) as f64 / 1024.0));
    assert_eq!(good(&text).rate_hz, 1024.0);
}

#[test]
fn sample_that_was_lost_is_interpolated_and_reported() {
    let clean = clean();
    let lines: Vec<&str> = clean.lines().collect();
    let text = [&lines[..41], &lines[42..100], &lines[120..]]
        .concat()
        .join("\n");
    let log = good(&text);
    assert_eq!((log.rate_hz, log.len, log.stamps.len()), (100.0, 200, 179));
    let q1 = &log.q[0];
    assert!((q1[40] - 0.5 * (q1[39] + q1[41])).abs() < 1e-12);
    assert_says(
        &log.warnings.join("\n"),
        &[
            "2 of 178 steps",
            "the longest is 210 ms (after row 97, t = 0.98 s)",
            "Gaps longer than 5 steps are bridged by straight lines (1)",
        ],
    );
}

#[test]
fn stamps_in_milliseconds_are_suspected_and_the_companion_corrects_them() {
    let text = log(|row, fields| fields[0] = format!("{}", (row - 1) * 10));
    assert_says(
        &good(&text).warnings.join("\n"),
        &["The stamps say 0.1 Hz", "unit = \"ms\""],
    );
    let file = file("log.csv", &text);
    std::fs::write(
        file.path.with_file_name("log.toml"),
        "[columns]\nt = { unit = 'ms' }\n",
    )
    .unwrap();
    let log = read_part(
        &file,
        "@0.5..1",
        &Drives::default(),
        &ReadOptions::default(),
    )
    .unwrap()
    .0;
    assert_eq!(
        (log.rate_hz, log.start, log.len, log.warnings.len()),
        (100.0, 0.5, 50, 0)
    );
}

#[test]
fn grid_that_would_be_absurd_is_refused() {
    let text = log(|row, fields| fields[0] = format!("{}", (row - 1) * 10));
    let file = file("log.csv", &text);
    std::fs::write(file.path.with_file_name("log.toml"), "rate_hz = 1000\n").unwrap();
    let error = read_part(&file, "", &Drives::default(), &ReadOptions::default()).unwrap_err();
    assert_says(
        &error.to_string(),
        &["1990 s make 1990001 samples for 200 rows"],
    );
}
