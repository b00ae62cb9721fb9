use super::super::description::{Description, Geometry, MdhRow, Motion};
use super::super::{Kind, read_text};
use crate::catalogue::EffectKind;

const SCARA: &str = "(* File scara.par *)
(* Robotname = 'Scara 4' *)
NL = 4
NJ = 4
NF = 4
Type = 0 (* Simple *)
is_floating = False
D2 = 0.5
(* Geometric parameters *)
Ant = {0,1,2,3}
Sigma = {0,0,0,1}
B = {0,0,0,0}
d = {0,D2,
  2*D2/2 - atan2(0,1),0}
R = {0,0,0,r4 + 0.1}
Alpha = {0,0,0,Pi}
Mu = {1,1,1,1}
Theta = {t1,t2-pi/2,t3,0}
(* Dynamic parameters *)
ZZ = {1.5,ZZ2,0.1,0.1}
M = {1,M2,2,0}
IA = {IA1,0,0,0}
FV = {0.25,0,FV3,FV4}
G = {0,0,G3}
";

fn read(text: &str) -> Description {
    let read = read_text(text, "x.par", Kind::Par, &|_| Err(String::new()));
    read.unwrap_or_else(|all| panic!("{all:?}"))
}

fn rows(robot: &Description) -> &[MdhRow] {
    match &robot.geometry {
        Geometry::Mdh(rows) => rows,
        Geometry::Urdf(_) => &[],
    }
}

#[test]
fn read_old_spelling_expressions_and_lists_over_lines() {
    let robot = read(SCARA);
    let rows = rows(&robot);
    assert_eq!(robot.name, "scara_4");
    assert_eq!(
        rows.iter().map(|row| row.ant).collect::<Vec<_>>(),
        [0, 1, 2, 3]
    );
    assert_eq!(rows[3].motion, Motion::Prismatic);
    assert_eq!((rows[1].d.value, rows[2].d.value), (0.5, 0.5));
    assert_eq!(rows[1].theta.value, -std::f64::consts::FRAC_PI_2);
    assert_eq!(
        (rows[3].r.value, rows[3].alpha.value),
        (0.1, std::f64::consts::PI)
    );
    assert_eq!(robot.gravity, [0.0, 0.0, -9.81]);
}

#[test]
fn read_numbers_are_known_and_symbols_are_not() {
    let robot = read(SCARA);
    let known: Vec<Option<f64>> = rows(&robot)
        .iter()
        .map(|row| Some(row.inertial?[5]))
        .collect();
    assert_eq!(known, [Some(1.5), None, Some(0.1), None]);
    assert_eq!(robot.parameters, [("FV1".to_owned(), 0.25)]);
    let effects = robot.effects.iter();
    let effects: Vec<_> = effects
        .map(|one| (one.kind, one.joints[0].as_str()))
        .collect();
    let expected = [
        (EffectKind::Viscous, "joint1"),
        (EffectKind::RotorInertia, "joint1"),
        (EffectKind::Viscous, "joint3"),
        (EffectKind::Viscous, "joint4"),
    ];
    assert_eq!(effects, expected);
}

#[test]
fn read_without_lists_of_effects_has_the_defaults() {
    assert_eq!(read("NL = 2\n").effects.len(), 8);
}
