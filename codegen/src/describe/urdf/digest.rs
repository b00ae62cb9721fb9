//! What is left of a URDF for urdf-rs to read: links with inertias, joints, valid numbers.
//!
//! Meshes, plugins and everything of foreign namespaces stay behind, and what was found to be
//! wrong is replaced by something harmless, so that values can be checked in the same run.

/// XML text that grows.
pub(super) struct Digest {
    text: String,
    quaternions: bool,
}

impl Digest {
    /// An open `<robot>` of a version of URDF; 1.0 if none is stated.
    ///
    /// urdf-rs gives quaternions a meaning from version 1.1 on, and has rules of its own about
    /// limits from 1.2 on, which are checked with their places elsewhere.
    pub(super) fn new(version: Option<&str>) -> Self {
        let number = |text: &str| text.trim().parse::<u32>().ok();
        let parts = version.and_then(|text| text.split_once('.'));
        let parts = parts.and_then(|(major, minor)| Some((number(major)?, number(minor)?)));
        let quaternions = parts.is_some_and(|version| version >= (1, 1));
        let version = if quaternions { "1.1" } else { "1.0" };
        Digest {
            text: format!("<robot name=\"r\" version=\"{version}\">"),
            quaternions,
        }
    }

    /// Whether an orientation may be a quaternion.
    pub(super) fn knows_quaternions(&self) -> bool {
        self.quaternions
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
