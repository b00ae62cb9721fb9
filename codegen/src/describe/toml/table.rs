//! A TOML table that is being read: what is asked for is known, the rest is reported.

use super::super::code;
use super::super::findings::{Findings, finding};
use super::super::suggest;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value with its place.
pub(super) type Value<'t> = &'t Spanned<DeValue<'t>>;

/// A table together with the keys that were asked for.
pub(super) struct Table<'t> {
    entries: &'t DeTable<'t>,
    /// How messages call it: `[identify]`, `joint 2`.
    pub(super) name: String,
    /// Where it starts.
    pub(super) offset: usize,
    known: Vec<&'static str>,
}

impl<'t> Table<'t> {
    /// A table of which nothing has been read.
    pub(super) fn new(entries: &'t DeTable<'t>, name: impl Into<String>, offset: usize) -> Self {
        Table {
            entries,
            name: name.into(),
            offset,
            known: Vec::new(),
        }
    }

    /// The value as a table, or an error that it is none.
    pub(super) fn from_value(value: Value<'t>, name: &str, to: &mut Findings) -> Option<Self> {
        match value.get_ref() {
            DeValue::Table(entries) => Some(Table::new(entries, name, value.span().start)),
            other => {
                wrong_type(value, name, "a table", other, to);
                None
            }
        }
    }

    /// The value of a key, if it is there.
    pub(super) fn get(&mut self, key: &'static str) -> Option<Value<'t>> {
        self.known.push(key);
        self.entries.get(key)
    }

    /// The value of a key, or an error that it is missing.
    pub(super) fn need(&mut self, key: &'static str, to: &mut Findings) -> Option<Value<'t>> {
        let value = self.get(key);
        if value.is_none() {
            let message = format!("{} has no `{key}`", self.name);
            to.error(self.offset, finding(code::KEY_MISSING, message));
        }
        value
    }

    /// How messages call a value of this table.
    pub(super) fn path(&self, key: &str) -> String {
        if self.name.is_empty() {
            format!("`{key}`")
        } else {
            format!("`{key}` of {}", self.name)
        }
    }

    /// Reports the keys that nobody asked for.
    pub(super) fn finish(self, to: &mut Findings) {
        for (key, offset, _) in in_text_order(self.entries) {
            if !self.known.contains(&key) {
                let place = if self.name.is_empty() {
                    "the description"
                } else {
                    &self.name
                };
                let message = format!("unknown key `{key}` in {place}");
                let help = suggest::help(key, &self.known);
                to.error(offset, finding(code::KEY_UNKNOWN, message).help(help));
            }
        }
    }
}

/// Key, its place, and value, in the order of the text.
pub(super) fn in_text_order<'t>(table: &'t DeTable<'t>) -> Vec<(&'t str, usize, Value<'t>)> {
    let mut entries: Vec<_> = table
        .iter()
        .map(|(key, value)| (key.get_ref().as_ref(), key.span().start, value))
        .collect();
    entries.sort_by_key(|(_, offset, _)| *offset);
    entries
}

/// Reports a value of another type than wanted.
pub(super) fn wrong_type(
    value: Value<'_>,
    what: &str,
    wanted: &str,
    found: &DeValue<'_>,
    to: &mut Findings,
) {
    let article = match found.type_str() {
        kind @ ("integer" | "array") => format!("an {kind}"),
        kind => format!("a {kind}"),
    };
    let message = format!("{what} must be {wanted}, not {article}");
    to.error(value.span().start, finding(code::VALUE_TYPE, message));
}
