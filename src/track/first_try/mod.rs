//! Everything that a first track needs, made from videos, their cameras and the person's height: manifest, plates, body, first pose,
//! and pictures to look at.

mod kept;
mod looked;
mod manifest;
mod matching;
mod scale;

use std::path::{Path, PathBuf};
use std::slice;

use anyhow::{Context, Result, bail, ensure};
use image::codecs::png::PngEncoder;

use self::kept::{Kept, learnt_plate};
use self::looked::look;
use self::manifest::{BODY, ManifestText, ManifestView, START, person_file};
use self::matching::match_cameras;
use self::scale::{ChosenScale, choose_scale};
use super::FrameRange;
use super::filmed_plate::filmed_plate;
use super::fit::{Coverage, Fit, FitSettings, PersonSeen, first_seen, fit_with, people_in};
use crate::check::{Start, misplaced_pictures, started};
use crate::features::LearntPlate;
use crate::files::{OutputFolder, Overwrite, listed, write_atomically};
use crate::geometry::Camera;
use crate::observe::{Advance, ViewPlate, with_plates};
use crate::sequence::{Footage, Orientation, SAME_RATE, Sequence, check_fps, read_cameras};

/// A body that covers less of the silhouettes than this, or lies on them with less, does not fit.
const FITS: f64 = 0.65;

/// What a first try is made from.
#[derive(Clone, Debug)]
pub struct FirstTrySettings {
    /// A video, or numbered pictures, a camera; called after it.
    pub videos: Vec<PathBuf>,
    /// The calibration.
    pub cameras: PathBuf,
    /// A folder with a picture of the empty scene a camera, called after it; learnt from the videos without.
    pub plates: Option<PathBuf>,
    /// The sequence's name.
    pub name: String,
    /// Frames per second; those of the videos without.
    pub fps: Option<f64>,
    /// Working size over stored size; chosen by how tall the person is in the pictures without.
    pub scale: Option<f64>,
    /// How the pictures of cameras are turned, by name.
    pub orientations: Vec<(String, Orientation)>,
    /// Which frames may be used; without, the first, or where nobody can be measured there, the first in which all are seen standing apart.
    pub frames: Option<FrameRange>,
    /// How the person is measured; the height is one of `heights`, the frames are `frames`.
    pub fit: FitSettings,
    /// How tall the people are who are tracked together, mm: one is measured alone, of several the tallest is who looks tallest, and so on.
    pub heights: Vec<f64>,
    /// Whether files that are there may be replaced.
    pub overwrite: Overwrite,
}

/// A view of a first try.
#[derive(Clone, Debug)]
pub struct FirstView {
    /// The camera's name.
    pub camera: String,
    /// Its video.
    pub video: PathBuf,
    /// Size of its pictures as they are stored, pixels.
    pub size: [u32; 2],
    /// Frames per second, where the file tells.
    pub fps: Option<f64>,
    /// How tall somebody is where the cameras look, pixels at the working size.
    pub person: Option<f64>,
    /// Pictures that the plate was learnt from; None where it was filmed.
    pub learnt_from: Option<usize>,
    /// How much of the plate is doubtful, % of the picture.
    pub doubtful: f64,
}

/// A person who was measured.
#[derive(Clone, Debug)]
pub struct FirstPerson {
    /// What the manifest calls her; nothing where she is alone.
    pub name: Option<String>,
    /// Her body and pose.
    pub fit: Fit,
}

/// A first try that is made.
#[derive(Clone, Debug)]
pub struct FirstTry {
    /// The manifest.
    pub manifest: PathBuf,
    /// Frames per second.
    pub fps: f64,
    /// Frames in every view.
    pub frame_count: usize,
    /// Working size over stored size.
    pub scale: f64,
    /// The views, in the order of the videos.
    pub views: Vec<FirstView>,
    /// The people who were measured; why not, where they could not be.
    pub people: Result<Vec<FirstPerson>, String>,
    /// Pictures to look at.
    pub looks: Vec<PathBuf>,
    /// Sentences the user should read.
    pub remarks: Vec<String>,
}

