use crate::catalogue::EffectKind;
use crate::describe::{Description, Diagnostic, Geometry, Kind, Motion, read_path, read_text};
use std::path::Path;

fn read(text: &str) -> Result<Description, Vec<Diagnostic>> {
    read_text(text, "robot.toml", Kind::Toml, &|_| {
        Err("no such file".to_owned())
    })
}

fn errors(text: &str) -> Vec<String> {
    read(text)
        .err()
        .unwrap_or_default()
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn built_in(name: &str) -> Description {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../robots/{name}.toml"));
    match read_path(&path) {
        Ok(description) => description,
        Err(errors) => panic!("{name}: {errors:?}"),
    }
}

#[test]
fn read_built_in_robots_gives_no_warning() {
    let moving = [
        ("scara", 2),
        ("emps", 1),
        ("tx40", 6),
        ("ur10e", 6),
        ("panda", 7),
        ("puma560", 6),
        ("rx90", 6),
    ];
    for (name, joints) in moving {
        let robot = built_in(name);
        let Geometry::Mdh(rows) = &robot.geometry else {
            panic!("{name} has no rows")
        };
        assert_eq!((robot.name.as_str(), rows.len()), (name, joints));
        assert_eq!((robot.warnings.len(), robot.snaps.len()), (0, 0), "{name}");
        assert_eq!(robot.hash.len(), 64);
    }
}

#[test]
fn read_scara_gives_what_the_paper_says() {
    let robot = built_in("scara");
    assert_eq!(robot.gravity, [0.0; 3]);
    assert_eq!(robot.lengths, [("L".to_owned(), 0.5)]);
    let Geometry::Mdh(rows) = &robot.geometry else {
        panic!("no rows")
    };
    assert_eq!(
        (rows[1].d.value, rows[1].d.text.as_str(), rows[1].ant),
        (0.5, "L", 1)
    );
    let scaled = &robot.scaled[0];
    assert_eq!(
        (scaled.name.as_str(), scaled.parameter.as_str()),
        ("LMX2", "MX2")
    );
    assert_eq!(
        (scaled.factor.value, scaled.factor.text.as_str()),
        (0.5, "L")
    );
    let effects: Vec<_> = robot
        .effects
        .iter()
        .map(|one| (one.kind, one.joints[0].as_str()))
        .collect();
    let expected = [
        (EffectKind::Viscous, "shoulder"),
        (EffectKind::Coulomb, "shoulder"),
        (EffectKind::Viscous, "elbow"),
        (EffectKind::Coulomb, "elbow"),
    ];
    assert_eq!(effects, expected);
    assert_eq!(robot.identify.prefilter_torque, Some(true));
    assert_eq!(robot.parameters[0], ("ZZR1".to_owned(), 3.5));
    assert_eq!(robot.parameters.len(), 8);
}

#[test]
fn read_link_side_torques_leaves_the_rotor_inertia_out() {
    let row = "[[joint]]\nkind = \"revolute\"\n";
    let kinds = |text: &str| read(text).unwrap().effects.len();
    assert_eq!(kinds(row), 4);
    assert_eq!(kinds(&format!("{row}[drives]\nside = \"link\"\n")), 3);
}

#[test]
fn read_angles_close_to_quarter_turns_are_snapped_and_reported() {
    let text = "[[joint]]\nname = \"a\"\nkind = \"revolute\"\nalpha = -1.57\ntheta = \"pi/2\"\n";
    let robot = read(text).unwrap();
    let Geometry::Mdh(rows) = &robot.geometry else {
        panic!("no rows")
    };
    assert_eq!(rows[0].alpha.value, -std::f64::consts::FRAC_PI_2);
    assert_eq!(rows[0].alpha.text, "-pi/2");
    assert_eq!(rows[0].theta.value, std::f64::consts::FRAC_PI_2);
    assert_eq!(robot.snaps.len(), 1);
    assert_eq!(
        (robot.snaps[0].from, robot.snaps[0].to.as_str()),
        (-1.57, "-pi/2")
    );
}

#[test]
fn read_joint_settings_replace_the_common_ones() {
    let text = r#"
effects = ["viscous"]
[[joint]]
name = "a"
kind = "prismatic"
gain = 2.0
effects = [{ kind = "coulomb", smoothing = 0.1 }, "torque_offset"]
limits = [-1, 1]
[[joint]]
name = "tool"
kind = "fixed"
[[joint]]
name = "b"
kind = "revolute"
gain = 3
[[effect]]
kind = "wrist_coupling"
joints = ["a", "b"]
"#;
    let robot = read(text).unwrap();
    let found: Vec<_> = robot
        .effects
        .iter()
        .map(|one| (one.kind.name(), one.joints.join("+")))
        .collect();
    let expected = [
        ("coulomb", "a".to_owned()),
        ("offset", "a".to_owned()),
        ("viscous", "b".to_owned()),
        ("wrist_coupling", "a+b".to_owned()),
    ];
    assert_eq!(found, expected);
    assert_eq!(robot.effects[0].shape, [("smoothing", 0.1)]);
    assert_eq!(robot.drives.gains, [2.0, 3.0]);
    let Geometry::Mdh(rows) = &robot.geometry else {
        panic!("no rows")
    };
    assert_eq!(rows[1].motion, Motion::Fixed);
    assert_eq!(
        (rows[0].limits.lower, rows[0].limits.upper),
        (Some(-1.0), Some(1.0))
    );
}

#[test]
fn read_reports_several_mistakes_with_places_and_the_nearest_word() {
    let text = r#"gravty = [0, 0, -9.81]
effects = ["colomb"]
[[joint]]
name = "a"
kind = "revolut"
d = "L2"
[identify]
edges = "scipi"
nd = 0
"#;
    let found = errors(text);
    let expected = [
        "robot.toml:1:1: error [IDIM051]: unknown key `gravty` in the description\n  help: did you \
         mean `gravity`?",
        "robot.toml:2:12: error [IDIM060]: unknown effect `colomb`\n  help: did you mean `coulomb`?",
        "robot.toml:5:8: error [IDIM054]: `kind` of joint `a` cannot be `revolut`\n  help: did you \
         mean `revolute`?",
        "robot.toml:6:6: error [IDIM048]: `d` of joint `a`: `L2` is not a named length\n  help: \
         give `L2` a value in [lengths]",
        "robot.toml:8:9: error [IDIM054]: `edges` of [identify] cannot be `scipi`\n  help: did you \
         mean `scipy`?",
        "robot.toml:9:6: error [IDIM045]: `nd` of [identify] must be a whole number, 1 or \
         more, not 0",
    ];
    assert_eq!(found, expected);
}
