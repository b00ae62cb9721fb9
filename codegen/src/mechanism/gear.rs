//! A gear that yields: the joint of a drive, and behind it that of the link.

use super::{Follow, Joint, Mechanism};
use crate::expr::Angle;

impl Mechanism {
    /// The robot with a joint in two: the first, in the joint's place, is turned by the drive and
    /// carries nothing; the second, behind it, lets the link move against the drive about the same
    /// axis. Effects stay with the drive, and all later joints count one more.
    pub fn with_gear(&self, joint: usize) -> Mechanism {
        let moved = |number: usize| if number > joint { number + 1 } else { number };
        let mut joints = Vec::with_capacity(self.joints.len() + 1);
        for (number, known) in self.joints.iter().enumerate() {
            // What stands on the joint stands on its link.
            let parent = known
                .parent
                .map(|on| if on == joint { on + 1 } else { moved(on) });
            let own = Joint {
                parent,
                ..known.clone()
            };
            if number != joint {
                joints.push(own);
                continue;
            }
            let link = Joint {
                name: format!("{} behind its gear", known.name),
                parent: Some(joint),
                gamma: Angle::ZERO,
                alpha: Angle::ZERO,
                theta: Angle::ZERO,
                position: [0.0; 3],
                gravity: None,
                ..known.clone()
            };
            joints.push(Joint {
                bodies: Vec::new(),
                ..own
            });
            joints.push(link);
        }
        let mut changed = self.clone();
        changed.joints = joints;
        changed.driven += 1;
        changed.order = self
            .order
            .iter()
            .flat_map(|&at| match at == joint {
                true => vec![joint, joint + 1],
                false => vec![moved(at)],
            })
            .collect();
        let both = |at: usize| match at == joint {
            true => vec![joint, joint + 1],
            false => vec![moved(at)],
        };
        changed.dyads = self
            .dyads
            .iter()
            .map(|dyad| dyad.renumbered(both))
            .collect();
        for follower in &mut changed.follows {
            let Follow::Sum(follower) = follower else {
                continue;
            };
            // What followed the joint follows its link: drive and yielding together.
            let terms = follower
                .terms
                .iter()
                .flat_map(|&(at, by)| match at == joint {
                    true => vec![(joint, by), (joint + 1, by)],
                    false => vec![(moved(at), by)],
                });
            follower.terms = terms.collect();
        }
        for effect in &mut changed.effects {
            effect.joints.iter_mut().for_each(|at| *at = moved(*at));
        }
        changed
    }
}
