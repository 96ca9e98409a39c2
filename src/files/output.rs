//! Writing results: to a temporary name first, renamed when complete, so that a reader never sees half a file and a
//! killed run leaves the previous one whole.

use std::fs::{self, File, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::input::no_regular_file;

/// What to do when a result is already there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Refuse with an error that names the file.
    Refuse,
    /// Replace it (`--force`).
    Replace,
}

impl Overwrite {
    /// Replaces what is there only where that was asked for.
    pub fn forced(is_forced: bool) -> Self {
        if is_forced { Self::Replace } else { Self::Refuse }
    }

    /// Whether a file may be written, to be asked before the work and not after it.
    ///
    /// # Errors
    /// When it is there and may not be replaced.
    pub fn check(self, path: &Path) -> Result<()> {
        if self == Self::Refuse && path.exists() {
            bail!("{} exists: choose another name, or replace it with --force", path.display());
        }
        Ok(())
    }
}

/// Checks the name of a picture that will be a PNG.
///
/// # Errors
/// When it ends as pictures of another kind do: the file would not be what it is called.
pub(crate) fn png_name(path: &Path) -> Result<()> {
    const OTHERS: [&str; 11] = ["jpg", "jpeg", "bmp", "gif", "tif", "tiff", "webp", "ppm", "tga", "exr", "svg"];
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if OTHERS.contains(&ending.as_str()) {
        bail!(
            "{} is called as if it were no PNG, expected a name that ends in .png: that is what is written",
            path.display()
        );
    }
    Ok(())
}

/// Writes a file through `body` under a temporary name beside `path`, then renames it to `path`.
///
/// # Errors
/// When the file is there and `overwrite` is [`Overwrite::Refuse`], when what is there is no regular file, or when writing fails (a full
/// disk, say): the message names the file; the temporary is removed and what was there before stays.
pub fn write_atomically(
    path: &Path,
    overwrite: Overwrite,
    body: impl FnOnce(&mut dyn Write) -> Result<()>,
) -> Result<()> {
    let mut body = Some(body);
    written_atomically(path, overwrite, &mut |writer| body.take().map_or(Ok(()), |body| body(writer)))
}

/// [`write_atomically`], compiled once for all bodies; `body` is called once at most.
fn written_atomically(
    path: &Path,
    overwrite: Overwrite,
    body: &mut dyn FnMut(&mut dyn Write) -> Result<()>,
) -> Result<()> {
    if overwrite == Overwrite::Refuse && path.exists() {
        bail!("{} exists already: pass --force to replace it, or choose another name", path.display());
    }
    // A rename would put the file in the place of a device or a link, for everybody who uses it.
    let there = fs::symlink_metadata(path).ok();
    if let Some(what) = there.and_then(|metadata| no_regular_file(metadata.file_type())) {
        bail!("{} is {what}, expected a regular file or a name that is free", path.display());
    }
    let temporary = temporary_name(path);
    let written = (|| -> Result<()> {
        // What a killed run left is taken away, so that nothing is written through a link of that name.
        if fs::symlink_metadata(&temporary).is_ok() {
            fs::remove_file(&temporary)?;
        }
        let mut writer = BufWriter::new(File::create_new(&temporary)?);
        body(&mut writer)?;
        writer.flush()?;
        // Without this a crash of the machine after the rename could leave an empty file under the final name.
        writer.get_ref().sync_data()?;
        fs::rename(&temporary, path)?;
        Ok(())
    })();
    if written.is_err() {
        // The temporary is of no use to anyone; failing to remove it must not hide the first error.
        let _ = fs::remove_file(&temporary);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}

fn temporary_name(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".tmp");
    path.with_file_name(name)
}

/// A folder that results go into.
#[derive(Clone, Debug)]
pub struct OutputFolder {
    path: PathBuf,
    overwrite: Overwrite,
}

