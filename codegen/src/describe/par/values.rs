//! The values of a `.par`: numbers, expressions, and symbols that may or may not have a value.

use super::super::code;
use super::super::expression::{self, RESERVED};
use super::super::findings::{Findings, finding};
use super::document::{Document, Entry, Item};
use std::cell::RefCell;
use std::collections::HashSet;
use std::f64::consts::PI;

/// More symbols than any robot has.
const MAX_SYMBOLS: usize = 300;

/// Scalars of the format, in lower case.
pub(super) const SCALARS: [&str; 6] = ["nl", "nj", "nf", "type", "is_floating", "is_mobile"];

/// Lists of the format, in lower case.
pub(super) const LISTS: [&str; 38] = [
    "ant", "sigma", "b", "d", "r", "gamma", "alpha", "mu", "theta", "xx", "xy", "xz", "yy", "yz",
    "zz", "mx", "my", "mz", "m", "ia", "fv", "fs", "fx", "fy", "fz", "cx", "cy", "cz", "eta", "k",
    "qp", "qdp", "gam", "w0", "wp0", "v0", "vp0", "g",
];

/// The world of frame 0, which the model does not depend on: 16 values.
const PLACE: &str = "z";

/// Looks values up.
pub(super) struct Values<'d, 't> {
    document: &'d Document<'t>,
    /// Symbols with a value, `Pi` among them.
    symbols: Vec<(String, f64)>,
    used: RefCell<HashSet<String>>,
}

impl<'d, 't> Values<'d, 't> {
    /// Gives symbols their values; a key that means nothing is an error.
    pub(super) fn new(document: &'d Document<'t>, to: &mut Findings) -> Self {
        let mut values = Values {
            document,
            symbols: vec![("Pi".to_owned(), PI), ("PI".to_owned(), PI)],
            used: RefCell::default(),
        };
        for entry in &document.entries {
            let key = entry.key.text;
            match (is_scalar(key), is_list(key), entry.list) {
                (true, _, false) | (_, true, true) => {}
                (false, false, false) => values.define(entry, to),
                (false, false, true) => unknown(entry.key, to),
                (_, _, found) => {
                    let wanted = if found { "one value" } else { "a list in { }" };
                    let message = format!("`{}` takes {wanted}", entry.key.text);
                    to.error(entry.key.offset, finding(code::VALUE_TYPE, message));
                }
            }
        }
        values
    }

    /// `D3 = 0.4318`: the value of a symbol.
    fn define(&mut self, entry: &Entry<'_>, to: &mut Findings) {
        let Some(&item) = entry.items.first() else {
            return;
        };
        if self.symbols.len() > MAX_SYMBOLS {
            let message = format!("more than {MAX_SYMBOLS} symbols");
            to.error(entry.key.offset, finding(code::NUMBER_RANGE, message));
        } else if let Some(value) = self.number(item, &format!("`{}`", entry.key.text), to) {
            self.symbols.push((entry.key.text.to_owned(), value));
        }
    }

    /// Reports symbols that were given a value for nothing: keys that are misspelt.
    pub(super) fn finish(&self, to: &mut Findings) {
        let used = self.used.borrow();
        for entry in &self.document.entries {
            let key = entry.key.text;
            let symbol = !entry.list && !is_scalar(key) && !is_list(key);
            if symbol && !used.contains(key) {
                unknown(entry.key, to);
            }
        }
    }

    /// The entry of a key.
    pub(super) fn entry(&self, key: &str) -> Option<&'d Entry<'t>> {
        let entries = &self.document.entries;
        entries
            .iter()
            .find(|entry| entry.key.text.eq_ignore_ascii_case(key))
    }

    /// The value of a key that has one.
    pub(super) fn scalar(&self, key: &str) -> Option<Item<'t>> {
        let entry = self.entry(key).filter(|entry| !entry.list)?;
        entry.items.first().copied()
    }

    /// The list of a key, if it has `count` values; other counts are reported.
    pub(super) fn list(
        &self,
        key: &str,
        count: usize,
        to: &mut Findings,
    ) -> Option<&'d [Item<'t>]> {
        let entry = self.entry(key).filter(|entry| entry.list)?;
        if entry.items.len() == count {
            return Some(&entry.items);
        }
        let message = format!(
            "`{}` has {} values instead of {count}",
            entry.key.text,
            entry.items.len()
        );
        to.error(entry.key.offset, finding(code::NUMBER_COUNT, message));
        None
    }

    /// The value of an expression in which every symbol has a value.
    pub(super) fn number(&self, item: Item<'_>, what: &str, to: &mut Findings) -> Option<f64> {
        self.evaluate(item, what, &[], to)
    }

    /// The same with values for further symbols.
    pub(super) fn evaluate(
        &self,
        item: Item<'_>,
        what: &str,
        more: &[(String, f64)],
        to: &mut Findings,
    ) -> Option<f64> {
        for word in words(item.text) {
            self.used.borrow_mut().insert(word.to_owned());
        }
        let all;
        let symbols = match more.is_empty() {
            true => &self.symbols,
            false => {
                all = [&self.symbols, more].concat();
                &all
            }
        };
        match expression::evaluate(item.text, symbols) {
            Ok(value) if value.is_finite() => Some(value),
            Ok(_) => {
                let message = format!("{what} is no finite number");
                to.error(item.offset, finding(code::NUMBER_NOT_FINITE, message));
                None
            }
            Err(mistake) => {
                let (message, help) = match first_without(item.text, symbols) {
                    Some(symbol) => (
                        format!("{what}: `{symbol}` has no value"),
                        format!("give it one on a line of its own: {symbol} = 0.5"),
                    ),
                    None => (format!("{what}: {}", mistake.message), mistake.help),
                };
                let found = finding(code::EXPRESSION, message).help(help);
                to.error(item.offset + mistake.offset, found);
                None
            }
        }
    }

    /// The first symbol of an expression that has no value.
    pub(super) fn symbol<'i>(&self, item: Item<'i>) -> Option<&'i str> {
        first_without(item.text, &self.symbols)
    }
}

fn first_without<'i>(text: &'i str, symbols: &[(String, f64)]) -> Option<&'i str> {
    words(text).find(|word| !symbols.iter().any(|(known, _)| known == word))
}

fn is_scalar(key: &str) -> bool {
    SCALARS.contains(&key.to_ascii_lowercase().as_str())
}

fn is_list(key: &str) -> bool {
    let key = key.to_ascii_lowercase();
    LISTS.contains(&key.as_str()) || key == PLACE
}

fn unknown(key: Item<'_>, to: &mut Findings) {
    let names = ["NL", "NJ", "NF", "Type", "is_floating", "is_mobile", "Z"];
    let lists = [
        "XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M", "IA", "FV", "FS", "G",
    ];
    let known = names.into_iter().chain(lists).chain(LISTS);
    let message = format!("unknown key `{}`", key.text);
    let help = to.suggest(key.text, known);
    to.error(key.offset, finding(code::KEY_UNKNOWN, message).help(help));
}

/// The names in an expression that are no function and no constant.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    let pieces = text.split(move |c: char| !letter(c));
    pieces.filter(|word| {
        let first = word.chars().next();
        first.is_some_and(|c| c.is_alphabetic() || c == '_') && !RESERVED.contains(word)
    })
}
