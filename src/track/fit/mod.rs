//! Measuring a person: body proportions and first poses from a few frames.
//!
//! The visual hull of the silhouettes says where the person stands and how tall; poses are searched from several headings and arm
//! positions; then swarms move the proportions and all poses together, in ever narrower rounds, by soft evidence where nobody asks
//! for another objective.

mod again;
mod appearing;
mod fitter;
mod following;
mod meant;
mod scorer;
mod seen;
mod shape;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

pub(super) use self::again::{TrackedPoses, measure_again};
pub(super) use self::appearing::first_seen;
pub(super) use self::following::Following;
pub use self::meant::{PersonSeen, people_in};
pub use self::scorer::Coverage;
pub(super) use self::seen::LeaveOut;

use self::fitter::Fitter;
use self::meant::Meant;
use self::seen::{Seen, all_but};
use super::figures::Figure;
use super::hull::Hull;
use super::{FrameRange, ObjectiveChoice};
use crate::body::{Body, PoseTable, Proportions};
use crate::evaluate::ObjectiveKind;
use crate::features::SeenView;
use crate::observe::{Advance, feature_settings, with_plates};
use crate::search::{SearchKind, SearchSettings};
use crate::sequence::Sequence;

/// How a person is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct FitSettings {
    /// Height of the person, mm; the visual hull's without it.
    pub height: Option<f64>,
    /// Which frames may be used.
    pub frames: FrameRange,
    /// How many of them at most, evenly spread.
    pub samples: usize,
    /// Poses to start from (one, or one a frame) instead of a search in all directions.
    pub start: Option<PathBuf>,
    /// Where the person stands in the first of the frames, where several are seen: the one nearest to this place, world x and y, mm. Without it the
    /// one nearest to where the cameras look.
    pub at: Option<[f64; 2]>,
    /// The only heading to start from: degrees, 0 along x, 90 along y.
    pub heading: Option<f64>,
    /// Whether the body stays the sequence's and only poses are sought.
    pub keep_body: bool,
    /// Whether a frame's first pose is searched round those found in the frames beside it too: where limbs are apart in one of them,
    /// they are told apart in all.
    pub follow: bool,
    /// What a good pose is, evidence where nobody says; over the sequence's `[objective]` table. Where no pose is known yet, evidence is
    /// of what is no background first.
    pub objective: ObjectiveChoice,
    /// Poses scored at once.
    pub particles: usize,
    /// Times that many poses are scored in a round.
    pub iterations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            height: None,
            frames: FrameRange::one(0),
            samples: 6,
            start: None,
            at: None,
            heading: None,
            keep_body: false,
            follow: false,
            objective: ObjectiveChoice::default(),
            particles: 300,
            iterations: 30,
            seed: 1,
        }
    }
}

/// A measured person.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The body.
    pub body: Body,
    /// Its proportions against the tables, where it was measured.
    pub proportions: Option<Proportions>,
    /// The height it was scaled to, mm; `None` where it was kept.
    pub height: Option<f64>,
    /// A pose a frame used.
    pub poses: PoseTable,
    /// Mean fitness of the poses.
    pub fitness: f32,
    /// Names of the views.
    pub views: Vec<String>,
    /// Coverage of each view with the first poses, and in the end.
    pub coverage: [Vec<Coverage>; 2],
    /// Sentences the user should read.
    pub remarks: Vec<String>,
    /// One on who else is seen.
    pub others: Option<String>,
}

/// Measures the person in a sequence.
///
/// # Errors
/// When a view has neither background nor masks and its background cannot be learnt, pictures cannot be read, the silhouettes have no
/// volume in common, or the body lacks the joints of the default one.
pub fn fit(sequence: &Sequence, settings: &FitSettings) -> Result<Fit> {
    fit_with(sequence, settings, &mut |_, _, _| {})
}

