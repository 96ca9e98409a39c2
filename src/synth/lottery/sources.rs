//! The files a lottery draws from: recorded motions and skinned people under folders.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf, absolute};

use anyhow::{Context, Result, bail};

use crate::files::{Limit, check_regular};

/// A recorded motion or what lies beside it.
const CLIP: Limit = Limit { what: "a clip", most: u64::MAX };

/// A recorded motion.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Recording {
    pub(super) file: PathBuf,
    /// The .asf of an .amc.
    pub(super) skeleton: Option<PathBuf>,
}

/// The motions under a folder, ordered by path: .bvh, .amc with the .asf beside it, DeepMimic clips.
///
/// # Errors
/// When the folder cannot be read, an .amc has no skeleton beside it, or there is no motion.
pub(super) fn recordings(folder: &Path) -> Result<Vec<Recording>> {
    let files = files_under(folder).with_context(|| format!("cannot read the motions of {}", folder.display()))?;
    let mut found = Vec::new();
    for file in &files {
        match extension(file).as_str() {
            "bvh" => found.push(Recording { file: file.clone(), skeleton: None }),
            "amc" => found.push(Recording { file: file.clone(), skeleton: Some(skeleton_of(file, &files)?) }),
            "txt" | "json" if is_clip(file)? => found.push(Recording { file: file.clone(), skeleton: None }),
            _ => {}
        }
    }
    if found.is_empty() {
        bail!("{} holds no motion, expected .bvh, .amc with .asf, or DeepMimic clips", folder.display());
    }
    Ok(found)
}

/// The skinned people under a folder, ordered by path.
///
/// # Errors
/// When the folder cannot be read or there is nobody.
pub(super) fn people(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = files_under(folder).with_context(|| format!("cannot read the people of {}", folder.display()))?;
    files.retain(|file| ["glb", "gltf"].contains(&extension(file).as_str()));
    if files.is_empty() {
        bail!("{} holds no person, expected .glb or .gltf files", folder.display());
    }
    Ok(files)
}

fn extension(file: &Path) -> String {
    file.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Every file under a folder by its absolute path, in an order that does not depend on the file system.
fn files_under(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(files_under(&path)?);
        } else if check_regular(&path).is_ok() {
            files.push(absolute(path)?);
        }
    }
    files.sort();
    Ok(files)
}

/// CMU names a subject's skeleton `02.asf` and the trials `02_01.amc`; a folder with one skeleton needs no names.
fn skeleton_of(motion: &Path, files: &[PathBuf]) -> Result<PathBuf> {
    let stem = |file: &Path| file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let beside: Vec<&PathBuf> =
        files.iter().filter(|file| extension(file) == "asf" && file.parent() == motion.parent()).collect();
    let name = stem(motion);
    let named = beside.iter().find(|file| stem(file) == name || Some(stem(file).as_str()) == name.split('_').next());
    match (named, beside.as_slice()) {
        (Some(skeleton), _) | (None, [skeleton]) => Ok((*skeleton).clone()),
        _ => bail!("{} has no skeleton beside it, expected an .asf file", motion.display()),
    }
}

/// Whether a text file is a DeepMimic clip, and no licence, description or character.
fn is_clip(file: &Path) -> Result<bool> {
    let mut bytes = Vec::new();
    let read = CLIP.open(file)?.take(4096).read_to_end(&mut bytes);
    read.with_context(|| format!("cannot read {}", file.display()))?;
    let begin = String::from_utf8_lossy(&bytes);
    Ok(begin.trim_start().starts_with('{') && begin.contains("\"Frames\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_are_told_from_what_lies_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("b")).unwrap();
        for (name, text) in [
            ("b/02_01.amc", ""),
            ("b/02.asf", ""),
            ("b/03.asf", ""),
            ("a.bvh", ""),
            ("LICENSE.txt", "Free to use"),
            ("character.txt", "{ \"Skeleton\": {} }"),
            ("kick.txt", "{\n\"Loop\": \"none\",\n\"Frames\": []}"),
            ("nobody.glb", ""),
        ] {
            fs::write(at(name), text).unwrap();
        }
        let found = recordings(folder.path()).unwrap();
        let names: Vec<_> =
            found.iter().map(|one| one.file.file_name().unwrap().to_string_lossy().into_owned()).collect();
        assert_eq!(names, ["a.bvh", "02_01.amc", "kick.txt"]);
        assert_eq!(found[1].skeleton.as_deref().unwrap().file_name().unwrap(), "02.asf");
        assert_eq!(people(folder.path()).unwrap().len(), 1);
        fs::remove_file(at("b/02.asf")).unwrap();
        assert_eq!(recordings(folder.path()).unwrap()[1].skeleton.as_deref().unwrap().file_name().unwrap(), "03.asf");
        fs::remove_file(at("b/03.asf")).unwrap();
        let error = recordings(folder.path()).unwrap_err().to_string();
        assert!(error.contains("02_01.amc has no skeleton beside it"), "{error}");
        let error = format!("{:#}", recordings(&at("nowhere")).unwrap_err());
        assert!(error.contains("nowhere") && error.contains("cannot read"), "{error}");
        let error = people(&at("b")).unwrap_err().to_string();
        assert!(error.contains("holds no person"), "{error}");
    }
}
