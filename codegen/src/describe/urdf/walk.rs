//! The walk over links and joints: first their text, then their values.

use super::super::check::{self, Named};
use super::super::code;
use super::super::description::{Motion, Snap, UrdfJoint, UrdfLink, UrdfTree};
use super::super::findings::{Findings, finding};
use super::super::tree::{Edge, Order};
use super::digest::Digest;
use super::element::Element;
use super::joints::{self, JointText};
use super::links::{self, LinkText};
use super::values;

/// Most links, and most joints, of a robot.
const MAX_LINKS: usize = 10_000;

/// Links and joints as far as they are known without values.
pub(super) struct Texts {
    links: Vec<LinkText>,
    joints: Vec<JointText>,
    /// What urdf-rs is given to read.
    pub(super) digest: String,
}

impl Texts {
    /// Reads all links and joints, and goes on after a bad one.
    pub(super) fn read(root: Element<'_>, to: &mut Findings) -> Option<Texts> {
        refuse_crowds(root, to)?;
        root.check_children(&["link", "joint"], "<robot>", to);
        let mut digest = Digest::new(root.attribute("version").map(|version| version.text));
        let (mut links, mut joints) = (Vec::new(), Vec::new());
        for child in root.children() {
            match child.tag() {
                "link" => links.push(links::read(child, &mut digest, to)),
                "joint" => joints.push(joints::read(child, &mut digest, to)),
                _ => {}
            }
        }
        warn_of_meshes(root, to);
        let digest = digest.finish();
        Some(Texts {
            links,
            joints,
            digest,
        })
    }

    /// Names of the links.
    pub(super) fn links(&self) -> Vec<&Named> {
        self.links.iter().map(|link| &link.named).collect()
    }

    /// Joints between links.
    pub(super) fn edges(&self) -> Vec<&Edge> {
        self.joints.iter().map(|joint| &joint.edge).collect()
    }

    /// The tree, if its order is known and there is a value for every text.
    pub(super) fn with_values(
        self,
        robot: &urdf_rs::Robot,
        order: Option<Order>,
        to: &mut Findings,
    ) -> Option<(UrdfTree, Vec<Snap>)> {
        if robot.links.len() != self.links.len() || robot.joints.len() != self.joints.len() {
            return None;
        }
        let named = self.links.iter().zip(&robot.links);
        let links = named.map(|(text, link)| UrdfLink {
            name: text.named.name.clone(),
            inertial: values::inertial(link, text, to),
            span: text.named.span,
        });
        let links = links.collect();
        let mut snaps = Vec::new();
        let named = self.joints.iter().zip(&robot.joints);
        let joints = named.map(|(text, joint)| UrdfJoint {
            name: text.edge.named.name.clone(),
            motion: text.motion,
            parent: 0,
            child: 0,
            origin: values::origin(joint, text, &mut snaps, to),
            axis: values::axis(joint, text, &mut snaps, to),
            drive: text.drive.clone(),
            limits: values::limits(joint, text, to),
            span: text.edge.named.span,
        });
        let joints: Vec<UrdfJoint> = joints.collect();
        check::identifiers(&self.moving(), to);
        let joints = ordered(&joints, &order?.joints, to);
        Some((UrdfTree { links, joints }, snaps))
    }

    /// Names of the joints that move.
    fn moving(&self) -> Vec<&Named> {
        let moves = |text: &&JointText| text.motion != Motion::Fixed;
        let moving = self.joints.iter().filter(moves);
        moving.map(|text| &text.edge.named).collect()
    }
}

/// Reports more links or joints than a robot has.
fn refuse_crowds(root: Element<'_>, to: &mut Findings) -> Option<()> {
    for tag in ["link", "joint"] {
        let mut all = root.children().filter(|child| child.tag() == tag);
        if let Some(child) = all.nth(MAX_LINKS) {
            let message = format!("more than {MAX_LINKS} <{tag}> elements");
            let help = "a robot is read here, not a scene";
            to.error(child.offset(), finding(code::XML_COUNT, message).help(help));
            return None;
        }
    }
    Some(())
}

fn warn_of_meshes(root: Element<'_>, to: &mut Findings) {
    let links = root.children().filter(|child| child.tag() == "link");
    let meshes: Vec<(usize, usize)> = links
        .map(|link| link.count_below("mesh"))
        .filter(|(count, _)| *count > 0)
        .collect();
    if let Some((_, first)) = meshes.first() {
        let count: usize = meshes.iter().map(|(count, _)| count).sum();
        let message = format!("{count} mesh files are not read");
        let help = "the model needs masses and inertias, not shapes";
        to.warn(*first, finding(code::MESHES_IGNORED, message).help(help));
    }
}

/// The joints with their links, parents first.
fn ordered(
    joints: &[UrdfJoint],
    order: &[(usize, usize, usize)],
    to: &mut Findings,
) -> Vec<UrdfJoint> {
    let ordered: Vec<UrdfJoint> = order
        .iter()
        .map(|&(index, parent, child)| UrdfJoint {
            parent,
            child,
            ..joints[index].clone()
        })
        .collect();
    let moving: Vec<usize> = order
        .iter()
        .map(|&(index, ..)| index)
        .filter(|&index| joints[index].motion != Motion::Fixed)
        .collect();
    if let Some(early) = moving.windows(2).find(|pair| pair[0] > pair[1]) {
        let (first, second) = (&joints[early[0]].name, &joints[early[1]].name);
        let message = format!(
            "joint `{second}` stands before `{first}`, but hangs on it or on what comes after it"
        );
        let help = "joints are numbered from the base outwards, not as they stand in the file";
        to.warn_at(
            joints[early[1]].span,
            finding(code::JOINTS_REORDERED, message).help(help),
        );
    }
    ordered
}
