//! Predicted torques as files, one row per row of the log that they belong to.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use idim::runtime::log::{self, Recording};

use super::Failure;

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

    /// Writes `LOGSTEM_WHAT.csv.gz` with t, tau1.. for each named torque of a log.
    ///
    /// # Errors
    /// [`Failure::Log`] if a file cannot be written.
    pub fn write<'a>(
        &mut self,
        recording: &Recording,
        torques: impl IntoIterator<Item = (&'a str, Vec<Vec<f64>>)>,
    ) -> Result<(), Failure> {
        let count = self.seen.entry(recording.stem.clone()).or_default();
        *count += 1;
        let stem = match *count {
            1 => recording.stem.clone(),
            count => format!("{}-{count}", recording.stem),
        };
        for (what, torque) in torques {
            let rows = torque
                .iter()
                .map(|series| log::onto_stamps(recording, series));
            let rows: Vec<Vec<f64>> = rows.collect();
            let names: Vec<String> = (1..=rows.len())
                .map(|joint| format!("tau{joint}"))
                .collect();
            let mut columns: Vec<(&str, &[f64])> = vec![("t", &recording.stamps)];
            let series = names
                .iter()
                .map(String::as_str)
                .zip(rows.iter().map(Vec::as_slice));
            columns.extend(series);
            log::write(&self.folder.join(format!("{stem}_{what}.csv.gz")), &columns)?;
        }
        Ok(())
    }
}
