//! `[identify]`, `[drives]` and `[prior]`.

use super::super::code;
use super::super::description::{
    DrivesSpec, EdgesSpec, FreedomSpec, IdentifySpec, PriorSpec, VelocitySpec, WeightsSpec,
};
use super::super::findings::{Findings, finding};
use super::joint::Extras;
use super::table::{Table, Value};
use super::value;
use nalgebra::DMatrix;

const EDGES: [(&str, EdgesSpec); 2] = [("matlab", EdgesSpec::Matlab), ("scipy", EdgesSpec::Scipy)];
const WEIGHTS: [(&str, WeightsSpec); 3] = [
    ("none", WeightsSpec::None),
    ("joint", WeightsSpec::Joint),
    ("robust", WeightsSpec::Robust),
];
const VELOCITY: [(&str, VelocitySpec); 2] = [
    ("derived", VelocitySpec::Derived),
    ("measured", VelocitySpec::Measured),
];

const FREEDOM: [(&str, FreedomSpec); 2] = [
    ("parameters", FreedomSpec::Parameters),
    ("mean", FreedomSpec::Mean),
];

/// Highest order of the prefilter that a design is made for.
const MAX_ORDER: usize = 20;

/// Reads `[identify]`.
pub(super) fn identify(value: Value<'_>, to: &mut Findings) -> Option<IdentifySpec> {
    const ANY: usize = u32::MAX as usize;
    let mut table = Table::from_value(value, "[identify]", to)?;
    let mut count = |key, range| {
        let value = table.get(key)?;
        value::count_within(value, &table.path(key), range, to)
    };
    let (order, nd, trim) = (
        count("order", (1, MAX_ORDER)),
        count("nd", (1, ANY)),
        count("trim", (0, ANY)),
    );
    let fq_hz = table.get("fq_hz").and_then(|value| {
        value::number_within(
            value,
            &table.path("fq_hz"),
            (f64::MIN_POSITIVE, f64::MAX),
            to,
        )
    });
    let border = table.get("border").and_then(|value| border(value, to));
    let edges = choice(&mut table, "edges", &EDGES, to);
    let weights = choice(&mut table, "weights", &WEIGHTS, to);
    let velocity = choice(&mut table, "velocity", &VELOCITY, to);
    let prefilter_torque = table
        .get("prefilter_torque")
        .and_then(|value| value::flag(value, &table.path("prefilter_torque"), to));
    let degrees_of_freedom = choice(&mut table, "degrees_of_freedom", &FREEDOM, to);
    table.finish(to);
    Some(IdentifySpec {
        fq_hz,
        order,
        nd,
        trim,
        border,
        edges,
        weights,
        velocity,
        prefilter_torque,
        degrees_of_freedom,
    })
}

fn choice<T: Copy>(
    table: &mut Table<'_>,
    key: &'static str,
    choices: &[(&str, T)],
    to: &mut Findings,
) -> Option<T> {
    let value = table.get(key)?;
    value::word(value, &table.path(key), choices, to)
}

fn border(value: Value<'_>, to: &mut Findings) -> Option<(usize, usize)> {
    let what = "`border` of [identify]";
    let values = value::list(value, what, to)?;
    let [start, end] = values[..] else {
        let message = format!("{what} takes two numbers: samples cut off at the start and the end");
        to.error(value.span().start, finding(code::NUMBER_COUNT, message));
        return None;
    };
    let range = (0, u32::MAX as usize);
    let start = value::count_within(start, what, range, to);
    let end = value::count_within(end, what, range, to);
    Some((start?, end?))
}

/// The `[drives]` table as written.
#[derive(Default)]
pub(super) struct Drives {
    gains: Option<(Vec<f64>, usize)>,
    coupling: Option<(Vec<Vec<f64>>, usize)>,
    commanded: bool,
    /// Whether torques are measured behind the gearbox, where no rotor inertia is felt.
    pub(super) link_side: bool,
}

