//! The problem in other link frames: a plane of symmetry is one through the axes of a frame, and
//! the description may state it in another than the identified one.

use idim_codegen::mechanism::{Pose, Standard};
use idim_runtime::physical::{Bodies, Extent, Mirror, Prior, Problem, Pseudo};
use nalgebra::Vector3;

/// Frames to solve in, each in the identified frame of its link; `None` for that itself.
pub(super) struct Turned(Vec<Option<Pose>>);

impl Turned {
    /// The frames of planes `(link, normal, frame)` among `links`, and the planes in them.
    pub fn of(links: usize, planes: &[(usize, usize, Pose)]) -> (Turned, Vec<Mirror>) {
        let mut frames = vec![None; links];
        for (link, _, frame) in planes {
            frames[*link] = Some(*frame).filter(|frame| *frame != Pose::identity());
        }
        let mirror = |(link, normal, _): &(usize, usize, Pose)| Mirror {
            link: *link,
            normal: *normal,
        };
        (Turned(frames), planes.iter().map(mirror).collect())
    }

    /// The problem in these frames; masses are the same in all.
    pub fn problem(&self, mut problem: Problem) -> Problem {
        for row in &mut problem.map {
            *row = self.row(row);
        }
        for (link, frame) in self.frames() {
            problem.links[link] = into(&problem.links[link], frame);
            let bounds = problem.bounds.iter_mut();
            for bound in bounds.filter(|bound| bound.link == link) {
                bound.extent = seen(&bound.extent, frame);
            }
        }
        problem
    }

    /// The bodies in the identified frames.
    pub fn back(&self, mut bodies: Bodies) -> Bodies {
        for (link, frame) in self.frames() {
            let body = Standard::from_values(bodies.links[link]);
            bodies.links[link] = body.moved(frame).values();
        }
        bodies
    }

    fn frames(&self) -> impl Iterator<Item = (usize, &Pose)> {
        let frames = self.0.iter().enumerate();
        frames.filter_map(|(link, frame)| Some((link, frame.as_ref()?)))
    }

    /// Factors of identified standard parameters as factors of those in the frames.
    fn row(&self, row: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let mut turned: Vec<(usize, f64)> = Vec::with_capacity(row.len());
        for (place, factor) in row {
            let Some(frame) = self.0.get(place / 10).copied().flatten() else {
                turned.push((*place, *factor));
                continue;
            };
            for own in 0..10 {
                let mut unit = [0.0; 10];
                unit[own] = 1.0;
                let share = Standard::from_values(unit).moved(&frame).values()[place % 10];
                if share != 0.0 {
                    turned.push((place - place % 10 + own, factor * share));
                }
            }
        }
        turned
    }
}

fn into(prior: &Prior, frame: &Pose) -> Prior {
    let body = Standard::from_values(prior.pseudo.values());
    Prior {
        pseudo: Pseudo::of(&body.moved(&frame.inverse()).values()),
        ..*prior
    }
}

fn seen(extent: &Extent, frame: &Pose) -> Extent {
    let back = frame.inverse();
    let turn = |axis: [f64; 3]| (back.rotation * Vector3::from(axis)).into();
    let center = back.translation + back.rotation * Vector3::from(extent.center);
    Extent {
        center: center.into(),
        axes: extent.axes.map(turn),
        ..*extent
    }
}
