//! Effects: what every joint gets, what one joint gets, and `[[effect]]`.

use super::super::check::Known;
use super::super::code;
use super::super::description::EffectSpec;
use super::super::diagnostic::Span;
use super::super::findings::{Findings, finding};
use super::super::suggest;
use super::table::{Table, Value};
use super::value;
use crate::catalogue::EffectKind;
use std::collections::HashMap;
use toml::de::DeValue;

/// An effect that is asked for, before it is said on which joint.
#[derive(Clone)]
pub(super) struct Wanted {
    /// Entry of the catalogue.
    kind: EffectKind,
    /// Shape parameters, defaults filled in.
    shape: Vec<(&'static str, f64)>,
    /// Where it is asked for.
    span: Span,
}

impl Wanted {
    /// The effect with default shape; `span` is where it is implied.
    pub(super) fn plain(kind: EffectKind, span: Span) -> Self {
        let shape = kind
            .shapes()
            .iter()
            .map(|shape| (shape.name, shape.default))
            .collect();
        Wanted { kind, shape, span }
    }

    /// The effect on one joint.
    pub(super) fn on(&self, joint: &str) -> EffectSpec {
        let Wanted { kind, shape, span } = self.clone();
        EffectSpec {
            kind,
            joints: vec![joint.to_owned()],
            shape,
            span,
        }
    }
}

/// Reads `effects = ["viscous", { kind = "coulomb", smoothing = 0.05 }]`.
pub(super) fn wanted(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Vec<Wanted>> {
    let mut all: Vec<Wanted> = Vec::new();
    for one in value::list(value, what, to)? {
        let offset = one.span().start;
        let Some(wanted) = entry(one, what, to) else {
            continue;
        };
        if wanted.kind.arity() != 1 {
            let name = wanted.kind.name();
            let message = format!("`{name}` takes {} joints, not one", wanted.kind.arity());
            let help = format!("use [[effect]] with kind = \"{name}\" and joints = [...]");
            to.error(offset, finding(code::EFFECT_ARITY, message).help(help));
        } else if all.iter().any(|other| other.kind == wanted.kind) {
            let message = format!("`{}` is twice in {what}", wanted.kind.name());
            to.error(offset, finding(code::EFFECT_REPEATED, message));
        } else {
            all.push(wanted);
        }
    }
    Some(all)
}

fn entry(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Wanted> {
    let span = to.span(value.span().start);
    match value.get_ref() {
        DeValue::Table(_) => {
            let mut table = Table::from_value(value, what, to)?;
            let kind = table.need("kind", to)?;
            let kind = self::kind(kind, to)?;
            let shape = shape(&mut table, kind, to);
            table.finish(to);
            Some(Wanted { kind, shape, span })
        }
        _ => Some(Wanted::plain(kind(value, to)?, span)),
    }
}

/// An entry of the catalogue by its name.
fn kind(value: Value<'_>, to: &mut Findings) -> Option<EffectKind> {
    let name = value::text(value, "an effect", to)?;
    let found = EffectKind::from_name(name);
    if found.is_none() {
        let known: Vec<&str> = EffectKind::ALL.iter().map(|kind| kind.name()).collect();
        let message = format!("unknown effect `{name}`");
        let help = suggest::help(name, &known);
        to.error(
            value.span().start,
            finding(code::EFFECT_UNKNOWN, message).help(help),
        );
    }
    found
}

/// The shape parameters of a kind; every one is asked for, so that others are unknown keys.
fn shape(table: &mut Table<'_>, kind: EffectKind, to: &mut Findings) -> Vec<(&'static str, f64)> {
    table.name = format!("effect `{}`", kind.name());
    let mut shape = Vec::new();
    for parameter in kind.shapes() {
        let given = table.get(parameter.name).and_then(|value| {
            value::number_within(value, &table.path(parameter.name), parameter.range, to)
        });
        shape.push((parameter.name, given.unwrap_or(parameter.default)));
    }
    shape
}

/// Reads one `[[effect]]`.
pub(super) fn on_joints(
    value: Value<'_>,
    joints: &[Known],
    to: &mut Findings,
) -> Option<EffectSpec> {
    let mut table = Table::from_value(value, "[[effect]]", to)?;
    let kind_value = table.need("kind", to)?;
    let kind = kind(kind_value, to)?;
    let shape = shape(&mut table, kind, to);
    let names = names(&mut table, kind, joints, to);
    let span = to.span(table.offset);
    table.finish(to);
    Some(EffectSpec {
        kind,
        joints: names?,
        shape,
        span,
    })
}

/// `joint = "a"` or `joints = ["a", "b"]`: as many moving joints as the kind takes.
fn names(
    table: &mut Table<'_>,
    kind: EffectKind,
    joints: &[Known],
    to: &mut Findings,
) -> Option<Vec<String>> {
    let (one, several) = (table.get("joint"), table.get("joints"));
    let (offset, values) = match (one, several) {
        (Some(value), None) => (value.span().start, vec![value]),
        (None, Some(value)) => (
            value.span().start,
            value::list(value, &table.path("joints"), to)?,
        ),
        (Some(_), Some(value)) => {
            let message = format!("{} has both `joint` and `joints`", table.name);
            to.error(value.span().start, finding(code::KEYS_EXCLUDE, message));
            return None;
        }
        (None, None) => (table.offset, Vec::new()),
    };
    if values.len() == kind.arity() {
        let names: Vec<Option<&str>> = values
            .iter()
            .map(|value| moving(value, joints, to))
            .collect();
        let names: Vec<&str> = names.into_iter().collect::<Option<_>>()?;
        if (1..names.len()).all(|i| !names[..i].contains(&names[i])) {
            return Some(names.into_iter().map(str::to_owned).collect());
        }
    }
    let wanted = match kind.arity() {
        0 => "no joint".to_owned(),
        1 => "`joint = \"NAME\"`".to_owned(),
        n => format!("`joints = [...]` with {n} different names"),
    };
    let message = format!("effect `{}` needs {wanted}", kind.name());
    to.error(offset, finding(code::EFFECT_ARITY, message));
    None
}

/// The name of a joint with a drive.
fn moving<'j>(value: Value<'_>, joints: &'j [Known], to: &mut Findings) -> Option<&'j str> {
    let wanted = value::text(value, "a joint", to)?;
    let found = joints.iter().find(|joint| joint.name == wanted);
    let mistake = match found.map(|joint| (joint, joint.idle())) {
        Some((joint, None)) => return Some(&joint.name),
        Some((_, Some((why, help)))) => finding(code::EFFECT_JOINT, why).help(help),
        None => {
            let driven = joints.iter().filter(|joint| joint.is_driven());
            let help = to.suggest(wanted, driven.map(|joint| joint.name.as_str()));
            finding(code::EFFECT_JOINT, format!("there is no joint `{wanted}`")).help(help)
        }
    };
    to.error(value.span().start, mistake);
    None
}

/// Reports an effect that is asked for twice on the same joints: its columns would be equal.
pub(super) fn check_distinct(effects: &[EffectSpec], to: &mut Findings) {
    // Of two joints of one name each has the effects of both: that is said already.
    if to.errors_of_group(code::NAME_REPEATED) > 0 {
        return;
    }
    let mut first: HashMap<(EffectKind, &[String]), Span> = HashMap::new();
    for EffectSpec {
        kind, joints, span, ..
    } in effects
    {
        if let Some(before) = first.insert((*kind, joints), *span) {
            let message = format!("`{}` acts on {} already", kind.name(), joints.join(", "));
            let help = match before.line {
                0 => "it is there by default".to_owned(),
                line => format!("it is asked for on line {line}; remove one"),
            };
            to.error_at(*span, finding(code::EFFECT_REPEATED, message).help(help));
        }
    }
}
