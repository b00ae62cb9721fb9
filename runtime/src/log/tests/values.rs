//! Values: numbers that are none, joints at rest, wrong units, clipped torque.

use super::*;

#[test]
fn number_that_is_none_is_located() {
    let text = log(|row, fields| {
        if row == 17 {
            fields[2] = "1.2.3".into();
        }
    });
    assert_says(
        &message(&text),
        &["row 16 (line 18), column `q2`: `1.2.3` is not a number"],
    );
    let comma = log(|row, fields| {
        if row == 3 {
            fields[2] = "1,5".into();
        }
    });
    assert_says(
        &message(&comma),
        &["row 2 (line 4) has 6 fields, the header has 5"],
    );
}

#[test]
fn values_that_are_not_finite_are_bridged_and_located_and_many_are_refused() {
    let clean = good(&clean());
    let names = ["position", "position", "torque", "torque"];
    for (value, column) in [("NaN", 1), ("", 2), ("inf", 3), ("-Infinity", 4)] {
        let text = |rows: &[usize]| {
            log(|row, fields| {
                if rows.contains(&row) {
                    fields[column] = value.into();
                }
            })
        };
        let bridged = good(&text(&[5, 6, 100, 150]));
        let said = format!(
            "{} is no number in 4 rows (4 to 5, 99, 149)",
            names[column - 1]
        );
        assert_says(&bridged.warnings.join("\n"), &[&said]);
        assert_eq!(bridged.doubtful, [3..7, 98..101, 148..151]);
        let error = |a: &[Vec<f64>], b: &[Vec<f64>]| {
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(error(&bridged.q, &clean.q) < 1e-3);
        assert!(error(&bridged.tau.unwrap(), clean.tau.as_ref().unwrap()) < 0.1);
        let many: Vec<usize> = (1..=200).step_by(7).collect();
        assert_says(
            &message(&text(&many)),
            &["values missing, NaN or infinite: 29", "0, 7, 14, ..."],
        );
    }
    let text = log(|row, fields| {
        if row == 50 {
            fields[0] = "nan".into();
        }
    });
    assert_says(
        &message(&text),
        &["column `t`: values missing, NaN or infinite: 1", "row 49"],
    );
}

#[test]
fn joint_that_rests_is_named_with_its_parameters() {
    let log = good(&log(|_, fields| fields[2] = "0.3".into()));
    assert_says(
        &log.warnings.join("\n"),
        &["Joint 2 (`elbow`) never moves", "FV2, FS2, IA2"],
    );
}

#[test]
fn torque_that_is_clipped_is_found_with_its_place() {
    let log = good(&log(|_, fields| {
        let tau: f64 = fields[3].parse().unwrap();
        fields[3] = format!("{}", tau.clamp(-5.0, 5.0));
    }));
    assert_says(
        &log.warnings.join("\n"),
        &[
            "Joint 1 (`shoulder`): the torque is clipped at -5 and 5 in 93 rows (16 to 46, ",
            "left out",
        ],
    );
    let dead = good(&self::log(|_, fields| fields[4] = "0".into()));
    assert_says(
        &dead.warnings.join("\n"),
        &["Joint 2", "its channel is dead"],
    );
}

/// The clean log with measured velocities, and q and qd multiplied.
fn with_speed(q_factor: f64, qd_factor: f64) -> Recording {
    let mut text = clean().replace("q1,q2", "q1,q2,qd1,qd2");
    let rows: Vec<String> = text
        .lines()
        .skip(1)
        .map(|line| {
            let v: Vec<f64> = line
                .split(',')
                .map(|field| field.parse().unwrap())
                .collect();
            let (qd1, qd2) = (1.5 * (3.0 * v[0]).cos(), -2.0 * (2.0 * v[0]).sin());
            let [q1, q2] = [v[1], v[2]].map(|q| q * q_factor);
            format!(
                "{},{q1},{q2},{},{},{},{}",
                v[0],
                qd1 * qd_factor,
                qd2 * qd_factor,
                v[3],
                v[4]
            )
        })
        .collect();
    text.truncate(text.find('\n').unwrap() + 1);
    good(&(text + &rows.join("\n")))
}

#[test]
fn unit_that_is_wrong_shows_against_the_velocity() {
    let degrees = std::f64::consts::PI.recip() * 180.0;
    assert_eq!(with_speed(1.0, 1.0).warnings, Vec::<String>::new());
    for (log, part) in [
        (with_speed(degrees, 1.0), "q was taken to be in deg;"),
        (with_speed(1.0, degrees), "qd was taken to be in deg/s;"),
        (with_speed(1.0, -1.0), "opposite signs"),
        (with_speed(1.0, 1e-3), "do not belong together"),
        (with_speed(degrees, degrees), ""),
    ] {
        assert_says(&log.warnings.join("\n"), &[part]);
    }
}
