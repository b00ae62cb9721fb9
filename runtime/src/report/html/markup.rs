//! Elements of the page, and the one place where text is escaped.

use std::fmt::{Display, Write};

/// Elements that never have an end tag.
const VOID: [&str; 5] = ["meta", "br", "hr", "input", "col"];

/// An element of HTML or SVG: names are the program's own, everything else is escaped.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Node>,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Element(Element),
    Text(String),
    /// Style sheet or script, of the program's own text and nothing else.
    Own(&'static str),
}

/// An empty element.
pub(super) fn el(name: &'static str) -> Element {
    Element {
        name,
        attributes: Vec::new(),
        children: Vec::new(),
    }
}

/// An empty element of a class.
pub(super) fn classed(name: &'static str, class: &str) -> Element {
    el(name).attr("class", class)
}

impl Element {
    /// Adds an attribute.
    pub fn attr(mut self, name: &'static str, value: impl Display) -> Self {
        self.attributes.push((name, value.to_string()));
        self
    }

    /// Adds text.
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.children.push(Node::Text(text.into()));
        self
    }

    /// Adds a child.
    pub fn child(mut self, child: Element) -> Self {
        self.children.push(Node::Element(child));
        self
    }

    /// Adds children.
    pub fn children(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        let nodes = children.into_iter().map(Node::Element);
        self.children.extend(nodes);
        self
    }

    /// Adds a text that is written as it stands: only one that is compiled in can be.
    pub fn own(mut self, text: &'static str) -> Self {
        self.children.push(Node::Own(text));
        self
    }

    /// Writes the element.
    pub fn write(&self, out: &mut String) {
        // Writing to a String does not fail.
        let _ = write!(out, "<{}", self.name);
        for (name, value) in &self.attributes {
            let _ = write!(out, " {name}=\"");
            escape(value, out);
            out.push('"');
        }
        if VOID.contains(&self.name) {
            out.push_str("/>");
            return;
        }
        out.push('>');
        for child in &self.children {
            match child {
                Node::Element(element) => element.write(out),
                Node::Text(text) => escape(text, out),
                Node::Own(text) => out.push_str(text),
            }
        }
        let _ = write!(out, "</{}>", self.name);
        if BLOCKS.contains(&self.name) {
            out.push('\n');
        }
    }
}

/// Elements after which a line ends, so that the source of a page can be read.
const BLOCKS: [&str; 12] = [
    "head", "title", "style", "script", "header", "section", "figure", "svg", "p", "tr", "table",
    "details",
];

/// Writes a text so that it can neither end nor begin markup, in an element or an attribute.
/// Characters that no XML may hold become replacement characters.
fn escape(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_attributes_cannot_leave_their_place() {
        let mut out = String::new();
        el("p")
            .attr("title", "\"><script>alert('x')</script>")
            .text("a < b & c\u{0}")
            .child(el("br"))
            .write(&mut out);
        assert_eq!(
            out,
            "<p title=\"&quot;&gt;&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;\">\
             a &lt; b &amp; c\u{FFFD}<br/></p>\n"
        );
    }
}
