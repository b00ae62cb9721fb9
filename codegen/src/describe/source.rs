//! From a file to text: which kind it is, and nothing but UTF-8 of a sane size.

use super::code;
use super::diagnostic::Diagnostic;
use super::findings::{Finding, Findings, finding};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Largest description that is read, bytes.
pub(super) const MAX_BYTES: u64 = 64 << 20;

/// How a description is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// URDF (XML).
    Urdf,
    /// TOML: a modified Denavit-Hartenberg table, or the companion of a URDF.
    Toml,
    /// SYMORO's `.par`.
    Par,
}

impl Kind {
    /// The kind by the extension; a text of another extension is looked at.
    pub(super) fn of(path: &Path, text: &str) -> Result<Kind, Finding> {
        let extension = path
            .extension()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "urdf" => Ok(Kind::Urdf),
            "toml" => Ok(Kind::Toml),
            "par" => Ok(Kind::Par),
            "xacro" => Err(finding(code::XACRO, "this is a xacro file, not a URDF")
                .help("run `xacro robot.xacro > robot.urdf` and read the result")),
            _ if text.trim_start().starts_with('<') => Ok(Kind::Urdf),
            _ if is_robot_toml(text) => Ok(Kind::Toml),
            _ => Err(finding(
                code::FILE_FORMAT,
                "not a robot description that can be read",
            )
            .help("robots are .urdf, .toml or .par files")),
        }
    }
}

/// Whether a text says where joints are in the way of a TOML robot.
fn is_robot_toml(text: &str) -> bool {
    let key = |line: &str| {
        line.split_once('=')
            .is_some_and(|(key, _)| key.trim() == "urdf")
    };
    text.lines()
        .any(|line| line.trim() == "[[joint]]" || key(line))
}

/// The name of a file without folder and extension.
pub(super) fn stem(file: &str) -> String {
    Path::new(file)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// How messages call a file that `file` names by a path relative to itself.
pub(super) fn beside(file: &str, path: &str) -> String {
    let folder = Path::new(file).parent().unwrap_or_else(|| Path::new(""));
    folder.join(path).display().to_string()
}

/// The text of a file that the user knows as `file`.
pub(super) fn text_of(path: &Path, file: &str) -> Result<String, Vec<Diagnostic>> {
    let bytes = bytes_of(path).map_err(|found| vec![found.on_file(file)])?;
    decode(bytes, file)
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, Finding> {
    let unreadable = |why: std::io::Error| finding(code::FILE_UNREADABLE, why.to_string());
    let file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(finding(code::FILE_UNREADABLE, "this is a folder").help("name a file in it"));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= MAX_BYTES {
        // A device or a pipe has no length: what it gives is limited as well.
        file.take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(unreadable)?;
    }
    if metadata.len() > MAX_BYTES || bytes.len() as u64 > MAX_BYTES {
        let message = format!("larger than {} MiB", MAX_BYTES >> 20);
        return Err(finding(code::FILE_TOO_LARGE, message)
            .help("a description holds numbers and names; meshes are files of their own"));
    }
    Ok(bytes)
}

/// UTF-8 without its byte order mark.
fn decode(bytes: Vec<u8>, file: &str) -> Result<String, Vec<Diagnostic>> {
    let help = "save it as UTF-8";
    let wide = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
    if wide || bytes.iter().take(2).any(|byte| *byte == 0) {
        let found = finding(
            code::FILE_NOT_UTF8,
            "this is UTF-16 or binary, not UTF-8 text",
        );
        return Err(vec![found.help(help).on_file(file)]);
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(without_mark(&text).to_owned()),
        Err(error) => {
            let good = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            let before = String::from_utf8_lossy(bytes.get(..good).unwrap_or_default());
            let byte = bytes.get(good).copied().unwrap_or_default();
            let mut to = Findings::new(&before, file);
            let message = format!("byte 0x{byte:02X} is not UTF-8");
            to.error(good, finding(code::FILE_NOT_UTF8, message).help(help));
            Err(to.decide().err().unwrap_or_default())
        }
    }
}

/// The text without a byte order mark.
pub(super) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{FEFF}').unwrap_or(text)
}
