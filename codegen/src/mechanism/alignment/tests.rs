//! Descriptions of one robot with frames put elsewhere, and of robots that are not one.

use nalgebra::{Rotation3, Vector3};

use super::*;
use crate::describe;

const ARM: &str = r#"
name = "arm"
[[joint]]
name = "turn"
kind = "revolute"
theta = 0.3
r = 0.31
[[joint]]
name = "shoulder"
kind = "revolute"
alpha = "-pi/2"
d = 0.15
r = 0.05
[[joint]]
name = "elbow"
kind = "revolute"
d = 0.42
theta = -1.1
[[joint]]
name = "reach"
kind = "prismatic"
alpha = 1.2
d = 0.07
r = 0.2
theta = 0.4
[[joint]]
name = "roll"
kind = "revolute"
alpha = 0.0
[[joint]]
name = "bend"
kind = "revolute"
alpha = "pi/2"
[[joint]]
name = "flange"
kind = "revolute"
alpha = "-pi/2"
r = 0.11
"#;

fn mechanism(file: &str, text: &str) -> Mechanism {
    let nothing = |_: &str| Err(String::new());
    let kind = describe::kind_of(file.as_ref(), text).unwrap();
    Mechanism::new(&describe::read_text(text, file, kind, &nothing).unwrap())
}

/// A frame elsewhere: height along the axis, m, turn as roll, pitch and yaw, zero, sign.
struct Elsewhere {
    height: f64,
    rpy: [f64; 3],
    zero: f64,
    sign: f64,
}

