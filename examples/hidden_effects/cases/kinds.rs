//! Five kinds of robot.

/// A link with the joint that carries it.
#[derive(Clone, Copy)]
pub struct Link {
    /// Origin of the joint in the frame of the link before: translation, m, and roll, rad.
    pub at: [f64; 3],
    pub roll: f64,
    pub slides: bool,
    /// kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub com: [f64; 3],
    /// Radii of gyration about it, m.
    pub radii: [f64; 3],
    /// Rotor inertia at the joint, kg m^2 or kg.
    pub rotor: f64,
    /// Torque that the joint is built for, N m or N: friction and noise go with it.
    pub scale: f64,
    /// Middle, half range and top speed of its motions.
    pub center: f64,
    pub reach: f64,
    pub speed: f64,
}

/// A kind of robot.
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Its links, from the base.
    pub links: &'static [Link],
    /// From the frame of the last link to the flange, m.
    pub flange: [f64; 3],
}

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
