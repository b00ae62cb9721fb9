//! Other inertial values in a URDF, every other byte as it is.

use std::ops::Range;

use roxmltree::{Document, Node};

use super::{INERTIA, triple};
use crate::describe::UrdfInertial;

/// Why a URDF cannot take inertial values.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UrdfError {
    /// No XML.
    #[error("the URDF cannot be read: {0}")]
    Xml(String),
    /// A link that is not in it.
    #[error("the URDF has no link `{0}`: it is not that of this robot")]
    Link(String),
}

/// A piece of the text and what stands there instead.
struct Edit {
    place: Range<usize>,
    text: String,
}

/// The text of a URDF with other inertial values of the links that are named. What `<inertial>`
/// holds beside its values stays; a link without one gets one.
///
/// # Errors
/// [`UrdfError`].
pub fn rewrite(text: &str, links: &[(String, UrdfInertial)]) -> Result<String, UrdfError> {
    let document = Document::parse(text).map_err(|error| UrdfError::Xml(error.to_string()))?;
    let mut edits = Vec::new();
    for (name, inertial) in links {
        let link = document.root_element().children().find(|node| {
            node.has_tag_name("link") && node.attribute("name").map(str::trim) == Some(name)
        });
        let link = link.ok_or_else(|| UrdfError::Link(name.clone()))?;
        match child(link, "inertial") {
            Some(element) => replaced(text, element, inertial, &mut edits),
            None => edits.push(inside(text, link, &element(text, link, inertial))),
        }
    }
    edits.sort_by_key(|edit| edit.place.start);
    let mut written = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        written.push_str(&text[at..edit.place.start]);
        written.push_str(&edit.text);
        at = edit.place.end;
    }
    written.push_str(&text[at..]);
    Ok(written)
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// The values of an `<inertial>` that is there.
fn replaced(text: &str, element: Node<'_, '_>, inertial: &UrdfInertial, edits: &mut Vec<Edit>) {
    let origin = [
        ("xyz", triple(inertial.origin.xyz)),
        ("rpy", triple([0.0; 3])),
    ];
    let mass = [("value", inertial.mass.to_string())];
    let tensor = INERTIA.iter().zip(inertial.inertia);
    let tensor: Vec<(&str, String)> = tensor
        .map(|(name, value)| (*name, (value + 0.0).to_string()))
        .collect();
    let parts = [
        ("origin", &origin[..]),
        ("mass", &mass[..]),
        ("inertia", &tensor[..]),
    ];
    let mut missing = String::new();
    for (name, values) in parts {
        match child(element, name) {
            Some(part) => values
                .iter()
                .for_each(|(name, value)| edits.push(attribute(text, part, name, value))),
            None => {
                let values = values
                    .iter()
                    .map(|(name, value)| format!(" {name}=\"{value}\""));
                missing.push_str(&format!("<{name}{}/>", values.collect::<String>()));
            }
        }
    }
    if !missing.is_empty() {
        edits.push(inside(text, element, &missing));
    }
}

/// An attribute with another value, or a new one.
fn attribute(text: &str, node: Node<'_, '_>, name: &str, value: &str) -> Edit {
    match node.attribute_node(name) {
        Some(attribute) => Edit {
            place: attribute.range_value(),
            text: value.to_owned(),
        },
        None => {
            let at = tag(text, node).end;
            let closing = if text[..at].ends_with('/') { 1 } else { 0 };
            Edit {
                place: at - closing..at - closing,
                text: format!(" {name}=\"{value}\""),
            }
        }
    }
}

/// Text as the first thing in an element.
fn inside(text: &str, node: Node<'_, '_>, content: &str) -> Edit {
    let at = tag(text, node).end;
    match text[..at].ends_with('/') {
        // <name/> opens for it.
        true => Edit {
            place: at - 1..at + 1,
            text: format!(">{content}</{}>", node.tag_name().name()),
        },
        false => Edit {
            place: at + 1..at + 1,
            text: content.to_owned(),
        },
    }
}

/// An element's opening tag, up to its `>`, which is not part of it.
fn tag(text: &str, node: Node<'_, '_>) -> Range<usize> {
    let start = node.range().start;
    // A `>` may stand in the value of an attribute.
    let after = node
        .attributes()
        .map(|attribute| attribute.range().end)
        .max();
    let from = after.unwrap_or(start);
    let end = text[from..].find('>').map_or(text.len(), |at| from + at);
    start..end
}

/// A new `<inertial>`, set off like the link's own lines.
fn element(text: &str, link: Node<'_, '_>, inertial: &UrdfInertial) -> String {
    let line = text[..link.range().start]
        .rfind('\n')
        .map_or(0, |at| at + 1);
    let indent = &text[line..link.range().start];
    let indent = if indent.trim().is_empty() { indent } else { "" };
    let tensor = INERTIA.iter().zip(inertial.inertia);
    let tensor: String = tensor
        .map(|(name, value)| format!(" {name}=\"{}\"", value + 0.0))
        .collect();
    format!(
        "\n{indent}  <inertial>\n{indent}    <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n\
         {indent}    <mass value=\"{}\"/>\n{indent}    <inertia{tensor}/>\n{indent}  </inertial>\n{indent}",
        triple(inertial.origin.xyz),
        inertial.mass,
    )
}
