//! MA-ES: evolution of a normal distribution by the matrix that makes its samples (Beyer and Sendhoff: "Simplify your covariance
//! matrix adaptation evolution strategy", 2017). It is CMA-ES without a covariance: nothing is factorised or inverted, there are
//! products alone, in single precision and in one order, so that a device does the same to the bit.

use std::ops::Range;

use anyhow::{Result, ensure};
use serde::Serialize;

use super::evolution::{Distribution, Evolution, generations};
use super::form::{Answer, Budget, SearchForm};
use crate::arithmetic::{exp_of_negative, reciprocal, root};
use crate::search::arithmetic::sum_of_squares;
use crate::search::device::DeviceForm;
use crate::search::shaders::{LEAST_SIGMA, MOST_SIGMA};
use crate::search::{Search, SearchSpace};

/// Constants of the strategy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MatrixSettings {
    /// First step size, in units of the frame's spread.
    #[serde(rename = "first_sigma")]
    pub sigma: f32,
    /// Samples of a generation, at least; an iteration has as many generations as its particles make.
    pub generation: usize,
}

impl Default for MatrixSettings {
    fn default() -> Self {
        Self { sigma: 0.7, generation: 50 }
    }
}

impl SearchForm for MatrixSettings {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        let matrix = MatrixNormal::new(self, budget.particles, space);
        Box::new(Evolution::new(self.generation, budget, space, matrix))
    }

    fn check(&self) -> Result<()> {
        ensure!((0.001..=10.0).contains(&self.sigma), "MA-ES's sigma is {}, expected 0.001 to 10", self.sigma);
        let generation = self.generation;
        ensure!((4..=1 << 20).contains(&generation), "MA-ES's generation is {generation}, expected 4 to 1048576");
        Ok(())
    }

    fn answer(&self) -> Answer {
        Answer::Better
    }

    fn on_device(&self) -> Option<&dyn DeviceForm> {
        Some(self)
    }
}

/// How fast a distribution of `dofs` values learns from generations of `count` samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rates {
    /// Of the samples of a generation, best first; their sum is 1. The others have none.
    pub(crate) weights: Vec<f32>,
    /// What the path keeps of itself, and what it takes of a generation's step.
    pub(crate) path: [f32; 2],
    /// What the matrix keeps of itself, takes of the path, and of the samples.
    pub(crate) matrix: [f32; 3],
    /// Factors of the change of the step size: of the path's length, and what is taken off that.
    pub(crate) sigma: [f32; 2],
}

impl Rates {
    /// Beyer and Sendhoff's, with logarithmic weights.
    pub(crate) fn new(dofs: usize, count: usize) -> Self {
        let parents = (count / 2).max(1);
        let raw = |rank: usize| (0.5 * (count as f64 + 1.0)).ln() - (rank as f64).ln();
        let total: f64 = (1..=parents).map(raw).sum();
        // A generation of one sample has no better half.
        let weight = |rank: usize| if total > 0.0 { raw(rank) / total } else { 1.0 };
        let mass = 1.0 / (1..=parents).map(|rank| weight(rank).powi(2)).sum::<f64>();
        let n = dofs as f64;
        let c_path = (mass + 2.0) / (n + mass + 5.0);
        let c_one = 2.0 / ((n + 1.3).powi(2) + mass);
        let c_rank = (1.0 - c_one).min(2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0).powi(2) + mass)).max(0.0);
        let damping = 1.0 + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_path;
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self {
            weights: (1..=parents).map(|rank| weight(rank) as f32).collect(),
            path: [(1.0 - c_path) as f32, (c_path * (2.0 - c_path) * mass).sqrt() as f32],
            matrix: [(1.0 - 0.5 * (c_one + c_rank)) as f32, (0.5 * c_one) as f32, (0.5 * c_rank) as f32],
            sigma: [(c_path / damping / expected) as f32, (c_path / damping) as f32],
        }
    }
}

/// A normal distribution by the matrix M that turns normal numbers z into its samples `m + sigma M z`. It works in units of the
/// frame's spread about the frame's centre, where the first distribution is `sigma^2 I`. A sample outside the limits is put on
/// them before it is scored, and its step counts as what it became, its normal numbers as they were.
struct MatrixNormal {
    first_sigma: f32,
    space: SearchSpace,
    centre: Vec<f32>,
    spread: Vec<f32>,
    /// Limits in units of the spread about the centre.
    limits: [Vec<f32>; 2],
    mean: Vec<f32>,
    sigma: f32,
    /// Column after column, so that rows are a vector's lanes.
    matrix: Vec<f32>,
    path: Vec<f32>,
    /// Rows of the samples' normal numbers.
    normals: Vec<f32>,
    /// Rows of their steps off the mean over sigma.
    steps: Vec<f32>,
    /// Weights of the samples.
    weights: Vec<f32>,
    /// By the number of samples of a generation.
    rates: Vec<(usize, Rates)>,
    /// What is summed up in a row.
    sums: [Vec<f32>; 2],
}

