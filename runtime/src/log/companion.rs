//! The log companion: what a log cannot say about itself, in a TOML file beside it.
//!
//! It is parsed and checked for structure here; what it says about columns is applied by the
//! reader, reference and controller are kept for the closed-loop simulation.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::closed_loop::{Controller, RawController, Reference};
use super::error::LogError;
use super::naming::{Family, Q, QM};
use super::reference::RawReference;
use crate::model::Joint;

/// Where a column comes from: `q1 = { from = "pos_shoulder", unit = "deg", gain = -1.0 }`.
///
/// The value used is `gain * unit * field`; a drive gain comes on top for `i` and `u` columns.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnSource {
    /// Name in the log's header; absent: the key itself.
    pub from: Option<String>,
    /// Unit in the log, such as `deg`, `mm`, `ms`, `deg/s`, `mN.m`; absent: the one in the
    /// header (`q1 [deg]`), else SI.
    pub unit: Option<String>,
    /// Factor on the value after the unit; absent: 1.
    pub gain: Option<f64>,
}

/// What lies beside a log. An absent companion is `Companion::default()`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Companion {
    /// The file it was read from, if there is one.
    pub path: Option<PathBuf>,
    /// Sampling rate, Hz; absent: from the stamps.
    pub rate_hz: Option<f64>,
    /// Encoder resolution seen at the joint, rad (or m).
    pub encoder_resolution: Option<f64>,
    /// Columns with other names, units or gains, by canonical name (`t`, `q1`, `tau_elbow`, ...).
    pub columns: BTreeMap<String, ColumnSource>,
    /// The commanded motion.
    pub reference: Option<Reference>,
    /// The controller that the log was made with.
    pub controller: Option<Controller>,
    /// Where the keys of `columns` stand: line and column, for messages.
    pub(super) places: BTreeMap<String, (usize, usize)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    rate_hz: Option<Spanned<f64>>,
    encoder_resolution: Option<Spanned<f64>>,
    #[serde(default)]
    columns: BTreeMap<Spanned<String>, Spanned<ColumnSource>>,
    reference: Option<RawReference>,
    controller: Option<RawController>,
}

/// A mistake and the bytes of the file that it stands in.
pub(super) type Mistake = (std::ops::Range<usize>, String);

impl Companion {
    /// Reads a companion, or a trajectory file (the same `[reference]` table).
    ///
    /// # Errors
    /// [`LogError::CompanionFile`] if the file cannot be read, [`LogError::Companion`] with file,
    /// line and column for malformed TOML, an unknown key, a wrong type or an impossible value.
    pub fn load(path: &Path) -> Result<Companion, LogError> {
        let text = std::fs::read_to_string(path).map_err(|source| LogError::CompanionFile {
            file: path.display().to_string(),
            source,
        })?;
        let parsed = Companion::parse(&text).map_err(|(span, message)| {
            let (line, column) = position(&text, span.start);
            LogError::Companion {
                file: path.display().to_string(),
                line,
                column,
                message,
            }
        })?;
        Ok(Companion {
            path: Some(path.to_owned()),
            ..parsed
        })
    }

    pub(crate) fn parse(text: &str) -> Result<Companion, Mistake> {
        let raw: Raw = toml::from_str(text).map_err(|error| {
            (
                error.span().unwrap_or_default(),
                error.message().trim().to_owned(),
            )
        })?;
        let (columns, places) = columns(text, raw.columns)?;
        Ok(Companion {
            path: None,
            rate_hz: raw
                .rate_hz
                .map(|rate| positive("rate_hz", rate))
                .transpose()?,
            encoder_resolution: raw
                .encoder_resolution
                .map(|step| positive("encoder_resolution", step))
                .transpose()?,
            columns,
            reference: raw.reference.map(RawReference::check).transpose()?,
            controller: raw.controller.map(RawController::check).transpose()?,
            places,
        })
    }

    /// The file, for messages.
    pub(super) fn file(&self) -> String {
        self.path
            .as_ref()
            .map_or_else(String::new, |path| path.display().to_string())
    }

    /// The error for the entry `key` of `[columns]`.
    pub(super) fn column_error(&self, key: &str, message: String) -> LogError {
        let (line, column) = self.places.get(key).copied().unwrap_or((1, 1));
        LogError::Companion {
            file: self.file(),
            line,
            column,
            message,
        }
    }

    /// Whether `[columns]` states the unit of a family's column of a joint.
    pub(super) fn states_unit(&self, family: &Family, joint: usize, joints: &[Joint]) -> bool {
        let mut names = family.names(joint, joints).into_iter();
        names.any(|name| self.columns.get(&name).is_some_and(|c| c.unit.is_some()))
    }

    /// Whether `[columns]` states the unit of a joint's position; `joint` counts from 0.
    pub(crate) fn states_position(&self, joint: usize, joints: &[Joint]) -> bool {
        self.states_unit(&Q, joint, joints) || self.states_unit(&QM, joint, joints)
    }

