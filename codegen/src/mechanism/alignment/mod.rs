//! One robot in two descriptions: where the second puts the frames of the first's links.
//!
//! With T_k(q) the pose of link k in the frame of the base, the two are one robot where constants
//! are found so that
//!
//! \\[ T'_k(q') = C_0^{-1} \, T_k(q) \, C_k, \qquad q'_k = s_k q_k + c_k, \quad s_k = \pm 1 \\]
//!
//! for all q: C_k is the other link frame in ours, c_k a shifted zero, s_k the sign of an axis. With
//! E_k the pose of a frame at rest in its antecedent's and J(q) the motion along or about z, the
//! frames obey \\( C_k = E_k^{-1} C_{a(k)} E'_k J(c_k) \\), and what is left to find are the zeros:
//! each is what brings the next axis that can tell it onto the other's ([`search`]). What was found
//! is tried at random poses before anyone gets it.

mod line;
mod search;

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use super::pose::{Pose, about_x, about_z};
use super::{Follow, Joint, JointKind, Mechanism};

/// Frames that differ by no more are the same, m and rad: less than a log can tell, and more than
/// six decimals of a description leave.
pub const SAME: f64 = 1e-6;

/// Poses that are tried.
const POSES: usize = 64;

/// A link's frame in two descriptions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displaced {
    /// 1, or -1 where the joint counts the other way round.
    pub sign: f64,
    /// The other's position where ours is zero, rad or m.
    pub zero: f64,
    /// The other's frame in ours: \\( x = R x' + p \\).
    pub pose: Pose,
}

/// Two descriptions of one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// The other's base in ours.
    pub base: Pose,
    /// By joint.
    pub links: Vec<Displaced>,
    /// How far frames are apart at the worst of many random poses, m and rad.
    pub apart: f64,
}

/// Why two descriptions are not of one robot.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AlignError {
    /// More joints, or fewer.
    #[error("it has {other} moving joints, and {own} were identified")]
    Count {
        /// Ours.
        own: usize,
        /// The other's.
        other: usize,
    },
    /// A joint that moves in another way.
    #[error("its joint {number} (`{name}`) is {other}, and the identified one is {own}")]
    Kind {
        /// Counted from 1.
        number: usize,
        /// In the other description.
        name: String,
        /// Ours.
        own: &'static str,
        /// The other's.
        other: &'static str,
    },
    /// A joint that hangs on another one.
    #[error("its joint {number} (`{name}`) is carried by {other}, and the identified one by {own}")]
    Carrier {
        /// Counted from 1.
        number: usize,
        /// In the other description.
        name: String,
        /// What carries ours.
        own: String,
        /// What carries the other.
        other: String,
    },
    /// A joint that follows in another way.
    #[error(
        "its joint {number} (`{name}`) follows other joints than the identified one, or otherwise"
    )]
    Follows {
        /// Counted from 1.
        number: usize,
        /// In the other description.
        name: String,
    },
    /// An axis that no displacement of frames brings onto ours.
    #[error(
        "they part at joint {number} (`{name}`): wherever the frames before it are put, its axis stays \
         {distance:.3e} m and {angle:.3e} rad from the identified one"
    )]
    Parts {
        /// Counted from 1.
        number: usize,
        /// In the other description.
        name: String,
        /// Between the axes, m; zero for a prismatic joint.
        distance: f64,
        /// Between their directions, rad.
        angle: f64,
    },
}

/// Where `other` puts the frames of the links of `own`; zeros and signs are changed where nothing
/// else helps, and a base is displaced only then.
///
/// # Errors
/// [`AlignError`].
pub fn align(own: &Mechanism, other: &Mechanism) -> Result<Alignment, AlignError> {
    same_tree(own, other)?;
    let (base, links) = search::frames(own, other)?;
    let apart = tried(own, other, &base, &links)?;
    same_followers(own, other, &links)?;
    Ok(Alignment { base, links, apart })
}

impl Alignment {
    /// Whether all frames, zeros and signs are the same; where the bases stand does not matter.
    pub fn is_identity(&self) -> bool {
        let same = |link: &Displaced| {
            link.sign > 0.0
                && link.zero.abs() <= SAME
                && apart(&link.pose, &Pose::identity()) <= SAME
        };
        self.links.iter().all(same)
    }

    /// The other robot with its bodies in our link frames: masses and names are its own, frames ours.
    pub fn carried(&self, own: &Mechanism, other: &Mechanism) -> Mechanism {
        let mut seen = other.clone();
        let joints = own.joints.iter().zip(&self.links);
        for (joint, (own, link)) in seen.joints.iter_mut().zip(joints) {
            for body in &mut joint.bodies {
                body.pose = link.pose.then(&body.pose);
                body.inertial = body.inertial.map(|inertial| inertial.moved(&link.pose));
            }
            *joint = Joint {
                name: joint.name.clone(),
                limits: joint.limits,
                bodies: std::mem::take(&mut joint.bodies),
                ..own.clone()
            };
        }
        seen
    }
}

impl Joint {
    /// Pose at q = 0 in the antecedent's frame, or that of the base.
    pub fn rest(&self) -> Pose {
        self.base.unwrap_or_else(|| Pose {
            rotation: about_z(self.gamma) * about_x(self.alpha) * about_z(self.theta),
            translation: self.position.into(),
        })
    }
}

