//! The minimum by damped Newton steps, while the weight of the description falls to what was asked.

use faer::prelude::Solve;
use faer::{Mat, Side};

use super::bodies::{Described, LEFT, Local, divergence};
use super::pseudo::Pseudo;
use super::{Bound, PhysicalError, Problem, Scalar};

/// At first the description counts as much as the data speak against it, and a third of that in
/// every further round: each begins where Newton's method converges fast.
const FALL: f64 = 0.3;

/// Steps of one round, and half the squared Newton decrement at which it ends, as a share of the
/// weight: the method converges quadratically there.
const STEPS: usize = 20_000;
const ENOUGH: f64 = 1e-12;

/// What free scalars are held to zero with, per unit squared, as a share of the weight; far below
/// what any log says of them.
const HELD: f64 = 1e-8;

/// What is added to a Hessian of unit diagonal that rounding has made indefinite.
const RIDGES: [f64; 6] = [0.0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-7];

/// Room that the first bodies have inside of their shapes, as a share of their mass, and the shares
/// of a ball in the middle that are tried for it.
const ROOM: f64 = 0.1;
const SHARES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Bodies and scalars on the way.
#[derive(Clone)]
pub(super) struct Point {
    pub links: Vec<Pseudo>,
    pub scalars: Vec<f64>,
}

impl Point {
    /// All unknowns in a row.
    pub fn unknowns(&self) -> Vec<f64> {
        let links = self.links.iter().flat_map(Pseudo::values);
        links.chain(self.scalars.iter().copied()).collect()
    }
}

/// The minimum, and the steps taken.
pub(super) fn minimum(problem: &Problem) -> Result<(Point, usize), PhysicalError> {
    let solver = Solver::new(problem)?;
    let mut at = solver.start()?;
    let mut steps = 0;
    let against = problem.misfit(&problem.parameters(&at.unknowns()));
    let mut weight = against.max(problem.weight);
    loop {
        steps += solver.round(&mut at, weight)?;
        if weight <= problem.weight {
            return Ok((at, steps));
        }
        weight = (FALL * weight).max(problem.weight);
    }
}

struct Solver<'a> {
    problem: &'a Problem,
    described: Vec<Described>,
    /// What is positive of a link inside of its shape: link and factors of its ten parameters.
    conditions: Vec<(usize, [f64; 10])>,
    /// K^T G K and K^T G X, with what is known beside.
    normal: Mat<f64>,
    right: Vec<f64>,
}

impl<'a> Solver<'a> {
    fn new(problem: &'a Problem) -> Result<Self, PhysicalError> {
        let described = problem.links.iter().enumerate().map(|(link, prior)| {
            prior.pseudo.inverse().ok_or(PhysicalError::Value {
                what: format!("the pseudo-inertia described for link {}", link + 1),
                value: f64::NAN,
                must: "positive definite",
            })
        });
        let described = described.collect::<Result<Vec<_>, _>>()?;
        let (normal, right) = normal_equations(problem);
        let bounds = problem.bounds.iter();
        let of = |bound: &Bound| {
            let link = bound.link;
            let conditions = bound.extent.conditions().into_iter();
            conditions.map(move |factors| (link, factors))
        };
        Ok(Solver {
            problem,
            described,
            conditions: bounds.flat_map(of).collect(),
            normal,
            right,
        })
    }

    /// The description, its bodies made symmetric and drawn into their shapes.
    fn start(&self) -> Result<Point, PhysicalError> {
        let scalar = |scalar: &Scalar| match scalar {
            Scalar::Positive(described) => *described,
            Scalar::Free => 0.0,
        };
        let mut links: Vec<Pseudo> = self.problem.links.iter().map(|p| p.pseudo).collect();
        for mirror in &self.problem.mirrors {
            links[mirror.link] = links[mirror.link].mirrored(mirror.normal);
        }
        for bound in &self.problem.bounds {
            let normals = self.problem.normals(bound.link);
            let found = inside(&links[bound.link], bound, &normals);
            links[bound.link] = found.ok_or_else(|| PhysicalError::Beside {
                what: bound.what.clone(),
            })?;
        }
        Ok(Point {
            links,
            scalars: self.problem.scalars.iter().map(scalar).collect(),
        })
    }

