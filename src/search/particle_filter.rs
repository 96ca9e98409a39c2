//! Bootstrap particle filter: sampling, importance, resampling (SPEC A8).

use std::ops::Range;

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::{
    Draw, Estimate, Fitness, Random, Search, SearchSettings, SearchSpace, Stream, check_start, weighted_deviation,
    weighted_mean,
};

/// Constants of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FilterSettings {
    /// sigma of the weights: how far below 1 a fitness may be and still count. Small values follow the best sample.
    pub sigma: f32,
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self { sigma: 0.05 }
    }
}

impl FilterSettings {
    pub(super) fn check(&self) -> Result<()> {
        ensure!((1e-4..=10.0).contains(&self.sigma), "the filter's sigma is {}, expected 0.0001 to 10", self.sigma);
        Ok(())
    }
}

/// The filter. Each frame it resamples the previous frame's particles by their weights (systematically: one random offset,
/// equal strides), moves each by N(0, spread) within the limits and weighs it by its fitness f with
///
/// ```text
/// w = 1 / (sigma sqrt(2 pi)) exp(-(1 - f)^2 / (2 sigma^2)),   normalised
/// ```
///
/// Its estimate is the weighted mean, scored as one more pose. It keeps its particles while each frame's centre is the
/// estimate it gave before; any other centre (the first frame, a recovery) puts all of them there. Particles are scored
/// in as many batches as there are iterations.
pub struct ParticleFilter {
    sigma: f64,
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
    weights: Vec<f64>,
    /// The pose last estimated, which a next frame's centre is compared with; empty before.
    estimated: Vec<f32>,
}

impl ParticleFilter {
    /// A filter from checked settings.
    pub(super) fn new(settings: &SearchSettings, space: &SearchSpace) -> Self {
        let (count, dofs) = (settings.particles * settings.iterations, space.dof_count());
        Self {
            sigma: f64::from(settings.filter.sigma),
            batch: settings.particles,
            iterations: settings.iterations,
            random: Random::new(settings.seed),
            space: space.clone(),
            frame: 0,
            done: None,
            spread: vec![0.0; dofs],
            particles: vec![0.0; count * dofs],
            resampled: vec![0.0; count * dofs],
            fitness: vec![0.0; count],
            weights: vec![0.0; count],
            estimated: Vec::with_capacity(dofs),
        }
    }

    /// Copies of particles in proportion to their weights, which sum to 1.
    fn resample(&mut self, frame: u32) {
        let dofs = self.space.dof_count();
        let count = self.weights.len();
        let mut offset = [0.0];
        let stream = Stream { frame, iteration: 0, particle: 0, draw: Draw::Resampling };
        self.random.uniforms(stream, &mut offset);
        let mut chosen = 0;
        let mut cumulated = self.weights[0];
        for (index, row) in self.resampled.chunks_exact_mut(dofs).enumerate() {
            let pointer = (index as f64 + f64::from(offset[0])) / count as f64;
            // Rounding may leave the sum a little below 1; the last particle with a weight then takes the rest.
            while cumulated <= pointer && self.weights[chosen + 1..].iter().any(|&weight| weight > 0.0) {
                chosen += 1;
                cumulated += self.weights[chosen];
            }
            row.copy_from_slice(&self.particles[chosen * dofs..(chosen + 1) * dofs]);
        }
        std::mem::swap(&mut self.particles, &mut self.resampled);
    }

    /// Indices of the particles scored so far.
    fn scored(&self) -> Range<usize> {
        0..self.done.unwrap_or(0) * self.batch
    }

