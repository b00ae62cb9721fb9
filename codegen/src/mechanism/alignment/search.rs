//! The zeros of the joints, one after the other from the base on, and back where a later axis does
//! not fit.

use nalgebra::{DMatrix, DVector, Vector3};

use super::line::Line;
use super::{AlignError, Displaced, SAME, moved};
use crate::expr::Angle;
use crate::mechanism::pose::about_x;
use crate::mechanism::{JointKind, Mechanism, Pose};

/// Joints tried at most, over all choices; every choice of an ordinary robot is seen long before.
const VISITS: usize = 100_000;

/// Zeros that differ by no more are one, rad.
const ONE_ZERO: f64 = 1e-7;

/// The other's base in ours, and the displacements by joint.
pub(super) fn frames(
    own: &Mechanism,
    other: &Mechanism,
) -> Result<(Pose, Vec<Displaced>), AlignError> {
    let mut search = Search {
        own,
        other,
        rest: own.joints.iter().map(|joint| joint.rest()).collect(),
        rest_other: other.joints.iter().map(|joint| joint.rest()).collect(),
        visits: 0,
        parting: None,
    };
    for base in search.bases() {
        if let Some(links) = search.from(0, base, vec![None; own.joints.len()]) {
            return Ok((base, links));
        }
    }
    Err(search.parted())
}

type Links = Vec<Option<Displaced>>;

/// How near an axis came: its place in the order, distance in m, angle in rad.
type Parting = (usize, f64, f64);

struct Search<'a> {
    own: &'a Mechanism,
    other: &'a Mechanism,
    /// E and E'.
    rest: Vec<Pose>,
    rest_other: Vec<Pose>,
    visits: usize,
    parting: Option<Parting>,
}