/// Whether both have the same joints in the same places of the tree.
fn same_tree(own: &Mechanism, other: &Mechanism) -> Result<(), AlignError> {
    let (a, b) = (&own.joints, &other.joints);
    if a.len() != b.len() {
        return Err(AlignError::Count {
            own: a.len(),
            other: b.len(),
        });
    }
    let kind = |kind| match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    };
    let carrier = |joints: &[Joint], joint: &Joint| match joint.parent {
        Some(parent) => format!("joint {} (`{}`)", parent + 1, joints[parent].name),
        None => "the base".to_owned(),
    };
    for (number, (x, y)) in (1..).zip(a.iter().zip(b)) {
        let name = y.name.clone();
        if x.kind != y.kind {
            let (own, other) = (kind(x.kind), kind(y.kind));
            return Err(AlignError::Kind {
                number,
                name,
                own,
                other,
            });
        }
        if x.parent != y.parent {
            let (own, other) = (carrier(a, x), carrier(b, y));
            return Err(AlignError::Carrier {
                number,
                name,
                own,
                other,
            });
        }
    }
    Ok(())
}

/// Whether joints that follow in both descriptions follow in the same way; a description that
/// leaves them free says nothing against it.
fn same_followers(
    own: &Mechanism,
    other: &Mechanism,
    links: &[Displaced],
) -> Result<(), AlignError> {
    for joint in 0..own.joints.len() {
        let (Follow::Sum(a), Follow::Sum(b)) = (own.follow(joint), other.follow(joint)) else {
            continue;
        };
        if joint < own.driven || joint < other.driven {
            continue;
        }
        // The other's position, by its own rule and by ours, for one driven joint after the other.
        let differs = |at: Option<usize>| {
            let q = |joint: usize| if at == Some(joint) { 1.0 } else { 0.0 };
            let turned = |joint: usize| links[joint].sign * q(joint) + links[joint].zero;
            let ours = links[joint].sign * a.at(q) + links[joint].zero;
            (b.at(turned) - ours).abs() > SAME
        };
        if differs(None) || (0..own.driven).any(|driven| differs(Some(driven))) {
            let name = other.joints[joint].name.clone();
            return Err(AlignError::Follows {
                number: joint + 1,
                name,
            });
        }
    }
    Ok(())
}

/// The largest distance between frames at random poses, m and rad.
fn tried(
    own: &Mechanism,
    other: &Mechanism,
    base: &Pose,
    links: &[Displaced],
) -> Result<f64, AlignError> {
    let mut generator = Pcg64Mcg::new(0x616c_6967);
    let mut unit = || (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    let mut worst: f64 = 0.0;
    for _ in 0..POSES {
        let q: Vec<f64> = links
            .iter()
            .map(|_| std::f64::consts::PI * unit())
            .collect();
        let pairs = q.iter().zip(links);
        let moved: Vec<f64> = pairs.map(|(q, link)| link.sign * q + link.zero).collect();
        let (ours, others) = (poses(own, &q), poses(other, &moved));
        for &joint in &own.order {
            let found = base.then(&others[joint]);
            let wanted = ours[joint].then(&links[joint].pose);
            let (distance, angle) = between(&found, &wanted);
            // Distances are small against what they are summed up from.
            if distance.max(angle) > SAME * (1.0 + wanted.translation.norm()) {
                let name = other.joints[joint].name.clone();
                return Err(AlignError::Parts {
                    number: joint + 1,
                    name,
                    distance,
                    angle,
                });
            }
            worst = worst.max(distance).max(angle);
        }
    }
    Ok(worst)
}

/// Poses of all link frames in the frame of the base, of positions of all joints, rad and m.
fn poses(mechanism: &Mechanism, q: &[f64]) -> Vec<Pose> {
    let mut poses = vec![Pose::identity(); mechanism.joints.len()];
    for &index in &mechanism.order {
        let joint = &mechanism.joints[index];
        let before = joint
            .parent
            .map_or(Pose::identity(), |parent| poses[parent]);
        poses[index] = before
            .then(&joint.rest())
            .then(&moved(joint.kind, q[index]));
    }
    poses
}

/// J(q).
fn moved(kind: JointKind, q: f64) -> Pose {
    let mut pose = Pose::identity();
    match kind {
        JointKind::Revolute => pose.rotation = about_z(crate::expr::Angle::radians(q)),
        JointKind::Prismatic => pose.translation.z = q,
    }
    pose
}

/// The distance of two poses, m and rad.
fn between(a: &Pose, b: &Pose) -> (f64, f64) {
    let turn = a.rotation.transpose() * b.rotation;
    // The angle of a small turn from what is antisymmetric: its cosine would lose half the digits.
    let half = 0.5 * (turn - turn.transpose()).norm() / std::f64::consts::SQRT_2;
    let angle = half.atan2(0.5 * (turn.trace() - 1.0));
    ((a.translation - b.translation).norm(), angle)
}

fn apart(a: &Pose, b: &Pose) -> f64 {
    let (distance, angle) = between(a, b);
    distance.max(angle)
}

#[cfg(test)]
mod tests;
