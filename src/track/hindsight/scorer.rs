//! What a pose is worth when the frames around it are known: its match with the pictures, less what it costs to be somewhere else than
//! they lead to expect, or in itself (METHOD A14).

use anyhow::Result;
use glam::DVec3;
use rayon::prelude::*;

use super::path::greatest;
use super::shape::{Posed, Shape};
use crate::evaluate::{Evaluator, Objective};
use crate::features::Observation;
use crate::search::{SearchKind, SearchSettings, SearchSpace};
use crate::track::glance::Seer;
use crate::track::worth::MATCH;

/// Samples of a generation, where a run has as many particles.
const GENERATION: usize = 50;
/// Poses whose costs are computed in one piece.
const COSTS_AT_ONCE: usize = 16;
/// Fitness below which nothing gets worse.
const LEAST: f64 = 1e-6;
/// From which distance of a joint on two poses are apart, mm.
const APART: f64 = 100.0;
/// Deviations from which on a joint that is elsewhere costs little more.
const ROBUST: f64 = 3.0;

/// Cost of a joint that is so many deviations off: quadratic at first, logarithmic far out.
pub(super) fn robust(deviations_squared: f64) -> f64 {
    const SQUARE: f64 = ROBUST * ROBUST;
    0.5 * SQUARE * (deviations_squared / SQUARE).ln_1p()
}

/// Where joints are expected.
#[derive(Clone, Debug)]
pub(super) struct Pull {
    /// mm.
    pub(super) targets: Vec<DVec3>,
    /// Standard deviations, mm.
    pub(super) scales: Vec<f64>,
}

impl Pull {
    /// What it costs to have the joints at `points`.
    pub(super) fn cost(&self, points: &[DVec3]) -> f64 {
        let pairs = points.iter().zip(&self.targets).zip(&self.scales);
        pairs.map(|((point, target), scale)| robust(point.distance_squared(*target) / (scale * scale))).sum()
    }
}

/// A pose of a frame, and what is known of it.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) pose: Vec<f32>,
    /// The joints, mm.
    pub(super) points: Vec<DVec3>,
    /// What the frame alone says for it.
    pub(super) worth: f64,
    /// Whether the pictures were asked, and say of no limb that it is elsewhere.
    pub(super) is_looked_at: bool,
    /// Whether it is what came of looking for its limbs.
    pub(super) is_looked_into: bool,
}

/// Whether two poses have a joint far apart.
pub(super) fn apart(one: &[DVec3], other: &[DVec3]) -> bool {
    one.iter().zip(other).any(|(a, b)| a.distance(*b) > APART)
}

/// What the best of candidates is worth by itself.
pub(super) fn most_worth<'c>(candidates: impl IntoIterator<Item = &'c Candidate>) -> f64 {
    candidates.into_iter().map(|candidate| candidate.worth).fold(f64::NEG_INFINITY, f64::max)
}

/// The index of the candidate that is worth most under a pull, or by itself; of equals the first.
pub(super) fn most_under(candidates: &[Candidate], pull: Option<&Pull>) -> usize {
    let worth = |candidate: &Candidate| candidate.worth - pull.map_or(0.0, |pull| pull.cost(&candidate.points));
    greatest(candidates.iter().map(worth))
}

/// Poses scored at once, and memory for what is found of them.
#[derive(Default)]
struct Batch {
    /// A pose a row.
    rows: Vec<f32>,
    fitness: Vec<f32>,
    costs: Vec<f64>,
}

/// Told how much of a frame's work is done; an error where the run is to end.
pub(super) type Told<'a> = dyn Fn(usize) -> Result<()> + Sync + 'a;

/// Scores poses of the frame observed last.
pub(super) struct Scorer<'a> {
    pub(super) evaluator: &'a mut dyn Evaluator,
    pub(super) objective: &'a Objective,
    pub(super) space: &'a SearchSpace,
    pub(super) shape: &'a Shape,
    watch: Option<&'a Told<'a>>,
    /// Decides all random numbers.
    seed: u64,
    /// The poses that a run scores a frame, over the usual ones.
    share: f64,
    /// Samples of a generation.
    pub(super) generation: usize,
    /// Poses scored so far.
    pub(super) scored: usize,
}

/// How widely and for how long to search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort<'a> {
    /// Standard deviation of each degree of freedom.
    pub(super) spread: &'a [f32],
    /// How many generations.
    pub(super) generations: usize,
    /// What tells the random numbers of searches of one frame apart.
    pub(super) turn: u64,
}

/// Of the fitness, what the frame alone says for a pose.
fn matched(fitness: f32) -> f64 {
    MATCH * f64::from(fitness).max(LEAST).ln()
}

impl<'a> Scorer<'a> {
    /// For a run with these settings.
    pub(super) fn new(
        evaluator: &'a mut dyn Evaluator,
        objective: &'a Objective,
        space: &'a SearchSpace,
        shape: &'a Shape,
        settings: &SearchSettings,
    ) -> Self {
        let usual = SearchSettings::default();
        let poses = |settings: &SearchSettings| settings.particles as f64 * settings.iterations as f64;
        let share = poses(settings) / poses(&usual);
        Self {
            evaluator,
            objective,
            space,
            shape,
            watch: None,
            seed: settings.seed,
            share,
            generation: GENERATION.min(settings.particles),
            scored: 0,
        }
    }

    /// Tells how far it is, and is stopped.
    pub(super) fn watched_by(self, watch: &'a Told<'a>) -> Self {
        Self { watch: Some(watch), ..self }
    }

