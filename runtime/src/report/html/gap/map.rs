//! A torque that has no name as a map over two variables.

use super::super::markup::{Element, classed, el};
use super::super::panel::{Frame, Panel, drawing, label, px};
use super::super::words::{number, percent, short, unit};
use crate::report::{Diagnosis, Smooth};

const SIZE: (f64, f64) = (620.0, 300.0);
const FRAME: Frame = Frame {
    left: 56.0,
    top: 40.0,
    width: 556.0,
    height: 210.0,
};

/// Cells of a map across and up.
const CELLS: (usize, usize) = (64, 32);

/// The maps with a line each that says what they explain.
pub(super) fn maps(diagnosis: &Diagnosis) -> Vec<Element> {
    diagnosis.smooths.iter().map(map).collect()
}

fn map(smooth: &Smooth) -> Element {
    let [x, y] = &smooth.variables;
    let words = format!("Torque of {} over {} and {}", smooth.joint, x.name, y.name);
    let ends = |at: &[f64]| {
        (
            at.first().copied().unwrap_or(0.0),
            at.last().copied().unwrap_or(1.0),
        )
    };
    let mut panel = Panel::new(FRAME, ends(&x.at), ends(&y.at));
    let torques = smooth.torque.iter().flatten().flatten();
    let largest = torques.fold(0.0, |top: f64, torque| top.max(torque.abs()));
    for column in 0..CELLS.0 {
        for row in 0..CELLS.1 {
            if let Some(cell) = cell(smooth, &panel, (column, row), largest) {
                panel.mark(cell);
            }
        }
    }
    // The frame is less high than wide.
    let title = |name: &str, most: usize, of: &str| format!("{}, {}", short(name, most), unit(of));
    let (x_title, y_title) = (title(&x.name, 34, &x.unit), title(&y.name, 22, &y.unit));
    let range = format!(
        "{}: torque from \u{2212}{} {u} (blue) to {} {u} (orange)",
        short(&smooth.joint, 40),
        number(largest, 3),
        number(largest, 3),
        u = smooth.unit
    );
    drawing("plot", SIZE, &words)
        .child(
            label(FRAME.left, 15.0, "start", &range)
                .attr("class", "name")
                .child(el("title").text(&smooth.joint)),
        )
        .child(label(FRAME.left, 31.0, "start", &explained(smooth)))
        .child(panel.finish(Some(&x_title), &y_title, &y.unit))
}

/// What it explains, in words.
fn explained(smooth: &Smooth) -> String {
    let proven = smooth.proven_pct.map_or(String::new(), |share| {
        format!(", {} on data that were not used", percent(share))
    });
    format!(
        "explains {} of what is left on blocks that were left out{proven}",
        percent(smooth.explained_pct)
    )
}

/// A cell where the log was.
fn cell(
    smooth: &Smooth,
    panel: &Panel,
    (column, row): (usize, usize),
    largest: f64,
) -> Option<Element> {
    let ((x0, x1), (y0, y1)) = (panel.x.range(), panel.y.range());
    let (wide, high) = ((x1 - x0) / CELLS.0 as f64, (y1 - y0) / CELLS.1 as f64);
    let (left, low) = (x0 + column as f64 * wide, y0 + row as f64 * high);
    let torque = smooth.torque_at([left + 0.5 * wide, low + 0.5 * high])?;
    let (width, height) = (FRAME.width / CELLS.0 as f64, FRAME.height / CELLS.1 as f64);
    let class = if torque < 0.0 {
        "cell below"
    } else {
        "cell above"
    };
    let share = (torque.abs() / largest.max(f64::MIN_POSITIVE)).min(1.0);
    Some(
        classed("rect", class)
            .attr("x", px(panel.x.at(left)))
            .attr("y", px(panel.y.at(low + high)))
            .attr("width", px(width + 0.3))
            .attr("height", px(height + 0.3))
            .attr("opacity", format!("{share:.2}")),
    )
}
