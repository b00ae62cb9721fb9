//! The equations that tie gains, robot and load together, and their solution.

use super::super::payload;
use crate::estimate::{Estimate, EstimateError, Triangle, estimate, from_triangles};
use crate::knowledge::STANDARD;
use crate::model::IdentificationModel;
use crate::observe::{Equations, ModelKind, Observations};
use crate::settings::Weights;

/// Most times that the equations are solved.
const ROUNDS: usize = 50;

/// The factors rest when none moves by more than this share of its sigma, or of itself.
const SETTLED: (f64, f64) = (0.01, 1e-9);

/// Logs without and with a load as equations of np + 10 parameters, those of the robot and of the
/// load, and of one factor for each joint after them.
pub(super) struct System {
    /// np, the number of parameters of the robot.
    pub np: usize,
    /// Number n of joints.
    pub joints: usize,
    /// What is known of the load.
    pub known: [Option<f64>; 10],
    /// Weights of the joints.
    pub weights: Weights,
    /// One for each log, the torques as logged.
    pub logs: Vec<Observations>,
}

/// Where the equations are linearised.
#[derive(Clone)]
pub(super) struct Point {
    /// Factor of each joint.
    pub factors: Vec<f64>,
    /// By joint, the np + 10 parameters by which its torque, as logged, is predicted.
    pub along: Vec<Vec<f64>>,
}

/// What the rounds end with.
pub(super) struct Solved {
    pub point: Point,
    pub estimate: Estimate,
    /// Joints whose factor is in the equations.
    pub reached: Vec<bool>,
    pub rounds: usize,
    pub converged: bool,
}

impl System {
    /// Number of columns with all factors.
    pub fn columns(&self) -> usize {
        self.np + STANDARD.len() + self.joints
    }

    /// Column of the factor of a joint.
    pub fn factor(&self, joint: usize) -> usize {
        self.np + STANDARD.len() + joint
    }

    /// Robot and load from all torques as they are, the load's mass unknown.
    pub fn as_logged(&self) -> Result<Estimate, EstimateError> {
        let together = joined(&self.logs);
        let triangles = Triangle::of_all(&together.blocks)?;
        from_triangles(&triangles, self.factor(0), self.weights)
    }

    /// Gauss-Newton rounds from `start`, the estimate with torques as they are.
    pub fn solve(&self, start: &Estimate) -> Result<Solved, EstimateError> {
        let mut reached = self.reached(start)?;
        let mut point = self.own()?;
        let mut rounds = 0;
        loop {
            rounds += 1;
            let estimate = self.round(&point, &reached)?;
            let (next, lost) = self.moved(&estimate, &reached);
            let settled = self.settled(&estimate, &point, &next);
            if (settled && !lost.contains(&true)) || rounds == ROUNDS {
                return Ok(Solved {
                    point,
                    estimate,
                    reached,
                    rounds,
                    converged: settled,
                });
            }
            for (reached, lost) in reached.iter_mut().zip(lost) {
                *reached &= !lost;
            }
            point = next;
        }
    }

    /// Which factors the load tells. Along predictions of one robot, equations that leave a factor
    /// open are singular to the last digits, whatever the noise.
    fn reached(&self, start: &Estimate) -> Result<Vec<bool>, EstimateError> {
        let point = Point {
            factors: vec![1.0; self.joints],
            along: vec![start.solution.clone(); self.joints],
        };
        let all = self.round(&point, &vec![true; self.joints])?;
        let told = |joint: usize| all.determined[self.factor(joint)];
        Ok((0..self.joints).map(told).collect())
    }

    /// Each joint's torque as the joint by itself explains it, which no gain can spoil.
    fn own(&self) -> Result<Point, EstimateError> {
        let together = joined(&self.logs);
        let alone = |block: &Equations| match block.columns.is_empty() {
            true => Ok(vec![0.0; self.factor(0)]),
            false => estimate(std::slice::from_ref(block), self.factor(0), Weights::None)
                .map(|found| found.solution),
        };
        Ok(Point {
            factors: vec![1.0; self.joints],
            along: together
                .blocks
                .iter()
                .map(alone)
                .collect::<Result<_, _>>()?,
        })
    }

    fn round(&self, point: &Point, reached: &[bool]) -> Result<Estimate, EstimateError> {
        let linear: Vec<_> = self.linearised(point, reached).collect();
        let triangles = Triangle::of_all(&joined(&linear).blocks)?;
        from_triangles(&triangles, self.columns(), self.weights)
    }

