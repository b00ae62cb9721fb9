//! Shapes of the links of a URDF: boxes, cylinders and spheres of `<collision>` and `<visual>`.
//!
//! The models need none of them; what they say is how far the mass of a link can reach.

use roxmltree::{Document, Node};

use super::Pose;

/// A shape with its place in the frame of its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Its centre and axes.
    pub pose: Pose,
    /// What it is.
    pub kind: SolidKind,
}

/// What a solid is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidKind {
    /// Edges, m.
    Box([f64; 3]),
    /// Radius about z and length along it, m.
    Cylinder(f64, f64),
    /// Radius, m.
    Sphere(f64),
}

/// The shapes of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkShapes {
    /// Name of the link.
    pub link: String,
    /// Those of `<collision>`; where one of these is no solid, those of `<visual>`; none where one of
    /// these is none either.
    pub solids: Vec<Solid>,
    /// Whether that is for a mesh or another shape that is not read.
    pub meshes: bool,
}

/// Why the shapes of a URDF cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ShapeError {
    /// No XML.
    #[error("the URDF cannot be read: {0}")]
    Xml(String),
    /// A size or place that is none.
    #[error("{what} of a shape of link `{link}` is `{text}`; write {must}")]
    Value {
        /// The link.
        link: String,
        /// Which attribute.
        what: &'static str,
        /// What stands there.
        text: String,
        /// What should.
        must: &'static str,
    },
}

/// The shapes of all links, in the order of the text.
///
/// # Errors
/// [`ShapeError`].
pub fn shapes(text: &str) -> Result<Vec<LinkShapes>, ShapeError> {
    let document = Document::parse(text).map_err(|error| ShapeError::Xml(error.to_string()))?;
    let links = document.root_element().children();
    let links = links.filter(|node| node.has_tag_name("link"));
    links.map(of_link).collect()
}

fn of_link(link: Node<'_, '_>) -> Result<LinkShapes, ShapeError> {
    let mut found = LinkShapes {
        link: link.attribute("name").unwrap_or_default().trim().to_owned(),
        solids: Vec::new(),
        meshes: false,
    };
    for tag in ["collision", "visual"] {
        let elements = link.children().filter(|node| node.has_tag_name(tag));
        let solids = elements.map(|element| solid(element, &found.link));
        let solids: Vec<Option<Solid>> = solids.collect::<Result<_, _>>()?;
        found.meshes |= solids.iter().any(Option::is_none);
        let all: Option<Vec<Solid>> = solids.into_iter().collect();
        // The coarser shape says enough; beside a mesh, a shape says nothing.
        if let Some(solids) = all.filter(|solids| !solids.is_empty()) {
            return Ok(LinkShapes {
                solids,
                meshes: false,
                ..found
            });
        }
    }
    Ok(found)
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn solid(element: Node<'_, '_>, link: &str) -> Result<Option<Solid>, ShapeError> {
    let geometry = child(element, "geometry");
    let Some(shape) = geometry.and_then(|geometry| geometry.first_element_child()) else {
        return Ok(None);
    };
    let size = |what| positive(shape, what, link);
    let kind = match shape.tag_name().name() {
        "box" => SolidKind::Box(triple(shape, "size", link, true)?.unwrap_or_default()),
        "cylinder" => SolidKind::Cylinder(size("radius")?, size("length")?),
        "sphere" => SolidKind::Sphere(size("radius")?),
        _ => return Ok(None),
    };
    let mut pose = Pose::default();
    if let Some(origin) = child(element, "origin") {
        pose.xyz = triple(origin, "xyz", link, false)?.unwrap_or_default();
        pose.rpy = triple(origin, "rpy", link, false)?.unwrap_or_default();
    }
    Ok(Some(Solid { pose, kind }))
}

/// A length that has to be there.
fn positive(node: Node<'_, '_>, what: &'static str, link: &str) -> Result<f64, ShapeError> {
    let text = node.attribute(what).unwrap_or_default();
    let value = text.trim().parse().ok();
    let value = value.filter(|value: &f64| *value > 0.0 && value.is_finite());
    value.ok_or_else(|| ShapeError::Value {
        link: link.to_owned(),
        what,
        text: text.to_owned(),
        must: "a positive length in m",
    })
}

/// Three numbers, if they are there; a size has to be, and to be positive.
fn triple(
    node: Node<'_, '_>,
    what: &'static str,
    link: &str,
    size: bool,
) -> Result<Option<[f64; 3]>, ShapeError> {
    let Some(text) = node.attribute(what).or(size.then_some("")) else {
        return Ok(None);
    };
    let numbers = text.split_whitespace().map(|word| word.parse::<f64>().ok());
    let numbers: Option<Vec<f64>> = numbers.collect();
    let fits = |values: &[f64; 3]| {
        values
            .iter()
            .all(|value| value.is_finite() && (!size || *value > 0.0))
    };
    let numbers = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    match numbers.filter(fits) {
        Some(numbers) => Ok(Some(numbers)),
        None => Err(ShapeError::Value {
            link: link.to_owned(),
            what,
            text: text.to_owned(),
            must: match size {
                true => "three positive lengths in m",
                false => "three numbers",
            },
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_are_read_with_their_places_and_meshes_are_told() {
        let text = r#"<robot name="r"><link name="a">
<visual><geometry><sphere radius="9"/></geometry></visual>
<collision><origin xyz="0.1 0 -0.2" rpy="0 1 0"/><geometry><box size="0.2 0.3 0.4"/></geometry></collision></link>
<link name="b"><visual><geometry><cylinder radius="0.05" length="0.3"/></geometry></visual>
<collision><geometry><mesh filename="a.stl"/></geometry></collision></link>
<link name="c"/>
<link name="d"><visual><geometry><sphere radius="1"/></geometry></visual>
<visual><geometry><mesh filename="a.stl"/></geometry></visual></link></robot>"#;
        let found = shapes(text).unwrap();
        let [a, b, c, d] = &found[..] else {
            panic!("{found:?}");
        };
        assert_eq!(a.solids.len(), 1);
        assert_eq!(a.solids[0].kind, SolidKind::Box([0.2, 0.3, 0.4]));
        let pose = a.solids[0].pose;
        assert_eq!((pose.xyz, pose.rpy), ([0.1, 0.0, -0.2], [0.0, 1.0, 0.0]));
        assert_eq!(b.solids[0].kind, SolidKind::Cylinder(0.05, 0.3));
        assert!(c.solids.is_empty() && !c.meshes);
        assert!(d.solids.is_empty() && d.meshes);
    }

    #[test]
    fn sizes_that_are_none_are_errors_with_their_link() {
        let sized = |shape: &str| {
            shapes(&format!(
                "<robot name=\"r\"><link name=\"a\"><collision><geometry>{shape}</geometry>\
                 </collision></link></robot>"
            ))
        };
        for wrong in [
            "<box size=\"1 2\"/>",
            "<box/>",
            "<box size=\"1 0 1\"/>",
            "<sphere radius=\"-1\"/>",
            "<cylinder radius=\"1\"/>",
        ] {
            match sized(wrong) {
                Err(ShapeError::Value { link, .. }) => assert_eq!(link, "a"),
                other => panic!("{wrong}: {other:?}"),
            }
        }
        assert!(matches!(shapes("<robot"), Err(ShapeError::Xml(_))));
    }
}
