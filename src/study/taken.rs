//! A recording taken otherwise than it was made: fewer cameras, fewer frames, backwards.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use serde::Serialize;

use super::settings::SequenceSettings;
use crate::body::Body;
use crate::files::{OutputFolder, Overwrite, expected};
use crate::motion::PointTrajectory;
use crate::sequence::{Sequence, write_cameras_toml};
use crate::track::{FitSettings, FrameRange, fit};

/// sequence.toml of what was taken.
#[derive(Serialize)]
struct Manifest<'a> {
    name: &'a str,
    fps: f64,
    cameras: &'a str,
    body: Option<&'a Path>,
    height: Option<f64>,
    measure_again: Option<bool>,
    start: Option<&'a Path>,
    view: Vec<ManifestView>,
    objective: Option<&'a toml::Table>,
    features: Option<&'a toml::Table>,
}

#[derive(Serialize)]
struct ManifestView {
    camera: String,
    source: String,
    background: Option<String>,
    background_doubtful: Option<f64>,
    mask: Option<String>,
    ignore: Option<String>,
}

/// The sequence as its settings take it. Where frames are left out or turned round, its pictures are written into `output` once, at
/// the working size.
///
/// # Errors
/// When a camera is unknown, the pictures cannot be read or written, or the first pose of a reversed sequence cannot be found.
pub(super) fn taken(mut sequence: Sequence, settings: &SequenceSettings, output: &OutputFolder) -> Result<Sequence> {
    if !settings.cameras.is_empty() {
        with_cameras(&mut sequence, &settings.cameras)?;
    }
    if settings.every.unwrap_or(1) == 1 && !settings.reversed {
        return Ok(sequence);
    }
    let folder = OutputFolder::open(&output.path().join("sequences").join(settings.name()))?;
    if !folder.path().join("sequence.toml").exists() {
        write(&sequence, settings, &folder)?;
    }
    Sequence::open(folder.path())
}

/// Keeps the views of some cameras.
fn with_cameras(sequence: &mut Sequence, names: &[String]) -> Result<()> {
    let known: Vec<String> = sequence.views.iter().map(|view| view.camera.clone()).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(name)) {
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        bail!("cameras names `{name}`, {}", expected(name, &known));
    }
    let mut keep = known.iter().map(|name| names.contains(name));
    sequence.views.retain(|_| keep.next().unwrap_or(false));
    let mut keep = known.iter().map(|name| names.contains(name));
    sequence.sizes.retain(|_| keep.next().unwrap_or(false));
    sequence.cameras.retain(|camera| names.contains(&camera.name));
    Ok(())
}

/// Which frame of the recording each frame shows.
fn shown(settings: &SequenceSettings, frame_count: usize) -> Vec<usize> {
    let mut frames: Vec<usize> = (0..frame_count).step_by(settings.every.unwrap_or(1).max(1)).collect();
    if settings.reversed {
        frames.reverse();
    }
    frames
}

/// The truth of what is shown.
pub(super) fn taken_truth(truth: &PointTrajectory, settings: &SequenceSettings, frame_count: usize) -> PointTrajectory {
    let row = |frame: usize| {
        let row = frame.checked_sub(truth.first_frame).and_then(|row| truth.frames.get(row));
        row.cloned().unwrap_or_else(|| vec![None; truth.names.len()])
    };
    PointTrajectory {
        names: truth.names.clone(),
        rate: truth.rate / settings.every.unwrap_or(1).max(1) as f64,
        first_frame: 0,
        frames: shown(settings, frame_count).into_iter().map(row).collect(),
        smoothed: None,
    }
}

