//! Five robots, and their descriptions as a manufacturer writes them: a URDF and a companion.

use std::fmt::Write;

use super::kinds::{Kind, Link};
use super::random::Random;

/// What a joint is built for.
#[derive(Clone, Copy, Debug)]
pub struct Rating {
    /// Torque, N m or N.
    pub scale: f64,
    /// Middle, half range and top speed of its motions; rad or m.
    pub center: f64,
    pub reach: f64,
    pub speed: f64,
    /// Whether it is prismatic.
    pub slides: bool,
}

/// A robot as it is described, and the sigma of what its description says.
pub struct Described {
    /// Its kind.
    pub kind: &'static str,
    /// `robot.urdf` and `robot.toml`.
    pub urdf: String,
    pub toml: String,
    /// Its joints.
    pub ratings: Vec<Rating>,
}

/// Sigmas of the `[prior]` table: mass, centre of mass (m, fraction), inertia (fraction, rotation in
/// rad), rotor inertia, friction.
pub const PRIOR: [f64; 7] = [0.01, 0.001, 0.01, 0.015, 0.01, 0.01, 1.0];

/// An exemplar of a kind: its values are its own, as those of another size or make would be.
pub fn describe(kind: &Kind, random: &mut Random) -> Described {
    let mut urdf = format!(
        "<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base\"/>\n",
        kind.name
    );
    let mut parameters = String::new();
    let size = random.ratio(0.9, 1.1);
    let mut parent = "base".to_owned();
    for (place, link) in kind.links.iter().enumerate() {
        let number = place + 1;
        let [rotor, viscous, coulomb] = [
            link.rotor * random.ratio(0.8, 1.25),
            0.07 * link.scale / link.speed * random.ratio(0.7, 1.4),
            0.05 * link.scale * random.ratio(0.7, 1.4),
        ];
        urdf += &body(number, link, size, random);
        urdf += &joint(number, link, &parent, (size, viscous, coulomb));
        let _ = write!(
            parameters,
            "IA{number} = {rotor:.6}\nFV{number} = {viscous:.6}\nFS{number} = {coulomb:.6}\n"
        );
        parent = format!("link{number}");
    }
    let at = kind.flange.map(|x| x * size);
    let _ = write!(
        urdf,
        "  <link name=\"flange\"/>\n  <joint name=\"to_flange\" type=\"fixed\">\n    <parent \
         link=\"{parent}\"/>\n    <child link=\"flange\"/>\n    <origin xyz=\"{}\" rpy=\"0 0 \
         0\"/>\n  </joint>\n</robot>\n",
        numbers(&at)
    );
    Described {
        kind: kind.name,
        urdf,
        toml: companion(&parameters),
        ratings: kind.links.iter().map(rating).collect(),
    }
}

fn rating(link: &Link) -> Rating {
    Rating {
        scale: link.scale,
        center: link.center,
        reach: link.reach,
        speed: link.speed,
        slides: link.slides,
    }
}

fn body(number: usize, link: &Link, size: f64, random: &mut Random) -> String {
    let mass = link.mass * size * random.ratio(0.85, 1.15);
    let com = link.com.map(|x| size * (x + 0.003 * random.normal()));
    let moments = link
        .radii
        .map(|r| mass * (size * r).powi(2) * random.ratio(0.85, 1.15));
    let small = moments.iter().fold(f64::INFINITY, |a: f64, b| a.min(*b));
    let [xy, xz, yz] = [(); 3].map(|()| 0.04 * small * random.normal());
    let [xx, yy, zz] = moments;
    format!(
        "  <link name=\"link{number}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 \
         0\"/>\n      <mass value=\"{mass:.6}\"/>\n      <inertia ixx=\"{xx:.8}\" ixy=\"{xy:.8}\" \
         ixz=\"{xz:.8}\" iyy=\"{yy:.8}\" iyz=\"{yz:.8}\" izz=\"{zz:.8}\"/>\n    </inertial>\n  \
         </link>\n",
        numbers(&com)
    )
}

fn joint(
    number: usize,
    link: &Link,
    parent: &str,
    (size, viscous, coulomb): (f64, f64, f64),
) -> String {
    let kind = if link.slides { "prismatic" } else { "revolute" };
    let (lower, upper) = (
        link.center - 1.25 * link.reach,
        link.center + 1.25 * link.reach,
    );
    format!(
        "  <joint name=\"joint{number}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    \
         <child link=\"link{number}\"/>\n    <origin xyz=\"{}\" rpy=\"{} 0 0\"/>\n    <axis xyz=\"0 \
         0 1\"/>\n    <limit lower=\"{lower:.4}\" upper=\"{upper:.4}\" effort=\"{}\" \
         velocity=\"{}\"/>\n    <dynamics damping=\"{viscous:.6}\" friction=\"{coulomb:.6}\"/>\n  \
         </joint>\n",
        numbers(&link.at.map(|x| x * size)),
        link.roll,
        4.0 * link.scale,
        1.5 * link.speed,
    )
}

fn companion(parameters: &str) -> String {
    let [mass, com, fraction, inertia, rotation, rotor, friction] = PRIOR;
    format!(
        "name = \"robot\"\nurdf = \"robot.urdf\"\ngravity = [0.0, 0.0, -9.81]\neffects = \
         [\"viscous\", \"coulomb\", \"rotor_inertia\"]\n\n[drives]\ntorque = \"commanded\"\n\n\
         [parameters]   # of the last calibration\n{parameters}\n[prior]   # one sigma of the values \
         above and of the URDF's inertial values\nmass = {mass}\ncom = {com}\ncom_fraction = \
         {fraction}\ninertia = {inertia}\ninertia_rotation = {rotation}\nrotor_inertia = \
         {rotor}\nfriction = {friction}\n"
    )
}

fn numbers(values: &[f64; 3]) -> String {
    let [x, y, z] = values;
    format!("{x:.7} {y:.7} {z:.7}")
}
