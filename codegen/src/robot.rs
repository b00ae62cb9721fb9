//! A robot from its description to everything that readers of the graph need.

use crate::base::{self, BaseError, BaseParameter, BaseParameters};
use crate::derive::motion::Motions;
use crate::derive::{self, ParameterKind};
use crate::describe::Description;
use crate::expr::{Expr, Graph, Operations};
use crate::functions::{self, Function, Group};
use crate::mechanism::Mechanism;
use crate::{placement, rewrite};

/// One non-zero entry of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Row (joint), counted from 0; 0 for h and dh.
    pub row: usize,
    /// Column (parameter), counted from 0.
    pub column: usize,
    /// The value.
    pub value: Expr,
}

/// The five outputs of an identification model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    /// D.
    Explicit,
    /// P.
    Momentum,
    /// R.
    Rest,
    /// h.
    Energy,
    /// dh of the columns without an energy.
    Power,
}

impl Output {
    /// All outputs, in a fixed order.
    pub const ALL: [Output; 5] = [
        Output::Explicit,
        Output::Momentum,
        Output::Rest,
        Output::Energy,
        Output::Power,
    ];

    /// Whether it has a row for each joint; else it is one row.
    pub fn is_matrix(self) -> bool {
        !matches!(self, Output::Energy | Output::Power)
    }
}

/// Operation counts for the inertial base columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// D.
    pub explicit: Operations,
    /// P and R together, shared nodes once.
    pub implicit: Operations,
    /// h.
    pub energy: Operations,
}

/// Description, mechanism, graph and base parameters of one robot.
#[derive(Clone, Debug)]
pub struct Robot {
    /// What it was made from.
    pub description: Description,
    /// The canonical robot.
    pub mechanism: Mechanism,
    /// The expressions of all outputs.
    pub graph: Graph,
    /// Number of nodes after each link's share of the graph.
    pub ends: Vec<usize>,
    /// The base parameters and their columns.
    pub base: BaseParameters,
    /// Functions beside the identification models; none unless asked for.
    pub functions: Vec<Function>,
    /// Number of nodes of the identification models; those of the functions come after them.
    pub models_end: usize,
    motions: Motions,
}

impl Robot {
    /// Derives the models of a described robot.
    ///
    /// # Errors
    /// [`BaseError`] when the base parameters are not clear.
    pub fn new(description: Description) -> Result<Robot, BaseError> {
        let mechanism = Mechanism::new(&description);
        Robot::of(description, mechanism)
    }

    /// The same of a mechanism that is another than the described one.
    ///
    /// # Errors
    /// As [`Robot::new`].
    pub fn of(description: Description, mechanism: Mechanism) -> Result<Robot, BaseError> {
        let mut graph = Graph::new();
        let standard = derive::standard(&mut graph, &mechanism);
        let (ends, mut motions) = (standard.ends, standard.motions);
        let standard = standard.parameters;
        let mut base = base::parameters(&mut graph, &mechanism, standard, &description)?;
        placement::cheapest(&mut graph, &mechanism, &mut motions, &mut base.parameters);
        rewrite::fewer(&mut graph, &mut base.parameters);
        Ok(Robot {
            description,
            mechanism,
            models_end: graph.nodes().len(),
            graph,
            ends,
            base,
            functions: vec![],
            motions,
        })
    }

    /// The same with functions beside the identification models, whose text stays as it is.
    #[must_use]
    pub fn with(mut self, groups: &[Group]) -> Robot {
        self.functions = functions::derive(
            &mut self.graph,
            &self.mechanism,
            &mut self.motions,
            &self.base,
            groups,
        );
        self
    }

    /// The non-zero entries of an output, by row, then by column.
    pub fn entries(&self, output: Output) -> Vec<Entry> {
        self.entries_of(output, |_| true)
    }

    fn entries_of(&self, output: Output, wanted: impl Fn(&BaseParameter) -> bool) -> Vec<Entry> {
        let mut entries = Vec::new();
        for (column, parameter) in self.base.parameters.iter().enumerate() {
            if !wanted(parameter) {
                continue;
            }
            let columns = &parameter.columns;
            let rows = match output {
                Output::Explicit => columns.explicit.clone(),
                Output::Momentum => columns.momentum.clone(),
                Output::Rest => columns.rest.clone(),
                Output::Energy => columns.energy.map(|h| (0, h)).into_iter().collect(),
                Output::Power => columns.power.map(|dh| (0, dh)).into_iter().collect(),
            };
            entries.extend(
                rows.into_iter()
                    .map(|(row, value)| Entry { row, column, value }),
            );
        }
        entries.sort_by_key(|entry| (entry.row, entry.column));
        entries
    }

    /// Operations of the inertial base columns.
    pub fn counts(&self) -> Counts {
        let count = |outputs: &[Output]| {
            let inertial =
                |parameter: &BaseParameter| matches!(parameter.kind, ParameterKind::Inertial(_));
            let values: Vec<Expr> = outputs
                .iter()
                .flat_map(|&output| self.entries_of(output, inertial))
                .map(|entry| entry.value)
                .collect();
            Operations::of(&self.graph, &values)
        };
        Counts {
            explicit: count(&[Output::Explicit]),
            implicit: count(&[Output::Momentum, Output::Rest]),
            energy: count(&[Output::Energy]),
        }
    }
}
