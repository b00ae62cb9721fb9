//! The evidence file: documented, versioned, checked.
//!
//! All numbers are little-endian; `f64` keep their bits; a text is a `u32` length and UTF-8.
//!
//! | bytes | content |
//! | --- | --- |
//! | 8 | `IDIMEV\r\n`, which a transfer as text would change |
//! | 4 | version of the format, `u32`: 1 |
//! | 8 | length of the content, `u64` |
//! | .. | content |
//! | 8 | CRC-64/XZ of all bytes before, `u64` |
//!
//! Content: robot (text); model (`u8`: 0 explicit, 1 implicit, 2 power); number np of parameters
//! (`u32`); fingerprint of the description (`u64`); number of columns (`u32`) and their names
//! (texts), np parameters first; number of joints (`u32`) and for each the number of columns that
//! it sees (`u32`) and these columns (`u32` each, ascending, from 0); number of time blocks
//! (`u32`); then for each block, for each joint: number of rows (`u64`) and the factor of
//! `[W | candidates | Y]`, n = columns seen + 1, its `n (n + 1) / 2` entries row by row, each from
//! the diagonal on (`f64`).

use std::io::Write;
use std::path::Path;

use super::bytes::{self, Reader};
use super::checksum::Checksum;
use super::error::FormatError;
use super::{Evidence, EvidenceError};
use crate::whole::Whole;

const MAGIC: &[u8; 8] = b"IDIMEV\r\n";

/// Version of the format that is written and read.
pub const VERSION: u32 = 1;

/// Bytes around the content: magic, version, length, checksum.
const FRAME: u64 = 8 + 4 + 8 + 8;

impl Evidence {
    /// The bytes of an evidence file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let content = bytes::write(self);
        let mut file = Vec::with_capacity(content.len() + FRAME as usize);
        file.extend(MAGIC);
        file.extend(VERSION.to_le_bytes());
        file.extend((content.len() as u64).to_le_bytes());
        file.extend(content);
        file.extend(Checksum::of(&file).to_le_bytes());
        file
    }

    /// Reads the bytes of an evidence file; `name` is for messages.
    ///
    /// # Errors
    /// [`EvidenceError::File`]: bytes that are no evidence, another version, cut off, damaged or
    /// contradicting themselves.
    pub fn from_bytes(bytes: &[u8], name: &str) -> Result<Self, EvidenceError> {
        let content = content(bytes).and_then(bytes::read);
        content.map_err(|source| EvidenceError::File {
            name: name.to_owned(),
            source,
        })
    }

    /// Writes an evidence file, completely or not at all.
    ///
    /// # Errors
    /// [`EvidenceError::Io`].
    pub fn save(&self, path: &Path) -> Result<(), EvidenceError> {
        let fail = |source| EvidenceError::Io {
            path: path.to_owned(),
            source,
        };
        let mut file = Whole::begin(path).map_err(fail)?;
        file.write_all(&self.to_bytes()).map_err(fail)?;
        file.sync().map_err(fail)?;
        file.place().map_err(fail)
    }

    /// Reads an evidence file.
    ///
    /// # Errors
    /// [`EvidenceError::Io`], and those of [`Evidence::from_bytes`].
    pub fn load(path: &Path) -> Result<Self, EvidenceError> {
        let bytes = std::fs::read(path).map_err(|source| EvidenceError::Io {
            path: path.to_owned(),
            source,
        })?;
        Evidence::from_bytes(&bytes, &path.display().to_string())
    }
}

/// Takes the frame off: what is between the length and the checksum.
fn content(file: &[u8]) -> Result<&[u8], FormatError> {
    let has = file.len() as u64;
    let start = &file[..file.len().min(MAGIC.len())];
    if !MAGIC.starts_with(start) {
        return Err(FormatError::NotEvidence);
    }
    let cut = |needs| FormatError::Cut { has, needs };
    let mut reader = Reader::new(file);
    reader.take(MAGIC.len()).ok_or(cut(FRAME))?;
    let found = reader.u32().ok_or(cut(FRAME))?;
    if found != VERSION {
        return Err(FormatError::Version {
            found,
            known: VERSION,
        });
    }
    let needs = reader.u64().ok_or(cut(FRAME))?.saturating_add(FRAME);
    if has < needs {
        return Err(cut(needs));
    }
    if has > needs {
        return Err(FormatError::Trailing { extra: has - needs });
    }
    let content = reader.take((needs - FRAME) as usize).ok_or(cut(needs))?;
    let sum = reader.u64().ok_or(cut(needs))?;
    match Checksum::of(&file[..file.len() - 8]) == sum {
        true => Ok(content),
        false => Err(FormatError::Damaged),
    }
}
