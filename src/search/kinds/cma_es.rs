//! CMA-ES: evolution of a normal distribution by the covariance of its successful samples (Hansen: "The CMA evolution
//! strategy: a tutorial", 2016). Written here because a frame's samples must be scored in batches, drawn from addressed
//! random numbers and held within limits, none of which the published crate does.

use anyhow::{Result, bail, ensure};
use serde::Serialize;
use toml::Table;

use super::form::{Budget, SearchForm};
use crate::files::table_of;
use crate::search::{Draw, Estimate, Fitness, Random, Search, SearchSpace, Stream, check_start};

/// Least pivot of the factorisation, relative to the first distribution's variance: below it a dimension stands still.
const LEAST_PIVOT: f64 = 1e-20;

/// Constants of the strategy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CmaSettings {
    /// First step size, in units of the frame's spread.
    #[serde(rename = "first_sigma")]
    pub sigma: f32,
    /// Samples of a generation, at least; an iteration has as many generations as its particles make. Fewer samples
    /// learn oftener, more are scored at once.
    pub generation: usize,
}

impl Default for CmaSettings {
    fn default() -> Self {
        Self { sigma: 0.7, generation: 50 }
    }
}

impl SearchForm for CmaSettings {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        Box::new(CmaEs::new(self, budget, space))
    }

    fn check(&self) -> Result<()> {
        ensure!((0.001..=10.0).contains(&self.sigma), "CMA-ES's sigma is {}, expected 0.001 to 10", self.sigma);
        let generation = self.generation;
        ensure!((4..=1 << 20).contains(&generation), "CMA-ES's generation is {generation}, expected 4 to 1048576");
        Ok(())
    }

    fn constants(&self) -> Result<Table> {
        table_of(self)
    }

    fn is_mean(&self) -> bool {
        true
    }
}

/// The strategy. It works in units of the frame's spread about the frame's centre, where the first distribution is
/// `sigma^2 I`. Samples are `m + sigma A z` with the Cholesky factor A of the covariance; the path of the step size is
/// whitened by A's inverse. A sample outside the limits is put on them before it is scored and counts as what it became.
/// The first sample is the centre. The estimate is the mean of the last distribution, scored as one more pose, or the best
/// sample where that is better.
pub struct CmaEs {
    name: &'static str,
    settings: CmaSettings,
    particles: usize,
    iterations: usize,
    random: Random,
    space: SearchSpace,
    frame: u32,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    centre: Vec<f32>,
    spread: Vec<f32>,
    distribution: Distribution,
    rows: Vec<f32>,
    fitness: Vec<f32>,
    /// The rows in units of the spread about the centre.
    samples: Vec<f64>,
    order: Vec<usize>,
    best: Vec<f32>,
    best_fitness: f32,
}

/// The distribution and its paths.
struct Distribution {
    mean: Vec<f64>,
    sigma: f64,
    covariance: Vec<f64>,
    /// Lower triangle with `factor factor' = covariance`.
    factor: Vec<f64>,
    path: Vec<f64>,
    sigma_path: Vec<f64>,
    generations: i32,
    /// The weights of a generation's better half.
    weights: Vec<f64>,
    step: Vec<f64>,
}

