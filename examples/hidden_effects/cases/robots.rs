//! Five robots, and their descriptions as a manufacturer writes them: a URDF and a companion.

use std::fmt::Write;

use super::random::Random;

/// A link with the joint that carries it.
#[derive(Clone, Copy)]
struct Link {
    /// Origin of the joint in the frame of the link before: translation, m, and roll, rad.
    at: [f64; 3],
    roll: f64,
    slides: bool,
    /// kg.
    mass: f64,
    /// Centre of mass, m.
    com: [f64; 3],
    /// Radii of gyration about it, m.
    radii: [f64; 3],
    /// Rotor inertia at the joint, kg m^2 or kg.
    rotor: f64,
    /// Torque that the joint is built for, N m or N: friction and noise go with it.
    scale: f64,
    /// Middle, half range and top speed of its motions.
    center: f64,
    reach: f64,
    speed: f64,
}

/// A kind of robot.
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    links: &'static [Link],
    /// From the frame of the last link to the flange, m.
    flange: [f64; 3],
}

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

const HALF: f64 = std::f64::consts::FRAC_PI_2;

const fn link(at: [f64; 3], roll: f64, mass: f64, com: [f64; 3], radii: [f64; 3]) -> Link {
    Link {
        at,
        roll,
        slides: false,
        mass,
        com,
        radii,
        rotor: 0.0,
        scale: 0.0,
        center: 0.0,
        reach: 0.0,
        speed: 0.0,
    }
}

impl Link {
    const fn driven(self, rotor: f64, scale: f64) -> Link {
        Link {
            rotor,
            scale,
            ..self
        }
    }

    const fn moving(self, center: f64, reach: f64, speed: f64) -> Link {
        Link {
            center,
            reach,
            speed,
            ..self
        }
    }

    const fn sliding(self) -> Link {
        Link {
            slides: true,
            ..self
        }
    }
}

