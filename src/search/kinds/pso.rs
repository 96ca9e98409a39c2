//! Particle swarm: synchronous, global best (METHOD A8).

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::form::{Budget, SearchForm};
use crate::search::arithmetic::Statistics;
use crate::search::device::DeviceForm;
use crate::search::philox::GROUP;
use crate::search::{Draw, Estimate, Fitness, Random, Search, SearchSpace, Stream, check_start};

/// Constants of the swarm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PsoSettings {
    /// Inertia omega in the first and in the last iteration of a frame, linear between.
    pub inertia: [f32; 2],
    /// c1, towards the particle's own best.
    pub cognitive: f32,
    /// c2, towards the swarm's best.
    pub social: f32,
}

impl Default for PsoSettings {
    /// c1 = c2 = 1.49618 are Clerc and Kennedy's (2002) constriction, 2.05 times chi = 0.7298. Their inertia is chi
    /// throughout, made for hundreds of iterations. A frame has ten or twenty, so here it falls from 0.8 to 0.2, first to
    /// explore, then to settle: on a kinematic stand-in for the objective (31 degrees of freedom, walking) that left 0.75 to
    /// 0.81 of the constant's error at 100x10, 300x15 and 500x20 poses a frame.
    fn default() -> Self {
        Self { inertia: [0.8, 0.2], cognitive: 1.496_18, social: 1.496_18 }
    }
}

impl PsoSettings {
    /// Inertia of the move into iteration `iteration` (1 is the first move) of `iterations`.
    pub(crate) fn inertia_of(&self, iteration: usize, iterations: usize) -> f32 {
        let [first, last] = self.inertia;
        let moves = iterations.saturating_sub(2).max(1) as f32;
        first + (last - first) * ((iteration - 1) as f32 / moves)
    }
}

impl SearchForm for PsoSettings {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        Box::new(Pso::new(self, budget, space))
    }

    fn check(&self) -> Result<()> {
        for inertia in self.inertia {
            ensure!((0.0..=1.0).contains(&inertia), "the swarm's inertia is {inertia}, expected 0 to 1");
        }
        for (name, value) in [("cognitive", self.cognitive), ("social", self.social)] {
            ensure!((0.0..=4.0).contains(&value), "the swarm's {name} weight is {value}, expected 0 to 4");
        }
        Ok(())
    }

    fn on_device(&self) -> Option<&dyn DeviceForm> {
        Some(self)
    }
}

/// The swarm. A frame starts from x ~ N(centre, spread) at rest, but for particle 0, which starts at the centre itself:
/// whatever happens, the result is no worse than standing still. All particles move together after an iteration's
/// fitness is known. One that would leave a limit is put on it and its velocity there set to zero, so that it does not
/// press on; a particle's own best is replaced only by something better, and of equals the lowest index leads.
pub struct Pso {
    name: &'static str,
    settings: PsoSettings,
    iterations: usize,
    random: Random,
    space: SearchSpace,
    frame: u32,
    /// Iterations of this frame that came before this swarm, and its own: one swarm may be a level of several.
    before: usize,
    span: usize,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    /// Rows of positions, of velocities and of the particles' best positions.
    positions: Vec<f32>,
    velocities: Vec<f32>,
    best: Vec<f32>,
    fitness: Vec<f32>,
    best_fitness: Vec<f32>,
    /// The swarm's best position and its fitness.
    leader: Vec<f32>,
    leader_fitness: f32,
    equal_weights: Vec<f32>,
}

impl Pso {
    /// A swarm from checked settings.
    pub(super) fn new(settings: &PsoSettings, budget: &Budget, space: &SearchSpace) -> Self {
        let (count, dofs) = (budget.particles, space.dof_count());
        Self {
            name: budget.name,
            settings: *settings,
            iterations: budget.iterations,
            random: Random::new(budget.seed),
            space: space.clone(),
            frame: 0,
            before: 0,
            span: budget.iterations,
            done: None,
            positions: vec![0.0; count * dofs],
            velocities: vec![0.0; count * dofs],
            best: vec![0.0; count * dofs],
            fitness: vec![0.0; count],
            best_fitness: vec![f32::NEG_INFINITY; count],
            leader: vec![0.0; dofs],
            leader_fitness: f32::NEG_INFINITY,
            equal_weights: vec![1.0; count],
        }
    }

    /// A swarm at rest around `centre`, that takes the frame's iterations from `before` on and has `span` of them.
    pub(super) fn begin(&mut self, frame: u32, [before, span]: [usize; 2], centre: &[f32], spread: &[f32]) {
        let dofs = self.space.dof_count();
        (self.frame, self.before, self.span) = (frame, before, span);
        self.done = Some(before);
        for row in self.positions.chunks_exact_mut(dofs) {
            row.copy_from_slice(centre);
        }
        let (first, others) = self.positions.split_at_mut(dofs);
        self.space.clamp(first);
        let stream = Stream { frame, iteration: before as u32, particle: 1, draw: Draw::Scatter };
        self.random.scatter(stream, spread, [self.space.lower(), self.space.upper()], others);
        self.velocities.fill(0.0);
        self.best.copy_from_slice(&self.positions);
        self.best_fitness.fill(f32::NEG_INFINITY);
        self.leader.copy_from_slice(&self.positions[..dofs]);
        self.leader_fitness = f32::NEG_INFINITY;
    }

