//! Numbers and names of the description as text of a program.

/// A number that reads back as itself, in C as in Python.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A name of the description between double quotes. Control characters are written in octal, which
/// C and Python read alike; so is `?`, of which C makes trigraphs.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            _ if c == '?' || c.is_ascii_control() => {
                quoted.push_str(&format!("\\{:03o}", u32::from(c)));
            }
            _ => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Text that may stand in a comment or a docstring of any language.
pub fn remark(text: &str) -> String {
    let plain = |c: char| if c.is_control() || c == '\\' { ' ' } else { c };
    let text: String = text.chars().map(plain).collect();
    text.replace("*/", "* /")
        .replace("/*", "/ *")
        .replace('"', "'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_name_cannot_end_its_string_or_become_a_trigraph() {
        assert_eq!(quoted("a\"b\\\n??/"), r#""a\"b\\\012\077\077/""#);
        assert_eq!(quoted("épaule"), "\"épaule\"");
    }

    #[test]
    fn remark_cannot_end_its_comment() {
        assert_eq!(remark("a*/\"\"\"b\\\n"), "a* /'''b  ");
    }
}
