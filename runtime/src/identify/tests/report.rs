//! The report of an identification, read as a person reads it.

use super::hand_written::scara;
use super::reading::recording;
use super::synthetic;
use crate::identify::{Options, identify};
use crate::report::terminal;

#[test]
fn the_terminal_report_fits_a_screen_and_lines_up() {
    let Some(log) = recording("reference/scara_table1_log.csv.gz", 2, 100.0) else {
        return;
    };
    let options = Options {
        fq_hz: Some(8.0),
        nd: Some(10),
        ..Options::default()
    };
    let found = identify(
        &scara(),
        std::slice::from_ref(&log),
        std::slice::from_ref(&log),
        &options,
        &(),
    )
    .unwrap();
    let text = terminal(&found);
    let lines: Vec<&str> = text.lines().collect();
    let fits = |line: &&str| line.chars().count() <= 118 && *line == line.trim_end();
    assert!(lines.iter().all(fits));
    assert!(lines[0].starts_with("hand-written: 4200 samples at 100 Hz (42.0 s) of "));
    assert!(
        lines[1].starts_with("q below 8 Hz (Butterworth 4), 1 in 10 kept (below 4.00 Hz), 25 ")
    );
    assert_eq!(lines[2], "chosen from the data: trim");
    let row = |start: &str| lines.iter().find(|line| line.starts_with(start)).unwrap();
    let words: Vec<&str> = row("ZZR1").split_whitespace().collect();
    assert_eq!(words.len(), 12, "{words:?}");
    assert_eq!((words[0], words[11]), ("ZZR1", "ZZR1"));
    for place in [2, 5] {
        let value: f64 = words[place].parse().unwrap();
        assert!((value / 3.5 - 1.0).abs() < 1e-3, "{value}");
    }
    assert_eq!(row("rank").matches("8 of 8").count(), 3);
    let digits = row("certain digits").split_whitespace().skip(2);
    let digits: Vec<f64> = digits.map(|digits| digits.parse().unwrap()).collect();
    assert!(digits.len() == 3 && digits.iter().all(|digits| (8.0..16.0).contains(digits)));
    assert_eq!(row("  elbow, N m").split_whitespace().count(), 9);
    assert!(row("validation reference/").contains("rmse"));
    assert!(!text.contains("warning"), "{text}");
}

#[test]
fn the_json_has_the_shape_of_the_contract() {
    let found = identify(
        &scara(),
        &[synthetic::log("a", 0.0, 3000)],
        &[synthetic::log("b", 1.0, 3000)],
        &synthetic::options(),
        &(),
    )
    .unwrap();
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["robot"], "hand-written");
    assert_eq!(json["samples"], 3000);
    assert_eq!(json["rate_hz"], 200.0);
    for (key, value) in [
        ("fq_hz", 20.0),
        ("order", 4.0),
        ("nd", 5.0),
        ("trim", 100.0),
    ] {
        assert_eq!(json["filter"][key].as_f64(), Some(value));
    }
    let names: Vec<_> = found.models.iter().map(|m| m.name.name()).collect();
    assert_eq!(names, ["explicit", "implicit", "power"]);
    let model = &json["models"][2];
    assert_eq!(model["name"], "power");
    assert!(model["rows"].is_u64() && model["rank"].is_u64() && model["condition"].is_f64());
    assert_eq!(model["certified_digits"], found.models[2].certified_digits);
    let parameter = &model["parameters"][0];
    for key in ["value", "sigma", "sigma_pct"] {
        assert!(parameter[key].is_f64(), "{key}");
    }
    assert!(parameter["sigma_corrected"].as_f64().unwrap() > 0.0);
    assert_eq!(parameter["joint"], 1);
    for key in ["name", "unit", "relation"] {
        assert!(parameter[key].is_string());
    }
    for fit in [&model["fit"], &model["validation"][0]] {
        assert!(fit["total_pct"].is_f64());
        assert_eq!(fit["joints"][1]["name"], "elbow");
        assert!(fit["joints"][1]["rmse"].is_f64() && fit["joints"][1]["rel_pct"].is_f64());
    }
    assert_eq!(model["validation"][0]["log"], "b");
}
