//! Search for the best pose of a frame over counter-based random numbers (METHOD A8): particle swarm, particle filter, annealed
//! particle filter, hierarchical particle swarm, CMA-ES and MA-ES, at equal numbers of evaluations.
//!
//! A search proposes batches of poses and is told their fitness; it knows neither cameras nor pictures. All of its random
//! numbers have an address of their own (see [`Random`]), all ties go to the lower index and all its sums run in a fixed
//! order, so its result depends on the seed and the fitness alone, never on the number of threads that computed that.

mod arithmetic;
mod device;
mod kinds;
mod philox;
mod refinement;
mod shaders;
mod space;
mod weights;

use anyhow::{Result, ensure};

pub use device::{DeviceFound, DeviceSearch};
pub use kinds::{
    AnnealedFilter, AnnealingSettings, CmaSettings, FilterSettings, HierarchicalPso, HierarchySettings, MatrixSettings,
    ParticleFilter, Pso, PsoSettings, SearchKind, SearchSettings,
};
pub use philox::{Draw, Random, Stream, philox4x32};
pub use refinement::Refinement;
pub use space::SearchSpace;

/// Scores poses: takes rows of single-precision state vectors (mm, radians), one after the other, and fills in one fitness
/// a row, larger is better. What is not a finite number counts as worse than anything.
pub type Fitness<'a> = dyn FnMut(&[f32], &mut [f32]) -> Result<()> + 'a;

/// What a search found in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The pose: mm, radians, in state-vector order, within the limits.
    pub pose: Vec<f32>,
    /// Its fitness.
    pub fitness: f32,
    /// Standard deviation of the candidates that stand behind it, one a degree of freedom: how sure the search is.
    pub spread: Vec<f32>,
    /// Poses scored for it.
    pub evaluations: usize,
}

/// A search over the poses of one frame after the other.
///
/// Call [`Self::start_frame`], then [`Self::iterate`] up to [`Self::iterations`] times (fewer, when time runs out), then
/// [`Self::estimate`]; or all of it by [`Self::search_frame`]. Buffers are allocated when the search is made: iterating
/// allocates nothing.
pub trait Search: Send {
    /// Its name as `--search` takes it.
    fn name(&self) -> &'static str;

    /// The iterations of a frame.
    fn iterations(&self) -> usize;

    /// Begins a frame around `centre`, the previous estimate, with a standard deviation of `spread` a degree of freedom.
    ///
    /// # Errors
    /// When a length is not the number of degrees of freedom, a value is not finite, or a spread is negative.
    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()>;

    /// One iteration: proposes poses, has them scored, takes note.
    ///
    /// # Errors
    /// When no frame was begun, its iterations are all done, or `fitness` fails.
    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()>;

    /// The result of the iterations so far.
    ///
    /// # Errors
    /// When nothing was scored, no fitness was a finite number, or `fitness` fails.
    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate>;

    /// A whole frame.
    ///
    /// # Errors
    /// As the three steps.
    fn search_frame(
        &mut self,
        frame: u32,
        centre: &[f32],
        spread: &[f32],
        fitness: &mut Fitness<'_>,
    ) -> Result<Estimate> {
        self.start_frame(frame, centre, spread)?;
        for _ in 0..self.iterations() {
            self.iterate(fitness)?;
        }
        self.estimate(fitness)
    }
}

/// Checks what [`Search::start_frame`] is given.
fn check_start(dof_count: usize, centre: &[f32], spread: &[f32]) -> Result<()> {
    for (name, values) in [("centre", centre), ("spread", spread)] {
        let count = values.len();
        ensure!(count == dof_count, "the search's {name} has {count} values, expected {dof_count}");
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            anyhow::bail!("the search's {name} is {} at index {index}, expected a finite number", values[index]);
        }
    }
    if let Some(index) = spread.iter().position(|&value| value < 0.0) {
        anyhow::bail!("the search's spread is {} at index {index}, expected 0 or more", spread[index]);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
