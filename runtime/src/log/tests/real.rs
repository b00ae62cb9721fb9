//! The reader on logs of real robots, kept outside the repository.

use std::path::PathBuf;

use super::super::*;
use super::{Drives, Joint, JointKind};

const UR10E_GAINS: [f64; 6] = [10.0, 10.6956, 8.4566, 9.0029, 9.48, 10.1232];

fn robot(n: usize, kind: JointKind) -> Vec<Joint> {
    (1..=n)
        .map(|j| Joint {
            name: format!("joint_{j}").into(),
            kind,
        })
        .collect()
}

/// A log under `shared`, or a note that it is not there.
fn shared(path: &str) -> Option<String> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let file = root.join(path.split('@').next().unwrap_or(path));
    if file.exists() {
        return Some(root.join(path).display().to_string());
    }
    println!("skipped: {} is absent", file.display());
    None
}

fn read_revolute(path: &str, n: usize, drives: &Drives) -> Recording {
    let joints = robot(n, JointKind::Revolute);
    let spec: LogSpec = path.parse().unwrap();
    let recording = read(&spec, &joints, drives, &ReadOptions::default())
        .unwrap()
        .0;
    println!(
        "{path}\n  {} Hz x {}: {:#?}",
        recording.rate_hz, recording.len, recording.warnings
    );
    recording
}

fn ur10e(path: &str) -> Option<Recording> {
    let drives = Drives {
        gains: UR10E_GAINS.to_vec().into(),
        ..Drives::default()
    };
    Some(read_revolute(
        &shared(&format!("data/real/ur10e/{path}"))?,
        6,
        &drives,
    ))
}

#[test]
fn emps_log_is_taken_as_it_is_with_its_reference() {
    let Some(path) = shared("data/real/emps/log_train.csv.gz") else {
        return;
    };
    let spec: LogSpec = path.parse().unwrap();
    let joints = robot(1, JointKind::Prismatic);
    let (recording, companion) =
        read(&spec, &joints, &Drives::default(), &ReadOptions::default()).unwrap();
    assert_eq!(
        (recording.rate_hz, recording.start, recording.len),
        (1000.0, 0.0, 24841)
    );
    assert_eq!(recording.q[0][..3], [7.45e-6, 1.43e-5, 2.185e-5]);
    assert_eq!(recording.tau.as_ref().unwrap()[0][1], 92.2646629);
    assert_eq!(recording.warnings, Vec::<String>::new());
    let Some(Reference::Sampled { q }) = companion.reference else {
        panic!("no reference")
    };
    assert_eq!(q[0][2], 0.00013646232);
}

#[test]
fn emps_voltage_with_a_gain_is_the_published_force() {
    let Some(path) = shared("data/real/emps/log_valid_pulses.csv.gz@..1") else {
        return;
    };
    let dir = tempfile::tempdir().unwrap();
    let map = dir.path().join("map.toml");
    std::fs::write(
        &map,
        "[columns]\ntau1 = { from = 'u1', gain = 35.15065188248547 }\n",
    )
    .unwrap();
    let joints = robot(1, JointKind::Prismatic);
    let force = |options: &ReadOptions| {
        let recording = read(&path.parse().unwrap(), &joints, &Drives::default(), options);
        recording.unwrap().0.tau.unwrap().remove(0)
    };
    let mapped = ReadOptions {
        companion: Some(map),
        ..ReadOptions::default()
    };
    let (logged, mapped) = (force(&ReadOptions::default()), force(&mapped));
    assert_eq!(logged.len(), 1000);
    // The voltage is printed with nine digits.
    for (logged, mapped) in logged.iter().zip(&mapped) {
        assert!((logged - mapped).abs() <= 1e-6 * logged.abs().max(1.0));
    }
}

