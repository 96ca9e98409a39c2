//! Files that a user, or a user's file, names: regular ones alone, read up to a limit.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};

/// What a kind of file is called, and what one holds at most.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// With its article: `a TOML file`.
    pub what: &'static str,
    /// Bytes.
    pub most: u64,
}

impl Limit {
    /// Opens a file for reading. Links are followed.
    ///
    /// # Errors
    /// When nothing is there, it may not be read, it holds more than the limit, or it is no regular file: a pipe would be waited for, and a
    /// device may never end.
    pub fn open(self, path: &Path) -> Result<File> {
        let cannot = || format!("cannot read {}", path.display());
        let metadata = fs::metadata(path).with_context(cannot)?;
        if let Some(what) = no_regular_file(metadata.file_type()) {
            bail!("{} is {what}, expected {}, which is a regular file", path.display(), self.what);
        }
        let (size, Self { what, most }) = (metadata.len(), self);
        ensure!(size <= most, "{} holds {size} bytes, expected {what} of at most {most}", path.display());
        File::open(path).with_context(cannot)
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// As [`Self::open`], whatever size the file said that it has.
    pub fn read(self, path: &Path) -> Result<Vec<u8>> {
        let file = self.open(path)?;
        let mut bytes =
            Vec::with_capacity(file.metadata().map_or(0, |metadata| metadata.len().min(self.most)) as usize);
        let read = file.take(self.most.saturating_add(1)).read_to_end(&mut bytes);
        read.with_context(|| format!("cannot read {}", path.display()))?;
        let Self { what, most } = self;
        ensure!(bytes.len() as u64 <= most, "{} holds more than {most} bytes, expected {what}", path.display());
        Ok(bytes)
    }

    /// The text of a file, without the mark that some editors begin it with.
    ///
    /// # Errors
    /// As [`Self::read`], and for bytes that are no text.
    pub fn read_text(self, path: &Path) -> Result<String> {
        let text = String::from_utf8(self.read(path)?).map_err(|error| {
            anyhow!("{} is not text (byte {} is not UTF-8)", path.display(), error.utf8_error().valid_up_to())
        })?;
        Ok(match text.strip_prefix('\u{feff}') {
            Some(rest) => rest.to_string(),
            None => text,
        })
    }
}

/// Whether something that can be read whole stands at a path.
///
/// # Errors
/// With the path and what stands there instead, in words: `there is no file p`, `p is a folder, expected a regular file`.
pub fn check_regular(path: &Path) -> Result<(), String> {
    match fs::metadata(path) {
        Ok(metadata) => no_regular_file(metadata.file_type())
            .map_or(Ok(()), |what| Err(format!("{} is {what}, expected a regular file", path.display()))),
        Err(_) => Err(format!("there is no file {}", path.display())),
    }
}

/// What something is, if it is no regular file.
pub(super) fn no_regular_file(kind: fs::FileType) -> Option<&'static str> {
    match (kind.is_file(), kind.is_symlink(), kind.is_dir()) {
        (true, ..) => None,
        (_, true, _) => Some("a link"),
        (.., true) => Some("a folder"),
        _ => Some("a device, a pipe or a socket"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTE: Limit = Limit { what: "a note", most: 4 };

    #[test]
    fn files_are_read_up_to_their_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("note");
        let error = |path: &Path| format!("{:#}", NOTE.read_text(path).unwrap_err());
        assert!(error(&path).contains("cannot read") && error(&path).contains("note"), "{}", error(&path));
        fs::write(&path, "abcd").unwrap();
        assert_eq!(NOTE.read_text(&path).unwrap(), "abcd");
        fs::write(&path, "\u{feff}a").unwrap();
        assert_eq!(NOTE.read_text(&path).unwrap(), "a");
        fs::write(&path, "abcde").unwrap();
        assert!(error(&path).ends_with("note holds 5 bytes, expected a note of at most 4"), "{}", error(&path));
        fs::write(&path, [0x61, 0xff]).unwrap();
        assert!(error(&path).ends_with("note is not text (byte 1 is not UTF-8)"), "{}", error(&path));
        assert!(error(folder.path()).ends_with("is a folder, expected a note, which is a regular file"));
        assert!(check_regular(folder.path()).unwrap_err().ends_with("is a folder, expected a regular file"));
        assert!(check_regular(&folder.path().join("none")).unwrap_err().starts_with("there is no file "));
    }

    /// It says that it is empty, and never ends.
    #[cfg(unix)]
    #[test]
    fn devices_pipes_and_sockets_are_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let (pipe, socket, link) =
            (folder.path().join("pipe"), folder.path().join("socket"), folder.path().join("link"));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for path in [Path::new("/dev/zero"), &pipe, &socket, &link] {
            let expected = format!("{} is a device, a pipe or a socket", path.display());
            let error = format!("{:#}", NOTE.read(path).unwrap_err());
            assert!(error.starts_with(&expected), "{error}");
            assert!(check_regular(path).unwrap_err().starts_with(&expected));
        }
    }

    /// Files of the kernel are regular, say that they are empty, and hold something.
    #[cfg(target_os = "linux")]
    #[test]
    fn the_size_a_file_says_is_not_believed() {
        let error = format!("{:#}", NOTE.read(Path::new("/proc/self/status")).unwrap_err());
        assert!(error.ends_with("/proc/self/status holds more than 4 bytes, expected a note"), "{error}");
    }
}
