//! The text of a `.par`: keys with a value or with a list of values, each with its place.

use super::super::code;
use super::super::findings::{Findings, finding};
use std::collections::HashMap;

/// A piece of text and its byte offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<'t> {
    /// Without blanks around it.
    pub(super) text: &'t str,
    /// Where it begins.
    pub(super) offset: usize,
}

impl<'t> Item<'t> {
    fn new(text: &'t str, offset: usize) -> Self {
        let blank = text.len() - text.trim_start().len();
        Item {
            text: text.trim(),
            offset: offset + blank,
        }
    }
}

/// `key = value` or `key = {value, value}`.
#[derive(Clone, Debug)]
pub(super) struct Entry<'t> {
    /// The key as it is written.
    pub(super) key: Item<'t>,
    /// One value, or those between braces.
    pub(super) items: Vec<Item<'t>>,
    /// Whether there are braces.
    pub(super) list: bool,
}

/// A file.
#[derive(Debug, Default)]
pub(super) struct Document<'t> {
    /// What `(* Robotname = '...' *)` says.
    pub(super) name: Option<&'t str>,
    /// Keys in the order of the text; those that the format knows are looked up in lower case,
    /// since old files write `Ant` and `Alpha`.
    pub(super) entries: Vec<Entry<'t>>,
}

/// Reads the text line by line; a line with a comment holds nothing else but a value before it.
pub(super) fn read<'t>(text: &'t str, to: &mut Findings) -> Document<'t> {
    let mut document = Document::default();
    let mut open: Option<(Entry<'t>, Vec<Item<'t>>)> = None;
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let at = offset;
        offset += line.len();
        let (code, comment) = line.split_at(line.find("(*").unwrap_or(line.len()));
        if document.name.is_none() {
            document.name = robot_name(comment);
        }
        match open.take() {
            Some(entry) => open = continue_list(entry, code, at, &mut document, to),
            None => open = begin(code, at, &mut document, to),
        }
    }
    if let Some((entry, _)) = open {
        let message = format!("the list of `{}` has no `}}`", entry.key.text);
        to.error(entry.key.offset, finding(code::PAR_SYNTAX, message));
    }
    repeated(&document, to);
    document
}

type Open<'t> = Option<(Entry<'t>, Vec<Item<'t>>)>;

fn begin<'t>(
    line: &'t str,
    offset: usize,
    document: &mut Document<'t>,
    to: &mut Findings,
) -> Open<'t> {
    if line.trim().is_empty() {
        return None;
    }
    let Some((key, value)) = line.split_once('=') else {
        let found = finding(code::PAR_SYNTAX, "this is no `key = value`");
        to.error(
            Item::new(line, offset).offset,
            found.help("comments stand between (* and *)"),
        );
        return None;
    };
    let at = offset + key.len() + 1;
    let key = Item::new(key, offset);
    let item = Item::new(value, at);
    let entry = |items, list| Entry { key, items, list };
    match item.text.strip_prefix('{') {
        Some(rest) => continue_list(
            (entry(Vec::new(), true), Vec::new()),
            rest,
            item.offset + 1,
            document,
            to,
        ),
        None => {
            document.entries.push(entry(vec![item], false));
            None
        }
    }
}

/// A piece of a list up to its `}` or the end of the line; a value does not go over lines.
fn continue_list<'t>(
    (mut entry, mut items): (Entry<'t>, Vec<Item<'t>>),
    piece: &'t str,
    offset: usize,
    document: &mut Document<'t>,
    to: &mut Findings,
) -> Open<'t> {
    let (inside, after) = match piece.split_once('}') {
        Some((inside, after)) => (inside, Some(after)),
        None => (piece, None),
    };
    items.extend(split(inside, offset));
    let Some(after) = after else {
        return Some((entry, items));
    };
    if !after.trim().is_empty() {
        let at = Item::new(after, offset + inside.len() + 1).offset;
        let message = format!("something stands behind the list of `{}`", entry.key.text);
        to.error(at, finding(code::PAR_SYNTAX, message));
    }
    entry.items = items;
    document.entries.push(entry);
    None
}

/// The values between commas that stand in no parentheses; a comma at the end of a line ends the
/// last value of that line.
fn split(text: &str, offset: usize) -> Vec<Item<'_>> {
    let mut items = Vec::new();
    let (mut start, mut depth) = (0, 0usize);
    for (place, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                items.push(Item::new(&text[start..place], offset + start));
                start = place + 1;
            }
            _ => {}
        }
    }
    items.push(Item::new(&text[start..], offset + start));
    items.retain(|item| !item.text.is_empty());
    items
}

/// `Robotname = 'X'` in a comment.
fn robot_name(comment: &str) -> Option<&str> {
    let (_, rest) = comment.split_once("Robotname")?;
    let (_, rest) = rest.split_once('\'')?;
    let (name, _) = rest.split_once('\'')?;
    Some(name.trim()).filter(|name| !name.is_empty())
}

fn repeated(document: &Document<'_>, to: &mut Findings) {
    let mut first: HashMap<String, usize> = HashMap::new();
    for entry in &document.entries {
        let key = entry.key;
        if let Some(before) = first.insert(key.text.to_owned(), key.offset) {
            let line = to.span(before).line;
            let message = format!("`{}` is there twice, first on line {line}", key.text);
            to.error(key.offset, finding(code::PAR_SYNTAX, message));
        }
    }
}
