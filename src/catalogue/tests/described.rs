//! Named effects as descriptions have them.

use idim_codegen::builder;
use idim_codegen::robot::Output;
use idim_runtime::diagnose::Catalogue;

use super::arm::{Course, PLAIN};
use crate::catalogue::{Effects, toml};

#[test]
fn what_is_written_is_read_back_and_has_the_columns_of_the_catalogue() {
    let robot = PLAIN.robot();
    let effects = Effects::new(&robot);
    let course = Course::of(&robot);
    let mut names = Vec::new();
    for hypothesis in effects.hypotheses(&course.signals()) {
        let shape = &hypothesis.grid[0];
        let specs = effects.described(&hypothesis, shape);
        let entry = &effects.entries()[hypothesis.entry];
        if specs.is_empty() || names.contains(&entry.name) {
            continue;
        }
        names.push(entry.name);
        // Read back from its text it is the same effect.
        let text = format!(
            "name = \"probe\"\n[[joint]]\nname = \"yaw\"\nkind = \"revolute\"\n\
             [[joint]]\nname = \"pitch\"\nkind = \"revolute\"\nd = 0.3\n\
             [[joint]]\nname = \"elbow\"\nkind = \"revolute\"\nd = 0.3\n\
             [[joint]]\nname = \"roll\"\nkind = \"revolute\"\nd = 0.3\n{}",
            toml(&specs)
        );
        let read = builder::read_texts(&[("probe.toml", &text)]).unwrap();
        let tail = &read.description.effects[read.description.effects.len() - specs.len()..];
        for (read, written) in tail.iter().zip(&specs) {
            assert_eq!((read.kind, &read.joints), (written.kind, &written.joints));
            assert_eq!(read.shape, written.shape, "{}", entry.name);
        }
        // The extended robot has as many parameters more as the effect has columns of its own.
        let extended = effects.extended(&specs).unwrap();
        let more = extended.base.parameters.len() - robot.base.parameters.len();
        assert!(
            more >= 1 && more <= entry.parameters.len(),
            "{}",
            entry.name
        );
        assert!(!extended.entries(Output::Explicit).is_empty());
    }
    let expected = [
        "viscous_asymmetry",
        "stribeck",
        "nonlinear_viscous",
        "position_dependent_friction",
        "torque_ripple",
        "spring",
        "end_stop",
        "transmission_coupling",
        "presliding",
    ];
    assert_eq!(names, expected);
}
