//! Other inertial values in a URDF, every other byte as it is.

use roxmltree::{Document, Node};

use super::edit::{Edit, attribute, child, edited, indent, inside, named};
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
    /// A joint that is not in it.
    #[error("the URDF has no joint `{0}`: it is not that of this robot")]
    Joint(String),
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
        let link = named(&document, "link", name);
        let link = link.ok_or_else(|| UrdfError::Link(name.clone()))?;
        match child(link, "inertial") {
            Some(element) => replaced(text, element, inertial, &mut edits),
            None => edits.push(inside(text, link, &element(text, link, inertial))),
        }
    }
    Ok(edited(text, edits))
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

/// A new `<inertial>`, set off like the link's own lines.
fn element(text: &str, link: Node<'_, '_>, inertial: &UrdfInertial) -> String {
    let indent = indent(text, link);
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
