//! Is a sequence sane? Every check is a number, its limit, what was found and what to do (docs/CALIBRATION.md).
//!
//! `view` looks at the calibration alone; `silhouettes` reads what the cameras saw, of which `repeats` asks whether it goes on; `agreement` measures how well they
//! agree, without any model of the person; `beginnings` puts cameras together that were started at different moments; `exchanges` asks whether two cameras or left and right are exchanged, `orientations` whether a
//! camera's picture is turned or mirrored, `faults` which cameras' `turns` and delays (`timing`) make them agree better, and by how much (`betterment`); `person` looks at the surface that they agree on.

mod agreement;
mod beginnings;
mod betterment;
mod exchanges;
mod faults;
mod finding;
mod orientations;
mod partners;
mod person;
mod repeats;
mod signed_distance;
mod silhouettes;
mod surely_far;
mod timing;
mod turns;
mod view;

use std::borrow::Cow;
use std::path::Path;

use anyhow::{Result, ensure};
use glam::DVec3;
use serde::Serialize;

pub use finding::{Finding, Status};

use agreement::{EXPLAINED, HARDLY_EXPLAINED, Ray, WELL_EXPLAINED, percent_explained, percent_seen, rays};
use beginnings::{Beginnings, beginnings};
use faults::{Faults, Times};
use orientations::Misplaced;
use repeats::Repeats;
use silhouettes::Silhouettes;

use crate::geometry::Camera;
use crate::observe::{Advance, Plated, ViewPlate, with_plates};
use crate::sequence::{DOUBTFUL, FrameSet, Sequence};

/// Frames looked at unless the user says which: a short stretch says as much as a long one.
const FRAMES: usize = 100;
/// Rays a silhouette for a number.
const RAYS: usize = 150;
/// What takes long once the silhouettes are there.
const COMPARISONS: usize = 3;
/// Frames that a camera which is far off in time is looked for over at least, and at most.
const FAR_FRAMES: usize = 30;
const MOST_FAR_FRAMES: usize = 240;
/// Fewer rays say nothing.
const FEWEST_RAYS: usize = 200;

/// Which frames are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckSettings {
    /// The first frame; None: 0.
    pub start: Option<usize>,
    /// The frame after the last; None: a hundred frames on, or the sequence's end.
    pub end: Option<usize>,
    /// How many frames between them.
    pub samples: usize,
}

impl Default for CheckSettings {
    fn default() -> Self {
        Self { start: None, end: None, samples: 8 }
    }
}

/// What was found out about a sequence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// The sequence's name, or its path where it cannot be opened.
    pub sequence: String,
    /// Whether no check failed.
    pub sane: bool,
    /// The frames looked at.
    pub frames: Vec<usize>,
    /// Every check.
    pub checks: Vec<Finding>,
}

impl CheckReport {
    fn new(sequence: String, frames: Vec<usize>, checks: Vec<Finding>) -> Self {
        let sane = checks.iter().all(|finding| finding.status != Status::Failed);
        Self { sequence, sane, frames, checks }
    }
}

/// Checks a sequence: its manifest, or the folder that holds it. Its body and start pose need not exist. A sequence that
/// cannot be opened is a failed check.
///
/// # Errors
/// When the frames asked for are not the sequence's, a picture cannot be read, or there is nothing to tell the person from
/// the background by.
pub fn check(path: &Path, settings: &CheckSettings) -> Result<CheckReport> {
    check_with(path, settings, &mut |_, _, _| {})
}

