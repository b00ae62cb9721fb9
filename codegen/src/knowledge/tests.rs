//! Values and tolerances against their definition: random individuals of a description.

use nalgebra::{DVector, Matrix3, Rotation3, Vector3};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use super::Knowledge;
use crate::builder::read_texts;
use crate::describe::{Geometry, UrdfInertial};
use crate::mechanism::Mechanism;
use crate::robot::Robot;

/// Three joints, a tool on a fixed joint, bodies turned and away from their frames.
const URDF: &str = r#"<robot name="arm"><link name="base"/>
<link name="one"><inertial><origin xyz="0.1 0.02 -0.05" rpy="0.3 0 0.1"/><mass value="6"/>
<inertia ixx="0.05" ixy="0.002" ixz="0" iyy="0.07" iyz="-0.001" izz="0.04"/></inertial></link>
<link name="two"><inertial><origin xyz="0.2 0 0.03"/><mass value="4"/>
<inertia ixx="0.01" ixy="0" ixz="0.001" iyy="0.06" iyz="0" izz="0.06"/></inertial></link>
<link name="three"><inertial><origin xyz="0 0.05 0.1"/><mass value="2"/>
<inertia ixx="0.012" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.004"/></inertial></link>
<link name="tool"><inertial><origin xyz="0.03 0 0.02" rpy="0 0.5 0"/><mass value="0.7"/>
<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.0015"/></inertial></link>
<joint name="a" type="revolute"><parent link="base"/><child link="one"/>
<origin xyz="0 0 0.3"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="one"/><child link="two"/>
<origin xyz="0 0.1 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="1"/></joint>
<joint name="c" type="revolute"><parent link="two"/><child link="three"/>
<origin xyz="0.4 0 0"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint>
<joint name="flange" type="fixed"><parent link="three"/><child link="tool"/>
<origin xyz="0 0 0.2" rpy="0 0.4 0"/></joint></robot>"#;

const HEAD: &str = "name = 'arm'\nurdf = 'arm.urdf'\n\
                    effects = ['viscous', 'coulomb', 'rotor_inertia']\n";

const VALUES: &str = "[parameters]\nIA1 = 0.5\nFV1 = 3.0\nFS1 = 2.0\nIA2 = 0.4\nFV2 = 2.0\n\
                      FS2 = 1.0\nIA3 = 0.1\nFV3 = 1.0\nFS3 = 0.5\n";

const PRIOR: &str = "[prior]\nmass = 0.01\ncom = 0.001\ncom_fraction = 0.01\ninertia = 0.015\n\
                     inertia_rotation = 0.01\nrotor_inertia = 0.02\nfriction = 0.3\n";

fn robot(toml: &str) -> Robot {
    read_texts(&[("arm.toml", toml), ("arm.urdf", URDF)]).unwrap()
}

/// Sum of uniform numbers: variance one.
fn normal(generator: &mut Pcg64Mcg) -> f64 {
    let uniform = (0..12).map(|_| f64::from(generator.next_u32()) / f64::from(u32::MAX));
    uniform.sum::<f64>() - 6.0
}

/// Another individual of the same description, as the words of `[prior]` say.
fn individual(body: &UrdfInertial, generator: &mut Pcg64Mcg) -> UrdfInertial {
    let mut body = *body;
    body.mass *= 1.0 + 0.01 * normal(generator);
    for along in &mut body.origin.xyz {
        *along *= 1.0 + 0.01 * normal(generator);
        *along += 0.001 * normal(generator);
    }
    let [xx, xy, xz, yy, yz, zz] = body.inertia;
    let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigen();
    let moments = own
        .eigenvalues
        .map(|i| i * (1.0 + 0.015 * normal(generator)));
    let turn = Vector3::from_fn(|_, _| 0.01 * normal(generator));
    let axes = Rotation3::new(turn).matrix() * own.eigenvectors;
    let j = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
    body.inertia = [j.m11, j.m12, j.m13, j.m22, j.m23, j.m33];
    body
}

