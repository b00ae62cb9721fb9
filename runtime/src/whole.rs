//! Files that are there whole or not at all.

use std::fs::OpenOptions;
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file that is written beside its place and takes it when it is complete.
///
/// Dropped before [`Whole::place`], it leaves nothing behind.
#[derive(Debug)]
pub struct Whole {
    file: NamedTempFile,
    path: PathBuf,
}

impl Whole {
    /// Begins the file that shall stand at `path`, or where the link at `path` leads.
    ///
    /// # Errors
    /// If its folder is missing or cannot be written.
    pub fn begin(path: &Path) -> io::Result<Self> {
        // The file would take the place of a link, too: of `/dev/stdout`, for one.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let mut builder = tempfile::Builder::new();
        builder.prefix(".idim-");
        #[cfg(unix)]
        {
            // Temporary files are private by default; this one becomes an ordinary file.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = if is_device(&path) {
            builder.tempfile()?
        } else {
            let folder = path.parent().filter(|it| !it.as_os_str().is_empty());
            builder.tempfile_in(folder.unwrap_or(Path::new(".")))?
        };
        Ok(Self { file, path })
    }

    /// Waits until the content is on the disk.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.as_file().sync_all()
    }

    /// Lets the file take its place.
    ///
    /// What stands there and is no ordinary file, such as `/dev/null` or a pipe, gets the content
    /// and stays what it is: a name put over it would take a device from the whole machine.
    ///
    /// # Errors
    /// If the place is a folder, belongs to another, ...
    pub fn place(mut self) -> io::Result<()> {
        if !is_device(&self.path) {
            self.file.persist(&self.path)?;
            return Ok(());
        }
        self.file.rewind()?;
        let mut device = OpenOptions::new().write(true).open(&self.path)?;
        io::copy(&mut self.file, &mut device)?;
        Ok(())
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

fn is_device(path: &Path) -> bool {
    let found = path.metadata();
    found.is_ok_and(|found| !found.is_file() && !found.is_dir())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, text: &str) -> io::Result<()> {
        let mut file = Whole::begin(path)?;
        file.write_all(text.as_bytes())?;
        file.place()
    }

    #[test]
    fn file_takes_the_place_of_an_older_one_and_nothing_else_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, "older and longer").unwrap();
        write(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        drop(Whole::begin(&path).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn folder_in_the_place_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "text").unwrap_err();
        assert!(folder.path().is_dir());
    }

    #[cfg(unix)]
    #[test]
    fn link_stays_and_the_file_that_it_leads_to_is_replaced() {
        let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        let (link, file) = (
            folders[0].path().join("link"),
            folders[1].path().join("file"),
        );
        write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, "new").unwrap();
        assert!(link.is_symlink() && !file.is_symlink());
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
    }

    #[cfg(unix)]
    #[test]
    fn pipe_gets_the_content_and_stays_a_pipe() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read_to_string(pipe).unwrap()
        });
        // Were the pipe replaced, its reader would wait for ever: look before joining it.
        write(&pipe, "text").unwrap();
        assert!(pipe.metadata().unwrap().file_type().is_fifo());
        assert_eq!(reader.join().unwrap(), "text");
    }
}
