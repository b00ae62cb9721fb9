//! Reading and writing at a place of a file, from several threads at once.

use std::fs::File;
use std::io;

/// Fills `bytes` from the byte `at` of the file on.
#[cfg(unix)]
pub(super) fn read(file: &File, at: u64, bytes: &mut [u8]) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, at)
}

/// Writes `bytes` from the byte `at` of the file on.
#[cfg(unix)]
pub(super) fn write(file: &File, at: u64, bytes: &[u8]) -> io::Result<()> {
    std::os::unix::fs::FileExt::write_all_at(file, bytes, at)
}

/// Where a file has one position for all, one thread after the other moves it.
#[cfg(not(unix))]
static POSITION: std::sync::Mutex<()> = std::sync::Mutex::new(());

/// Fills `bytes` from the byte `at` of the file on.
#[cfg(not(unix))]
pub(super) fn read(mut file: &File, at: u64, bytes: &mut [u8]) -> io::Result<()> {
    use std::io::{Read, Seek, SeekFrom};
    let _alone = POSITION
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(bytes)
}

/// Writes `bytes` from the byte `at` of the file on.
#[cfg(not(unix))]
pub(super) fn write(mut file: &File, at: u64, bytes: &[u8]) -> io::Result<()> {
    use std::io::{Seek, SeekFrom, Write};
    let _alone = POSITION
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    file.seek(SeekFrom::Start(at))?;
    file.write_all(bytes)
}