    /// Newton's method at one weight; the steps it took.
    fn round(&self, at: &mut Point, weight: f64) -> Result<usize, PhysicalError> {
        for step in 0..STEPS {
            let no_end = PhysicalError::NoEnd { steps: step };
            let local = self.locals(at).ok_or(no_end.clone())?;
            let (gradient, hessian) = self.derivatives(at, &local, weight);
            let direction = descent(&gradient, &hessian).ok_or(no_end)?;
            let slope: f64 = gradient.iter().zip(&direction).map(|(g, d)| g * d).sum();
            if -0.5 * slope <= ENOUGH * weight {
                return Ok(step);
            }
            match self.along(at, &local, (&direction, slope), weight) {
                Some(next) => *at = next,
                // Rounding leaves nothing to gain.
                None => return Ok(step),
            }
        }
        Err(PhysicalError::NoEnd { steps: STEPS })
    }

    /// As far along a direction as the objective falls well.
    fn along(
        &self,
        at: &Point,
        local: &[Local],
        (direction, slope): (&[f64], f64),
        weight: f64,
    ) -> Option<Point> {
        let here = self.value(at, weight)?;
        let mut length = 1.0;
        while length > 1e-12 {
            let step: Vec<f64> = direction.iter().map(|d| length * d).collect();
            let next = self.moved(at, local, &step);
            let there = next.as_ref().and_then(|next| self.value(next, weight));
            if there.is_some_and(|there| there < here + 1e-4 * length * slope) {
                return next;
            }
            length *= 0.5;
        }
        None
    }

    fn locals(&self, at: &Point) -> Option<Vec<Local>> {
        let links = at.links.iter().zip(&self.described).enumerate();
        links
            .map(|(k, (link, described))| Local::of(link, described, &self.problem.normals(k)))
            .collect()
    }

    /// A step in the coordinates of the bodies, positive scalars in shares of themselves; `None`
    /// if it leads too far.
    fn moved(&self, at: &Point, local: &[Local], step: &[f64]) -> Option<Point> {
        let (links, scalars) = step.split_at(10 * local.len());
        let links = local.iter().zip(links.chunks_exact(10));
        let links = links
            .map(|(local, step)| local.at(step))
            .collect::<Option<Vec<_>>>()?;
        let outside = |(link, factors): &(usize, [f64; 10])| {
            sum(factors, &links[*link]) < LEFT * sum(factors, &at.links[*link])
        };
        if self.conditions.iter().any(outside) {
            return None;
        }
        let scalars = scalars.iter().zip(&at.scalars).zip(&self.problem.scalars);
        let scalar = |((step, x), scalar): ((&f64, &f64), &Scalar)| match scalar {
            Scalar::Positive(_) if *step < LEFT - 1.0 => None,
            scalar => Some(x + step * unit(scalar, *x)),
        };
        let scalars = scalars.map(scalar).collect::<Option<_>>()?;
        Some(Point { links, scalars })
    }

    /// The objective; `None` outside of what exists.
    fn value(&self, at: &Point, weight: f64) -> Option<f64> {
        let mut away = 0.0;
        for (link, described) in at.links.iter().zip(&self.described) {
            away += divergence(link, described)?;
        }
        for (x, scalar) in at.scalars.iter().zip(&self.problem.scalars) {
            away += match scalar {
                Scalar::Positive(_) if *x <= 0.0 => return None,
                Scalar::Positive(described) => x / described - (x / described).ln() - 1.0,
                Scalar::Free => 0.5 * HELD * x * x,
            };
        }
        for (link, factors) in &self.conditions {
            let left = sum(factors, &at.links[*link]);
            if left <= 0.0 {
                return None;
            }
            away -= left.ln();
        }
        let unknowns = at.unknowns();
        let known = self.problem.known.iter().map(|known| {
            let reached: f64 = known.factors.iter().map(|(k, f)| f * unknowns[*k]).sum();
            0.5 * ((reached - known.value) / known.sigma).powi(2)
        });
        let misfit = self.problem.misfit(&self.problem.parameters(&unknowns));
        Some(misfit + known.sum::<f64>() + weight * away)
    }

