//! What a description states of its bodies: `total_mass` and `[[link]]`.

use super::*;

use idim::codegen::mechanism::Pose;
use nalgebra::Vector3;

/// An arm of two links with meshes alone. Its second axis is square to nothing, so that the
/// identified frame of the second link has none of the axes of the link's own.
const ARM: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><visual><geometry><mesh filename="u.stl"/></geometry></visual></link>
<link name="lower"><visual><geometry><mesh filename="l.stl"/></geometry></visual></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
<joint name="elbow" type="continuous"><origin xyz="0.4 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0.6 0.8"/></joint>
</robot>"#;

/// Both links, in their own frames: slender along x, and the second symmetric about x and z.
const UPPER: &str = "box = [[-0.05, -0.06, -0.06], [0.45, 0.06, 0.06]]";
const LOWER: &str = "box = [[-0.05, -0.06, -0.06], [0.35, 0.06, 0.06]]\nsymmetric = \"xz\"";

fn described(upper: &str, lower: &str) -> Robot {
    let companion = format!(
        "urdf = \"arm.urdf\"\ntotal_mass = 4.0\n[[link]]\nname = \"upper\"\n{upper}\n\
         [[link]]\nname = \"lower\"\nmass = 1.0\n{lower}\n"
    );
    builder::read_texts(&[("arm.toml", companion.as_str()), ("arm.urdf", ARM)]).unwrap()
}

/// Frame of a link of the URDF in the identified frame.
fn own_frame(robot: &Robot, place: usize) -> Pose {
    robot.mechanism.joints[place].bodies[0].pose
}

/// Slender links: 3 kg about 0.2 m, 1 kg about 0.15 m, along x of their own frames, the second
/// with more above than below.
fn identified(robot: &Robot) -> Identified {
    let body = |mass: f64, x: f64, z: f64, place: usize| {
        let pseudo = Pseudo::ball(mass, 0.03, [x, 0.0, z]);
        Standard::from_values(pseudo.values()).moved(&own_frame(robot, place))
    };
    let truth = truth(robot, &[body(3.0, 0.2, 0.0, 0), body(1.0, 0.15, 0.02, 1)]);
    let sigma = vec![Some(1e-3); truth.len()];
    Identified::new(truth, (&sigma, &sigma), &[])
}

fn exported(robot: &Robot) -> Result<Exported, ExportError> {
    let options = Options {
        fill: true,
        ..Options::default()
    };
    export(robot, Some(ARM), &identified(robot), &options)
}

/// A found link in the frame of the URDF's link.
fn found(robot: &Robot, exported: &Exported, place: usize) -> Standard {
    let link = Standard::from_values(exported.bodies.links[place]);
    link.moved(&own_frame(robot, place).inverse())
}

#[test]
fn bodies_have_the_masses_boxes_and_planes_of_the_description() {
    let robot = described(UPPER, LOWER);
    let exported = exported(&robot).unwrap();
    assert!(
        exported.bodies.distance < 4.0,
        "{}",
        exported.bodies.distance
    );
    let boxes = [[-0.05, 0.45], [-0.05, 0.35]];
    for (place, (mass, [low, high])) in [3.0, 1.0].into_iter().zip(boxes).enumerate() {
        let link = found(&robot, &exported, place);
        assert!((link.mass - mass).abs() < 1e-3 * mass, "{}", link.mass);
        let center = link.moment / link.mass;
        assert!(center.x > low && center.x < high, "{center}");
        assert!(center.y.abs() < 0.06 && center.z.abs() < 0.06, "{center}");
        // Mass inside of a box has second moments about its middle of at most half its edge squared.
        let middle = Pose {
            translation: Vector3::new(-0.5 * (low + high), 0.0, 0.0),
            ..Pose::identity()
        };
        let moments = Pseudo::of(&link.moved(&middle).values()).0;
        for (axis, half) in [0.5 * (high - low), 0.06, 0.06].into_iter().enumerate() {
            assert!(
                moments[axis][axis] <= link.mass * half * half,
                "{moments:?}"
            );
        }
    }
    let link = found(&robot, &exported, 1);
    let (size, [_, xy, _, _, yz, _, _, my, ..]) = (link.inertia.trace(), link.values());
    assert!(
        xy.abs() < 1e-12 * size && yz.abs() < 1e-12 * size,
        "{link:?}"
    );
    assert!(my.abs() < 1e-12, "{link:?}");
    // In the identified frame, turned about x, the plane is oblique.
    let [.., my, mz, _] = exported.bodies.links[1];
    assert!(my.abs() > 1e-3 && mz.abs() > 1e-3, "{my} {mz}");
}

