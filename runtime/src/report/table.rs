//! Aligned columns of text, and numbers that line up in them.

/// How a column of text is aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Right,
}

/// Rows of cells, rendered with two spaces between columns.
pub(super) struct Table {
    align: Vec<Align>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(align: Vec<Align>) -> Self {
        Table {
            align,
            rows: Vec::new(),
        }
    }

    /// Adds a row; missing cells are empty.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Width of each column.
    fn widths(&self) -> Vec<usize> {
        let cell = |row: &Vec<String>, k: usize| row.get(k).map_or(0, |cell| cell.chars().count());
        (0..self.align.len())
            .map(|k| self.rows.iter().map(|row| cell(row, k)).max().unwrap_or(0))
            .collect()
    }

    /// Renders all rows, none longer than `limit` characters.
    pub fn render(&self, limit: usize) -> String {
        let widths = self.widths();
        let mut text = String::new();
        for row in &self.rows {
            let cells = self.align.iter().zip(&widths).enumerate();
            let line: Vec<String> = cells
                .map(|(k, (align, width))| {
                    let cell = row.get(k).map_or("", String::as_str);
                    match align {
                        Align::Left => format!("{cell:<width$}"),
                        Align::Right => format!("{cell:>width$}"),
                    }
                })
                .collect();
            text.push_str(&shorten(line.join("  ").trim_end(), limit));
            text.push('\n');
        }
        text
    }
}

/// Cuts a text to at most `limit` characters, the last of them then being an ellipsis.
pub(super) fn shorten(text: &str, limit: usize) -> String {
    match text.chars().count() <= limit {
        true => text.to_owned(),
        false => text
            .chars()
            .take(limit.saturating_sub(1))
            .chain(['\u{2026}'])
            .collect(),
    }
}

/// A number with that many significant digits: fixed point where it is short, else with an
/// exponent.
pub(super) fn significant(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return "-".to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    // Rounding may carry into another decade, so the exponent is read from the rounded number.
    let rounded = format!("{x:.*e}", digits.saturating_sub(1));
    let exponent = rounded
        .split_once('e')
        .and_then(|(_, e)| e.parse::<i32>().ok())
        .unwrap_or(0);
    match exponent {
        -4..=5 => {
            let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
            format!("{x:.decimals$}")
        }
        _ => rounded,
    }
}

/// [`significant`], or a dash where there is no number.
pub(super) fn optional(x: Option<f64>, digits: usize) -> String {
    x.map_or_else(|| "-".to_owned(), |x| significant(x, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        let cases = [
            (3.503755, "3.5038"),
            (-0.0498099, "-0.049810"),
            (203.5034, "203.50"),
            (123456.7, "123457"),
            (1234567.8, "1.2346e6"),
            (9.99999, "10.000"),
            (1.0e-7, "1.0000e-7"),
            (0.0, "0"),
            (f64::NAN, "-"),
        ];
        for (x, text) in cases {
            assert_eq!(significant(x, 5), text);
        }
        assert_eq!(optional(None, 3), "-");
    }

    #[test]
    fn columns_line_up_and_lines_end_at_the_limit() {
        let mut table = Table::new(vec![Align::Left, Align::Right, Align::Left]);
        table.row(vec!["a".into(), "1".into(), "x".into()]);
        table.row(vec!["long".into(), "22.5".into(), "a relation".into()]);
        table.row(vec!["b".into()]);
        assert_eq!(
            table.render(16),
            "a        1  x\nlong  22.5  a r\u{2026}\nb\n"
        );
    }
}
