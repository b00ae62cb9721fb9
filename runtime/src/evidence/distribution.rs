//! Student's and Fisher's distributions, from the incomplete beta function.

/// Lanczos' approximation with g = 7 and nine terms: 15 digits for x > 0 (P. Godfrey, 2001).
const LANCZOS: [f64; 9] = [
    0.999_999_999_999_809_9,
    676.520_368_121_885_1,
    -1_259.139_216_722_402_8,
    771.323_428_777_653_1,
    -176.615_029_162_140_6,
    12.507_343_278_686_905,
    -0.138_571_095_265_720_12,
    9.984_369_578_019_572e-6,
    1.505_632_735_149_311_6e-7,
];

/// Terms of the continued fraction; it needs about the square root of the larger parameter.
const TERMS: usize = 10_000;

/// Probability that a value of Fisher's F distribution with `above` and `below` degrees of freedom
/// (real numbers) is larger than `f`.
pub fn f_survival(f: f64, above: f64, below: f64) -> f64 {
    if f <= 0.0 {
        return 1.0;
    }
    beta_ratio(below / 2.0, above / 2.0, below / (below + above * f))
}

/// The value that Student's t with `dof` degrees of freedom (a positive real number) exceeds in
/// absolute value with probability `1 - level`: half the width of an interval of that level, in
/// standard deviations. `level` 0.95 gives 1.96 for large `dof` and 2.13 for 15.
pub fn student_quantile(level: f64, dof: f64) -> f64 {
    let outside = 1.0 - level.clamp(0.0, 1.0 - f64::EPSILON);
    let exceeds = |t: f64| beta_ratio(dof / 2.0, 0.5, dof / (dof + t * t));
    let (mut low, mut high) = (0.0, 1.0);
    while exceeds(high) > outside && high < 1e150 {
        (low, high) = (high, 2.0 * high);
    }
    // Bisection to the last bit: 60 halvings, and no derivative that could fail.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match exceeds(middle) > outside {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

/// Regularised incomplete beta function \\( I_x(a, b) \\).
fn beta_ratio(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p()).exp();
    // The fraction converges fast on this side of the mean only.
    match x < (a + 1.0) / (a + b + 2.0) {
        true => front * fraction(a, b, x) / a,
        false => 1.0 - front * fraction(b, a, 1.0 - x) / b,
    }
}

/// Continued fraction of the incomplete beta function by Lentz' method (DLMF 8.17.22).
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    let away_from_zero = |x: f64| if x.abs() < 1e-300 { 1e-300 } else { x };
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut value = d;
    for m in 1..TERMS {
        let m = m as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let before = value;
        for term in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + term * d);
            c = away_from_zero(1.0 + term / c);
            value *= c * d;
        }
        if (value - before).abs() <= f64::EPSILON * value.abs() {
            break;
        }
    }
    value
}

/// Logarithm of the gamma function, for x > 0.
fn ln_gamma(x: f64) -> f64 {
    let x = x - 1.0;
    let terms = LANCZOS.iter().enumerate().skip(1);
    let sum: f64 = LANCZOS[0] + terms.map(|(k, term)| term / (x + k as f64)).sum::<f64>();
    let t = x + 7.5;
    0.5 * (2.0 * std::f64::consts::PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(value: f64, expected: f64) {
        assert!(
            (value / expected - 1.0).abs() < 1e-11,
            "{value} is not {expected}"
        );
    }

    #[test]
    fn student_quantiles_with_closed_forms_agree() {
        // One degree of freedom: tan(pi level / 2); two: level * sqrt(2 / (1 - level^2)).
        for level in [0.5, 0.9, 0.95, 0.99] {
            close(
                student_quantile(level, 1.0),
                (std::f64::consts::FRAC_PI_2 * level).tan(),
            );
            close(
                student_quantile(level, 2.0),
                level * (2.0 / (1.0 - level * level)).sqrt(),
            );
        }
    }

    #[test]
    fn student_quantiles_agree_with_tables() {
        // R: qt(0.975, c(5, 15, 30)); the normal limit 1.959963984540054.
        close(student_quantile(0.95, 5.0), 2.570_581_835_636_314);
        close(student_quantile(0.95, 15.0), 2.131_449_545_559_323);
        close(student_quantile(0.95, 30.0), 2.042_272_456_301_238);
        assert!((student_quantile(0.95, 1e9) - 1.959_963_984_540_054).abs() < 1e-6);
    }

    #[test]
    fn fisher_tail_with_two_above_has_its_closed_form() {
        for (f, below) in [(0.5f64, 3.0f64), (3.0, 10.0), (40.0, 200.0), (2.0, 1e6)] {
            let expected: f64 = (-0.5 * below * (2.0 * f / below).ln_1p()).exp();
            assert!((f_survival(f, 2.0, below) / expected - 1.0).abs() < 1e-9);
        }
    }
}
