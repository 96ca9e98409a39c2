//! A trial: what its files say of it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::chosen_calibration::calibration;
use super::config::{Config, LargeGaps};
use super::videos::{Recording, recordings};
use crate::sequence::calibration::read_cameras;
use crate::sequence::video::probe_video;

/// What one camera recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pose2SimView {
    /// The camera's name in the calibration.
    pub camera: String,
    /// The recording's name, without an ending.
    pub name: String,
    /// The video, or the pattern of numbered pictures.
    pub source: PathBuf,
    /// The camera's picture size, pixels.
    pub size: [u32; 2],
}

/// A trial of Pose2Sim as its folders hold it; what is `None` nobody says.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose2SimTrial {
    /// Its folder.
    pub dir: PathBuf,
    /// That folder's name, which its files bear.
    pub name: String,
    /// Its own Config.toml.
    pub config: PathBuf,
    /// The person's height, mm.
    pub height: Option<f64>,
    /// Frames a second: those of the configuration, or the videos' own, rounded as Pose2Sim rounds them.
    pub fps: Option<f64>,
    /// The first frame and the one after the last; all without.
    pub frames: Option<[usize; 2]>,
    /// The points that its kinematics are told of.
    pub pose_model: String,
    /// The longest gap that a line bridges, frames.
    pub longest_line: usize,
    /// What longer gaps hold.
    pub large_gaps: LargeGaps,
    /// The calibration that is taken.
    pub calibration: PathBuf,
    /// Those that were there too.
    pub other_calibrations: Vec<PathBuf>,
    /// The cameras with their recordings, in the order of these.
    pub views: Vec<Pose2SimView>,
}

impl Pose2SimTrial {
    /// Of a folder and those whose Config.toml count for it, its own first.
    pub(super) fn open(dir: &Path, levels: &[PathBuf]) -> Result<Self> {
        let config = Config::read(levels)?;
        config.check_people()?;
        let (calibration, other_calibrations) = calibration(levels)?;
        let recordings = recordings(dir)?;
        let views = views(&recordings, &calibration, dir)?;
        let fps = match config.frame_rate()? {
            Some(rate) => Some(rate),
            None if recordings.iter().all(|recording| recording.is_video) => Some(common_rate(&recordings)?),
            None => None,
        };
        Ok(Self {
            dir: dir.to_path_buf(),
            name: dir.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            config: config.file().to_path_buf(),
            height: config.height()?,
            fps,
            frames: config.frame_range()?,
            pose_model: config.pose_model()?,
            longest_line: config.longest_line()?,
            large_gaps: config.large_gaps()?,
            calibration,
            other_calibrations,
            views,
        })
    }

    /// Whether its kinematics are told of points that are other than Halpe26's.
    pub fn has_other_points(&self) -> bool {
        !["body_with_feet", "halpe_26", "lower_body", "halpe_26_lower"]
            .contains(&self.pose_model.to_lowercase().as_str())
    }

    /// What is read from where, a line each.
    pub fn told(&self) -> String {
        let mut text = String::new();
        let shown = |path: &Path| path.strip_prefix(&self.dir).unwrap_or(path).display().to_string();
        // Writing into a String cannot fail.
        let _ = writeln!(text, "cameras from {}", shown(&self.calibration));
        for other in &self.other_calibrations {
            let _ = writeln!(text, "  the newest is taken, and not {}", shown(other));
        }
        for view in &self.views {
            let _ = writeln!(text, "  {} filmed {}", view.camera, shown(&view.source));
        }
        text
    }
}

/// Cameras and recordings: by name where each recording bears a camera's, else in order, as Pose2Sim pairs them.
fn views(recordings: &[Recording], calibration: &Path, dir: &Path) -> Result<Vec<Pose2SimView>> {
    let cameras = read_cameras(calibration)?;
    let of_name =
        |recording: &Recording| cameras.iter().find(|camera| camera.name.eq_ignore_ascii_case(&recording.name));
    let paired: Option<Vec<_>> = recordings.iter().map(of_name).collect();
    let paired = match paired {
        Some(paired) => paired,
        None => {
            ensure!(
                recordings.len() == cameras.len(),
                "{} holds {} cameras and {} {} recordings, expected as many, or recordings that bear the cameras' names",
                calibration.display(),
                cameras.len(),
                dir.join("videos").display(),
                recordings.len()
            );
            cameras.iter().collect()
        }
    };
    let view = |(camera, recording): (&crate::geometry::Camera, &Recording)| Pose2SimView {
        camera: camera.name.clone(),
        name: recording.name.clone(),
        source: recording.source.clone(),
        size: camera.size,
    };
    Ok(paired.into_iter().zip(recordings).map(view).collect())
}

/// The rate of all videos, frames a second, as a manifest reads it (where pictures are missing that at which the others came), and whole as
/// Pose2Sim takes it.
fn common_rate(videos: &[Recording]) -> Result<f64> {
    let mut common: Option<(&Path, f64)> = None;
    for Recording { source, .. } in videos {
        let rate = probe_video(source)?.fps;
        let rate =
            rate.with_context(|| format!("{} tells no frame rate, expected a video that does", source.display()))?;
        let rate = rate.round().max(1.0);
        let (first, expected) = *common.get_or_insert((source, rate));
        ensure!(
            rate == expected,
            "{} has {rate} frames a second and {} has {expected}, expected videos of one rate",
            source.display(),
            first.display()
        );
    }
    common.map(|(_, rate)| rate).context("there is no video")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::manifest::recordings_tests::numbered_video;
    use crate::sequence::video::tests::ffmpeg_is_here;

    #[test]
    fn a_video_that_lacks_pictures_has_the_rate_at_which_the_others_came() {
        if !ffmpeg_is_here("a_video_that_lacks_pictures_has_the_rate_at_which_the_others_came") {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let video = |name: &str, rate: u32, missing: &str| {
            let source = folder.path().join(name);
            numbered_video(&source, rate, 24, missing);
            Recording { name: name.to_string(), source, is_video: true }
        };
        let (whole, torn) = (video("a.mkv", 30, "0"), video("b.mkv", 30, "between(n,8,15)"));
        assert_eq!(common_rate(&[whole, torn]).unwrap(), 30.0);
        let (slow, fast) = (video("c.mkv", 25, "0"), video("d.mkv", 50, "0"));
        assert!(common_rate(&[slow, fast]).unwrap_err().to_string().contains("expected videos of one rate"));
    }
}