/// All of them: a planar arm of two, an arm of three, a SCARA with a spindle, arms of six and seven.
pub static KINDS: [Kind; 5] = [
    Kind {
        name: "planar2",
        links: &[
            link(
                [0.0, 0.0, 0.22],
                0.0,
                9.0,
                [0.17, 0.0, 0.02],
                [0.06, 0.13, 0.13],
            )
            .driven(1.1, 45.0)
            .moving(0.1, 1.7, 2.8),
            link(
                [0.36, 0.0, 0.05],
                0.0,
                5.0,
                [0.15, 0.01, -0.02],
                [0.05, 0.1, 0.1],
            )
            .driven(0.25, 14.0)
            .moving(0.3, 1.8, 3.6),
        ],
        flange: [0.28, 0.0, 0.0],
    },
    Kind {
        name: "arm3",
        links: &[
            link(
                [0.0, 0.0, 0.4],
                0.0,
                18.0,
                [0.01, 0.02, -0.1],
                [0.14, 0.14, 0.11],
            )
            .driven(2.4, 70.0)
            .moving(0.0, 2.0, 2.2),
            link(
                [0.0, 0.0, 0.0],
                -HALF,
                11.0,
                [0.2, -0.01, 0.06],
                [0.07, 0.17, 0.17],
            )
            .driven(2.8, 150.0)
            .moving(-0.9, 0.9, 1.9),
            link(
                [0.46, 0.0, 0.0],
                0.0,
                6.5,
                [0.18, 0.02, 0.0],
                [0.05, 0.15, 0.15],
            )
            .driven(1.0, 55.0)
            .moving(1.1, 1.3, 2.6),
        ],
        flange: [0.42, 0.0, 0.0],
    },
    Kind {
        name: "scara4",
        links: &[
            link(
                [0.0, 0.0, 0.35],
                0.0,
                11.0,
                [0.19, 0.0, 0.03],
                [0.07, 0.14, 0.14],
            )
            .driven(1.9, 80.0)
            .moving(0.0, 1.8, 2.6),
            link(
                [0.4, 0.0, 0.08],
                0.0,
                8.0,
                [0.14, -0.01, 0.05],
                [0.07, 0.12, 0.12],
            )
            .driven(0.7, 34.0)
            .moving(0.4, 1.8, 3.2),
            link(
                [0.33, 0.0, 0.0],
                0.0,
                2.2,
                [0.0, 0.0, -0.1],
                [0.08, 0.08, 0.02],
            )
            .driven(6.0, 70.0)
            .moving(-0.1, 0.09, 0.45)
            .sliding(),
            link(
                [0.0, 0.0, -0.2],
                0.0,
                0.9,
                [0.015, 0.01, -0.02],
                [0.04, 0.04, 0.035],
            )
            .driven(0.012, 1.6)
            .moving(0.0, 2.4, 5.0),
        ],
        flange: [0.0, 0.0, -0.05],
    },
    Kind {
        name: "arm6",
        links: &[
            link(
                [0.0, 0.0, 0.16],
                0.0,
                7.5,
                [0.0, -0.02, 0.02],
                [0.06, 0.06, 0.05],
            )
            .driven(2.1, 85.0)
            .moving(0.0, 1.9, 2.2),
            link(
                [0.0, 0.14, 0.0],
                -HALF,
                13.0,
                [0.24, 0.0, 0.02],
                [0.06, 0.18, 0.18],
            )
            .driven(2.6, 150.0)
            .moving(-1.1, 0.8, 1.9),
            link(
                [0.48, 0.0, -0.12],
                0.0,
                5.5,
                [0.2, 0.0, 0.02],
                [0.04, 0.15, 0.15],
            )
            .driven(0.9, 60.0)
            .moving(1.2, 1.1, 2.6),
            link(
                [0.43, 0.0, 0.0],
                0.0,
                2.1,
                [0.0, 0.01, 0.05],
                [0.045, 0.04, 0.035],
            )
            .driven(0.16, 13.0)
            .moving(-0.6, 1.6, 3.2),
            link(
                [0.0, 0.0, 0.11],
                -HALF,
                2.0,
                [0.0, -0.01, 0.04],
                [0.045, 0.04, 0.035],
            )
            .driven(0.13, 9.5)
            .moving(-0.8, 1.5, 3.6),
            link(
                [0.0, 0.0, 0.1],
                HALF,
                1.1,
                [0.02, 0.0, 0.04],
                [0.05, 0.05, 0.04],
            )
            .driven(0.08, 5.0)
            .moving(0.0, 2.4, 4.4),
        ],
        flange: [0.0, 0.0, 0.08],
    },
    Kind {
        name: "arm7",
        links: &[
            link(
                [0.0, 0.0, 0.15],
                0.0,
                5.2,
                [0.0, 0.02, 0.1],
                [0.09, 0.09, 0.06],
            )
            .driven(1.3, 60.0)
            .moving(0.0, 1.8, 2.0),
            link(
                [0.0, 0.0, 0.2],
                HALF,
                5.4,
                [0.0, 0.09, 0.03],
                [0.09, 0.06, 0.09],
            )
            .driven(1.5, 110.0)
            .moving(0.5, 0.9, 1.9),
            link(
                [0.0, 0.21, 0.0],
                -HALF,
                4.1,
                [0.0, -0.02, 0.11],
                [0.09, 0.09, 0.05],
            )
            .driven(0.8, 42.0)
            .moving(0.0, 1.7, 2.4),
            link(
                [0.0, 0.0, 0.2],
                -HALF,
                3.6,
                [0.0, 0.08, 0.03],
                [0.08, 0.05, 0.08],
            )
            .driven(0.8, 55.0)
            .moving(-1.2, 0.9, 2.4),
            link(
                [0.0, 0.2, 0.0],
                HALF,
                2.3,
                [0.0, 0.02, 0.09],
                [0.07, 0.07, 0.04],
            )
            .driven(0.22, 14.0)
            .moving(0.0, 1.9, 3.2),
            link(
                [0.0, 0.0, 0.2],
                HALF,
                1.9,
                [0.0, 0.01, 0.01],
                [0.05, 0.04, 0.05],
            )
            .driven(0.18, 12.0)
            .moving(0.6, 1.3, 3.2),
            link(
                [0.0, 0.08, 0.0],
                -HALF,
                0.9,
                [0.015, 0.01, 0.04],
                [0.05, 0.05, 0.04],
            )
            .driven(0.07, 4.5)
            .moving(0.0, 2.3, 4.2),
        ],
        flange: [0.0, 0.0, 0.07],
    },
];

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
