//! Random robots as the texts that users write.

use std::fmt::Write;

use super::draw::{Inertial, Kind, Robot, Row};
use super::vector::Vector;

/// Joint k is `jK`, the link that it carries `lK+1`.
pub fn urdf(robot: &Robot) -> String {
    let mut text = "<robot name=\"random\">\n<link name=\"l0\"/>\n".to_owned();
    for (index, joint) in robot.joints.iter().enumerate() {
        let link = index + 1;
        let inertial = joint.inertial.as_ref().map(inertial).unwrap_or_default();
        writeln!(text, "<link name=\"l{link}\">{inertial}</link>").unwrap();
        let parent = format!("l{}", joint.parent);
        let pose = origin(joint.rpy, joint.xyz);
        let axis = format!("<axis xyz=\"{}\"/>", three(joint.axis));
        text += &element(
            &format!("j{index}"),
            joint.kind,
            &parent,
            link,
            &pose,
            &axis,
        );
    }
    text + "</robot>\n"
}

fn element(name: &str, kind: Kind, parent: &str, link: usize, origin: &str, axis: &str) -> String {
    let (word, axis, limit) = match kind {
        Kind::Revolute => ("continuous", axis, ""),
        Kind::Prismatic => (
            "prismatic",
            axis,
            "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"9\"/>",
        ),
        Kind::Fixed => ("fixed", "", ""),
    };
    format!(
        "<joint name=\"{name}\" type=\"{word}\"><parent link=\"{parent}\"/>\
         <child link=\"l{link}\"/>{origin}{axis}{limit}</joint>\n"
    )
}

fn inertial(body: &Inertial) -> String {
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = body.inertia;
    format!(
        "<inertial>{}<mass value=\"{}\"/><inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" \
         iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/></inertial>",
        origin(body.rpy, body.xyz),
        body.mass
    )
}

fn origin(rpy: Vector, xyz: Vector) -> String {
    format!("<origin rpy=\"{}\" xyz=\"{}\"/>", three(rpy), three(xyz))
}

fn three([x, y, z]: Vector) -> String {
    format!("{x} {y} {z}")
}

/// The companion of `arm.urdf`.
pub fn companion(gravity: Vector, effects: &[&str]) -> String {
    format!("urdf = \"arm.urdf\"\ngravity = {gravity:?}\neffects = {effects:?}\n")
}

/// A table as a description of its own.
pub fn table(rows: &[Row]) -> String {
    let mut text = "name = \"random\"\neffects = []\n".to_owned();
    for (index, row) in rows.iter().enumerate() {
        let kind = match row.kind {
            Kind::Prismatic => "prismatic",
            _ => "revolute",
        };
        writeln!(
            text,
            "[[joint]]\nname = \"j{index}\"\nkind = \"{kind}\"\nant = {}\ngamma = {:?}\nb = {:?}\n\
             alpha = {:?}\nd = {:?}\ntheta = {:?}\nr = {:?}",
            row.ant, row.gamma, row.b, row.alpha, row.d, row.theta, row.r
        )
        .unwrap();
    }
    text
}

/// The same robot as a URDF: the turns and shifts of a row one after the other, as fixed joints
/// with empty links, the last with the moving joint.
pub fn table_as_urdf(rows: &[Row]) -> String {
    let mut text = "<robot name=\"random\">\n<link name=\"l0\"/>\n".to_owned();
    let mut links = 0;
    let mut carried = vec![0];
    for (index, row) in rows.iter().enumerate() {
        let steps = [
            (Kind::Fixed, [0.0, 0.0, row.gamma], [0.0, 0.0, row.b]),
            (Kind::Fixed, [row.alpha, 0.0, 0.0], [row.d, 0.0, 0.0]),
            (row.kind, [0.0, 0.0, row.theta], [0.0, 0.0, row.r]),
        ];
        let mut parent = carried[row.ant];
        for (place, (kind, rpy, xyz)) in steps.into_iter().enumerate() {
            links += 1;
            let name = match place {
                2 => format!("j{index}"),
                _ => format!("f{index}_{place}"),
            };
            writeln!(text, "<link name=\"l{links}\"/>").unwrap();
            let from = format!("l{parent}");
            let axis = "<axis xyz=\"0 0 1\"/>";
            text += &element(&name, kind, &from, links, &origin(rpy, xyz), axis);
            parent = links;
        }
        carried.push(parent);
    }
    text + "</robot>\n"
}