fn drawn(generator: &mut Pcg64Mcg, joints: usize) -> Vec<Elsewhere> {
    let mut unit = || (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    let mut one = |_| Elsewhere {
        height: 0.2 * unit(),
        rpy: [3.0 * unit(), 1.5 * unit(), 3.0 * unit()],
        zero: 2.0 * unit(),
        sign: if unit() < 0.0 { -1.0 } else { 1.0 },
    };
    (0..joints).map(&mut one).collect()
}

/// A URDF of the mechanism with its frames elsewhere; a joint's axis goes through its origin.
fn urdf(own: &Mechanism, base: &Pose, elsewhere: &[Elsewhere]) -> String {
    let mut frames: Vec<Pose> = Vec::new();
    let mut text = String::from("<robot name=\"other\"><link name=\"base\"/>");
    for (index, (joint, put)) in own.joints.iter().zip(elsewhere).enumerate() {
        let turn = Rotation3::from_euler_angles(put.rpy[0], put.rpy[1], put.rpy[2]).into_inner();
        let frame = Pose {
            rotation: turn,
            translation: Vector3::new(0.0, 0.0, put.height),
        };
        let before = joint.parent.map_or(*base, |parent| frames[parent]);
        let start = moved(joint.kind, -put.sign * put.zero);
        let origin = before
            .inverse()
            .then(&joint.rest())
            .then(&start)
            .then(&frame);
        let (r, p, y) = Rotation3::from_matrix_unchecked(origin.rotation).euler_angles();
        let axis: Vector3<f64> = turn.row(2).transpose() * put.sign;
        let kind = if joint.kind == JointKind::Revolute {
            "continuous"
        } else {
            "prismatic"
        };
        let limit = if kind == "prismatic" {
            "<limit lower=\"-9\" upper=\"9\" effort=\"1\" velocity=\"1\"/>"
        } else {
            ""
        };
        let parent = joint
            .parent
            .map_or("base".into(), |parent| format!("l{parent}"));
        let t = origin.translation;
        text.push_str(&format!(
            "<link name=\"l{index}\"/><joint name=\"{}\" type=\"{kind}\"><parent link=\"{parent}\"/>\
             <child link=\"l{index}\"/><origin xyz=\"{} {} {}\" rpy=\"{r} {p} {y}\"/>\
             <axis xyz=\"{} {} {}\"/>{limit}</joint>",
            joint.name, t.x, t.y, t.z, axis.x, axis.y, axis.z,
        ));
        frames.push(frame);
    }
    text + "</robot>"
}

#[test]
fn frames_put_elsewhere_are_found() {
    let own = mechanism("arm.toml", ARM);
    let mut generator = Pcg64Mcg::new(3);
    let mut tried = 0;
    for case in 0..40 {
        let elsewhere = drawn(&mut generator, own.joints.len());
        let other = mechanism("o.urdf", &urdf(&own, &Pose::identity(), &elsewhere));
        // An angle that happens to be next to a right one is read as that: another robot.
        if !other.snaps.is_empty() {
            continue;
        }
        let found = align(&own, &other).unwrap();
        assert!(found.apart < 1e-9, "case {case}: {}", found.apart);
        assert_eq!(found.base, Pose::identity());
        tried += 1;
    }
    assert!(tried > 20, "{tried}");
}

#[test]
fn base_put_elsewhere_is_found() {
    let own = mechanism("arm.toml", ARM);
    let mut generator = Pcg64Mcg::new(4);
    let elsewhere = drawn(&mut generator, own.joints.len());
    let turn = Rotation3::from_euler_angles(0.3, -0.2, 1.0).into_inner();
    let base = Pose {
        rotation: turn,
        translation: Vector3::new(0.2, -0.1, 0.6),
    };
    let found = align(&own, &mechanism("o.urdf", &urdf(&own, &base, &elsewhere))).unwrap();
    assert!(found.apart < 1e-9, "{}", found.apart);
    assert!(!found.is_identity());
}

#[test]
fn same_description_has_the_same_frames() {
    let own = mechanism("arm.toml", ARM);
    let found = align(&own, &own).unwrap();
    assert!(found.is_identity());
    assert!(found.apart < 1e-15);
}

#[test]
fn other_robots_are_told_by_the_joint_where_they_part() {
    let own = mechanism("arm.toml", ARM);
    let longer = mechanism("arm.toml", &ARM.replace("d = 0.42", "d = 0.43"));
    match align(&own, &longer) {
        Err(AlignError::Parts {
            number,
            name,
            distance,
            angle,
        }) => {
            assert_eq!((number, name.as_str()), (3, "elbow"));
            assert!(
                (distance - 0.01).abs() < 1e-9 && angle < 1e-9,
                "{distance} {angle}"
            );
        }
        other => panic!("{other:?}"),
    }
    let tilted = mechanism("arm.toml", &ARM.replace("alpha = 1.2", "alpha = 1.25"));
    match align(&own, &tilted) {
        Err(AlignError::Parts { number, angle, .. }) => {
            assert_eq!(number, 4);
            assert!((angle - 0.05).abs() < 1e-9, "{angle}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn other_trees_are_told_by_their_first_other_joint() {
    let own = mechanism("arm.toml", ARM);
    let flange = ARM.rfind("[[joint]]").unwrap();
    let shorter = align(&own, &mechanism("arm.toml", &ARM[..flange]));
    assert_eq!(shorter, Err(AlignError::Count { own: 7, other: 6 }));
    let sliding = ARM
        .replacen("revolute", "prismatic", 3)
        .replacen("prismatic", "revolute", 2);
    let other = align(&own, &mechanism("arm.toml", &sliding));
    let expected = AlignError::Kind {
        number: 3,
        name: "elbow".into(),
        own: "revolute",
        other: "prismatic",
    };
    assert_eq!(other, Err(expected));
    let branched = ARM.replace("name = \"bend\"", "name = \"bend\"\nant = 4");
    let other = align(&own, &mechanism("arm.toml", &branched));
    let expected = AlignError::Carrier {
        number: 6,
        name: "bend".into(),
        own: "joint 5 (`roll`)".into(),
        other: "joint 4 (`reach`)".into(),
    };
    assert_eq!(other, Err(expected));
}
