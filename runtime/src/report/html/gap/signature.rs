//! The residual over the variable that explains it, before and after.

use super::super::markup::{Element, el};
use super::super::panel::{Curve, Frame, Panel, drawing, label};
use super::super::scale::padded_range;
use super::super::words::{short, unit};
use crate::report::{Diagnosis, Signature};

const SIZE: (f64, f64) = (620.0, 230.0);
const LEFT: Frame = Frame {
    left: 56.0,
    top: 24.0,
    width: 240.0,
    height: 160.0,
};
const RIGHT: Frame = Frame {
    left: 372.0,
    ..LEFT
};
const WHOLE: Frame = Frame {
    width: 556.0,
    ..LEFT
};

/// Means along the variable.
const STEPS: usize = 28;

/// Dots that a mean is taken of, at least.
const FEWEST: usize = 4;

/// Share of the dots at either end of an axis that may be cut off.
const OUTLIERS: f64 = 0.003;

/// The drawing of an effect.
pub(super) fn of_effect(diagnosis: &Diagnosis, effect: usize) -> Option<Element> {
    let pictures = diagnosis.pictures.as_ref()?;
    let mut all = pictures.signatures.iter();
    let own = all.find(|signature| signature.effect == Some(effect))?;
    let range = (span_of(&[&own.x]), span_of(&[&own.before, &own.after]));
    let words = format!(
        "Residual of {} over {}, before and after",
        own.joint, own.variable
    );
    Some(
        drawing("plot", SIZE, &words)
            .child(heading(own))
            .child(panel(own, LEFT, range, ("before", &own.before)))
            .child(panel(own, RIGHT, range, ("after", &own.after))),
    )
}

/// Drawings of what has no name.
pub(super) fn unnamed(diagnosis: &Diagnosis) -> Vec<Element> {
    let all = diagnosis
        .pictures
        .iter()
        .flat_map(|pictures| &pictures.signatures);
    all.filter(|signature| signature.effect.is_none())
        .map(|own| {
            let range = (span_of(&[&own.x]), span_of(&[&own.before]));
            let words = format!("Residual of {} over {}", own.joint, own.variable);
            drawing("plot", SIZE, &words)
                .child(heading(own))
                .child(panel(own, WHOLE, range, ("before", &own.before)))
        })
        .collect()
}

fn heading(own: &Signature) -> Element {
    let name = format!("residual of {}", own.joint);
    label(LEFT.left, 15.0, "start", &short(&name, 60))
        .attr("class", "name")
        .child(el("title").text(&own.joint))
}

fn panel(
    own: &Signature,
    frame: Frame,
    (x, y): ((f64, f64), (f64, f64)),
    (class, residual): (&str, &[f32]),
) -> Element {
    let mut panel = Panel::new(frame, x, y);
    panel.dots(class, &own.x, residual);
    let (at, mean) = means(&own.x, residual, x);
    panel.curve(&Curve {
        class: &format!("{class} mean"),
        name: format!("mean {class}"),
        x: &at,
        y: &mean,
        points: STEPS + 1,
    });
    let x_title = format!("{}, {}", short(&own.variable, 30), unit(&own.variable_unit));
    let y_title = match class {
        "before" => format!("before, {}", own.unit),
        _ => class.to_owned(),
    };
    panel.finish(Some(&x_title), &y_title, &own.unit)
}

/// Means of the residual in equal steps of the variable.
fn means(x: &[f32], y: &[f32], (low, high): (f64, f64)) -> (Vec<f64>, Vec<f64>) {
    let mut steps = vec![(0.0, 0.0, 0_usize); STEPS];
    for (x, y) in x
        .iter()
        .zip(y)
        .filter(|(x, y)| x.is_finite() && y.is_finite())
    {
        let share = (f64::from(*x) - low) / (high - low);
        let step = &mut steps[((share * STEPS as f64) as usize).min(STEPS - 1)];
        *step = (step.0 + f64::from(*x), step.1 + f64::from(*y), step.2 + 1);
    }
    let filled = steps.into_iter().filter(|step| step.2 >= FEWEST);
    filled.map(|(x, y, n)| (x / n as f64, y / n as f64)).unzip()
}

/// Range of the values, without a share of them at either end, and a little wider.
fn span_of(all: &[&[f32]]) -> (f64, f64) {
    let all = all.concat();
    let finite = all.iter().filter(|value| value.is_finite());
    let mut sorted: Vec<f64> = finite.map(|value| f64::from(*value)).collect();
    sorted.sort_by(f64::total_cmp);
    let cut = (OUTLIERS * sorted.len() as f64) as usize;
    let inside = sorted.get(cut..sorted.len().saturating_sub(cut));
    padded_range(inside.unwrap_or(&[]).iter().copied())
}
