//! For build scripts: robots in, Rust modules out.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), idim_codegen::BuildError> {
//!     idim_codegen::Builder::new().robot("robots/arm.urdf").generate()
//! }
//! ```
//!
//! and in the crate, which depends on `idim-runtime`:
//!
//! ```ignore
//! mod arm {
//!     idim_runtime::include_robot!("arm");
//! }
//! ```

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use crate::base::BaseError;
use crate::describe::{self, Description, Diagnostic};
use crate::emit;
use crate::functions::Group;
use crate::robot::Robot;
use crate::source::Source;

/// Collects robot descriptions and writes their modules to `OUT_DIR`.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    robots: Vec<PathBuf>,
    folders: Vec<PathBuf>,
    groups: Vec<Group>,
    out: Option<PathBuf>,
}

/// Why a robot could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The description has mistakes.
    #[error("{}", list(.0))]
    Description(Vec<Diagnostic>),
    /// The base parameters are not clear.
    #[error("{file}: {source}")]
    Base {
        /// The description.
        file: String,
        /// What is not clear.
        source: BaseError,
    },
    /// Two descriptions have one name.
    #[error("{first} and {second} both describe a robot called `{name}`: rename one")]
    Twice {
        /// The name.
        name: String,
        /// One file.
        first: String,
        /// The other.
        second: String,
    },
    /// A file or folder could not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// `OUT_DIR` is not set: this is no build script.
    #[error("OUT_DIR is not set: call this from a build script, or say where with `out_dir`")]
    NoOutDir,
    /// The generator made something that is not Rust.
    #[error("{0}")]
    Emission(String),
}

fn list(diagnostics: &[Diagnostic]) -> String {
    let lines: Vec<String> = diagnostics.iter().map(Diagnostic::to_string).collect();
    lines.join("\n")
}

impl Builder {
    /// An empty builder.
    pub fn new() -> Builder {
        Builder::default()
    }

    /// Adds one description: `.toml`, `.urdf` or `.par`.
    #[must_use]
    pub fn robot(mut self, path: impl Into<PathBuf>) -> Builder {
        self.robots.push(path.into());
        self
    }

    /// Adds every description of a folder; a URDF that a `.toml` beside it names is its geometry,
    /// not a robot of its own.
    #[must_use]
    pub fn robots_in(mut self, folder: impl Into<PathBuf>) -> Builder {
        self.folders.push(folder.into());
        self
    }

    /// Adds functions beside the identification models to every module: inverse dynamics, mass
    /// matrix and gravity, or pose and Jacobian.
    #[must_use]
    pub fn with(mut self, group: Group) -> Builder {
        self.groups.push(group);
        self
    }

    /// Writes to this folder instead of `OUT_DIR/idim`.
    #[must_use]
    pub fn out_dir(mut self, folder: impl Into<PathBuf>) -> Builder {
        self.out = Some(folder.into());
        self
    }

    /// Writes `NAME.rs` for every robot and `index.rs` over all of them; files whose text did not
    /// change are left alone. Tells cargo which files to watch.
    ///
    /// # Errors
    /// [`BuildError`]: the first robot that has mistakes, with all of them.
    pub fn generate(&self) -> Result<(), BuildError> {
        let out = match (&self.out, std::env::var_os("OUT_DIR")) {
            (Some(out), _) => out.clone(),
            (None, Some(out)) => PathBuf::from(out).join("idim"),
            (None, None) => return Err(BuildError::NoOutDir),
        };
        let sources = self.sources()?;
        std::fs::create_dir_all(&out).map_err(|error| io(&out, error))?;
        for source in &sources {
            let robot = source.robot.clone().with(&self.groups);
            let text = emit::rust(&robot).map_err(BuildError::Emission)?;
            let name = &robot.mechanism.name;
            write_if_changed(&out.join(format!("{name}.rs")), &text)?;
        }
        let index = emit::index(&sources).map_err(BuildError::Emission)?;
        write_if_changed(&out.join("index.rs"), &index)?;
        for path in sources
            .iter()
            .flat_map(|source| &source.paths)
            .chain(&self.folders)
        {
            println!("cargo::rerun-if-changed={}", path.display());
        }
        Ok(())
    }

    /// All robots, by name.
    fn sources(&self) -> Result<Vec<Source>, BuildError> {
        let mut sources: Vec<Source> = Vec::new();
        for path in &self.robots {
            sources.push(read(path)?);
        }
        for folder in &self.folders {
            sources.extend(read_folder(folder)?);
        }
        sources.sort_by(|a, b| a.robot.mechanism.name.cmp(&b.robot.mechanism.name));
        for pair in sources.windows(2) {
            if pair[0].robot.mechanism.name == pair[1].robot.mechanism.name {
                return Err(BuildError::Twice {
                    name: pair[0].robot.mechanism.name.clone(),
                    first: pair[0].file.clone(),
                    second: pair[1].file.clone(),
                });
            }
        }
        Ok(sources)
    }
}

