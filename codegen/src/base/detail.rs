//! Columns that a detail of the description alone keeps among the independent ones.
//!
//! Bars of a parallelogram that differ by a tenth of a millimetre, or gravity that leans by a hair,
//! give a robot base parameters which the exact robot does not have. They are independent, far
//! above rounding, but no measurement tells them: the rank is clear, and within it lies a second
//! drop.

use nalgebra::DMatrix;

use super::BaseParameter;
use super::rank::Split;
use crate::derive::{ParameterKind, Standard};

/// The smallest drop that a detail explains; robots of no special shape stay below half of it.
const LEAST_DROP: f64 = 1e3;

/// The base parameters that stand on a detail.
#[derive(Clone, Debug, PartialEq)]
pub struct Detail {
    /// Their places among the base parameters, ascending.
    pub parameters: Vec<usize>,
    /// How many times less of their columns is left, beside those of the others, than of any other:
    /// the precision that it takes to tell them.
    pub drop: f64,
}

/// Looks for base parameters that stand on a detail: what is left of their columns beside the
/// others is less than of the next one by a large factor, with columns as unit vectors or with
/// inertial ones in SI units, where a column that is small by itself counts, too.
pub fn find(
    samples: &DMatrix<f64>,
    split: &Split,
    standard: &[Standard],
    parameters: &[BaseParameter],
) -> Option<Detail> {
    let inertial = |column: usize| matches!(standard[column].kind, ParameterKind::Inertial(_));
    let left = split.kept.iter().copied().zip(split.apart.iter().copied());
    let bodies = left.clone().filter(|&(column, _)| inertial(column));
    let in_units = bodies.map(|(column, apart)| (column, apart * samples.column(column).norm()));
    let found: Vec<(Vec<usize>, f64)> = [left.collect(), in_units.collect()]
        .into_iter()
        .filter_map(below)
        .collect();
    let drop = found.iter().map(|(_, drop)| *drop).reduce(f64::max)?;
    let columns = found.iter().flat_map(|(columns, _)| columns);
    let names: Vec<&str> = columns.map(|&at| standard[at].name.as_str()).collect();
    let stands = |parameter: &BaseParameter| names.contains(&parameter.relation[0].1.as_str());
    let places = (0..parameters.len()).filter(|&place| stands(&parameters[place]));
    Some(Detail {
        parameters: places.collect(),
        drop,
    })
}

/// The columns below the first large drop of their values, and that drop.
fn below(mut values: Vec<(usize, f64)>) -> Option<(Vec<usize>, f64)> {
    values.sort_by(|a, b| b.1.total_cmp(&a.1));
    let drops = values.windows(2).map(|pair| pair[0].1 / pair[1].1);
    let (place, drop) = drops.enumerate().find(|&(_, drop)| drop >= LEAST_DROP)?;
    let columns = values[place + 1..].iter().map(|&(column, _)| column);
    Some((columns.collect(), drop))
}

#[cfg(test)]
mod tests {
    use crate::builder::{self, BuildError};
    use crate::robot::Robot;

    fn read(text: &str) -> Result<Robot, BuildError> {
        let text = format!("name = \"arm\"\neffects = []\n{text}");
        builder::read_texts(&[("arm.toml", &text)])
    }

    fn robot(text: &str) -> Robot {
        read(text).unwrap_or_else(|error| unreachable!("{error}"))
    }

    /// Names of the base parameters, and of those that stand on a detail; the drop to these.
    fn told(robot: &Robot) -> (Vec<&str>, Vec<&str>, f64) {
        let name = |place: usize| robot.base.parameters[place].name.as_str();
        let all = (0..robot.base.parameters.len()).map(name).collect();
        match &robot.base.detail {
            None => (all, vec![], 1.0),
            Some(detail) => {
                let these = detail.parameters.iter().map(|&place| name(place));
                (all, these.collect(), detail.drop)
            }
        }
    }

    /// A crank of 0.2 m and a rocker, 0.5 m apart, with a coupler of `coupler` between them.
    fn four_bar(coupler: f64, flipped: bool) -> Result<Robot, BuildError> {
        read(&format!(
            "gravity = [0, -9.81, 0]\n\
             [[joint]]\nname = \"crank\"\nkind = \"revolute\"\nlimits = [0.3, 2.8]\n\
             [[joint]]\nname = \"coupler\"\nkind = \"revolute\"\nd = 0.2\npassive = true\n\
             [[joint]]\nname = \"rocker\"\nkind = \"revolute\"\nant = 0\nd = 0.5\npassive = true\n\
             [[loop]]\nname = \"loop\"\ncut = {{ ant = 2, d = {coupler} }}\n\
             meets = {{ ant = 3, d = 0.2 }}\nflipped = {flipped}\n"
        ))
    }

