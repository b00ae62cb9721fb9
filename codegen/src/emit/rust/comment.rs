//! Comments and blank lines, which token streams cannot carry: placeholders in the tokens, set in
//! the text afterwards.

use proc_macro2::TokenStream;
use quote::quote;

/// A `//` comment on a line of its own, which token streams cannot carry: [`set`] sets it.
pub fn comment(text: &str) -> TokenStream {
    let text = plain(text);
    quote! { comment!(#text); }
}

/// A `//` comment at the end of the line before.
pub fn note(text: &str) -> TokenStream {
    let text = plain(text);
    quote! { note!(#text); }
}

/// Text that a string literal carries unescaped.
fn plain(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_control() || c == '"' || c == '\\' {
                ' '
            } else {
                c
            }
        })
        .collect()
}

/// Sets the comments that [`comment`] and [`note`] stand for, and the blank lines between items.
pub fn set(text: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    for line in text.lines() {
        let trimmed = line.trim_start();
        let indent = &line[..line.len() - trimmed.len()];
        let quoted = |start: &str| trimmed.strip_prefix(start)?.strip_suffix("\");");
        let before = out.last().map_or("", String::as_str);
        if let Some(comment) = quoted("comment!(\"") {
            if !before.ends_with('{') {
                out.push(String::new());
            }
            out.push(format!("{indent}// {comment}"));
        } else if let Some(note) = quoted("note!(\"") {
            if let Some(last) = out.last_mut().filter(|last| last.len() + note.len() < 96) {
                last.push_str(&format!(" // {note}"));
            }
        } else {
            if starts_item(trimmed, before) && indent.is_empty() {
                out.push(String::new());
            }
            out.push(line.to_owned());
        }
    }
    out.push(String::new());
    out.join("\n")
}

/// Whether a top-level line begins an item that a blank line sets off from the line before.
fn starts_item(line: &str, before: &str) -> bool {
    let ends = ["}", "};", "];", ");"].contains(&before) || before.starts_with("use ");
    let documented = line.starts_with("///") && !before.starts_with("///") && !before.is_empty();
    documented || (ends && !line.is_empty() && !line.starts_with("use ") && line != "}")
}