fn write(sequence: &Sequence, settings: &SequenceSettings, folder: &OutputFolder) -> Result<()> {
    let shown: BTreeMap<usize, usize> =
        shown(settings, sequence.frame_count).into_iter().enumerate().map(|(now, before)| (before, now)).collect();
    write_cameras_toml(&folder.file("cameras.toml")?, &sequence.cameras, Overwrite::Replace)?;
    let save = |picture: &dyn Fn(&Path) -> image::ImageResult<()>, name: String| -> Result<()> {
        let path = folder.file(&name)?;
        picture(&path).with_context(|| format!("cannot write {}", path.display()))
    };
    let plates = sequence.backgrounds()?;
    for (view, plate) in sequence.views.iter().zip(&plates) {
        if let Some(plate) = plate {
            save(&|path| plate.save(path), format!("plates/{}.png", view.camera))?;
        }
    }
    let mut reader = sequence.read_frames(0..sequence.frame_count)?;
    while let Some(set) = reader.next_frame()? {
        let Some(now) = shown.get(&set.index) else { continue };
        let views = sequence.views.iter().zip(&set.pictures).zip(&set.masks).zip(&set.ignored);
        for (((view, picture), mask), ignored) in views {
            save(&|path| picture.save(path), format!("frames/{}_{now:04}.png", view.camera))?;
            if let Some(ignored) = ignored {
                save(&|path| ignored.save(path), format!("ignored/{}_{now:04}.png", view.camera))?;
            }
            if let Some(mask) = mask {
                save(&|path| mask.save(path), format!("masks/{}_{now:04}.png", view.camera))?;
            }
        }
    }
    let body = if sequence.needs_body() { None } else { Some(std::path::absolute(&sequence.body)?) };
    // What was the first frame is the last one now.
    let start = match (&settings.start, settings.reversed) {
        (Some(start), _) => Some(std::path::absolute(start)?),
        (None, false) => sequence.start.as_deref().map(std::path::absolute).transpose()?,
        (None, true) => None,
    };
    let write_manifest = |start: Option<&Path>| {
        let view = |(view, plate): (&crate::sequence::View, &Option<_>)| {
            let name = &view.camera;
            ManifestView {
                camera: name.clone(),
                source: format!("frames/{name}_%04d.png"),
                background: plate.as_ref().map(|_| format!("plates/{name}.png")),
                background_doubtful: plate
                    .as_ref()
                    .map(|_| view.background_doubtful)
                    .filter(|doubtful| *doubtful > 0.0),
                mask: view.mask.as_ref().map(|_| format!("masks/{name}_%04d.png")),
                ignore: view.ignored.as_ref().map(|_| format!("ignored/{name}_%04d.png")),
            }
        };
        let manifest = Manifest {
            name: &sequence.name,
            fps: sequence.fps / settings.every.unwrap_or(1).max(1) as f64,
            cameras: "cameras.toml",
            body: body.as_deref(),
            height: sequence.height,
            measure_again: sequence.measure_again,
            start,
            view: sequence.views.iter().zip(&plates).map(view).collect(),
            objective: sequence.objective.as_ref(),
            features: sequence.features.as_ref(),
        };
        toml::to_string(&manifest).context("cannot write the manifest")
    };
    let start = match (start, &body) {
        // Where there is no body either, a run finds both.
        (None, Some(body)) if settings.reversed => {
            let unfitted = folder.file("unfitted.toml")?;
            folder.write("unfitted.toml", |out| Ok(out.write_all(write_manifest(None)?.as_bytes())?))?;
            let first = FrameRange::one(0);
            let once =
                FitSettings { keep_body: true, frames: first, heading: settings.heading, ..FitSettings::default() };
            let found = fit(&Sequence::open(&unfitted)?, &once).context("the first pose of the reversed sequence")?;
            found.poses.write(&folder.file("start.csv")?, Overwrite::Replace, &Body::load(body)?)?;
            Some("start.csv".into())
        }
        (start, _) => start,
    };
    folder.write("sequence.toml", |out| Ok(out.write_all(write_manifest(start.as_deref())?.as_bytes())?))
}

