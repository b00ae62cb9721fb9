//! Coefficients of the regrouping relations as polynomials in the lengths of the robot.
//!
//! A number says nothing of where it comes from: 0.25 may be L^2, L/2 or a coincidence. So each
//! coefficient is taken on several robots that differ in their lengths alone, and a polynomial is
//! believed if it gives the coefficient of every one of them.

/// Lengths of the robot and of those that differ from it, one list per robot.
pub type Samples<'a> = &'a [Vec<f64>];

/// Relative agreement of a polynomial with coefficients that least squares found.
const TOLERANCE: f64 = 1e-11;

/// Factors of the terms of a sum, each with both signs. A term alone may have any half up to 4.
const FACTORS: [f64; 3] = [1.0, 2.0, 0.5];

/// Products in a sum; more lengths than this have too many products to look for three at once.
const MANY: usize = 40;

/// A product of lengths, by index, with a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    factor: f64,
    lengths: Vec<usize>,
}

/// A sum of terms of one degree; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial(Vec<Term>);

/// Products of lengths with their values on every robot, by degree from 0 to 3.
#[derive(Clone, Debug)]
pub struct Products(Vec<Vec<Product>>);

#[derive(Clone, Debug)]
struct Product {
    lengths: Vec<usize>,
    values: Vec<f64>,
}

impl Products {
    /// All products of up to three of the lengths.
    pub fn new(samples: Samples<'_>) -> Products {
        let one = Product {
            lengths: vec![],
            values: vec![1.0; samples.len()],
        };
        let mut degrees = vec![vec![one]];
        let count = samples.first().map_or(0, Vec::len);
        for degree in 0..3 {
            let mut next = Vec::new();
            for product in &degrees[degree] {
                let first = product.lengths.last().copied().unwrap_or(0);
                next.extend((first..count).map(|length| product.times(length, samples)));
            }
            degrees.push(next);
        }
        Products(degrees)
    }

    /// The simplest polynomial with the given values on every robot: one product before a sum of
    /// two before a sum of three, low degrees first.
    pub fn polynomial(&self, values: &[f64]) -> Option<Polynomial> {
        let degrees = || self.0.iter().map(Vec::as_slice);
        let alone = degrees().find_map(|products| sum(products, values, 1));
        let sums = |count: usize| degrees().skip(1).find_map(move |p| sum(p, values, count));
        alone
            .or_else(|| sums(2))
            .or_else(|| sums(3))
            .map(Polynomial)
    }
}

impl Product {
    fn times(&self, length: usize, samples: Samples<'_>) -> Product {
        let mut lengths = self.lengths.clone();
        lengths.push(length);
        let values = self.values.iter().zip(samples);
        let values = values.map(|(value, sample)| value * sample[length]);
        Product {
            lengths,
            values: values.collect(),
        }
    }

    fn term(&self, factor: f64) -> Term {
        let lengths = self.lengths.clone();
        Term { factor, lengths }
    }

    /// The factor that makes the product the given values: a half of a small integer.
    fn factor(&self, values: &[f64]) -> Option<f64> {
        let factor = (2.0 * values[0] / self.values[0]).round() / 2.0;
        let small = factor != 0.0 && factor.abs() <= 4.0;
        let mut pairs = values.iter().zip(&self.values);
        let near = |(value, product): (&f64, &f64)| {
            (value - factor * product).abs() <= TOLERANCE * value.abs().max(1.0)
        };
        (small && pairs.all(near)).then_some(factor)
    }
}

/// `count` of the products with factors that add up to the values.
fn sum(products: &[Product], values: &[f64], count: usize) -> Option<Vec<Term>> {
    if count == 1 {
        let alone = |product: &Product| Some(vec![product.term(product.factor(values)?)]);
        return products.iter().find_map(alone);
    }
    if count > 2 && products.len() > MANY {
        return None;
    }
    products.iter().enumerate().find_map(|(index, product)| {
        let signed = FACTORS.iter().flat_map(|&factor| [factor, -factor]);
        signed.into_iter().find_map(|factor| {
            let pairs = values.iter().zip(&product.values);
            let rest: Vec<f64> = pairs.map(|(value, x)| value - factor * x).collect();
            let others = sum(&products[index + 1..], &rest, count - 1)?;
            let mut terms = vec![product.term(factor)];
            terms.extend(others);
            Some(terms)
        })
    })
}

impl Polynomial {
    /// Whether it reads best with a minus sign before it, and its text without that sign: empty
    /// for 1, `d3^2`, `2*d3*r4`, `(d3^2 + d4^2)`.
    pub fn text(&self, names: &[String]) -> (bool, String) {
        let negative = self.0[0].factor < 0.0;
        let mut text = String::new();
        for (index, term) in self.0.iter().enumerate() {
            let minus = (term.factor < 0.0) != negative;
            text.push_str(match (index, minus) {
                (0, _) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            });
            text.push_str(&term.text(names));
        }
        match self.0.len() {
            1 => (negative, text),
            _ => (negative, format!("({text})")),
        }
    }
}

impl Term {
    /// Without its sign.
    fn text(&self, names: &[String]) -> String {
        let mut factors = Vec::new();
        if self.factor.abs() != 1.0 {
            factors.push(self.factor.abs().to_string());
        }
        for run in self.lengths.chunk_by(|a, b| a == b) {
            let name = &names[run[0]];
            factors.push(match run.len() {
                1 => name.clone(),
                power => format!("{name}^{power}"),
            });
        }
        factors.join("*")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples() -> Vec<Vec<f64>> {
        vec![vec![0.5, 0.25], vec![0.7, 0.4], vec![1.1, 0.3]]
    }

    fn text(of: impl Fn(f64, f64) -> f64) -> Option<(bool, String)> {
        let samples = samples();
        let values: Vec<f64> = samples.iter().map(|l| of(l[0], l[1])).collect();
        let names = ["d3".to_owned(), "r4".to_owned()];
        let found = Products::new(&samples).polynomial(&values)?;
        Some(found.text(&names))
    }

    #[test]
    fn coefficients_are_read_as_products_and_sums_of_lengths() {
        let plus = |text: &str| Some((false, text.to_owned()));
        assert_eq!(text(|_, _| 1.0), plus(""));
        assert_eq!(text(|d, _| d * d), plus("d3^2"));
        assert_eq!(text(|d, r| 2.0 * d * r), plus("2*d3*r4"));
        assert_eq!(text(|d, r| d * d + r * r), plus("(d3^2 + r4^2)"));
        assert_eq!(text(|_, r| -r), Some((true, "r4".to_owned())));
        let square = |d: f64, r: f64| (d - r) * (d - r);
        assert_eq!(text(square), plus("(d3^2 - 2*d3*r4 + r4^2)"));
    }

    #[test]
    fn number_that_equals_a_length_on_one_robot_alone_is_none() {
        // d3^2 and r4 are 0.25 on the first robot; the coefficient is a quarter on all.
        assert_eq!(text(|_, _| 0.25), None);
        assert_eq!(text(|d, _| d.sin()), None);
    }
}