    /// Gradient and Hessian in the coordinates of the bodies.
    fn derivatives(&self, at: &Point, local: &[Local], weight: f64) -> (Vec<f64>, Mat<f64>) {
        let unknowns = at.unknowns();
        let count = unknowns.len();
        let first = 10 * local.len();
        let mut turn = Mat::<f64>::zeros(count, count);
        let mut gradient = vec![0.0; count];
        let mut curvature = vec![1.0; count];
        for (link, local) in local.iter().enumerate() {
            for (i, values) in local.values.iter().enumerate() {
                gradient[10 * link + i] = local.gradient[i];
                for (k, value) in values.iter().enumerate() {
                    turn[(10 * link + k, 10 * link + i)] = *value;
                }
            }
        }
        for (place, (x, scalar)) in at.scalars.iter().zip(&self.problem.scalars).enumerate() {
            let place = first + place;
            turn[(place, place)] = unit(scalar, *x);
            (gradient[place], curvature[place]) = match scalar {
                Scalar::Positive(described) => (x / described - 1.0, 1.0),
                Scalar::Free => (HELD * x, HELD),
            };
        }
        let pull = |i: usize| {
            let row = (0..count).map(|k| self.normal[(i, k)] * unknowns[k]);
            row.sum::<f64>() - self.right[i]
        };
        let pull: Vec<f64> = (0..count).map(pull).collect();
        for (k, gradient) in gradient.iter_mut().enumerate() {
            let data: f64 = (0..count).map(|i| turn[(i, k)] * pull[i]).sum();
            *gradient = weight * *gradient + data;
        }
        let mut hessian = turn.transpose() * &self.normal * &turn;
        for (k, curvature) in curvature.into_iter().enumerate() {
            hessian[(k, k)] += weight * curvature;
        }
        for (link, factors) in &self.conditions {
            let left = sum(factors, &at.links[*link]);
            let slope = local[*link]
                .values
                .map(|values| dot(factors, &values) / left);
            for (i, a) in slope.iter().enumerate() {
                gradient[10 * link + i] -= weight * a;
                for (k, b) in slope.iter().enumerate() {
                    hessian[(10 * link + i, 10 * link + k)] += weight * a * b;
                }
            }
        }
        (gradient, hessian)
    }
}

/// A body with room inside of its shape: as described, or with as much of a ball in the middle as it
/// takes. `None` where the planes it is symmetric about leave none.
fn inside(described: &Pseudo, bound: &Bound, normals: &[usize]) -> Option<Pseudo> {
    let mass = described.0[3][3];
    let extent = &bound.extent;
    let ball = Pseudo::ball(mass, extent.narrowest() / 3.0, extent.center);
    let ball = normals.iter().fold(ball, |ball, n| ball.mirrored(*n));
    let mixed = |share: f64| {
        let entry = |i: usize, k: usize| (1.0 - share) * described.0[i][k] + share * ball.0[i][k];
        Pseudo(std::array::from_fn(|i| {
            std::array::from_fn(|k| entry(i, k))
        }))
    };
    let mut all = SHARES.into_iter().map(mixed);
    all.find(|body| extent.room(body) >= ROOM)
}

fn sum(factors: &[f64; 10], body: &Pseudo) -> f64 {
    dot(factors, &body.values())
}

fn dot(a: &[f64; 10], b: &[f64; 10]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What a scalar's coordinate is counted in: a positive one in shares of itself.
fn unit(scalar: &Scalar, value: f64) -> f64 {
    match scalar {
        Scalar::Positive(_) => value,
        Scalar::Free => 1.0,
    }
}

/// K^T G K and K^T G X, and rows of what is known beside.
fn normal_equations(problem: &Problem) -> (Mat<f64>, Vec<f64>) {
    let (np, count) = (problem.estimate.len(), problem.unknowns());
    let mut normal = Mat::zeros(count, count);
    let mut right = vec![0.0; count];
    for i in 0..np {
        for k in 0..np {
            let g = problem.precision[i * np + k];
            for (a, fa) in &problem.map[i] {
                right[*a] += fa * g * problem.estimate[k];
                for (b, fb) in &problem.map[k] {
                    normal[(*a, *b)] += fa * g * fb;
                }
            }
        }
    }
    for known in &problem.known {
        let weight = known.sigma.powi(-2);
        for (a, fa) in &known.factors {
            right[*a] += weight * fa * known.value;
            for (b, fb) in &known.factors {
                normal[(*a, *b)] += weight * fa * fb;
            }
        }
    }
    (normal, right)
}

/// -H^-1 g, in units that make the diagonal of H one. Where a body all but vanishes, rounding may
/// take the definiteness away; the least that gives it back is added.
fn descent(gradient: &[f64], hessian: &Mat<f64>) -> Option<Vec<f64>> {
    let count = gradient.len();
    let scale: Vec<f64> = (0..count).map(|i| hessian[(i, i)].sqrt().recip()).collect();
    let right = Mat::from_fn(count, 1, |i, _| -scale[i] * gradient[i]);
    RIDGES.iter().find_map(|ridge| {
        let scaled = Mat::from_fn(count, count, |i, k| {
            let own = if i == k { *ridge } else { 0.0 };
            scale[i] * hessian[(i, k)] * scale[k] + own
        });
        let solution = scaled.llt(Side::Lower).ok()?.solve(&right);
        let direction: Vec<f64> = (0..count).map(|i| scale[i] * solution[(i, 0)]).collect();
        direction.iter().all(|d| d.is_finite()).then_some(direction)
    })
}
