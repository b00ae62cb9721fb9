//! From base parameters to bodies that exist: standard parameters of every link whose
//! pseudo-inertia is positive definite, as near as the data allow to an estimate.
//!
//! The log decides np base parameters \\( X = K z \\) and nothing else of the standard parameters
//! z. Among all z
//!
//! \\[ \min_z \; \tfrac12 (K z - \hat X)^T G (K z - \hat X)
//!    + \gamma \sum_k \left( \mathrm{tr}(P_{0k}^{-1} P_k) - \log\det(P_{0k}^{-1} P_k) - 4 \right)
//!    + \gamma \sum_j \left( s_j / s_{0j} - \log(s_j / s_{0j}) - 1 \right) \\]
//!
//! is taken: G is the inverse covariance of the estimate, so that the data weigh in their own
//! metric, P_k the 4 x 4 pseudo-inertia of link k and P_0k the described one, to which the
//! Bregman divergence of log det leads where the data are silent (Lee, Wensing, Park, "Geometric
//! robot dynamic identification: a convex programming approach", IEEE Transactions on Robotics 36,
//! 2020; Wensing, Kim, Slotine, "Linear matrix inequalities for physically consistent inertial
//! parameter identification", IEEE RA-L 3, 2018). It grows without bound where a P_k ceases to be
//! positive definite, and s_j are the parameters that cannot be negative: rotor inertias and
//! friction. Where the extent of a link is known, what its mass cannot exceed ([`Extent`]) adds
//! \\( -\gamma \sum \log \mathrm{tr}(P_k Q) \\). The problem is convex and self-concordant; [`newton`]
//! solves it without a semidefinite solver.

mod bodies;
mod extent;
mod newton;
mod pseudo;

pub use extent::{Extent, Shape};
pub use pseudo::{Prior, Pseudo};

/// A parameter that is no inertial parameter of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// One that is positive, with the value it has where the data are silent.
    Positive(f64),
    /// One of either sign, zero where the data are silent.
    Free,
}

/// A combination of standard parameters that is known beside the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// What is known, in words, for messages: `mass of link 3`.
    pub what: String,
    /// Factors of the unknowns: place and factor.
    pub factors: Vec<(usize, f64)>,
    /// Value, SI.
    pub value: f64,
    /// Standard deviation, SI.
    pub sigma: f64,
}

/// A shape that the mass of a link is inside of.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// The link in words, for messages: `what moves with joint elbow`.
    pub what: String,
    /// Counted from 0.
    pub link: usize,
    /// In the frame of the link.
    pub extent: Extent,
}

/// A plane through the origin of a link's frame that its mass is symmetric about: two products of
/// inertia and a first moment are zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mirror {
    /// Counted from 0.
    pub link: usize,
    /// Axis of the frame that is square to the plane, 0 to 2.
    pub normal: usize,
}

/// What is to be solved. The unknowns z are ten values of each link in the order of
/// [`crate::knowledge::STANDARD`], then the scalars.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Described bodies, one per link.
    pub links: Vec<Prior>,
    /// Rotor inertias, friction and all else.
    pub scalars: Vec<Scalar>,
    /// K by rows: np lists of (unknown, factor).
    pub map: Vec<Vec<(usize, f64)>>,
    /// The np estimated base parameters, SI.
    pub estimate: Vec<f64>,
    /// Their inverse covariance, np x np, row-major, positive semidefinite.
    pub precision: Vec<f64>,
    /// What is known beside.
    pub known: Vec<Known>,
    /// What the mass of links is inside of.
    pub bounds: Vec<Bound>,
    /// Links that are symmetric.
    pub mirrors: Vec<Mirror>,
    /// \\( \gamma \\): what the description counts for, in standard deviations of the data
    /// squared; 1 takes it for known to about its own size.
    pub weight: f64,
}

/// Bodies that exist.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    /// The ten standard parameters of each link, SI.
    pub links: Vec<[f64; 10]>,
    /// The scalars.
    pub scalars: Vec<f64>,
    /// The np base parameters of these bodies.
    pub parameters: Vec<f64>,
    /// \\( (X - \hat X)^T G (X - \hat X) \\): how far they are from the estimate, in standard
    /// deviations squared.
    pub distance: f64,
    /// Newton steps taken.
    pub steps: usize,
}

/// Why there are no such bodies.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhysicalError {
    /// A length that does not fit.
    #[error("{what}: {has} values, {needs} are needed")]
    Length {
        /// Of what.
        what: &'static str,
        /// How many there are.
        has: usize,
        /// How many there should be.
        needs: usize,
    },
    /// A number that is not one, or out of its range.
    #[error("{what} is {value}; it must be {must}")]
    Value {
        /// Of what.
        what: String,
        /// What it is.
        value: f64,
        /// What it may be.
        must: &'static str,
    },
    /// Something stated that no bodies with these base parameters have.
    #[error(
        "the {what} cannot be {wanted:.6} kg: bodies that exist and have the identified parameters \
         come to {nearest:.6} kg at the nearest; leave it out, or check it and the log"
    )]
    Infeasible {
        /// What was stated.
        what: String,
        /// Its value.
        wanted: f64,
        /// The nearest value there is.
        nearest: f64,
    },
    /// A shape that no bodies with these base parameters are inside of.
    #[error(
        "{what} cannot be inside of its shape: bodies that are inside of theirs are {farther:.1} \
         standard deviations farther from the identified parameters than bodies anywhere, and {what} \
         reaches nearest to the edge of its own; check the shape and the log, or leave shapes out"
    )]
    Outside {
        /// Which link.
        what: String,
        /// How much farther, in standard deviations, stretched where bodies are far already.
        farther: f64,
    },
    /// A shape that has no room about the plane its mass is symmetric about.
    #[error(
        "{what} is symmetric about a plane that does not go through the middle of its shape: correct \
         the one or the other"
    )]
    Beside {
        /// Which link.
        what: String,
    },
    /// Newton's method came to no end.
    #[error(
        "no bodies were found after {steps} steps: the precision of the estimate is no covariance"
    )]
    NoEnd {
        /// Steps taken.
        steps: usize,
    },
}

