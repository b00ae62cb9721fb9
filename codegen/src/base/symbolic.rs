//! Coefficients of the regrouping relations as polynomials in the lengths of the robot.
//!
//! A number says nothing of where it comes from: 0.25 may be L^2, L/2 or a coincidence. So each
//! coefficient is taken on several robots that differ in their lengths alone, and a polynomial is
//! believed if it gives the coefficient of every one of them.

/// The robot, and those that differ from it in their lengths, without whose agreement a
/// polynomial is not believed.
pub const ROBOTS: usize = 3;

/// Lengths of every robot, one list per robot.
pub type Samples<'a> = &'a [Vec<f64>; ROBOTS];

/// A value on every robot.
type Values = [f64; ROBOTS];

/// Relative agreement of a polynomial with coefficients that least squares found.
const TOLERANCE: f64 = 1e-11;

/// Factors of the terms of a sum but its last.
const FACTORS: [f64; 6] = [1.0, -1.0, 2.0, -2.0, 0.5, -0.5];

/// The last term, or one alone, may have any half up to this.
const LARGEST: i32 = 4;

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
pub struct Products(Vec<Degree>);

/// The products of one degree, in the order in which they are preferred.
#[derive(Clone, Debug)]
struct Degree {
    products: Vec<Product>,
    /// Every product with every factor that a last term may have, by its value on the last robot,
    /// whose lengths have no simple ratios.
    multiples: Vec<Multiple>,
}

#[derive(Clone, Debug)]
struct Product {
    lengths: Vec<usize>,
    values: Values,
}

#[derive(Clone, Copy, Debug)]
struct Multiple {
    value: f64,
    product: usize,
    factor: f64,
}

impl Products {
    /// All products of up to three of the lengths.
    pub fn new(samples: Samples<'_>) -> Products {
        let one = Product {
            lengths: vec![],
            values: [1.0; ROBOTS],
        };
        let mut degrees = vec![vec![one]];
        let count = samples[0].len();
        for degree in 0..3 {
            let mut next = Vec::new();
            for product in &degrees[degree] {
                let first = product.lengths.last().copied().unwrap_or(0);
                next.extend((first..count).map(|length| product.times(length, samples)));
            }
            degrees.push(next);
        }
        Products(degrees.into_iter().map(Degree::new).collect())
    }

    /// The simplest polynomial with the given values on every robot: one product before a sum of
    /// two before a sum of three, low degrees first.
    pub fn polynomial(&self, values: &[f64; ROBOTS]) -> Option<Polynomial> {
        let alone = self.0.iter().find_map(|degree| degree.sum(0, *values, 1));
        let sums = |count: usize| {
            let mut degrees = self.0.iter().skip(1);
            degrees.find_map(|degree| degree.sum(0, *values, count))
        };
        alone
            .or_else(|| sums(2))
            .or_else(|| sums(3))
            .map(Polynomial)
    }
}

impl Degree {
    fn new(products: Vec<Product>) -> Degree {
        let halves = (-2 * LARGEST..=2 * LARGEST).filter(|&halves| halves != 0);
        let factors: Vec<f64> = halves.map(|halves| f64::from(halves) / 2.0).collect();
        let multiples = products.iter().enumerate().flat_map(|(index, product)| {
            factors.iter().map(move |&factor| Multiple {
                value: factor * product.values[ROBOTS - 1],
                product: index,
                factor,
            })
        });
        let mut multiples: Vec<Multiple> = multiples.collect();
        multiples.sort_by(|a, b| a.value.total_cmp(&b.value));
        Degree {
            products,
            multiples,
        }
    }

    /// `count` of the products from `first` on, with factors, that add up to the values.
    fn sum(&self, first: usize, values: Values, count: usize) -> Option<Vec<Term>> {
        if count == 1 {
            return Some(vec![self.alone(first, values)?]);
        }
        if count > 2 && self.products.len() > MANY {
            return None;
        }
        let products = self.products.iter().enumerate().skip(first);
        products.into_iter().find_map(|(index, product)| {
            FACTORS.iter().find_map(|&factor| {
                let rest = std::array::from_fn(|k| values[k] - factor * product.values[k]);
                let mut terms = self.sum(index + 1, rest, count - 1)?;
                terms.insert(0, product.term(factor));
                Some(terms)
            })
        })
    }

    /// The first of the products from `first` on that is the values, with its factor.
    fn alone(&self, first: usize, values: Values) -> Option<Term> {
        let (value, reach) = (values[ROBOTS - 1], reach(values[ROBOTS - 1]));
        let start = self
            .multiples
            .partition_point(|one| one.value < value - reach);
        let near = self.multiples[start..].iter();
        near.take_while(|one| one.value <= value + reach)
            .filter(|one| one.product >= first)
            .filter(|one| self.products[one.product].is(values, one.factor))
            .min_by_key(|one| one.product)
            .map(|one| self.products[one.product].term(one.factor))
    }
}

/// How far a polynomial may be from a coefficient.
fn reach(value: f64) -> f64 {
    TOLERANCE * value.abs().max(1.0)
}

impl Product {
    fn times(&self, length: usize, samples: Samples<'_>) -> Product {
        let mut lengths = self.lengths.clone();
        lengths.push(length);
        Product {
            lengths,
            values: std::array::from_fn(|robot| self.values[robot] * samples[robot][length]),
        }
    }

    fn term(&self, factor: f64) -> Term {
        let lengths = self.lengths.clone();
        Term { factor, lengths }
    }

    /// Whether the product times the factor is the values, on every robot.
    fn is(&self, values: Values, factor: f64) -> bool {
        let pairs = values.iter().zip(self.values);
        pairs
            .into_iter()
            .all(|(&value, product)| (value - factor * product).abs() <= reach(value))
    }
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

    fn samples() -> [Vec<f64>; ROBOTS] {
        [vec![0.5, 0.25], vec![0.7, 0.4], vec![1.1, 0.3]]
    }

    fn text(of: impl Fn(f64, f64) -> f64) -> Option<(bool, String)> {
        let samples = samples();
        let values = samples.each_ref().map(|l| of(l[0], l[1]));
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
