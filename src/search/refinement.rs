//! Local refinement of a search's winner: a pattern search that looks both ways along every dimension and follows a
//! separable parabola, in batches.

use anyhow::Result;

use super::{Estimate, Fitness, Search, SearchSpace};

/// Step of the first round, in units of the frame's spread.
const FIRST_STEP: f32 = 0.25;
/// Factor on the step after a round that found nothing better.
const SHRINK: f32 = 0.5;
/// Shares of the way to the parabola's top that are tried: dimensions are not independent, so all of it may be too far.
const REACHES: [f32; 3] = [1.0, 0.5, 0.25];

/// Refines poses with a fixed number of evaluations.
#[derive(Clone, Debug)]
pub struct Refinement {
    evaluations: usize,
    space: SearchSpace,
}

impl Refinement {
    /// With so many evaluations a pose.
    pub fn new(evaluations: usize, space: &SearchSpace) -> Self {
        Self { evaluations, space: space.clone() }
    }

    /// Improves an estimate, `spread` being that of its frame. A round scores a step of both signs along each dimension that
    /// has a spread, then up to three steps towards the top of the parabolas through these, and goes to the best if that
    /// is better; else steps shrink. The last round takes as many dimensions as evaluations are left. The estimate never
    /// gets worse, keeps the limits, and its evaluations are counted.
    ///
    /// # Errors
    /// When `fitness` fails.
    pub fn improve(&self, estimate: &mut Estimate, spread: &[f32], fitness: &mut Fitness<'_>) -> Result<()> {
        let dofs = self.space.dof_count();
        let moved: Vec<usize> = (0..dofs).filter(|&d| spread[d] > 0.0).collect();
        let mut left = if moved.is_empty() { 0 } else { self.evaluations };
        estimate.evaluations += left;
        let mut size = FIRST_STEP;
        let mut turn = 0;
        while left > 0 {
            let count = moved.len().min(left.saturating_sub(REACHES.len()).div_ceil(2).max(1)).min(left.div_ceil(2));
            let tried: Vec<usize> = (0..count).map(|at| moved[(turn + at) % moved.len()]).collect();
            turn = (turn + count) % moved.len();
            let mut rows = Vec::with_capacity(2 * count * dofs);
            for &d in &tried {
                for sign in [1.0, -1.0] {
                    rows.extend_from_slice(&estimate.pose);
                    let place = rows.len() - dofs + d;
                    rows[place] += sign * size * spread[d];
                }
            }
            rows.truncate(left.min(2 * count) * dofs);
            let (scores, mut is_better) = self.score(&mut rows, estimate.fitness, fitness)?;
            left -= scores.len();
            let mut best =
                is_better.take().map(|index| (scores[index], rows[index * dofs..(index + 1) * dofs].to_vec()));

            let tops: Vec<f32> = scores.chunks_exact(2).map(|both| top(estimate.fitness, both[0], both[1])).collect();
            let reaches = &REACHES[..REACHES.len().min(left)];
            let mut rows = Vec::with_capacity(reaches.len() * dofs);
            for reach in reaches {
                rows.extend_from_slice(&estimate.pose);
                let row = rows.len() - dofs;
                for (&d, top) in tried.iter().zip(&tops) {
                    rows[row + d] += reach * top * size * spread[d];
                }
            }
            let bar = best.as_ref().map_or(estimate.fitness, |(fitness, _)| *fitness);
            let (scores, is_better) = self.score(&mut rows, bar, fitness)?;
            left -= scores.len();
            if let Some(index) = is_better {
                best = Some((scores[index], rows[index * dofs..(index + 1) * dofs].to_vec()));
            }
            match best {
                Some((fitness, pose)) => (estimate.fitness, estimate.pose) = (fitness, pose),
                None => size *= SHRINK,
            }
        }
        Ok(())
    }

