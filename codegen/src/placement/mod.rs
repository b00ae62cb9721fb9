//! In which frame each entry of D, P and R is evaluated.
//!
//! An entry is the product of a joint's screw with what a parameter does to its link, the same in
//! every frame between the two. In the link's own frame the screws have to come there; in the
//! joint's own the screw is z and the column has to come back; on the way there are frames in
//! which both are sparse. Which is cheapest depends on what other entries need anyhow, so it is
//! counted.

mod search;
pub(crate) mod transport;

use crate::base::BaseParameter;
use crate::derive::ParameterKind;
use crate::derive::explicit::pairing;
use crate::derive::motion::{Motions, Mover};
use crate::derive::vector::Screw;
use crate::expr::{Expr, Graph};
use crate::mechanism::Mechanism;
use search::Entry;
use transport::{Share, movers_along, shares};

/// Replaces the inertial entries of D, P and R by cheaper ones of equal value.
pub fn cheapest(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    parameters: &mut [BaseParameter],
) {
    let columns: Vec<Column> = parameters
        .iter()
        .enumerate()
        .filter_map(|(place, parameter)| match parameter.kind {
            // A scaled parameter has its own form already.
            ParameterKind::Inertial(index) if parameter.relation[0].0 == 1.0 => Some(Column {
                place,
                link: parameter.link,
                index,
            }),
            _ => None,
        })
        .collect();
    let mut frames = Frames::new(graph, mechanism, motions);
    explicit(graph, &mut frames, &columns, parameters);
    implicit(graph, &mut frames, &columns, parameters);
}

/// A column whose entries may be placed.
#[derive(Clone, Copy, Debug)]
struct Column {
    place: usize,
    link: usize,
    index: usize,
}

struct Frames<'a> {
    mechanism: &'a Mechanism,
    motions: &'a mut Motions,
    /// Per link, per frame of its path, the joints that move it.
    movers: Vec<Vec<Vec<Mover>>>,
}

impl Frames<'_> {
    fn new<'a>(
        graph: &mut Graph,
        mechanism: &'a Mechanism,
        motions: &'a mut Motions,
    ) -> Frames<'a> {
        let links = 0..mechanism.joints.len();
        let movers = links
            .map(|link| movers_along(graph, mechanism, motions, link))
            .collect();
        Frames {
            mechanism,
            motions,
            movers,
        }
    }

    /// <screw or rate of the joint, share> in every frame that the joint moves.
    fn forms(
        &mut self,
        graph: &mut Graph,
        column: Column,
        share: Share,
        of: fn(&Mover) -> &Screw,
    ) -> impl Fn(usize) -> Vec<Expr> + use<> {
        let key = (column.link, column.index);
        let shares = shares(graph, self.mechanism, self.motions, key, share);
        let mut forms: Vec<(usize, Expr)> = vec![];
        for (movers, share) in self.movers[column.link].iter().zip(&shares) {
            for mover in movers {
                forms.push((mover.joint, pairing(graph, of(mover), share)));
            }
        }
        move |joint| {
            let own = forms.iter().filter(|form| form.0 == joint);
            own.map(|form| form.1).collect()
        }
    }
}

fn explicit(
    graph: &mut Graph,
    frames: &mut Frames<'_>,
    columns: &[Column],
    parameters: &mut [BaseParameter],
) {
    let mut entries = vec![];
    for &column in columns {
        let forms = frames.forms(graph, column, Share::Wrench, |mover| &mover.screw);
        for &(row, _) in &parameters[column.place].columns.explicit {
            entries.push(Entry {
                column: (column.link, column.index),
                row,
                part: 0,
                forms: forms(row),
            });
        }
    }
    let chosen = search::choose(graph, &entries);
    let mut values = entries
        .iter()
        .zip(chosen)
        .map(|(entry, form)| entry.forms[form]);
    for column in columns {
        let parameter = &mut parameters[column.place];
        replace(
            graph,
            "d",
            parameter,
            |p| &mut p.columns.explicit,
            &mut values,
        );
    }
}

fn implicit(
    graph: &mut Graph,
    frames: &mut Frames<'_>,
    columns: &[Column],
    parameters: &mut [BaseParameter],
) {
    let mut entries = vec![];
    for &column in columns {
        let key = (column.link, column.index);
        let momenta = frames.forms(graph, column, Share::Momentum, |mover| &mover.screw);
        let kinetic = frames.forms(graph, column, Share::Momentum, |mover| &mover.rate);
        let weights = frames.forms(graph, column, Share::Weight, |mover| &mover.screw);
        let lists = &parameters[column.place].columns;
        for (part, list) in [(0, &lists.momentum), (1, &lists.rest), (2, &lists.rest)] {
            for &(row, _) in list {
                let forms = match part {
                    0 => momenta(row),
                    1 => kinetic(row),
                    _ => weights(row),
                };
                entries.push(Entry {
                    column: key,
                    row,
                    part,
                    forms,
                });
            }
        }
    }
    let chosen = search::choose(graph, &entries);
    let values: Vec<Expr> = entries
        .iter()
        .zip(chosen)
        .map(|(e, form)| e.forms[form])
        .collect();
    let mut rest = values.into_iter();
    for column in columns {
        let parameter = &mut parameters[column.place];
        let count = parameter.columns.rest.len();
        replace(
            graph,
            "p",
            parameter,
            |p| &mut p.columns.momentum,
            &mut rest,
        );
        let kinetic: Vec<Expr> = rest.by_ref().take(count).collect();
        let weights: Vec<Expr> = rest.by_ref().take(count).collect();
        let pairs = weights.into_iter().zip(kinetic);
        let sums: Vec<Expr> = pairs
            .map(|(weight, kinetic)| graph.sub(weight, kinetic))
            .collect();
        replace(
            graph,
            "r",
            parameter,
            |p| &mut p.columns.rest,
            &mut sums.into_iter(),
        );
    }
}

/// Takes over the chosen values; an entry that folds to zero in its new form is none.
fn replace(
    graph: &mut Graph,
    prefix: &str,
    parameter: &mut BaseParameter,
    list: fn(&mut BaseParameter) -> &mut Vec<(usize, Expr)>,
    values: &mut impl Iterator<Item = Expr>,
) {
    let name = parameter.relation[0].1.to_lowercase();
    let entries = list(parameter);
    for ((joint, entry), value) in entries.iter_mut().zip(values) {
        *entry = value;
        graph.name(value, &format!("{prefix}{}_{name}", *joint + 1));
    }
    entries.retain(|&(_, entry)| !graph.is_zero(entry));
}
