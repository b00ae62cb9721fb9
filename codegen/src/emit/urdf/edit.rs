//! Pieces of a URDF's text replaced, every other byte as it is.

use std::ops::Range;

use roxmltree::{Document, Node};

/// A piece of the text and what stands there instead.
pub(super) struct Edit {
    pub place: Range<usize>,
    pub text: String,
}

/// The text with all edits, which do not overlap.
pub(super) fn edited(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|edit| edit.place.start);
    let mut written = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        written.push_str(&text[at..edit.place.start]);
        written.push_str(&edit.text);
        at = edit.place.end;
    }
    written.push_str(&text[at..]);
    written
}

/// An element of the robot by its tag and name.
pub(super) fn named<'a, 'i>(
    document: &'a Document<'i>,
    tag: &str,
    name: &str,
) -> Option<Node<'a, 'i>> {
    document
        .root_element()
        .children()
        .find(|node| node.has_tag_name(tag) && node.attribute("name").map(str::trim) == Some(name))
}

/// What stands before an element on its line, if that is nothing but space.
pub(super) fn indent<'t>(text: &'t str, node: Node<'_, '_>) -> &'t str {
    let line = text[..node.range().start]
        .rfind('\n')
        .map_or(0, |at| at + 1);
    let indent = &text[line..node.range().start];
    if indent.trim().is_empty() { indent } else { "" }
}

pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// An attribute with another value, or a new one.
pub(super) fn attribute(text: &str, node: Node<'_, '_>, name: &str, value: &str) -> Edit {
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
pub(super) fn inside(text: &str, node: Node<'_, '_>, content: &str) -> Edit {
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
