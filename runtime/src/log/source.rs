//! From a path to lines of text: gzip, text encoding and separator are recognised from the content.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::error::{Found, Problem};
use super::parse::{Fields, unquoted};

/// A first line longer than this is no header, bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Bytes per read: large enough that inflating and splitting run in long stretches.
const BUFFER: usize = 1 << 17;

/// An open log behind its header.
pub(super) struct Source {
    /// Column names, trimmed.
    pub header: Vec<String>,
    /// What separates the fields.
    pub separator: u8,
    /// Lines that the header took; the reader counts from the line after.
    pub header_lines: u64,
    /// The lines behind the header.
    pub text: Box<dyn BufRead + Send>,
}

/// Opens a log and reads its header.
pub(super) fn open(path: &Path) -> Found<Source> {
    let extension = path.extension().map_or_else(String::new, |e| {
        e.to_ascii_lowercase().to_string_lossy().into_owned()
    });
    match extension.as_str() {
        "parquet" => return Err(Problem::Format("Parquet")),
        "mcap" => return Err(Problem::Format("MCAP")),
        "mat" => return Err(Problem::Format("MATLAB")),
        _ => {}
    }
    let file = File::open(path).map_err(Problem::Open)?;
    if file.metadata().map_err(Problem::Open)?.is_dir() {
        return Err(Problem::Directory);
    }
    read(Box::new(BufReader::with_capacity(BUFFER, file)))
}

/// The same on any bytes.
pub(super) fn read(mut bytes: Box<dyn BufRead + Send>) -> Found<Source> {
    let gzip = bytes
        .fill_buf()
        .map_err(Problem::Open)?
        .starts_with(&[0x1f, 0x8b]);
    let mut text: Box<dyn BufRead + Send> = if gzip {
        Box::new(BufReader::with_capacity(BUFFER, MultiGzDecoder::new(bytes)))
    } else {
        bytes
    };
    let (line, header_lines) = first_line(&mut text)?;
    let separator = separator(&line);
    let header = names(&line, separator)?;
    Ok(Source {
        header,
        separator,
        header_lines,
        text,
    })
}

/// The first line that is not blank, and how many lines were read up to it.
fn first_line(text: &mut dyn BufRead) -> Found<(String, u64)> {
    let mut lines = 0;
    loop {
        let mut line = Vec::new();
        let read = text.take(LONGEST_HEADER).read_until(b'\n', &mut line);
        read.map_err(|e| Problem::Damaged {
            rows: 0,
            reason: e.to_string(),
        })?;
        if line.is_empty() {
            return Err(Problem::Empty);
        }
        lines += 1;
        let line = decode(&line)?;
        // NumPy writes its header as a comment.
        let line = line
            .trim_start_matches('\u{feff}')
            .trim()
            .trim_start_matches('#')
            .trim();
        if !line.is_empty() {
            return Ok((line.to_owned(), lines));
        }
    }
}

fn decode(line: &[u8]) -> Found<&str> {
    if line.starts_with(&[0xff, 0xfe]) || line.starts_with(&[0xfe, 0xff]) {
        return Err(Problem::NotText("it begins like UTF-16"));
    }
    if line.contains(&0) {
        return Err(Problem::NotText("its first line holds zero bytes"));
    }
    if line.len() as u64 == LONGEST_HEADER {
        return Err(Problem::NotText("its first line does not end"));
    }
    std::str::from_utf8(line).map_err(|_| Problem::NotText("its first line is not UTF-8"))
}

/// The separator that splits the header most often; a comma where none does.
fn separator(header: &str) -> u8 {
    let count = |of: u8| header.bytes().filter(|&b| b == of).count();
    let mut best = b',';
    for candidate in [b';', b'\t'] {
        if count(candidate) > count(best) {
            best = candidate;
        }
    }
    best
}

fn names(line: &str, separator: u8) -> Found<Vec<String>> {
    let names: Vec<String> = Fields::of(line.as_bytes(), separator)
        .map(|field| {
            let (name, quoted) = unquoted(line.as_bytes().get(field).unwrap_or_default());
            let name = String::from_utf8_lossy(name);
            if quoted {
                name.replace("\"\"", "\"")
            } else {
                name.into_owned()
            }
        })
        .collect();
    if names
        .iter()
        .all(|name| name.is_empty() || name.parse::<f64>().is_ok())
    {
        return Err(Problem::NoHeader(line.chars().take(60).collect()));
    }
    Ok(names)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn header(bytes: &[u8]) -> Found<Vec<String>> {
        read(Box::new(Cursor::new(bytes.to_vec()))).map(|source| source.header)
    }

    #[test]
    fn header_with_bom_spaces_and_any_separator_is_found() {
        for text in [
            "\u{feff}t, q1 ,tau1\r\n0,1,2\r\n",
            "t;q1;tau1\n0;1;2\n",
            "t\tq1\ttau1\n",
            "# t, q1, tau1\n",
            "\n\r\n\"t\",\"q1\",\"tau1\"",
        ] {
            assert_eq!(
                header(text.as_bytes()).unwrap(),
                ["t", "q1", "tau1"],
                "{text:?}"
            );
        }
    }

    #[test]
    fn file_that_is_no_log_says_what_it_is_instead() {
        for (bytes, part_of_message) in [
            (&b""[..], "is empty"),
            (b"\n\n", "is empty"),
            (b"\xff\xfet\0,\0", "UTF-16"),
            (b"\x7fELF\x02\0\0", "zero bytes"),
            (b"t,\xe9\n", "not UTF-8"),
            (b"0.0,1.0\n", "holds numbers"),
        ] {
            let message = header(bytes).unwrap_err().to_string();
            assert!(message.contains(part_of_message), "{message}");
        }
        assert!(
            header(&[b'x'; 2 << 20])
                .unwrap_err()
                .to_string()
                .contains("does not end")
        );
    }

    #[test]
    fn gzip_is_recognised_by_its_content() {
        use std::io::Write;
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        gz.write_all(b"t,q1\n0,1\n").unwrap();
        let bytes = gz.finish().unwrap();
        assert_eq!(header(&bytes).unwrap(), ["t", "q1"]);
        let message = header(&bytes[..12]).unwrap_err().to_string();
        assert!(message.contains("cannot be read"), "{message}");
    }
}