#[test]
fn tx40_log_in_parts_keeps_every_sample() {
    let Some(path) = shared("data/real/staubli_tx40/log.csv.gz") else {
        return;
    };
    let whole = read_revolute(&path, 6, &Drives::default());
    assert_eq!((whole.rate_hz, whole.len), (5000.0, 45000));
    let train = read_revolute(&format!("{path}@..5"), 6, &Drives::default());
    let valid = read_revolute(&format!("{path}@5..7.5"), 6, &Drives::default());
    assert_eq!((train.len, valid.len, valid.start), (25000, 12500, 5.0));
    assert_eq!((valid.stem.as_str(), valid.rate_hz), ("log", 5000.0));
    assert_eq!(valid.q[5], whole.q[5][25000..37500]);
    assert_eq!(train.tau.unwrap()[1][1], -27.01888);
    assert!(whole.warnings.is_empty() && train.warnings.is_empty());
}

#[test]
fn tx40_motor_side_with_coupling_is_its_joint_side() {
    let Some(path) = shared("data/real/staubli_tx40/log.csv.gz@1..1.5") else {
        return;
    };
    let logged = read_revolute(&path, 6, &Drives::default());
    let dir = tempfile::tempdir().unwrap();
    let map = dir.path().join("map.toml");
    // Hiding the joint side leaves the motor side; taum1.. stand for the currents.
    let mut columns = String::from("[columns]\n");
    for j in 1..=6 {
        columns += &format!("qm{j} = {{}}\ni{j} = {{ from = 'taum{j}' }}\n");
    }
    std::fs::write(&map, columns).unwrap();
    let mut coupling = vec![0.0; 36];
    for (j, ratio) in [32.0, 32.0, 45.0, -48.0, 45.0, 32.0]
        .into_iter()
        .enumerate()
    {
        coupling[7 * j] = ratio;
    }
    coupling[5 * 6 + 4] = 32.0;
    let drives = Drives {
        gains: vec![1.0; 6].into(),
        coupling: coupling.into(),
    };
    let text = hide_joint_side(&path);
    let log = dir.path().join("motor.csv");
    std::fs::write(&log, text).unwrap();
    let options = ReadOptions {
        companion: Some(map),
        ..ReadOptions::default()
    };
    let joints = robot(6, JointKind::Revolute);
    let motor = read(&LogSpec::from(log), &joints, &drives, &options)
        .unwrap()
        .0;
    let half_turn = std::f64::consts::FRAC_PI_2;
    for (j, offset) in [0.0, -half_turn, half_turn, 0.0, 0.0, 0.0]
        .into_iter()
        .enumerate()
    {
        for k in 0..logged.len {
            assert!((motor.q[j][k] + offset - logged.q[j][k]).abs() < 1e-6);
            let (found, expected) = (
                motor.tau.as_ref().unwrap()[j][k],
                logged.tau.as_ref().unwrap()[j][k],
            );
            assert!(
                (found - expected).abs() < 1e-4,
                "joint {j}: {found} {expected}"
            );
        }
    }
}

/// The part of the TX40 log as text, with the joint-side columns renamed away.
fn hide_joint_side(path: &str) -> String {
    use std::io::Read;
    let file = std::fs::File::open(path.split('@').next().unwrap()).unwrap();
    let mut text = String::new();
    flate2::read::MultiGzDecoder::new(file)
        .read_to_string(&mut text)
        .unwrap();
    let mut lines = text.lines();
    let header = lines
        .next()
        .unwrap()
        .replace(",q", ",_q")
        .replace(",tau", ",_tau");
    let header = header.replace("_qm", "qm").replace("_taum", "taum");
    let rows: Vec<&str> = lines.skip(5000).take(2500).collect();
    format!("{header}\n{}\n", rows.join("\n"))
}

#[test]
fn ur10e_log_is_put_on_ten_milliseconds_as_the_protocol_does() {
    let Some(log) = ur10e("validation/20_01_17_ptp_10_points.csv.gz@#700..4200") else {
        return;
    };
    assert_eq!(
        (log.rate_hz, log.start, log.stamps.len()),
        (100.0, 7.462, 3500)
    );
    // len(arange(7.462, 44.858 + 0.005, 0.01))
    assert_eq!(log.len, 3741);
    assert_eq!(log.q[0][0], -0.0708);
    // Stamps 7.462, 7.472: on the grid, bit for bit.
    assert!((log.q[0][1] - -0.0651).abs() < 1e-12);
    assert!(
        log.warnings.iter().any(|w| w.contains("irregular")),
        "{:?}",
        log.warnings
    );
    assert!(log.qd.is_some());
}