    /// Bars that turn as one have one second moment and two first ones; a coupler that does not
    /// turn is a mass at the end of the crank.
    #[test]
    fn parallelogram_but_for_a_hair_stands_on_it() {
        let exact = four_bar(0.5, false).unwrap_or_else(|error| unreachable!("{error}"));
        let (exact, detail, _) = told(&exact);
        assert_eq!((exact.len(), detail.len()), (3, 0), "{exact:?}");
        let nearly = four_bar(0.5 + 1e-4, true).unwrap_or_else(|error| unreachable!("{error}"));
        let (all, detail, drop) = told(&nearly);
        // The bars of the exact one are told as ever.
        assert!(all.starts_with(&["ZZR1", "MXR1", "MY1"]), "{all:?}");
        assert!(!detail.is_empty() && (1e3..1e5).contains(&drop));
        assert!(!detail.iter().any(|name| name.ends_with('1')), "{detail:?}");
        // Bars that nobody takes for a parallelogram's.
        let longer = four_bar(0.6, true).unwrap_or_else(|error| unreachable!("{error}"));
        let (all, detail, _) = told(&longer);
        assert!(all.len() > 3 && detail.is_empty(), "{detail:?} of {all:?}");
    }

    /// Effects of the square of a hair are rounding: nobody can say which columns there are.
    #[test]
    fn parallelogram_but_for_less_than_a_hair_is_an_error_that_says_what_to_look_for() {
        let Err(error) = four_bar(0.5 + 1e-5, true) else {
            unreachable!("a clear rank");
        };
        let error = error.to_string();
        assert!(error.contains("nearly dependent: MX2"), "{error}");
        assert!(
            error.contains("loops that are almost parallelograms"),
            "{error}"
        );
    }

    /// Without gravity the first moments of the second link matter by the offset of its axis alone.
    #[test]
    fn offset_of_a_micrometre_is_all_that_first_moments_stand_on() {
        let arm = |offset: f64| {
            robot(&format!(
                "gravity = [0, 0, 0]\n[[joint]]\nname = \"a\"\nkind = \"revolute\"\n\
                 [[joint]]\nname = \"b\"\nkind = \"revolute\"\nd = {offset}\n"
            ))
        };
        let (coaxial, near, far) = (arm(0.0), arm(1e-6), arm(0.3));
        assert_eq!(told(&coaxial).0, ["ZZ1", "ZZ2"]);
        let (all, detail, drop) = told(&near);
        assert_eq!((all.len(), detail), (4, vec!["MX2", "MY2"]));
        assert!((1e5..1e7).contains(&drop), "{drop:e}");
        assert!(told(&far).1.is_empty());
    }

    /// On a vertical axis gravity does nothing: the first moments of its link appear as it leans.
    #[test]
    fn gravity_that_leans_by_a_hair_is_told_by_the_first_moments_of_the_first_link() {
        let leaning = |angle: f64| {
            robot(&format!(
                "gravity = [{}, 0, {}]\n\
                 [[joint]]\nname = \"turret\"\nkind = \"revolute\"\n\
                 [[joint]]\nname = \"arm\"\nkind = \"revolute\"\nalpha = \"pi/2\"\n\
                 [[joint]]\nname = \"forearm\"\nkind = \"revolute\"\nd = 0.4\n",
                9.81 * angle.sin(),
                -9.81 * angle.cos()
            ))
        };
        let (upright, level, leaning) = (leaning(0.0), leaning(0.3), leaning(1e-5));
        let (upright, detail, _) = told(&upright);
        assert!(detail.is_empty(), "{detail:?}");
        let (all, detail, drop) = told(&leaning);
        assert_eq!(all.len(), upright.len() + 2);
        let symbols: Vec<&str> = detail.iter().map(|name| &name[..2]).collect();
        assert_eq!(symbols, ["MX", "MY"], "{detail:?}");
        assert!(detail.iter().all(|name| name.ends_with('1')), "{detail:?}");
        assert!((1e3..1e6).contains(&drop), "{drop:e}");
        let (all, detail, _) = told(&level);
        assert_eq!((all.len(), detail.len()), (upright.len() + 2, 0));
    }

    #[test]
    fn axes_that_are_parallel_but_for_a_hair_are_parallel_and_nothing_stands_on_it() {
        for alpha in ["0", "1e-5"] {
            let arm = robot(&format!(
                "[[joint]]\nname = \"a\"\nkind = \"revolute\"\n\
                 [[joint]]\nname = \"b\"\nkind = \"revolute\"\nd = 0.3\nalpha = \"{alpha}\"\n"
            ));
            let (all, detail, _) = told(&arm);
            assert_eq!(all, ["ZZR1", "ZZ2", "MX2", "MY2"]);
            assert!(detail.is_empty(), "{detail:?}");
        }
    }
}