impl Search<'_> {
    /// Where the other's base may be: at ours, or so that the first axes meet, one way or the other.
    fn bases(&self) -> Vec<Pose> {
        let mut bases = vec![Pose::identity()];
        if let Some(&first) = self.own.order.first() {
            let over = Pose {
                rotation: about_x(Angle::quarters(2)),
                ..Pose::identity()
            };
            let back = self.rest_other[first].inverse();
            bases.push(self.rest[first].then(&back));
            bases.push(self.rest[first].then(&over).then(&back));
        }
        bases
    }

    /// The displacements from a place in the order on, if there are such.
    fn from(&mut self, place: usize, base: Pose, mut links: Links) -> Option<Vec<Displaced>> {
        self.visits += 1;
        let Some(&joint) = self.own.order.get(place) else {
            return links.into_iter().collect();
        };
        if self.visits > VISITS {
            return None;
        }
        self.slide(joint, &base, &mut links);
        let frame = self.frame(joint, &base, &links);
        let z = frame.rotation.column(2);
        let angle = z.x.hypot(z.y).atan2(z.z.abs());
        let distance = match self.own.joints[joint].kind {
            JointKind::Revolute => frame.translation.x.hypot(frame.translation.y),
            JointKind::Prismatic => 0.0,
        };
        if distance > SAME || angle > SAME {
            self.note((place, distance, angle));
            return None;
        }
        let sign = z.z.signum();
        for zero in self.zeros(joint, &frame, sign) {
            let pose = frame.then(&moved(self.own.joints[joint].kind, zero));
            links[joint] = Some(Displaced { sign, zero, pose });
            if let Some(found) = self.from(place + 1, base, links.clone()) {
                return Some(found);
            }
        }
        None
    }

    /// The other's frame in ours with a zero that is not shifted, \\( E^{-1} C_a E' \\).
    fn frame(&self, joint: usize, base: &Pose, links: &Links) -> Pose {
        let parent = self.own.joints[joint].parent;
        let before = parent.and_then(|parent| links[parent]);
        let before = before.map_or(*base, |link| link.pose);
        let back = self.rest[joint].inverse();
        back.then(&before).then(&self.rest_other[joint])
    }

    /// Zeros that a joint may have: none first, then the least. A turn is what brings the next axis
    /// that it moves onto the other's; a slide is found by the revolute joint after it.
    fn zeros(&self, joint: usize, frame: &Pose, sign: f64) -> Vec<f64> {
        let mut zeros = vec![0.0];
        if self.own.joints[joint].kind == JointKind::Prismatic {
            return zeros;
        }
        if let Some((ours, others)) = self.teller(joint, &Pose::identity(), frame) {
            zeros.extend(others.turns_onto(&ours).into_iter().map(|turn| sign * turn));
        }
        zeros.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        zeros.dedup_by(|a, b| (*a - *b).abs() <= ONE_ZERO);
        zeros
    }

    /// The nearest axis on `joint` that turns about its z move, ours and the other's, in our frame.
    fn teller(&self, joint: usize, ours: &Pose, others: &Pose) -> Option<(Line, Line)> {
        let is_child = |index: &usize| self.own.joints[*index].parent == Some(joint);
        (0..self.own.joints.len())
            .filter(is_child)
            .find_map(|child| {
                let frames = (
                    ours.then(&self.rest[child]),
                    others.then(&self.rest_other[child]),
                );
                let placed = self.own.joints[child].kind == JointKind::Revolute;
                let lines = (Line::of(&frames.0, placed), Line::of(&frames.1, placed));
                match lines.0.is_fixed() {
                    true => self.teller(child, &frames.0, &frames.1),
                    false => Some(lines),
                }
            })
    }

    /// Shifts the zeros of prismatic joints before a revolute one, as little as brings its axis onto
    /// the other's and leaves the axes between where they are.
    fn slide(&self, joint: usize, base: &Pose, links: &mut Links) {
        let gap = self.frame(joint, base, links).translation;
        let turns = self.own.joints[joint].kind == JointKind::Revolute;
        if !turns || gap.x.hypot(gap.y) <= SAME {
            return;
        }
        // From the joint back to the base.
        let parent = |joint: &usize| self.own.joints[*joint].parent;
        let chain: Vec<usize> = std::iter::successors(Some(joint), parent).collect();
        let slides = |place: &usize| self.own.joints[chain[*place]].kind == JointKind::Prismatic;
        let slides: Vec<usize> = (0..chain.len()).filter(slides).collect();
        if slides.is_empty() {
            return;
        }
        let mut moves = DMatrix::zeros(2 * chain.len(), slides.len());
        for (column, &slide) in slides.iter().enumerate() {
            self.moves(&chain[..slide], &mut moves, column);
        }
        let mut wanted = DVector::zeros(2 * chain.len());
        wanted[0] = -gap.x;
        wanted[1] = -gap.y;
        let Ok(inverse) = moves.clone().pseudo_inverse(1e-9) else {
            return;
        };
        let shifts = inverse * &wanted;
        if (moves * &shifts - wanted).amax() > SAME {
            return;
        }
        for (place, &index) in chain.iter().enumerate().skip(1).rev() {
            let pose = self.frame(index, base, links);
            let Some(link) = &mut links[index] else {
                continue;
            };
            if let Some(column) = slides.iter().position(|slide| *slide == place) {
                link.zero += link.sign * shifts[column];
            }
            link.pose = pose.then(&moved(self.own.joints[index].kind, link.zero));
        }
    }

    /// How far a slide of one before a chain moves the axes of its revolute joints, by two rows for
    /// each place.
    fn moves(&self, chain: &[usize], moves: &mut DMatrix<f64>, column: usize) {
        let mut along = Vector3::z();
        for (place, &index) in chain.iter().enumerate().rev() {
            along = self.rest[index].rotation.transpose() * along;
            if self.own.joints[index].kind == JointKind::Revolute {
                moves[(2 * place, column)] = along.x;
                moves[(2 * place + 1, column)] = along.y;
            }
        }
    }

    /// Keeps what came farthest, and there nearest.
    fn note(&mut self, new: Parting) {
        let better = self.parting.is_none_or(|(place, distance, angle)| {
            new.0 > place || (new.0 == place && new.1 + new.2 < distance + angle)
        });
        if better {
            self.parting = Some(new);
        }
    }

    fn parted(&self) -> AlignError {
        let (place, distance, angle) = self.parting.unwrap_or_default();
        let joint = self.own.order.get(place).copied().unwrap_or_default();
        AlignError::Parts {
            number: joint + 1,
            name: self.other.joints[joint].name.clone(),
            distance,
            angle,
        }
    }
}
