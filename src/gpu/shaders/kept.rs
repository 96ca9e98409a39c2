//! What the shaders were compiled to, kept in the repository under `glsl/compiled/`, so that a build needs no shader compiler: a file
//! of Rust a room, a file of words a stage, and the list of all that they were made from, each with the hash of its text.

use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The folder under the shader folder that holds them.
pub const FOLDER: &str = "compiled";
/// The list of sources in it.
pub const LIST: &str = "sources.txt";
/// What makes them fresh again.
const ADVICE: &str = "run `make shaders`";
/// What else decides their content, from the crate's folder on.
const GENERATOR: [&str; 6] = [
    "src/gpu/interface.rs",
    "src/gpu/shaders/compile.rs",
    "src/gpu/shaders/constants.rs",
    "src/gpu/shaders/generate.rs",
    "src/gpu/shaders/layouts.rs",
    "src/gpu/shaders/reflect.rs",
];

/// FNV-1a, 64 bits. Lines end alike however the files were checked out.
fn hash(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .filter(|&&byte| byte != b'\r')
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Every file under `path`, or `path` itself, each under its path from `base` on, with its hash; not the kept ones, nor the hidden
/// ones that editors leave.
fn gather(base: &Path, path: &Path, sources: &mut BTreeMap<String, u64>) -> Result<()> {
    let cannot = || format!("cannot read {}", path.display());
    if path.is_dir() {
        for entry in fs::read_dir(path).with_context(cannot)? {
            let below = entry.with_context(cannot)?.path();
            let hidden = below.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if !hidden && below != base.join("glsl").join(FOLDER) {
                gather(base, &below, sources)?;
            }
        }
        return Ok(());
    }
    let parts: Vec<_> =
        path.strip_prefix(base)?.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    sources.insert(parts.join("/"), hash(&fs::read(path).with_context(cannot)?));
    Ok(())
}

/// Every source of the kept files and its hash, by its path from the crate's folder on.
///
/// # Errors
/// When one cannot be read.
pub fn sources(base: &Path) -> Result<BTreeMap<String, u64>> {
    let mut sources = BTreeMap::new();
    gather(base, &base.join("glsl"), &mut sources)?;
    for path in GENERATOR.map(|path| base.join(path)).iter().filter(|path| path.exists()) {
        gather(base, path, &mut sources)?;
    }
    Ok(sources)
}

/// Whether what is kept in the crate's folder `base` was made from the sources that are there now.
///
/// # Errors
/// One sentence that names the first file that was changed, added or removed since, and what to do.
pub fn check(base: &Path) -> Result<()> {
    let path = base.join("glsl").join(FOLDER).join(LIST);
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}: {ADVICE}", path.display()))?;
    let mut known = BTreeMap::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
        let wrong = || {
            format!("{}, line {}: expected a hash of 16 digits and a path, found {line:?}", path.display(), number + 1)
        };
        let (hash, source) = line.split_once(' ').with_context(wrong)?;
        known.insert(source.to_string(), u64::from_str_radix(hash, 16).with_context(wrong)?);
    }
    let now = sources(base)?;
    for (source, hash) in &now {
        match known.get(source) {
            None => bail!("{source} is new since the shaders in glsl/{FOLDER} were compiled: {ADVICE}"),
            Some(then) => {
                ensure!(
                    then == hash,
                    "{source} has changed since the shaders in glsl/{FOLDER} were compiled: {ADVICE}"
                );
            }
        }
    }
    if let Some(gone) = known.keys().find(|source| !now.contains_key(*source)) {
        bail!("{gone} is gone since the shaders in glsl/{FOLDER} were compiled: {ADVICE}");
    }
    Ok(())
}
