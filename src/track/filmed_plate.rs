//! Pictures of the empty scene that were filmed, one a camera in a folder.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::files::{PICTURE_ENDINGS, listed};

/// The picture that bears one of the names, in the first of the folders that has one, as an absolute path; where none has, the only one
/// whose name contains one of them (`bg_cam01.png`), of several the only one whose name ends with it (not `bg_cam01_half.png`).
///
/// # Errors
/// When none of the folders has one, or several contain the name: with the folder and the first name.
pub(super) fn filmed_plate(folders: &[PathBuf], names: &[&str]) -> Result<PathBuf> {
    let places = folders.iter().flat_map(|folder| names.iter().map(move |name| (folder, name)));
    let files = places.flat_map(|(folder, name)| PICTURE_ENDINGS.map(|ending| folder.join(format!("{name}.{ending}"))));
    for file in files {
        if file.is_file() {
            return fs::canonicalize(&file).with_context(|| format!("cannot read {}", file.display()));
        }
    }
    for folder in folders {
        let mut contained = containing(folder, names);
        let ends = |file: &PathBuf| names.iter().any(|name| stem(file).ends_with(&name.to_lowercase()));
        if contained.iter().filter(|file| ends(file)).count() == 1 {
            contained.retain(ends);
        }
        match contained.as_slice() {
            [] => {}
            [file] => return fs::canonicalize(file).with_context(|| format!("cannot read {}", file.display())),
            several => bail!(
                "{} pictures in {} could be the empty scene of {}: {}, expected {}.png",
                several.len(),
                folder.display(),
                names.first().unwrap_or(&""),
                listed(
                    several.iter().filter_map(|file| file.file_name()).map(|name| name.to_string_lossy().into_owned())
                ),
                names.first().unwrap_or(&"")
            ),
        }
    }
    let folder = folders.last().map(|folder| folder.display().to_string()).unwrap_or_default();
    bail!(
        "{folder} holds no {}.png (nor .{}), expected a picture of the empty scene of each camera",
        names.first().unwrap_or(&""),
        PICTURE_ENDINGS[1..].join(", .")
    )
}

/// The pictures of a folder whose name contains one of the names, in their order.
fn containing(folder: &Path, names: &[&str]) -> Vec<PathBuf> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_one = |file: &PathBuf| {
        let (stem, ending) = (stem(file), lower(file.extension()));
        let is_named = names.iter().any(|name| !name.is_empty() && holds(&stem, &name.to_lowercase()));
        is_named && PICTURE_ENDINGS.contains(&ending.as_str()) && file.is_file()
    };
    let mut files: Vec<PathBuf> = files.filter(is_one).collect();
    files.sort();
    files
}

fn lower(part: Option<&OsStr>) -> String {
    part.map(|part| part.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// A file's name without its ending, in small letters.
fn stem(file: &Path) -> String {
    lower(file.file_stem())
}

/// Whether a name contains a camera's, and not as the beginning of a longer number: `cam1` is not in `cam10`.
pub(super) fn holds(name: &str, camera: &str) -> bool {
    let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    name.match_indices(camera).any(|(at, _)| {
        let (before, after) = (name[..at].chars().next_back(), name[at + camera.len()..].chars().next());
        let cuts_before = is_digit(before) && is_digit(camera.chars().next());
        let cuts_after = is_digit(after) && is_digit(camera.chars().next_back());
        !cuts_before && !cuts_after
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plates_may_be_called_after_their_cameras_and_more() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "bg_cam1.png",
            "cam10_background.PNG",
            "cam2.png",
            "old_cam2.png",
            "a_cam3.png",
            "b_cam3.jpg",
            "cam4.txt",
            "bg_cam5.png",
            "bg_cam5_half.png",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let plate = |camera: &str| {
            let found = filmed_plate(&[folder.path().to_path_buf()], &[camera]);
            found
                .map(|file| file.file_name().unwrap().to_string_lossy().into_owned())
                .map_err(|error| error.to_string())
        };
        assert_eq!(plate("cam1").unwrap(), "bg_cam1.png");
        assert_eq!(plate("cam10").unwrap(), "cam10_background.PNG");
        assert_eq!(plate("cam2").unwrap(), "cam2.png", "its own name comes first");
        assert!(
            plate("cam3").unwrap_err().contains("a_cam3.png, b_cam3.jpg, expected cam3.png"),
            "{plate:?}",
            plate = plate("cam3")
        );
        assert_eq!(plate("cam5").unwrap(), "bg_cam5.png", "what ends with the name comes first");
        assert!(plate("cam4").unwrap_err().contains("holds no cam4.png"));
    }
}
