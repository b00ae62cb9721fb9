//! The small expressions of descriptions: `pi/2`, `-L1`, `L*cos(pi/6) + 0.1`.
//!
//! Numbers, `pi`, named lengths, `+ - * /`, parentheses, `cos`, `sin`, `sqrt`, `atan2`. Evaluated while they
//! are read; nesting is limited, so that no text can exhaust the stack.

use super::suggest;

/// Deepest nesting of parentheses and signs.
const MAX_DEPTH: usize = 32;

/// Names that are not free for lengths.
pub(crate) const RESERVED: [&str; 5] = ["pi", "cos", "sin", "sqrt", "atan2"];

/// Why an expression has no value.
#[derive(Debug, PartialEq)]
pub(crate) struct Mistake {
    /// Byte offset in the expression.
    pub(crate) offset: usize,
    /// What is wrong there.
    pub(crate) message: String,
    /// What to do.
    pub(crate) help: String,
}

/// The value of an expression over named lengths.
pub(crate) fn evaluate(text: &str, lengths: &[(String, f64)]) -> Result<f64, Mistake> {
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
        lengths,
    };
    let value = parser.sum()?;
    match parser.peek() {
        None => Ok(value),
        Some(',') => {
            let help = "decimal numbers are written with a point: 0.5";
            Err(parser.mistake("`,` has no meaning here", help))
        }
        Some(found) => Err(parser.mistake(format!("`{found}` does not belong here"), HELP)),
    }
}

const HELP: &str =
    "expressions are numbers, pi and named lengths with + - * / ( ) cos sin sqrt atan2";

struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    lengths: &'t [(String, f64)],
}

