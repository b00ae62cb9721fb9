//! How far the mass of links can reach, from the boxes that the description states and the shapes
//! that a URDF gives them.

use idim_codegen::describe::shapes::{LinkShapes, Solid, SolidKind, shapes};
use idim_codegen::mechanism::{Joint, Mechanism, Pose};
use idim_runtime::physical::{Bound, Extent, Shape};
use nalgebra::Vector3;

use super::ExportError;
use super::stated::Stated;

/// What the mass of each link is inside of, in the link's frame: the described robot and the one of
/// the URDF, in the same frames, with the URDF's shapes if asked for. A box of the description comes
/// before them. Links with shapes that are not read go among the warnings.
///
/// # Errors
/// [`ExportError::Shapes`], [`ExportError::NoShapes`].
pub(super) fn of(
    [own, carrier]: [&Mechanism; 2],
    stated: &Stated<'_>,
    urdf: Option<&str>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Bound>, ExportError> {
    let single = stated.shapes();
    let mut known = single.clone();
    known.extend(urdf.map(shapes).transpose()?.unwrap_or_default());
    let mut bounds = Vec::new();
    for (link, (own, joint)) in own.joints.iter().zip(&carrier.joints).enumerate() {
        let whole = stated.whole(own, link).map(|(pose, solid)| {
            let placed = pose.then(&Pose::from_rpy(&solid.pose));
            one(&placed, &solid)
        });
        let found = whole.or_else(|| extent(own, &single));
        match found.or_else(|| extent(joint, &known)) {
            Some(extent) => bounds.push(Bound {
                what: format!("what moves with `{}`", joint.name),
                link,
                extent,
            }),
            // Without --boxes, nobody asked for those of the other links.
            None if urdf.is_none() => {}
            None => warnings.push(format!(
                "What moves with `{}` has no box, cylinder or sphere, or meshes beside, which are not \
                 read: its mass may be anywhere.",
                joint.name
            )),
        }
    }
    match bounds.is_empty() {
        true => Err(ExportError::NoShapes),
        false => Ok(bounds),
    }
}

/// The one solid of a joint's bodies, or an upright box in the frame of the first around them all.
/// `None` where a body with a mass has none, or meshes.
fn extent(joint: &Joint, known: &[LinkShapes]) -> Option<Extent> {
    let mut solids: Vec<(Pose, Solid)> = Vec::new();
    for body in &joint.bodies {
        let heavy = body.inertial.is_some_and(|inertial| inertial.mass > 0.0);
        let alone = joint.bodies.len() == 1;
        let Some(shapes) = known.iter().find(|shapes| shapes.link == body.name) else {
            // A frame without mass needs no shape, if it is known for one.
            match heavy || joint.carried().mass <= 0.0 {
                true => return None,
                false => continue,
            }
        };
        if shapes.meshes || ((heavy || alone) && shapes.solids.is_empty()) {
            return None;
        }
        let placed = |solid: &Solid| (body.pose.then(&Pose::from_rpy(&solid.pose)), *solid);
        solids.extend(shapes.solids.iter().map(placed));
    }
    match solids.as_slice() {
        [] => None,
        [(pose, solid)] => Some(one(pose, solid)),
        all => Some(around(&joint.bodies.first()?.pose, all)),
    }
}

fn one(pose: &Pose, solid: &Solid) -> Extent {
    Extent {
        shape: match solid.kind {
            SolidKind::Box(edges) => Shape::Box(edges.map(|edge| 0.5 * edge)),
            SolidKind::Cylinder(radius, length) => Shape::Cylinder(radius, 0.5 * length),
            SolidKind::Sphere(radius) => Shape::Sphere(radius),
        },
        ..standing(pose, [0.0; 3])
    }
}

/// A box with the axes of a frame.
fn standing(frame: &Pose, half: [f64; 3]) -> Extent {
    Extent {
        center: frame.translation.into(),
        axes: std::array::from_fn(|axis| frame.rotation.column(axis).into_owned().into()),
        shape: Shape::Box(half),
    }
}

/// The box along the axes of a frame that is just around all solids.
fn around(frame: &Pose, solids: &[(Pose, Solid)]) -> Extent {
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (pose, solid) in solids {
        let pose = frame.inverse().then(pose);
        for axis in 0..3 {
            let along: Vector3<f64> = pose.rotation.row(axis).transpose();
            let (at, reach) = (pose.translation[axis], reach(solid, &along));
            least[axis] = least[axis].min(at - reach);
            most[axis] = most[axis].max(at + reach);
        }
    }
    let middle: [f64; 3] = std::array::from_fn(|axis| 0.5 * (least[axis] + most[axis]));
    let center = Pose {
        translation: frame.translation + frame.rotation * Vector3::from(middle),
        ..*frame
    };
    standing(
        &center,
        std::array::from_fn(|axis| 0.5 * (most[axis] - least[axis])),
    )
}

/// How far a solid reaches from its centre along a direction of its own frame, m.
fn reach(solid: &Solid, along: &Vector3<f64>) -> f64 {
    match solid.kind {
        SolidKind::Box(edges) => 0.5 * along.abs().dot(&Vector3::from(edges)),
        SolidKind::Cylinder(radius, length) => {
            radius * along.x.hypot(along.y) + 0.5 * length * along.z.abs()
        }
        SolidKind::Sphere(radius) => radius,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use idim_codegen::builder::read_texts;

    const ARM: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/><geometry><box size="0.2 0.4 0.1"/></geometry></collision></link>
<link name="tool"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
<joint name="f" type="fixed"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="tool"/></joint>
</robot>"#;

    #[test]
    fn box_around_bodies_that_move_together() {
        let robot = read_texts(&[("arm.urdf", ARM)]).unwrap();
        let stated = Stated::of(&robot).unwrap();
        let mechanisms = [&robot.mechanism; 2];
        let bounds = of(mechanisms, &stated, Some(ARM), &mut Vec::new()).unwrap();
        let [bound] = &bounds[..] else {
            panic!("{bounds:?}");
        };
        // x from 0.1 - 0.2 to 0.5 + 0.05, y to 0.1, z to the cylinder's 0.1.
        let Shape::Box(half) = bound.extent.shape else {
            panic!("{bound:?}");
        };
        let wanted = [0.325, 0.1, 0.1, 0.225, 0.0, 0.0];
        for (found, wanted) in half.iter().chain(&bound.extent.center).zip(wanted) {
            assert!((found - wanted).abs() < 1e-12, "{bound:?}");
        }
    }

    #[test]
    fn meshes_leave_a_link_without_a_shape() {
        let mesh = ARM.replace(
            "<cylinder radius=\"0.05\" length=\"0.2\"/>",
            "<mesh filename=\"t.stl\"/>",
        );
        let robot = read_texts(&[("arm.urdf", mesh.as_str())]).unwrap();
        let mut warnings = Vec::new();
        let stated = Stated::of(&robot).unwrap();
        let none = of([&robot.mechanism; 2], &stated, Some(&mesh), &mut warnings);
        assert!(matches!(none, Err(ExportError::NoShapes)));
        assert!(warnings[0].contains("`j`"));
    }
}