impl SequenceSettings {
    /// Whether what is asked of a recording makes sense.
    ///
    /// # Errors
    /// With the key.
    pub(super) fn check_taken(&self) -> Result<()> {
        ensure!(self.every != Some(0), "every is 0, expected 1 or more");
        ensure!(self.start.is_none() || self.reversed, "`start` stands without `reversed`, expected it beside that");
        ensure!(
            self.heading.is_none() || self.reversed,
            "`heading` stands without `reversed`, expected it beside that"
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn settings(every: usize, reversed: bool) -> SequenceSettings {
        SequenceSettings { every: Some(every), reversed, name: Some("taken".into()), ..SequenceSettings::default() }
    }

    #[test]
    fn the_truth_goes_the_same_way_as_the_frames() {
        let at = |frame: usize| Some(glam::DVec3::new(frame as f64, 0.0, 0.0));
        let truth = PointTrajectory {
            names: vec!["knee".into()],
            rate: 60.0,
            first_frame: 1,
            frames: (1..7).map(|frame| vec![at(frame)]).collect(),
            smoothed: None,
        };
        let rows = |settings: &SequenceSettings| {
            let taken = taken_truth(&truth, settings, 7);
            assert_eq!(taken.first_frame, 0);
            (taken.rate, taken.frames.iter().map(|row| row[0].map(|at| at.x)).collect::<Vec<_>>())
        };
        assert_eq!(rows(&settings(2, false)), (30.0, vec![None, Some(2.0), Some(4.0), Some(6.0)]));
        assert_eq!(rows(&settings(3, true)), (20.0, vec![Some(6.0), Some(3.0), None]));
    }

    #[test]
    fn fewer_cameras_and_frames_backwards() {
        let folder = tempfile::tempdir().unwrap();
        let made = OutputFolder::open(&folder.path().join("made")).unwrap();
        let mut scene = crate::synth::Scene { frames: 5, ..crate::synth::Scene::default() };
        scene.rig.size = [160, 90];
        crate::synth::SyntheticSequence::new(&scene).unwrap().write(&made, false, None, &|_| Ok(())).unwrap();
        let mut sequence = Sequence::open(made.path()).unwrap();
        sequence.measure_again = Some(true);
        let output = OutputFolder::open(folder.path()).unwrap();
        let asked = SequenceSettings {
            cameras: vec!["cam3".into(), "cam1".into()],
            start: Some(made.path().join("start.csv")),
            ..settings(2, true)
        };
        let taken = taken(sequence.clone(), &asked, &output).unwrap();
        assert_eq!((taken.frame_count, taken.fps, taken.views.len()), (3, 12.5, 2));
        assert_eq!((taken.measure_again, taken.needs_body()), (Some(true), false));
        assert_eq!(taken.cameras.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>(), ["cam1", "cam3"]);
        let read = |path: &Path| image::open(path).unwrap().into_rgb8();
        let now = read(&taken.dir.join("frames/cam3_0000.png"));
        assert_eq!(now, read(&made.path().join("frames/cam3_0004.png")));
        assert_ne!(now, read(&made.path().join("frames/cam3_0000.png")));
        // Of someone of whom a height is known alone.
        let manifest = fs::read_to_string(made.path().join("sequence.toml")).unwrap();
        let is_kept = |line: &&str| !["body", "start"].iter().any(|key| line.starts_with(key));
        let kept: Vec<&str> = manifest.lines().filter(is_kept).collect();
        let unknown = made.path().join("unknown.toml");
        fs::write(&unknown, format!("height = 1750.0\n{}", kept.join("\n"))).unwrap();
        let asked = SequenceSettings { name: Some("unknown".into()), ..settings(1, true) };
        let taken = super::taken(Sequence::open(&unknown).unwrap(), &asked, &output).unwrap();
        assert_eq!((taken.height, taken.start.as_deref(), taken.needs_body()), (Some(1750.0), None, true));
        let unknown = SequenceSettings { cameras: vec!["cam7".into()], ..settings(1, false) };
        let error = super::taken(sequence, &unknown, &output).unwrap_err().to_string();
        assert!(error.contains("cameras names `cam7`") && error.contains("cam1"), "{error}");
        assert!(SequenceSettings { heading: Some(0.0), ..SequenceSettings::default() }.check_taken().is_err());
        assert!(settings(0, false).check_taken().is_err());
    }
}