/// As [`check`], and tells how far it is.
///
/// # Errors
/// As [`check`].
pub fn check_with(path: &Path, settings: &CheckSettings, progress: &mut Advance<'_>) -> Result<CheckReport> {
    let sequence = match Sequence::open_unfitted(path) {
        Ok(sequence) => sequence,
        Err(error) => {
            let finding = Finding::number("files", "", f64::NAN, [0.0, 0.0]).found(format!("{error:#}"));
            let finding = finding.or("what stands before: nothing else can be looked at");
            return Ok(CheckReport::new(path.display().to_string(), Vec::new(), vec![finding]));
        }
    };
    let first = settings.start.unwrap_or(0);
    let end = settings.end.unwrap_or(sequence.frame_count.min(first + FRAMES));
    ensure!(
        first < end && end <= sequence.frame_count,
        "frames {first}..{end} are no frames of {}, which has frames 0..{}",
        sequence.path.display(),
        sequence.frame_count
    );
    let plated = with_plates(&sequence, progress)?;
    let opened_sequence = plated.sequence.as_ref();
    let sequence = opened_sequence;
    let mut repeats = Repeats::default();
    let mut note = |frame: &FrameSet| repeats.note(frame);
    let silhouettes = Silhouettes::read_and_show(sequence, first..end, settings.samples, &mut note, progress)?;
    let reach = far_reach(sequence.fps);
    let begun = beginnings(sequence, &silhouettes, &(first..end), settings.samples, reach, progress)?;
    let (sequence, silhouettes, begun) = match begun {
        Some(Beginnings { sequence, silhouettes, delays, explained }) => {
            (Cow::Owned(sequence), silhouettes, Some((delays, explained)))
        }
        None => (Cow::Borrowed(sequence), silhouettes, None),
    };
    let sequence = sequence.as_ref();
    let opened = format!("{} views, {} frames", sequence.views.len(), sequence.frame_count);
    let mut checks = vec![
        Finding::number("files", "views", sequence.views.len() as f64, [2.0, f64::INFINITY])
            .found(opened)
            .or("give the sequence a second camera: one alone cannot be checked"),
    ];
    checks.extend(
        opened_sequence.remarks_on_recordings().iter().map(|remark| Finding::not_measured("recordings", remark)),
    );
    checks.extend(repeats.findings(opened_sequence));
    checks.extend(view::lenses(&sequence.cameras));
    checks.push(view::up_axis(&sequence.cameras));
    checks.extend(plates(sequence, &plated));
    checks.extend(seen(sequence, &silhouettes));
    progress("comparing the silhouettes", 0, COMPARISONS);
    let found = rays(&sequence.cameras, &silhouettes.moments(), RAYS);
    if found.len() < FEWEST_RAYS {
        let why = format!("the silhouettes have {} border rays, expected {FEWEST_RAYS} or more", found.len());
        checks.push(Finding::not_measured("agreement", &why));
        checks.extend(view::volume(&sequence.cameras, DVec3::ZERO));
    } else {
        let middle = found.iter().map(|ray| ray.point).sum::<DVec3>() / found.len() as f64;
        checks.extend(view::volume(&sequence.cameras, middle));
        progress("comparing the silhouettes", 1, COMPARISONS);
        let exchanges = exchanges::exchanges(&sequence.cameras, &silhouettes, &found);
        progress("comparing the silhouettes", 2, COMPARISONS);
        let is_exchanged = exchanges.iter().any(|finding| finding.status == Status::Failed);
        let misplaced =
            if is_exchanged { None } else { Misplaced::find(&sequence.cameras, &silhouettes.moments(), &found) };
        let unmeasured =
            |why: &str| ["direction", "roll", "timing"].map(|check| Finding::not_measured(check, why)).to_vec();
        let faults = if is_exchanged {
            Faults { findings: unmeasured("put right what is exchanged first"), rays: found }
        } else if let Some(misplaced) = &misplaced {
            let findings = unmeasured("put what is turned or mirrored right first");
            Faults { findings, rays: misplaced.rays.clone() }
        } else {
            let stated: Vec<f64> = opened_sequence.views.iter().map(|view| view.delay).collect();
            let reach = far_reach(sequence.fps);
            let mut widen = |wide: &[usize]| silhouettes.widened(sequence, wide, reach, progress);
            let begun = begun.as_ref().map(|(delays, explained)| (delays.as_slice(), *explained));
            let times = Times { stated: &stated, begun, fps: sequence.fps, widen: &mut widen };
            faults::faults(&sequence.cameras, times, &silhouettes, RAYS)?
        };
        checks.extend(explained(&sequence.cameras, &faults.rays));
        checks.extend(exchanges);
        checks.extend(misplaced.map(|misplaced| misplaced.findings(sequence)).unwrap_or_default());
        checks.extend(faults.findings);
        checks.extend(person::person(&faults.rays, sequence.body.is_file().then_some(sequence.body.as_path()))?);
    }
    Ok(CheckReport::new(sequence.name.clone(), silhouettes.samples.clone(), checks))
}

/// A sentence for each camera, one or two, whose picture is turned or mirrored, so that it agrees with the others only once that is put
/// right; none where all agree, or nothing tells.
///
/// # Errors
/// When a picture cannot be read.
pub fn misplaced_pictures(sequence: &Sequence, progress: &mut Advance<'_>) -> Result<Vec<String>> {
    let plated = with_plates(sequence, progress)?;
    let sequence = plated.sequence.as_ref();
    let frames = 0..sequence.frame_count.min(FRAMES);
    let silhouettes = Silhouettes::read(sequence, frames, CheckSettings::default().samples, progress)?;
    let found = rays(&sequence.cameras, &silhouettes.moments(), RAYS);
    let misplaced = Misplaced::find(&sequence.cameras, &silhouettes.moments(), &found);
    let misplaced = misplaced.filter(|_| found.len() >= FEWEST_RAYS);
    Ok(misplaced.map(|misplaced| misplaced.sentences(sequence)).unwrap_or_default())
}