impl FirstTry {
    /// Whether the body lies on the silhouettes of every view.
    pub fn fits(&self) -> bool {
        let fits = |coverage: &Coverage| !coverage.falls_short_of(FITS);
        let covers = |person: &FirstPerson| person.fit.coverage[1].iter().all(fits);
        self.people.as_ref().is_ok_and(|people| people.iter().all(covers))
    }
}

/// Makes sequence.toml, plates/, body.toml, start.csv and look/ in `folder`; of several people, who are tracked together, body and pose lie
/// in a folder for each. Where somebody could not be measured all but bodies and poses is there, and the result says why. Of a manifest that
/// is replaced stays what its user wrote or changed: every key that is not written here, the name, rate and scale unless others are asked
/// for, and plates that were not learnt.
///
/// # Errors
/// When a video is of no camera or of another size than its camera, no rate is known, a file is there and may not be replaced, a
/// background cannot be learnt, or something cannot be read or written.
pub fn first_try(settings: &FirstTrySettings, folder: &Path, progress: &mut Advance<'_>) -> Result<FirstTry> {
    ensure!(settings.videos.len() >= 2, "{} videos were given, expected two or more", settings.videos.len());
    let height = *settings.heights.first().context("the person's height is not known, expected it in mm")?;
    for height in &settings.heights {
        ensure!((500.0..=2500.0).contains(height), "the person's height is {height}, expected 500 to 2500 mm");
    }
    let all_cameras = read_cameras(&settings.cameras)?;
    let matched = match_cameras(&settings.videos, &all_cameras)?;
    let cameras: Vec<Camera> = matched.iter().map(|&at| all_cameras[at].clone()).collect();
    let there = folder.join("sequence.toml");
    let is_there = settings.overwrite == Overwrite::Replace && there.is_file();
    let kept = if is_there { Kept::read(&there, settings.heights.len())? } else { Kept::default() };
    let kept = kept.oriented(&settings.orientations, &cameras)?;
    let fitting = |(video, camera): (&PathBuf, &Camera)| {
        let orientation = kept.orientation(&camera.name).with_context(|| there.display().to_string())?;
        Ok(Orientation::orient(orientation, Footage::open(video)?, Some(camera.size)))
    };
    let footage = settings.videos.iter().zip(&cameras).map(fitting).collect::<Result<Vec<_>>>()?;
    for (footage, camera) in footage.iter().zip(&cameras) {
        let ([width, height], [wide, high]) = (footage.size, camera.size);
        ensure!(
            footage.size == camera.size,
            "{} has pictures of {width}x{height} pixels, but camera {:?} is calibrated for {wide}x{high}{}",
            footage.shown,
            camera.name,
            footage.why_another_size(camera.size)
        );
    }
    let mut remarks = unused(&all_cameras, &matched);
    let fps = rate(settings.fps.or(kept.fps), &footage)?;
    let chosen = choose_scale(&cameras, height);
    let mut changed = Vec::new();
    if let Some(own) = kept.fps.filter(|own| settings.fps.is_none() && rate(None, &footage).ok() != Some(*own)) {
        changed.push(format!("`fps = {own}`"));
    }
    if let Some(own) = kept.scale.filter(|own| settings.scale.is_none() && *own != chosen.scale) {
        changed.push(format!("`scale = {own}`"));
    }
    let ChosenScale { scale, heights } = match settings.scale.or(kept.scale) {
        Some(scale) => chosen.at(scale),
        None => chosen,
    };
    remarks.extend(kept.remark(&cameras, &changed));
    let filmed = |camera: &Camera| -> Result<Option<(PathBuf, f64)>> {
        let Some(plates) = &settings.plates else { return Ok(kept.plate(&camera.name, folder)) };
        Ok(Some((filmed_plate(slice::from_ref(plates), &[&camera.name])?, 0.0)))
    };
    let filmed = cameras.iter().map(filmed).collect::<Result<Vec<_>>>()?;
    let people = names(settings.heights.len());
    let alone = people.is_empty().then_some(None);
    let own = people.iter().map(|name| Some(name.as_str())).chain(alone);
    let own = own.flat_map(|name| [BODY, START].map(|file| person_file(name, file)));
    let learnt_plates = cameras.iter().zip(&filmed).filter(|(_, filmed)| filmed.is_none());
    let learnt_plates = learnt_plates.map(|(camera, _)| learnt_plate(&camera.name));
    for name in ["sequence.toml".to_string()].into_iter().chain(own).chain(learnt_plates) {
        settings.overwrite.check(&folder.join(name))?;
    }
    let output = OutputFolder::open(folder)?;
    let manifest = output.file("sequence.toml")?;
    let name = kept.name.as_deref().unwrap_or(&settings.name);
    let write_manifest = |learnt: &[ViewPlate], delays: &[Option<isize>], people: &[String], overwrite: Overwrite| {
        let views = cameras.iter().zip(&settings.videos).zip(&filmed).enumerate();
        let views = views
            .map(|(at, ((camera, source), filmed))| {
                let plate = of_camera(learnt, camera)
                    .map(|plate| (output.path().join(learnt_plate(&camera.name)), plate.percent_doubtful()));
                let plate = plate.or_else(|| filmed.clone());
                ManifestView {
                    camera: &camera.name,
                    source,
                    doubtful: plate.as_ref().map_or(0.0, |(_, doubtful)| *doubtful),
                    plate: plate.map(|(file, _)| file),
                    delay: delays.get(at).copied().flatten(),
                    kept: kept.keys(&camera.name),
                }
            })
            .collect();
        let text =
            ManifestText { name, fps, cameras: &settings.cameras, height, scale, people, views, kept: &kept.whole };
        let text = text.text(output.path())?;
        write_atomically(&manifest, overwrite, |writer| Ok(writer.write_all(text.as_bytes())?))
    };
    write_manifest(&[], &[], &[], settings.overwrite)?;
    let (learnt, delays) = {
        let sequence = Sequence::open_unfitted(&manifest)?;
        let plated = with_plates(&sequence, progress)?;
        ensure!(
            kept.learns_on() || plated.sequence.views.iter().all(|view| !view.learns_background()),
            "the videos have {} frames, too few to learn the empty scene from, expected pictures of it with --plates",
            sequence.frame_count
        );
        let start = started(&plated.sequence, progress)?;
        remarks.extend(start_remark(&start, &cameras));
        remarks.extend(plated.remarks());
        let delays = stated_delays(start);
        (plated.learnt, delays)
    };
    for ViewPlate { camera, plate } in &learnt {
        output
            .write(&learnt_plate(camera), |writer| Ok(plate.picture.write_with_encoder(PngEncoder::new(writer))?))?;
    }
    if !learnt.is_empty() || !delays.is_empty() {
        write_manifest(&learnt, &delays, &[], Overwrite::Replace)?;
    }
    let sequence = Sequence::open_unfitted(&manifest)?;
    let frame_count = sequence.frame_count;
    remarks.extend(sequence.remarks_on_recordings());
    let Measured { people: measured, frame } =
        measured_somewhere(&sequence, settings, &people, &mut remarks, progress)?;
    let fits = measured.as_deref().unwrap_or_default();
    for FirstPerson { name, fit } in fits {
        let file = |file: &str| person_file(name.as_deref(), file);
        let text = format!("# Measured by `pantin start` on {}.\n\n{}", sequence.name, fit.body.to_toml());
        output.write(&file(BODY), |writer| Ok(writer.write_all(text.as_bytes())?))?;
        fit.poses.write(&output.file(&file(START))?, Overwrite::Replace, &fit.body)?;
        // Where all are tracked nobody is left out.
        remarks.extend(fit.others.clone().filter(|_| name.is_none()));
    }
    if !people.is_empty() && !fits.is_empty() {
        write_manifest(&learnt, &delays, &people, Overwrite::Replace)?;
    }
    let fits: Vec<&Fit> = fits.iter().map(|person| &person.fit).collect();
    let looks = look(&sequence, frame, &fits, &output)?;
    let views = cameras.iter().zip(&footage).zip(heights).zip(&filmed);
    let views = views.map(|(((camera, footage), person), filmed)| {
        let plate = of_camera(&learnt, camera);
        FirstView {
            camera: camera.name.clone(),
            video: PathBuf::from(&footage.shown),
            size: footage.size,
            fps: footage.fps,
            person,
            learnt_from: plate.map(|plate| plate.pictures),
            doubtful: plate
                .map_or_else(|| filmed.as_ref().map_or(0.0, |(_, doubtful)| *doubtful), LearntPlate::percent_doubtful),
        }
    });
    let views = views.collect();
    let mut made =
        FirstTry { manifest: manifest.clone(), fps, frame_count, scale, views, people: measured, looks, remarks };
    if !made.fits() {
        // What cannot be looked at says nothing; the first try is made all the same.
        made.remarks.extend(misplaced_pictures(&sequence, progress).unwrap_or_default());
    }
    Ok(made)
}

