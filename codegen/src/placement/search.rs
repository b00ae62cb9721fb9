//! The choice of one form for every entry so that together they need the fewest operations.

use crate::expr::needs::Needs;
use crate::expr::{Expr, Graph};

/// An entry that may be computed in several ways.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Link and parameter that it belongs to.
    pub column: (usize, usize),
    /// Joint.
    pub row: usize,
    /// Which of the outputs of the function, and which part of it.
    pub part: usize,
    /// One form per frame of the link's path, the link's own first; at least one.
    pub forms: Vec<Expr>,
}

/// Most rounds over all moves; the second finds little and the third next to nothing.
const ROUNDS: usize = 4;

/// The form of every entry. From the link's own frame on, whatever saves operations is done:
/// for a whole link, a column, a row of a link, one entry, in this order.
pub fn choose(graph: &Graph, entries: &[Entry]) -> Vec<usize> {
    let mut search = Search::new(graph, entries);
    let moves = moves(entries);
    for _ in 0..ROUNDS {
        let before = search.needs.cost;
        for (group, form) in &moves {
            search.attempt(group, *form, Reach::There);
            search.attempt(group, *form, Reach::Last);
        }
        if search.needs.cost == before {
            break;
        }
    }
    search.chosen
}

/// Groups of entries, each with the form that they may take together.
fn moves(entries: &[Entry]) -> Vec<(Vec<usize>, usize)> {
    let mut moves: Vec<(Vec<usize>, usize)> = vec![];
    let keys: [fn(&Entry) -> [usize; 4]; 6] = [
        |e| [e.column.0, 0, 0, 0],
        |e| [e.column.0, 0, 0, 1 + e.part],
        |e| [e.column.0, 1 + e.column.1, 0, 0],
        |e| [e.column.0, 1 + e.column.1, 0, 1 + e.part],
        |e| [e.column.0, 0, 1 + e.row, 0],
        |e| [e.column.0, 1 + e.column.1, 1 + e.row, 1 + e.part],
    ];
    for key in keys {
        let mut groups: Vec<([usize; 4], Vec<usize>)> = vec![];
        for (index, entry) in entries.iter().enumerate() {
            match groups.iter_mut().find(|group| group.0 == key(entry)) {
                Some(group) => group.1.push(index),
                None => groups.push((key(entry), vec![index])),
            }
        }
        for (_, group) in groups.into_iter().rev() {
            let forms = group.iter().map(|&index| entries[index].forms.len());
            let forms = forms.max().unwrap_or(0);
            moves.extend((0..forms).map(|form| (group.clone(), form)));
        }
    }
    moves
}

/// What a move does with the entries of a group whose joint does not move the frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// They stay.
    There,
    /// They take the last form they have, in the joint's own frame.
    Last,
}

/// Operations that the chosen forms need, each shared node once.
struct Search<'a> {
    graph: &'a Graph,
    entries: &'a [Entry],
    chosen: Vec<usize>,
    needs: Needs,
}

impl<'a> Search<'a> {
    fn new(graph: &'a Graph, entries: &'a [Entry]) -> Search<'a> {
        let mut search = Search {
            graph,
            entries,
            chosen: vec![0; entries.len()],
            needs: Needs::none(graph.nodes().len()),
        };
        for entry in entries {
            search.needs.need(graph.nodes(), entry.forms[0].node());
        }
        search
    }

    /// Gives the group a form where it has it; undone unless that saves operations.
    fn attempt(&mut self, group: &[usize], form: usize, reach: Reach) {
        let before = self.needs.cost;
        let mut changed = vec![];
        for &index in group {
            let (entry, old) = (&self.entries[index], self.chosen[index]);
            let last = entry.forms.len() - 1;
            let form = if reach == Reach::Last {
                form.min(last)
            } else {
                form
            };
            if form <= last && form != old {
                changed.push((index, old));
                self.give(index, form);
            }
        }
        if self.needs.cost >= before {
            for (index, old) in changed {
                self.give(index, old);
            }
        }
    }

    fn give(&mut self, index: usize, form: usize) {
        let (forms, nodes) = (&self.entries[index].forms, self.graph.nodes());
        self.needs.need(nodes, forms[form].node());
        self.needs.release(nodes, forms[self.chosen[index]].node());
        self.chosen[index] = form;
    }
}
