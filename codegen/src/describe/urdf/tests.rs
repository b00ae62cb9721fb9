use crate::catalogue::EffectKind;
use crate::describe::{
    Description, Diagnostic, Geometry, Kind, Limits, Motion, UrdfTree, read_text,
};
use std::f64::consts::{FRAC_PI_2, PI};

const ARM: &str = r#"<robot name="TwoArms" version="1.1">
  <joint name="elbow" type="prismatic">
    <parent link="upper"/>
    <child link="fore"/>
    <origin xyz="0 0.1 0" quat_xyzw="0 0 0.70710678 0.70710678"/>
    <axis xyz="0 -3 4"/>
    <limit lower="-0.5" upper="inf" effort="0" velocity="2"/>
  </joint>
  <joint name="shoulder" type="continuous">
    <parent link="base"/>
    <child link="upper"/>
    <origin rpy="1.57 0.3 -3.14159265"/>
    <axis xyz="0 0 -1"/>
    <limit lower="-9" upper="9" effort="10" velocity="2"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="fore"/>
    <child link="tool"/>
  </joint>
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0.1 0.2 0.3" rpy="1.57 0 0"/>
      <mass value="2"/>
      <inertia ixx="0.04" ixy="0.001" ixz="0.002" iyy="0.05" iyz="0.003" izz="0.06"/>
    </inertial>
  </link>
  <link name="fore"/>
  <link name="tool"/>
</robot>
"#;

fn read(text: &str) -> Result<Description, Vec<Diagnostic>> {
    read_text(text, "arm.urdf", Kind::Urdf, &|_| {
        Err("no such file".to_owned())
    })
}

fn arm() -> (Description, UrdfTree) {
    let robot = read(ARM).unwrap();
    let Geometry::Urdf(tree) = robot.geometry.clone() else {
        panic!("not a URDF")
    };
    (robot, tree)
}

#[test]
fn read_puts_joints_into_the_order_from_base_to_tip() {
    let (robot, tree) = arm();
    let names: Vec<&str> = tree
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, ["shoulder", "elbow", "mount"]);
    let ends: Vec<_> = tree
        .joints
        .iter()
        .map(|joint| (joint.parent, joint.child))
        .collect();
    assert_eq!(ends, [(0, 1), (1, 2), (2, 3)]);
    let motions: Vec<_> = tree.joints.iter().map(|joint| joint.motion).collect();
    assert_eq!(
        motions,
        [Motion::Revolute, Motion::Prismatic, Motion::Fixed]
    );
    assert!(
        robot.warnings.iter().any(|one| one.code == "IDIM107"),
        "{:?}",
        robot.warnings
    );
}

#[test]
fn read_poses_are_snapped_in_joints_and_kept_in_inertials() {
    let (robot, tree) = arm();
    assert_eq!(tree.joints[0].origin.rpy, [FRAC_PI_2, 0.3, -PI]);
    assert_eq!(tree.joints[0].origin.xyz, [0.0; 3]);
    assert_eq!(tree.joints[1].origin.rpy, [0.0, 0.0, FRAC_PI_2]);
    let inertial = tree.links[1].inertial.unwrap();
    assert_eq!(
        (inertial.mass, inertial.origin.rpy),
        (2.0, [1.57, 0.0, 0.0])
    );
    assert_eq!(inertial.inertia, [0.04, 0.001, 0.002, 0.05, 0.003, 0.06]);
    assert!(tree.links[0].inertial.is_none());
    assert_eq!(robot.snaps.len(), 1);
    assert_eq!(
        (robot.snaps[0].joint.as_str(), robot.snaps[0].from),
        ("shoulder", 1.57)
    );
}

#[test]
fn read_axes_are_unit_vectors() {
    let (_, tree) = arm();
    assert_eq!(tree.joints[0].axis, [0.0, 0.0, -1.0]);
    let [x, y, z] = tree.joints[1].axis;
    assert_eq!(x, 0.0);
    assert!((y + 0.6).abs() < 1e-15 && (z - 0.8).abs() < 1e-15);
}

#[test]
fn read_limits_tell_stated_from_silent() {
    let (_, tree) = arm();
    let stated = Limits {
        velocity: Some(2.0),
        effort: Some(10.0),
        ..Limits::default()
    };
    assert_eq!(tree.joints[0].limits, stated);
    let stated = Limits {
        lower: Some(-0.5),
        velocity: Some(2.0),
        ..Limits::default()
    };
    assert_eq!(tree.joints[1].limits, stated);
}

#[test]
fn read_bare_urdf_gives_every_moving_joint_the_default_effects() {
    let (robot, _) = arm();
    assert_eq!(robot.name, "two_arms");
    assert_eq!(robot.gravity, [0.0, 0.0, -9.81]);
    let kinds = |joint: &str| -> Vec<EffectKind> {
        let on = robot
            .effects
            .iter()
            .filter(|effect| effect.joints == [joint]);
        on.map(|effect| effect.kind).collect()
    };
    let all = [
        EffectKind::Viscous,
        EffectKind::Coulomb,
        EffectKind::Offset,
        EffectKind::RotorInertia,
    ];
    assert_eq!(kinds("shoulder"), all);
    assert_eq!(kinds("elbow"), all);
    assert_eq!(robot.effects.len(), 8);
}

#[test]
fn read_companion_overrides_the_urdf_and_hashes_both_texts() {
    let companion = r#"urdf = "arm.urdf"
effects = ["viscous"]
[joint.elbow]
effects = []
limits = { upper = 0.5 }
gain = 3.0
[joint.shoulder]
gain = 2.0
"#;
    let load = |path: &str| match path {
        "arm.urdf" => Ok(ARM.to_owned()),
        other => Err(format!("asked for {other}")),
    };
    let robot = read_text(companion, "robots/arm.toml", Kind::Toml, &load).unwrap();
    assert_eq!(robot.name, "two_arms");
    assert_eq!(robot.effects.len(), 1);
    assert_eq!(robot.effects[0].joints, ["shoulder"]);
    assert_eq!(robot.drives.gains, [2.0, 3.0]);
    let Geometry::Urdf(tree) = &robot.geometry else {
        panic!("not a URDF")
    };
    assert_eq!(
        (tree.joints[1].limits.lower, tree.joints[1].limits.upper),
        (Some(-0.5), Some(0.5))
    );
    assert!(
        robot
            .warnings
            .iter()
            .all(|one| one.file == "robots/arm.urdf")
    );
    assert_ne!(robot.hash, read(ARM).unwrap().hash);
}

#[test]
fn read_hash_is_that_of_the_file() {
    let text = "<robot name=\"a\"><link name=\"b\"/><link name=\"c\"/><joint name=\"d\" \
                type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/></joint></robot>";
    // printf '%s' "$text" | sha256sum
    let expected = "e86c359949a5604c868a697ec016219afa3f508916168a814e9ce76f43fd15d4";
    assert_eq!(read(text).unwrap().hash, expected);
}
