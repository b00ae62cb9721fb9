//! Joints that follow others: the models in the driven joints against those of the open tree,
//! G^T D_tree and so on, and against the identities that every model obeys.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod projected;
#[allow(
    dead_code,
    reason = "of the reference robots only the files are read here"
)]
mod robots;

use idim_codegen::builder;
use idim_codegen::mechanism::{Affine, Follow};
use idim_codegen::robot::Robot;
use projected::{check, check_within, robot};
use robots::reference;
use serde_json::{Value, json};

/// Two fingers on a slide: one follows a motor at half its speed, its tip follows it in turn, and a
/// rack follows the motor as a displacement. Axes of all kinds, numbers without meaning.
const HAND: &str = r#"
    gravity = [1.0, -2.0, -9.0]
    [[joint]]
    name = "slide"
    kind = "prismatic"
    alpha = 0.4
    [[joint]]
    name = "finger"
    kind = "revolute"
    gamma = 0.3
    alpha = "pi/2"
    d = 0.1
    r = 0.05
    mimic = { joint = "motor", multiplier = 0.5, offset = 0.2 }
    [[joint]]
    name = "tip"
    kind = "revolute"
    d = 0.07
    mimic = { joint = "finger", multiplier = -1.5 }
    [[joint]]
    name = "motor"
    kind = "revolute"
    ant = 1
    alpha = 0.2
    d = -0.1
    [[joint]]
    name = "rack"
    kind = "prismatic"
    ant = 4
    alpha = 1.1
    d = 0.02
    mimic = { joint = "motor", multiplier = 0.03, offset = 0.1 }
    [[joint]]
    name = "free"
    kind = "revolute"
    ant = 5
    alpha = -0.8
    d = 0.05
"#;

/// The parallelogram robot of SYMORO's examples, with the lengths of the reference.
const SR400: &str = "(* Robotname = 'SR400' *)
NL = 8
NJ = 9
NF = 10
Type = 2
d2 = 0.5
d3 = 0.9
d4 = 0.15
d8 = 0.4
r4 = 0.8
ant = {0,1,2,3,4,5,1,7,8,3}
sigma = {0,0,0,0,0,0,0,0,0,2}
b = {1,0,0,0,0,0,0,0,0,0}
d = {0,d2,d3,d4,0,0,d2,-d8,d3,-d8}
r = {0,0,0,r4,0,0,0,0,0,0}
gamma = {0,0,0,0,0,0,0,0,0,pi/2}
alpha = {0,-pi/2,0,-pi/2,pi/2,-pi/2,-pi/2,0,0,0}
mu = {1,1,0,1,1,1,1,0,0,0}
theta = {th1,th2,th3,th4,th5,th6,th7,th8,th9,0}
IA = {IA1,IA2,0,IA4,IA5,IA6,IA7,0}
G = {0,0,G3}
";

#[test]
fn parallelogram_of_sr400_has_the_base_parameters_of_the_reference() {
    let robot = robot("sr400.par", SR400);
    let mechanism = &robot.mechanism;
    let names: Vec<&str> = mechanism.driven().iter().map(|j| j.name.as_str()).collect();
    assert_eq!(
        names,
        ["joint1", "joint2", "joint4", "joint5", "joint6", "joint7"]
    );
    // theta3 = theta7 - theta2 - pi/2, theta8 = theta2 - theta7
    let half = std::f64::consts::FRAC_PI_2;
    let sum = |terms: &[(usize, f64)], offset| {
        Follow::Sum(Affine {
            terms: terms.to_vec(),
            offset,
        })
    };
    let expected = [
        sum(&[(1, -1.0), (5, 1.0)], -half),
        sum(&[(1, 1.0), (5, -1.0)], 0.0),
    ];
    assert_eq!(mechanism.follows, expected);
    assert_eq!(robot.base.parameters.len(), 42);
    check(&robot);
    let rigid = SR400.replace(
        "IA = {IA1,IA2,0,IA4,IA5,IA6,IA7,0}",
        "IA = {0,0,0,0,0,0,0,0}",
    );
    let rigid = projected::robot("sr400.par", &rigid);
    assert_eq!(rigid.base.parameters.len(), 39);
}