/// What so many people are called who are tracked together; nothing where one is tracked alone.
fn names(count: usize) -> Vec<String> {
    if count > 1 { (1..=count).map(|nth| format!("person{nth}")).collect() } else { Vec::new() }
}

/// People as they were measured, or why they could not be, and the frame that was looked at.
struct Measured {
    people: Result<Vec<FirstPerson>, String>,
    frame: usize,
}

/// As [`measured`], in the frames that were asked for; without any in the first, or where that fails, in the first in which all are seen.
///
/// # Errors
/// When the frames are not the sequence's, or frames cannot be looked at.
fn measured_somewhere(
    sequence: &Sequence,
    settings: &FirstTrySettings,
    names: &[String],
    remarks: &mut Vec<String>,
    progress: &mut Advance<'_>,
) -> Result<Measured> {
    let count = sequence.frame_count;
    let range = settings.frames.unwrap_or(FrameRange::one(0));
    let frame = range.within(count, &sequence.path.display().to_string())?.start;
    let measure = |frames: FrameRange, progress: &mut Advance<'_>| {
        measured(sequence, settings, names, frames, progress).map_err(|error| format!("{error:#}"))
    };
    let why = match measure(range, progress) {
        Err(why) if settings.fit.at.is_none() => why,
        // Where somebody was said to stand he stands in the frame that was meant.
        people => return Ok(Measured { people, frame }),
    };
    let who = if names.is_empty() { "somebody is seen" } else { "all are seen apart" };
    let others = if settings.frames.is_some() { 0..count } else { 1..count };
    let why = match (first_seen(sequence, settings.heights.len(), others, progress)?, settings.frames) {
        (Some(other), None) => {
            let people = measure(FrameRange::one(other), progress);
            if people.is_ok() {
                remarks.push(format!(
                    "{why}: measured in frame {other} instead, where {who}; what is before is not tracked from there"
                ));
            }
            return Ok(Measured { people, frame: other });
        }
        (Some(other), Some(_)) => {
            let frames = FrameRange::one(other);
            format!("{why}; {who} in frame {other}: --frames {frames}, and --frames {other}.. for `pantin track`")
        }
        (None, _) => format!("{why}; in none of the frames that were looked at {who}"),
    };
    Ok(Measured { people: Err(why), frame })
}

