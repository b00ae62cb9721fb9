//! Apache Parquet: columns of numbers, row group by row group, a few pages at a time.

use std::fs::File;

use parquet::basic::{LogicalType, TimeUnit};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use rayon::iter::{IntoParallelRefMutIterator, ParallelIterator};

use super::columns::Layout;
use super::error::{Found, Problem};
use super::parse::Parsed;

/// Rows that are read at a time.
const PIECE: usize = 1 << 13;

/// A Parquet file and its columns.
pub(super) struct Content {
    file: SerializedFileReader<File>,
}

impl Content {
    /// Opens a file; the names of its columns come with it.
    pub fn open(file: File) -> Found<(Content, Vec<String>)> {
        let file = SerializedFileReader::new(file).map_err(|error| damaged(0, &error))?;
        let schema = file.metadata().file_metadata().schema_descr();
        let columns = schema.columns().iter();
        let names = columns.map(|column| column.path().string()).collect();
        Ok((Content { file }, names))
    }

    /// Hands the rows on, piece by piece, until nobody wants more.
    pub fn read(&self, layout: &Layout, mut take: impl FnMut(&Parsed) -> Found<bool>) -> Found<()> {
        let mut before = 0;
        for group in 0..self.file.num_row_groups() {
            let rows = self.file.get_row_group(group);
            let rows = rows.map_err(|error| damaged(before, &error))?;
            let mut columns = columns(&*rows, layout, before)?;
            loop {
                let read = |column: &mut Column| column.read();
                let values: Result<Vec<_>, _> = columns.par_iter_mut().map(read).collect();
                let values = values.map_err(|error| damaged(before, &error))?;
                let piece = Parsed::of(values);
                if piece.rows == 0 {
                    break;
                }
                before += piece.rows;
                if !take(&piece)? {
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}

fn damaged(rows: usize, error: &ParquetError) -> Problem {
    Problem::Damaged {
        rows,
        reason: error.to_string(),
    }
}

/// How many bytes of text would hold the same numbers, at twelve each.
pub(super) fn text_size(file: File) -> Option<u64> {
    let file = SerializedFileReader::new(file).ok()?;
    let file = file.metadata().file_metadata();
    let rows = u64::try_from(file.num_rows()).ok()?;
    Some(rows * file.schema_descr().num_columns() as u64 * 12)
}

/// A channel's column in a row group.
struct Column {
    reader: ColumnReader,
    /// The level at which a value is there.
    defined: i16,
    factor: f64,
}

fn columns(rows: &dyn RowGroupReader, layout: &Layout, before: usize) -> Found<Vec<Column>> {
    let schema = rows.metadata().schema_descr();
    let column = |channel: &super::lookup::Channel| {
        let descriptor = schema.column(channel.index);
        let error = || Problem::NoNumbers {
            column: channel.name.clone(),
            holds: descriptor.physical_type().to_string(),
        };
        let reader = rows.get_column_reader(channel.index);
        let reader = reader.map_err(|e| damaged(before, &e))?;
        let numeric = matches!(
            reader,
            ColumnReader::BoolColumnReader(_)
                | ColumnReader::Int32ColumnReader(_)
                | ColumnReader::Int64ColumnReader(_)
                | ColumnReader::FloatColumnReader(_)
                | ColumnReader::DoubleColumnReader(_)
        );
        if !numeric || descriptor.max_rep_level() > 0 {
            return Err(error());
        }
        let unit = unit(&descriptor).ok_or_else(error)?;
        Ok(Column {
            reader,
            defined: descriptor.max_def_level(),
            factor: channel.factor * unit,
        })
    };
    layout.channels.iter().map(column).collect()
}

/// What the numbers of a column count, s for points in time; `None` if they are not what they seem.
fn unit(column: &ColumnDescriptor) -> Option<f64> {
    match column.logical_type_ref() {
        Some(LogicalType::Timestamp(time)) => Some(match time.unit {
            TimeUnit::MILLIS => 1e-3,
            TimeUnit::MICROS => 1e-6,
            TimeUnit::NANOS => 1e-9,
        }),
        None | Some(LogicalType::Integer(_)) => Some(1.0),
        Some(_) => None,
    }
}

impl Column {
    /// The next values; absent ones are NaN.
    fn read(&mut self) -> Result<Vec<f64>, ParquetError> {
        let (defined, factor) = (self.defined, self.factor);
        match &mut self.reader {
            ColumnReader::BoolColumnReader(reader) => {
                read(reader, defined, |v| f64::from(u8::from(v)) * factor)
            }
            ColumnReader::Int32ColumnReader(reader) => {
                read(reader, defined, |v| f64::from(v) * factor)
            }
            ColumnReader::Int64ColumnReader(reader) => read(reader, defined, |v| v as f64 * factor),
            ColumnReader::FloatColumnReader(reader) => {
                read(reader, defined, |v| f64::from(v) * factor)
            }
            ColumnReader::DoubleColumnReader(reader) => read(reader, defined, |v| v * factor),
            _ => Ok(Vec::new()),
        }
    }
}

fn read<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    defined: i16,
    number: impl Fn(T::T) -> f64,
) -> Result<Vec<f64>, ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let mut rows = 0;
    // A call may end with a page.
    while rows < PIECE {
        let levels = (defined > 0).then_some(&mut levels);
        let (read, ..) = reader.read_records(PIECE - rows, levels, None, &mut values)?;
        rows += read;
        if read == 0 {
            break;
        }
    }
    let mut values = values.into_iter().map(number);
    if defined == 0 {
        return Ok(values.collect());
    }
    let present = |level: i16| {
        if level == defined {
            values.next()
        } else {
            None
        }
    };
    Ok(levels
        .into_iter()
        .map(present)
        .map(|value| value.unwrap_or(f64::NAN))
        .collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use parquet::basic::Compression;
    use parquet::data_type::{DoubleType, FloatType, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    use super::super::tests::joints;
    use super::super::{LogSpec, ReadOptions, Recording, read, read_long};
    use crate::settings::Drives;

    const SCHEMA: &str = "message log {
        REQUIRED INT64 t (TIMESTAMP(MICROS, true));
        OPTIONAL DOUBLE q1; REQUIRED FLOAT q2; REQUIRED BYTE_ARRAY note (STRING);
        REQUIRED DOUBLE tau1; REQUIRED DOUBLE tau2;
    }";

    /// 30 000 rows at 1 kHz in three row groups; q1 is absent in two rows.
    fn write(path: &std::path::Path, compression: Compression) {
        let properties = WriterProperties::builder().set_compression(compression);
        let schema = Arc::new(parse_message_type(SCHEMA).unwrap());
        let file = std::fs::File::create(path).unwrap();
        let mut writer =
            SerializedFileWriter::new(file, schema, Arc::new(properties.build())).unwrap();
        for group in 0..3 {
            let rows: Vec<usize> = (group * 10_000..(group + 1) * 10_000).collect();
            let t = |k: &usize| *k as f64 * 1e-3;
            let mut rows_writer = writer.next_row_group().unwrap();
            let mut place = 0;
            while let Some(mut column) = rows_writer.next_column().unwrap() {
                let doubles =
                    |f: &dyn Fn(f64) -> f64| -> Vec<f64> { rows.iter().map(|k| f(t(k))).collect() };
                match place {
                    0 => {
                        let stamps: Vec<i64> = rows.iter().map(|k| *k as i64 * 1000).collect();
                        column.typed::<Int64Type>().write_batch(&stamps, None, None)
                    }
                    1 => {
                        let absent = |k: usize| k == 500 || k == 501;
                        let levels: Vec<i16> =
                            rows.iter().map(|&k| i16::from(!absent(k))).collect();
                        let there = rows.iter().filter(|&&k| !absent(k));
                        let q: Vec<f64> = there.map(|k| (3.0 * t(k)).sin()).collect();
                        column
                            .typed::<DoubleType>()
                            .write_batch(&q, Some(&levels), None)
                    }
                    2 => {
                        let q: Vec<f32> = rows.iter().map(|k| t(k).cos() as f32).collect();
                        column.typed::<FloatType>().write_batch(&q, None, None)
                    }
                    3 => {
                        let notes = vec!["ok".into(); rows.len()];
                        let column = column.typed::<parquet::data_type::ByteArrayType>();
                        column.write_batch(&notes, None, None)
                    }
                    4 => column.typed::<DoubleType>().write_batch(
                        &doubles(&|t| 7.0 * (5.0 * t).sin()),
                        None,
                        None,
                    ),
                    _ => {
                        column
                            .typed::<DoubleType>()
                            .write_batch(&doubles(&|t| t - 1.0), None, None)
                    }
                }
                .unwrap();
                column.close().unwrap();
                place += 1;
            }
            rows_writer.close().unwrap();
        }
        writer.close().unwrap();
    }

    #[test]
    fn log_in_parquet_is_read_by_row_groups_with_every_codec() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("log.parquet");
        let all: Vec<Recording> = [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::GZIP(Default::default()),
            Compression::ZSTD(Default::default()),
        ]
        .map(|compression| {
            write(&path, compression);
            let spec = LogSpec::from(path.clone());
            let (drives, options) = (Drives::default(), ReadOptions::default());
            let long = read_long(&spec, &joints(), &drives, &options).unwrap().0;
            let short = read(&spec, &joints(), &drives, &options).unwrap().0;
            let mut window = long.window(0..long.len).unwrap();
            window.warnings = long.warnings;
            assert_eq!(window, short);
            short
        })
        .to_vec();
        let log = &all[0];
        assert!(all.iter().all(|other| other == log));
        assert_eq!((log.rate_hz, log.len, log.start), (1000.0, 30_000, 0.0));
        assert_eq!(log.q[0][20_000], (3.0 * 20_000.0 * 1e-3_f64).sin());
        assert_eq!(log.q[1][77], f64::from((77.0 * 1e-3_f64).cos() as f32));
        assert!(log.warnings[0].contains("no number in 2 rows (500 to 501)"));
        assert_eq!(log.stamps[12_345], 12_345_000.0 * 1e-6);
    }

    #[test]
    fn log_in_parquet_that_cannot_be_used_says_why() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("log.parquet");
        let message = |companion: &str| {
            std::fs::write(path.with_extension("toml"), companion).unwrap();
            let spec = LogSpec::from(path.clone());
            let found = read(
                &spec,
                &joints(),
                &Drives::default(),
                &ReadOptions::default(),
            );
            found.unwrap_err().to_string()
        };
        write(&path, Compression::SNAPPY);
        let found = message("[columns]\nq1 = { from = 'note' }\n");
        assert!(
            found.contains("column `note` holds BYTE_ARRAY, not numbers"),
            "{found}"
        );
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        let found = message("");
        assert!(found.contains("cannot be read beyond row 0"), "{found}");
    }
}