impl MatrixNormal {
    fn new(settings: &MatrixSettings, particles: usize, space: &SearchSpace) -> Self {
        let dofs = space.dof_count();
        let zeros = || vec![0.0; dofs];
        let mut rates: Vec<(usize, Rates)> = Vec::new();
        for range in generations(particles, settings.generation) {
            if rates.iter().all(|(known, _)| *known != range.len()) {
                rates.push((range.len(), Rates::new(dofs, range.len())));
            }
        }
        Self {
            first_sigma: settings.sigma,
            space: space.clone(),
            centre: zeros(),
            spread: zeros(),
            limits: [zeros(), zeros()],
            mean: zeros(),
            sigma: settings.sigma,
            matrix: vec![0.0; dofs * dofs],
            path: zeros(),
            normals: vec![0.0; particles * dofs],
            steps: vec![0.0; particles * dofs],
            weights: vec![0.0; particles],
            rates,
            sums: [zeros(), zeros()],
        }
    }

    /// The pose's value at `offset` spreads off the centre; not held within the limits.
    fn pose_at(&self, d: usize, offset: f32) -> f32 {
        self.centre[d] + self.spread[d] * offset
    }
}

impl Distribution for MatrixNormal {
    fn start(&mut self, centre: &[f32], spread: &[f32]) {
        self.centre.copy_from_slice(centre);
        self.spread.copy_from_slice(spread);
        for (bounds, limits) in [self.space.lower(), self.space.upper()].into_iter().zip(&mut self.limits) {
            for (d, limit) in limits.iter_mut().enumerate() {
                let off = bounds[d] - centre[d];
                *limit = if spread[d] > 0.0 { off * reciprocal(spread[d]) } else { 0.0 };
            }
        }
        self.mean.fill(0.0);
        self.path.fill(0.0);
        self.matrix.fill(0.0);
        self.matrix.iter_mut().step_by(centre.len() + 1).for_each(|diagonal| *diagonal = 1.0);
        self.sigma = self.first_sigma;
    }

    fn draw(&mut self, index: usize, normals: Option<&[f32]>, row: &mut [f32]) {
        let dofs = row.len();
        let place = index * dofs;
        let z = &mut self.normals[place..place + dofs];
        match normals {
            Some(normals) => z.copy_from_slice(normals),
            None => z.fill(0.0),
        }
        turn(&self.matrix, z, &mut self.steps[place..place + dofs]);
        let inverse = reciprocal(self.sigma);
        for (d, value) in row.iter_mut().enumerate() {
            let free = self.mean[d] + self.sigma * self.steps[place + d];
            let held = free.max(self.limits[0][d]).min(self.limits[1][d]);
            if held != free {
                self.steps[place + d] = (held - self.mean[d]) * inverse;
            }
            *value = self.pose_at(d, held);
        }
        self.space.clamp(row);
    }

    fn learn(&mut self, range: Range<usize>, order: &[usize]) {
        let dofs = self.mean.len();
        let Some((_, rates)) = self.rates.iter().find(|(count, _)| *count == range.len()) else { return };
        // Sums go over the samples as they were drawn, so that a device need not sort them.
        let weights = &mut self.weights[range.clone()];
        weights.fill(0.0);
        for (sample, weight) in order.iter().zip(&rates.weights) {
            weights[sample - range.start] = *weight;
        }
        let rows = range.start * dofs..range.end * dofs;
        let (normals, steps) = (&self.normals[rows.clone()], &self.steps[rows]);
        let [normal, step] = &mut self.sums;
        normal.fill(0.0);
        step.fill(0.0);
        let samples = normals.chunks_exact(dofs).zip(steps.chunks_exact(dofs)).zip(&*weights);
        for ((z, d), weight) in samples.filter(|(_, weight)| **weight != 0.0) {
            add_scaled(normal, z, *weight);
            add_scaled(step, d, *weight);
        }
        for (path, normal) in self.path.iter_mut().zip(&*normal) {
            *path = rates.path[0] * *path + rates.path[1] * normal;
        }
        let limits = self.limits[0].iter().zip(&self.limits[1]);
        for ((mean, step), (low, high)) in self.mean.iter_mut().zip(&*step).zip(limits) {
            *mean = (*mean + self.sigma * step).max(*low).min(*high);
        }
        let [turned, sum] = &mut self.sums;
        turn(&self.matrix, &self.path, turned);
        learn_matrix(&mut self.matrix, rates, &self.path, turned, [normals, steps, weights], sum);
        let [gain, loss] = rates.sigma;
        let change = (gain * root(sum_of_squares(&self.path)) - loss).min(1.0);
        let factor = if change > 0.0 { reciprocal(exp_of_negative(-change)) } else { exp_of_negative(change) };
        self.sigma = (self.sigma * factor).max(f32::from_bits(LEAST_SIGMA)).min(f32::from_bits(MOST_SIGMA));
    }

