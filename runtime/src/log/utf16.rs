//! UTF-16, as spreadsheets save "Unicode text", to UTF-8.

use std::io::{self, BufRead, Read};

/// A reader of UTF-16 that gives UTF-8; what is no character becomes U+FFFD.
pub(super) struct Utf16<R> {
    bytes: R,
    big_endian: bool,
    /// Text that was decoded and not yet read.
    text: Vec<u8>,
    read: usize,
    /// Units that were read and wait for the next one.
    units: Vec<u16>,
    odd: Option<u8>,
}

/// Whether bytes begin like UTF-16, and if so, whether big-endian: a byte order mark, or two ASCII
/// characters.
pub(super) fn detect(bytes: &[u8]) -> Option<bool> {
    match bytes {
        [0xff, 0xfe, ..] => Some(false),
        [0xfe, 0xff, ..] => Some(true),
        [1..0x80, 0, 1..0x80, 0, ..] => Some(false),
        [0, 1..0x80, 0, 1..0x80, ..] => Some(true),
        _ => None,
    }
}

impl<R: BufRead> Utf16<R> {
    pub(super) fn new(bytes: R, big_endian: bool) -> Utf16<R> {
        Utf16 {
            bytes,
            big_endian,
            text: Vec::new(),
            read: 0,
            units: Vec::new(),
            odd: None,
        }
    }

    /// Decodes what the reader holds; nothing at its end.
    fn refill(&mut self) -> io::Result<()> {
        self.text.clear();
        self.read = 0;
        while self.text.is_empty() {
            let bytes = self.bytes.fill_buf()?;
            let (taken, ended) = (bytes.len(), bytes.is_empty());
            for &byte in bytes {
                match self.odd.take() {
                    None => self.odd = Some(byte),
                    Some(first) if self.big_endian => {
                        self.units.push(u16::from_be_bytes([first, byte]));
                    }
                    Some(first) => self.units.push(u16::from_le_bytes([first, byte])),
                }
            }
            self.bytes.consume(taken);
            // Half of a pair waits for the other half.
            let half = self
                .units
                .pop_if(|unit| !ended && (0xd800..0xdc00).contains(unit));
            let text = char::decode_utf16(self.units.drain(..));
            for character in text.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)) {
                let mut utf8 = [0; 4];
                self.text
                    .extend(character.encode_utf8(&mut utf8).as_bytes());
            }
            self.units.extend(half);
            if ended {
                break;
            }
        }
        Ok(())
    }
}

impl<R: BufRead> Read for Utf16<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.read == self.text.len() {
            self.refill()?;
        }
        let mut rest = self.text.get(self.read..).unwrap_or_default();
        let read = rest.read(buffer)?;
        self.read += read;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_in_utf16_of_either_order_is_the_text() {
        let text = "t\tq1 [\u{b0}]\n0,5\t\u{1d465}\n";
        for (big, order) in [
            (true, u16::to_be_bytes as fn(u16) -> [u8; 2]),
            (false, u16::to_le_bytes),
        ] {
            let bytes: Vec<u8> = text.encode_utf16().flat_map(order).collect();
            assert_eq!(detect(&bytes), Some(big));
            // A buffer of three bytes splits units and pairs.
            let reader = io::BufReader::with_capacity(3, &bytes[..]);
            let mut found = String::new();
            Utf16::new(reader, big).read_to_string(&mut found).unwrap();
            assert_eq!(found, text);
        }
        assert_eq!(detect(b"t,q1"), None);
    }
}
