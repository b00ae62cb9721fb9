//! An arm of four joints in variants, and a motion of it.

use idim_codegen::{Robot, builder};
use idim_runtime::diagnose::{Catalogue, Hypothesis, Signals, TorqueColumn};

use crate::catalogue::Effects;
use crate::catalogue::evaluate::Motion;
use crate::catalogue::geometry::{described, inertial, rigid};

/// What distinguishes an arm from the plain one.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    /// Gravity in frame 0.
    pub gravity: [f64; 3],
    /// Origin of the elbow on the upper arm, off all axes.
    pub elbow: [f64; 3],
    /// Mass at the tool, kg.
    pub tool: f64,
    /// Whether the tool is a point.
    pub point: bool,
}

pub const PLAIN: Arm = Arm {
    gravity: [0.0, 0.0, -9.81],
    elbow: [0.4, 0.05, 0.1],
    tool: 0.0,
    point: false,
};

impl Arm {
    pub fn robot(self) -> Robot {
        let [gx, gy, gz] = self.gravity;
        let [x, y, z] = self.elbow;
        let m = self.tool;
        let j = if self.point { 0.0 } else { 0.01 * m };
        let companion = format!("urdf = \"arm.urdf\"\ngravity = [{gx:?}, {gy:?}, {gz:?}]\n");
        let tool = match m > 0.0 {
            false => String::new(),
            true => format!(
                r#"<inertial><origin xyz="{c} 0 {c}"/><mass value="{m}"/><inertia ixx="{j}"
                ixy="0" ixz="0" iyy="{j}" iyz="0" izz="{j}"/></inertial>"#,
                c = if self.point { 0.0 } else { 0.03 },
            ),
        };
        let urdf = format!(
            r#"<robot name="arm"><link name="base"/>
{shoulder}{upper}{fore}{hand}<link name="flange">{tool}</link>
<joint name="yaw" type="revolute"><parent link="base"/><child link="shoulder"/>
  <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<joint name="pitch" type="revolute"><parent link="shoulder"/><child link="upper"/>
  <origin xyz="0.06 0 0.1"/><axis xyz="0 1 0"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
  <origin xyz="{x:?} {y:?} {z:?}"/><axis xyz="0 1 0"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<joint name="roll" type="revolute"><parent link="fore"/><child link="hand"/>
  <origin xyz="0.3 0.02 0"/><axis xyz="1 0 0"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<joint name="mount" type="fixed"><parent link="hand"/><child link="flange"/>
  <origin xyz="0.1 0.02 0.03" rpy="0 0.4 0"/></joint>
</robot>"#,
            shoulder = link("shoulder", 3.0),
            upper = link("upper", 2.5),
            fore = link("fore", 1.5),
            hand = link("hand", 0.5),
        );
        builder::read_texts(&[("arm.toml", &companion), ("arm.urdf", &urdf)]).unwrap()
    }
}

fn link(name: &str, mass: f64) -> String {
    let (a, b, c) = (0.02 * mass, 0.03 * mass, 0.04 * mass);
    format!(
        r#"<link name="{name}"><inertial><origin xyz="0.1 0.02 -0.03" rpy="0.1 0.2 0.3"/>
<mass value="{mass}"/><inertia ixx="{a}" ixy="0.001" ixz="0" iyy="{b}" iyz="0" izz="{c}"/></inertial></link>"#
    )
}

/// A motion of four joints in closed form, with the torques of a robot along it.
pub struct Course {
    pub t: Vec<f64>,
    pub q: Vec<Vec<f64>>,
    pub qd: Vec<Vec<f64>>,
    pub qdd: Vec<Vec<f64>>,
    pub tau: Vec<Vec<f64>>,
    pub parameters: Vec<f64>,
    pub dead_band: Vec<f64>,
}

pub const RATE: f64 = 200.0;

impl Course {
    pub fn of(robot: &Robot) -> Course {
        let t: Vec<f64> = (0..600).map(|i| f64::from(i) / RATE).collect();
        let wave = |derivative: u32| -> Vec<Vec<f64>> {
            let joint = |j: u32| {
                let w = 2.0 + 0.7 * f64::from(j);
                let phase = f64::from(j) + f64::from(derivative) * std::f64::consts::FRAC_PI_2;
                let size = 0.9 * w.powi(derivative as i32);
                t.iter().map(|t| size * (w * t + phase).sin()).collect()
            };
            (0..4).map(joint).collect()
        };
        let mut course = Course {
            q: wave(0),
            qd: wave(1),
            qdd: wave(2),
            t,
            tau: vec![],
            parameters: base(robot),
            dead_band: vec![0.05; 4],
        };
        course.tau = torque(robot, &course.motion());
        course
    }

    pub fn motion(&self) -> Motion<'_> {
        Motion {
            q: &self.q,
            qd: &self.qd,
            qdd: &self.qdd,
            slip: None,
            still: false,
            shift: None,
        }
    }

    pub fn signals(&self) -> Signals<'_> {
        Signals {
            rate_hz: RATE,
            t: &self.t,
            q: &self.q,
            qd: &self.qd,
            qdd: &self.qdd,
            tau_model: &self.tau,
            tau_rigid: &self.tau,
            parameters: &self.parameters,
            dead_band: &self.dead_band,
        }
    }

    /// The columns of an entry on joints, counted from 0, with a shape.
    pub fn columns(
        &self,
        effects: &Effects,
        name: &str,
        joints: &[usize],
        shape: &[f64],
    ) -> Vec<TorqueColumn> {
        let entry = effects
            .entries()
            .iter()
            .position(|entry| entry.name == name);
        let hypothesis = Hypothesis {
            entry: entry.unwrap(),
            joints: joints.to_vec(),
            grid: vec![],
            bounds: vec![],
            least: 0.0,
        };
        effects.columns(&hypothesis, shape, &self.signals())
    }
}

/// Inverse dynamics of the described rigid bodies.
pub fn torque(robot: &Robot, motion: &Motion<'_>) -> Vec<Vec<f64>> {
    let x: Vec<f64> = described(robot).into_iter().flatten().collect();
    rigid(&robot.mechanism, |_, _| true).torque(motion, &x)
}

/// Base parameters of the described rigid bodies.
fn base(robot: &Robot) -> Vec<f64> {
    let standard = described(robot);
    let value = |name: &String| inertial(name).map_or(0.0, |(link, place)| standard[link][place]);
    let parameters = robot.base.parameters.iter();
    parameters
        .map(|p| {
            p.relation
                .iter()
                .map(|(factor, name)| factor * value(name))
                .sum()
        })
        .collect()
}

/// A column on all joints, zero where it does not act.
pub fn spread(column: &TorqueColumn, len: usize) -> Vec<Vec<f64>> {
    let mut all = vec![vec![0.0; len]; 4];
    for (joint, torque) in &column.torque {
        all[*joint].clone_from(torque);
    }
    all
}

/// Largest difference of two sets of series.
pub fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.fold(0.0, |all: f64, (a, b)| all.max((a - b).abs()))
}

/// (a - b) / step.
pub fn slope(a: &[Vec<f64>], b: &[Vec<f64>], step: f64) -> Vec<Vec<f64>> {
    let of_joint = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| (a - b) / step).collect()
    };
    a.iter().zip(b).map(of_joint).collect()
}

/// Largest absolute value.
pub fn size(a: &[Vec<f64>]) -> f64 {
    a.iter().flatten().fold(0.0, |all: f64, x| all.max(x.abs()))
}
