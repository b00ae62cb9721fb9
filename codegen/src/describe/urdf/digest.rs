//! What is left of a URDF for urdf-rs to read: links with inertias, joints, valid numbers.
//!
//! Meshes, plugins and everything of foreign namespaces stay behind, and what was found to be
//! wrong is replaced by something harmless, so that values can be checked in the same run.

/// XML text that grows.
pub(super) struct Digest {
    text: String,
}

impl Digest {
    /// An open `<robot>`; urdf-rs gives quaternions a meaning from version 1.1 on, and rules of
    /// its own about limits from 1.2 on, which are checked here with their places instead.
    pub(super) fn new() -> Self {
        Digest {
            text: "<robot name=\"r\" version=\"1.1\">".to_owned(),
        }
    }

    /// An element that contains others.
    pub(super) fn open(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.start(tag, attributes);
        self.text.push('>');
    }

    /// The end of such an element.
    pub(super) fn close(&mut self, tag: &str) {
        self.text.push_str("</");
        self.text.push_str(tag);
        self.text.push('>');
    }

    /// An element without content.
    pub(super) fn empty(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.start(tag, attributes);
        self.text.push_str("/>");
    }

    /// The whole text.
    pub(super) fn finish(mut self) -> String {
        self.close("robot");
        self.text
    }

    fn start(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.text.push('<');
        self.text.push_str(tag);
        for (name, value) in attributes {
            self.text.push(' ');
            self.text.push_str(name);
            self.text.push_str("=\"");
            for letter in value.chars() {
                match letter {
                    '&' => self.text.push_str("&amp;"),
                    '<' => self.text.push_str("&lt;"),
                    '"' => self.text.push_str("&quot;"),
                    _ => self.text.push(letter),
                }
            }
            self.text.push('"');
        }
    }
}
