//! Names that generated code can carry.

/// Longest identifier that is made of a name.
const MAX_LENGTH: usize = 64;

/// Words that Rust keeps for itself.
pub const KEYWORDS: [&str; 53] = [
    "abstract",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "struct",
    "super",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "union",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "macro_rules",
];

/// A name in snake case, of `a-z0-9_` only: `PandaArm 2` becomes `panda_arm_2`.
///
/// What has no letter or digit of its own (`../`, `机器人`) becomes empty.
pub fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    let mut after_small_letter = false;
    for letter in name.chars() {
        if snake.len() >= MAX_LENGTH {
            break;
        }
        if !letter.is_ascii_alphanumeric() {
            if !snake.is_empty() && !snake.ends_with('_') {
                snake.push('_');
            }
        } else {
            if after_small_letter && letter.is_ascii_uppercase() {
                snake.push('_');
            }
            snake.push(letter.to_ascii_lowercase());
        }
        after_small_letter = letter.is_ascii_lowercase();
    }
    snake.truncate(snake.trim_end_matches('_').len());
    snake
}

/// The module name of a robot: a lower-case Rust identifier, whatever the robot is called.
pub fn robot_name(name: &str) -> String {
    let snake = snake_case(name);
    if snake.is_empty() {
        return "robot".to_owned();
    }
    if snake.starts_with(|first: char| first.is_ascii_digit()) {
        return format!("robot_{snake}");
    }
    if KEYWORDS.contains(&snake.as_str()) {
        return format!("{snake}_robot");
    }
    snake
}

/// Whether a word can name a length or a parameter: a letter, then letters, digits and `_`.
pub fn is_word(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_alphabetic())
        && word
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robot_name_is_always_an_identifier() {
        for (name, expected) in [
            ("scara", "scara"),
            ("UR10e", "ur10e"),
            ("PandaArm 2", "panda_arm_2"),
            ("../../etc/passwd", "etc_passwd"),
            ("type", "type_robot"),
            ("self", "self_robot"),
            ("1link", "robot_1link"),
            ("机器人", "robot"),
            ("", "robot"),
            ("a--b__c-", "a_b_c"),
        ] {
            assert_eq!(robot_name(name), expected);
        }
        assert!(robot_name(&"x_y".repeat(1000)).len() <= MAX_LENGTH);
    }
}
