//! What is exported, for people.

use std::fmt::Write;

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{Frame, Link, Parameter, Report};

/// A parameter that moved by more standard deviations than this is listed.
const MOVED: f64 = 2.0;

/// What moves with a joint from its ten parameters.
pub(super) fn link(joint: &str, values: &[f64; 10]) -> Link {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = *values;
    let com = Vector3::new(mx, my, mz) / mass;
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let steiner = Matrix3::identity() * com.dot(&com) - com * com.transpose();
    let mut moments: [f64; 3] = (inertia - mass * steiner).symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    Link {
        joint: joint.to_owned(),
        mass,
        center_of_mass: com.into(),
        principal_moments: moments,
        standard: *values,
    }
}

/// The table of links, and the parameters that had to give way.
pub(super) fn text(report: &Report) -> String {
    let mut text = format!(
        "{}: bodies that exist, nearest to what was identified\n\n",
        report.robot
    );
    let width = report
        .links
        .iter()
        .map(|l| l.joint.len())
        .max()
        .unwrap_or(0)
        .max(5);
    let _ = writeln!(
        text,
        "  {:width$}  {:>9}  {:>27}  {:>30}",
        "joint", "mass, kg", "centre of mass, m", "principal moments, kg m^2"
    );
    for link in &report.links {
        let [x, y, z] = link.center_of_mass;
        let [a, b, c] = link.principal_moments;
        let _ = writeln!(
            text,
            "  {:width$}  {:>9.4}  {x:>8.4} {y:>8.4} {z:>8.4}   {a:>9.3e} {b:>9.3e} {c:>9.3e}",
            link.joint, link.mass
        );
    }
    let others = report
        .others
        .iter()
        .map(|o| format!("{} {:.4}", o.name, o.value));
    let others: Vec<String> = others.collect();
    if !others.is_empty() {
        let _ = writeln!(text, "\n  {}", wrapped(&others));
    }
    let count = report.parameters.len();
    let _ = writeln!(
        text,
        "\n  {:.1} standard deviations from the identified parameters, {count} of them together",
        report.distance.max(0.0).sqrt()
    );
    text.push_str(&moved(&report.parameters));
    text.push_str(&frames(&report.frames));
    for dynamics in &report.dynamics {
        let value = |value: Option<f64>| value.map_or("as it was".into(), |v| format!("{v:.4}"));
        let _ = writeln!(
            text,
            "  {}: damping {}, friction {}",
            dynamics.joint,
            value(dynamics.damping),
            value(dynamics.friction)
        );
    }
    for warning in &report.warnings {
        let _ = writeln!(text, "  {warning}");
    }
    text
}

/// Words in lines of about a terminal's width.
fn wrapped(words: &[String]) -> String {
    let mut lines = String::new();
    let mut length = 0;
    for (k, word) in words.iter().enumerate() {
        let part = if k == 0 {
            word.clone()
        } else {
            format!(", {word}")
        };
        if length + part.len() > 88 {
            lines.push_str(",\n  ");
            lines.push_str(word);
            length = word.len();
        } else {
            length += part.len();
            lines.push_str(&part);
        }
    }
    lines
}

/// Parameters that no bodies have together with all others.
fn moved(parameters: &[Parameter]) -> String {
    let away = |p: &Parameter| {
        let sigma = p.sigma.filter(|sigma| *sigma > 0.0)?;
        Some((p.exported - p.identified) / sigma)
    };
    let mut text = String::new();
    for parameter in parameters {
        let Some(by) = away(parameter).filter(|by| by.abs() > MOVED) else {
            continue;
        };
        if text.is_empty() {
            text.push_str("  No bodies have all of them; these gave way:\n");
        }
        let _ = writeln!(
            text,
            "    {:6} {:>12.6} -> {:>12.6} {:8} ({by:+.1} sigma)",
            parameter.name, parameter.identified, parameter.exported, parameter.unit
        );
    }
    text
}

/// Where the URDF puts its link frames.
fn frames(frames: &[Frame]) -> String {
    let mut text = String::new();
    if frames.is_empty() {
        return text;
    }
    text.push_str("  The URDF has its link frames elsewhere; the bodies went there:\n");
    for frame in frames {
        let turn = Matrix3::from_fn(|i, k| frame.rotation[i][k]);
        let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(turn).euler_angles();
        // Rounded before it is written: no zero has a sign.
        let round = |x: f64| (x * 1e4).round() / 1e4 + 0.0;
        let [x, y, z] = frame.xyz.map(round);
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(round);
        let sign = if frame.sign < 0.0 { "-" } else { " " };
        let _ = writeln!(
            text,
            "    {}: xyz {x:.4} {y:.4} {z:.4} rpy {roll:.4} {pitch:.4} {yaw:.4}, q_urdf = {sign}q {:+.4}",
            frame.joint,
            round(frame.zero)
        );
    }
    text
}
