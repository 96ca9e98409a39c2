//! The particle filter on the device.

use anyhow::Result;

use super::frame::{DeviceForm, FrameRecording};
use crate::gpu::Groups;
use crate::search::shaders::{propagate_comp, weigh_comp};
use crate::search::{FilterSettings, SearchSpace};

impl DeviceForm for FilterSettings {
    /// Records a frame of the filter: all batches, the weights, the mean and its own evaluation.
    fn record(&self, frame: &mut FrameRecording, _: &SearchSpace, iterations: usize) -> Result<()> {
        let (extent, memory) = (frame.extent, frame.memory);
        // `check_room` has seen to it that this fits.
        let count = extent.candidates * iterations as u32;
        let particles = frame.values("particles", count, extent.dofs)?;
        let previous = frame.values("previous particles", count, extent.dofs)?;
        let all_fitness = frame.values("fitness of all particles", count, 1)?;
        let weights = frame.values("weights", count, 1)?;
        let cumulated = frame.values("sums of weights", count, 2)?;
        let sharpness = frame.values("sharpness", 1, 1)?;
        let (positions, fitness) = (frame.evaluator.poses().clone(), frame.evaluator.fitness().clone());
        frame.recorder.fill("sharpness", &sharpness, self.sharpness().to_bits())?;

        frame.recorder.copy("keep", (&particles, 0), (&previous, 0), particles.size())?;
        for batch in 0..iterations as u32 {
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
            frame.recorder.run(bindings.dispatch(push, extent.block_groups(frame.recorder.device())))?;
            frame.evaluate(extent.candidates)?;
            let bytes = 4 * u64::from(extent.candidates);
            frame.recorder.copy("gather", (&fitness, 0), (&all_fitness, 4 * u64::from(first)), bytes)?;
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
        frame.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        frame.estimate_mean(&particles, &weights, count)
    }
}
