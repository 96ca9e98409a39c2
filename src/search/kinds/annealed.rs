//! Annealed particle filter (Deutscher and Reid: "Articulated body motion capture by stochastic search", 2005; METHOD A8).

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::form::{Answer, Budget, SearchForm};
use crate::search::device::DeviceForm;
use crate::search::weights::Weights;
use crate::search::{Draw, Estimate, Fitness, Random, Search, SearchSpace, Stream, check_start};

/// Constants of the annealing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AnnealingSettings {
    /// Share of the particles that a layer's weights leave: their effective number `(sum w)^2 / sum w^2` over their number.
    pub survival: f32,
    /// Factor on the frame's spread that the last layer is scattered with; the first has 1, those between fall geometrically.
    pub last_noise: f32,
}

impl Default for AnnealingSettings {
    fn default() -> Self {
        Self { survival: 0.3, last_noise: 0.15 }
    }
}

impl AnnealingSettings {
    /// Factor on the spread in a layer of so many.
    pub(crate) fn noise_of(&self, layer: usize, layers: usize) -> f32 {
        let progress = layer as f64 / layers.saturating_sub(1).max(1) as f64;
        f64::from(self.last_noise).powf(progress) as f32
    }
}

impl SearchForm for AnnealingSettings {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        Box::new(AnnealedFilter::new(self, budget, space))
    }

    fn check(&self) -> Result<()> {
        for (name, value) in [("survival rate", self.survival), ("last noise", self.last_noise)] {
            ensure!((0.001..=1.0).contains(&value), "the annealing's {name} is {value}, expected 0.001 to 1");
        }
        Ok(())
    }

    fn answer(&self) -> Answer {
        Answer::Mean
    }

    fn on_device(&self) -> Option<&dyn DeviceForm> {
        Some(self)
    }
}

/// The filter. An iteration is a layer: the particles are resampled by the weights of the layer before and scattered, each
/// layer with less noise. A layer weighs its particles by
///
/// ```text
/// w = exp(-beta (1 - f)^2)
/// ```
///
/// with the exponent beta that leaves [`AnnealingSettings::survival`] of them, and no smaller one than the layer before. The
/// estimate is the weighted mean of the last layer, scored as one more pose.
///
/// The first layer of a frame is scattered around the centre, with one particle at the centre itself, instead of around the
/// particles of the frame before: these have settled there, and so a frame depends on its centre alone.
pub struct AnnealedFilter {
    name: &'static str,
    settings: AnnealingSettings,
    layers: usize,
    random: Random,
    space: SearchSpace,
    frame: u32,
    /// Layers done in this frame; `None` before the first frame.
    done: Option<usize>,
    spread: Vec<f32>,
    noise: Vec<f32>,
    particles: Vec<f32>,
    /// The other half of a double buffer, for resampling.
    resampled: Vec<f32>,
    fitness: Vec<f32>,
    weights: Weights,
    /// The exponent of the last layer.
    sharpness: f32,
}

impl AnnealedFilter {
    /// A filter from checked settings.
    fn new(settings: &AnnealingSettings, budget: &Budget, space: &SearchSpace) -> Self {
        let (count, dofs) = (budget.particles, space.dof_count());
        Self {
            name: budget.name,
            settings: *settings,
            layers: budget.iterations,
            random: Random::new(budget.seed),
            space: space.clone(),
            frame: 0,
            done: None,
            spread: vec![0.0; dofs],
            noise: vec![0.0; dofs],
            particles: vec![0.0; count * dofs],
            resampled: vec![0.0; count * dofs],
            fitness: vec![f32::NAN; count],
            weights: Weights::new(count),
            sharpness: 0.0,
        }
    }

    /// Weighs the last layer; yields the particle with the largest weight, none where no fitness is finite.
    fn weigh(&mut self) -> Option<usize> {
        self.sharpness = Weights::sharpness_for(&self.fitness, self.settings.survival, self.sharpness);
        self.weights.weigh(&self.fitness, self.sharpness)
    }
}

impl Search for AnnealedFilter {
    fn name(&self) -> &'static str {
        self.name
    }

    fn iterations(&self) -> usize {
        self.layers
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        let dofs = self.space.dof_count();
        check_start(dofs, centre, spread)?;
        for row in self.particles.chunks_exact_mut(dofs) {
            row.copy_from_slice(centre);
            self.space.clamp(row);
        }
        self.spread.copy_from_slice(spread);
        self.sharpness = 0.0;
        self.frame = frame;
        self.done = Some(0);
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.layers, "all {done} iterations of frame {} are done", self.frame);
        let stream = Stream { frame: self.frame, iteration: done as u32, particle: 0, draw: Draw::Scatter };
        // A layer without any finite fitness has nothing to choose by: its particles go on as they are.
        if done > 0 && self.weigh().is_some() {
            let stream = Stream { draw: Draw::Resampling, ..stream };
            self.weights.resample(self.random, stream, &self.particles, &mut self.resampled);
            std::mem::swap(&mut self.particles, &mut self.resampled);
        }
        let factor = self.settings.noise_of(done, self.layers);
        for (noise, spread) in self.noise.iter_mut().zip(&self.spread) {
            *noise = spread * factor;
        }
        let kept = if done == 0 { self.space.dof_count() } else { 0 };
        let limits = [self.space.lower(), self.space.upper()];
        self.random.scatter(stream, &self.noise, limits, &mut self.particles[kept..]);
        fitness(&self.particles, &mut self.fitness)?;
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let scored = self.done.unwrap_or(0) * self.fitness.len();
        ensure!(scored > 0, "the search has scored no pose yet, so there is nothing to estimate");
        let nearest = self.weigh();
        self.weights.estimate(&self.particles, nearest, &self.space, (self.frame, scored), fitness)
    }
}
