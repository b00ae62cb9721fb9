//! Links and joints, known by name, as one tree.

use super::check::{self, Named};
use super::code;
use super::diagnostic::Span;
use super::findings::{Findings, finding};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// A joint between two links.
pub(super) struct Edge {
    /// The joint.
    pub(super) named: Named,
    /// The link that it hangs on, with the place of the name.
    pub(super) parent: Named,
    /// The link that hangs on it.
    pub(super) child: Named,
}

/// The joints in an order in which a parent comes before its children, with the indices of their
/// links.
pub(super) struct Order {
    /// Index of the joint, its parent link, its child link.
    pub(super) joints: Vec<(usize, usize, usize)>,
}

/// Checks that the links form one tree. The stages build on each other: after a repeated name, say,
/// every message about roots would be misleading, so the first stage that fails is the last.
pub(super) fn order(links: &[&Named], joints: &[&Edge], to: &mut Findings) -> Option<Order> {
    let before = to.errors();
    check::unique("link", links, to);
    let names: Vec<&Named> = joints.iter().map(|joint| &joint.named).collect();
    check::unique("joint", &names, to);
    check_shared(links, &names, to);
    let index: HashMap<&str, usize> = links
        .iter()
        .enumerate()
        .rev()
        .map(|(i, link)| (link.name.as_str(), i))
        .collect();
    let ends = ends(joints, &index, links, to);
    if to.errors() > before {
        return None;
    }
    let joint_above = joint_above(&ends, links, joints, to)?;
    acyclic(&ends, &joint_above, links, joints, to)?;
    one_root(&joint_above, links, to)?;
    Some(Order {
        joints: parents_first(&ends, &joint_above),
    })
}

/// Warns of names that a link shares with a joint.
fn check_shared(links: &[&Named], joints: &[&Named], to: &mut Findings) {
    let places: HashMap<&str, Span> = joints
        .iter()
        .map(|joint| (joint.name.as_str(), joint.span))
        .collect();
    for link in links {
        if let Some(joint) = places.get(link.name.as_str()) {
            let message = format!("a link and a joint are both called `{}`", link.name);
            let help = format!(
                "the joint is on line {}; some programs refuse this",
                joint.line
            );
            to.warn_at(link.span, finding(code::NAME_SHARED, message).help(help));
        }
    }
}

/// Parent and child of every joint; an unknown one is an error.
fn ends(
    joints: &[&Edge],
    index: &HashMap<&str, usize>,
    links: &[&Named],
    to: &mut Findings,
) -> Vec<(usize, usize)> {
    let mut find = |joint: &Edge, end: &Named, role: &str| -> usize {
        let found = index.get(end.name.as_str()).copied();
        if found.is_none() {
            let message = format!(
                "{role} of joint `{}` is `{}`, which is no link",
                joint.named.name, end.name
            );
            let help = to.suggest(&end.name, links.iter().map(|link| link.name.as_str()));
            to.error_at(end.span, finding(code::LINK_UNKNOWN, message).help(help));
        }
        found.unwrap_or_default()
    };
    let both = |joint: &&Edge| {
        (
            find(joint, &joint.parent, "parent"),
            find(joint, &joint.child, "child"),
        )
    };
    joints.iter().map(both).collect()
}

/// The joint that each link hangs on.
fn joint_above(
    ends: &[(usize, usize)],
    links: &[&Named],
    joints: &[&Edge],
    to: &mut Findings,
) -> Option<Vec<Option<usize>>> {
    let before = to.errors();
    let mut above: Vec<Option<usize>> = vec![None; links.len()];
    for (joint, &(_, child)) in ends.iter().enumerate() {
        if let Some(first) = above[child].replace(joint) {
            let message = format!(
                "link `{}` is the child of two joints, `{}` and `{}`",
                links[child].name, joints[first].named.name, joints[joint].named.name
            );
            let help = "a URDF is a tree: closed loops cannot be written in it";
            to.error_at(
                joints[joint].child.span,
                finding(code::SEVERAL_PARENTS, message).help(help),
            );
        }
    }
    (to.errors() == before).then_some(above)
}

/// Walks up from every link; a link that is met again on the way up is its own ancestor.
fn acyclic(
    ends: &[(usize, usize)],
    above: &[Option<usize>],
    links: &[&Named],
    joints: &[&Edge],
    to: &mut Findings,
) -> Option<()> {
    let before = to.errors();
    // The walk in which each link was met first.
    let mut met: Vec<Option<usize>> = vec![None; links.len()];
    for start in 0..links.len() {
        let mut link = start;
        while met[link].is_none() {
            met[link] = Some(start);
            let Some(joint) = above[link] else { break };
            link = ends[joint].0;
            if met[link] == Some(start) {
                let message = cycle(link, ends, above, links);
                let help = "one link, the base, must be no joint's child";
                to.error_at(
                    joints[joint].named.span,
                    finding(code::CYCLE, message).help(help),
                );
            }
        }
    }
    (to.errors() == before).then_some(())
}

/// `a <- b <- a`, shortened where it is long.
fn cycle(
    start: usize,
    ends: &[(usize, usize)],
    above: &[Option<usize>],
    links: &[&Named],
) -> String {
    const SHOWN: usize = 8;
    let mut path = vec![links[start].name.as_str()];
    let mut link = start;
    while let Some(joint) = above[link] {
        link = ends[joint].0;
        if path.len() >= SHOWN && link != start {
            path.push("...");
            break;
        }
        path.push(&links[link].name);
        if link == start {
            break;
        }
    }
    format!(
        "link `{}` is its own ancestor: {}",
        links[start].name,
        path.join(" <- ")
    )
}

fn one_root(above: &[Option<usize>], links: &[&Named], to: &mut Findings) -> Option<()> {
    let roots: Vec<&Named> = links
        .iter()
        .zip(above)
        .filter(|(_, joint)| joint.is_none())
        .map(|(link, _)| *link)
        .collect();
    let [_, second, ..] = roots[..] else {
        return Some(());
    };
    let names: Vec<&str> = roots.iter().map(|link| link.name.as_str()).collect();
    let message = format!(
        "{} links have no parent: {}",
        roots.len(),
        super::suggest::listed(&names)
    );
    let help = "all links but the base must be the child of a joint";
    to.error_at(
        second.span,
        finding(code::SEVERAL_ROOTS, message).help(help),
    );
    None
}

/// As in the document, except that a joint waits for the one it hangs on.
fn parents_first(ends: &[(usize, usize)], above: &[Option<usize>]) -> Vec<(usize, usize, usize)> {
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); above.len()];
    for (joint, &(parent, _)) in ends.iter().enumerate() {
        below[parent].push(joint);
    }
    let roots = (0..above.len()).filter(|&link| above[link].is_none());
    let mut ready: BinaryHeap<Reverse<usize>> = roots
        .flat_map(|root| below[root].iter().copied().map(Reverse))
        .collect();
    let mut order = Vec::with_capacity(ends.len());
    while let Some(Reverse(joint)) = ready.pop() {
        let (parent, child) = ends[joint];
        order.push((joint, parent, child));
        ready.extend(below[child].iter().copied().map(Reverse));
    }
    order
}
