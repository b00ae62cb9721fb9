//! Predicted torques as files, one row per row of the log that they belong to.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use idim::runtime::log::{self, Recording};

use super::Failure;

/// Series of all joints with the name that they share.
pub type Named = (&'static str, Vec<Vec<f64>>);

/// A folder of predictions. Two parts of one file do not overwrite each other: the second has a
/// number.
pub struct Predictions {
    folder: PathBuf,
    seen: HashMap<String, usize>,
}

impl Predictions {
    /// Makes the folder.
    ///
    /// # Errors
    /// [`Failure::Write`].
    pub fn new(folder: &Path) -> Result<Self, Failure> {
        std::fs::create_dir_all(folder).map_err(|source| Failure::Write {
            path: folder.to_owned(),
            source,
        })?;
        Ok(Predictions {
            folder: folder.to_owned(),
            seen: HashMap::new(),
        })
    }

    /// Writes `LOGSTEM_WHAT.csv.gz` for each of some predictions of a log: t, then the series of
    /// every joint under each name (`tau`, `q`).
    ///
    /// # Errors
    /// [`Failure::Log`] if a file cannot be written.
    pub fn write<'a>(
        &mut self,
        recording: &Recording,
        predictions: impl IntoIterator<Item = (&'a str, Vec<Named>)>,
    ) -> Result<(), Failure> {
        let count = self.seen.entry(recording.stem.clone()).or_default();
        *count += 1;
        let stem = match *count {
            1 => recording.stem.clone(),
            count => format!("{}-{count}", recording.stem),
        };
        for (what, series) in predictions {
            let mut rows: Vec<(String, Vec<f64>)> = Vec::new();
            for (name, joints) in series {
                let own = joints.iter().enumerate();
                rows.extend(own.map(|(joint, series)| {
                    let name = format!("{name}{}", joint + 1);
                    (name, log::onto_stamps(recording, series))
                }));
            }
            let mut columns: Vec<(&str, &[f64])> = vec![("t", &recording.stamps)];
            columns.extend(
                rows.iter()
                    .map(|(name, row)| (name.as_str(), row.as_slice())),
            );
            log::write(&self.folder.join(format!("{stem}_{what}.csv.gz")), &columns)?;
        }
        Ok(())
    }
}
