//! Which folders are trials, and which files count for them.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::config::{CONFIG, Config};
use super::listing::folders_of;
use super::trial::Pose2SimTrial;

/// How far below a session its trials may lie: in the folder of a participant, and in one of his.
const DEEPEST: usize = 3;

/// The trials of a folder of Pose2Sim, in the order of their paths: the folder itself where no Config.toml lies below it, else those
/// folders below with one that have none below themselves, but for those that `exclude_from_batch` names.
///
/// # Errors
/// One sentence naming the file and key, the folder, what was found and what was expected: no Config.toml, a wrong value in one, no
/// calibration, no videos, cameras that do not go with the videos, several people.
pub fn pose2sim_trials(dir: &Path) -> Result<Vec<Pose2SimTrial>> {
    if !dir.is_dir() {
        bail!("there is no folder {}, expected one of Pose2Sim, with a {CONFIG} in it", dir.display());
    }
    let dir = fs::canonicalize(dir).with_context(|| format!("cannot read the folder {}", dir.display()))?;
    let mut below = Vec::new();
    collect(&dir, DEEPEST, &mut below)?;
    below.sort();
    let is_leaf = |folder: &PathBuf| !below.iter().any(|other| other != folder && other.starts_with(folder));
    let mut folders: Vec<PathBuf> = below.iter().filter(|folder| is_leaf(folder)).cloned().collect();
    if folders.is_empty() {
        if !dir.join(CONFIG).is_file() {
            bail!("{} has no {CONFIG}, nor has a folder below it, expected a project of Pose2Sim", dir.display());
        }
        return Ok(vec![Pose2SimTrial::open(&dir, &levels(&dir, &dir))?]);
    }
    let found = folders.len();
    if dir.join(CONFIG).is_file() {
        let excluded = Config::read(std::slice::from_ref(&dir))?.excluded()?;
        let is_named = |folder: &Path| {
            let own = folder.file_name().map(|name| name.to_string_lossy());
            let path = folder.strip_prefix(&dir).map(|path| path.to_string_lossy());
            excluded.iter().any(|name| own.as_deref() == Some(name) || path.as_deref().is_ok_and(|path| path == name))
        };
        folders.retain(|folder| !is_named(folder));
    }
    if folders.is_empty() {
        bail!("{}: project.exclude_from_batch names all {found} trials", dir.join(CONFIG).display());
    }
    folders.iter().map(|folder| Pose2SimTrial::open(folder, &levels(folder, &dir))).collect()
}

fn collect(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) -> Result<()> {
    if depth == 0 {
        return Ok(());
    }
    for inner in folders_of(folder)? {
        if inner.join(CONFIG).is_file() {
            found.push(inner.clone());
        }
        collect(&inner, depth - 1, found)?;
    }
    Ok(())
}

/// The folders whose Config.toml count for a trial, its own first: those between it and the folder that was named, and those right above
/// that.
fn levels(trial: &Path, dir: &Path) -> Vec<PathBuf> {
    let has_config = |folder: &&Path| folder.join(CONFIG).is_file();
    let inner = trial.ancestors().take_while(|folder| folder.starts_with(dir)).filter(has_config);
    let above = dir.ancestors().skip(1).take_while(has_config);
    inner.chain(above).map(Path::to_path_buf).collect()
}
