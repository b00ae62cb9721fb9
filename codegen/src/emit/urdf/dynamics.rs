//! Friction in a URDF: `<dynamics damping= friction=>` of its joints.

use roxmltree::Document;

use super::UrdfError;
use super::edit::{attribute, child, edited, indent, inside, named};

/// Friction of a joint as a URDF has it; `None` leaves what is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dynamics {
    /// Viscous friction, N m s/rad or N s/m.
    pub damping: Option<f64>,
    /// Coulomb friction, N m or N.
    pub friction: Option<f64>,
}

impl Dynamics {
    fn attributes(&self) -> impl Iterator<Item = (&'static str, String)> {
        let both = [("damping", self.damping), ("friction", self.friction)];
        let stated = both.into_iter();
        stated.filter_map(|(name, value)| Some((name, (value? + 0.0).to_string())))
    }
}

/// The text of a URDF with other friction of the joints that are named; a joint without
/// `<dynamics>` gets one. Every other byte stays.
///
/// # Errors
/// [`UrdfError`].
pub fn with_dynamics(text: &str, joints: &[(String, Dynamics)]) -> Result<String, UrdfError> {
    let document = Document::parse(text).map_err(|error| UrdfError::Xml(error.to_string()))?;
    let mut edits = Vec::new();
    for (name, dynamics) in joints {
        let joint = named(&document, "joint", name);
        let joint = joint.ok_or_else(|| UrdfError::Joint(name.clone()))?;
        let values = dynamics.attributes();
        match child(joint, "dynamics") {
            Some(element) => {
                edits.extend(values.map(|(name, value)| attribute(text, element, name, &value)));
            }
            None => {
                let values: String = values.map(|(k, v)| format!(" {k}=\"{v}\"")).collect();
                let indent = indent(text, joint);
                let element = format!("\n{indent}  <dynamics{values}/>");
                edits.extend((!values.is_empty()).then(|| inside(text, joint, &element)));
            }
        }
    }
    Ok(edited(text, edits))
}

/// Friction of all joints of a URDF that state one, by name; what is no number is not stated.
///
/// # Errors
/// [`UrdfError::Xml`].
pub fn dynamics(text: &str) -> Result<Vec<(String, Dynamics)>, UrdfError> {
    let document = Document::parse(text).map_err(|error| UrdfError::Xml(error.to_string()))?;
    let joints = document.root_element().children();
    let joints = joints.filter(|node| node.has_tag_name("joint"));
    let stated = joints.filter_map(|joint| {
        let element = child(joint, "dynamics")?;
        let value = |name: &str| element.attribute(name)?.trim().parse().ok();
        let dynamics = Dynamics {
            damping: value("damping"),
            friction: value("friction"),
        };
        Some((joint.attribute("name")?.trim().to_owned(), dynamics))
    });
    Ok(stated.collect())
}
