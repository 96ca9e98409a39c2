//! The weights of a filter's particles: from their fitness, as shares of the largest, and resampling by them.

use anyhow::{Result, bail, ensure};

use super::arithmetic::Statistics;
use super::shaders::{ANNEAL_LANES, HALVINGS, LEAST_SHARPNESS, MOST_SHARPNESS};
use super::{Estimate, Fitness, Random, SearchSpace, Stream};
use crate::arithmetic::exp_of_negative;

/// What a share of 1 counts in the integer sums that resampling goes by.
const WHOLE: f32 = 2_147_483_648.0;

/// Weights of particles, `w = exp(-sharpness (1 - f)^2)` of a fitness f as shares of the largest.
pub(super) struct Weights {
    /// Weights as shares of the largest.
    shares: Vec<f32>,
    /// Sums of the shares up to and with each particle, 2^-31.
    cumulated: Vec<u64>,
}

impl Weights {
    pub(super) fn new(count: usize) -> Self {
        Self { shares: vec![0.0; count], cumulated: vec![0; count] }
    }

    /// Sets the weights from the fitness of the first particles; those that were not scored get none. The common factor of
    /// the formula cancels, and so does the largest one's exponent, which keeps the others from vanishing together. Yields
    /// the particle with the largest, none where no fitness is finite.
    pub(super) fn weigh(&mut self, fitness: &[f32], sharpness: f32) -> Option<usize> {
        let nearest = nearest(fitness)?;
        let largest = fitness[nearest];
        self.shares.fill(0.0);
        for (share, &fitness) in self.shares.iter_mut().zip(fitness) {
            *share = share_of(fitness, largest, sharpness);
        }
        self.cumulate();
        Some(nearest)
    }

    fn cumulate(&mut self) {
        let mut sum = 0;
        for (share, cumulated) in self.shares.iter().zip(&mut self.cumulated) {
            sum += u64::from((share * WHOLE) as u32);
            *cumulated = sum;
        }
    }

    /// The sharpness, no less than `least`, that leaves `survival` of the particles with a finite fitness: their effective
    /// number `(sum w)^2 / sum w^2` falls as the sharpness rises, so it is halved in on, by bit patterns, whose order is that
    /// of the numbers.
    pub(super) fn sharpness_for(fitness: &[f32], survival: f32, least: f32) -> f32 {
        let Some(nearest) = nearest(fitness) else { return least };
        let largest = fitness[nearest];
        let wanted = survival * fitness.iter().filter(|fitness| fitness.is_finite()).count() as f32;
        let [mut low, mut high] = [LEAST_SHARPNESS, MOST_SHARPNESS];
        for _ in 0..HALVINGS {
            let middle = low + (high - low) / 2;
            let [sum, squares] = sums_of_shares(fitness, largest, f32::from_bits(middle));
            // The largest share is 1, so neither sum is 0.
            if sum * sum > wanted * squares {
                low = middle;
            } else {
                high = middle;
            }
        }
        f32::from_bits(low).max(least)
    }

    /// Fills `resampled` with copies of particles in proportion to their weights: systematically, by one random offset and
    /// equal strides.
    pub(super) fn resample(&self, random: Random, stream: Stream, particles: &[f32], resampled: &mut [f32]) {
        let count = self.cumulated.len() as u64;
        let dofs = particles.len() / self.cumulated.len();
        let stride = self.cumulated[self.cumulated.len() - 1] / count;
        // At most 2^31, a weight's mean, times a fraction of 2^32; less than a stride, so no pointer reaches the sum of all.
        let offset = (stride * u64::from(random.first_word(stream))) >> 32;
        let mut chosen = 0;
        for (index, row) in resampled.chunks_exact_mut(dofs).enumerate() {
            let pointer = index as u64 * stride + offset;
            while self.cumulated[chosen] <= pointer {
                chosen += 1;
            }
            row.copy_from_slice(&particles[chosen * dofs..(chosen + 1) * dofs]);
        }
    }

    /// The weighted mean of the particles, about the one with the largest weight, as [`Self::weigh`] gave it; scored as one pose more
    /// than the `scored` ones of the frame.
    ///
    /// # Errors
    /// When no particle, or the mean, has a finite fitness, or the scoring fails.
    pub(super) fn estimate(
        &self,
        particles: &[f32],
        nearest: Option<usize>,
        space: &SearchSpace,
        (frame, scored): (u32, usize),
        fitness: &mut Fitness<'_>,
    ) -> Result<Estimate> {
        let Some(nearest) = nearest else { bail!("none of the {scored} poses of frame {frame} has a finite fitness") };
        let dofs = space.dof_count();
        let reference = &particles[nearest * dofs..(nearest + 1) * dofs];
        let Statistics { mean: mut pose, deviation: spread } = Statistics::of(particles, &self.shares, reference);
        space.clamp(&mut pose);
        let mut score = [f32::NAN];
        fitness(&pose, &mut score)?;
        ensure!(score[0].is_finite(), "the estimate of frame {frame} has a fitness of {}", score[0]);
        Ok(Estimate { pose, fitness: score[0], spread, evaluations: scored + 1 })
    }
}

