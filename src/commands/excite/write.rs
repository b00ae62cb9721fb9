//! The motion as a trajectory file, and as samples.

use std::fmt::Write;
use std::path::Path;

use idim::runtime::excite::Excitation;
use idim::runtime::log::{self, Fourier, Reference, ViaPoints};
use idim::runtime::simulate::{Grid, Trajectory};

use super::Failure;

/// The `[reference]` table, with how it was made in comments.
pub(super) fn trajectory(found: &Excitation, command: &str) -> String {
    let mut text = format!("# {command}\n# Exciting motion of {}.", found.robot);
    // Writing to a String does not fail.
    let _ = writeln!(
        text,
        " cond(W) {:.4}, with columns of unit norm {:.4}.\n[reference]",
        found.condition, found.condition_scaled
    );
    match &found.motion {
        Reference::Fourier(fourier) => of_fourier(&mut text, fourier),
        Reference::ViaPoints(points) => of_points(&mut text, points),
        Reference::Sampled { .. } => {}
    }
    text
}

fn of_fourier(text: &mut String, fourier: &Fourier) {
    let _ = writeln!(
        text,
        "kind = \"fourier\"\nf0_hz = {:?}\nperiods = {:?}\ncenter = {:?}",
        fourier.f0_hz, fourier.periods, fourier.center
    );
    rows(text, "sin", &fourier.sin);
    rows(text, "cos", &fourier.cos);
}

fn of_points(text: &mut String, points: &ViaPoints) {
    let _ = writeln!(
        text,
        "kind = \"via_points\"\nperiods = {:?}\ntimes = {:?}",
        points.periods, points.times
    );
    rows(text, "q", &points.q);
    rows(text, "qd", &points.qd);
    rows(text, "qdd", &points.qdd);
}

fn rows(text: &mut String, key: &str, rows: &[Vec<f64>]) {
    let _ = writeln!(text, "{key} = [");
    for row in rows {
        let _ = writeln!(text, "  {row:?},");
    }
    text.push_str("]\n");
}

/// t, q1_ref.., qd1_ref.., qdd1_ref.. from the start to the end of the last period.
///
/// # Errors
/// [`Failure::Simulate`] for a rate that is none, [`Failure::Log`] if the file cannot be written.
pub(super) fn samples(path: &Path, found: &Excitation, rate_hz: f64) -> Result<(), Failure> {
    let seconds = found.motion.seconds().unwrap_or(0.0);
    let grid = Grid {
        rate_hz,
        start: 0.0,
        len: (seconds * rate_hz).round() as usize + 1,
    };
    let motion = Trajectory::of(&found.motion, &grid)?;
    let t: Vec<f64> = (0..grid.len).map(|k| grid.time(k)).collect();
    let mut columns = vec![("t".to_owned(), t.as_slice())];
    let groups = [("q", &motion.q), ("qd", &motion.qd), ("qdd", &motion.qdd)];
    for (name, series) in groups {
        let named = series.iter().enumerate();
        columns
            .extend(named.map(|(j, values)| (format!("{name}{}_ref", j + 1), values.as_slice())));
    }
    let columns: Vec<(&str, &[f64])> = columns
        .iter()
        .map(|(name, values)| (name.as_str(), *values))
        .collect();
    Ok(log::write(path, &columns)?)
}
