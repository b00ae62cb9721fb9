//! How many base parameters a robot has, from Newton and Euler alone: the rank of the torques that
//! unit bodies on its links take.

use nalgebra::DMatrix;

use super::draw::{Draw, Inertial, Robot};
use super::newton_euler;

/// Singular values of unit columns beyond which a direction counts.
const THRESHOLD: f64 = 1e-8;

/// Bodies that span all ten parameters of a link: an entry of the tensor each, a mass at the
/// origin, and one on each axis.
fn bodies() -> Vec<Inertial> {
    let still = Inertial {
        mass: 0.0,
        xyz: [0.0; 3],
        rpy: [0.0; 3],
        inertia: [[0.0; 3]; 3],
    };
    let mut bodies = Vec::new();
    for (row, column) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
        let mut body = still;
        body.inertia[row][column] = 1.0;
        body.inertia[column][row] = 1.0;
        bodies.push(body);
    }
    for axis in 0..4 {
        let mut body = Inertial { mass: 1.0, ..still };
        if axis < 3 {
            body.xyz[axis] = 1.0;
        }
        bodies.push(body);
    }
    bodies
}

/// A joint that follows another: its position is multiplier times that of the other, plus offset.
#[derive(Clone, Copy, Debug)]
pub struct Mimic {
    pub joint: usize,
    pub of: usize,
    pub multiplier: f64,
    pub offset: f64,
}

/// The number of base parameters of the rigid bodies.
pub fn base_parameters(robot: &Robot) -> usize {
    base_parameters_with(robot, &[])
}

/// The same of a robot some of whose joints follow others, possibly one after the other: the
/// driven joints alone move, and feel the torques of what follows them by the ratios of the speeds.
pub fn base_parameters_with(robot: &Robot, mimics: &[Mimic]) -> usize {
    let moving = robot.moving();
    let coupling = Coupling::new(&moving, mimics);
    let states = 40.max(20 * moving.len() / coupling.driven);
    let mut draw = Draw::new(0xc0);
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); 10 * moving.len()];
    for _ in 0..states {
        let mut series = |range: f64| -> Vec<f64> {
            (0..coupling.driven).map(|_| range * draw.unit()).collect()
        };
        let (q, qd, qdd) = (series(3.0), series(3.0), series(5.0));
        let (q, qd, qdd) = (
            coupling.positions(&q),
            coupling.rates(&qd),
            coupling.rates(&qdd),
        );
        let mut bare = robot.clone();
        for joint in &mut bare.joints {
            joint.inertial = None;
        }
        for (link, &joint) in moving.iter().enumerate() {
            for (index, body) in bodies().into_iter().enumerate() {
                bare.joints[joint].inertial = Some(body);
                let torques = newton_euler::torques(&bare, &q, &qd, &qdd);
                columns[10 * link + index].extend(coupling.felt(&torques));
            }
            bare.joints[joint].inertial = None;
        }
    }
    rank(columns)
}

/// How the moving joints follow the driven ones among them.
struct Coupling {
    /// Number of driven joints.
    driven: usize,
    /// By moving joint: the driven one, the ratio of the speeds, the position at its zero.
    laws: Vec<(usize, f64, f64)>,
}

impl Coupling {
    fn new(moving: &[usize], mimics: &[Mimic]) -> Coupling {
        let follows = |joint: usize| mimics.iter().find(|mimic| mimic.joint == joint);
        let driven = moving.iter().filter(|&&joint| follows(joint).is_none());
        let driven: Vec<usize> = driven.copied().collect();
        let law = |&joint: &usize| {
            let (mut at, mut ratio, mut offset) = (joint, 1.0, 0.0);
            while let Some(mimic) = follows(at) {
                offset += ratio * mimic.offset;
                (at, ratio) = (mimic.of, ratio * mimic.multiplier);
            }
            let driver = driven.iter().position(|&known| known == at);
            (driver.unwrap(), ratio, offset)
        };
        Coupling {
            laws: moving.iter().map(law).collect(),
            driven: driven.len(),
        }
    }

    fn positions(&self, driven: &[f64]) -> Vec<f64> {
        let laws = self.laws.iter();
        laws.map(|&(driver, ratio, offset)| ratio * driven[driver] + offset)
            .collect()
    }

    fn rates(&self, driven: &[f64]) -> Vec<f64> {
        let laws = self.laws.iter();
        laws.map(|&(driver, ratio, _)| ratio * driven[driver])
            .collect()
    }

    fn felt(&self, torques: &[f64]) -> Vec<f64> {
        let mut felt = vec![0.0; self.driven];
        for (torque, &(driver, ratio, _)) in torques.iter().zip(&self.laws) {
            felt[driver] += ratio * torque;
        }
        felt
    }
}

fn rank(columns: Vec<Vec<f64>>) -> usize {
    let norm = |column: &Vec<f64>| column.iter().map(|x| x * x).sum::<f64>().sqrt();
    let largest = columns.iter().map(norm).fold(0.0, f64::max);
    let units: Vec<Vec<f64>> = columns
        .into_iter()
        .filter(|column| norm(column) > 1e-10 * largest)
        .map(|column| {
            let size = norm(&column);
            column.into_iter().map(|x| x / size).collect()
        })
        .collect();
    let w = DMatrix::from_fn(units[0].len(), units.len(), |row, column| {
        units[column][row]
    });
    let sigma = w.qr().r().singular_values();
    let kept = sigma.iter().filter(|&&value| value > THRESHOLD);
    let (kept, least) = kept.fold((0, f64::INFINITY), |(n, least), &x| (n + 1, least.min(x)));
    let dropped = sigma.iter().filter(|&&value| value <= THRESHOLD);
    let next = dropped.fold(0.0, |a: f64, &x| a.max(x));
    assert!(
        least > 1e3 * next,
        "the rank is not clear: {least:e} over {next:e}"
    );
    kept
}
