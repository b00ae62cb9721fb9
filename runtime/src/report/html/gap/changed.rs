//! What has changed on a robot whose parameters are known, and when something touched it.

use super::super::figure;
use super::super::markup::{Element, classed, el};
use super::super::panel::{drawing, label, px};
use super::super::scale::{Scale, round_range};
use super::super::words::number;
use crate::report::{Changed, Contact, Diagnosis, changed};

/// Width of the drawing, of what stands right of it and of the names, pixels.
const WIDTH: f64 = 660.0;
const RIGHT: f64 = 70.0;
const NAMES: f64 = 150.0;

/// Height of a joint's line, pixels.
const LINE: f64 = 18.0;

/// What has changed; `None` where parameters are not known, or nothing has.
pub(super) fn section(diagnosis: &Diagnosis) -> Option<Element> {
    let known = diagnosis
        .changed
        .as_ref()
        .filter(|known| !known.is_empty())?;
    let lines = changed::lines(known).into_iter();
    let lines = lines.map(|line| el("li").text(line));
    let logs = known.contacts.chunk_by(|a, b| a.log == b.log);
    let caption = "When each joint\u{2019}s torque is beyond what the known model allows: while it moves, \
                   the model\u{2019}s torque; at rest, anything that its friction can hold. Beside each \
                   stretch the largest torque beyond that.";
    Some(
        el("section")
            .child(el("h2").text("What has changed"))
            .child(el("ul").children(lines))
            .children(logs.map(|contacts| figure([timeline(contacts)], caption)))
            .child(against(known)),
    )
}

fn against(known: &Changed) -> Element {
    el("p").text(format!(
        "Against the parameters of {}, which stay as they are.",
        known.against
    ))
}

/// Contacts of one log over time, a line for each joint that feels one.
fn timeline(contacts: &[Contact]) -> Element {
    let mut joints: Vec<(usize, &str)> = Vec::new();
    for touched in contacts.iter().flat_map(|contact| &contact.joints) {
        joints.push((touched.number, &touched.joint));
    }
    joints.sort_unstable();
    joints.dedup();
    let ends = contacts.iter().flat_map(|c| [c.from_s, c.to_s]);
    let x = Scale::linear(round_range(ends, 6), (NAMES, WIDTH - RIGHT));
    let bottom = 6.0 + LINE * joints.len() as f64;
    let mut marks = Vec::new();
    for tick in x.ticks(6) {
        let at = px(x.at(tick.value));
        marks.push(classed("path", "grid").attr("d", format!("M{at} 2V{}", px(bottom))));
        marks.push(label(at, bottom + 13.0, "middle", &tick.label));
    }
    let middle = (NAMES + WIDTH - RIGHT) / 2.0;
    marks.push(label(middle, bottom + 27.0, "middle", "time of the log, s").attr("class", "axis"));
    for (place, (number, name)) in joints.iter().enumerate() {
        let top = 6.0 + LINE * place as f64;
        marks.push(label(NAMES - 8.0, top + 12.0, "end", name).attr("class", "name"));
        let own = contacts
            .iter()
            .flat_map(|contact| felt(contact, *number, (&x, top)));
        marks.extend(own);
    }
    let words = "When each joint feels contact";
    drawing("bars", (WIDTH, bottom + 30.0), words).children(marks)
}

/// A joint's bar during a contact.
fn felt(contact: &Contact, joint: usize, (x, top): (&Scale, f64)) -> Vec<Element> {
    let touched = contact
        .joints
        .iter()
        .find(|touched| touched.number == joint);
    let Some(touched) = touched else {
        return Vec::new();
    };
    let (from, to) = (x.at(contact.from_s), x.at(contact.to_s));
    let torque = format!("{} {}", number(touched.torque, 2), touched.unit);
    let title = format!(
        "{}: {torque} from {} to {} s",
        touched.joint,
        number(contact.from_s, 4),
        number(contact.to_s, 4)
    );
    let bar = classed("rect", "bar before")
        .attr("x", px(from))
        .attr("y", px(top + 2.0))
        .attr("width", px((to - from).max(1.0)))
        .attr("height", LINE - 4.0)
        .child(el("title").text(title));
    vec![
        bar,
        label(to + 3.0, top + 12.0, "start", &torque).attr("class", "before"),
    ]
}
