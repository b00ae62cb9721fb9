//! From URDF text to an XML tree that is a `<robot>`.

use super::super::code;
use super::super::diagnostic::Span;
use super::super::findings::{Finding, Findings, finding};
use super::element::Element;
use super::guard;
use roxmltree::{Document, Error, Node, ParsingOptions};

/// Most nodes (elements, texts, comments) of a document; 10 000 links of a rich URDF have fewer.
const MAX_NODES: u32 = 2_000_000;

/// Parses the text, or says what keeps it from being XML.
pub(super) fn parse<'t>(text: &'t str, to: &mut Findings) -> Option<Document<'t>> {
    let start = text.trim_start();
    if !start.starts_with('<') {
        let what = if start.is_empty() {
            "the file is empty"
        } else {
            "this is not XML"
        };
        let help = "a URDF is one <robot> element";
        to.error(
            text.len() - start.len(),
            finding(code::FILE_CONTENT, what).help(help),
        );
        return None;
    }
    if !guard::admits(text, to) {
        return None;
    }
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: MAX_NODES,
        ..Default::default()
    };
    match Document::parse_with_options(text, options) {
        Ok(document) => Some(document),
        Err(error) => {
            let span = place(&error, text, to);
            to.error_at(span, explained(&error));
            None
        }
    }
}

fn place(error: &Error, text: &str, to: &Findings) -> Span {
    match error {
        Error::NoRootNode | Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            to.span(text.trim_end().len())
        }
        _ => Span {
            line: error.pos().row as usize,
            column: error.pos().col as usize,
        },
    }
}

fn explained(error: &Error) -> Finding {
    // The place is said once, in front.
    let what = error
        .to_string()
        .replace(&format!(" at {}", error.pos()), "");
    let (code, help) = match error {
        Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            return finding(code::XACRO, "macros of xacro are not expanded").help(RUN_XACRO);
        }
        Error::UnknownNamespace(..) => (code::XML_SYNTAX, "declare it: xmlns:prefix=\"...\""),
        Error::DtdDetected => (code::XML_DTD, "remove <!DOCTYPE ...>"),
        Error::NodesLimitReached | Error::AttributesLimitReached => (
            code::XML_COUNT,
            "a description holds links and joints, not data",
        ),
        Error::NoRootNode => (code::XML_SYNTAX, "a URDF is one <robot> element"),
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => (
            code::XML_SYNTAX,
            "is the file cut off, or a tag not closed?",
        ),
        Error::UnexpectedCloseTag(..) => (code::XML_SYNTAX, "is the element before it not closed?"),
        _ => (code::XML_SYNTAX, ""),
    };
    finding(code, format!("not well-formed XML: {what}")).help(help)
}

const RUN_XACRO: &str = "run `xacro robot.urdf.xacro > robot.urdf` and read the result";

/// The root, if it is a `<robot>` without macros.
pub(super) fn robot<'a>(document: &'a Document<'a>, to: &mut Findings) -> Option<Element<'a>> {
    let root = Element::new(document.root_element());
    if root.tag() != "robot" {
        to.error(root.offset(), wrong_root(root.tag()));
        return None;
    }
    if let Some(offset) = first_macro(document) {
        let found = finding(code::XACRO, "macros of xacro are not expanded").help(RUN_XACRO);
        to.error(offset, found);
        return None;
    }
    Some(root)
}

fn wrong_root(tag: &str) -> Finding {
    let (message, help) = match tag {
        "mujoco" => (
            "this is an MJCF file (<mujoco>), not a URDF",
            "convert it to URDF first",
        ),
        "sdf" | "gazebo" => (
            "this is an SDF file (<sdf>), not a URDF",
            "convert it to URDF first",
        ),
        "COLLADA" => (
            "this is a COLLADA mesh, not a URDF",
            "name the URDF that uses it",
        ),
        _ => {
            let message = format!("the root element is <{tag}>, not <robot>");
            return finding(code::FILE_CONTENT, message).help("a URDF is one <robot> element");
        }
    };
    finding(code::FILE_CONTENT, message).help(help)
}

/// The first element or value of links and joints that xacro should have replaced.
fn first_macro(document: &Document<'_>) -> Option<usize> {
    document
        .root_element()
        .descendants()
        .filter(|node| node.is_element())
        .find_map(|node| {
            if node
                .tag_name()
                .namespace()
                .is_some_and(|name| name.contains("xacro"))
            {
                return Some(node.range().start);
            }
            let left = |text: &str| text.contains("${") || text.contains("$(arg");
            let value = node.attributes().find(|one| left(one.value()))?;
            let ours = |one: Node<'_, '_>| matches!(one.tag_name().name(), "link" | "joint");
            let read = node.parent_element().is_none() || node.ancestors().any(ours);
            read.then(|| value.range_value().start)
        })
}
