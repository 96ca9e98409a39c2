//! Measuring a person: body proportions and first poses from the silhouettes of a few frames.
//!
//! The visual hull says where the person stands and how tall; poses are searched from several headings and arm
//! positions; then swarms move the proportions and all poses together, in ever narrower rounds.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, bail, ensure};
use rayon::prelude::*;

use super::hull::Hull;
use super::{FrameRange, ObjectiveChoice};
use crate::body::{Body, PoseTable, Proportions};
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::evaluate::{Components, Evaluator, Objective, ObjectiveKind};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::observe::{Observer, silhouette_settings, take_observations};
use crate::search::{SearchKind, SearchSettings, SearchSpace};
use crate::sequence::Sequence;

/// Headings a first pose is searched from, evenly round the circle.
const HEADINGS: usize = 8;
/// Angles the arms are lifted sideways to at first, degrees: hanging, half way, a T.
const ARMS: [f64; 3] = [10.0, 45.0, 88.0];
/// Spreads, in steps of the body, that a promising first pose is searched with one after the other: an arm on the wrong
/// side of the trunk needs a wide one to come round.
const SPREADS: [f32; 4] = [4.0, 3.0, 2.0, 1.0];
/// First poses that are followed further.
const SURVIVORS: usize = 3;
/// Times they are searched round once more.
const ENCORES: usize = 3;
/// Rounds that proportions and poses are searched together in, each narrower than the one before by [`NARROWING`].
const ROUNDS: i32 = 10;
const NARROWING: f64 = 0.75;
/// What a proportion one standard deviation off the tables costs in fitness: enough to settle what the silhouettes leave
/// open (where a straight leg has its knee), too little to work against them.
const PRIOR: f64 = 2e-4;

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
    /// The only heading to start from: degrees, 0 along x, 90 along y.
    pub heading: Option<f64>,
    /// Whether the body stays the sequence's and only poses are sought.
    pub keep_body: bool,
    /// Whether a frame's first pose is searched round those found in the frames beside it too: where limbs are apart in one of them,
    /// they are told apart in all.
    pub follow: bool,
    /// What a good pose is; over the sequence's `[objective]` table. Silhouettes are compared, whatever weighs evidence.
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
            frames: FrameRange { start: Some(0), end: Some(1) },
            samples: 6,
            start: None,
            heading: None,
            keep_body: false,
            follow: false,
            objective: ObjectiveChoice::default(),
            particles: 300,
            iterations: 60,
            seed: 1,
        }
    }
}

/// How well the drawn and the seen silhouettes of a view cover each other, over all frames used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coverage {
    /// Share of the seen silhouette that the model covers.
    pub seen: f64,
    /// Share of the drawn model that lies on the seen silhouette.
    pub drawn: f64,
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
}

/// Measures the person in a sequence.
///
/// # Errors
/// When the sequence has a view without background and masks, pictures cannot be read, the silhouettes have no volume in
/// common, or the body lacks the joints of the default one.
pub fn fit(sequence: &Sequence, settings: &FitSettings) -> Result<Fit> {
    let name = sequence.path.display().to_string();
    ensure!(settings.samples > 0, "0 frames were asked for, expected at least 1");
    let objective = settings.objective.resolve(sequence.objective.as_ref(), &name)?;
    let objective = if objective.weighs_evidence() { Objective::of(ObjectiveKind::Sp) } else { objective };
    let frames = sampled(settings.frames.within(sequence.frame_count, &name)?, settings.samples);
    let observations = observe(sequence, &frames)?;
    let in_frame = |at: usize| format!("{name}, frame {}", frames[at]);
    let hulls: Vec<Hull> = observations
        .iter()
        .enumerate()
        .map(|(at, seen)| Hull::carve(&sequence.cameras, seen).with_context(|| in_frame(at)))
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
    // Rounds that narrow by themselves; the swarm is what they were tried with.
    let search = SearchSettings {
        kind: SearchKind::Pso,
        particles: settings.particles,
        iterations: settings.iterations,
        seed: settings.seed,
        ..SearchSettings::default()
    };
    search.check()?;
    let scorer = Scorer::new(&body, &sequence.cameras, &observations, objective)?;
    let mut fitter = Fitter { space: SearchSpace::of(&body)?, search, scorer, searches: 0 };
    let mut poses = match &settings.start {
        Some(path) => fitter.settle(start_poses(path, &body, &frames)?)?,
        None => {
            let found = hulls.iter().enumerate().map(|(at, hull)| fitter.first_pose(&body, at, hull, settings.heading));
            let found = found.collect::<Result<Vec<_>>>()?;
            let found = if settings.follow { fitter.follow(found)? } else { found };
            found.into_iter().map(|(pose, _)| pose).collect()
        }
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
    })
}