/// Crank, coupler and rocker of no special lengths on a turning column, a tool on the coupler.
const FOUR_BAR: &str = r#"
    gravity = [1.0, -2.0, -9.0]
    [[joint]]
    name = "column"
    kind = "revolute"
    [[joint]]
    name = "crank"
    kind = "revolute"
    alpha = "pi/2"
    d = 0.1
    theta = 0.3
    [[joint]]
    name = "coupler"
    kind = "revolute"
    d = 0.2
    passive = true
    [[joint]]
    name = "tool"
    kind = "revolute"
    d = 0.3
    alpha = 0.7
    [[joint]]
    name = "rocker"
    kind = "revolute"
    ant = 1
    alpha = "-pi/2"
    d = 0.7
    r = 0.1
    passive = true
    [[loop]]
    name = "four-bar"
    cut = { ant = 3, d = 0.6, r = -0.02 }
    meets = { ant = 5, alpha = "pi", d = 0.5, r = 0.08 }
"#;

#[test]
fn four_bar_is_the_projected_tree() {
    // The crank turns fully: shortest and longest are shorter than the others together.
    for text in [
        FOUR_BAR.to_owned(),
        format!("{FOUR_BAR}    flipped = true\n"),
    ] {
        let robot = robot("four_bar.toml", &text);
        assert_eq!(robot.mechanism.driven, 3);
        assert_eq!(robot.mechanism.dyads.len(), 1);
        check_within(&robot, &|q| robot.mechanism.bend(q) > 0.2, 1e-7);
    }
}

/// A robot of the reference as the `.par` it comes from, with lengths of its symbols.
fn symoro(source: &Value, lengths: &str) -> String {
    let frames = source["frames"].as_array().unwrap();
    let list = |key: &str| {
        let of = |frame: &Value| match &frame[key] {
            // A length of this name would be the list itself.
            Value::String(text) if text == "d" => "0.5".to_owned(),
            Value::String(text) => text.clone(),
            number => number.to_string(),
        };
        let all: Vec<String> = frames.iter().map(of).collect();
        format!("{key} = {{{}}}\n", all.join(","))
    };
    let keys = [
        "ant", "sigma", "mu", "gamma", "b", "alpha", "d", "theta", "r",
    ];
    let lists: String = keys.into_iter().map(list).collect();
    // Lengths of joints that are cut are unknown to a tree.
    let known = lengths.lines().filter(|line| {
        let name = line.split(' ').next();
        name.is_some_and(|name| lists.contains(name))
    });
    let known: String = known.map(|line| format!("{line}\n")).collect();
    let name = source["name"].as_str().unwrap();
    let mut text = format!("(* Robotname = '{name}' *)\n{known}Type = 2\nG = {{0,0,G3}}\n");
    for key in ["NL", "NJ", "NF"] {
        text += &format!("{key} = {}\n", source[key]);
    }
    text += &lists;
    text + &format!(
        "IA = {{{}}}\n",
        vec!["0"; source["NL"].as_u64().unwrap() as usize].join(",")
    )
}

/// Lengths of TwoLoops and of AKR3000.
const TWO: &str = "g12 = 0.4\nd3 = 0.6\nd4 = 0.5\nd7 = 0.15\nd12 = 0.15\n";
const CYLINDERS: &str = "D3 = 0.35\nD4 = -0.4\nD7 = 0.8\nRL8 = 0.7\nD13 = 0.3\nD14 = 0.35\n\
                         gam13 = 2.6\ngam14 = -2.2\n";

