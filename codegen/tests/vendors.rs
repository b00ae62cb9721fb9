//! Descriptions as vendors ship them: humanoids, quadrupeds, hands; with meshes, transmissions,
//! world links, links without inertia and macros that nobody expanded. Each has the right number of
//! base parameters, or one clear error, and none keeps anybody waiting.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]
#![allow(dead_code, reason = "what random robots need beyond counting")]

mod projected;
mod random;

use std::f64::consts::FRAC_PI_2;
use std::time::{Duration, Instant};

use idim_codegen::base::BaseParameter;
use idim_codegen::derive::ParameterKind;
use idim_codegen::mechanism::Follow;
use idim_codegen::robot::Robot;
use idim_codegen::{BuildError, builder};
use random::count::{Mimic, base_parameters, base_parameters_with};
use random::draw::{Inertial, Joint, Kind, Robot as Drawn};
use random::text;

/// From the text to base parameters no robot takes longer, on any machine: a guard against
/// hanging, not a benchmark. Unoptimised and beside other tests, the largest takes a few seconds;
/// `benches/generate.rs` times it.
const PATIENCE: Duration = Duration::from_secs(60);

fn derive(urdf: &str) -> Result<Robot, BuildError> {
    let companion = text::companion([0.0, 0.0, -9.81], &[]);
    timely(&[("arm.toml", &companion), ("arm.urdf", urdf)])
}

/// As a user has it who has nothing but the URDF: with friction and rotor inertias.
fn derive_bare(urdf: &str) -> Result<Robot, BuildError> {
    timely(&[("arm.urdf", urdf)])
}

fn timely(texts: &[(&str, &str)]) -> Result<Robot, BuildError> {
    let start = Instant::now();
    let robot = builder::read_texts(texts);
    let took = start.elapsed();
    assert!(took < PATIENCE, "took {took:?}");
    robot
}

/// A robot that grows limb by limb.
struct Body(Drawn);

impl Body {
    /// A base and nothing else.
    fn new() -> Body {
        Body(Drawn {
            joints: Vec::new(),
            gravity: [0.0, 0.0, -9.81],
        })
    }

    fn push(&mut self, kind: Kind, parent: usize, axis: [f64; 3], xyz: [f64; 3]) -> usize {
        self.0.joints.push(Joint {
            kind,
            parent,
            rpy: [0.0; 3],
            xyz,
            axis,
            inertial: Some(Inertial {
                mass: 1.2,
                xyz: [0.01, -0.02, 0.5 * xyz[2]],
                rpy: [0.0; 3],
                inertia: [[0.02, 0.0, 0.001], [0.0, 0.03, 0.0], [0.001, 0.0, 0.01]],
            }),
        });
        self.0.joints.len()
    }

    /// A chain of hinges about x, y or z, each so far from the one before; the last link.
    fn limb(&mut self, from: usize, root: [f64; 3], axes: &str, step: [f64; 3]) -> usize {
        let mut link = from;
        for (index, letter) in axes.chars().enumerate() {
            let axis = match letter {
                'x' => [1.0, 0.0, 0.0],
                'y' => [0.0, 1.0, 0.0],
                _ => [0.0, 0.0, 1.0],
            };
            // Hips, shoulders and wrists have several axes through one point.
            let xyz = match (index, index % 3) {
                (0, _) => root,
                (_, 0) => step,
                _ => [0.0; 3],
            };
            link = self.push(Kind::Revolute, link, axis, xyz);
        }
        link
    }

    fn leg(&mut self, from: usize, side: f64) {
        let foot = self.limb(from, [0.0, 0.1 * side, -0.1], "zxyyyx", [0.0, 0.0, -0.35]);
        self.push(Kind::Fixed, foot, [0.0; 3], [0.05, 0.0, -0.08]);
    }

    fn arm(&mut self, from: usize, side: f64) {
        let wrist = self.limb(from, [0.0, 0.2 * side, 0.4], "yxzyzyx", [0.0, 0.02, -0.25]);
        for finger in 0..3 {
            let root = [0.03 * f64::from(finger), 0.01, -0.1];
            let joints = if finger == 0 { "zyy" } else { "yy" };
            self.limb(wrist, root, joints, [0.0, 0.0, -0.04]);
        }
    }

