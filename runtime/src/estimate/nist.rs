//! The 11 linear sets of NIST's Statistical Reference Datasets: correct digits of the plain
//! factorisation, of refinement, and of refinement with powers in 32 digits.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::least_squares::solve;
use super::refine::certain;
use super::{Double, Entries, Refined, Triangle, refine, refined};
use crate::observe::Equations;

/// A set with its columns and measurements in 32 digits.
pub(super) struct Set {
    pub columns: Vec<Vec<Double>>,
    pub y: Vec<Double>,
    /// Parameters and their standard deviations.
    pub beta: Vec<f64>,
    pub sigma: Vec<f64>,
}

impl Entries for Set {
    fn rows(&self) -> usize {
        self.y.len()
    }

    fn columns(&self) -> usize {
        self.columns.len()
    }

    fn column(&self, k: usize, out: &mut [Double]) {
        out.copy_from_slice(&self.columns[k]);
    }

    fn measurements(&self, out: &mut [Double]) {
        out.copy_from_slice(&self.y);
    }

    fn roundoff(&self) -> f64 {
        2f64.powi(-100)
    }
}

impl Set {
    /// The set in f64.
    pub fn equations(&self) -> Equations {
        let rounded = |values: &[Double]| values.iter().map(|x| x.rounded()).collect::<Vec<_>>();
        Equations {
            columns: (0..self.columns.len()).collect(),
            rows: self.y.len(),
            w: self.columns.iter().flat_map(|c| rounded(c)).collect(),
            y: Some(rounded(&self.y)),
        }
    }

    /// Plain solution and standard deviations, and the digits that are said to be certain.
    pub fn plain(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let triangles = Triangle::of_all(&[self.equations()]).unwrap();
        let found = solve(&triangles, &[1.0], self.columns.len()).unwrap();
        assert_eq!(found.rank, self.columns.len());
        let sigma = found.sigma.iter().map(|sigma| sigma.unwrap()).collect();
        let each = found.numerical_error.iter().zip(&found.solution);
        let digits = each.map(|(error, x)| certain(*error, x.abs()));
        (found.solution.clone(), sigma, digits.fold(16.0, f64::min))
    }

    pub fn refined(&self) -> Refined {
        refined(&[self.equations()], &[1.0], self.columns.len()).unwrap()
    }
}

/// Fewest correct digits over several numbers: log relative error, absolute where the truth is 0.
pub(super) fn correct_digits(own: &[f64], truth: &[f64]) -> f64 {
    let digits = |(own, truth): (&f64, &f64)| {
        let scale = if *truth == 0.0 { 1.0 } else { truth.abs() };
        -((own - truth).abs() / scale).log10()
    };
    own.iter().zip(truth).map(digits).fold(15.0, f64::min)
}

/// All digits of a decimal number without exponent.
fn decimal(text: &str) -> Double {
    let text = text.trim();
    let places = text.split_once('.').map_or(0, |(_, places)| places.len());
    let digits: f64 = text.replace('.', "").parse().unwrap();
    Double::ratio(digits, 10f64.powi(places as i32))
}

/// Powers of `x` from 0 to `degree`, by columns.
pub(super) fn powers(x: &[Double], degree: usize) -> Vec<Vec<Double>> {
    let mut columns = vec![vec![Double::from(1.0); x.len()]];
    for k in 0..degree {
        let next = columns[k].iter().zip(x).map(|(power, x)| *power * *x);
        columns.push(next.collect());
    }
    columns
}

fn read(folder: &Path, set: &Value) -> Set {
    let text = std::fs::read_to_string(folder.join(set["file"].as_str().unwrap())).unwrap();
    let lines = text.lines().skip(1);
    let rows: Vec<Vec<Double>> = lines.map(|l| l.split(',').map(decimal).collect()).collect();
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<_>>();
    let model = set["model"].as_str().unwrap();
    let numbers = |name: &str| {
        let list = set["exact_rational_20_digits"][name].as_array().unwrap();
        let number = |x: &Value| x.as_str().unwrap().parse().unwrap();
        list.iter().map(number).collect()
    };
    let given = (1..rows[0].len()).map(column);
    Set {
        columns: match model.strip_prefix("poly") {
            Some(degree) => powers(&column(1), degree.parse().unwrap()),
            None if model == "noint" => given.collect(),
            None => std::iter::once(vec![Double::from(1.0); rows.len()])
                .chain(given)
                .collect(),
        },
        y: column(0),
        beta: numbers("beta"),
        sigma: numbers("sd"),
    }
}

/// Least digits of the plain factorisation: those of LAPACK's, or where the rounding of the data
/// to f64 leaves fewer, those.
fn least(name: &str) -> f64 {
    match name {
        "Filip" | "Wampler5" => 7.2,
        "Wampler4" => 9.1,
        "Wampler1" | "Wampler3" => 9.6,
        "Longley" => 11.3,
        "Pontius" => 12.2,
        "Norris" | "Wampler2" => 13.0,
        _ => 15.0,
    }
}

fn check(name: &str, set: &Set) {
    let (plain, sigma, certified) = set.plain();
    let in_f64 = set.refined();
    let in_32_digits = refine(set).unwrap();
    let digits = |own: &[f64]| correct_digits(own, &set.beta);
    let (first, second, third) = (
        digits(&plain),
        digits(&in_f64.solution),
        digits(&in_32_digits.solution),
    );
    let bounds = [
        (certified, first),
        (in_f64.certified_digits(), second),
        (in_32_digits.certified_digits(), third),
    ];
    eprintln!(
        "{name:9} plain {first:4.1} ({:4.1} certain)  sigma {:4.1}  refined {second:4.1} \
         ({:4.1} certain, {} steps)  32-digit powers {third:4.1} ({:4.1} certain, {} steps)",
        bounds[0].0,
        correct_digits(&sigma, &set.sigma),
        bounds[1].0,
        in_f64.steps,
        bounds[2].0,
        in_32_digits.steps,
    );
    assert!(first >= least(name), "{name}: {first}");
    assert!(in_f64.converged && in_32_digits.converged, "{name}");
    let floor = if name == "Filip" { 7.5 } else { 13.0 };
    assert!(second >= floor, "{name}, refined: {second}");
    assert!(third >= 14.5, "{name}, refined from 32 digits: {third}");
    for (certified, correct) in bounds {
        let fits = certified.min(15.0) <= correct + 1e-9;
        assert!(
            fits,
            "{name}: {certified} digits claimed, {correct} correct"
        );
    }
}

#[test]
fn nist_sets_have_the_digits_of_lapack_and_all_of_them_when_refined() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder = folder.join("../../shared/reference/nist_strd");
    let Ok(text) = std::fs::read_to_string(folder.join("certified.json")) else {
        eprintln!("skipped: {} is not there", folder.display());
        return;
    };
    let sets: Value = serde_json::from_str(&text).unwrap();
    let sets = sets.as_object().unwrap().iter();
    let sets: Vec<_> = sets.filter(|(_, set)| set["file"].is_string()).collect();
    assert_eq!(sets.len(), 11);
    for (name, set) in sets {
        check(name, &read(&folder, set));
    }
}