impl OutputFolder {
    /// Creates the folder (and its parents). A folder that already holds something is refused unless `overwrite` says
    /// otherwise, so that a second run never mixes its results into those of a first.
    ///
    /// # Errors
    /// When the folder holds files and may not be overwritten, when `path` is a file, or when it cannot be made.
    pub fn create(path: &Path, overwrite: Overwrite) -> Result<Self> {
        if path.exists() && !path.is_dir() {
            bail!("{} is a file, expected a folder to write results into", path.display());
        }
        if overwrite == Overwrite::Refuse && Self::holds_something(path)? {
            bail!(
                "the folder {} is not empty: pass --force to overwrite its files, or choose another folder",
                path.display()
            );
        }
        fs::create_dir_all(path).with_context(|| format!("cannot create the folder {}", path.display()))?;
        // Past this point the folder is ours: files in it are replaced (a resumed run rewrites its own).
        Ok(Self { path: path.to_path_buf(), overwrite: Overwrite::Replace })
    }

    /// [`Self::create`] for work that fills the folder: where the work fails before there is a file, the folders made for it are taken away.
    ///
    /// # Errors
    /// As there, and when the work fails.
    pub fn filled<T>(path: &Path, overwrite: Overwrite, work: impl FnOnce(&Self) -> Result<T>) -> Result<T> {
        let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let missing: Vec<&Path> = path.ancestors().take_while(is_missing).collect();
        let done = work(&Self::create(path, overwrite)?);
        if done.is_err() && !missing.is_empty() {
            remove_empty(path);
            // One that holds something stays, and so do those that it is in.
            let _ = missing[1..].iter().try_for_each(fs::remove_dir);
        }
        done
    }

    /// Whether a folder is there that is not empty.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn holds_something(path: &Path) -> Result<bool> {
        let cannot = || format!("cannot read the folder {}", path.display());
        Ok(path.is_dir() && fs::read_dir(path).with_context(cannot)?.next().is_some())
    }

    /// Creates the folder or opens it with what it holds (a resumed run).
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn open(path: &Path) -> Result<Self> {
        Self::create(path, Overwrite::Replace)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file in this folder; `name` may hold sub-folders, which are made.
    ///
    /// # Errors
    /// When a sub-folder cannot be made.
    pub fn file(&self, name: &str) -> Result<PathBuf> {
        let path = self.path.join(name);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).with_context(|| format!("cannot create the folder {}", parent.display()))?;
        }
        Ok(path)
    }

    /// Writes one file of the folder, atomically.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write(&self, name: &str, body: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
        write_atomically(&self.file(name)?, self.overwrite, body)
    }
}

/// Removes a folder in which there are at most folders that are as empty.
fn remove_empty(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            remove_empty(&entry.path());
        }
    }
    // Of use to nobody, and in nobody's way: what the work failed of is what is to be said.
    let _ = fs::remove_dir(folder);
}

/// A folder that a run writes into; free again when this is dropped or the process ends, however it does.
#[derive(Debug)]
pub struct Occupied {
    _folder: Option<File>,
}