/// Reads `[drives]`.
pub(super) fn drives(value: Value<'_>, to: &mut Findings) -> Option<Drives> {
    let mut table = Table::from_value(value, "[drives]", to)?;
    let gains = table.get("gains").and_then(|value| {
        Some((
            value::numbers(value, &table.path("gains"), to)?,
            value.span().start,
        ))
    });
    let coupling = table.get("coupling").and_then(|value| {
        let what = table.path("coupling");
        let rows = value::list(value, &what, to)?;
        let rows: Vec<_> = rows
            .into_iter()
            .map(|row| value::numbers(row, &what, to))
            .collect();
        Some((
            rows.into_iter().collect::<Option<Vec<_>>>()?,
            value.span().start,
        ))
    });
    let torque = [("measured", false), ("commanded", true)];
    let commanded = choice(&mut table, "torque", &torque, to).unwrap_or(false);
    let side = [("joint", false), ("link", true)];
    let link_side = choice(&mut table, "side", &side, to).unwrap_or(false);
    table.finish(to);
    Some(Drives {
        gains,
        coupling,
        commanded,
        link_side,
    })
}

impl Drives {
    /// The drives of as many moving joints as there are `extras`, with the gains that joints state
    /// themselves.
    pub(super) fn settle(self, extras: &[&Extras], to: &mut Findings) -> DrivesSpec {
        let coupling = self
            .coupling
            .and_then(|(rows, offset)| coupling(rows, extras.len(), offset, to));
        DrivesSpec {
            gains: gains(self.gains, extras, to),
            coupling: coupling.unwrap_or_default(),
            commanded: self.commanded,
        }
    }
}

fn gains(common: Option<(Vec<f64>, usize)>, extras: &[&Extras], to: &mut Findings) -> Vec<f64> {
    let own: Vec<(f64, usize)> = extras.iter().filter_map(|extras| extras.gain).collect();
    let (gains, offset) = match (common, own.first()) {
        (None, None) => return Vec::new(),
        (Some(_), Some((_, offset))) => {
            let message = "a gain is stated both in [drives] and for a joint";
            to.error(
                *offset,
                finding(code::KEYS_EXCLUDE, message).help("keep one of the two"),
            );
            return Vec::new();
        }
        (Some(common), None) => common,
        (None, Some((_, offset))) => (own.iter().map(|(gain, _)| *gain).collect(), *offset),
    };
    if gains.len() != extras.len() {
        let message = format!("gains: {} for {} moving joints", gains.len(), extras.len());
        let help = "give one gain per moving joint, 1.0 where the log is in N m already";
        to.error(offset, finding(code::JOINT_COUNT, message).help(help));
    }
    if gains.contains(&0.0) {
        let help = "a gain of 0 would erase the torque";
        to.error(
            offset,
            finding(code::NUMBER_RANGE, "a drive gain is 0").help(help),
        );
    }
    gains
}

/// The matrix row by row, if it is square, of the right size and invertible.
fn coupling(rows: Vec<Vec<f64>>, n: usize, offset: usize, to: &mut Findings) -> Option<Vec<f64>> {
    if rows.len() != n || rows.iter().any(|row| row.len() != n) {
        let message = format!("the coupling matrix must be {n} x {n}, one row per moving joint");
        to.error(offset, finding(code::JOINT_COUNT, message));
        return None;
    }
    let flat = rows.concat();
    let singular = DMatrix::from_row_slice(n, n, &flat).singular_values();
    let (low, high) = (singular.min(), singular.max());
    if low.is_nan() || low <= high * 1e-12 {
        let help = "q_motor = C q_joint must determine q_joint";
        let message = "the coupling matrix cannot be inverted";
        to.error(offset, finding(code::COUPLING_SINGULAR, message).help(help));
        return None;
    }
    Some(flat)
}

/// Reads `[prior]`; what is not stated is not known, and its sigma infinite.
pub(super) fn prior(value: Value<'_>, to: &mut Findings) -> Option<PriorSpec> {
    let mut table = Table::from_value(value, "[prior]", to)?;
    let mut sigma = |key| {
        let value = table.get(key)?;
        value::number_within(value, &table.path(key), (0.0, f64::MAX), to)
    };
    // Two contributions to one sigma: one of them alone leaves the other at zero.
    let pair = |one: Option<f64>, other: Option<f64>| match (one, other) {
        (None, None) => (f64::INFINITY, 0.0),
        _ => (one.unwrap_or(0.0), other.unwrap_or(0.0)),
    };
    let (com, com_fraction) = pair(sigma("com"), sigma("com_fraction"));
    let (inertia, inertia_rotation) = pair(sigma("inertia"), sigma("inertia_rotation"));
    let mut known = |key| sigma(key).unwrap_or(f64::INFINITY);
    let prior = PriorSpec {
        mass: known("mass"),
        com,
        com_fraction,
        inertia,
        inertia_rotation,
        rotor_inertia: known("rotor_inertia"),
        friction: known("friction"),
    };
    table.finish(to);
    Some(prior)
}