    fn torso(&mut self, from: usize) {
        let chest = self.limb(from, [0.0, 0.0, 0.1], "zyx", [0.0, 0.0, 0.1]);
        self.limb(chest, [0.0, 0.0, 0.5], "zy", [0.0, 0.0, 0.1]);
        self.arm(chest, 1.0);
        self.arm(chest, -1.0);
    }

    fn finger(&mut self, from: usize, place: f64) {
        let tip = self.limb(from, [0.02 * place, 0.0, 0.09], "yxxx", [0.0, 0.0, 0.03]);
        self.push(Kind::Fixed, tip, [0.0; 3], [0.0, 0.0, 0.02]);
    }

    /// What stands in such files beside links and joints.
    fn urdf(&self) -> String {
        let extras = "<material name=\"grey\"><color rgba=\"0.5 0.5 0.5 1\"/></material>\n\
            <transmission name=\"t0\"><type>SimpleTransmission</type><joint name=\"j0\">\
            <hardwareInterface>EffortJointInterface</hardwareInterface></joint>\
            <actuator name=\"m0\"><mechanicalReduction>100</mechanicalReduction></actuator>\
            </transmission>\n<gazebo reference=\"l1\"><mu1>0.9</mu1></gazebo>\n</robot>";
        let visual = "<visual><geometry><mesh filename=\"package://robot/meshes/l1.dae\" \
            scale=\"0.001 0.001 0.001\"/></geometry><material name=\"grey\"/></visual></link>";
        let text = text::urdf(&self.0);
        text.replace("</inertial></link>", &format!("</inertial>{visual}"))
            .replace("</robot>", extras)
    }
}

fn count_of(build: impl FnOnce(&mut Body)) -> usize {
    let mut part = Body::new();
    build(&mut part);
    base_parameters(&part.0)
}

fn humanoid() -> Body {
    let mut body = Body::new();
    body.leg(0, 1.0);
    body.leg(0, -1.0);
    body.torso(0);
    body
}

#[test]
fn humanoid_of_45_joints_has_the_base_parameters_of_its_limbs() {
    let body = humanoid();
    assert_eq!(body.0.moving().len(), 45);
    let robot = derive_bare(&body.urdf()).unwrap();
    let count = |wanted: &dyn Fn(&BaseParameter) -> bool| {
        let parameters = robot.base.parameters.iter();
        parameters.filter(|parameter| wanted(parameter)).count()
    };
    // Limbs on a base that stands still know nothing of each other.
    let limbs = 2 * count_of(|part| part.leg(0, 1.0)) + count_of(|part| part.torso(0));
    let inertial = count(&|p| matches!(p.kind, ParameterKind::Inertial(_)));
    assert_eq!(inertial, limbs);
    // Viscous and Coulomb friction and the offset of each joint; rotor inertias that no link's
    // inertia hides.
    assert_eq!(count(&|p| p.kind == ParameterKind::Friction), 3 * 45);
    assert!(count(&|p| p.kind == ParameterKind::Drive) > 0);
}

#[test]
fn quadruped_has_four_times_the_base_parameters_of_a_leg() {
    let leg = |body: &mut Body, x: f64, y: f64| {
        body.limb(0, [x, y, 0.0], "xyy", [0.0, 0.08, -0.25]);
    };
    let mut body = Body::new();
    for (x, y) in [(0.2, 0.1), (0.2, -0.1), (-0.2, 0.1), (-0.2, -0.1)] {
        leg(&mut body, x, y);
    }
    let robot = derive(&body.urdf()).unwrap();
    let expected = 4 * count_of(|part| leg(part, 0.2, 0.1));
    assert_eq!(robot.base.parameters.len(), expected);
}

#[test]
fn hand_of_five_fingers_on_a_wrist_has_the_right_base_parameters() {
    let mut hand = Body::new();
    let palm = hand.limb(0, [0.0, 0.0, 0.1], "yx", [0.0; 3]);
    for finger in 0..5 {
        hand.finger(palm, f64::from(finger));
    }
    let robot = derive(&hand.urdf()).unwrap();
    assert_eq!(robot.mechanism.joints.len(), 22);
    assert_eq!(robot.base.parameters.len(), base_parameters(&hand.0));
}