fn read_folder(folder: &Path) -> Result<Vec<Source>, BuildError> {
    let listing = std::fs::read_dir(folder).map_err(|error| io(folder, error))?;
    let mut paths = Vec::new();
    for item in listing {
        paths.push(item.map_err(|error| io(folder, error))?.path());
    }
    paths.sort();
    let ending = |path: &&PathBuf, ending: &str| path.extension().is_some_and(|e| e == ending);
    let mut sources = Vec::new();
    for path in paths.iter().filter(|path| ending(path, "toml")) {
        sources.push(read(path)?);
    }
    let named: Vec<PathBuf> = sources
        .iter()
        .flat_map(|source| source.paths.clone())
        .collect();
    for path in paths
        .iter()
        .filter(|path| ending(path, "par") || (ending(path, "urdf") && !named.contains(path)))
    {
        sources.push(read(path)?);
    }
    Ok(sources)
}

/// Reads a description and derives its robot, keeping the texts.
///
/// # Errors
/// [`BuildError::Description`] and [`BuildError::Base`].
pub fn read(path: &Path) -> Result<Source, BuildError> {
    open(path)?.derive()
}

/// A description with the texts that it was read from; its robot is still to be derived, which
/// takes longer.
#[derive(Clone, Debug)]
pub struct Described {
    /// What the texts say.
    pub description: Description,
    path: PathBuf,
    texts: Vec<(String, String)>,
    paths: Vec<PathBuf>,
}

impl Described {
    /// Derives the robot.
    ///
    /// # Errors
    /// [`BuildError::Base`].
    pub fn derive(self) -> Result<Source, BuildError> {
        Ok(Source {
            file: name_of(&self.path),
            texts: self.texts,
            paths: self.paths,
            robot: derive(self.description, &self.path.display().to_string())?,
        })
    }
}

/// Reads a description.
///
/// # Errors
/// [`BuildError::Description`].
pub fn open(path: &Path) -> Result<Described, BuildError> {
    let text = describe::text_of(path).map_err(BuildError::Description)?;
    let kind = describe::kind_of(path, &text).map_err(BuildError::Description)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let loaded = RefCell::new((vec![(name_of(path), text.clone())], vec![path.to_owned()]));
    let load = |named: &str| {
        let path = folder.join(named);
        let text = describe::text_of(&path).map_err(|all| list(&all))?;
        let mut loaded = loaded.borrow_mut();
        loaded.0.push((named.to_owned(), text.clone()));
        loaded.1.push(path);
        Ok(text)
    };
    let description = describe::read_text(&text, &path.display().to_string(), kind, &load)
        .map_err(BuildError::Description)?;
    let (texts, paths) = loaded.into_inner();
    Ok(Described {
        description,
        path: path.to_owned(),
        texts,
        paths,
    })
}

/// Derives a robot from texts that were read before: the description first.
///
/// # Errors
/// [`BuildError::Description`] and [`BuildError::Base`].
pub fn read_texts(texts: &[(&str, &str)]) -> Result<Robot, BuildError> {
    let (file, text) = texts.first().copied().unwrap_or(("", ""));
    let kind = describe::kind_of(Path::new(file), text).map_err(BuildError::Description)?;
    let load = |named: &str| {
        let found = texts.iter().find(|(file, _)| *file == named);
        found
            .map(|(_, text)| (*text).to_owned())
            .ok_or_else(|| format!("{named} is not there"))
    };
    let description = describe::read_text(text, file, kind, &load);
    derive(description.map_err(BuildError::Description)?, file)
}

fn derive(description: Description, file: &str) -> Result<Robot, BuildError> {
    Robot::new(description).map_err(|source| BuildError::Base {
        file: file.to_owned(),
        source,
    })
}

fn name_of(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

fn io(path: &Path, source: std::io::Error) -> BuildError {
    BuildError::Io {
        path: path.display().to_string(),
        source,
    }
}

/// An unchanged file keeps its time stamp, and cargo does not rebuild what includes it.
fn write_if_changed(path: &Path, text: &str) -> Result<(), BuildError> {
    if std::fs::read_to_string(path).is_ok_and(|known| known == text) {
        return Ok(());
    }
    std::fs::write(path, text).map_err(|error| io(path, error))
}
