//! The catalogue as a text for people: `docs/effects.md`.

use std::fmt::Write;

use idim_runtime::diagnose::{Entry, EntryKind};

use super::entries;

const HEAD: &str = "\
# The catalogue of effects

What a robot can have that its model has not, by the names that `idim diagnose` prints, that `--json` writes and that
`[[effect]]` of a description reads (those that a description can ask for). `idim diagnose --list` prints the same.

Torque balance at joint j, positive as the drive pushes:

    tau_j = [rigid body + rotor inertia](q, qd, qdd) + FV qd_j + FS sgn(qd_j) + OFF + sum of the effects' torques

`tau_m` is the torque that the present model predicts from the motion, `tau_rigid` its rigid-body part with the rotor
inertias; a measured torque never enters a column. Near rest, inside the dead band that the encoder's resolution and the
filter leave, `sgn` is interpolated. Linear parameters are estimated with everything else; shape parameters enter
non-linearly and are searched. Units are those of a revolute joint; a prismatic one has N for N m and m for rad.

Each picture is the effect's torque along one motion of a small arm over the variable that shows it, from the columns that
the diagnosis uses (`cargo run --example effect_pictures`).

An effect that base parameters can hide shows only against what is known: described values with tolerances (`[prior]`),
a nominal model, a known mass. Without any of it it is said to be undecidable on the log, never found.
";

/// The text of `docs/effects.md`: one section per entry.
pub fn guide() -> String {
    let mut text = HEAD.to_owned();
    for (kind, title) in [
        (EntryKind::Static, "Static: of the instantaneous state"),
        (
            EntryKind::ModelDependent,
            "Of the model's own torque: rebuilt after each refit",
        ),
        (EntryKind::Memory, "With memory: a state runs along the log"),
        (
            EntryKind::Yielding,
            "With memory, and links that move against their drives",
        ),
    ] {
        let _ = write!(text, "\n## {title}\n");
        let all = entries();
        all.iter()
            .filter(|entry| entry.kind == kind)
            .for_each(|entry| section(&mut text, entry));
    }
    text
}

fn section(text: &mut String, entry: &Entry) {
    let names = |list: &[(&str, &str)]| -> String {
        let with_unit = list.iter().map(|(name, unit)| format!("{name} ({unit})"));
        with_unit.collect::<Vec<_>>().join(", ")
    };
    let _ = write!(text, "\n### `{}`\n\n", entry.name);
    let _ = writeln!(text, "{}.\n", sentence(entry.meaning));
    let _ = writeln!(text, "    {}\n", entry.formula);
    let _ = writeln!(text, "![signature](effects/{}.svg)\n", entry.name);
    let _ = writeln!(text, "- parameters: {}", names(entry.parameters));
    if !entry.shape.is_empty() {
        let _ = writeln!(text, "- shape: {}", names(entry.shape));
    }
    let _ = writeln!(
        text,
        "- often taken for: {}",
        entry.confused_with.join(", ")
    );
    let _ = writeln!(text, "- what separates them: {}", entry.experiment);
    if entry.hidden_by_parameters {
        let _ = writeln!(text, "- base parameters can hide it");
    }
}

fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