/// The particle whose fitness is nearest to 1, the first of equals; none where no fitness is finite.
fn nearest(fitness: &[f32]) -> Option<usize> {
    let mut nearest = None;
    for (index, fitness) in fitness.iter().enumerate().filter(|(_, fitness)| fitness.is_finite()) {
        let distance = (1.0 - fitness).abs();
        if nearest.is_none_or(|(_, least)| distance < least) {
            nearest = Some((index, distance));
        }
    }
    nearest.map(|(index, _)| index)
}

/// The sum of all shares and of their squares, in as many running sums as a workgroup has invocations for them; these are
/// added upper half to lower half.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn sums_of_shares(fitness: &[f32], largest: f32, sharpness: f32) -> [f32; 2] {
    const LANES: usize = ANNEAL_LANES as usize;
    let (mut sums, mut squares) = ([0.0_f32; LANES], [0.0_f32; LANES]);
    let mut add = |row: &[f32; LANES]| {
        for ((sum, squares), &fitness) in sums.iter_mut().zip(&mut squares).zip(row) {
            let share = share_of(fitness, largest, sharpness);
            *sum += share;
            *squares += share * share;
        }
    };
    let (rows, rest) = fitness.as_chunks::<LANES>();
    rows.iter().for_each(&mut add);
    let mut last = [f32::NAN; LANES];
    last[..rest.len()].copy_from_slice(rest);
    add(&last);
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            sums[lane] += sums[lane + half];
            squares[lane] += squares[lane + half];
        }
        half /= 2;
    }
    [sums[0], squares[0]]
}

/// The weight of `fitness` as a share of that of `largest`; none of what is not a finite number.
#[inline(always)]
fn share_of(fitness: f32, largest: f32, sharpness: f32) -> f32 {
    if !fitness.is_finite() {
        return 0.0;
    }
    // (1 - f)^2 less the same of the largest, without the digits that a difference of squares loses.
    let exponent = (fitness - largest) * (2.0 - fitness - largest) * sharpness;
    exp_of_negative(if exponent > 0.0 { 0.0 } else { exponent })
}

#[cfg(test)]
mod tests {
    use super::super::{Draw, FilterSettings};
    use super::*;

    #[test]
    fn systematic_resampling_is_proportional() {
        let shares = [0.0, 0.3, 0.05, 0.0, 0.4, 0.125, 0.125, 0.0];
        let mut weights = Weights::new(8);
        weights.shares.copy_from_slice(&shares.map(|share| (share / 0.4) as f32));
        weights.cumulate();
        let particles: Vec<f32> = (0..8).map(|index| index as f32).collect();
        for frame in 0..200 {
            let mut resampled = vec![f32::NAN; 8];
            let stream = Stream { frame, iteration: 0, particle: 0, draw: Draw::Resampling };
            weights.resample(Random::new(1), stream, &particles, &mut resampled);
            for (index, share) in shares.iter().enumerate() {
                let copies = resampled.iter().filter(|particle| **particle == index as f32).count() as f64;
                let expected = share * 8.0;
                assert!((copies - expected).abs() < 1.0, "frame {frame}, particle {index}: {copies} for {expected}");
            }
        }
    }

    #[test]
    fn weights_follow_the_formula() {
        let settings = FilterSettings::default();
        let mut weights = Weights::new(5);
        assert_eq!(weights.weigh(&[0.9, 0.85, f32::NAN, 0.7, 0.0], settings.sharpness()), Some(0));
        let sigma = f64::from(settings.sigma);
        let formula = |f: f32| {
            (-(1.0 - f64::from(f)).powi(2) / (2.0 * sigma * sigma)).exp() / (sigma * std::f64::consts::TAU.sqrt())
        };
        let plain = [formula(0.9), formula(0.85), 0.0, formula(0.7), formula(0.0)];
        for (index, (share, plain)) in weights.shares.iter().zip(plain).enumerate() {
            assert!((f64::from(*share) - plain / formula(0.9)).abs() < 1e-6, "{share} for {}", plain / formula(0.9));
            let before = if index == 0 { 0 } else { weights.cumulated[index - 1] };
            let weight = (weights.cumulated[index] - before) as f64 / f64::from(WHOLE);
            assert!((weight - f64::from(*share)).abs() < 1e-9);
        }
        // Fitness so low that the plain formula would give 0 / 0.
        let sharpness = FilterSettings { sigma: 1e-4 }.sharpness();
        assert_eq!(weights.weigh(&[0.1, 0.1, f32::NAN, 0.0, 0.0], sharpness), Some(0));
        assert_eq!(weights.shares, [1.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(weights.weigh(&[f32::NAN, f32::INFINITY], 1.0), None);
    }

    #[test]
    fn the_sharpness_leaves_the_wanted_share() {
        let fitness: Vec<f32> = (0..300).map(|index| 0.3 + 0.4 * (index as f32 * 0.61).sin().abs()).collect();
        for survival in [0.2, 0.5, 0.9] {
            let sharpness = Weights::sharpness_for(&fitness, survival, 0.0);
            let mut weights = Weights::new(300);
            weights.weigh(&fitness, sharpness);
            let sum = |power| weights.shares.iter().map(|share| f64::from(*share).powi(power)).sum::<f64>();
            let left = sum(1).powi(2) / sum(2) / 300.0;
            assert!((left - f64::from(survival)).abs() < 1e-2, "{left} for {survival}");
            assert_eq!(Weights::sharpness_for(&fitness, survival, 1e9), 1e9, "it never falls");
        }
        assert_eq!(Weights::sharpness_for(&[f32::NAN], 0.5, 3.0), 3.0);
    }
}