/// Measures the person, or each of the people of these names: those who stand nearest to where the cameras look.
///
/// # Errors
/// When somebody cannot be measured, or fewer are seen.
fn measured(
    sequence: &Sequence,
    settings: &FirstTrySettings,
    names: &[String],
    frames: FrameRange,
    progress: &mut Advance<'_>,
) -> Result<Vec<FirstPerson>> {
    let mut heights = settings.heights.clone();
    let settings = FitSettings { frames, ..settings.fit.clone() };
    if names.is_empty() {
        let fit = FitSettings { height: heights.pop(), ..settings };
        return Ok(vec![FirstPerson { name: None, fit: fit_with(sequence, &fit, progress)? }]);
    }
    let frame = frames.start.unwrap_or(0);
    let mut seen = people_in(sequence, &[frame])?.pop().unwrap_or_default();
    ensure!(
        seen.len() >= names.len(),
        "{} people are to be tracked and {} seen apart in frame {frame}, expected a frame in which all stand by themselves",
        names.len(),
        match seen.len() {
            0 => "none is".to_string(),
            1 => "one is".to_string(),
            count => format!("{count} are"),
        }
    );
    seen.truncate(names.len());
    seen.sort_by(|a, b| b.height.total_cmp(&a.height));
    heights.sort_by(|a, b| b.total_cmp(a));
    let people = names.iter().zip(seen).zip(heights);
    people
        .map(|((name, PersonSeen { at, .. }), height)| {
            let fit = FitSettings { at: Some(at), height: Some(height), ..settings.clone() };
            let fit = fit_with(sequence, &fit, &mut *progress).with_context(|| name.clone())?;
            Ok(FirstPerson { name: Some(name.clone()), fit })
        })
        .collect()
}