/// As [`fit`], and tells how far it is.
///
/// # Errors
/// As [`fit`].
pub fn fit_with(sequence: &Sequence, settings: &FitSettings, progress: &mut Advance<'_>) -> Result<Fit> {
    let name = sequence.path.display().to_string();
    ensure!(settings.samples > 0, "0 frames were asked for, expected at least 1");
    let objective = settings.objective.resolve_over(ObjectiveKind::Evidence, sequence.objective.as_ref(), &name)?;
    objective.check_segments(!feature_settings(sequence)?.segment.is_empty()).with_context(|| name.clone())?;
    let weighs_evidence = objective.weighs_evidence();
    let plated = with_plates(sequence, progress)?;
    let remarks = [sequence.remarks(), plated.remarks()].concat();
    let sequence = plated.sequence.as_ref();
    let frames = sampled(settings.frames.within(sequence.frame_count, &name)?, settings.samples);
    let mut meant = Meant::new(settings.at, frames.first().copied().unwrap_or_default(), &name);
    let chosen = |at: usize, figures: &[Figure]| meant.choose(at, figures);
    let seen = Seen::look(sequence, &frames, weighs_evidence, &mut all_but(&sequence.cameras, chosen))?;
    let in_frame = |at: usize| format!("{name}, frame {}", frames[at]);
    let hulls: Vec<Hull> = seen
        .observations
        .iter()
        .enumerate()
        .map(|(at, seen)| Hull::carve(&sequence.cameras, &SeenView::all(seen)).with_context(|| in_frame(at)))
        .collect::<Result<_>>()?;
    let height = match (settings.keep_body, settings.height) {
        (true, _) => None,
        (false, Some(height)) => Some(height),
        (false, None) => Some(median(hulls.iter().map(|hull| hull.span[1] - hull.span[0]))),
    };
    let body = match height {
        Some(height) => Body::adult(height).context("the height of the person")?,
        None => Body::load(&sequence.body)?,
    };
    // What begins far off and what moves all poses at once is searched by the swarm, all else by what learns the shape of the hill.
    let search = SearchSettings {
        kind: SearchKind::Pso,
        particles: settings.particles,
        iterations: settings.iterations,
        seed: settings.seed,
        ..SearchSettings::default()
    };
    search.check()?;
    let mut fitter = Fitter::new(&body, &sequence.cameras, seen, search, objective, progress)?;
    fitter.expect(
        frames.len(),
        settings.start.is_some(),
        settings.heading.is_some(),
        settings.follow,
        height.is_some(),
    );
    let mut poses = match &settings.start {
        Some(path) => {
            let poses = start_poses(path, &body, &frames)?;
            fitter.found_round(&body, poses)?
        }
        None => fitter.found(&body, &hulls, settings.heading, settings.follow)?,
    };
    let before = fitter.scorer.coverage(&poses)?;
    let mut fitted = body.clone();
    let proportions = match height {
        Some(_) => {
            let proportions = fitter.stretch(&body, &mut poses)?;
            fitted = proportions.apply(&body).rounded();
            Some(proportions)
        }
        None => None,
    };
    let after = fitter.scorer.coverage(&poses)?;
    let fitness = fitter.scorer.mean_fitness(&poses)?;
    fitted.name.clone_from(&sequence.name);
    let poses = poses.iter().map(|pose| pose.iter().map(|value| f64::from(*value)).collect()).collect();
    Ok(Fit {
        body: fitted,
        proportions,
        height,
        poses: PoseTable { frames, poses },
        fitness,
        views: sequence.cameras.iter().map(|camera| camera.name.clone()).collect(),
        coverage: [before, after],
        remarks,
        others: meant.others,
    })
}

/// At most `count` frames of a range, evenly spread, first and last among them.
pub(super) fn sampled(range: std::ops::Range<usize>, count: usize) -> Vec<usize> {
    let last = range.len().saturating_sub(1);
    let count = count.min(range.len());
    (0..count).map(|i| range.start + if count > 1 { (i * last + (count - 1) / 2) / (count - 1) } else { 0 }).collect()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// The poses of a file for some frames: its only one for all of them, or each frame's own.
fn start_poses(path: &Path, body: &Body, frames: &[usize]) -> Result<Vec<Vec<f32>>> {
    let table = PoseTable::read(path, body)?;
    frames
        .iter()
        .map(|frame| {
            let row = if table.poses.len() == 1 { Some(0) } else { table.frames.iter().position(|f| f == frame) };
            let Some(row) = row else {
                bail!("{} has no pose of frame {frame}, expected one pose or one for every frame used", path.display())
            };
            body.check_limits(&table.poses[row]).with_context(|| format!("{}, row {row}", path.display()))?;
            Ok(table.poses[row].iter().map(|value| *value as f32).collect())
        })
        .collect()
}
