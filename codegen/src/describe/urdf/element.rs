//! Elements and attributes of a URDF with their places.

use super::super::code;
use super::super::findings::{Findings, finding};
use super::super::suggest;
use roxmltree::Node;

/// Attributes that mean something somewhere, and so are no misspelling of another.
const ATTRIBUTES: [&str; 19] = [
    "name",
    "type",
    "link",
    "joint",
    "xyz",
    "rpy",
    "quat_xyzw",
    "value",
    "ixx",
    "ixy",
    "ixz",
    "iyy",
    "iyz",
    "izz",
    "lower",
    "upper",
    "effort",
    "velocity",
    "version",
];

/// Elements of URDF: no misspelling of each other.
const CHILDREN: [&str; 18] = [
    "link",
    "joint",
    "material",
    "gazebo",
    "transmission",
    "inertial",
    "visual",
    "collision",
    "origin",
    "mass",
    "inertia",
    "parent",
    "child",
    "axis",
    "limit",
    "dynamics",
    "mimic",
    "calibration",
];

/// An element.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    node: Node<'a, 'a>,
}

/// The value of an attribute.
#[derive(Clone, Copy)]
pub(super) struct Attribute<'a> {
    /// Its text.
    pub(super) text: &'a str,
    /// Where the text starts.
    pub(super) offset: usize,
}

impl<'a> Element<'a> {
    /// An element of the tree.
    pub(super) fn new(node: Node<'a, 'a>) -> Self {
        Element { node }
    }

    /// Name without prefix.
    pub(super) fn tag(self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Where the element starts.
    pub(super) fn offset(self) -> usize {
        self.node.range().start
    }

    /// Child elements; those of a foreign namespace are not ours to read.
    pub(super) fn children(self) -> impl Iterator<Item = Element<'a>> {
        let ours = self.node.tag_name().namespace();
        let known =
            move |node: &Node<'_, '_>| node.is_element() && node.tag_name().namespace() == ours;
        self.node.children().filter(known).map(Element::new)
    }

    /// How many elements of that name are somewhere below, and where the first is.
    pub(super) fn count_below(self, tag: &str) -> (usize, usize) {
        let mut all = self
            .node
            .descendants()
            .filter(|node| node.tag_name().name() == tag);
        let first = all.next().map(|node| node.range().start);
        first.map_or((0, 0), |first| (1 + all.count(), first))
    }

    /// An attribute, if it is there.
    pub(super) fn attribute(self, name: &str) -> Option<Attribute<'a>> {
        let found = self.node.attributes().find(|one| one.name() == name)?;
        Some(Attribute {
            text: found.value(),
            offset: found.range_value().start,
        })
    }

    /// An attribute, or an error that it is missing; `owner` says what the element belongs to.
    pub(super) fn need(self, name: &str, owner: &str, to: &mut Findings) -> Option<Attribute<'a>> {
        let found = self.attribute(name);
        if found.is_none() {
            let message = format!("<{}> of {owner} has no `{name}`", self.tag());
            let help = self.similar(name);
            to.error(
                self.offset(),
                finding(code::ATTRIBUTE_MISSING, message).help(help),
            );
        }
        found
    }

    /// The `name` of a link or a joint, or an error that it has none.
    pub(super) fn name(self, to: &mut Findings) -> Option<&'a str> {
        match self.attribute("name") {
            Some(name) if !name.text.trim().is_empty() => Some(name.text.trim()),
            found => {
                let place = found.map_or(self.offset(), |name| name.offset);
                let message = format!("<{}> has no name", self.tag());
                let help = self.similar("name");
                to.error(place, finding(code::NAME_MISSING, message).help(help));
                None
            }
        }
    }

    /// Help for a missing attribute: the one that was probably meant.
    fn similar(self, name: &str) -> String {
        let near = self.node.attributes().find(|one| {
            !ATTRIBUTES.contains(&one.name()) && suggest::nearest(one.name(), [name]).is_some()
        });
        match near {
            Some(near) => format!("`{}` is there: did you mean `{name}`?", near.name()),
            None => format!("write <{} {name}=\"...\">", self.tag()),
        }
    }

    /// The child of that name; a second one is an error.
    pub(super) fn child(self, tag: &str, owner: &str, to: &mut Findings) -> Option<Element<'a>> {
        let mut all = self.children().filter(|child| child.tag() == tag);
        let first = all.next();
        if let Some(second) = all.next() {
            let message = format!("{owner} has two <{tag}>");
            let help = "keep one of them";
            to.error(
                second.offset(),
                finding(code::ELEMENT_REPEATED, message).help(help),
            );
        }
        first
    }

    /// The child of that name, or an error that it is missing.
    pub(super) fn need_child(
        self,
        tag: &str,
        owner: &str,
        to: &mut Findings,
    ) -> Option<Element<'a>> {
        let found = self.child(tag, owner, to);
        if found.is_none() {
            let message = format!("{owner} has no <{tag}>");
            to.error(self.offset(), finding(code::ELEMENT_MISSING, message));
        }
        found
    }

    /// Reports children that are almost one of the elements that matter: a misspelt `<orgin>`
    /// would silently be a joint at the origin. Others may be what they like.
    pub(super) fn check_children(self, matter: &[&str], owner: &str, to: &mut Findings) {
        for child in self
            .children()
            .filter(|child| !CHILDREN.contains(&child.tag()))
        {
            if let Some(near) = suggest::nearest(child.tag(), matter.iter().copied()) {
                let message = format!("unknown element <{}> in {owner}", child.tag());
                let help = format!("did you mean <{near}>?");
                to.error(
                    child.offset(),
                    finding(code::ELEMENT_UNKNOWN, message).help(help),
                );
            }
        }
    }

    /// Reports attributes that are almost one of the known ones.
    pub(super) fn check_attributes(self, known: &[&str], owner: &str, to: &mut Findings) {
        for one in self
            .node
            .attributes()
            .filter(|one| !known.contains(&one.name()))
        {
            if let Some(near) = suggest::nearest(one.name(), known.iter().copied()) {
                let message = format!(
                    "unknown attribute `{}` of <{}> in {owner}",
                    one.name(),
                    self.tag()
                );
                let help = format!("did you mean `{near}`?");
                let place = one.range().start;
                to.error(place, finding(code::ATTRIBUTE_UNKNOWN, message).help(help));
            }
        }
    }
}