    /// Sets the normalised weights from the fitness; particles not scored get none. The common factor of the formula
    /// cancels, and taking the best one's exponent out keeps the others from vanishing together.
    fn weigh(&mut self) -> Result<()> {
        let scored = self.scored();
        let exponent = |fitness: f32| -(1.0 - f64::from(fitness)).powi(2) / (2.0 * self.sigma * self.sigma);
        let fitness = &self.fitness[scored.clone()];
        let finite = fitness.iter().filter(|fitness| fitness.is_finite());
        let largest = finite.map(|&fitness| exponent(fitness)).fold(f64::NEG_INFINITY, f64::max);
        ensure!(
            largest > f64::NEG_INFINITY,
            "none of the {} poses of frame {} has a finite fitness",
            scored.len(),
            self.frame
        );
        self.weights.fill(0.0);
        for (weight, &fitness) in self.weights.iter_mut().zip(fitness) {
            if fitness.is_finite() {
                *weight = (exponent(fitness) - largest).exp();
            }
        }
        let total: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|weight| *weight /= total);
        Ok(())
    }
}

impl Search for ParticleFilter {
    fn name(&self) -> &'static str {
        "pf"
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        let dofs = self.space.dof_count();
        check_start(dofs, centre, spread)?;
        if self.estimated == centre {
            self.resample(frame);
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
        let dofs = self.space.dof_count();
        let scored = self.scored().len();
        ensure!(scored > 0, "the search has scored no pose yet, so there is nothing to estimate");
        self.weigh()?;
        let rows = &self.particles[..scored * dofs];
        let mean = weighted_mean(rows, dofs, |index| self.weights[index]);
        let spread = weighted_deviation(rows, dofs, |index| self.weights[index], &mean);
        let mut pose: Vec<f32> = mean.into_iter().map(|value| value as f32).collect();
        self.space.clamp(&mut pose);
        let mut score = [f32::NAN];
        fitness(&pose, &mut score)?;
        let evaluations = scored + 1;
        ensure!(score[0].is_finite(), "the estimate of frame {} has a fitness of {}", self.frame, score[0]);
        self.estimated.clone_from(&pose);
        Ok(Estimate { pose, fitness: score[0], spread, evaluations })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systematic_resampling_is_proportional() {
        let space = SearchSpace::new(vec![-10.0], vec![10.0], vec![1.0]).unwrap();
        let settings = SearchSettings { particles: 8, iterations: 1, ..SearchSettings::default() };
        let weights = [0.0, 0.3, 0.05, 0.0, 0.4, 0.125, 0.125, 0.0];
        for frame in 0..200 {
            let mut filter = ParticleFilter::new(&settings, &space);
            filter.weights.copy_from_slice(&weights);
            for (index, particle) in filter.particles.iter_mut().enumerate() {
                *particle = index as f32;
            }
            filter.resample(frame);
            for (index, weight) in weights.iter().enumerate() {
                let copies = filter.particles.iter().filter(|particle| **particle == index as f32).count() as f64;
                let expected = weight * 8.0;
                assert!((copies - expected).abs() < 1.0, "frame {frame}, particle {index}: {copies} for {expected}");
            }
        }
    }

    #[test]
    fn weights_follow_the_formula() {
        let space = SearchSpace::new(vec![-10.0], vec![10.0], vec![1.0]).unwrap();
        let settings = SearchSettings { particles: 5, iterations: 1, ..SearchSettings::default() };
        let mut filter = ParticleFilter::new(&settings, &space);
        filter.done = Some(1);
        filter.fitness.copy_from_slice(&[0.9, 0.85, f32::NAN, 0.7, 0.0]);
        filter.weigh().unwrap();
        let sigma = f64::from(settings.filter.sigma);
        let formula = |f: f32| {
            (-(1.0 - f64::from(f)).powi(2) / (2.0 * sigma * sigma)).exp() / (sigma * std::f64::consts::TAU.sqrt())
        };
        let plain = [formula(0.9), formula(0.85), 0.0, formula(0.7), formula(0.0)];
        let total: f64 = plain.iter().sum();
        for (weight, plain) in filter.weights.iter().zip(plain) {
            assert!((weight - plain / total).abs() < 1e-12, "{weight} for {}", plain / total);
        }
        // Fitness so low that the plain formula would give 0 / 0.
        filter.sigma = 1e-4;
        filter.fitness.copy_from_slice(&[0.1, 0.1, f32::NAN, 0.0, 0.0]);
        filter.weigh().unwrap();
        assert_eq!(filter.weights, [0.5, 0.5, 0.0, 0.0, 0.0]);
    }
}
