//! Files of skeletal motion by their extension.

use std::path::Path;

use anyhow::{Context, Result, bail};

use super::super::parse_bvh;
use super::super::point_file::{read_bytes, text};
use super::deepmimic::DeepMimicSkeleton;
use super::{SkeletalMotion, parse_amc, parse_asf, parse_deepmimic, parse_deepmimic_skeleton};

/// Frames a second of AMC files, which do not say it: those of CMU's collection.
const AMC_RATE: f64 = 120.0;

/// Reads a skeleton's motion: `.bvh`, `.amc` (with the `.asf` that `skeleton` names) or a DeepMimic clip (`.txt` or `.json`; the
/// published humanoid unless `skeleton` names a character file). `rate` replaces the frame rate of an AMC file, 120 Hz.
///
/// # Errors
/// One sentence with the file, the line or frame, what was found and what was expected; an AMC file without a skeleton, or
/// an extension that is none of these.
pub fn read_skeletal_motion(path: &Path, skeleton: Option<&Path>, rate: Option<f64>) -> Result<SkeletalMotion> {
    let name = path.display().to_string();
    let load = |path: &Path| -> Result<(Vec<u8>, String)> { Ok((read_bytes(path)?, path.display().to_string())) };
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match (extension.as_str(), skeleton) {
        ("bvh", None) => {
            let bytes = read_bytes(path)?;
            parse_bvh(text(&bytes, &name)?, &name)?.to_skeletal().with_context(|| name.clone())
        }
        ("bvh", Some(skeleton)) => {
            bail!("{name} holds its own skeleton, expected none beside it (found {})", skeleton.display())
        }
        ("amc", Some(skeleton)) => {
            let (bytes, asf) = load(skeleton)?;
            let skeleton = parse_asf(text(&bytes, &asf)?, &asf)?;
            let bytes = read_bytes(path)?;
            parse_amc(text(&bytes, &name)?, &name, &skeleton, rate.unwrap_or(AMC_RATE))
        }
        ("amc", None) => bail!("{name} needs its skeleton, expected an .asf file to be named beside it"),
        ("txt" | "json", skeleton) => {
            let skeleton = match skeleton {
                None => DeepMimicSkeleton::humanoid(),
                Some(path) => {
                    let (bytes, character) = load(path)?;
                    parse_deepmimic_skeleton(text(&bytes, &character)?, &character)?
                }
            };
            let bytes = read_bytes(path)?;
            parse_deepmimic(text(&bytes, &name)?, &name, &skeleton)
        }
        ("asf", _) => bail!("{name} is a skeleton, expected the .amc file that moves it"),
        (other, _) => bail!("{name} ends in `.{other}`, expected .bvh, .amc or a DeepMimic .txt"),
    }
}