#[test]
fn box_of_the_description_that_the_log_contradicts_is_an_error_with_its_link() {
    // The centre of mass is 0.15 m away from the joint, and the box begins at 0.2 m.
    let robot = described(UPPER, "box = [[0.2, -0.06, -0.06], [0.35, 0.06, 0.06]]");
    match exported(&robot).unwrap_err() {
        ExportError::Physical(PhysicalError::Outside { what, .. }) => {
            assert_eq!(what, "what moves with `elbow`");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn options_come_before_the_description() {
    let robot = described(UPPER, LOWER);
    let heavier = Options {
        fill: true,
        total_mass: Some(4.5),
        masses: vec![("elbow".into(), 1.2)],
        symmetric: vec![("elbow".into(), Plane::Xy)],
        ..Options::default()
    };
    let sigma = vec![Some(1.0); robot.base.parameters.len()];
    let loose = Identified::new(identified(&robot).parameters, (&sigma, &sigma), &[]);
    let exported = export(&robot, Some(ARM), &loose, &heavier).unwrap();
    let masses: Vec<f64> = exported.bodies.links.iter().map(|link| link[9]).collect();
    assert!((masses[0] - 3.3).abs() < 0.01 && (masses[1] - 1.2).abs() < 0.01);
    let [_, _, xz, _, yz, _, _, _, mz, _] = exported.bodies.links[1];
    assert!(xz.abs() + yz.abs() + mz.abs() < 1e-12);
}

#[test]
fn planes_in_two_frames_are_an_error() {
    let text = "urdf = \"arm.urdf\"\n[[link]]\nname = \"lower\"\nsymmetric = \"xz\"\n\
        [[link]]\nname = \"tool\"\nsymmetric = \"xy\"\n";
    let tool = "<link name=\"tool\"/><joint name=\"f\" type=\"fixed\"><origin xyz=\"0.1 0 0\"/>\
        <parent link=\"lower\"/><child link=\"tool\"/></joint></robot>";
    let urdf = ARM.replace("</robot>", tool);
    let robot = builder::read_texts(&[("arm.toml", text), ("arm.urdf", urdf.as_str())]).unwrap();
    let sigma = vec![Some(1.0); robot.base.parameters.len()];
    let zero = vec![0.1; sigma.len()];
    let identified = Identified::new(zero, (&sigma, &sigma), &[]);
    let fill = Options {
        fill: true,
        ..Options::default()
    };
    let refused = export(&robot, Some(&urdf), &identified, &fill).unwrap_err();
    assert!(matches!(refused, ExportError::Planes(joint) if joint == "elbow"));
}

/// Masses that the maker states for the links of a UR10e (P. Corke's Robotics Toolbox for Python,
/// `models/DH/UR10e.py`, after "DH parameters for calculations of kinematics and dynamics", Universal
/// Robots), and boxes around links between their joints, 0.1 m to the side and 0.14 m beyond the
/// axes, in the frames of the rows.
const UR10E: [(&str, f64, &str); 6] = [
    (
        "shoulder_pan_joint",
        7.369,
        "[[-0.14, -0.14, -0.14], [0.14, 0.14, 0.14]]",
    ),
    (
        "shoulder_lift_joint",
        13.051,
        "[[\"D3 - 0.1\", -0.1, 0.0], [0.1, 0.1, 0.28]]",
    ),
    (
        "elbow_joint",
        3.989,
        "[[\"D4 - 0.1\", -0.1, -0.1], [0.1, 0.1, 0.2]]",
    ),
    (
        "wrist_1_joint",
        2.1,
        "[[-0.1, -0.14, -0.14], [0.1, 0.14, 0.14]]",
    ),
    (
        "wrist_2_joint",
        1.98,
        "[[-0.1, -0.14, -0.14], [0.1, 0.14, 0.14]]",
    ),
    (
        "wrist_3_joint",
        0.615,
        "[[-0.1, -0.1, -0.1], [0.1, 0.1, 0.16]]",
    ),
];

#[test]
fn stated_masses_and_boxes_make_a_ur10e_of_a_log_that_leaves_them_open() {
    let Some(folder) = shared() else { return };
    let folder = folder.join("ur10e");
    let link = |(name, mass, corners): &(&str, f64, &str)| {
        format!("\n[[link]]\nname = \"{name}\"\nmass = {mass}\nbox = {corners}\n")
    };
    let stated: String = UR10E.iter().map(link).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/ur10e.toml");
    let text = std::fs::read_to_string(path).unwrap() + &stated;
    let robot = builder::read_texts(&[("ur10e.toml", text.as_str())]).unwrap();
    let model = generated("ur10e");
    let log = |name: &str| read(model, &folder.join(name));
    let train = [log("identification/20_02_10_30sec_12harm.csv.gz")];
    let valid = log("validation/20_01_17_ptp_10_points.csv.gz");
    let found = identify(model, &train, &[] as &[Recording], &only_explicit(), &()).unwrap();
    let identified = Identified::of(explicit(&found));
    let urdf = std::fs::read_to_string(folder.join("ur10e.urdf")).unwrap();
    let exported = export(&robot, Some(&urdf), &identified, &Options::default()).unwrap();
    exists(model, &exported);
    for (place, (name, mass, _)) in UR10E.iter().enumerate() {
        let link = exported.bodies.links[place];
        assert!((link[9] - mass).abs() < 1e-3 * mass, "{name}: {}", link[9]);
        let entry = &robot.description.links[place];
        let [lowest, highest] = entry.corners.unwrap();
        for axis in 0..3 {
            let center = link[6 + axis] / link[9];
            assert!(
                lowest[axis] < center && center < highest[axis],
                "{name}: {center}"
            );
        }
    }
    let free = error(model, &valid, &found, &identified.parameters);
    let bodies = error(model, &valid, &found, &exported.bodies.parameters);
    println!("validation error {free:.3} % free, {bodies:.3} % of these bodies");
    assert!(bodies < 1.02 * free);
}