    /// Scores rows, held within the limits; and the first of the best that are better than `bar`.
    fn score(&self, rows: &mut [f32], bar: f32, fitness: &mut Fitness<'_>) -> Result<(Vec<f32>, Option<usize>)> {
        let dofs = self.space.dof_count();
        rows.chunks_exact_mut(dofs).for_each(|row| self.space.clamp(row));
        let mut scores = vec![f32::NAN; rows.len() / dofs];
        if !scores.is_empty() {
            fitness(rows, &mut scores)?;
        }
        let mut best = None;
        let mut most = bar;
        for (index, &score) in scores.iter().enumerate() {
            if score.is_finite() && score > most {
                (best, most) = (Some(index), score);
            }
        }
        Ok((scores, best))
    }
}

/// Where the parabola through `left` at -1, `middle` at 0 and `right` at 1 is highest, within [-1, 1].
fn top(middle: f32, right: f32, left: f32) -> f32 {
    let curvature = right + left - 2.0 * middle;
    let slope = 0.5 * (right - left);
    if !(curvature.is_finite() && slope.is_finite()) || slope == 0.0 {
        0.0
    } else if curvature < 0.0 {
        (-slope / curvature).clamp(-1.0, 1.0)
    } else {
        slope.signum()
    }
}

/// A search whose winner is refined.
pub(super) struct Refined {
    inner: Box<dyn Search>,
    refinement: Refinement,
    spread: Vec<f32>,
    /// What the search inside estimated last, and what became of it: a filter goes on from its own estimate alone.
    estimated: [Vec<f32>; 2],
}

impl Refined {
    pub(super) fn new(inner: Box<dyn Search>, refinement: Refinement) -> Self {
        Self { inner, refinement, spread: Vec::new(), estimated: [Vec::new(), Vec::new()] }
    }
}

impl Search for Refined {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn iterations(&self) -> usize {
        self.inner.iterations()
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        let [before, after] = &self.estimated;
        let centre = if after == centre { before } else { centre };
        self.inner.start_frame(frame, centre, spread)?;
        self.spread = spread.to_vec();
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        self.inner.iterate(fitness)
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        let mut estimate = self.inner.estimate(fitness)?;
        let before = estimate.pose.clone();
        self.refinement.improve(&mut estimate, &self.spread, fitness)?;
        self.estimated = [before, estimate.pose.clone()];
        Ok(estimate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coupled_hill_is_climbed_within_the_budget() {
        let dofs = 8;
        let space = SearchSpace::new(vec![-10.0; dofs], vec![10.0; dofs], vec![1.0; dofs]).unwrap();
        // Neighbours pull at each other.
        let hill = |row: &[f32]| {
            let alone: f32 = row.iter().map(|x| (x - 1.0).powi(2)).sum();
            let pairs: f32 = row.windows(2).map(|pair| (pair[0] - pair[1]).powi(2)).sum();
            1.0 / (1.0 + alone + 0.5 * pairs)
        };
        for budget in [0, 1, 2, 3, 7, 19, 20, 500] {
            let pose: Vec<f32> = (0..dofs).map(|d| 1.0 + 0.4 * (d as f32 * 1.9).sin()).collect();
            let before = hill(&pose);
            let mut estimate = Estimate { fitness: before, pose, spread: vec![0.1; dofs], evaluations: 100 };
            let mut asked = 0;
            let mut fitness = |rows: &[f32], scores: &mut [f32]| {
                asked += scores.len();
                for (row, score) in rows.chunks_exact(dofs).zip(scores) {
                    *score = hill(row);
                }
                Ok(())
            };
            Refinement::new(budget, &space).improve(&mut estimate, &vec![1.0; dofs], &mut fitness).unwrap();
            assert_eq!((asked, estimate.evaluations), (budget, 100 + budget));
            assert_eq!(estimate.fitness, hill(&estimate.pose));
            assert!(estimate.fitness >= before);
            if budget == 500 {
                assert!(estimate.fitness > 0.999, "{} from {before}", estimate.fitness);
            }
        }
    }
}
