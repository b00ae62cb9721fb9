//! Whatever the bytes, the reader answers.

use proptest::prelude::*;

use super::*;

/// Bytes that often look like a log.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let field = prop_oneof![
        any::<f64>().prop_map(|value| value.to_string()),
        (0..50_i32).prop_map(|value| (f64::from(value) * 0.01).to_string()),
        "[-+0-9.eE,;\" \t]{0,6}",
        Just("nan".to_owned()),
        Just(String::new()),
    ];
    let row = prop::collection::vec(field, 3..7).prop_map(|fields| fields.join(","));
    let rows = prop::collection::vec(row, 0..40);
    let text = (
        prop_oneof![
            Just("t,q1,q2,tau1,tau2\n"),
            Just("t;q1;q2;tau1\n"),
            Just("")
        ],
        rows,
    )
        .prop_map(|(header, rows)| (header.to_owned() + &rows.join("\n")).into_bytes());
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..400),
        prop::collection::vec(any::<u8>(), 0..100)
            .prop_map(|tail| [vec![0x1f, 0x8b, 8], tail].concat()),
        text,
    ]
}

/// Rows with ordered and disordered stamps that parse, so that grid and checks are reached.
fn stamped() -> impl Strategy<Value = Vec<u8>> {
    let step = prop_oneof![8 => Just(0.01), 1 => 0.0..0.02, 1 => Just(0.0), 1 => any::<f64>()];
    prop::collection::vec((step, any::<f64>()), 5..60).prop_map(|rows| {
        let mut text = String::from("t,q1,q2,tau1,tau2,qd1,qd2\n");
        let mut t = 0.0;
        for (step, value) in rows {
            t += step.abs();
            text += &format!("{t},{value},{},{value},1,{value},{t}\n", value * 0.1);
        }
        text.into_bytes()
    })
}

proptest! {
    // A failing case is kept as a test of its own, not in a file beside the crate.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn log_of_any_bytes_never_panics(bytes in prop_oneof![bytes(), stamped()], part in "(|@#3\\.\\.30|@0\\.02\\.\\.0\\.3)") {
        let file = file("log.csv", bytes);
        for require_torque in [true, false] {
            let options = ReadOptions { require_torque, ..ReadOptions::default() };
            if let Ok((log, _)) = read_part(&file, &part, &Drives::default(), &options) {
                prop_assert!(log.q.iter().all(|q| q.len() == log.len));
                prop_assert_eq!(onto_stamps(&log, &log.q[0]).len(), log.stamps.len());
            }
        }
    }

    #[test]
    fn companion_of_any_text_never_panics(text in "(\\[columns\\]\n|\\[reference\\]\n|[a-z_0-9 =.'\"{}\\[\\]\n]){0,12}") {
        let file = file("log.toml", text);
        let _ = Companion::load(&file.path);
    }

    #[test]
    fn spec_of_any_text_never_panics(text in "[a-z.@#0-9/-]{0,12}|\\PC{0,12}") {
        if let Ok(spec) = text.parse::<LogSpec>() {
            let _ = (spec.stem(), spec.companion_path(), spec.part.contains(3, f64::NAN));
        }
    }
}
