//! What every target does with a text: read it as a description and, for some of those that are
//! one, derive the robot.

use idim_codegen::Robot;
use idim_codegen::describe::{Description, EffectSpec, Geometry, Kind, Motion, read_text};

/// The URDF that a companion names, whatever it calls it.
const ARM: &str = r#"<robot name="arm"><link name="base"/><link name="upper"><inertial>
<mass value="1.5"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/></inertial>
</link><link name="tool"/><joint name="shoulder" type="revolute"><parent link="base"/>
<child link="upper"/><axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1" effort="10" velocity="2"/>
</joint><joint name="mount" type="fixed"><parent link="upper"/><child link="tool"/></joint></robot>"#;

/// Moving joints and effects beyond which deriving a robot takes too long for a fuzzer.
const JOINTS: usize = 4;
const EFFECTS: usize = 24;

/// Reads the text; of the valid ones every eighth, by its hash, goes on to the base parameters.
///
/// # Panics
/// When the readers break a promise: errors without a message, values that are not finite.
pub fn follow(text: &[u8], kind: Kind) {
    let Ok(text) = std::str::from_utf8(text) else {
        return;
    };
    match read_text(text, "fuzzed", kind, &|_| Ok(ARM.to_owned())) {
        Err(errors) => {
            assert!(!errors.is_empty(), "refused without a word");
            assert!(errors.iter().all(|one| !one.message.is_empty()));
        }
        Ok(description) => derive(description),
    }
}

fn derive(description: Description) {
    assert!(description.gravity.iter().all(|g| g.is_finite()));
    let effects: &Vec<EffectSpec> = &description.effects;
    let chosen = description.hash.starts_with(['0', '1']);
    if !chosen || joints(&description) > JOINTS || effects.len() > EFFECTS {
        return;
    }
    // An unclear rank is an answer too.
    if let Ok(robot) = Robot::new(description) {
        for parameter in &robot.base.parameters {
            let finite = parameter.relation.iter().all(|(factor, _)| factor.is_finite());
            assert!(finite, "{}: {}", parameter.name, parameter.text);
        }
    }
}

fn joints(description: &Description) -> usize {
    let moves = |motion: Motion| motion != Motion::Fixed;
    match &description.geometry {
        Geometry::Urdf(tree) => tree.joints.iter().filter(|j| moves(j.motion)).count(),
        Geometry::Mdh(rows) => rows.iter().filter(|row| moves(row.motion)).count(),
    }
}
