//! Text in stretches of whole lines, so that they can be parsed apart from each other.

use std::io::{self, BufRead, Read};

/// Bytes of text per stretch: large against a line, small enough to stay in the cache and to leave
/// no thread waiting long for the last one.
pub(super) const STRETCH: usize = 1 << 16;

/// Whole lines.
#[derive(Default)]
pub(super) struct Stretch {
    /// Text, and behind it room that is known already.
    bytes: Vec<u8>,
    len: usize,
}

impl Stretch {
    /// The lines.
    pub(super) fn text(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }

    /// Starts anew with these bytes.
    fn begin(&mut self, with: &[u8]) {
        self.len = 0;
        self.room(with.len()).copy_from_slice(with);
        self.len = with.len();
    }

    /// The next bytes.
    fn room(&mut self, len: usize) -> &mut [u8] {
        let end = self.len + len;
        if self.bytes.len() < end {
            self.bytes.resize(end, 0);
        }
        self.bytes.get_mut(self.len..end).unwrap_or_default()
    }

    /// Reads up to `len` bytes more; whether there were as many.
    fn read(&mut self, text: &mut dyn Read, len: usize) -> io::Result<bool> {
        let end = self.len + len;
        while self.len < end {
            match text.read(self.room(end - self.len)) {
                Ok(0) => return Ok(false),
                Ok(read) => self.len += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(true)
    }
}

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
    pub(super) fn fill(&mut self, stretch: &mut Stretch) -> io::Result<()> {
        stretch.begin(&self.rest);
        self.rest.clear();
        let mut outcome = Ok(());
        while !self.ended {
            match stretch.read(&mut self.text, STRETCH) {
                Ok(full) => self.ended = !full,
                Err(error) => {
                    self.ended = true;
                    outcome = Err(error);
                }
            }
            let end = memchr::memrchr(b'\n', stretch.text()).map_or(0, |at| at + 1);
            if outcome.is_err() {
                stretch.len = end;
            } else if end > 0 && !self.ended {
                let rest = stretch.text().get(end..).unwrap_or_default();
                self.rest.extend_from_slice(rest);
                stretch.len = end;
            }
            // Otherwise, a line longer than a stretch.
            if end > 0 {
                break;
            }
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
            let (mut found, mut stretch) = (Vec::new(), Stretch::default());
            loop {
                lines.fill(&mut stretch).unwrap();
                let stretch = stretch.text();
                if stretch.is_empty() {
                    break;
                }
                let last = found.len() + stretch.len() == text.len();
                assert!(last || stretch.ends_with(b"\n"));
                found.extend_from_slice(stretch);
            }
            assert_eq!(found, text.as_bytes());
        }
    }

    /// Gives few bytes at a time, is interrupted, and breaks at the end.
    struct Broken {
        text: io::Cursor<Vec<u8>>,
        calls: usize,
    }

    impl Read for Broken {
        fn read(&mut self, room: &mut [u8]) -> io::Result<usize> {
            self.calls += 1;
            if self.calls.is_multiple_of(3) {
                return Err(io::ErrorKind::Interrupted.into());
            }
            let few = room.len().min(7);
            match self.text.read(&mut room[..few])? {
                0 => Err(io::ErrorKind::UnexpectedEof.into()),
                read => Ok(read),
            }
        }
    }

    #[test]
    fn whole_lines_before_an_error_are_kept_however_few_bytes_come_at_a_time() {
        let whole = "0.001,-1.5\n".repeat(20_000);
        let text = io::Cursor::new(format!("{whole}0.00").into_bytes());
        let broken = Broken { text, calls: 0 };
        let mut lines = Lines::new(Box::new(io::BufReader::with_capacity(5, broken)));
        let (mut found, mut stretch) = (Vec::new(), Stretch::default());
        let error = loop {
            let outcome = lines.fill(&mut stretch);
            found.extend_from_slice(stretch.text());
            match outcome {
                Ok(()) => assert!(!stretch.text().is_empty(), "the error was lost"),
                Err(error) => break error,
            }
        };
        assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
        assert_eq!(found, whole.as_bytes());
        lines.fill(&mut stretch).unwrap();
        assert!(stretch.text().is_empty(), "the text has ended");
    }
}