    /// Whether reference and controller have as many joints as the robot.
    pub(super) fn check_joints(&self, joints: usize) -> Result<(), LogError> {
        let reference = self.reference.as_ref().map(Reference::joints);
        let controller = self
            .controller
            .as_ref()
            .map(|controller| controller.kp.len());
        for (table, found) in [("reference", reference), ("controller", controller)] {
            if let Some(found) = found.filter(|&found| found != joints) {
                let message = format!("[{table}] is for {found} joints, the robot has {joints}");
                return Err(LogError::CompanionRobot {
                    file: self.file(),
                    message,
                });
            }
        }
        Ok(())
    }
}

type Columns = BTreeMap<String, ColumnSource>;
type Places = BTreeMap<String, (usize, usize)>;

/// The `[columns]` table, and where its keys stand.
fn columns(
    text: &str,
    raw: BTreeMap<Spanned<String>, Spanned<ColumnSource>>,
) -> Result<(Columns, Places), Mistake> {
    let mut columns = BTreeMap::new();
    let mut places = BTreeMap::new();
    for (key, source) in raw {
        let (span, key) = (key.span(), key.into_inner());
        let source_span = source.span();
        let source = source.into_inner();
        if source
            .gain
            .is_some_and(|gain| !gain.is_finite() || gain == 0.0)
        {
            return Err((
                source_span,
                format!("`{key}`: a gain must be finite and not zero"),
            ));
        }
        places.insert(key.clone(), position(text, span.start));
        columns.insert(key, source);
    }
    Ok((columns, places))
}

/// The value, if it is finite and greater than zero.
pub(super) fn positive(key: &str, value: Spanned<f64>) -> Result<f64, Mistake> {
    let span = value.span();
    let value = value.into_inner();
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err((
            span,
            format!("{key} = {value}: must be finite and greater than zero"),
        ))
    }
}

/// Line and column of a byte, both counted from 1, columns in characters.
fn position(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    let column = before
        .get(line_start..)
        .map_or(0, |line| line.chars().count());
    (before.matches('\n').count() + 1, column + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("log.toml");
        std::fs::write(&path, text).unwrap();
        let message = Companion::load(&path).unwrap_err().to_string();
        message.rsplit("log.toml").next().unwrap().to_owned()
    }

    const REFERENCE: &str = "[reference]\nkind = 'fourier'\nf0_hz = 0.125\nperiods = 3\n\
        center = [0.0, 0.1]\nsin = [[0.1, 0.02], [0.3, 0.0]]\ncos = [[0.1, 0.02], [0.3, 0.0]]\n";

    #[test]
    fn companion_as_in_the_contract_is_read() {
        let text = format!(
            "rate_hz = 1000\nencoder_resolution = 6e-6\n[columns]\n\
             q1 = {{ from = 'pos_shoulder', unit = 'deg' }}\n{REFERENCE}\
             [controller]\nlaw = 'pd'\nkp = [100.0, 80]\nkd = [10.0, 8.0]\nfeedforward = 'rigid'\n\
             velocity_filter_hz = 80\ntorque_limit = [40.0, 30.0]\nstart = 'reference'\n"
        );
        let companion = Companion::parse(&text).unwrap();
        assert_eq!(companion.rate_hz, Some(1000.0));
        assert_eq!(companion.encoder_resolution, Some(6e-6));
        assert_eq!(
            companion.columns["q1"].from.as_deref(),
            Some("pos_shoulder")
        );
        assert_eq!(companion.controller.as_ref().unwrap().kp, [100.0, 80.0]);
        assert!(companion.check_joints(2).is_ok());
        let message = companion.check_joints(3).unwrap_err().to_string();
        assert!(
            message.contains("[reference] is for 2 joints, the robot has 3"),
            "{message}"
        );
    }

    #[test]
    fn companion_with_an_unknown_key_points_at_it() {
        let message = error("rate_hz = 10\n  rate = 5\n");
        assert!(
            message.starts_with(":2:3: unknown field `rate`"),
            "{message}"
        );
        let message = error("[columns]\nq1 = { form = 'a' }\n");
        assert!(
            message.starts_with(":2:8: unknown field `form`"),
            "{message}"
        );
        let message = error(&format!("{REFERENCE}offset = 1\n"));
        assert!(
            message.starts_with(":8:1: unknown field `offset`"),
            "{message}"
        );
    }

    #[test]
    fn companion_with_an_impossible_value_points_at_it() {
        for (text, start) in [
            ("rate_hz = 0\n", ":1:11: rate_hz = 0: must be finite"),
            ("rate_hz = nan\n", ":1:11: rate_hz = NaN"),
            ("rate_hz = 'fast'\n", ":1:11: invalid type"),
            ("rate_hz = \n", ":1:"),
            ("[columns]\nq1 = { gain = 0.0 }\n", ":2:6: `q1`: a gain"),
        ] {
            let message = error(text);
            assert!(message.starts_with(start), "{text}: {message}");
        }
    }

    #[test]
    fn companion_that_is_absent_names_the_file() {
        let message = Companion::load(Path::new("no/such.toml"))
            .unwrap_err()
            .to_string();
        assert!(
            message.starts_with("no/such.toml: the log companion cannot be read"),
            "{message}"
        );
    }
}
