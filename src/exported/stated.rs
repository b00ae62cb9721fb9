//! What the description knows of its bodies beside any log: `total_mass` and `[[link]]`.

use idim_codegen::Robot;
use idim_codegen::describe::shapes::{LinkShapes, Solid, SolidKind};
use idim_codegen::describe::{LinkSpec, Pose as Placed};
use idim_codegen::mechanism::{Joint, Pose};

use super::ExportError;

/// An entry and where it belongs.
struct Entry<'r> {
    spec: &'r LinkSpec,
    /// What moves with this joint, counted from 0.
    link: usize,
    /// The frame that the entry is written in, in that of the joint.
    frame: Pose,
}

/// The entries of a description.
pub(super) struct Stated<'r> {
    pub total_mass: Option<f64>,
    entries: Vec<Entry<'r>>,
}

impl<'r> Stated<'r> {
    /// Finds the link of every entry.
    ///
    /// # Errors
    /// [`ExportError::UnknownLink`].
    pub fn of(robot: &'r Robot) -> Result<Stated<'r>, ExportError> {
        let joints = &robot.mechanism.joints;
        let entry = |spec: &'r LinkSpec| {
            let (link, frame) = place(joints, &spec.name).ok_or_else(|| {
                let known = joints.iter().map(|joint| joint.name.clone());
                ExportError::UnknownLink {
                    name: spec.name.clone(),
                    known: known.collect(),
                }
            })?;
            Ok(Entry { spec, link, frame })
        };
        let entries = robot.description.links.iter().map(entry);
        Ok(Stated {
            total_mass: robot.description.total_mass,
            entries: entries.collect::<Result<_, ExportError>>()?,
        })
    }

    /// Masses, each with its link and the name of its entry.
    pub fn masses(&self) -> impl Iterator<Item = (usize, &'r str, f64)> {
        let mass = |entry: &Entry<'r>| Some((entry.link, &*entry.spec.name, entry.spec.mass?));
        self.entries.iter().filter_map(mass)
    }

    /// Whether there is any box.
    pub fn has_boxes(&self) -> bool {
        self.entries.iter().any(|e| e.spec.corners.is_some())
    }

    /// Boxes by the names of bodies: an entry of a joint that is no body's is one of all that moves
    /// with it, `whole`, with its frame.
    pub fn whole(&self, joint: &Joint, link: usize) -> Option<(Pose, Solid)> {
        let body = |name: &str| joint.bodies.iter().any(|body| body.name == name);
        let mut own = self.entries.iter().filter(|entry| entry.link == link);
        let alone = joint.bodies.len() == 1;
        let entry = own.find(|e| e.spec.corners.is_some() && (alone || !body(&e.spec.name)))?;
        Some((entry.frame, solid(entry.spec.corners?)))
    }

    /// Boxes of single bodies, as shapes beside those of a URDF.
    pub fn shapes(&self) -> Vec<LinkShapes> {
        let shape = |entry: &Entry<'r>| {
            Some(LinkShapes {
                link: entry.spec.name.clone(),
                solids: vec![solid(entry.spec.corners?)],
                meshes: false,
            })
        };
        self.entries.iter().filter_map(shape).collect()
    }

    /// Planes of each link, by their normals, and the frame they are in; those of the options,
    /// which are in the link's own frame, come before those of the description.
    ///
    /// # Errors
    /// [`ExportError::Planes`].
    pub fn planes(
        &self,
        joints: &[Joint],
        stated: &[(usize, usize)],
    ) -> Result<Vec<(usize, usize, Pose)>, ExportError> {
        let own = stated.iter().map(|(link, n)| (*link, *n, Pose::identity()));
        let mut planes: Vec<(usize, usize, Pose)> = own.collect();
        for entry in &self.entries {
            if stated.iter().any(|(link, _)| *link == entry.link) {
                continue;
            }
            let mut before = planes.iter().filter(|(link, ..)| *link == entry.link);
            if !entry.spec.symmetric.is_empty() && before.any(|(.., frame)| *frame != entry.frame) {
                return Err(ExportError::Planes(joints[entry.link].name.clone()));
            }
            let normals = entry.spec.symmetric.iter().map(|plane| plane.normal());
            planes.extend(normals.map(|normal| (entry.link, normal, entry.frame)));
        }
        Ok(planes)
    }
}

/// The joint that a name belongs to, and the frame of that name.
fn place(joints: &[Joint], name: &str) -> Option<(usize, Pose)> {
    let bodies = joints.iter().enumerate().find_map(|(link, joint)| {
        let body = joint.bodies.iter().find(|body| body.name == name)?;
        Some((link, body.pose))
    });
    bodies.or_else(|| {
        let link = joints.iter().position(|joint| joint.name == name)?;
        let first = joints[link].bodies.first();
        Some((link, first.map_or(Pose::identity(), |body| body.pose)))
    })
}

fn solid([lowest, highest]: [[f64; 3]; 2]) -> Solid {
    let middle = |axis: usize| 0.5 * (lowest[axis] + highest[axis]);
    Solid {
        pose: Placed {
            xyz: std::array::from_fn(middle),
            ..Placed::default()
        },
        kind: SolidKind::Box(std::array::from_fn(|axis| highest[axis] - lowest[axis])),
    }
}
