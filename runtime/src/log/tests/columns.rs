//! Columns, companions and drives.

use super::*;

#[test]
fn column_that_is_missing_is_named_with_what_was_found() {
    assert_says(
        &message(&clean().replace("q2", "pos_2")),
        &[
            "position of joint 2 (`elbow`)",
            "`q2` or",
            "`elbow`",
            "found t, q1, pos_2",
        ],
    );
    assert_says(
        &message(&clean().replace("t,q1", "time_s,q1")),
        &["time stamps", "time_s"],
    );
    let text = clean().replace("tau1", "taul");
    assert_says(
        &message(&text),
        &["torque of joint 1", "did you mean `taul`?", "[columns]"],
    );
    assert_says(
        &message(&clean().replace("q1,q2", "q0,q1")),
        &["joint 2", "did you mean `q0`"],
    );
}

#[test]
fn log_without_torque_is_read_where_none_is_required() {
    let text = clean().replace("tau", "x");
    assert_says(&message(&text), &["torque of joint 1"]);
    let options = ReadOptions {
        require_torque: false,
        ..ReadOptions::default()
    };
    let read = |text: &str| {
        read_part(&file("log.csv", text), "", &Drives::default(), &options)
            .unwrap()
            .0
    };
    assert_eq!(read(&text).tau, None);
    let holes = read(&log(|row, fields| {
        if row % 5 == 4 {
            fields[3] = "nan".into();
        }
    }));
    assert_eq!(holes.tau, None);
    assert_says(
        &holes.warnings.join("\n"),
        &["`tau1`: values missing, NaN or infinite: 40", "row 3, 8"],
    );
    let currents = read(&clean().replace("tau", "i"));
    assert_eq!(currents.tau, None);
    assert_says(&currents.warnings.join("\n"), &["no drive gains"]);
}

#[test]
fn currents_need_gains_of_the_right_number() {
    let text = clean().replace("tau", "i");
    assert_says(
        &message(&text),
        &["`i1`", "no drive gains", "[drives] gains"],
    );
    let with = |gains: &[f64]| {
        let drives = Drives {
            gains: gains.to_vec().into(),
            ..Drives::default()
        };
        read_part(
            &file("log.csv", &text),
            "",
            &drives,
            &ReadOptions::default(),
        )
    };
    let tau = with(&[10.0, -2.0]).unwrap().0.tau.unwrap();
    let logged = good(&clean()).tau.unwrap();
    assert_eq!(
        (tau[0][7], tau[1][7]),
        (10.0 * logged[0][7], -2.0 * logged[1][7])
    );
    assert_says(
        &with(&[1.0]).unwrap_err().to_string(),
        &["gains has 1 entries", "need 2"],
    );
}

#[test]
fn companion_maps_names_units_and_gains() {
    let text = clean().replace("q1,q2", "pos_a,pos_b");
    let degrees = "[columns]\nq1 = { from = 'pos_a', unit = 'deg' }\n\
                   elbow = { from = 'pos_b', gain = -1 }\n";
    let file = file("log.csv", &text);
    std::fs::write(file.path.with_file_name("log.toml"), degrees).unwrap();
    let log = read_part(&file, "", &Drives::default(), &ReadOptions::default())
        .unwrap()
        .0;
    let plain = good(&clean());
    assert!((log.q[0][9] - plain.q[0][9].to_radians()).abs() < 1e-15);
    assert_eq!(log.q[1][9], -plain.q[1][9]);
}

#[test]
fn companion_that_does_not_fit_points_at_the_entry() {
    for (companion, parts) in [
        ("[columns]\nq9 = {}\n", [":2:1:", "`q9` is no column"]),
        (
            "[columns]\nq1 = { from = 'pos' }\n",
            [":2:1:", "`pos` (for q1) is not in the log"],
        ),
        (
            "[columns]\nq1 = { unit = 'mm' }\n",
            [":2:1:", "a revolute joint"],
        ),
        (
            "[columns]\ntau1 = { unit = 'deg' }\n",
            [":2:1:", "does not fit this column"],
        ),
        (
            "[columns]\nq1 = { unit = 'degrees' }\n",
            [":2:1:", "is not known; one of rad"],
        ),
    ] {
        let file = file("log.csv", clean());
        std::fs::write(file.path.with_file_name("log.toml"), companion).unwrap();
        let error = read_part(&file, "", &Drives::default(), &ReadOptions::default());
        assert_says(&error.unwrap_err().to_string(), &parts);
    }
}

#[test]
fn unit_in_the_header_counts_unless_the_companion_states_another() {
    let expected = good(&clean());
    let degrees = |header: &str| {
        log(|_, fields| {
            let q: f64 = fields[1].parse().unwrap();
            fields[1] = format!("{}", q.to_degrees());
        })
        .replacen("t,q1,q2,tau1,tau2", header, 1)
    };
    for header in [
        "t [s],q1 [deg],q2 [rad],tau1 [Nm],tau2 (N.m)",
        "T (s),Q1 (\u{b0}),q2,tau1,tau2",
    ] {
        let found = good(&degrees(header));
        let error = found.q[0]
            .iter()
            .zip(&expected.q[0])
            .map(|(a, b)| (a - b).abs());
        assert!(error.fold(0.0, f64::max) < 1e-12);
        assert_eq!((&found.q[1], &found.tau), (&expected.q[1], &expected.tau));
    }
    assert_says(
        &message(&degrees("t,q1 [N.m],q2,tau1,tau2")),
        &[
            "column `q1 [N.m]`: unit `N.m` does not fit this column; one of rad",
            "[columns]",
        ],
    );
    let file = file("log.csv", clean().replacen("q1", "q1 [raw]", 1));
    let companion = "[columns]\nq1 = { unit = 'rad' }\n";
    std::fs::write(file.path.with_file_name("log.toml"), companion).unwrap();
    let found = read_part(&file, "", &Drives::default(), &ReadOptions::default());
    assert_eq!(found.unwrap().0.q, expected.q);
}