/// A rhombus, two parallelograms in series that keep a hand level, and a robot whose two cylinders
/// move triangles. Their base parameters are counted by the rank of the energies of all links at
/// random postures, loops closed by Newton's method, in a program that shares nothing with this.
#[test]
fn loops_of_the_reference_are_the_projected_trees() {
    let Some(geometry) = reference("mdh_geometry.json") else {
        return;
    };
    for (name, lengths, dyads, parameters) in [
        ("testLoop", "", 0, 4),
        ("TwoLoops", TWO, 0, 22),
        ("AKR3000", CYLINDERS, 2, 54),
    ] {
        let robot = robot("x.par", &symoro(&geometry["robots"][name], lengths));
        assert_eq!(robot.mechanism.dyads.len(), dyads, "{name}");
        assert_eq!(robot.base.parameters.len(), parameters, "{name}");
        assert!(robot.base.gap > 1e6, "{name}: {:.1e}", robot.base.gap);
        check_within(&robot, &|q| robot.mechanism.bend(q) > 0.6, 1e-7);
    }
}

/// What SYMORO prints for robots with closed loops are the base parameters of their open trees.
#[test]
fn open_trees_have_the_base_parameters_that_symoro_prints_for_the_loops() {
    let (Some(geometry), Some(symoro_prints)) =
        (reference("mdh_geometry.json"), reference("opensymoro.json"))
    else {
        return;
    };
    for (name, lengths) in [
        ("testLoop", ""),
        ("TwoLoops", TWO),
        ("AKR3000", CYLINDERS),
        ("RX90_2loops", TRIANGLES),
        (
            "SR400",
            "d2 = 0.5\nd3 = 0.9\nd4 = 0.15\nd8 = 0.4\nr4 = 0.8\n",
        ),
    ] {
        let mut tree = geometry["robots"][name].clone();
        let links = tree["NL"].as_u64().unwrap() as usize;
        let frames = tree["frames"].as_array_mut().unwrap();
        frames.truncate(links);
        for frame in frames {
            frame["mu"] = json!(1);
        }
        (tree["NJ"], tree["NF"]) = (json!(links), json!(links));
        let text = symoro(&tree, lengths).replace("Type = 2", "Type = 1");
        let printed = &symoro_prints["results"][name]["base_params"]["n_rigid"];
        assert_eq!(
            robot("x.par", &text).base.parameters.len(),
            *printed,
            "{name}"
        );
    }
}

/// Lengths of RX90_2loops.
const TRIANGLES: &str = "d3 = 0.45\nd4 = 0.4\nd6 = 0.15\nd7 = 0.12\n";

/// Each loop of this description has three turning joints, the cut one included, whose points
/// d3, d6 and sqrt(d3^2 + d6^2) apart (d4 and d7 likewise) form a triangle: the motor of joint 3
/// cannot turn, and there are no base parameters to count. (The six constraints have rank six in
/// the six joints of the loops at every posture that closes them.)
#[test]
fn loops_of_the_reference_that_cannot_move_are_an_error_that_names_them() {
    let Some(geometry) = reference("mdh_geometry.json") else {
        return;
    };
    let text = symoro(&geometry["robots"]["RX90_2loops"], TRIANGLES);
    let error = builder::read_texts(&[("x.par", &text)]).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("is rigid"), "{error}");
}

#[test]
fn mimic_joints_are_the_projected_tree() {
    let robot = robot("hand.toml", HAND);
    let names: Vec<&str> = robot
        .mechanism
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, ["slide", "motor", "free", "finger", "tip", "rack"]);
    assert_eq!(robot.mechanism.driven, 3);
    check(&robot);
}

/// What a joint carries when it follows at ratio m along the same axis is m^2 of its inertia: one
/// base parameter for the pair, as counted by hand.
#[test]
fn mimic_on_parallel_axes_regroups_by_the_square_of_its_ratio() {
    let text = r#"
        gravity = [0, 0, 0]
        effects = []
        [[joint]]
        name = "a"
        kind = "revolute"
        [[joint]]
        name = "b"
        kind = "revolute"
        ant = 0
        mimic = { joint = "a", multiplier = -3 }
    "#;
    let robot = robot("pair.toml", text);
    let relations: Vec<String> = relations(&robot);
    assert_eq!(relations, ["ZZ1 + 9*ZZ2"]);
    check(&robot);
}

fn relations(robot: &Robot) -> Vec<String> {
    let parameters = robot.base.parameters.iter();
    parameters
        .map(|parameter| parameter.relation_text())
        .collect()
}
