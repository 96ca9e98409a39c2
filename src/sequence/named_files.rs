//! The files that a manifest names, beside it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::footage::{Footage, is_pattern};
use crate::files::{beside, check_regular};

/// A manifest whose files are looked for.
#[derive(Clone, Copy)]
pub(super) struct NamedFiles<'a> {
    pub(super) manifest: &'a Path,
    /// The folder from which they are named.
    pub(super) dir: &'a Path,
}

impl NamedFiles<'_> {
    /// Where a file is or may be yet to be made.
    pub(super) fn place(self, relative: &Path) -> PathBuf {
        beside(self.dir, relative)
    }

    /// The file that `key` names.
    ///
    /// # Errors
    /// When it is not there or no regular file.
    pub(super) fn existing(self, key: &str, relative: &Path) -> Result<PathBuf> {
        let file = self.place(relative);
        if let Err(why) = check_regular(&file) {
            bail!("{}: {key} is {:?}, and {why}", self.manifest.display(), relative.display());
        }
        Ok(file)
    }

    /// The video or the pictures that `key` names.
    ///
    /// # Errors
    /// When they are not there or cannot be read.
    pub(super) fn footage(self, key: &str, relative: &Path) -> Result<Footage> {
        let file = self.place(relative);
        if is_pattern(&file) {
            return Footage::open(&file)
                .with_context(|| format!("{}: {key} is {:?}", self.manifest.display(), relative.display()));
        }
        Footage::open(&self.existing(key, relative)?)
    }
}