impl Distribution {
    fn new(dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            mean: zeros(),
            sigma: 1.0,
            covariance: vec![0.0; dofs * dofs],
            factor: vec![0.0; dofs * dofs],
            path: zeros(),
            sigma_path: zeros(),
            generations: 0,
            weights: Vec::new(),
            step: zeros(),
        }
    }

    fn reset(&mut self, sigma: f64) {
        let dofs = self.mean.len();
        for values in [&mut self.mean, &mut self.path, &mut self.sigma_path] {
            values.fill(0.0);
        }
        for matrix in [&mut self.covariance, &mut self.factor] {
            matrix.fill(0.0);
            matrix.iter_mut().step_by(dofs + 1).for_each(|diagonal| *diagonal = 1.0);
        }
        self.sigma = sigma;
        self.generations = 0;
    }

    /// The sample of normal numbers `z`.
    fn sample(&self, z: &[f32], sample: &mut [f64]) {
        let dofs = z.len();
        for (row, (sample, mean)) in sample.iter_mut().zip(&self.mean).enumerate() {
            let factor = &self.factor[row * dofs..=row * dofs + row];
            let sum: f64 = factor.iter().zip(z).map(|(a, z)| a * f64::from(*z)).sum();
            *sample = mean + self.sigma * sum;
        }
    }

    /// Learns from a generation of `count` samples, whose better ones are the rows `order` of `samples`, best first.
    fn learn(&mut self, samples: &[f64], order: &[usize], count: usize) {
        let dofs = self.mean.len();
        let parents = (count / 2).max(1).min(order.len());
        self.weights.clear();
        self.weights.extend((1..=parents).map(|rank| (0.5 * (count as f64 + 1.0)).ln() - (rank as f64).ln()));
        let total: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|weight| *weight /= total);
        let mass = 1.0 / self.weights.iter().map(|weight| weight * weight).sum::<f64>();
        let n = dofs as f64;
        let c_path = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n);
        let c_sigma = (mass + 2.0) / (n + mass + 5.0);
        let c_one = 2.0 / ((n + 1.3).powi(2) + mass);
        let c_rank = (1.0 - c_one).min(2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0).powi(2) + mass)).max(0.0);
        let damping = 1.0 + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let rows = || order.iter().map(|&row| &samples[row * dofs..(row + 1) * dofs]).zip(&self.weights);
        self.step.fill(0.0);
        for (row, weight) in rows() {
            for ((step, x), mean) in self.step.iter_mut().zip(row).zip(&self.mean) {
                *step += weight * (x - mean) / self.sigma;
            }
        }
        // Paths: the step whitened by A's inverse (forward substitution), and the step itself.
        let keep = (c_sigma * (2.0 - c_sigma) * mass).sqrt();
        let mut white = vec![0.0; dofs];
        for row in 0..dofs {
            let factor = &self.factor[row * dofs..(row + 1) * dofs];
            let known: f64 = factor[..row].iter().zip(&white).map(|(a, w)| a * w).sum();
            white[row] = (self.step[row] - known) / factor[row];
        }
        for (path, white) in self.sigma_path.iter_mut().zip(&white) {
            *path = (1.0 - c_sigma) * *path + keep * white;
        }
        self.generations += 1;
        let length = self.sigma_path.iter().map(|p| p * p).sum::<f64>().sqrt();
        let settled = (1.0 - (1.0 - c_sigma).powi(2 * self.generations)).sqrt();
        let is_moving = length / settled < (1.4 + 2.0 / (n + 1.0)) * expected;
        let gain = if is_moving { (c_path * (2.0 - c_path) * mass).sqrt() } else { 0.0 };
        for (path, step) in self.path.iter_mut().zip(&self.step) {
            *path = (1.0 - c_path) * *path + gain * step;
        }
        let lost = if is_moving { 0.0 } else { c_one * c_path * (2.0 - c_path) };
        for row in 0..dofs {
            for column in 0..=row {
                let samples =
                    rows().map(|(x, weight)| weight * (x[row] - self.mean[row]) * (x[column] - self.mean[column]));
                let rank = samples.sum::<f64>() / (self.sigma * self.sigma);
                let place = &mut self.covariance[row * dofs + column];
                *place =
                    (1.0 - c_one - c_rank + lost) * *place + c_one * self.path[row] * self.path[column] + c_rank * rank;
            }
        }
        for (mean, step) in self.mean.iter_mut().zip(&self.step) {
            *mean += self.sigma * step;
        }
        self.sigma *= ((c_sigma / damping) * (length / expected - 1.0)).min(1.0).exp();
        self.factorise();
    }

    /// Cholesky's factor of the covariance.
    fn factorise(&mut self) {
        let dofs = self.mean.len();
        for row in 0..dofs {
            for column in 0..=row {
                let (a, b) = (&self.factor[row * dofs..], &self.factor[column * dofs..]);
                let known: f64 = a[..column].iter().zip(&b[..column]).map(|(a, b)| a * b).sum();
                let left = self.covariance[row * dofs + column] - known;
                self.factor[row * dofs + column] = if row == column {
                    left.max(LEAST_PIVOT).sqrt()
                } else {
                    left / self.factor[column * dofs + column]
                };
            }
        }
    }
}

impl CmaEs {
    /// A search from checked settings.
    fn new(settings: &CmaSettings, budget: &Budget, space: &SearchSpace) -> Self {
        let (count, dofs) = (budget.particles, space.dof_count());
        Self {
            name: budget.name,
            settings: *settings,
            particles: count,
            iterations: budget.iterations,
            random: Random::new(budget.seed),
            space: space.clone(),
            frame: 0,
            done: None,
            centre: vec![0.0; dofs],
            spread: vec![0.0; dofs],
            distribution: Distribution::new(dofs),
            rows: vec![0.0; count * dofs],
            fitness: vec![f32::NAN; count],
            samples: vec![0.0; count * dofs],
            order: Vec::with_capacity(count),
            best: vec![0.0; dofs],
            best_fitness: f32::NEG_INFINITY,
        }
    }

