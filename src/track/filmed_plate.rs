//! Pictures of the empty scene that were filmed, one a camera in a folder.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};

use crate::files::PICTURE_ENDINGS;

/// The picture that bears one of the names, in the first of the folders that has one, as an absolute path.
///
/// # Errors
/// When none of the folders has one: with the last folder and the first name.
pub(super) fn filmed_plate(folders: &[PathBuf], names: &[&str]) -> Result<PathBuf> {
    let places = folders.iter().flat_map(|folder| names.iter().map(move |name| (folder, name)));
    let files = places.flat_map(|(folder, name)| PICTURE_ENDINGS.map(|ending| folder.join(format!("{name}.{ending}"))));
    for file in files {
        if file.is_file() {
            return fs::canonicalize(&file).with_context(|| format!("cannot read {}", file.display()));
        }
    }
    let folder = folders.last().map(|folder| folder.display().to_string()).unwrap_or_default();
    bail!(
        "{folder} holds no {}.png (nor .{}), expected a picture of the empty scene of each camera",
        names.first().unwrap_or(&""),
        PICTURE_ENDINGS[1..].join(", .")
    )
}
