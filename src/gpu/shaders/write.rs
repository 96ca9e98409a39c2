//! Writes what the shaders compile to into the repository.

use super::generate::{generate, rooms};
use super::kept::{FOLDER, LIST, sources};
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The list of the sources in the crate's folder `base`, as it is kept.
fn list(base: &Path) -> Result<String> {
    let sources = sources(base)?;
    let mut text = String::from(
        "# What the files beside this one were made from, with the FNV-1a hash of each; `make shaders` writes them all.\n",
    );
    for (path, hash) in sources {
        writeln!(text, "{hash:016x} {path}")?;
    }
    Ok(text)
}

/// Every file of the crate's folder `base` that holds something compiled: its path from the kept folder on, and its content.
///
/// # Errors
/// What does not compile or cannot be read.
pub fn files(base: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>> {
    let root = base.join("glsl");
    let mut files = BTreeMap::new();
    for room in rooms(&root)? {
        let generated = generate(&root, &room)?;
        files.insert(PathBuf::from(format!("{room}.rs")), generated.source.into_bytes());
        for (name, words) in generated.words {
            let bytes = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            files.insert(PathBuf::from(format!("{name}.spv")), bytes);
        }
    }
    files.insert(PathBuf::from(LIST), list(base)?.into_bytes());
    Ok(files)
}

/// Compiles everything, and makes the kept folder hold that and nothing else.
///
/// # Errors
/// What does not compile, or cannot be written.
#[allow(dead_code, reason = "the build alone writes")]
pub fn write(base: &Path) -> Result<()> {
    let files = files(base)?;
    let folder = base.join("glsl").join(FOLDER);
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("cannot clear {}", folder.display()))?;
    }
    for (name, content) in files {
        let path = folder.join(name);
        let cannot = || format!("cannot write {}", path.display());
        fs::create_dir_all(path.parent().unwrap_or(&folder)).with_context(cannot)?;
        fs::write(&path, content).with_context(cannot)?;
    }
    Ok(())
}
