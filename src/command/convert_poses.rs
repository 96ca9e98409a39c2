//! `pantin convert` of poses and their body.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::output::{say, tell};
use crate::body::{Body, Coordinates, PoseTable};
use crate::files::{Overwrite, write_atomically};
use crate::motion::{
    Convention, LeftAsIs, LowPass, PointFormat, PointTrajectory, write_bvh, write_mot, write_points_by,
};

/// How poses become other files.
#[derive(clap::Args, Debug)]
pub(super) struct PoseFlags {
    /// IN is poses.csv of this body: its joints become points, its bones and skin a motion (.bvh, .glb, .mot). Needs --rate.
    #[arg(long, value_name = "body.toml")]
    body: Option<PathBuf>,
    /// What a .mot calls the body's degrees of freedom, where not as usual: a mapping file.
    #[arg(long, value_name = "FILE.toml", requires = "body")]
    coordinates: Option<PathBuf>,
}

/// Says how a motion was smoothed.
pub(super) fn tell_smoothed(low_pass: &LowPass, left: LeftAsIs) {
    tell!("smoothed at {}", low_pass.told());
    if let Some(left) = left.told() {
        tell!("note: {left}");
    }
}

/// Endings of files that points alone do not make.
const MOTIONS: [&str; 2] = ["glb", "mot"];

fn is_motion(path: &Path) -> Option<&'static str> {
    let end = path.extension()?;
    MOTIONS.into_iter().find(|known| end.eq_ignore_ascii_case(known))
}

impl PoseFlags {
    /// Whether this is about poses.
    pub(super) fn is_asked(&self) -> bool {
        self.body.is_some()
    }

    /// Converts, if this is about poses.
    ///
    /// # Errors
    /// When a file cannot be read or written, or OUT needs a body that is not named.
    pub(super) fn convert(
        &self,
        input: &Path,
        output: &Path,
        rate: Option<f64>,
        smooth: Option<f64>,
        convention: Convention,
        overwrite: Overwrite,
    ) -> Result<bool> {
        let Some(body) = &self.body else {
            if let Some(end) = is_motion(output) {
                anyhow::bail!(
                    "{} cannot be made of points: a .{end} needs poses.csv and --body body.toml",
                    output.display()
                );
            }
            return Ok(false);
        };
        let body = Body::load(body)?;
        let mut poses = PoseTable::read(input, &body)?;
        let rate = rate.with_context(|| format!("{} has no times, expected --rate HZ", input.display()))?;
        let mut smoothed = None;
        if let Some(cutoff) = smooth {
            let low_pass = LowPass::new(cutoff, rate).with_context(|| input.display().to_string())?;
            let left = poses.smooth(&body, &low_pass, &|_| false).with_context(|| input.display().to_string())?;
            tell_smoothed(&low_pass, left);
            smoothed = Some(low_pass.cutoff());
        }
        let frames = poses.frames.len();
        let name = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let coordinates = self.coordinates.as_deref();
        ensure!(
            coordinates.is_none() || is_motion(output) == Some("mot"),
            "--coordinates is for .mot files, found {}",
            output.display()
        );
        match is_motion(output) {
            Some("glb") => write_atomically(output, overwrite, |out| body.write_gltf(out, &poses, rate))?,
            Some(_) => {
                let coordinates =
                    coordinates.map_or_else(|| Coordinates::of_body(&body), |path| Coordinates::read(path, &body))?;
                let table = coordinates.of_poses(&body, &poses, rate)?;
                write_atomically(output, overwrite, |out| write_mot(out, &table, &name))?;
            }
            None if PointFormat::of(output)? == PointFormat::Bvh => {
                let motion = body.to_bvh(&poses, rate)?.in_unit(convention.bvh_unit())?;
                write_atomically(output, overwrite, |out| write_bvh(out, &motion))?;
            }
            None => {
                let points = PointTrajectory { smoothed, ..body.joint_trajectory(&poses, rate)? };
                write_points_by(output, points, convention, overwrite)?;
            }
        }
        say!("{}: {} bones, {frames} frames", output.display(), body.bones.len());
        Ok(true)
    }
}