    /// The swarm's best position; where it began while no fitness was finite.
    pub(super) fn leader(&self) -> &[f32] {
        &self.leader
    }

    /// Standard deviation of the particles' best positions.
    pub(super) fn deviation(&self) -> Vec<f32> {
        Statistics::of(&self.best, &self.equal_weights, &self.leader).deviation
    }

    /// Moves every particle into iteration `iteration`.
    fn advance(&mut self, iteration: usize) {
        let step = Move {
            random: self.random,
            stream: Stream { frame: self.frame, iteration: iteration as u32, particle: 0, draw: Draw::Cognitive },
            omega: self.settings.inertia_of(iteration - self.before, self.span),
            cognitive: self.settings.cognitive,
            social: self.settings.social,
            leader: &self.leader,
            lower: self.space.lower(),
            upper: self.space.upper(),
        };
        move_rows(&step, &self.best, &mut self.positions, &mut self.velocities);
    }

    /// Takes note of an iteration's fitness.
    fn learn(&mut self) {
        let dofs = self.space.dof_count();
        let mut leading = None;
        for (index, (&fitness, best)) in self.fitness.iter().zip(&mut self.best_fitness).enumerate() {
            if fitness.is_finite() && fitness > *best {
                *best = fitness;
                let row = index * dofs..(index + 1) * dofs;
                self.best[row.clone()].copy_from_slice(&self.positions[row]);
                if fitness > self.leader_fitness {
                    self.leader_fitness = fitness;
                    leading = Some(index);
                }
            }
        }
        if let Some(index) = leading {
            self.leader.copy_from_slice(&self.positions[index * dofs..(index + 1) * dofs]);
        }
    }
}

/// What all particles share when they move.
struct Move<'a> {
    random: Random,
    /// Address of the random numbers but for particle and purpose.
    stream: Stream,
    omega: f32,
    cognitive: f32,
    social: f32,
    leader: &'a [f32],
    lower: &'a [f32],
    upper: &'a [f32],
}

/// Moves the particles: v <- omega v + c1 r1 (p - x) + c2 r2 (g - x), x <- x + v, within the limits. Compiled for several
/// instruction sets; the results are the same bits, since Rust neither reorders nor fuses floating-point operations.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn move_rows(step: &Move<'_>, best: &[f32], positions: &mut [f32], velocities: &mut [f32]) {
    let dofs = step.leader.len();
    let rows = positions.chunks_exact_mut(dofs).zip(velocities.chunks_exact_mut(dofs));
    for (particle, ((x, v), p)) in rows.zip(best.chunks_exact(dofs)).enumerate() {
        let cognitive = Stream { particle: particle as u32, ..step.stream };
        let social = Stream { draw: Draw::Social, ..cognitive };
        for group in 0..dofs.div_ceil(GROUP) {
            let r1 = step.random.uniform_group(cognitive, group);
            let r2 = step.random.uniform_group(social, group);
            let from = group * GROUP;
            let count = GROUP.min(dofs - from);
            let range = from..from + count;
            // Slices of one length and no branch: the compiler turns this loop into vectors.
            let (x, v, p) = (&mut x[range.clone()], &mut v[range.clone()], &p[range.clone()]);
            let (g, low, high) = (&step.leader[range.clone()], &step.lower[range.clone()], &step.upper[range]);
            for d in 0..count {
                let velocity =
                    step.omega * v[d] + step.cognitive * r1[d] * (p[d] - x[d]) + step.social * r2[d] * (g[d] - x[d]);
                let free = x[d] + velocity;
                let held = free.max(low[d]).min(high[d]);
                v[d] = if held == free { velocity } else { 0.0 };
                x[d] = held;
            }
        }
    }
}

impl Search for Pso {
    fn name(&self) -> &'static str {
        self.name
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        check_start(self.space.dof_count(), centre, spread)?;
        self.begin(frame, [0, self.iterations], centre, spread);
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.iterations, "all {done} iterations of frame {} are done", self.frame);
        if done > self.before {
            self.advance(done);
        }
        fitness(&self.positions, &mut self.fitness)?;
        self.learn();
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, _fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let evaluations = self.done.unwrap_or(0) * self.fitness.len();
        ensure!(evaluations > 0, "the search has scored no pose yet, so there is nothing to estimate");
        ensure!(
            self.leader_fitness.is_finite(),
            "none of the {evaluations} poses of frame {} has a finite fitness",
            self.frame
        );
        let (pose, spread) = (self.leader.clone(), self.deviation());
        Ok(Estimate { pose, fitness: self.leader_fitness, spread, evaluations })
    }
}
