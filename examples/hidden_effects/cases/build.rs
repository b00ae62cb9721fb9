//! Links and joints put into a description.

use idim::codegen::catalogue::EffectKind;
use idim::codegen::describe::{
    Description, Drive, EffectSpec, Geometry, Limits, Motion, Pose, Span, UrdfInertial, UrdfJoint,
    UrdfLink, UrdfTree,
};

/// Mass and moments of links that are only joints: next to nothing.
const NOTHING: (f64, f64) = (1e-5, 1e-8);

/// The links and joints; all robots here are URDFs.
pub fn tree(description: &mut Description) -> &mut UrdfTree {
    if let Geometry::Mdh(_) = description.geometry {
        let (links, joints) = (Vec::new(), Vec::new());
        description.geometry = Geometry::Urdf(UrdfTree { links, joints });
    }
    match &mut description.geometry {
        Geometry::Urdf(tree) => tree,
        Geometry::Mdh(_) => unreachable!("replaced above"),
    }
}

/// Asks for an effect.
pub fn ask(to: &mut Description, kind: EffectKind, joints: Vec<String>, shape: &[f64]) {
    let named = kind.shapes().iter().zip(shape);
    to.effects.push(EffectSpec {
        kind,
        joints,
        shape: named.map(|(known, value)| (known.name, *value)).collect(),
        span: Span { line: 0, column: 0 },
    });
}

/// A body of its own.
pub fn body(mass: f64, com: [f64; 3], [xx, yy, zz]: [f64; 3]) -> UrdfInertial {
    UrdfInertial {
        mass,
        origin: Pose {
            rpy: [0.0; 3],
            xyz: com,
        },
        inertia: [xx, 0.0, 0.0, yy, 0.0, zz],
    }
}

fn link(tree: &mut UrdfTree, inertial: UrdfInertial) -> usize {
    let name = format!("added{}", tree.links.len());
    tree.links.push(UrdfLink {
        name,
        inertial: Some(inertial),
        span: Span { line: 0, column: 0 },
    });
    tree.links.len() - 1
}

/// Hangs a body on the flange (the last link there is); returns the name of the joint.
pub fn fasten(
    tree: &mut UrdfTree,
    motion: Motion,
    axis: [f64; 3],
    inertial: UrdfInertial,
) -> String {
    let flange = tree.links.iter().position(|link| link.name == "flange");
    let parent = flange.unwrap_or_default();
    let child = link(tree, inertial);
    let name = format!("hanging{child}");
    tree.joints.push(UrdfJoint {
        name: name.clone(),
        motion,
        parent,
        child,
        origin: Pose::default(),
        axis,
        drive: Drive::Own,
        limits: Limits::default(),
        span: Span { line: 0, column: 0 },
    });
    name
}

/// Puts a joint behind another one: the first turns a drive, the second what the drive carries.
/// Returns the name of the second.
pub fn split(tree: &mut UrdfTree, joint: &str) -> String {
    let (mass, moment) = NOTHING;
    let between = link(tree, body(mass, [0.0; 3], [moment; 3]));
    let gear = format!("{joint}_gear");
    let place = tree.joints.iter().position(|known| known.name == joint);
    let place = place.unwrap_or_default();
    let carried = tree.joints[place].child;
    tree.joints[place].child = between;
    let behind = UrdfJoint {
        name: gear.clone(),
        parent: between,
        child: carried,
        origin: Pose::default(),
        limits: Limits::default(),
        ..tree.joints[place].clone()
    };
    tree.joints.insert(place + 1, behind);
    gear
}

/// Puts a joint between the base and everything on it, turning about x or y of frame 0 at the
/// floor; returns its name.
pub fn rock(tree: &mut UrdfTree, axis: [f64; 3]) -> String {
    let (mass, moment) = NOTHING;
    let is_child = |link: usize| tree.joints.iter().any(|joint| joint.child == link);
    let root = (0..tree.links.len()).find(|&link| !is_child(link));
    let root = root.unwrap_or_default();
    let rocking = link(tree, body(mass, [0.0; 3], [moment; 3]));
    for joint in tree.joints.iter_mut().filter(|joint| joint.parent == root) {
        joint.parent = rocking;
    }
    tree.joints.insert(
        0,
        UrdfJoint {
            name: "rocking".into(),
            motion: Motion::Revolute,
            parent: root,
            child: rocking,
            origin: Pose::default(),
            axis,
            drive: Drive::Own,
            limits: Limits::default(),
            span: Span { line: 0, column: 0 },
        },
    );
    "rocking".into()
}

/// A hanging body.
pub fn hanging(mass: f64, below: f64) -> UrdfInertial {
    body(mass, [0.0, 0.0, below], [mass * 0.0004; 3])
}

/// Gravity as a base that is turned about x, then about y, sees it.
pub fn tilted([gx, gy, gz]: [f64; 3], x: f64, y: f64) -> [f64; 3] {
    let ((sx, cx), (sy, cy)) = (x.sin_cos(), y.sin_cos());
    let (gy, gz) = (cx * gy + sx * gz, cx * gz - sx * gy);
    [cy * gx - sy * gz, gy, cy * gz + sy * gx]
}

/// Moves a point along the line to it.
pub fn lengthen(at: &mut [f64; 3], by: f64) {
    let length = at.iter().map(|x| x * x).sum::<f64>().sqrt();
    at.iter_mut()
        .for_each(|x| *x *= 1.0 + by / length.max(f64::MIN_POSITIVE));
}
