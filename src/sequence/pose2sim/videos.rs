//! The recordings of a trial, in the order in which Pose2Sim takes them for the cameras.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};

use super::listing::{entries, folders_of};
use crate::files::PICTURE_ENDINGS;

/// What Pose2Sim takes for a video.
const VIDEOS: [&str; 10] = ["mp4", "avi", "mov", "mkv", "wmv", "flv", "webm", "m4v", "mpeg", "mpg"];

/// A recording of one camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Recording {
    /// The video's name without its ending, or that of the folder of pictures.
    pub(super) name: String,
    /// The video, or the pattern of the pictures' names.
    pub(super) source: PathBuf,
    pub(super) is_video: bool,
}

/// The videos of `videos/`, or where there is none its folders of pictures, by the last number in their names, those without one last.
pub(super) fn recordings(trial: &Path) -> Result<Vec<Recording>> {
    let folder = trial.join("videos");
    ensure!(folder.is_dir(), "{} has no folder `videos`, expected one with a video of each camera", trial.display());
    let mut found: Vec<Recording> = Vec::new();
    for file in entries(&folder)?.into_iter().filter(|file| file.is_file() && ends_like(file, &VIDEOS)) {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        found.push(Recording { name, source: file, is_video: true });
    }
    if found.is_empty() {
        for inner in folders_of(&folder)? {
            let Some(source) = pattern(&inner)? else { continue };
            let name = inner.file_name().unwrap_or_default().to_string_lossy().into_owned();
            found.push(Recording { name, source, is_video: false });
        }
    }
    if found.is_empty() {
        bail!(
            "{} holds no video ({}) and no folder of pictures ({}), expected one of each camera",
            folder.display(),
            VIDEOS.join(", "),
            PICTURE_ENDINGS.join(", ")
        );
    }
    found.sort_by_cached_key(|recording| {
        let number = last_number(&recording.name);
        (number.is_none(), number, recording.name.clone())
    });
    Ok(found)
}

fn ends_like(file: &Path, endings: &[&str]) -> bool {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    endings.contains(&ending.as_str())
}

/// The last run of digits in a name.
fn last_number(name: &str) -> Option<u64> {
    name.split(|c: char| !c.is_ascii_digit()).rfind(|digits| !digits.is_empty())?.parse().ok()
}

/// The pattern of the names of a folder's pictures, by the first of them: its last number counts. None without pictures.
fn pattern(folder: &Path) -> Result<Option<PathBuf>> {
    let pictures: Vec<PathBuf> =
        entries(folder)?.into_iter().filter(|file| ends_like(file, &PICTURE_ENDINGS)).collect();
    let Some(first) = pictures.first() else { return Ok(None) };
    let name = first.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    let Some(end) = stem.rfind(|c: char| c.is_ascii_digit()).map(|at| at + 1) else {
        bail!("{} has no number in its name, expected numbered pictures", first.display());
    };
    let begin = stem[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + stem[at..].chars().next().map_or(1, char::len_utf8));
    let (before, after) = (&name[..begin], &name[end..]);
    let plain = |text: &str| text.replace('%', "%%");
    // Numbers of one length are padded with zeros.
    let of_them = |file: &&PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(before) && name.ends_with(after)
    };
    let is_padded = pictures.iter().filter(of_them).all(|file| file.as_os_str().len() == first.as_os_str().len());
    let number = if is_padded { format!("%0{}d", end - begin) } else { "%d".to_string() };
    Ok(Some(folder.join(format!("{}{number}{}", plain(before), plain(after)))))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn trial(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            let file = folder.path().join("videos").join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "").unwrap();
        }
        folder
    }

    fn names(folder: &tempfile::TempDir) -> Vec<String> {
        recordings(folder.path()).unwrap().into_iter().map(|recording| recording.name).collect()
    }

    #[test]
    fn videos_come_by_their_last_number() {
        let folder = trial(&["b_cam10.mp4", "x2.avi", "cam1.MP4", "notes.txt", "front.mov", ".hidden3.mp4"]);
        assert_eq!(names(&folder), ["cam1", "x2", "b_cam10", "front"]);
    }

    #[test]
    fn folders_of_pictures_stand_in_for_videos() {
        let folder = trial(&["cam2/f_0007.png", "cam2/f_0008.png", "cam1/9.jpg", "cam1/10.jpg", "empty/readme.txt"]);
        let found = recordings(folder.path()).unwrap();
        let patterns: Vec<String> =
            found.iter().map(|found| found.source.file_name().unwrap().to_string_lossy().into_owned()).collect();
        assert_eq!(patterns, ["%d.jpg", "f_%04d.png"]);
        fs::write(folder.path().join("videos/late.mp4"), "").unwrap();
        assert_eq!(names(&folder), ["late"]);
    }

    #[test]
    fn what_is_missing_is_said() {
        let refused = |folder: &tempfile::TempDir| recordings(folder.path()).unwrap_err().to_string();
        assert!(refused(&tempfile::tempdir().unwrap()).contains("has no folder `videos`"));
        assert!(refused(&trial(&["notes.txt"])).contains("holds no video"));
        assert!(refused(&trial(&["cam1/first.png"])).contains("no number in its name"));
    }
}
