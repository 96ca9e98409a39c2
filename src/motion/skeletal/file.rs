//! Files of skeletal motion by their extension.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use super::super::parse_bvh;
use super::super::whole_file::{extension, read_bytes, text};
use super::deepmimic::DeepMimicSkeleton;
use super::{SkeletalMotion, parse_amc, parse_asf, parse_deepmimic, parse_deepmimic_skeleton};
use crate::files::choices;

/// Frames a second of AMC files, which do not say it: those of CMU's collection.
const AMC_RATE: f64 = 120.0;

/// Reads a skeleton's motion: `.bvh`, `.amc` (with the `.asf` that `skeleton` names) or a DeepMimic clip (`.txt` or `.json`; the
/// published humanoid unless `skeleton` names a character file). `rate` replaces the frame rate of an AMC file, 120 Hz.
///
/// # Errors
/// One sentence with the file, the line or frame, what was found and what was expected; an AMC file without a skeleton, or
/// an extension that is none of these.
pub fn read_skeletal_motion(path: &Path, skeleton: Option<&Path>, rate: Option<f64>) -> Result<SkeletalMotion> {
    let extension = extension(path);
    ensure!(extension != "asf", "{} is a skeleton, expected the .amc file that moves it", path.display());
    let format = MotionFormat::from_name(&extension).with_context(|| path.display().to_string())?;
    (format.reader())(path, skeleton, rate)
}

choices! {
    /// The formats that hold skeletal motion, by their extensions.
    "motion format" pub enum MotionFormat => reader: Reader {
        /// BVH, with its own skeleton.
        "bvh" Bvh => bvh,
        /// CMU's AMC, beside the ASF file of its skeleton.
        "amc" Amc => amc,
        /// A DeepMimic clip.
        "txt" DeepMimic => deepmimic,
        /// A DeepMimic clip.
        "json" DeepMimicJson => deepmimic,
    }
}

type Reader = fn(&Path, Option<&Path>, Option<f64>) -> Result<SkeletalMotion>;

/// What `parse` makes of a text file and its name.
fn parsed<T>(path: &Path, parse: impl FnOnce(&str, &str) -> Result<T>) -> Result<T> {
    let name = path.display().to_string();
    parse(text(&read_bytes(path)?, &name)?, &name)
}

fn bvh(path: &Path, skeleton: Option<&Path>, _rate: Option<f64>) -> Result<SkeletalMotion> {
    if let Some(skeleton) = skeleton {
        bail!("{} holds its own skeleton, expected none beside it (found {})", path.display(), skeleton.display());
    }
    parsed(path, |text, name| parse_bvh(text, name)?.to_skeletal().with_context(|| name.to_string()))
}

fn amc(path: &Path, skeleton: Option<&Path>, rate: Option<f64>) -> Result<SkeletalMotion> {
    let Some(skeleton) = skeleton else {
        bail!("{} needs its skeleton, expected an .asf file to be named beside it", path.display());
    };
    let skeleton = parsed(skeleton, parse_asf)?;
    parsed(path, |text, name| parse_amc(text, name, &skeleton, rate.unwrap_or(AMC_RATE)))
}

fn deepmimic(path: &Path, skeleton: Option<&Path>, _rate: Option<f64>) -> Result<SkeletalMotion> {
    let skeleton = match skeleton {
        None => DeepMimicSkeleton::humanoid(),
        Some(character) => parsed(character, parse_deepmimic_skeleton)?,
    };
    parsed(path, |text, name| parse_deepmimic(text, name, &skeleton))
}
