//! URDFs written and read again.

use super::*;
use crate::builder::read_texts;
use crate::expr::Angle;
use crate::mechanism::Mechanism;

const ARM: &str = r#"<?xml version="1.0"?>
<!-- keeps its > comments -->
<robot name="arm">
  <link name="base"/>
  <link name="upper"><visual name="a > b"/>
    <inertial>
      <mass value="2"/> <!-- weighed -->
      <origin rpy="0 0.5 0" xyz="0 0 0.2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.02"/>
    </inertial>
  </link>
  <link name="lower"/>
  <link name="tool">
    <inertial><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/><mass value="0.5"/></inertial>
  </link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
  <joint name="elbow" type="continuous"><origin xyz="0 0 0.4"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint>
  <joint name="flange" type="fixed"><origin xyz="0 0 0.3" rpy="0.3 0 0"/><parent link="lower"/><child link="tool"/></joint>
</robot>
"#;

fn body(mass: f64, com: [f64; 3], j: [f64; 3]) -> Standard {
    Standard::from_urdf(&UrdfInertial {
        mass,
        origin: Pose {
            rpy: [0.1, -0.4, 0.7],
            xyz: com,
        },
        inertia: [j[0], 0.0, 0.0, j[1], 0.0, j[2]],
    })
}

fn values(mechanism: &Mechanism) -> Vec<[f64; 10]> {
    let joints = mechanism.joints.iter();
    joints.map(|joint| joint.carried().values()).collect()
}

#[test]
fn values_written_are_read_back_and_other_bytes_stay() {
    let bodies = [
        ("upper", body(3.1, [0.01, -0.02, 0.21], [0.12, 0.1, 0.03])),
        ("lower", body(1.2, [0.0, 0.03, 0.11], [0.02, 0.025, 0.01])),
        (
            "tool",
            body(0.7, [0.001, 0.0, 0.04], [0.002, 0.0021, 0.001]),
        ),
    ];
    let wanted: Vec<(String, UrdfInertial)> = bodies
        .iter()
        .map(|(name, body)| ((*name).to_owned(), inertial(body)))
        .collect();
    let text = rewrite(ARM, &wanted).unwrap();
    for kept in [
        "<!-- keeps its > comments -->",
        "<visual name=\"a > b\"/>",
        "<!-- weighed -->",
        "<link name=\"base\"/>",
        "<parent link=\"lower\"/><child link=\"tool\"/></joint>",
    ] {
        assert!(text.contains(kept), "{kept}\n{text}");
    }
    let robot = read_texts(&[("arm.urdf", text.as_str())]).unwrap();
    let [upper, rest] = &robot.mechanism.joints[..] else {
        panic!("two joints");
    };
    for (found, (name, body)) in upper.bodies.iter().chain(&rest.bodies).zip(&bodies) {
        assert_eq!(found.name, *name);
        let wanted = body.moved(&found.pose).values();
        for (a, b) in found.inertial.unwrap().values().iter().zip(wanted) {
            assert!((a - b).abs() < 1e-14, "{name}: {a} {b}");
        }
    }
    // What is written is written again to the byte.
    assert_eq!(rewrite(&text, &wanted).unwrap(), text);
}

#[test]
fn friction_goes_into_dynamics_and_other_bytes_stay() {
    let text = ARM.replace(
        "<joint name=\"elbow\" type=\"continuous\">",
        "<joint name=\"elbow\" type=\"continuous\"><dynamics friction='0.5' spring=\"1\"/>",
    );
    let both = |damping, friction| Dynamics { damping, friction };
    let wanted = [
        ("shoulder".to_owned(), both(Some(2.5), Some(0.0))),
        ("elbow".to_owned(), both(Some(1e-7), Some(0.75))),
    ];
    let written = with_dynamics(&text, &wanted).unwrap();
    assert_eq!(dynamics(&written).unwrap(), wanted);
    // Taken out again, it is the text before.
    let before = written
        .replace("\n    <dynamics damping=\"2.5\" friction=\"0\"/>", "")
        .replace("friction='0.75'", "friction='0.5'")
        .replace(" damping=\"0.0000001\"/>", "/>");
    assert_eq!(before, text);
    // What is not stated stays.
    let damping = [("elbow".to_owned(), both(Some(3.0), None))];
    let written = with_dynamics(&text, &damping).unwrap();
    assert!(written.contains("<dynamics friction='0.5' spring=\"1\" damping=\"3\"/>"));
    assert_eq!(with_dynamics(&text, &[]).unwrap(), text);
    let other = [("wrist".to_owned(), both(Some(3.0), None))];
    assert_eq!(
        with_dynamics(&text, &other),
        Err(UrdfError::Joint("wrist".into()))
    );
}

#[test]
fn link_that_is_not_there_and_text_that_is_no_xml_are_errors() {
    let some = inertial(&body(1.0, [0.0; 3], [0.1; 3]));
    let unknown = rewrite(ARM, &[("arm3".into(), some)]);
    assert_eq!(unknown, Err(UrdfError::Link("arm3".into())));
    assert!(matches!(rewrite("<robot", &[]), Err(UrdfError::Xml(_))));
}

#[test]
fn fresh_urdf_is_the_robot_in_its_own_frames() {
    let description = r#"
name = "tilted"
gravity = [3.0, 0.0, -9.34]
[[joint]]
name = "one"
kind = "revolute"
ant = 0
alpha = "-pi/2"
r = 0.3
[[joint]]
name = "slide"
kind = "prismatic"
ant = 1
alpha = 0.4
d = 0.2
theta = 0.7
[[joint]]
name = "two"
kind = "revolute"
ant = 1
gamma = 0.5
alpha = "pi/2"
d = 0.1
b = 0.15
"#;
    let robot = read_texts(&[("tilted.toml", description)]).unwrap();
    let bodies = [
        body(3.1, [0.01, -0.02, 0.21], [0.12, 0.1, 0.03]),
        body(1.2, [0.0, 0.03, 0.11], [0.02, 0.025, 0.01]),
        body(0.7, [0.001, 0.0, 0.04], [0.002, 0.0021, 0.001]),
    ];
    let text = fresh(&robot.mechanism, &bodies);
    let read = read_texts(&[("tilted.urdf", text.as_str())]).unwrap();
    let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    for (a, b) in read.mechanism.joints.iter().zip(&robot.mechanism.joints) {
        assert_eq!(a.kind, b.kind);
        assert_eq!(a.parent, b.parent);
        assert!(
            close(&a.position, &b.position),
            "{}: {:?} {:?}",
            a.name,
            a.position,
            b.position
        );
        let angles = |j: &crate::mechanism::Joint| [j.gamma, j.alpha, j.theta].map(Angle::value);
        assert!(
            close(&angles(a), &angles(b)),
            "{}: {:?} {:?}",
            a.name,
            angles(a),
            angles(b)
        );
    }
    for (a, b) in values(&read.mechanism).iter().zip(&bodies) {
        assert!(close(a, &b.values()));
    }
}
