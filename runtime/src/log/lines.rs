//! Text in stretches of whole lines, so that they can be parsed apart from each other.

use std::io::{self, BufRead, Read};

/// Bytes of text per stretch: large against a line, small enough to stay in the cache.
pub(super) const STRETCH: usize = 1 << 17;

/// A reader that ends its stretches behind line feeds.
pub(super) struct Lines {
    text: Box<dyn BufRead + Send>,
    /// The beginning of a line that the last stretch left over.
    rest: Vec<u8>,
    ended: bool,
}

impl Lines {
    pub(super) fn new(text: Box<dyn BufRead + Send>) -> Lines {
        Lines {
            text,
            rest: Vec::new(),
            ended: false,
        }
    }

    /// Fills `stretch` with whole lines; nothing is left when it stays empty. After an error, the
    /// stretch holds the whole lines before it, and the text has ended.
    pub(super) fn fill(&mut self, stretch: &mut Vec<u8>) -> io::Result<()> {
        stretch.clear();
        stretch.append(&mut self.rest);
        let mut outcome = Ok(());
        let mut wanted = STRETCH;
        while !self.ended {
            let missing = wanted.saturating_sub(stretch.len()).max(1);
            match self.text.by_ref().take(missing as u64).read_to_end(stretch) {
                Ok(read) => self.ended = read < missing,
                Err(error) => {
                    self.ended = true;
                    outcome = Err(error);
                }
            }
            let end = memchr::memrchr(b'\n', stretch).map_or(0, |at| at + 1);
            if outcome.is_err() {
                stretch.truncate(end);
            } else if end > 0 && !self.ended {
                self.rest.extend_from_slice(&stretch[end..]);
                stretch.truncate(end);
                break;
            }
            // A line longer than a stretch.
            wanted = stretch.len() + STRETCH;
        }
        outcome
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_end_with_lines_and_together_are_the_text() {
        for (line, count) in [(13, 40_000), (300_000, 3), (1, 300_000)] {
            let text = format!("{}\n", "x".repeat(line - 1)).repeat(count) + "tail";
            let mut lines = Lines::new(Box::new(io::Cursor::new(text.clone().into_bytes())));
            let (mut found, mut stretch) = (Vec::new(), Vec::new());
            loop {
                lines.fill(&mut stretch).unwrap();
                if stretch.is_empty() {
                    break;
                }
                let last = found.len() + stretch.len() == text.len();
                assert!(last || stretch.ends_with(b"\n"));
                found.extend_from_slice(&stretch);
            }
            assert_eq!(found, text.as_bytes());
        }
    }
}