impl<'t> Parser<'t> {
    fn sum(&mut self) -> Result<f64, Mistake> {
        let mut value = self.product()?;
        loop {
            if self.eat('+') {
                value += self.product()?;
            } else if self.eat('-') {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result<f64, Mistake> {
        let mut value = self.factor()?;
        loop {
            if self.eat('*') {
                value *= self.factor()?;
            } else if self.eat('/') {
                let divisor = self.factor()?;
                if divisor == 0.0 {
                    return Err(self.mistake("division by zero", ""));
                }
                value /= divisor;
            } else {
                return Ok(value);
            }
        }
    }

    fn factor(&mut self) -> Result<f64, Mistake> {
        if self.depth >= MAX_DEPTH {
            return Err(self.mistake("nested too deeply", "give the parts names in [lengths]"));
        }
        self.depth += 1;
        let value = self.operand();
        self.depth -= 1;
        value
    }

    fn operand(&mut self) -> Result<f64, Mistake> {
        if self.eat('-') {
            return Ok(-self.factor()?);
        }
        if self.eat('+') {
            return self.factor();
        }
        if self.eat('(') {
            return self.closed();
        }
        match self.peek() {
            Some(first) if first.is_ascii_digit() || first == '.' => self.number(),
            Some(first) if first.is_alphabetic() || first == '_' => self.word(),
            Some(found) => Err(self.mistake(format!("`{found}` does not belong here"), HELP)),
            None => Err(self.mistake("something is missing at the end", HELP)),
        }
    }

    /// What follows an opening parenthesis, with the closing one.
    fn closed(&mut self) -> Result<f64, Mistake> {
        let value = self.sum()?;
        if self.eat(')') {
            return Ok(value);
        }
        Err(self.mistake("a `)` is missing", ""))
    }

    fn number(&mut self) -> Result<f64, Mistake> {
        let rest = self.rest();
        let mut length = 0;
        let mut before = ' ';
        for letter in rest.chars() {
            let exponent_sign = matches!(letter, '+' | '-') && matches!(before, 'e' | 'E');
            let digit = letter.is_ascii_digit() || matches!(letter, '.' | 'e' | 'E');
            if !digit && !exponent_sign {
                break;
            }
            length += letter.len_utf8();
            before = letter;
        }
        let digits = rest.get(..length).unwrap_or_default();
        match digits.parse::<f64>() {
            Ok(value) => {
                self.at += length;
                Ok(value)
            }
            Err(_) => Err(self.mistake(format!("`{digits}` is not a number"), "")),
        }
    }

    fn word(&mut self) -> Result<f64, Mistake> {
        let start = self.at;
        let rest = self.rest();
        let end = rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        let word = rest.get(..end).unwrap_or_default();
        self.at += end;
        match word {
            "pi" => Ok(std::f64::consts::PI),
            "cos" | "sin" | "sqrt" => self.call(word),
            "atan2" => self.atan2(),
            _ => match self.lengths.iter().find(|(name, _)| name == word) {
                Some((_, value)) => Ok(*value),
                None => {
                    self.at = start;
                    Err(self.unknown(word))
                }
            },
        }
    }

    fn call(&mut self, function: &str) -> Result<f64, Mistake> {
        if !self.eat('(') {
            return Err(self.mistake(format!("`{function}` needs its argument in ( )"), ""));
        }
        let argument = self.closed()?;
        match function {
            "cos" => Ok(argument.cos()),
            "sin" => Ok(argument.sin()),
            _ if argument < 0.0 => Err(self.mistake("square root of a negative number", "")),
            _ => Ok(argument.sqrt()),
        }
    }

    fn atan2(&mut self) -> Result<f64, Mistake> {
        if !self.eat('(') {
            return Err(self.mistake("`atan2` needs its arguments in ( )", ""));
        }
        let y = self.sum()?;
        if !self.eat(',') {
            return Err(self.mistake("`atan2` takes two arguments", ""));
        }
        Ok(y.atan2(self.closed()?))
    }

    fn unknown(&self, word: &str) -> Mistake {
        const COMPARED: usize = 100;
        let mut known: Vec<&str> = self
            .lengths
            .iter()
            .take(COMPARED)
            .map(|(name, _)| name.as_str())
            .collect();
        known.extend(RESERVED);
        let help = match suggest::nearest(word, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("give `{word}` a value in [lengths]"),
        };
        self.mistake(format!("`{word}` is not a named length"), help)
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn peek(&mut self) -> Option<char> {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        self.rest().chars().next()
    }

    fn eat(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn mistake(&self, message: impl Into<String>, help: impl Into<String>) -> Mistake {
        Mistake {
            offset: self.at,
            message: message.into(),
            help: help.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn value(text: &str) -> Result<f64, Mistake> {
        evaluate(text, &[("L".to_owned(), 0.5), ("D3".to_owned(), 0.25)])
    }

    #[test]
    fn evaluate_follows_the_rules_of_arithmetic() {
        for (text, expected) in [
            ("pi/2", FRAC_PI_2),
            ("-pi/2", -FRAC_PI_2),
            (" - L * 2 + 1e-1 ", -0.9),
            ("2 - 3 - 4", -5.0),
            ("8/4/2", 1.0),
            ("--(L + D3)*4", 3.0),
            ("sqrt(L*L) - cos(0) + sin(0)", -0.5),
            ("2*pi", 2.0 * PI),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn evaluate_says_where_an_expression_is_wrong() {
        for (text, offset, message) in [
            ("", 0, "missing"),
            ("2 +", 3, "missing"),
            ("L2", 0, "`L2` is not a named length"),
            ("1 + 2)", 5, "`)`"),
            ("(1", 2, "`)` is missing"),
            ("1/0", 3, "division by zero"),
            ("0,5", 1, "`,`"),
            ("1.2.3", 0, "not a number"),
            ("cos 2", 4, "argument"),
            ("sqrt(-1)", 8, "negative"),
            ("π", 0, "`π`"),
        ] {
            let mistake = value(text).unwrap_err();
            assert_eq!(mistake.offset, offset, "{text}");
            assert!(
                mistake.message.contains(message),
                "{text}: {}",
                mistake.message
            );
        }
    }

    #[test]
    fn evaluate_deep_nesting_is_a_mistake_not_an_overflow() {
        for text in ["(".repeat(1_000_000), "-".repeat(1_000_000)] {
            assert_eq!(value(&text).unwrap_err().message, "nested too deeply");
        }
    }
}