#[test]
fn ur10e_logs_all_read_at_one_hundred_hertz() {
    for (path, still) in [
        ("identification/20_02_10_30sec_12harm.csv.gz@#635..3510", 0),
        ("identification/20_02_12_40sec_12harm.csv.gz", 0),
        ("identification/20_02_05_20sec_12harm.csv.gz", 0),
        ("identification/20_02_12_50sec_12harm.csv.gz", 0),
        ("identification/20_02_19_14harm50sec.csv.gz", 0),
        ("identification/20_02_19_14harm50secLoad.csv.gz", 0),
        ("identification/20_02_19_15harm50secLoad.csv.gz@#6..", 0),
        ("validation/20_01_17_p1.csv.gz", 6),
        ("collision/20_01_22_push_pose_2.csv.gz", 3),
        ("jointwise/20_01_22_joint_2.csv.gz", 4),
    ] {
        let Some(log) = ur10e(path) else { return };
        assert_eq!(log.rate_hz, 100.0, "{path}");
        let found = log
            .warnings
            .iter()
            .filter(|w| w.contains("never moves"))
            .count();
        assert_eq!(found, still, "{path}");
        let unexpected = |w: &&String| !w.contains("never moves") && !w.contains("irregular");
        assert_eq!(log.warnings.iter().find(unexpected), None, "{path}");
    }
}

#[test]
fn ur10e_log_with_a_broken_clock_says_where() {
    let Some(path) = shared("data/real/ur10e/identification/20_02_19_15harm50secLoad.csv.gz")
    else {
        return;
    };
    let drives = Drives {
        gains: UR10E_GAINS.to_vec().into(),
        ..Drives::default()
    };
    let joints = robot(6, JointKind::Revolute);
    let error = read(
        &path.parse().unwrap(),
        &joints,
        &drives,
        &ReadOptions::default(),
    );
    let message = error.unwrap_err().to_string();
    assert!(
        message.contains("from 0 s to -3047.8161 s at row 1 (line 3)"),
        "{message}"
    );
}

#[test]
fn panda_log_with_lost_cycles_is_put_on_one_millisecond() {
    let Some(path) = shared("data/real/franka_panda/log.csv.gz@9..13.2") else {
        return;
    };
    let log = read_revolute(&path, 7, &Drives::default());
    assert_eq!((log.rate_hz, log.start), (1000.0, 9.00087));
    assert_eq!(log.stamps.len(), 4058);
    // arange(9.00087, 13.1997 + 0.0005, 0.001), cut by 150 and by 20: as many as the reference has.
    assert_eq!((log.len - 300).div_ceil(20), 195);
    let [first, ..] = log.warnings.as_slice() else {
        panic!("no warnings")
    };
    assert!(
        first.contains("irregular") && first.contains("1000 Hz"),
        "{first}"
    );
}

#[test]
fn practice_log_is_read_with_its_companion() {
    let Some(path) = shared("data/hidden_effects_practice/cases/case_001/train.csv.gz") else {
        return;
    };
    let joints = robot(6, JointKind::Revolute);
    let (log, companion) = read(
        &path.parse().unwrap(),
        &joints,
        &Drives::default(),
        &ReadOptions::default(),
    )
    .unwrap();
    assert_eq!(
        (log.rate_hz, log.len, log.warnings.len()),
        (1000.0, 24000, 0)
    );
    assert_eq!(companion.encoder_resolution, Some(1.19842249e-05));
    let Some(Reference::Fourier(reference)) = companion.reference else {
        panic!("no reference")
    };
    assert_eq!(
        (reference.f0_hz, reference.periods, reference.sin[1][7]),
        (0.125, 3.0, -0.014725)
    );
    let controller = companion.controller.unwrap();
    assert_eq!(
        (controller.feedforward, controller.start),
        (Feedforward::Rigid, Start::Reference)
    );
}