    /// The equations of each log about a point: of joint j, in units of its logged torque,
    /// \\( (W_j X + W_j K_l X_{load} - t_j g_j) / g_j^0 = \tau_j - t_j \\), where
    /// \\( t_j \\) is the prediction at the point. It has none of the noise of \\( \tau_j \\), and
    /// the right side has it once.
    pub fn linearised<'a>(
        &'a self,
        point: &'a Point,
        reached: &'a [bool],
    ) -> impl Iterator<Item = Observations> + 'a {
        self.logs.iter().map(|log| Observations {
            model: log.model,
            blocks: (0..self.joints)
                .map(|joint| self.joint(joint, &log.blocks[joint], point, reached[joint]))
                .collect(),
        })
    }

    fn joint(&self, joint: usize, block: &Equations, point: &Point, reached: bool) -> Equations {
        let share = 1.0 / point.factors[joint];
        let predicted = block.product(&point.along[joint]);
        let mut y = block.y.clone().unwrap_or_default();
        let mut less = |factor: f64, column: &[f64]| {
            for (y, value) in y.iter_mut().zip(column) {
                *y -= factor * value;
            }
        };
        let (mut columns, mut w) = (Vec::new(), Vec::new());
        for (k, &column) in block.columns.iter().enumerate() {
            let known = column.checked_sub(self.np).and_then(|at| self.known[at]);
            match known {
                Some(value) => less(share * value, block.column(k)),
                None => {
                    columns.push(column);
                    w.extend(block.column(k).iter().map(|value| share * value));
                }
            }
        }
        if reached {
            less(1.0, &predicted);
            columns.push(self.factor(joint));
            w.extend(predicted.iter().map(|value| -share * value));
        }
        Equations {
            columns,
            rows: block.rows,
            w,
            y: block.y.as_ref().map(|_| y),
        }
    }

    /// The point of an estimate, and the joints whose factor it lost: no drive turns torque round.
    fn moved(&self, estimate: &Estimate, reached: &[bool]) -> (Point, Vec<bool>) {
        let found = |joint: usize| estimate.solution[self.factor(joint)];
        let good = |joint: usize| found(joint).is_finite() && found(joint) > 0.0;
        let lost = (0..self.joints).map(|joint| reached[joint] && !good(joint));
        let factor = |joint: usize| match reached[joint] && good(joint) {
            true => found(joint),
            false => 1.0,
        };
        let factors: Vec<f64> = (0..self.joints).map(factor).collect();
        let mut all = estimate.solution[..self.factor(0)].to_vec();
        for (value, known) in all[self.np..].iter_mut().zip(self.known) {
            *value = known.unwrap_or(*value);
        }
        let scaled = |factor: &f64| all.iter().map(|value| value / factor).collect();
        let along = factors.iter().map(scaled).collect();
        (Point { factors, along }, lost.collect())
    }

    fn settled(&self, estimate: &Estimate, point: &Point, next: &Point) -> bool {
        let (of_sigma, of_itself) = SETTLED;
        (0..self.joints).all(|joint| {
            let sigma = estimate.sigma[self.factor(joint)].unwrap_or(0.0);
            let (before, after) = (point.factors[joint], next.factors[joint]);
            (after - before).abs() <= (of_sigma * sigma).max(of_itself * after)
        })
    }
}

/// The equations of a log with ten columns of the load beside the robot's own: those of `carried`
/// for a loaded robot, zeros for the robot alone.
pub(super) fn beside(
    model: &dyn IdentificationModel,
    observed: &Observations,
    carried: &[Vec<f64>; 10],
    loaded: bool,
) -> Observations {
    let np = model.columns().len();
    let block = |block: &Equations| {
        let mut wide = block.clone();
        for (parameter, factors) in carried.iter().enumerate() {
            if payload::felt(block, factors) {
                wide.columns.push(np + parameter);
                match loaded {
                    true => wide.w.extend(block.product(factors)),
                    false => wide.w.resize(wide.w.len() + block.rows, 0.0),
                }
            }
        }
        wide
    };
    Observations {
        model: ModelKind::Explicit,
        blocks: observed.blocks.iter().map(block).collect(),
    }
}

/// All logs as one.
pub(super) fn joined(logs: &[Observations]) -> Observations {
    let mut together = Observations {
        model: ModelKind::Explicit,
        blocks: Vec::new(),
    };
    for log in logs {
        match together.blocks.is_empty() {
            true => together.clone_from(log),
            false => together.append(log),
        }
    }
    together
}
