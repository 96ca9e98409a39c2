//! Bootstrap particle filter: sampling, importance, resampling (SPEC A8).

use std::ops::Range;

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::arithmetic::{Statistics, exp_of_negative};
use super::{Draw, Estimate, Fitness, Random, Search, SearchSettings, SearchSpace, Stream, check_start};

/// What a share of 1 counts in the integer sums that resampling goes by.
pub(super) const WHOLE: f32 = 2_147_483_648.0;

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

    /// 1 / (2 sigma^2).
    pub(super) fn sharpness(&self) -> f32 {
        (0.5 / f64::from(self.sigma).powi(2)) as f32
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
    /// Weights as shares of the largest.
    shares: Vec<f32>,
    /// The particle with the largest.
    nearest: usize,
    /// Sums of the shares up to and with each particle, 2^-31.
    cumulated: Vec<u64>,
    /// The pose last estimated, which a next frame's centre is compared with; empty before.
    estimated: Vec<f32>,
}

impl ParticleFilter {
    /// A filter from checked settings.
    pub(super) fn new(settings: &SearchSettings, space: &SearchSpace) -> Self {
        let (count, dofs) = (settings.particles * settings.iterations, space.dof_count());
        Self {
            sharpness: settings.filter.sharpness(),
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
            shares: vec![0.0; count],
            nearest: 0,
            cumulated: vec![0; count],
            estimated: Vec::with_capacity(dofs),
        }
    }

    /// Copies of particles in proportion to their weights.
    fn resample(&mut self, frame: u32) {
        let dofs = self.space.dof_count();
        let count = self.cumulated.len() as u64;
        let stream = Stream { frame, iteration: 0, particle: 0, draw: Draw::Resampling };
        let stride = self.cumulated[self.cumulated.len() - 1] / count;
        // At most 2^31, a weight's mean, times a fraction of 2^32; less than a stride, so no pointer reaches the sum of all.
        let offset = (stride * u64::from(self.random.first_word(stream))) >> 32;
        let mut chosen = 0;
        for (index, row) in self.resampled.chunks_exact_mut(dofs).enumerate() {
            let pointer = index as u64 * stride + offset;
            while self.cumulated[chosen] <= pointer {
                chosen += 1;
            }
            row.copy_from_slice(&self.particles[chosen * dofs..(chosen + 1) * dofs]);
        }
        std::mem::swap(&mut self.particles, &mut self.resampled);
    }

    /// Indices of the particles scored so far.
    fn scored(&self) -> Range<usize> {
        0..self.done.unwrap_or(0) * self.batch
    }

    /// Sets the weights from the fitness; particles not scored get none. The common factor of the formula cancels, and so
    /// does the largest one's exponent, which keeps the others from vanishing together.
    fn weigh(&mut self) -> Result<()> {
        let scored = self.scored();
        let fitness = &self.fitness[scored.clone()];
        let mut nearest = None;
        for (index, fitness) in fitness.iter().enumerate().filter(|(_, fitness)| fitness.is_finite()) {
            let distance = (1.0 - fitness).abs();
            if nearest.is_none_or(|(_, least)| distance < least) {
                nearest = Some((index, distance));
            }
        }
        let Some((nearest, _)) = nearest else {
            bail!("none of the {} poses of frame {} has a finite fitness", scored.len(), self.frame)
        };
        let largest = fitness[nearest];
        self.nearest = nearest;
        self.shares.fill(0.0);
        for (share, &fitness) in self.shares.iter_mut().zip(fitness).filter(|(_, fitness)| fitness.is_finite()) {
            // (1 - f)^2 less the same of the largest, without the digits that a difference of squares loses.
            let exponent = (fitness - largest) * (2.0 - fitness - largest) * self.sharpness;
            *share = exp_of_negative(if exponent > 0.0 { 0.0 } else { exponent });
        }
        self.cumulate();
        Ok(())
    }

    fn cumulate(&mut self) {
        let mut sum = 0;
        for (share, cumulated) in self.shares.iter().zip(&mut self.cumulated) {
            sum += u64::from((share * WHOLE) as u32);
            *cumulated = sum;
        }
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
        let reference = &self.particles[self.nearest * dofs..(self.nearest + 1) * dofs];
        let Statistics { mean: mut pose, deviation: spread } = Statistics::of(&self.particles, &self.shares, reference);
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
            filter.shares.copy_from_slice(&weights.map(|weight| (weight / 0.4) as f32));
            filter.cumulate();
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
        for (index, (share, plain)) in filter.shares.iter().zip(plain).enumerate() {
            assert!((f64::from(*share) - plain / formula(0.9)).abs() < 1e-6, "{share} for {}", plain / formula(0.9));
            let before = if index == 0 { 0 } else { filter.cumulated[index - 1] };
            let weight = (filter.cumulated[index] - before) as f64 / f64::from(WHOLE);
            assert!((weight - f64::from(*share)).abs() < 1e-9);
        }
        // Fitness so low that the plain formula would give 0 / 0.
        filter.sharpness = FilterSettings { sigma: 1e-4 }.sharpness();
        filter.fitness.copy_from_slice(&[0.1, 0.1, f32::NAN, 0.0, 0.0]);
        filter.weigh().unwrap();
        assert_eq!(filter.shares, [1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}