/// The plate that was learnt for a camera.
fn of_camera<'a>(learnt: &'a [ViewPlate], camera: &Camera) -> Option<&'a LearntPlate> {
    learnt.iter().find(|view| view.camera == camera.name).map(|view| &view.plate)
}

/// What is stated of each view's delay. Where the silhouettes agree as they are, one 0 says so, and nobody needs to ask again.
fn stated_delays(start: Start) -> Vec<Option<isize>> {
    match start {
        Start::Unasked | Start::Untold => Vec::new(),
        Start::Together => vec![Some(0)],
        Start::Apart { delays, .. } => {
            delays.into_iter().map(|delay| Some(delay).filter(|delay| *delay != 0)).collect()
        }
    }
}

/// A sentence on when the cameras were started, where their files say that it was not at one moment.
fn start_remark(start: &Start, cameras: &[Camera]) -> Option<String> {
    match start {
        Start::Unasked => None,
        Start::Together => Some("the silhouettes agree with the first pictures of all cameras taken for one moment".to_string()),
        Start::Untold => Some(
            "the files leave open whether the cameras were started together, and the silhouettes agree neither as they are nor moved by what \
             lengths and clocks make likely: look for a clap in each video, state its `delay`, and start again with --force"
                .to_string(),
        ),
        Start::Apart { delays, explained: [before, after] } => {
            let late = cameras.iter().zip(delays).filter(|(_, delay)| **delay != 0);
            let late: Vec<String> = late.map(|(camera, delay)| format!("{} {delay}", camera.name)).collect();
            Some(format!(
                "the cameras were not started together: written into the manifest is `delay`, the frames by which pictures come too late ({}); \
                 the views then explain {after:.0} % of each other's borders instead of {before:.0}",
                listed(&late)
            ))
        }
    }
}

/// A sentence about cameras that no video is of.
fn unused(cameras: &[Camera], matched: &[usize]) -> Vec<String> {
    let unused = cameras.iter().enumerate().filter(|(at, _)| !matched.contains(at));
    let names: Vec<&str> = unused.map(|(_, camera)| camera.name.as_str()).collect();
    if names.is_empty() { Vec::new() } else { vec![format!("no video is of camera {}", listed(&names))] }
}

/// Frames per second: what is asked for, or that of the most videos, of as many the first's. The sequence says where others differ.
fn rate(asked: Option<f64>, footage: &[Footage]) -> Result<f64> {
    let said: Vec<f64> = footage.iter().filter_map(|one| one.fps).collect();
    let alike = |fps: f64| said.iter().filter(|rate| (*rate / fps - 1.0).abs() <= SAME_RATE).count();
    let most = said.iter().map(|fps| alike(*fps)).max();
    let common = said.iter().copied().find(|fps| Some(alike(*fps)) == most);
    let Some(fps) = asked.or(common) else {
        bail!("numbered pictures do not tell how many frames a second they are, expected --fps");
    };
    check_fps(fps)?;
    Ok(fps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::{Source, Turn, Video};

    fn footage(fps: Option<f64>) -> Footage {
        let source = Source::Video(Video { path: "v.mp4".into(), stored: [64, 48], turn: Turn::None });
        let (shown, size) = ("v.mp4".into(), [8, 8]);
        Footage { shown, source, size, frame_count: 9, marked: Turn::None, fps, times: None, made: None, picks: None }
    }

    #[test]
    fn the_rate_is_that_of_most_videos_and_a_missing_one_is_asked_for() {
        let of = |asked, rates: &[f64]| {
            let footage: Vec<Footage> = rates.iter().map(|rate| footage(Some(*rate))).collect();
            rate(asked, &footage).unwrap()
        };
        assert_eq!(of(None, &[29.97, 29.98]), 29.97);
        assert_eq!(of(None, &[30.0, 25.0]), 30.0);
        assert_eq!(of(None, &[30.0, 25.0, 25.001]), 25.0);
        assert_eq!(of(Some(50.0), &[30.0, 25.0]), 50.0);
        let error = rate(None, &[footage(None)]).unwrap_err().to_string();
        assert!(error.contains("expected --fps"), "{error}");
    }
}
