//! The sequence.toml of a trial, once everything is known that it needs.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use toml::{Table, Value};

use super::super::filmed_plate::filmed_plate;
use super::POSE2SIM_OWN;
use crate::files::seen_from;
use crate::sequence::{Pose2SimTrial, Pose2SimView};

/// Length of the longer side that is worked at where nobody says, pixels.
const WORKING_SIDE: f64 = 480.0;

/// Folders from a trial's own up to its session's: the trial, its participant's folder, the session's. What lies outside is named in full.
const SESSION: usize = 3;

/// What a user gives beside a project's files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose2SimGiven {
    /// The person's height, mm.
    pub height: Option<f64>,
    /// The person's body.toml.
    pub body: Option<PathBuf>,
    /// Whether a first pose is given.
    pub has_start: bool,
    /// A folder with pictures of the empty scene.
    pub plates: Option<PathBuf>,
    /// Frames a second.
    pub fps: Option<f64>,
    /// Working size over stored size.
    pub scale: Option<f64>,
}

/// The sequence.toml for the folder [`POSE2SIM_OWN`] of a trial. What is given goes before what its files say.
///
/// # Errors
/// When something is missing that no file says: the sentence names the option that gives it; when a plate or the body is not there.
pub fn pose2sim_manifest(trial: &Pose2SimTrial, given: &Pose2SimGiven) -> Result<Table> {
    let config = trial.config.display();
    let own = trial.dir.join(POSE2SIM_OWN);
    let Some(fps) = given.fps.or(trial.fps) else {
        bail!("{config}: project.frame_rate is 'auto', which pictures do not tell: give --fps HZ");
    };
    let path = |file: &Path| Value::String(seen_from(&own, file, SESSION).to_string_lossy().into_owned());
    let mut manifest = Table::new();
    manifest.insert("name".into(), Value::String(trial.name.clone()));
    manifest.insert("fps".into(), Value::Float(fps));
    manifest.insert("scale".into(), Value::Float(given.scale.unwrap_or_else(|| scale(&trial.views))));
    manifest.insert("cameras".into(), path(&trial.calibration));
    match (&given.body, given.height.or(trial.height)) {
        (Some(body), _) => {
            let body = fs::canonicalize(body).with_context(|| format!("cannot read {}", body.display()))?;
            manifest.insert("body".into(), path(&body));
        }
        (None, Some(height)) => {
            ensure!(
                !given.has_start,
                "--start is a pose of a body that is known: give --body FILE with it, or leave both to be found"
            );
            manifest.insert("height".into(), Value::Float(height));
        }
        (None, None) => bail!(
            "{config}: project.participant_height is 'auto', and the body is measured by it: give --height MM, or a body that was \
             measured, --body FILE"
        ),
    }
    // Without plates the empty scene is learnt from the whole recordings.
    let mut views = Vec::new();
    for view in &trial.views {
        let mut table = Table::new();
        table.insert("camera".into(), Value::String(view.camera.clone()));
        table.insert("source".into(), path(&view.source));
        if let Some(plates) = &given.plates {
            table.insert(
                "background".into(),
                path(&filmed_plate(&[plates.join(&trial.name), plates.clone()], &[&view.camera, &view.name])?),
            );
        }
        views.push(Value::Table(table));
    }
    manifest.insert("view".into(), Value::Array(views));
    Ok(manifest)
}

/// The part of the pictures' size that is worked at.
fn scale(views: &[Pose2SimView]) -> f64 {
    let longest = views.iter().flat_map(|view| view.size).max().unwrap_or(1);
    let scale = WORKING_SIDE / f64::from(longest.max(1));
    ((scale * 1000.0).round() / 1000.0).clamp(0.001, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_worked_at_smaller() {
        let view = |size| Pose2SimView { camera: String::new(), name: String::new(), source: PathBuf::new(), size };
        assert_eq!(scale(&[view([1088, 1920]), view([1080, 1920])]), 0.25);
        assert_eq!(scale(&[view([320, 240])]), 1.0);
    }
}