/// Whether the cameras of a sequence were started together.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// Nothing says otherwise, or the manifest states it.
    Unasked,
    /// Their files say otherwise, and their silhouettes agree as they are.
    Together,
    /// They were not.
    Apart {
        /// Frames by which each view's pictures come too late.
        delays: Vec<isize>,
        /// The part of the views' borders that the others explain, %, as they are and with the views put together.
        explained: [f64; 2],
    },
    /// Their files say otherwise, and their silhouettes agree neither way.
    Untold,
}

/// Whether the cameras were started at different moments, as their files make likely and their silhouettes confirm.
///
/// # Errors
/// When a picture cannot be read.
pub fn started(sequence: &Sequence, progress: &mut Advance<'_>) -> Result<Start> {
    if sequence.likely_delays().is_empty() {
        return Ok(Start::Unasked);
    }
    let plated = with_plates(sequence, progress)?;
    let sequence = plated.sequence.as_ref();
    let (frames, samples) = (0..sequence.frame_count.min(FRAMES), CheckSettings::default().samples);
    let silhouettes = Silhouettes::read(sequence, frames.clone(), samples, progress)?;
    if beginnings::agree(&sequence.cameras, &silhouettes) {
        return Ok(Start::Together);
    }
    let found = beginnings(sequence, &silhouettes, &frames, samples, far_reach(sequence.fps), progress)?;
    Ok(found.map_or(Start::Untold, |begun| Start::Apart { delays: begun.delays, explained: begun.explained }))
}

/// Frames by which a camera is looked for that is far off in time: a second's, [`FAR_FRAMES`] where that is fewer.
fn far_reach(fps: f64) -> usize {
    (fps.round() as usize).clamp(FAR_FRAMES, MOST_FAR_FRAMES)
}

/// How far the plates that were learnt can be believed.
fn plates(sequence: &Sequence, plated: &Plated<'_>) -> Vec<Finding> {
    let finding = |camera: &str, doubtful: f64, found: String| {
        Finding::number("learnt background", "% of the picture doubtful", doubtful, [0.0, DOUBTFUL])
            .doubtful_within([0.0, f64::MAX])
            .of(camera)
            .found(found)
            .or("the person may stand in it, and loses limbs there: film the empty scene and give it as `background`, or film on until he \
                 has left that place")
    };
    let learnt = |view: &ViewPlate| {
        let remarks = view.plate.remarks();
        let found = if remarks.is_empty() {
            format!("learnt from {} pictures", view.plate.pictures)
        } else {
            remarks.join("; ")
        };
        finding(&view.camera, view.plate.percent_doubtful(), found)
    };
    // Those that were learnt before, and whose doubts the manifest states.
    let stated = sequence.views.iter().filter(|view| view.background_doubtful > 0.0).filter_map(|view| {
        let plate = view.background.as_ref()?.display();
        Some(finding(&view.camera, view.background_doubtful, format!("{plate}, as the manifest says")))
    });
    plated.learnt.iter().map(learnt).chain(stated).collect()
}

/// In how many of the frames looked at each camera sees somebody who should be in its picture.
fn seen(sequence: &Sequence, silhouettes: &Silhouettes) -> Vec<Finding> {
    let moments = silhouettes.moments();
    let finding = |(view, camera): (usize, &Camera)| {
        let share = percent_seen(&sequence.cameras, &moments, view);
        Finding::number("silhouettes", "% of the frames", share, [60.0, 100.0]).of(&camera.name).or(
            "look at them with `pantin features`: a background picture of the same light helps, and frames with the person \
             in view",
        )
    };
    sequence.cameras.iter().enumerate().map(finding).collect()
}

/// The share of each silhouette's border that the other views explain: their visual hull reaches it.
fn explained(cameras: &[Camera], rays: &[Ray]) -> Vec<Finding> {
    let finding = |(view, camera): (usize, &Camera)| {
        let own: Vec<&Ray> = rays.iter().filter(|ray| ray.view == view).collect();
        Finding::number("hull coverage", "% of the border", percent_explained(own.iter().copied()), [WELL_EXPLAINED, 100.0])
            .doubtful_within([HARDLY_EXPLAINED, 100.0])
            .of(&camera.name)
            .found(format!(
                "of {} rays within {EXPLAINED} px of the visual hull of the other views, all that follows put right",
                own.len()
            ))
            .or("other views' silhouettes lose parts of the person that this one shows, or this one shows more than the person: look at \
                 them with `pantin features`; where they are good, calibration or lens do not fit the pictures")
    };
    cameras.iter().enumerate().map(finding).collect()
}
