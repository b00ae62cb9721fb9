//! Friction that goes into the URDF.

use idim::codegen::emit::urdf::dynamics;

use super::*;

const TABLE: &str = r#"
name = "arm"
effects = EFFECTS
[[joint]]
name = "shoulder"
kind = "revolute"
alpha = "-pi/2"
[[joint]]
name = "elbow"
kind = "revolute"
d = 0.4
"#;

const URDF: &str = r#"<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><dynamics damping="7" friction="8" /></joint>
<joint name="elbow" type="continuous"><origin xyz="0.4 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint>
</robot>"#;

fn exported(effects: &str, value: impl Fn(&str) -> f64) -> Result<Exported, ExportError> {
    let table = TABLE.replace("EFFECTS", effects);
    let robot = builder::read_texts(&[("arm.toml", table.as_str())]).unwrap();
    let parameters = robot.base.parameters.iter();
    let values: Vec<f64> = parameters.map(|p| value(&p.name)).collect();
    let sigma = vec![Some(1e-4); values.len()];
    let identified = Identified::new(values, (&sigma, &sigma), &[]);
    let options = Options {
        fill: true,
        friction: true,
        ..Options::default()
    };
    export(&robot, Some(URDF), &identified, &options)
}

fn value(name: &str) -> f64 {
    match name {
        "FV1" => 3.5,
        "FS1" => 0.25,
        "FV2" => 0.125,
        "FVN1" => -0.5,
        _ => 0.4,
    }
}

#[test]
fn viscous_and_coulomb_friction_go_into_dynamics() {
    let exported = exported("[\"viscous\", \"coulomb\"]", value).unwrap();
    let found = dynamics(&exported.urdf).unwrap();
    let wanted = [("shoulder", 3.5, 0.25), ("elbow", 0.125, 0.4)];
    for ((name, found), (joint, damping, friction)) in found.iter().zip(wanted) {
        assert_eq!(name, joint);
        assert!((found.damping.unwrap() - damping).abs() < 1e-3);
        assert!((found.friction.unwrap() - friction).abs() < 1e-3);
    }
    assert_eq!(exported.friction, found);
    assert!(
        exported
            .urdf
            .contains("<axis xyz=\"0 1 0\"/><dynamics damping=")
    );
}

#[test]
fn friction_without_words_and_negative_estimates_are_said() {
    let effects =
        "[\"viscous\"]\n[[effect]]\nkind = \"nonlinear_viscous\"\njoint = \"elbow\"\np = 0.5";
    let negative = |name: &str| if name == "FV2" { -0.3 } else { value(name) };
    let exported = exported(effects, negative).unwrap();
    let said = exported.warnings.join("\n");
    assert!(
        said.contains("FV2 of `elbow` was identified as -0.3"),
        "{said}"
    );
    assert!(said.contains("no words for FVN2: "), "{said}");
    let found = dynamics(&exported.urdf).unwrap();
    assert_eq!(found[1].1.damping, Some(0.0));
    // Coulomb friction is not part of the model: what the URDF says of it stays.
    assert_eq!(
        (found[0].1.friction, found[1].1.friction),
        (Some(8.0), None)
    );
}

#[test]
fn model_without_friction_has_none_to_write() {
    let none = exported("[]", value);
    assert!(matches!(none, Err(ExportError::NoFriction)));
}