/// Stated values that are missed by more standard deviations than this cannot be.
const MISSED: f64 = 4.0;

impl Problem {
    /// Solves it.
    ///
    /// # Errors
    /// [`PhysicalError`].
    pub fn solve(&self) -> Result<Bodies, PhysicalError> {
        self.check()?;
        let found = self.nearest()?;
        if !self.bounds.is_empty() {
            let anywhere = Problem {
                bounds: Vec::new(),
                ..self.clone()
            };
            self.fits(&found, &anywhere.nearest()?)?;
        }
        Ok(found)
    }

    /// Whether bodies inside of their shapes explain the estimate like bodies `anywhere`: where these
    /// are farther from it than its errors, so much more is allowed.
    fn fits(&self, found: &Bodies, anywhere: &Bodies) -> Result<(), PhysicalError> {
        let stretch = (anywhere.distance / self.estimate.len() as f64).max(1.0);
        let farther = ((found.distance - anywhere.distance).max(0.0) / stretch).sqrt();
        let room = |bound: &Bound| bound.extent.room(&Pseudo::of(&found.links[bound.link]));
        let mut bounds = self.bounds.iter();
        let first = bounds.next();
        let least = first.map(|first| {
            bounds.fold(first, |least, bound| match room(bound) < room(least) {
                true => bound,
                false => least,
            })
        });
        match least.filter(|_| farther > MISSED) {
            Some(bound) => Err(PhysicalError::Outside {
                what: bound.what.clone(),
                farther,
            }),
            None => Ok(()),
        }
    }

    /// The minimum, which keeps what is known beside.
    fn nearest(&self) -> Result<Bodies, PhysicalError> {
        let (point, steps) = newton::minimum(self)?;
        let unknowns = point.unknowns();
        for known in &self.known {
            let reached: f64 = known.factors.iter().map(|(k, f)| f * unknowns[*k]).sum();
            if (reached - known.value).abs() > MISSED * known.sigma {
                return Err(PhysicalError::Infeasible {
                    what: known.what.clone(),
                    wanted: known.value,
                    nearest: reached,
                });
            }
        }
        let parameters = self.parameters(&unknowns);
        let distance = 2.0 * self.misfit(&parameters);
        Ok(Bodies {
            links: point.links.iter().map(Pseudo::values).collect(),
            scalars: point.scalars,
            parameters,
            distance,
            steps,
        })
    }

    /// Normals of the planes that a link is symmetric about.
    fn normals(&self, link: usize) -> Vec<usize> {
        let own = self.mirrors.iter().filter(|mirror| mirror.link == link);
        own.map(|mirror| mirror.normal).collect()
    }

    /// Number of unknowns.
    fn unknowns(&self) -> usize {
        10 * self.links.len() + self.scalars.len()
    }

    /// K z.
    fn parameters(&self, unknowns: &[f64]) -> Vec<f64> {
        let row = |row: &Vec<(usize, f64)>| row.iter().map(|(k, f)| f * unknowns[*k]).sum();
        self.map.iter().map(row).collect()
    }

    /// Half the squared distance from the estimate.
    fn misfit(&self, parameters: &[f64]) -> f64 {
        let away: Vec<f64> = parameters
            .iter()
            .zip(&self.estimate)
            .map(|(a, b)| a - b)
            .collect();
        let rows = self.precision.chunks_exact(away.len());
        let pull = rows.map(|row| row.iter().zip(&away).map(|(g, a)| g * a).sum::<f64>());
        0.5 * pull.zip(&away).map(|(pull, away)| pull * away).sum::<f64>()
    }

    fn check(&self) -> Result<(), PhysicalError> {
        let np = self.estimate.len();
        let lengths = [
            ("K", self.map.len(), np),
            ("the precision", self.precision.len(), np * np),
        ];
        for (what, has, needs) in lengths {
            if has != needs {
                return Err(PhysicalError::Length { what, has, needs });
            }
        }
        let wrong = |what: &str, value: f64, must| PhysicalError::Value {
            what: what.to_owned(),
            value,
            must,
        };
        let numbers = self.estimate.iter().chain(&self.precision);
        if let Some(value) = numbers.copied().find(|x| !x.is_finite()) {
            return Err(wrong("an estimate or its precision", value, "finite"));
        }
        if !(self.weight > 0.0 && self.weight.is_finite()) {
            return Err(wrong(
                "the weight of the description",
                self.weight,
                "positive",
            ));
        }
        for bound in &self.bounds {
            let narrowest = bound.extent.narrowest();
            if bound.link >= self.links.len() || !(narrowest > 0.0 && narrowest.is_finite()) {
                let what = format!("half the extent of {}, in m,", bound.what);
                return Err(wrong(&what, narrowest, "positive"));
            }
        }
        let mirrors = self.mirrors.iter();
        let mut beyond = mirrors.filter(|m| m.link >= self.links.len() || m.normal > 2);
        if let Some(mirror) = beyond.next() {
            let what = "the link of a plane, or its normal,";
            return Err(wrong(what, mirror.normal as f64, "one that is there"));
        }
        for known in &self.known {
            if !(known.value > 0.0 && known.value.is_finite()) {
                return Err(wrong(
                    &format!("the {}", known.what),
                    known.value,
                    "positive",
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
