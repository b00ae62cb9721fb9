//! The `[reference]` table of a companion or of a trajectory file, read and checked.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::closed_loop::{Fourier, Reference, ViaPoints, finite, same_length};
use super::companion::{Mistake, positive};

/// Furthest that a motion may jump from the end of one period to the start of the next, rad or m.
const JUMP: f64 = 1e-9;

type Rows = Spanned<Vec<Vec<f64>>>;

/// All keys of all kinds; which are needed depends on the kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawReference {
    kind: Spanned<String>,
    periods: Option<Spanned<f64>>,
    f0_hz: Option<Spanned<f64>>,
    center: Option<Spanned<Vec<f64>>>,
    sin: Option<Rows>,
    cos: Option<Rows>,
    times: Option<Spanned<Vec<f64>>>,
    q: Option<Rows>,
    qd: Option<Rows>,
    qdd: Option<Rows>,
}

impl RawReference {
    pub(super) fn check(self) -> Result<Reference, Mistake> {
        match self.kind.get_ref().as_str() {
            "fourier" => self.fourier().map(Reference::Fourier),
            "via_points" => self.via_points().map(Reference::ViaPoints),
            other => {
                let message = format!(
                    "kind = \"{other}\" is not known; expected \"fourier\" or \"via_points\""
                );
                Err((self.kind.span(), message))
            }
        }
    }

    fn fourier(self) -> Result<Fourier, Mistake> {
        let kind = (self.kind.get_ref().as_str(), self.kind.span());
        let other = [("q", &self.q), ("qd", &self.qd), ("qdd", &self.qdd)];
        let other = other.map(|(key, rows)| (key, rows.as_ref().map(Spanned::span)));
        none_of(&kind, &other)?;
        none_of(&kind, &[("times", self.times.as_ref().map(Spanned::span))])?;
        let f0_hz = needed(&kind, "f0_hz", self.f0_hz)?;
        let center = needed(&kind, "center", self.center)?;
        let sin = needed(&kind, "sin", self.sin)?;
        let cos = needed(&kind, "cos", self.cos)?;
        let harmonics = sin.get_ref().first().map_or(0, Vec::len);
        let shape = (center.get_ref().len(), harmonics);
        table("sin", &sin, shape, "harmonics in each row")?;
        table("cos", &cos, shape, "harmonics in each row")?;
        finite("center", center.get_ref(), &center.span())?;
        Ok(Fourier {
            f0_hz: positive("f0_hz", f0_hz)?,
            periods: periods(self.periods)?,
            center: center.into_inner(),
            sin: sin.into_inner(),
            cos: cos.into_inner(),
        })
    }

    fn via_points(self) -> Result<ViaPoints, Mistake> {
        let kind = (self.kind.get_ref().as_str(), self.kind.span());
        let other = [
            ("f0_hz", self.f0_hz.as_ref().map(Spanned::span)),
            ("center", self.center.as_ref().map(Spanned::span)),
            ("sin", self.sin.as_ref().map(Spanned::span)),
            ("cos", self.cos.as_ref().map(Spanned::span)),
        ];
        none_of(&kind, &other)?;
        let times = needed(&kind, "times", self.times)?;
        increasing(&times)?;
        let q = needed(&kind, "q", self.q)?;
        let shape = (q.get_ref().len(), times.get_ref().len());
        let what = "points in each row";
        table("q", &q, shape, what)?;
        let rates = [("qd", self.qd), ("qdd", self.qdd)].map(|(key, rows)| match rows {
            // Without them the joints rest at every point.
            None => Ok(vec![vec![0.0; shape.1]; shape.0]),
            Some(rows) => table(key, &rows, shape, what).map(|()| rows.into_inner()),
        });
        let [qd, qdd] = rates;
        let periods = periods(self.periods)?;
        closed(&q, periods)?;
        Ok(ViaPoints {
            times: times.into_inner(),
            periods,
            q: q.into_inner(),
            qd: qd?,
            qdd: qdd?,
        })
    }
}

/// A key that this kind needs.
fn needed<T>(
    (kind, span): &(&str, Range<usize>),
    key: &str,
    value: Option<T>,
) -> Result<T, Mistake> {
    let message = || format!("missing field `{key}`, which kind = \"{kind}\" needs");
    value.ok_or_else(|| (span.clone(), message()))
}

/// Keys that only other kinds have.
fn none_of(
    (kind, _): &(&str, Range<usize>),
    keys: &[(&str, Option<Range<usize>>)],
) -> Result<(), Mistake> {
    let mut found = keys
        .iter()
        .filter_map(|(key, span)| Some((key, span.clone()?)));
    match found.next() {
        None => Ok(()),
        Some((key, span)) => Err((span, format!("kind = \"{kind}\" has no {key}"))),
    }
}

