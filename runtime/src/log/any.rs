//! A log wherever its samples are.

use std::ops::Range;

use super::{Companion, LogError, LogSpec, LongLog, ReadOptions, Recording, Samples};
use crate::model::Joint;
use crate::settings::Drives;

/// A part with no more samples than this is held in memory, however long its file.
const HELD: usize = 150_000;

/// A log in memory, or one that stays on disk.
#[derive(Debug)]
pub enum Log {
    /// In memory.
    Held(Recording),
    /// On disk.
    Long(LongLog),
}

impl Log {
    /// Reads a log, or a part of it, into memory if it is short enough.
    ///
    /// # Errors
    /// Those of [`super::read()`] and [`super::read_long`].
    pub fn read(
        spec: &LogSpec,
        joints: &[Joint],
        drives: &Drives,
        options: &ReadOptions,
    ) -> Result<(Log, Companion), LogError> {
        if !super::is_long(spec) {
            let (recording, companion) = super::read(spec, joints, drives, options)?;
            return Ok((Log::Held(recording), companion));
        }
        let (long, companion) = super::read_long(spec, joints, drives, options)?;
        match long.len > HELD {
            true => Ok((Log::Long(long), companion)),
            false => {
                let mut recording = long.window(0..long.len)?;
                recording.warnings = long.warnings;
                Ok((Log::Held(recording), companion))
            }
        }
    }

    /// The first `samples` samples.
    ///
    /// # Errors
    /// [`LogError`] if they cannot be read from where they are kept.
    pub fn beginning(&self, samples: usize) -> Result<Recording, LogError> {
        self.source().window(0..samples)
    }

    fn source(&self) -> &dyn Samples {
        match self {
            Log::Held(recording) => recording,
            Log::Long(long) => long,
        }
    }
}

impl Samples for Log {
    fn name(&self) -> &str {
        self.source().name()
    }

    fn rate_hz(&self) -> f64 {
        self.source().rate_hz()
    }

    fn len(&self) -> usize {
        self.source().len()
    }

    fn doubtful(&self) -> &[Range<usize>] {
        self.source().doubtful()
    }

    fn ranges(&self) -> Option<&[(f64, f64)]> {
        self.source().ranges()
    }

    fn warnings(&self) -> &[String] {
        self.source().warnings()
    }

    fn window(&self, range: Range<usize>) -> Result<Recording, LogError> {
        self.source().window(range)
    }
}