impl OutputFolder {
    /// Keeps every other run that asks likewise out of the folder. Where the system locks no folders (Windows, some network shares) none is kept
    /// out.
    ///
    /// # Errors
    /// When another run is in it.
    pub fn occupy(&self) -> Result<Occupied> {
        let Ok(folder) = File::open(&self.path) else { return Ok(Occupied { _folder: None }) };
        match folder.try_lock() {
            Err(TryLockError::WouldBlock) => {
                bail!(
                    "another run is writing into {}: wait until it has ended, or choose another folder",
                    self.path.display()
                )
            }
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Occupied { _folder: Some(folder) }),
        }
    }

    /// Does something while no other process does anything under the same lock, `<name>.lock` in this folder, which stays.
    ///
    /// # Errors
    /// When the file cannot be made or locked, or what is done fails.
    pub fn alone<T>(&self, name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let (lock, path) = self.lock(name)?;
        lock.lock().with_context(|| format!("cannot lock {}", path.display()))?;
        work()
    }

    /// [`Self::alone`], or nothing where another process is at it.
    ///
    /// # Errors
    /// As there.
    pub fn alone_at_once<T>(&self, name: &str, work: impl FnOnce() -> Result<T>) -> Result<Option<T>> {
        let (lock, path) = self.lock(name)?;
        match lock.try_lock() {
            Ok(()) => work().map(Some),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error).with_context(|| format!("cannot lock {}", path.display())),
        }
    }

    fn lock(&self, name: &str) -> Result<(File, PathBuf)> {
        let path = self.file(&format!("{name}.lock"))?;
        let lock = File::options().create(true).append(true).open(&path);
        Ok((lock.with_context(|| format!("cannot lock {}", path.display()))?, path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn work_that_writes_nothing_leaves_no_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/c");
        let fail = |names: &[&str]| {
            let error = OutputFolder::filled(&path, Overwrite::Refuse, |output| -> Result<()> {
                OutputFolder::open(&output.path().join("person"))?;
                names.iter().try_for_each(|name| output.write(name, |_| Ok(())))?;
                bail!("it fails")
            });
            assert_eq!(error.unwrap_err().to_string(), "it fails");
        };
        fail(&[]);
        assert!(!folder.path().join("a").exists());
        // What was there stays.
        fs::create_dir_all(folder.path().join("a/b")).unwrap();
        fail(&[]);
        assert!(folder.path().join("a/b").exists() && !path.exists());
        fs::create_dir(&path).unwrap();
        fail(&[]);
        assert!(path.exists());
        fs::remove_dir_all(folder.path().join("a")).unwrap();
        fail(&["half.csv"]);
        assert!(path.join("half.csv").exists() && !path.join("person").exists());
    }

    #[test]
    fn one_run_at_a_time_is_in_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::open(folder.path()).unwrap();
        let first = output.occupy().unwrap();
        let error = output.occupy().unwrap_err().to_string();
        assert!(error.contains("another run is writing into") && error.contains("choose another folder"), "{error}");
        drop(first);
        output.occupy().unwrap();
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.csv");
        write_atomically(&path, Overwrite::Refuse, |w| Ok(w.write_all(b"old")?)).unwrap();
        let refused = write_atomically(&path, Overwrite::Refuse, |w| Ok(w.write_all(b"new")?)).unwrap_err();
        assert!(format!("{refused:#}").contains("--force"), "{refused:#}");
        let failed = write_atomically(&path, Overwrite::Replace, |w| {
            w.write_all(b"half")?;
            bail!("no space left on device")
        })
        .unwrap_err();
        assert!(format!("{failed:#}").contains("poses.csv"), "{failed:#}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary is gone");
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_folders_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [target, link, temporary] = ["target.csv", "link.csv", "new.csv.tmp"].map(|name| folder.path().join(name));
        fs::write(&target, "theirs").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        let socket = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        for (path, what) in [(&link, "a link"), (&socket, "a socket"), (&folder.path().to_path_buf(), "a folder")] {
            let error = write_atomically(path, Overwrite::Replace, |w| Ok(w.write_all(b"ours")?)).unwrap_err();
            assert!(format!("{error:#}").contains(what), "{error:#}");
        }
        // Nor is anything written through a link that has the temporary's name.
        std::os::unix::fs::symlink(&target, &temporary).unwrap();
        write_atomically(&folder.path().join("new.csv"), Overwrite::Refuse, |w| Ok(w.write_all(b"ours")?)).unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"theirs");
        assert_eq!(fs::read(folder.path().join("new.csv")).unwrap(), b"ours");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }

    #[test]
    fn a_full_disk_is_one_sentence() {
        // Linux offers a device that is always full; elsewhere there is nothing to test with.
        if !Path::new("/dev/full").exists() {
            return;
        }
        let error = (|| -> Result<()> {
            let mut writer = BufWriter::new(fs::OpenOptions::new().write(true).open("/dev/full")?);
            writer.write_all(b"x")?;
            writer.flush()?;
            Ok(())
        })()
        .unwrap_err();
        assert!(format!("{error:#}").to_lowercase().contains("no space"), "{error:#}");
    }

    #[test]
    fn an_occupied_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        OutputFolder::create(folder.path(), Overwrite::Refuse).unwrap().write("a/b.txt", |_| Ok(())).unwrap();
        let error = OutputFolder::create(folder.path(), Overwrite::Refuse).unwrap_err();
        assert!(format!("{error}").contains("not empty"), "{error}");
    }
}
