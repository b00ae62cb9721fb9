//! A long log is the recording of the same file, window by window.

use super::super::tests::{file, joints};
use super::super::{LogSpec, Recording, read};
use super::*;

/// 90 000 rows at 1 kHz: three segments. `edit` changes t, q1, q2, tau1, tau2 of a row.
fn text(edit: impl Fn(usize, &mut [f64; 5])) -> String {
    let mut text = String::from("t,q1,q2,tau1,tau2\n");
    for row in 0..90_000 {
        let t = row as f64 * 1e-3;
        let mut values = [
            t,
            0.5 * (3.0 * t).sin(),
            (2.0 * t).cos(),
            7.0 * (5.0 * t).sin(),
            (7.0 * t).cos() - 1.0,
        ];
        edit(row, &mut values);
        let fields = values.map(|value| format!("{value:.6}"));
        text += &fields.join(",");
        text.push('\n');
    }
    text
}

fn both(text: &str, part: &str, drives: &Drives) -> (Recording, LongLog) {
    let file = file("log.csv", text);
    let spec: LogSpec = format!("{}{part}", file.path.display()).parse().unwrap();
    let options = ReadOptions::default();
    let short = read(&spec, &joints(), drives, &options).unwrap().0;
    let long = read_long(&spec, &joints(), drives, &options).unwrap().0;
    (short, long)
}

/// Windows of odd sizes, put together.
fn whole(long: &LongLog) -> Recording {
    let mut all = long.window(0..0).unwrap();
    let mut from = 0;
    for size in [1, 4095, 40_000, 7, usize::MAX] {
        let window = long.window(from..from.saturating_add(size)).unwrap();
        assert_eq!(window.start, long.start + from as f64 / long.rate_hz);
        from += window.len;
        all.len += window.len;
        for (all, window) in all.q.iter_mut().zip(window.q) {
            all.extend(window);
        }
        let (tau, window_tau) = (all.tau.as_mut().unwrap(), window.tau.unwrap());
        for (all, window) in tau.iter_mut().zip(window_tau) {
            all.extend(window);
        }
        all.stamps.extend(window.stamps);
    }
    all.warnings = long.warnings.clone();
    all.doubtful = long.doubtful.clone();
    all
}

#[test]
fn long_log_is_the_recording_to_the_last_bit() {
    let drives = Drives::default();
    for part in ["", "@10.5..80", "@#70000.."] {
        let (short, long) = both(&text(|_, _| {}), part, &drives);
        assert_eq!(short.warnings, Vec::<String>::new());
        assert_eq!(whole(&long), short);
        assert_eq!((long.len, long.rows), (short.len, short.stamps.len()));
    }
}

#[test]
fn long_log_with_defects_is_the_same_recording_and_says_the_same() {
    let dirty = text(|row, values| match row {
        // On the border of two segments, too.
        5000 | 32_760..32_775 => values[1] = f64::NAN,
        12_000 | 60_000 => values[4] = 900.0,
        40_000..40_120 => values[2] = (2.0_f64 * 39.999).cos(),
        _ => {}
    });
    let (short, long) = both(&dirty, "", &Drives::default());
    assert_eq!(short.warnings.len(), 3, "{:?}", short.warnings);
    assert_eq!(whole(&long), short);
    assert_eq!(short.doubtful.len(), 5);
    let window = long.window(4000..6000).unwrap();
    let first = &short.doubtful[0];
    assert_eq!(window.doubtful, vec![first.start - 4000..first.end - 4000]);
}

#[test]
fn long_log_with_irregular_stamps_is_interpolated_alike() {
    let clean = text(|row, values| {
        values[0] += 4e-4 * (row as f64 * 0.3).sin();
        if row > 50_000 {
            values[0] += 2.5;
        }
        if row % 10_007 == 3 {
            values[0] = f64::NEG_INFINITY;
        }
    });
    // A row lost here, a stamp repeated there.
    let mut lines: Vec<&str> = clean
        .lines()
        .filter(|line| !line.starts_with("-inf"))
        .collect();
    lines.insert(32_770, lines[32_769]);
    let (short, long) = both(&lines.join("\n"), "", &Drives::default());
    assert_eq!(short.warnings.len(), 3, "{:?}", short.warnings);
    assert_eq!(whole(&long), short);
}

#[test]
fn long_log_of_motors_is_the_same_at_the_joints() {
    let drives = Drives {
        gains: vec![2.0, 3.0].into(),
        coupling: vec![45.0, 0.0, 32.0, 32.0].into(),
    };
    let motors = text(|_, _| {}).replacen("q1,q2,tau1,tau2", "qm1,qm2,i1,i2", 1);
    let (short, long) = both(&motors, "", &drives);
    assert_eq!(whole(&long), short);
    let extent = short.q[1]
        .iter()
        .fold((0.0_f64, 0.0_f64), |(low, high), q| {
            (low.min(*q), high.max(*q))
        });
    assert_eq!(long.range[1], extent);
}

#[test]
fn long_log_that_cannot_be_used_says_what_the_short_one_says() {
    let broken = [
        text(|row, values| {
            if row == 77_000 {
                values[0] = 1.0;
            }
        }),
        text(|row, values| {
            if row % 5 == 1 {
                values[3] = f64::NAN;
            }
        }),
        text(|_, _| {}) + "90.0,1,2,x,3\n",
        text(|_, _| {}).replace("t,q1", "t,q9"),
        text(|row, values| values[0] = (row / 2) as f64 * 0.002),
    ];
    for text in broken {
        let file = file("log.csv", text);
        let spec: LogSpec = file.path.display().to_string().parse().unwrap();
        let (drives, options) = (Drives::default(), ReadOptions::default());
        let short = read(&spec, &joints(), &drives, &options).unwrap_err();
        let long = read_long(&spec, &joints(), &drives, &options).unwrap_err();
        assert_eq!(long.to_string(), short.to_string());
    }
}

#[test]
fn log_that_is_long_is_told_by_its_size() {
    use std::io::Write;
    let spec = |path: &std::path::Path| LogSpec::from(path.to_owned());
    assert!(!is_long(&spec(&file("log.csv", "t,q1\n").path)));
    assert!(!is_long(&spec("no/such/log.csv".as_ref())));
    assert!(!is_long(&spec(&std::env::temp_dir())));
    let zeros = vec![b'0'; LONG as usize + 1];
    assert!(is_long(&spec(&file("log.csv", &zeros).path)));
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(&zeros).unwrap();
    assert!(is_long(&spec(&file("log.gz", gzip.finish().unwrap()).path)));
}