fn periods(periods: Option<Spanned<f64>>) -> Result<f64, Mistake> {
    periods.map_or(Ok(1.0), |periods| positive("periods", periods))
}

/// One row per joint, every row as long, all numbers finite.
fn table(
    key: &str,
    rows: &Rows,
    (joints, length): (usize, usize),
    what: &str,
) -> Result<(), Mistake> {
    let span = rows.span();
    same_length(key, "rows", rows.get_ref().len(), joints, &span)?;
    rows.get_ref().iter().try_for_each(|row| {
        same_length(key, what, row.len(), length, &span)?;
        finite(key, row, &span)
    })
}

/// At least two times, from 0 on.
fn increasing(times: &Spanned<Vec<f64>>) -> Result<(), Mistake> {
    let (span, times) = (times.span(), times.get_ref());
    finite("times", times, &span)?;
    let up = times.windows(2).all(|pair| pair[0] < pair[1]);
    match times.len() > 1 && times[0] == 0.0 && up {
        true => Ok(()),
        false => Err((span, "times must begin with 0 and increase".into())),
    }
}

/// A motion that is repeated ends where it begins.
fn closed(q: &Rows, periods: f64) -> Result<(), Mistake> {
    let jumps = |row: &Vec<f64>| {
        let ends = row.first().zip(row.last());
        ends.is_some_and(|(first, last)| (first - last).abs() > JUMP)
    };
    match periods > 1.0 && q.get_ref().iter().any(jumps) {
        false => Ok(()),
        true => Err((
            q.span(),
            "with more than one period every row of q must end where it begins".into(),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Reference, Mistake> {
        toml::from_str::<RawReference>(text).unwrap().check()
    }

    fn reference(center: &str, sin: &str, cos: &str) -> Result<Reference, Mistake> {
        read(&format!(
            "kind = 'fourier'\nf0_hz = 0.1\nperiods = 2\ncenter = {center}\nsin = {sin}\ncos = {cos}"
        ))
    }

    #[test]
    fn reference_with_equal_rows_is_accepted() {
        let found = reference("[0.0, 1]", "[[1.0], [2.0]]", "[[3.0], [4.0]]").unwrap();
        assert_eq!((found.joints(), found.seconds()), (2, Some(20.0)));
    }

    #[test]
    fn reference_with_unequal_rows_says_which_list_and_how_many() {
        for (center, sin, cos, message) in [
            (
                "[0.0]",
                "[[1.0], [2.0]]",
                "[[1.0]]",
                "sin has 2 rows, expected 1",
            ),
            (
                "[0.0]",
                "[[1.0]]",
                "[[1.0, 2.0]]",
                "cos has 2 harmonics in each row, expected 1",
            ),
            ("[nan]", "[[1.0]]", "[[1.0]]", "center holds NaN"),
            ("[0.0]", "[[inf]]", "[[1.0]]", "sin holds NaN"),
        ] {
            let (_, found) = reference(center, sin, cos).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }

    #[test]
    fn reference_of_an_unknown_kind_names_the_known_ones() {
        let text = "kind = 'csv'\nf0_hz = 1\ncenter = []\nsin = []\ncos = []";
        let (span, message) = read(text).unwrap_err();
        assert!(
            message.contains("expected \"fourier\" or \"via_points\""),
            "{message}"
        );
        assert_eq!(&text[span], "'csv'");
    }

    #[test]
    fn via_points_rest_at_every_point_unless_told_otherwise() {
        let found = read("kind = 'via_points'\ntimes = [0, 1, 3]\nq = [[0, 1, 0]]").unwrap();
        let Reference::ViaPoints(points) = &found else {
            panic!("{found:?}");
        };
        assert_eq!(
            (points.qd[0].as_slice(), found.seconds()),
            (&[0.0; 3][..], Some(3.0))
        );
    }

    #[test]
    fn keys_of_another_kind_and_missing_ones_are_named() {
        for (text, message) in [
            (
                "kind = 'fourier'\ncenter = []\nsin = []\ncos = []",
                "missing field `f0_hz`, which kind = \"fourier\" needs",
            ),
            ("kind = 'via_points'\nq = [[0, 1]]", "missing field `times`"),
            (
                "kind = 'via_points'\ntimes = [0, 1]\nq = [[0, 1]]\nsin = [[1]]",
                "kind = \"via_points\" has no sin",
            ),
            (
                "kind = 'via_points'\ntimes = [1, 0]\nq = [[0, 1]]",
                "times must begin with 0 and increase",
            ),
            (
                "kind = 'via_points'\ntimes = [0, 1]\nq = [[0, 1]]\nperiods = 2",
                "must end where it begins",
            ),
            (
                "kind = 'via_points'\ntimes = [0, 1]\nq = [[0, 1]]\nqd = [[0]]",
                "qd has 1 points in each row, expected 2",
            ),
        ] {
            let (_, found) = read(text).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
