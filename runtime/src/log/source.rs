//! From a path to lines of text: gzip, text encoding, comments and separator are recognised from the content.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::error::{Found, Problem};
use super::parse::{Fields, unquoted};
use super::utf16::{self, Utf16};

/// A first line longer than this is no header, bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Bytes per read: those of a stretch, which a buffer that is not larger lets through without a copy.
const BUFFER: usize = super::lines::STRETCH;

/// An open log behind its header.
pub(super) struct Source {
    /// Column names, trimmed.
    pub header: Vec<String>,
    /// Line of the file in which the data begin, counted from 1.
    pub first_line: u64,
    /// The data.
    pub content: Content,
}

/// The data of a log.
pub(super) enum Content {
    Text(Text),
    #[cfg(feature = "parquet")]
    Parquet(super::parquet::Content),
}

/// Lines of text.
pub(super) struct Text {
    /// What separates the fields.
    pub separator: u8,
    /// The lines behind the header.
    pub lines: Box<dyn BufRead + Send>,
}

/// Opens a log and reads its header.
pub(super) fn open(path: &Path) -> Found<Source> {
    let extension = path.extension().map_or_else(String::new, |e| {
        e.to_ascii_lowercase().to_string_lossy().into_owned()
    });
    match extension.as_str() {
        "mcap" => return Err(Problem::Format("MCAP")),
        "mat" => return Err(Problem::Format("MATLAB")),
        _ => {}
    }
    let file = File::open(path).map_err(Problem::Open)?;
    if file.metadata().map_err(Problem::Open)?.is_dir() {
        return Err(Problem::Directory);
    }
    let mut file = BufReader::with_capacity(BUFFER, file);
    let begins = file.fill_buf().map_err(Problem::Open)?;
    if extension == "parquet" || begins.starts_with(b"PAR1") {
        return parquet(file.into_inner());
    }
    read(Box::new(file))
}

#[cfg(feature = "parquet")]
fn parquet(file: File) -> Found<Source> {
    let (content, header) = super::parquet::Content::open(file)?;
    Ok(Source {
        header,
        first_line: 1,
        content: Content::Parquet(content),
    })
}

#[cfg(not(feature = "parquet"))]
fn parquet(_file: File) -> Found<Source> {
    Err(Problem::NotBuiltIn {
        format: "Parquet",
        feature: "parquet",
    })
}

/// The same on any bytes.
pub(super) fn read(mut bytes: Box<dyn BufRead + Send>) -> Found<Source> {
    if peek(&mut bytes)?.starts_with(&[0x1f, 0x8b]) {
        let inflated = MultiGzDecoder::new(bytes);
        bytes = Box::new(BufReader::with_capacity(BUFFER, inflated));
    }
    if let Some(big_endian) = utf16::detect(peek(&mut bytes)?) {
        let utf8 = Utf16::new(bytes, big_endian);
        bytes = Box::new(BufReader::with_capacity(BUFFER, utf8));
    }
    let header = Header::read(&mut bytes)?;
    let separator = header.separator.unwrap_or_else(|| separator(&header.line));
    let lines: Box<dyn BufRead + Send> = if header.behind.is_empty() {
        bytes
    } else {
        Box::new(Cursor::new(header.behind).chain(bytes))
    };
    Ok(Source {
        header: names(&header.line, separator)?,
        first_line: header.first_line,
        content: Content::Text(Text { separator, lines }),
    })
}

fn peek(bytes: &mut dyn BufRead) -> Found<&[u8]> {
    bytes.fill_buf().map_err(|error| damaged(&error))
}

fn damaged(error: &io::Error) -> Problem {
    Problem::Damaged {
        rows: 0,
        reason: error.to_string(),
    }
}

/// The line with the column names.
#[derive(Default)]
struct Header {
    line: String,
    /// What a line `sep=;`, as spreadsheets write it, says.
    separator: Option<u8>,
    /// Line of the file in which the data begin, counted from 1.
    first_line: u64,
    /// A data line that was read already.
    behind: Vec<u8>,
}

impl Header {
    /// The first line that is no comment. Where that holds numbers, the last comment holds the
    /// names: so NumPy and MATLAB write them.
    fn read(text: &mut dyn BufRead) -> Found<Header> {
        let mut header = Header::default();
        let mut comment = None;
        loop {
            let mut bytes = Vec::new();
            let read = text.take(LONGEST_HEADER).read_until(b'\n', &mut bytes);
            read.map_err(|error| damaged(&error))?;
            header.first_line += 1;
            let line = if comment.is_some() && bytes.is_empty() {
                ""
            } else if bytes.is_empty() {
                return Err(Problem::Empty);
            } else {
                &decode(&bytes)?
            };
            let line = line.trim_start_matches('\u{feff}').trim();
            let said = line.trim_start_matches(['#', '%']).trim();
            if said.len() < line.len() {
                comment = Some(said.to_owned())
                    .filter(|said| !said.is_empty())
                    .or(comment);
            } else if let Some(said) = line.strip_prefix("sep=").filter(|s| s.len() == 1) {
                header.separator = said.bytes().next();
            } else if let Some(comment) = comment.take_if(|_| line.is_empty() || numeric(line)) {
                header.line = comment;
                header.behind = bytes;
                return Ok(header);
            } else if !line.is_empty() {
                header.line = line.to_owned();
                header.first_line += 1;
                return Ok(header);
            }
        }
    }
}

/// Whether a line holds numbers and no names.
fn numeric(line: &str) -> bool {
    let mut fields = line
        .split([',', ';', '\t', ' '])
        .map(|field| field.trim_matches('"'));
    fields.all(|field| field.is_empty() || field.parse::<f64>().is_ok())
}

/// A line of UTF-8, or else of Latin-1.
fn decode(line: &[u8]) -> Found<Cow<'_, str>> {
    if line.contains(&0) {
        return Err(Problem::NotText("its first line holds zero bytes"));
    }
    if line.len() as u64 == LONGEST_HEADER {
        return Err(Problem::NotText("its first line does not end"));
    }
    if let Ok(text) = std::str::from_utf8(line) {
        return Ok(Cow::Borrowed(text));
    }
    // In Latin-1, these bytes are no characters; in a binary file, they are frequent.
    if line.iter().any(|byte| (0x80..0xa0).contains(byte)) {
        return Err(Problem::NotText(
            "its first line is neither UTF-8 nor Latin-1",
        ));
    }
    Ok(Cow::Owned(
        line.iter().map(|&byte| char::from(byte)).collect(),
    ))
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
            "# made on Monday\n#\n# t, q1, tau1\n0,1,2\n",
            "% made on Monday\nt,q1,tau1\n0,1,2\n",
            "%t,q1,tau1\n\n",
            "sep=;\nt;q1;tau1\n",
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
            (b"\x7fELF\x02\0\0", "zero bytes"),
            (b"t,\x89\n", "neither UTF-8 nor Latin-1"),
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
