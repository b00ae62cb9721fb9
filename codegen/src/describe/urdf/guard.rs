//! A look at the raw text before any parser sees it.
//!
//! XML parsers recurse over nested elements, compare every attribute of an element with every
//! other, and expand entities. A single pass over the bytes makes sure that none of that can
//! exhaust stack, time or memory.

use super::super::code;
use super::super::findings::{Findings, finding};

/// Deepest nesting of elements; a URDF needs six.
pub(super) const MAX_DEPTH: usize = 64;

/// Most attributes of one element; a URDF needs eight.
const MAX_ATTRIBUTES: usize = 256;

/// Most namespace declarations in a document; a URDF needs none.
const MAX_NAMESPACES: usize = 1000;

/// Whether the text may be given to a parser; if not, the findings say why.
pub(super) fn admits(text: &str, to: &mut Findings) -> bool {
    if text.matches("xmlns").count() > MAX_NAMESPACES {
        let message = format!("more than {MAX_NAMESPACES} namespace declarations");
        to.error(0, finding(code::XML_COUNT, message));
        return false;
    }
    let mut scan = Scan {
        text,
        at: 0,
        depth: 0,
    };
    while let Some(offset) = scan.next_markup() {
        if !scan.step(offset, to) {
            return false;
        }
    }
    true
}

struct Scan<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
}

impl Scan<'_> {
    /// The place of the next `<`.
    fn next_markup(&self) -> Option<usize> {
        Some(self.at + self.text.get(self.at..)?.find('<')?)
    }

    /// Goes past the markup at `offset`. What is not closed ends the scan: the parser finds it too.
    fn step(&mut self, offset: usize, to: &mut Findings) -> bool {
        let rest = self.text.get(offset..).unwrap_or_default();
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((open, close)) = skipped.iter().find(|(open, _)| rest.starts_with(open)) {
            let inside = rest.get(open.len()..).unwrap_or_default();
            self.at = match inside.find(close) {
                Some(end) => offset + open.len() + end + close.len(),
                None => self.text.len(),
            };
            return true;
        }
        if rest.starts_with("<!") {
            let found = finding(code::XML_DTD, "a document type declaration is not read");
            to.error(
                offset,
                found.help("remove <!DOCTYPE ...>; entities are not expanded"),
            );
            return false;
        }
        self.tag(offset, rest, to)
    }

    fn tag(&mut self, offset: usize, rest: &str, to: &mut Findings) -> bool {
        let tag = Tag::of(rest);
        self.at = offset + tag.length;
        if tag.attributes > MAX_ATTRIBUTES {
            let message = format!("an element with more than {MAX_ATTRIBUTES} attributes");
            to.error(offset, finding(code::XML_COUNT, message));
            return false;
        }
        if rest.starts_with("</") {
            self.depth = self.depth.saturating_sub(1);
        } else if !tag.closed {
            self.depth += 1;
        }
        if self.depth > MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            let help = "links and joints stand directly in <robot>; is a tag not closed?";
            to.error(offset, finding(code::XML_DEPTH, message).help(help));
            return false;
        }
        true
    }
}

/// What matters of a tag.
struct Tag {
    /// Bytes from `<` to `>`.
    length: usize,
    /// How many quoted values it has.
    attributes: usize,
    /// Whether it ends in `/>`.
    closed: bool,
}

impl Tag {
    fn of(rest: &str) -> Tag {
        let mut quote = None;
        let mut attributes = 0;
        let mut before = b'<';
        for (index, byte) in rest.bytes().enumerate() {
            match (quote, byte) {
                (None, b'>') => {
                    return Tag {
                        length: index + 1,
                        attributes,
                        closed: before == b'/',
                    };
                }
                (None, b'"' | b'\'') => {
                    quote = Some(byte);
                    attributes += 1;
                }
                (Some(open), _) if open == byte => quote = None,
                _ => {}
            }
            before = byte;
        }
        Tag {
            length: rest.len(),
            attributes,
            closed: true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Option<String> {
        let mut findings = Findings::new(text, "a.urdf");
        (!admits(text, &mut findings)).then(|| findings.decide().unwrap_err()[0].to_string())
    }

    #[test]
    fn admits_ordinary_documents_of_any_length() {
        let link = "<link name='a>b'/><!-- <a><b> --><![CDATA[<c><d>]]><x><y/></x>";
        assert_eq!(
            refused(&format!(
                "<?xml version='1.0'?><robot>{}</robot>",
                link.repeat(999)
            )),
            None
        );
    }

    #[test]
    fn admits_no_deep_nesting_no_doctype_no_thousand_attributes() {
        assert!(
            refused(&"<a>".repeat(16_000))
                .unwrap()
                .contains(":1:193: error [IDIM011]")
        );
        assert!(
            refused("<a/>\n<!DOCTYPE b>")
                .unwrap()
                .contains(":2:1: error [IDIM012]")
        );
        assert!(
            refused(&format!("<a{}/>", " b='c'".repeat(1000)))
                .unwrap()
                .contains("IDIM013")
        );
        assert!(refused(&"xmlns".repeat(1001)).unwrap().contains("IDIM013"));
    }
}
