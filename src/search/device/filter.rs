//! The particle filter on the device.

use anyhow::Result;

use super::FrameRecording;
use crate::gpu::Groups;
use crate::search::SearchSettings;
use crate::search::shaders::{propagate_comp, weigh_comp};

impl FrameRecording<'_> {
    /// Records a frame of the filter: all batches, the weights, the mean and its own evaluation.
    pub(super) fn filter(&mut self, settings: &SearchSettings) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        // `check_room` has seen to it that this fits.
        let count = extent.candidates * settings.iterations as u32;
        let particles = self.values("particles", count, extent.dofs)?;
        let previous = self.values("previous particles", count, extent.dofs)?;
        let all_fitness = self.values("fitness of all particles", count, 1)?;
        let weights = self.values("weights", count, 1)?;
        let cumulated = self.values("sums of weights", count, 2)?;
        let sharpness = self.values("sharpness", 1, 1)?;
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        self.recorder.fill("sharpness", &sharpness, settings.filter.sharpness().to_bits())?;

        self.recorder.copy("keep", (&particles, 0), (&previous, 0), particles.size())?;
        for batch in 0..settings.iterations as u32 {
            let first = batch * extent.candidates;
            let bindings = propagate_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                previous: &previous,
                cumulated: &cumulated,
                particles: &particles,
                positions: &positions,
            };
            let push = propagate_comp::Push { first, batch: extent.candidates, count, dofs: extent.dofs };
            self.recorder.run(bindings.dispatch(push, extent.block_groups(self.recorder.device())))?;
            self.evaluate(extent.candidates)?;
            let bytes = 4 * u64::from(extent.candidates);
            self.recorder.copy("gather", (&fitness, 0), (&all_fitness, 4 * u64::from(first)), bytes)?;
        }
        let bindings = weigh_comp::Bindings {
            fitness: &all_fitness,
            outcome: &memory.outcome,
            particles: &particles,
            weights: &weights,
            cumulated: &cumulated,
            sharpness: &sharpness,
        };
        // The sharpness stays what the settings say.
        let push = weigh_comp::Push { count, dofs: extent.dofs, survival: 0.0 };
        self.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        self.estimate_mean(&particles, &weights, count)
    }
}