/// At most `count` frames of a range, evenly spread, first and last among them.
fn sampled(range: std::ops::Range<usize>, count: usize) -> Vec<usize> {
    let last = range.len().saturating_sub(1);
    let count = count.min(range.len());
    (0..count).map(|i| range.start + if count > 1 { (i * last + (count - 1) / 2) / (count - 1) } else { 0 }).collect()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// What was seen in some frames: `[frame][view]`.
fn observe(sequence: &Sequence, frames: &[usize]) -> Result<Vec<Vec<Observation>>> {
    if let Some(view) = sequence.views.iter().find(|view| view.learns_background()) {
        bail!(
            "{}: camera {:?} has neither a background picture nor masks, expected one of them to measure a person with",
            sequence.path.display(),
            view.camera
        );
    }
    let (Some(&first), Some(last)) = (frames.first(), frames.last()) else { return Ok(Vec::new()) };
    let mut observer = Observer::new(sequence, silhouette_settings(sequence)?, first..last + 1, first)?;
    let mut observations = Vec::new();
    while let Some(frame) = observer.read()? {
        observations.extend(observer.features(&frame, frames.contains(&frame.index))?.map(take_observations));
    }
    Ok(observations)
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

/// Scores poses, and bodies with their poses, against all frames used.
struct Scorer {
    objective: Objective,
    /// An evaluator of one thread for every frame, `[thread][frame]`: bodies differ from row to row.
    threads: Vec<Mutex<Vec<Cpu>>>,
}

impl Scorer {
    fn new(body: &Body, cameras: &[Camera], frames: &[Vec<Observation>], objective: Objective) -> Result<Self> {
        let count = std::thread::available_parallelism().map_or(1, usize::from);
        let thread = |_| -> Result<Mutex<Vec<Cpu>>> {
            let evaluators = frames.iter().map(|observations| {
                let mut cpu = Cpu::with(body, cameras, InstructionSet::best(), 1)?;
                cpu.observe(observations)?;
                Ok(cpu)
            });
            Ok(Mutex::new(evaluators.collect::<Result<_>>()?))
        };
        Ok(Self { objective, threads: (0..count).map(thread).collect::<Result<_>>()? })
    }

    /// Shares rows of `width` values and their results among the threads.
    fn share(
        &self,
        rows: &[f32],
        width: usize,
        results: &mut [f32],
        score: impl Fn(&mut [Cpu], &[f32], &mut [f32]) -> Result<()> + Sync,
    ) -> Result<()> {
        let each = results.len().div_ceil(self.threads.len()).max(1);
        let shares = rows.par_chunks(each * width).zip(results.par_chunks_mut(each)).zip(&self.threads);
        shares.try_for_each(|((rows, results), thread)| {
            score(&mut thread.lock().unwrap_or_else(PoisonError::into_inner), rows, results)
        })
    }

    /// Fitness of poses in one frame.
    fn poses(&self, frame: usize, dofs: usize, rows: &[f32], results: &mut [f32]) -> Result<()> {
        self.share(rows, dofs, results, |cpus, rows, results| cpus[frame].fitness(rows, &self.objective, results))
    }

    /// Mean fitness over the frames of rows of proportions and poses, less what unusual proportions cost.
    fn people(&self, body: &Body, dofs: usize, rows: &[f32], results: &mut [f32]) -> Result<()> {
        let frames = self.frame_count();
        self.share(rows, Proportions::COUNT + frames * dofs, results, |cpus, rows, results| {
            for (row, result) in rows.chunks_exact(Proportions::COUNT + frames * dofs).zip(results) {
                let (factors, poses) = row.split_at(Proportions::COUNT);
                let proportions = proportions(factors);
                let stretched = proportions.apply(body);
                let mut sum = 0.0;
                for (cpu, pose) in cpus.iter_mut().zip(poses.chunks_exact(dofs)) {
                    let mut fitness = [0.0];
                    cpu.set_body(&stretched)?;
                    cpu.fitness(pose, &self.objective, &mut fitness)?;
                    sum += f64::from(fitness[0]);
                }
                *result = (sum / frames as f64 - cost(&proportions)) as f32;
            }
            Ok(())
        })
    }

    fn frame_count(&self) -> usize {
        self.with_first(|cpus| cpus.len())
    }

    fn set_body(&self, body: &Body) -> Result<()> {
        for thread in &self.threads {
            for cpu in thread.lock().unwrap_or_else(PoisonError::into_inner).iter_mut() {
                cpu.set_body(body)?;
            }
        }
        Ok(())
    }

    fn with_first<T>(&self, look: impl FnOnce(&mut Vec<Cpu>) -> T) -> T {
        look(&mut self.threads[0].lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Coverage of each view by one pose a frame.
    fn coverage(&self, poses: &[Vec<f32>]) -> Result<Vec<Coverage>> {
        self.with_first(|cpus| {
            let views = cpus.first().map_or(0, Evaluator::view_count);
            let mut sums = vec![[0.0; 3]; views];
            for (cpu, pose) in cpus.iter_mut().zip(poses) {
                let mut components = vec![Components::default(); views];
                cpu.components(pose, &mut components)?;
                for (sum, view) in sums.iter_mut().zip(components) {
                    for (sum, count) in sum.iter_mut().zip([view.overlap, view.area_obs, view.area_model]) {
                        *sum += f64::from(count);
                    }
                }
            }
            let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
            Ok(sums.into_iter().map(|[o, s, d]| Coverage { seen: share(o, s), drawn: share(o, d) }).collect())
        })
    }

    fn mean_fitness(&self, poses: &[Vec<f32>]) -> Result<f32> {
        self.with_first(|cpus| {
            let mut sum = 0.0;
            for (cpu, pose) in cpus.iter_mut().zip(poses) {
                let mut fitness = [0.0];
                cpu.fitness(pose, &self.objective, &mut fitness)?;
                sum += fitness[0];
            }
            Ok(sum / poses.len().max(1) as f32)
        })
    }
}

/// Proportions from a row of a search.
fn proportions(factors: &[f32]) -> Proportions {
    let mut proportions = Proportions::default();
    for (factor, value) in proportions.0.iter_mut().zip(factors) {
        *factor = f64::from(*value);
    }
    proportions
}

/// What proportions off the tables cost.
fn cost(proportions: &Proportions) -> f64 {
    let off = proportions.0.iter().zip(&Proportions::ALL).map(|(factor, known)| (factor - 1.0) / known.deviation);
    PRIOR * off.map(|off| off * off).sum::<f64>()
}

/// The searches of one fit.
struct Fitter {
    space: SearchSpace,
    search: SearchSettings,
    scorer: Scorer,
    /// Searches done: each draws random numbers of its own.
    searches: u32,
}

impl Fitter {
    /// The best pose of one frame round `centre`; `spread` is in steps of the body.
    fn pose(&mut self, frame: usize, centre: &[f32], spread: f32, iterations: usize) -> Result<(Vec<f32>, f32)> {
        let mut search = SearchSettings { iterations, ..self.search }.build(&self.space)?;
        let steps = self.space.spread(1.0 / 25.0)?;
        let spread: Vec<f32> = steps.into_iter().map(|step| step * spread).collect();
        self.searches += 1;
        let dofs = self.space.dof_count();
        let scorer = &self.scorer;
        let found = search.search_frame(self.searches, centre, &spread, &mut |rows, results| {
            scorer.poses(frame, dofs, rows, results)
        })?;
        Ok((found.pose, found.fitness))
    }

    /// The pose of a frame from nothing but the hull.
    fn first_pose(&mut self, body: &Body, frame: usize, hull: &Hull, heading: Option<f64>) -> Result<(Vec<f32>, f32)> {
        let headings = match heading {
            Some(heading) => vec![heading],
            None => (0..HEADINGS).map(|turn| turn as f64 * 360.0 / HEADINGS as f64 - 180.0).collect(),
        };
        let iterations = self.search.iterations;
        let by_fitness = |a: &(Vec<f32>, f32), b: &(Vec<f32>, f32)| b.1.total_cmp(&a.1);
        let mut found = Vec::new();
        // Of each heading the best arms go on: the best of all together would be one heading several times.
        for heading in headings {
            let mut tried = Vec::new();
            for arms in ARMS {
                let centre = rest_pose(body, hull, heading, arms)?;
                tried.push(self.pose(frame, &centre, 2.0, iterations.div_ceil(3))?);
            }
            tried.sort_by(by_fitness);
            if let Some(best) = tried.into_iter().next() {
                found.push(self.narrowed(frame, best)?);
            }
        }
        found.sort_by(by_fitness);
        found.truncate(SURVIVORS);
        for pose in &mut found {
            for _ in 0..ENCORES {
                *pose = self.narrowed(frame, std::mem::take(pose))?;
            }
        }
        found.sort_by(by_fitness);
        Ok(found.into_iter().next().unwrap_or_default())
    }

    /// First poses, each also searched round its neighbours', there and back: what fits better stays.
    fn follow(&mut self, mut poses: Vec<(Vec<f32>, f32)>) -> Result<Vec<(Vec<f32>, f32)>> {
        let last = poses.len().saturating_sub(1);
        let there = (0..last).map(|at| (at, at + 1));
        let back = (0..last).rev().map(|at| (at + 1, at));
        for (from, to) in there.chain(back) {
            let round = (poses[from].0.clone(), f32::NEG_INFINITY);
            let found = self.narrowed(to, round)?;
            if found.1 > poses[to].1 {
                poses[to] = found;
            }
        }
        Ok(poses)
    }

    /// A pose searched round with one spread after the other. A swarm has its centre among its particles, so nothing gets
    /// worse.
    fn narrowed(&mut self, frame: usize, mut pose: (Vec<f32>, f32)) -> Result<(Vec<f32>, f32)> {
        for spread in SPREADS {
            pose = self.pose(frame, &pose.0, spread, self.search.iterations)?;
        }
        Ok(pose)
    }

    /// Poses of all frames improved from given ones.
    fn settle(&mut self, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        let mut settled = Vec::new();
        for (frame, mut pose) in poses.into_iter().enumerate() {
            self.space.clamp(&mut pose);
            for spread in [2.0, 1.0] {
                pose = self.pose(frame, &pose, spread, self.search.iterations)?.0;
            }
            settled.push(pose);
        }
        Ok(settled)
    }

    /// The proportions of the body, with the poses moving along.
    fn stretch(&mut self, body: &Body, poses: &mut Vec<Vec<f32>>) -> Result<Proportions> {
        let (dofs, frames) = (self.space.dof_count(), poses.len());
        let known = Proportions::ALL;
        let joined = |shape: &dyn Fn(usize) -> f32, pose: &[f32]| -> Vec<f32> {
            (0..known.len()).map(shape).chain(pose.repeat(frames)).collect()
        };
        let lower = joined(&|i| known[i].limits[0] as f32, self.space.lower());
        let upper = joined(&|i| known[i].limits[1] as f32, self.space.upper());
        let steps = joined(&|i| known[i].deviation as f32, &self.space.spread(1.0 / 25.0)?);
        let space = SearchSpace::new(lower, upper, steps.clone())?;
        let mut centre: Vec<f32> = vec![1.0; known.len()];
        centre.extend(poses.concat());
        for round in 0..ROUNDS {
            let narrow = NARROWING.powi(round) as f32;
            let spread: Vec<f32> = steps.iter().map(|step| step * narrow).collect();
            let mut search = self.search.build(&space)?;
            self.searches += 1;
            let scorer = &self.scorer;
            let found = search.search_frame(self.searches, &centre, &spread, &mut |rows, results| {
                scorer.people(body, dofs, rows, results)
            })?;
            centre = found.pose;
            // The poses alone settle faster than with the proportions in tow.
            self.scorer.set_body(&proportions(&centre[..known.len()]).apply(body))?;
            for frame in 0..frames {
                let row = known.len() + frame * dofs..known.len() + (frame + 1) * dofs;
                let (pose, _) = self.pose(frame, &centre[row.clone()], narrow, self.search.iterations)?;
                centre[row].copy_from_slice(&pose);
            }
        }
        let (factors, settled) = centre.split_at(known.len());
        *poses = settled.chunks_exact(dofs).map(<[f32]>::to_vec).collect();
        Ok(proportions(factors))
    }
}

/// Standing in the hull, facing `heading` (degrees), arms lifted by `arms` degrees.
fn rest_pose(body: &Body, hull: &Hull, heading: f64, arms: f64) -> Result<Vec<f32>> {
    let names = body.dof_names();
    let mut pose = body.standing_pose();
    for (name, value) in [
        ("pelvis.tx", hull.centre.x),
        ("pelvis.ty", hull.centre.y),
        ("pelvis.rz", heading.to_radians()),
        ("left_shoulder.rx", arms.to_radians()),
        ("right_shoulder.rx", -arms.to_radians()),
    ] {
        let index = names.iter().position(|known| known == name);
        pose[index.with_context(|| format!("the body has no {name}, expected the joints of the default body"))?] =
            value;
    }
    if let Some(lift) = names.iter().position(|name| name == "pelvis.tz") {
        pose[lift] += hull.span[0];
    }
    body.clamp_to_limits(&mut pose);
    Ok(pose.into_iter().map(|value| value as f32).collect())
}