/// A wrist, a thumb, and four fingers of which the last follows the one beside it; in each finger
/// the middle joint follows the first and the tip the middle one, as tendons and linkages have it.
fn coupled_hand() -> (Body, Vec<Mimic>) {
    let mut hand = Body::new();
    let mut mimics = Vec::new();
    let mut follow = |link: usize, of: usize, multiplier: f64, offset: f64| {
        // The joint that carries link k is joint k - 1.
        let (joint, of) = (link - 1, of - 1);
        mimics.push(Mimic {
            joint,
            of,
            multiplier,
            offset,
        });
    };
    let palm = hand.limb(0, [0.0, 0.0, 0.1], "yx", [0.0; 3]);
    let turned = hand.limb(palm, [-0.03, 0.01, 0.03], "z", [0.0; 3]);
    let mut phalanx = hand.limb(turned, [-0.02, 0.0, 0.03], "y", [0.0; 3]);
    for _ in 0..2 {
        let before = phalanx;
        phalanx = hand.limb(before, [-0.02, 0.0, 0.03], "y", [0.0; 3]);
        follow(phalanx, before, 0.7, 0.02);
    }
    let mut knuckles = Vec::new();
    for finger in 0..4 {
        let place = [0.02 * f64::from(finger) - 0.03, 0.0, 0.09];
        let knuckle = hand.limb(palm, place, "x", [0.0; 3]);
        let middle = hand.limb(knuckle, [0.0, 0.0, 0.04], "x", [0.0; 3]);
        // The tip leans to the thumb.
        let leaning = [0.995, 0.0998749217771909, 0.0];
        let tip = hand.push(Kind::Revolute, middle, leaning, [0.0, 0.002, 0.03]);
        hand.push(Kind::Fixed, tip, [0.0; 3], [0.0, 0.0, 0.02]);
        follow(middle, knuckle, 1.1, 0.05);
        follow(tip, middle, -0.8, 0.0);
        knuckles.push(knuckle);
    }
    follow(knuckles[3], knuckles[2], 1.0, 0.0);
    (hand, mimics)
}

impl Body {
    /// The same with joints that follow others.
    fn urdf_with(&self, mimics: &[Mimic]) -> String {
        let mut text = self.urdf();
        for Mimic {
            joint,
            of,
            multiplier,
            offset,
        } in mimics
        {
            let numbers = match (*multiplier, *offset) {
                (1.0, 0.0) => String::new(),
                _ => format!(" multiplier=\"{multiplier}\" offset=\"{offset}\""),
            };
            let start = text.find(&format!("<joint name=\"j{joint}\" ")).unwrap();
            let end = start + text[start..].find("</joint>").unwrap();
            text.insert_str(end, &format!("<mimic joint=\"j{of}\"{numbers}/>"));
        }
        text
    }
}

/// Counted by the rank of the torques that the seven motors feel, with Newton and Euler.
#[test]
fn hand_with_chains_of_mimic_joints_has_the_right_base_parameters() {
    let (hand, mimics) = coupled_hand();
    let robot = derive(&hand.urdf_with(&mimics)).unwrap();
    assert_eq!(
        (robot.mechanism.driven, robot.mechanism.joints.len()),
        (7, 18)
    );
    let expected = base_parameters_with(&hand.0, &mimics);
    assert_eq!(robot.base.parameters.len(), expected);
    assert!(expected < base_parameters(&hand.0));
    // The last tip follows the knuckle beside it through three joints.
    let last = robot
        .mechanism
        .joints
        .iter()
        .position(|joint| joint.name == "j20");
    let Follow::Sum(sum) = robot.mechanism.follow(last.unwrap()) else {
        panic!("no sum");
    };
    let [(driver, ratio)] = sum.terms[..] else {
        panic!("{sum:?}");
    };
    assert_eq!(robot.mechanism.joints[driver].name, "j14");
    assert!(
        (ratio + 0.88).abs() < 1e-12 && (sum.offset + 0.04).abs() < 1e-12,
        "{sum:?}"
    );
    projected::check(&robot);
}

