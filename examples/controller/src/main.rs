//! A controller that knows its robot: `robots/arm.urdf` becomes straight-line code in `build.rs`,
//! and a loop of 1 kHz calls it. `cargo run -p controller` runs it for a second.

use std::time::{Duration, Instant};

mod arm {
    #![allow(dead_code, reason = "of a robot's module a program uses a part")]
    #![allow(missing_docs, clippy::all, reason = "generated")]
    idim_runtime::include_robot!("arm");
}

/// One turn of the loop.
const PERIOD: Duration = Duration::from_millis(1);

/// Seconds that the loop runs.
const SECONDS: f64 = 1.0;

/// Joint by joint, rad, N m.
type Joints = [f64; arm::JOINTS];

fn main() {
    print_columns();
    let parameters = known_parameters();
    let start = Instant::now();
    let mut slowest = Duration::ZERO;
    for tick in 0..(SECONDS / PERIOD.as_secs_f64()) as u32 {
        let due = start + tick * PERIOD;
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
        let begun = Instant::now();
        let [q, qd, qdd] = reference(f64::from(tick) * PERIOD.as_secs_f64());
        let tau = feedforward(q, qd, qdd, &parameters);
        slowest = slowest.max(begun.elapsed());
        if tick % 250 == 0 {
            println!(
                "{:5.2} s  tau = {tau:8.3?} N m",
                start.elapsed().as_secs_f64()
            );
        }
    }
    println!("slowest turn: {slowest:?} of {PERIOD:?}");
}

/// The torque that the model asks for, tau = D(q, qd, qdd) X. Everything lies on the stack.
fn feedforward(q: Joints, qd: Joints, qdd: Joints, x: &[f64; arm::PARAMETERS]) -> Joints {
    let state = arm::State::new(q, qd, qdd);
    // Entries that are always zero are never written.
    let mut d = [[0.0; arm::PARAMETERS]; arm::JOINTS];
    arm::explicit(&state, &mut d);
    d.map(|row| row.iter().zip(x).map(|(d, x)| d * x).sum())
}

/// What the URDF says of the parameters. What it cannot say (friction, rotor inertias) counts as
/// zero until it is identified from a log.
fn known_parameters() -> [f64; arm::PARAMETERS] {
    std::array::from_fn(|column| match arm::KNOWLEDGE.rigid.get(column) {
        Some(value) => *value,
        None => 0.0,
    })
}

/// The table of columns: what X is made of.
fn print_columns() {
    for column in &arm::COLUMNS {
        let joint = &arm::JOINT_TABLE[column.joint - 1].name;
        println!(
            "{:6} {:10} {joint:10} {}",
            column.name, column.unit, column.relation
        );
    }
}

/// A slow wave about a pose, with its derivatives.
fn reference(t: f64) -> [Joints; 3] {
    let center = [0.0, 0.8, -0.6];
    let amplitude = [0.4, 0.3, 0.5];
    let w = 2.0 * std::f64::consts::PI * 0.5;
    let (s, c) = (w * t).sin_cos();
    [
        std::array::from_fn(|joint| center[joint] + amplitude[joint] * s),
        amplitude.map(|a| a * w * c),
        amplitude.map(|a| -a * w * w * s),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At rest with the arm stretched out level, the weights have the levers of the URDF.
    #[test]
    fn stretched_arm_at_rest_is_held_against_its_weight() {
        let rest = [0.0; arm::JOINTS];
        let tau = feedforward(rest, rest, rest, &known_parameters());
        let elbow = 1.1 * 0.11 + 0.3 * 0.3;
        let shoulder = 2.4 * 0.16 + 1.1 * (0.35 + 0.11) + 0.3 * (0.35 + 0.3);
        let expected = [0.0, 9.81 * shoulder, 9.81 * elbow];
        for (tau, expected) in tau.iter().zip(expected) {
            assert!(
                (tau - expected).abs() < 1e-12,
                "{tau} instead of {expected}"
            );
        }
    }
}
