//! Columns of numbers into a CSV file, plain or gzip, all or nothing.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::error::LogError;
use crate::whole::Whole;

/// Writes named columns, such as `t, tau1, tau2`, as CSV; compressed if the path ends in `.gz`.
///
/// Every number reads back as the same `f64`. The file appears whole or not at all: it is written
/// beside its place and renamed. Equal columns give equal bytes.
///
/// # Errors
/// [`LogError::UnequalColumns`] if the columns differ in length, [`LogError::Write`] if the
/// directory is missing or not writable, the disk full, ...
pub fn write(path: &Path, columns: &[(&str, &[f64])]) -> Result<(), LogError> {
    let file = || path.display().to_string();
    let (first, rows) = columns
        .first()
        .map_or(("", 0), |(name, values)| (*name, values.len()));
    if let Some((column, values)) = columns.iter().find(|(_, values)| values.len() != rows) {
        return Err(LogError::UnequalColumns {
            file: file(),
            column: (*column).to_owned(),
            found: values.len(),
            first: first.to_owned(),
            expected: rows,
        });
    }
    replace(path, |out| rows_to(out, columns, rows)).map_err(|source| LogError::Write {
        file: file(),
        source,
    })
}

fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, Whole::begin(path)?);
    if path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("gz"))
    {
        // Digits of measurements hardly compress: more effort buys a few percent.
        let mut gzip = BufWriter::with_capacity(1 << 16, GzEncoder::new(out, Compression::fast()));
        content(&mut gzip)?;
        out = gzip
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?
            .finish()?;
    } else {
        content(&mut out)?;
    }
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.place()
}

fn rows_to(out: &mut dyn Write, columns: &[(&str, &[f64])], rows: usize) -> io::Result<()> {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in 0..rows {
        for (i, (_, values)) in columns.iter().enumerate() {
            if i > 0 {
                out.write_all(b",")?;
            }
            number(out, values.get(row).copied().unwrap_or(f64::NAN))?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// The shortest digits that read back as the same number.
fn number(out: &mut dyn Write, value: f64) -> io::Result<()> {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e9).contains(&size) || !size.is_finite() {
        write!(out, "{value}")
    } else {
        write!(out, "{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn columns_written_read_back_as_the_same_numbers() {
        let dir = tempfile::tempdir().unwrap();
        let t = [0.0, 0.001, 1.0 / 3.0, -0.0];
        let tau = [f64::MIN_POSITIVE, -1e300, 12.5, 1e-7];
        for name in ["out.csv", "out.csv.gz"] {
            let path = dir.path().join(name);
            write(&path, &[("t", &t), ("tau1", &tau)]).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let mut text = String::new();
            if name.ends_with("gz") {
                flate2::read::GzDecoder::new(&bytes[..])
                    .read_to_string(&mut text)
                    .unwrap();
            } else {
                text = String::from_utf8(bytes).unwrap();
            }
            let mut lines = text.lines();
            assert_eq!(lines.next(), Some("t,tau1"));
            for (k, line) in lines.enumerate() {
                let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
                assert_eq!(values, [t[k], tau[k]]);
            }
        }
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 2);
    }

    #[test]
    fn columns_of_unequal_length_are_refused_and_nothing_is_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("out.csv");
        let error = write(&path, &[("t", &[0.0, 1.0]), ("tau1", &[1.0])]).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("column `tau1` has 1 rows, `t` has 2"),
            "{error}"
        );
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn path_in_a_missing_directory_is_named() {
        let error = write(Path::new("no/such/out.csv"), &[("t", &[0.0])])
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("no/such/out.csv: cannot be written"),
            "{error}"
        );
    }

    #[test]
    fn file_written_twice_has_the_same_bytes() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("out.csv.gz");
        let bytes = || {
            write(&path, &[("t", &[0.0, 0.5])]).unwrap();
            std::fs::read(&path).unwrap()
        };
        assert_eq!(bytes(), bytes());
    }
}
