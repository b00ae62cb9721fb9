//! The regrouping relations as text, with the lengths by name where a coefficient follows from
//! them: `ZZ1 + IA1 + L^2*M2`.

use nalgebra::DMatrix;

use super::lengths::{self, Length};
use super::rank::Split;
use super::symbolic::{Products, ROBOTS};
use super::{BaseParameter, names, regroup, sample};
use crate::derive;
use crate::describe::{Description, ScaledParameter};
use crate::expr::Graph;
use crate::mechanism::Mechanism;

/// Writes the relation of every parameter; coefficients that no lengths explain stay numbers.
pub fn write(
    parameters: &mut [BaseParameter],
    mechanism: &Mechanism,
    description: &Description,
    split: &Split,
    standard: &[String],
) {
    let laws = Laws::new(mechanism, description, split, standard);
    for parameter in parameters {
        let mut scaled = description.scaled.iter();
        let scaled = scaled.rfind(|wish| wish.name == parameter.name);
        parameter.text = laws.text(parameter, scaled);
    }
}

/// What is known of the coefficients on robots of other lengths.
struct Laws<'a> {
    split: &'a Split,
    standard: &'a [String],
    lengths: Vec<String>,
    products: Products,
    /// Of the robots with other lengths; none where there are no lengths.
    others: Vec<DMatrix<f64>>,
}

impl Laws<'_> {
    fn new<'a>(
        mechanism: &Mechanism,
        description: &Description,
        split: &'a Split,
        standard: &'a [String],
    ) -> Laws<'a> {
        let lengths = lengths::of(mechanism, description);
        let samples: [Vec<f64>; ROBOTS] = std::array::from_fn(|robot| match robot {
            0 => lengths.iter().map(|length| length.value).collect(),
            other => other_values(&lengths, other - 1),
        });
        let others = samples[1..].iter().filter(|_| !lengths.is_empty());
        let others = others
            .map(|values| coefficients(&lengths::changed(mechanism, &lengths, values), split))
            .collect();
        Laws {
            split,
            standard,
            products: Products::new(&samples),
            lengths: lengths.into_iter().map(|length| length.name).collect(),
            others,
        }
    }

    fn text(&self, parameter: &BaseParameter, scaled: Option<&ScaledParameter>) -> String {
        // A scale that is itself a length is written in front of every term.
        let scale = scaled.filter(|wish| is_name(&wish.factor.text));
        let divisor = scale.map_or(1.0, |wish| wish.factor.value);
        let own = &parameter.relation[0].1;
        let terms = parameter.relation.iter().map(|(number, name)| {
            let law = match scaled.is_some() && scale.is_none() {
                true => None,
                false => self.law(number / divisor, own, name),
            };
            let (negative, text) = law.unwrap_or_else(|| names::number(number / divisor));
            let prefix = scale.map_or("", |wish| wish.factor.text.trim());
            let factors: Vec<&str> = [prefix, &text]
                .into_iter()
                .filter(|x| !x.is_empty())
                .collect();
            (negative, factors.join("*"), name.as_str())
        });
        names::relation(&terms.collect::<Vec<_>>())
    }

    /// The coefficient of `name` in the parameter that stands for `own`, in lengths.
    fn law(&self, number: f64, own: &str, name: &str) -> Option<(bool, String)> {
        if own == name {
            return Some((number < 0.0, String::new())).filter(|_| number.abs() == 1.0);
        }
        let place = self.place(&self.split.kept, own)?;
        let other = self.place(&self.split.dependent, name)?;
        let values: [f64; ROBOTS] = std::array::from_fn(|robot| match robot {
            0 => number,
            robot => self
                .others
                .get(robot - 1)
                .map_or(number, |c| c[(place, other)]),
        });
        Some(self.products.polynomial(&values)?.text(&self.lengths))
    }

    fn place(&self, columns: &[usize], name: &str) -> Option<usize> {
        columns
            .iter()
            .position(|&column| self.standard[column] == name)
    }
}

/// Regrouping coefficients of a mechanism with the given choice of columns.
fn coefficients(mechanism: &Mechanism, split: &Split) -> DMatrix<f64> {
    let mut graph = Graph::new();
    let standard = derive::standard(&mut graph, mechanism).parameters;
    let samples = sample::explicit(&graph, mechanism, &standard);
    regroup::coefficients(&samples, split)
}

/// Lengths without simple ratios, between 0.25 and 1.25 m; multiples of the golden ratio spread
/// them evenly.
fn other_values(lengths: &[Length], robot: usize) -> Vec<f64> {
    let golden = 0.618_033_988_749_894_9;
    let count = lengths.len();
    let value = |index: usize| 0.25 + (golden * (robot * count + index + 1) as f64).fract();
    (0..count).map(value).collect()
}

fn is_name(text: &str) -> bool {
    let text = text.trim();
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(plain) && text != "pi"
}