    fn mean(&self, row: &mut [f32]) {
        for (d, value) in row.iter_mut().enumerate() {
            *value = self.pose_at(d, self.mean[d]);
        }
        self.space.clamp(row);
    }

    fn deviation(&self) -> Vec<f32> {
        let dofs = self.mean.len();
        let mut squares = vec![0.0_f32; dofs];
        for column in self.matrix.chunks_exact(dofs) {
            for (square, entry) in squares.iter_mut().zip(column) {
                *square += entry * entry;
            }
        }
        squares.iter().zip(&self.spread).map(|(square, spread)| self.sigma * root(*square) * spread).collect()
    }
}

fn add_scaled(sums: &mut [f32], row: &[f32], factor: f32) {
    for (sum, value) in sums.iter_mut().zip(row) {
        *sum += value * factor;
    }
}

/// The product of the matrix and a vector, each row's sum in the order of the columns. Compiled for several instruction sets with
/// the same results.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn turn(matrix: &[f32], vector: &[f32], product: &mut [f32]) {
    product.fill(0.0);
    for (&value, column) in vector.iter().zip(matrix.chunks_exact(product.len())) {
        for (sum, entry) in product.iter_mut().zip(column) {
            *sum += entry * value;
        }
    }
}

/// `M <- (1 - (c1 + cw) / 2) M + c1/2 (M s) s' + cw/2 sum w d z'` with the path s and the samples' normal numbers z, steps d and
/// weights w.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn learn_matrix(
    matrix: &mut [f32],
    rates: &Rates,
    path: &[f32],
    turned: &[f32],
    [normals, steps, weights]: [&[f32]; 3],
    sum: &mut [f32],
) {
    let dofs = path.len();
    let [kept, of_path, of_samples] = rates.matrix;
    for (d, column) in matrix.chunks_exact_mut(dofs).enumerate() {
        sum.fill(0.0);
        let samples = normals.chunks_exact(dofs).zip(steps.chunks_exact(dofs)).zip(weights);
        for ((z, step), weight) in samples.filter(|(_, weight)| **weight != 0.0) {
            let normal = weight * z[d];
            for (sum, step) in sum.iter_mut().zip(step) {
                *sum += step * normal;
            }
        }
        for ((entry, turned), sum) in column.iter_mut().zip(turned).zip(&*sum) {
            *entry = kept * *entry + of_path * (turned * path[d]) + of_samples * sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::evolution::tests::{ellipsoid, least, rosenbrock, sphere};
    use super::*;
    use crate::search::{SearchKind, SearchSettings};

    #[test]
    fn sphere_ellipsoid_and_rosenbrock() {
        let matrix = MatrixSettings { sigma: 0.5, generation: 20 };
        let settings = SearchSettings { kind: SearchKind::MaEs, particles: 20, matrix, ..Default::default() };
        let least = |dofs, iterations, function: &dyn Fn(&[f64]) -> f64| least(&settings, dofs, iterations, function);
        let found = [least(10, 150, &sphere), least(10, 500, &ellipsoid), least(6, 500, &rosenbrock)];
        assert!(found.iter().all(|value| *value < 1e-8), "{found:?}");
        // What it cannot do so soon: the bounds above are able to fail.
        assert!(least(10, 20, &ellipsoid) > 1e-3);
    }

    #[test]
    fn weights_and_rates_are_the_published_ones() {
        let rates = Rates::new(31, 50);
        assert_eq!(rates.weights.len(), 25);
        assert!((rates.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!(rates.weights.windows(2).all(|pair| pair[0] > pair[1]));
        let mass = 1.0 / rates.weights.iter().map(|weight| f64::from(*weight).powi(2)).sum::<f64>();
        // (mass + 2) / (31 + mass + 5), 2 / (32.3^2 + mass), 2 (mass - 2 + 1 / mass) / (33^2 + mass), halved.
        let expected =
            [1.0 - (mass + 2.0) / (36.0 + mass), 1.0 / (1043.29 + mass), (mass - 2.0 + 1.0 / mass) / (1089.0 + mass)];
        for (found, expected) in [rates.path[0], rates.matrix[1], rates.matrix[2]].into_iter().zip(expected) {
            assert!((f64::from(found) - expected).abs() < 1e-6, "{found} for {expected}");
        }
        // A path as long as chance makes it leaves the step size as it is.
        let expected = 31_f64.sqrt() * (1.0 - 1.0 / 124.0 + 1.0 / 20_181.0);
        assert!((f64::from(rates.sigma[1] / rates.sigma[0]) - expected).abs() < 1e-4);
        assert_eq!(Rates::new(3, 1).weights, [1.0]);
    }
}