    /// So much of a frame's work is done.
    ///
    /// # Errors
    /// Where the run is to end.
    pub(super) fn has_worked(&self, share: usize) -> Result<()> {
        self.watch.map_or(Ok(()), |watch| watch(share))
    }

    /// What is `usual` where a run scores as many poses as it usually does, at least 1.
    pub(super) fn generations(&self, usual: usize) -> usize {
        ((usual as f64 * self.share).round() as usize).max(1)
    }

    /// For looks at what was observed.
    pub(super) fn seer(&mut self) -> Seer<'_> {
        Seer { evaluator: &mut *self.evaluator, objective: self.objective }
    }

    pub(super) fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        self.evaluator.observe(observations)
    }

    /// The worth of a batch of poses. What they cost is computed while they are scored.
    fn weigh(&mut self, batch: &mut Batch, pull: Option<&Pull>, worth: &mut [f32]) -> Result<()> {
        let Self { evaluator, objective, space, shape, .. } = self;
        let Batch { rows, fitness, costs } = batch;
        fitness.resize(worth.len(), 0.0);
        costs.resize(worth.len(), 0.0);
        let all_costs = || {
            let each = rows.par_chunks_exact(space.dof_count()).zip(costs.par_iter_mut()).with_min_len(COSTS_AT_ONCE);
            each.for_each_init(Posed::default, |posed, (row, cost)| {
                shape.pose(row, posed);
                *cost = shape.cost(posed) + pull.map_or(0.0, |pull| pull.cost(&posed.points));
            });
        };
        rayon::join(|| evaluator.fitness(rows, objective, fitness), all_costs).0?;
        for ((worth, fitness), cost) in worth.iter_mut().zip(fitness).zip(costs) {
            *worth = (matched(*fitness) - *cost) as f32;
        }
        Ok(())
    }

    /// Poses of the frame as candidates.
    pub(super) fn candidates(&mut self, poses: &[Vec<f32>]) -> Result<Vec<Candidate>> {
        let mut fitness = vec![0.0; poses.len()];
        if !poses.is_empty() {
            self.evaluator.fitness(&poses.concat(), self.objective, &mut fitness)?;
        }
        self.scored += poses.len();
        let mut posed = Posed::default();
        let pairs = poses.iter().zip(fitness);
        Ok(pairs.map(|(pose, fitness)| self.scored_candidate(pose.clone(), fitness, &mut posed)).collect())
    }

    /// A pose of which the fitness is known.
    fn scored_candidate(&self, pose: Vec<f32>, fitness: f32, posed: &mut Posed) -> Candidate {
        self.shape.pose(&pose, posed);
        let worth = matched(fitness) - self.shape.cost(posed);
        Candidate { pose, points: posed.points.clone(), worth, is_looked_at: false, is_looked_into: false }
    }

    /// A pose of the frame as a candidate.
    pub(super) fn candidate(&mut self, pose: Vec<f32>) -> Result<Candidate> {
        Ok(self.candidates(&[pose])?.swap_remove(0))
    }

    /// [`Self::search`], moving all that has a spread.
    pub(super) fn search_all(
        &mut self,
        frame: usize,
        centre: &[f32],
        effort: Effort<'_>,
        pull: Option<&Pull>,
    ) -> Result<Candidate> {
        let moved: Vec<usize> = (0..centre.len()).filter(|&d| effort.spread[d] > 0.0).collect();
        self.search(frame, centre, &moved, effort, pull)
    }

    /// Searches around `centre`, moving the degrees of freedom in `moved` alone, for what is worth most under `pull`.
    pub(super) fn search(
        &mut self,
        frame: usize,
        centre: &[f32],
        moved: &[usize],
        effort: Effort<'_>,
        pull: Option<&Pull>,
    ) -> Result<Candidate> {
        let part = |values: &[f32]| -> Vec<f32> { moved.iter().map(|&d| values[d]).collect() };
        let space = SearchSpace::new(part(self.space.lower()), part(self.space.upper()), vec![1.0; moved.len()])?;
        let (particles, iterations) = (self.generation, effort.generations);
        let mut settings = SearchSettings {
            kind: SearchKind::MaEs,
            particles,
            iterations,
            seed: self.seed,
            ..SearchSettings::default()
        };
        settings.matrix.generation = particles;
        let mut search = settings.reseeded(effort.turn + 1).build(&space)?;
        let mut batch = Batch::default();
        // Of all poses the first that is worth most, and its fitness.
        let mut best = (f32::NEG_INFINITY, 0.0);
        let frame = u32::try_from(frame).unwrap_or(u32::MAX);
        let estimate = search.search_frame(frame, &part(centre), &part(effort.spread), &mut |rows, worth| {
            batch.rows.clear();
            for row in rows.chunks_exact(moved.len()) {
                let begin = batch.rows.len();
                batch.rows.extend_from_slice(centre);
                moved.iter().zip(row).for_each(|(&d, value)| batch.rows[begin + d] = *value);
            }
            self.weigh(&mut batch, pull, worth)?;
            let all = worth.iter().copied().zip(batch.fitness.iter().copied());
            best = all.fold(best, |best, one| if one.0 > best.0 { one } else { best });
            Ok(())
        })?;
        self.scored += estimate.evaluations;
        let mut pose = centre.to_vec();
        moved.iter().zip(&estimate.pose).for_each(|(&d, value)| pose[d] = *value);
        // The mean, which is scored last, or the best before it.
        let fitness = if batch.rows == pose { batch.fitness[0] } else { best.1 };
        Ok(self.scored_candidate(pose, fitness, &mut Posed::default()))
    }
}