/// Base parameters of a random individual of the robot.
fn sample(robot: &Robot, generator: &mut Pcg64Mcg) -> DVector<f64> {
    let mut other = robot.clone();
    if let Geometry::Urdf(tree) = &mut other.description.geometry {
        for link in &mut tree.links {
            link.inertial = link
                .inertial
                .as_ref()
                .map(|body| individual(body, generator));
        }
    }
    for (name, value) in &mut other.description.parameters {
        let size = if name.starts_with("IA") { 0.02 } else { 0.3 };
        *value *= 1.0 + size * normal(generator);
    }
    other.mechanism = Mechanism::new(&other.description);
    let nominal = super::values::Values::of(&other).nominal(&other);
    DVector::from_iterator(nominal.len(), nominal.into_iter().map(Option::unwrap))
}

/// A X - b of every row.
fn whitened(rows: &[Vec<f64>], x: &DVector<f64>) -> Vec<f64> {
    let error = |row: &Vec<f64>| {
        let product: f64 = row.iter().zip(x.iter()).map(|(a, x)| a * x).sum();
        product - row[x.len()]
    };
    rows.iter().map(error).collect()
}

#[test]
fn random_individuals_have_the_covariance_of_the_rows() {
    let robot = robot(&format!("{HEAD}{VALUES}{PRIOR}"));
    let known = Knowledge::of(&robot);
    let np = robot.base.parameters.len();
    assert_eq!(known.prior.len(), np, "everything is described");
    let mut generator = Pcg64Mcg::new(7);
    const SAMPLES: usize = 4000;
    let mut covariance = vec![vec![0.0; np]; np];
    for _ in 0..SAMPLES {
        let error = whitened(&known.prior, &sample(&robot, &mut generator));
        for i in 0..np {
            for k in 0..np {
                covariance[i][k] += error[i] * error[k] / SAMPLES as f64;
            }
        }
    }
    // An entry scatters by 1 / sqrt(samples) = 1.6 %, a variance by sqrt(2) times that.
    for (i, row) in covariance.iter().enumerate() {
        for (k, value) in row.iter().enumerate() {
            let expected = f64::from(u8::from(i == k));
            assert!((value - expected).abs() < 0.1, "{i} {k}: {value}");
        }
    }
}

#[test]
fn rows_are_centred_on_the_nominal_values() {
    let robot = robot(&format!("{HEAD}{VALUES}{PRIOR}"));
    let known = Knowledge::of(&robot);
    let nominal: Vec<f64> = known.nominal.iter().map(|x| x.unwrap()).collect();
    for error in whitened(&known.prior, &DVector::from_vec(nominal)) {
        assert!(error.abs() < 1e-6, "{error}");
    }
}

#[test]
fn what_is_not_described_is_left_open() {
    // Without values of friction and rotors nothing bounds them, nor what they are regrouped with.
    let robot = robot(&format!("{HEAD}{PRIOR}"));
    let known = Knowledge::of(&robot);
    let open = |name: &str| name.starts_with('F') || name.contains("IA");
    let mut rows = 0;
    for (column, parameter) in robot.base.parameters.iter().enumerate() {
        let touched = known.prior.iter().any(|row| row[column] != 0.0);
        let unknown = parameter.relation.iter().any(|(_, name)| open(name));
        assert_eq!(touched, !unknown, "{}", parameter.name);
        assert_eq!(
            known.nominal[column].is_some(),
            !unknown,
            "{}",
            parameter.name
        );
        rows += usize::from(touched);
    }
    assert_eq!(known.prior.len(), rows);
}

#[test]
fn a_stated_base_parameter_comes_before_the_described_bodies() {
    let robot = robot(&format!(
        "{HEAD}[parameters]\nXXR3 = 0.25\nXX3 = 9.0\nM3 = 1.0\n"
    ));
    let known = Knowledge::of(&robot);
    let place = |name: &str| robot.base.parameters.iter().position(|p| p.name == name);
    assert_eq!(known.nominal[place("XXR3").unwrap()], Some(0.25));
    assert!(known.prior.is_empty(), "no [prior]");
}

#[test]
fn terms_and_values_give_the_described_rigid_body() {
    let robot = robot(HEAD);
    let known = Knowledge::of(&robot);
    let values = super::values::Values::of(&robot);
    let mut sums = vec![0.0; robot.base.parameters.len()];
    for term in &known.terms {
        let name = format!(
            "{}{}",
            crate::mechanism::inertia::NAMES[term.parameter],
            term.link + 1
        );
        sums[term.column] += term.factor * values.standard(&name).unwrap();
    }
    for (sum, rigid) in sums.iter().zip(&known.rigid) {
        assert!((sum - rigid).abs() < 1e-12 * rigid.abs().max(1.0));
    }
}
