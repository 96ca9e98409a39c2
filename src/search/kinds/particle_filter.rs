//! Bootstrap particle filter: sampling, importance, resampling (METHOD A8).

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::form::{Answer, Budget, SearchForm};
use crate::search::device::DeviceForm;
use crate::search::weights::Weights;
use crate::search::{Draw, Estimate, Fitness, Random, Search, SearchSpace, Stream, check_start};

/// Constants of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FilterSettings {
    /// sigma of the weights: how far below 1 a fitness may be and still count. Small values follow the best sample. Fitnesses
    /// of a good and of a lost pose differ by some tenths, those of neighbours by hundredths: a wide sigma averages everything.
    pub sigma: f32,
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self { sigma: 0.02 }
    }
}

impl FilterSettings {
    /// 1 / (2 sigma^2).
    pub(crate) fn sharpness(&self) -> f32 {
        (0.5 / f64::from(self.sigma).powi(2)) as f32
    }
}

impl SearchForm for FilterSettings {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        Box::new(ParticleFilter::new(self, budget, space))
    }

    fn check(&self) -> Result<()> {
        ensure!((1e-4..=10.0).contains(&self.sigma), "the filter's sigma is {}, expected 0.0001 to 10", self.sigma);
        Ok(())
    }

    fn carries_on(&self) -> bool {
        true
    }

    fn answer(&self) -> Answer {
        Answer::Mean
    }

    fn on_device(&self) -> Option<&dyn DeviceForm> {
        Some(self)
    }
}

/// The filter. Each frame it resamples the previous frame's particles by their weights (systematically: one random offset,
/// equal strides), moves each by N(0, spread) within the limits and weighs it by its fitness f with
///
/// ```text
/// w = 1 / (sigma sqrt(2 pi)) exp(-(1 - f)^2 / (2 sigma^2)),   normalised
/// ```
///
/// Weights are held as shares of the largest; resampling adds them up as integers of 2^-31 of it, exactly and so in any order.
/// Its estimate is the weighted mean, scored as one more pose. It keeps its particles while each frame's centre is the
/// estimate it gave before; any other centre (the first frame, a recovery) puts all of them there. Particles are scored
/// in as many batches as there are iterations.
pub struct ParticleFilter {
    name: &'static str,
    /// 1 / (2 sigma^2).
    sharpness: f32,
    /// Particles scored in one iteration.
    batch: usize,
    iterations: usize,
    random: Random,
    space: SearchSpace,
    frame: u32,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    spread: Vec<f32>,
    particles: Vec<f32>,
    /// The other half of a double buffer, for resampling.
    resampled: Vec<f32>,
    fitness: Vec<f32>,
    weights: Weights,
    /// The pose last estimated, which a next frame's centre is compared with; empty before.
    estimated: Vec<f32>,
}

impl ParticleFilter {
    /// A filter from checked settings.
    fn new(settings: &FilterSettings, budget: &Budget, space: &SearchSpace) -> Self {
        let (count, dofs) = (budget.particles * budget.iterations, space.dof_count());
        Self {
            name: budget.name,
            sharpness: settings.sharpness(),
            batch: budget.particles,
            iterations: budget.iterations,
            random: Random::new(budget.seed),
            space: space.clone(),
            frame: 0,
            done: None,
            spread: vec![0.0; dofs],
            particles: vec![0.0; count * dofs],
            resampled: vec![0.0; count * dofs],
            fitness: vec![0.0; count],
            weights: Weights::new(count),
            estimated: Vec::with_capacity(dofs),
        }
    }
}

impl Search for ParticleFilter {
    fn name(&self) -> &'static str {
        self.name
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        let dofs = self.space.dof_count();
        check_start(dofs, centre, spread)?;
        if self.estimated == centre {
            let stream = Stream { frame, iteration: 0, particle: 0, draw: Draw::Resampling };
            self.weights.resample(self.random, stream, &self.particles, &mut self.resampled);
            std::mem::swap(&mut self.particles, &mut self.resampled);
        } else {
            for row in self.particles.chunks_exact_mut(dofs) {
                row.copy_from_slice(centre);
            }
        }
        self.estimated.clear();
        self.spread.copy_from_slice(spread);
        self.frame = frame;
        self.done = Some(0);
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.iterations, "all {done} iterations of frame {} are done", self.frame);
        let dofs = self.space.dof_count();
        let first = done * self.batch;
        let rows = &mut self.particles[first * dofs..(first + self.batch) * dofs];
        let stream = Stream { frame: self.frame, iteration: 0, particle: first as u32, draw: Draw::Scatter };
        self.random.scatter(stream, &self.spread, [self.space.lower(), self.space.upper()], rows);
        fitness(rows, &mut self.fitness[first..first + self.batch])?;
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let scored = self.done.unwrap_or(0) * self.batch;
        ensure!(scored > 0, "the search has scored no pose yet, so there is nothing to estimate");
        let nearest = self.weights.weigh(&self.fitness[..scored], self.sharpness);
        let estimate = self.weights.estimate(&self.particles, nearest, &self.space, (self.frame, scored), fitness)?;
        self.estimated.clone_from(&estimate.pose);
        Ok(estimate)
    }
}
