//! What the evolution strategies share: generations drawn from a distribution, scored, ranked and learnt from.

use std::ops::Range;

use anyhow::{Result, bail, ensure};

use super::form::Budget;
use crate::search::{Draw, Estimate, Fitness, Random, Search, SearchSpace, Stream, check_start};

/// A distribution of poses that learns from what was drawn of it. Samples have numbers, those of a frame's iteration from 0.
pub(super) trait Distribution: Send {
    /// Begins a frame around `centre`, within the limits, with this standard deviation.
    fn start(&mut self, centre: &[f32], spread: &[f32]);

    /// Makes sample `index` from normal numbers and puts its pose in `row`, within the limits. Without any it is the centre.
    fn draw(&mut self, index: usize, normals: Option<&[f32]>, row: &mut [f32]);

    /// Learns from a generation of samples `range`; `order` has those with a finite fitness, best first, at least one.
    fn learn(&mut self, range: Range<usize>, order: &[usize]);

    /// Its mean, within the limits.
    fn mean(&self, row: &mut [f32]);

    /// Its standard deviation, one a degree of freedom.
    fn deviation(&self) -> Vec<f32>;
}

/// The generations of an iteration of `particles` samples when they have at least `least` each: as many as these make.
pub(crate) fn generations(particles: usize, least: usize) -> impl Iterator<Item = Range<usize>> {
    let count = (particles / least).max(1);
    (0..count).map(move |generation| generation * particles / count..(generation + 1) * particles / count)
}

/// An evolution strategy. The first sample of a frame is its centre. The estimate is the mean of the last distribution,
/// scored as one more pose, or the best sample where that is better.
pub(super) struct Evolution<D> {
    name: &'static str,
    generation: usize,
    particles: usize,
    iterations: usize,
    random: Random,
    space: SearchSpace,
    frame: u32,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    distribution: D,
    normals: Vec<f32>,
    rows: Vec<f32>,
    fitness: Vec<f32>,
    order: Vec<usize>,
    best: Vec<f32>,
    best_fitness: f32,
}

impl<D: Distribution> Evolution<D> {
    /// A search whose generations have `generation` samples at least.
    pub(super) fn new(generation: usize, budget: &Budget, space: &SearchSpace, distribution: D) -> Self {
        let (count, dofs) = (budget.particles, space.dof_count());
        Self {
            name: budget.name,
            generation,
            particles: count,
            iterations: budget.iterations,
            random: Random::new(budget.seed),
            space: space.clone(),
            frame: 0,
            done: None,
            distribution,
            normals: vec![0.0; dofs],
            rows: vec![0.0; count * dofs],
            fitness: vec![f32::NAN; count],
            order: Vec::with_capacity(count),
            best: vec![0.0; dofs],
            best_fitness: f32::NEG_INFINITY,
        }
    }

    /// Draws the samples `range` of iteration `iteration`.
    fn draw(&mut self, iteration: usize, range: Range<usize>) {
        let dofs = self.space.dof_count();
        for particle in range {
            let row = &mut self.rows[particle * dofs..(particle + 1) * dofs];
            if (iteration, particle) == (0, 0) {
                self.distribution.draw(particle, None, row);
                continue;
            }
            let stream = Stream {
                frame: self.frame,
                iteration: iteration as u32,
                particle: particle as u32,
                draw: Draw::Scatter,
            };
            self.random.normals(stream, &mut self.normals);
            self.distribution.draw(particle, Some(&self.normals), row);
        }
    }
}

impl<D: Distribution> Search for Evolution<D> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        check_start(self.space.dof_count(), centre, spread)?;
        self.frame = frame;
        self.done = Some(0);
        self.best.copy_from_slice(centre);
        self.space.clamp(&mut self.best);
        self.distribution.start(&self.best, spread);
        self.best_fitness = f32::NEG_INFINITY;
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.iterations, "all {done} iterations of frame {} are done", self.frame);
        let dofs = self.space.dof_count();
        for range in generations(self.particles, self.generation) {
            self.draw(done, range.clone());
            let rows = &self.rows[range.start * dofs..range.end * dofs];
            fitness(rows, &mut self.fitness[range.clone()])?;
            let scores = &self.fitness;
            self.order.clear();
            self.order.extend(range.clone().filter(|&row| scores[row].is_finite()));
            // A stable sort: of equals the lower index stays first.
            self.order.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]));
            let Some(&first) = self.order.first() else { continue };
            if scores[first] > self.best_fitness {
                self.best_fitness = scores[first];
                self.best.copy_from_slice(&self.rows[first * dofs..(first + 1) * dofs]);
            }
            self.distribution.learn(range, &self.order);
        }
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let scored = self.done.unwrap_or(0) * self.particles;
        ensure!(scored > 0, "the search has scored no pose yet, so there is nothing to estimate");
        let is_finite = self.best_fitness.is_finite();
        ensure!(is_finite, "none of the {scored} poses of frame {} has a finite fitness", self.frame);
        let mut mean = vec![0.0; self.space.dof_count()];
        self.distribution.mean(&mut mean);
        let mut score = [f32::NAN];
        fitness(&mean, &mut score)?;
        let spread = self.distribution.deviation();
        let is_mean = score[0].is_finite() && score[0] >= self.best_fitness;
        let (pose, fitness) = if is_mean { (mean, score[0]) } else { (self.best.clone(), self.best_fitness) };
        Ok(Estimate { pose, fitness, spread, evaluations: scored + 1 })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::search::SearchSettings;

    pub(in super::super) fn sphere(x: &[f64]) -> f64 {
        x.iter().map(|x| x * x).sum()
    }

    pub(in super::super) fn ellipsoid(x: &[f64]) -> f64 {
        let n = x.len() as f64 - 1.0;
        x.iter().enumerate().map(|(i, x)| 10_f64.powf(4.0 * i as f64 / n) * x * x).sum()
    }

    pub(in super::super) fn rosenbrock(x: &[f64]) -> f64 {
        x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum()
    }

    /// The best of a function to be minimised, after so many iterations from (-1, 1.5, …) on.
    pub(in super::super) fn least(
        settings: &SearchSettings,
        dofs: usize,
        iterations: usize,
        function: &dyn Fn(&[f64]) -> f64,
    ) -> f64 {
        let space = SearchSpace::new(vec![-50.0; dofs], vec![50.0; dofs], vec![1.0; dofs]).unwrap();
        let mut search = SearchSettings { iterations, ..*settings }.build(&space).unwrap();
        let mut least = f64::INFINITY;
        let centre: Vec<f32> = (0..dofs).map(|d| if d % 2 == 0 { -1.0 } else { 1.5 }).collect();
        search
            .search_frame(0, &centre, &vec![1.0; dofs], &mut |rows, fitness| {
                for (row, fitness) in rows.chunks_exact(dofs).zip(fitness) {
                    let row: Vec<f64> = row.iter().map(|x| f64::from(*x)).collect();
                    let value = function(&row);
                    least = least.min(value);
                    // Only the order counts, and this one keeps it where a single's digits would end.
                    *fitness = -(value.max(1e-30).ln() as f32);
                }
                Ok(())
            })
            .unwrap();
        least
    }
}
