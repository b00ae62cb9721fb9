//! Effects of the description on joints given by index.

use super::{Effect, Joint};
use crate::describe::EffectSpec;

/// Resolves the joint names of checked effects; the order of the description is kept.
pub fn resolve(joints: &[Joint], specs: &[EffectSpec]) -> Vec<Effect> {
    let index = |name: &String| joints.iter().position(|joint| joint.name == *name);
    specs
        .iter()
        .filter_map(|spec| {
            let joints: Option<Vec<usize>> = spec.joints.iter().map(index).collect();
            let shape = spec.shape.iter().map(|&(_, value)| value).collect();
            joints.map(|joints| Effect {
                kind: spec.kind,
                joints,
                shape,
            })
        })
        .collect()
}