#[test]
fn world_link_and_frames_without_inertia_change_nothing() {
    let mut arm = Body::new();
    arm.limb(0, [0.0, 0.0, 0.3], "zyyzyz", [0.0, 0.1, 0.4]);
    let plain = derive(&arm.urdf()).unwrap();
    let world = arm.urdf().replace(
        "<link name=\"l0\"/>",
        "<link name=\"world\"/><link name=\"l0\"/><joint name=\"to_world\" type=\"fixed\">\
         <parent link=\"world\"/><child link=\"l0\"/></joint><link name=\"camera\"/>\
         <joint name=\"eye\" type=\"fixed\"><parent link=\"l4\"/><child link=\"camera\"/>\
         <origin xyz=\"0 0 0.1\" rpy=\"-1.5707963 0 0\"/></joint>",
    );
    let world = derive(&world).unwrap();
    assert_eq!(names(&world), names(&plain));
    assert_eq!(relations(&world), relations(&plain));
}

#[test]
fn world_link_with_inertia_and_a_turned_base_are_understood() {
    let mut arm = Body::new();
    let base = arm.push(Kind::Fixed, 0, [0.0; 3], [0.0, 0.0, 0.5]);
    arm.0.joints[0].rpy = [FRAC_PI_2, 0.0, 0.0];
    arm.limb(base, [0.0, 0.0, 0.3], "zyyzyz", [0.0, 0.1, 0.4]);
    let robot = derive(&arm.urdf()).unwrap();
    assert_eq!(robot.base.parameters.len(), base_parameters(&arm.0));
}

#[test]
fn links_without_inertia_have_the_same_base_parameters() {
    let mut arm = Body::new();
    arm.limb(0, [0.0, 0.0, 0.3], "zyyzyz", [0.0, 0.1, 0.4]);
    let described = derive(&arm.urdf()).unwrap();
    for joint in &mut arm.0.joints {
        joint.inertial = None;
    }
    let bare = derive(&arm.urdf()).unwrap();
    assert_eq!(relations(&bare), relations(&described));
    let warnings = &bare.description.warnings;
    let massless = warnings.iter().find(|one| one.code == "IDIM100").unwrap();
    assert!(
        massless
            .message
            .starts_with("6 links move and have no mass"),
        "{massless}"
    );
}

/// Joints through one point are often written with empty links between them.
#[test]
fn massless_links_between_joints_are_links_all_the_same() {
    let mut arm = Body::new();
    arm.limb(0, [0.0, 0.0, 0.3], "zyyzyz", [0.0, 0.1, 0.4]);
    for joint in [1, 3, 4] {
        arm.0.joints[joint].inertial = None;
    }
    let robot = derive(&arm.urdf()).unwrap();
    assert_eq!(robot.base.parameters.len(), base_parameters(&arm.0));
}

#[test]
fn macros_that_nobody_expanded_are_one_clear_error() {
    let mut leg = Body::new();
    leg.leg(0, 1.0);
    let text = leg.urdf();
    for (from, to) in [
        ("<mass value=\"1.2\"/>", "<mass value=\"${thigh_mass}\"/>"),
        ("xyz=\"0 0 -0.35\"", "xyz=\"0 0 ${-leg_length}\""),
        ("<link name=\"l1\"", "<link name=\"${prefix}l1\""),
        ("<robot name=\"random\"", "<robot name=\"$(arg name)\""),
    ] {
        assert!(text.contains(from), "{from}");
        let error = derive_bare(&text.replace(from, to)).unwrap_err();
        let BuildError::Description(found) = error else {
            panic!("{to}: {error}");
        };
        assert!(
            found.iter().all(|one| one.code == "IDIM014"),
            "{to}: {found:?}"
        );
        assert!(
            found[0].span.line > 0 && found[0].to_string().contains("xacro"),
            "{to}"
        );
        assert_eq!(found.len(), 1, "{to}: {found:?}");
    }
}

fn names(robot: &Robot) -> Vec<String> {
    let parameters = robot.base.parameters.iter();
    parameters.map(|parameter| parameter.name.clone()).collect()
}

fn relations(robot: &Robot) -> Vec<String> {
    let parameters = robot.base.parameters.iter();
    parameters
        .map(|parameter| parameter.relation_text())
        .collect()
}