    /// Draws the samples `range` of iteration `iteration`.
    fn draw(&mut self, iteration: usize, range: std::ops::Range<usize>) {
        let dofs = self.space.dof_count();
        let mut normals = vec![0.0; dofs];
        for particle in range {
            let place = particle * dofs..(particle + 1) * dofs;
            let (row, sample) = (&mut self.rows[place.clone()], &mut self.samples[place]);
            if (iteration, particle) == (0, 0) {
                row.copy_from_slice(&self.centre);
            } else {
                let stream = Stream {
                    frame: self.frame,
                    iteration: iteration as u32,
                    particle: particle as u32,
                    draw: Draw::Scatter,
                };
                self.random.normals(stream, &mut normals);
                self.distribution.sample(&normals, sample);
                self.space.place(&self.centre, &self.spread, sample, row);
            }
            self.space.clamp(row);
            for (d, sample) in sample.iter_mut().enumerate() {
                let off = f64::from(row[d]) - f64::from(self.centre[d]);
                *sample = if self.spread[d] > 0.0 { off / f64::from(self.spread[d]) } else { 0.0 };
            }
        }
    }
}

impl Search for CmaEs {
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
        self.centre.copy_from_slice(centre);
        self.space.clamp(&mut self.centre);
        self.spread.copy_from_slice(spread);
        self.distribution.reset(f64::from(self.settings.sigma));
        self.best.copy_from_slice(&self.centre);
        self.best_fitness = f32::NEG_INFINITY;
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.iterations, "all {done} iterations of frame {} are done", self.frame);
        let dofs = self.space.dof_count();
        let generations = (self.particles / self.settings.generation).max(1);
        for generation in 0..generations {
            let range = generation * self.particles / generations..(generation + 1) * self.particles / generations;
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
            self.distribution.learn(&self.samples, &self.order, range.len());
        }
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let scored = self.done.unwrap_or(0) * self.particles;
        ensure!(scored > 0, "the search has scored no pose yet, so there is nothing to estimate");
        let is_finite = self.best_fitness.is_finite();
        ensure!(is_finite, "none of the {scored} poses of frame {} has a finite fitness", self.frame);
        let dofs = self.space.dof_count();
        let mut mean = vec![0.0; dofs];
        self.space.place(&self.centre, &self.spread, &self.distribution.mean, &mut mean);
        self.space.clamp(&mut mean);
        let mut score = [f32::NAN];
        fitness(&mean, &mut score)?;
        let variances = self.distribution.covariance.iter().step_by(dofs + 1);
        let deviations = variances.map(|variance| self.distribution.sigma * variance.sqrt());
        let spread = deviations.zip(&self.spread).map(|(deviation, spread)| deviation as f32 * spread).collect();
        let is_mean = score[0].is_finite() && score[0] >= self.best_fitness;
        let (pose, fitness) = if is_mean { (mean, score[0]) } else { (self.best.clone(), self.best_fitness) };
        Ok(Estimate { pose, fitness, spread, evaluations: scored + 1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::{SearchKind, SearchSettings};

    /// The best of a function to be minimised, after so many generations of 20 samples from (1, 1, …) on.
    fn least(dofs: usize, iterations: usize, function: &dyn Fn(&[f64]) -> f64) -> f64 {
        let space = SearchSpace::new(vec![-50.0; dofs], vec![50.0; dofs], vec![1.0; dofs]).unwrap();
        let cma = CmaSettings { sigma: 0.5, generation: 20 };
        let settings = SearchSettings { kind: SearchKind::CmaEs, particles: 20, iterations, cma, ..Default::default() };
        let mut search = settings.build(&space).unwrap();
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

    #[test]
    fn sphere_ellipsoid_and_rosenbrock() {
        let sphere = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let ellipsoid = |x: &[f64]| {
            let n = x.len() as f64 - 1.0;
            x.iter().enumerate().map(|(i, x)| 10_f64.powf(4.0 * i as f64 / n) * x * x).sum::<f64>()
        };
        let rosenbrock =
            |x: &[f64]| x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum::<f64>();
        let found = [least(10, 150, &sphere), least(10, 400, &ellipsoid), least(6, 400, &rosenbrock)];
        assert!(found.iter().all(|value| *value < 1e-8), "{found:?}");
        // What it cannot do so soon: the bounds above are able to fail.
        assert!(least(10, 20, &ellipsoid) > 1e-3);
    }
}
