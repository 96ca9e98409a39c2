//! The annealed particle filter on the device.

use anyhow::Result;

use super::frame::{DeviceForm, FrameRecording};
use crate::gpu::Groups;
use crate::search::shaders::{layer_comp, weigh_comp};
use crate::search::{AnnealingSettings, SearchSpace};

impl DeviceForm for AnnealingSettings {
    /// Records a frame of the annealed filter: its layers, each with its weights, then the mean of the last and its own
    /// evaluation.
    fn record(&self, frame: &mut FrameRecording, _: &SearchSpace, iterations: usize) -> Result<()> {
        let (extent, memory) = (frame.extent, frame.memory);
        let previous = frame.values("previous particles", extent.candidates, extent.dofs)?;
        let weights = frame.values("weights", extent.candidates, 1)?;
        let cumulated = frame.values("sums of weights", extent.candidates, 2)?;
        let sharpness = frame.values("sharpness", 1, 1)?;
        // Particles live where the evaluator takes them from.
        let (positions, fitness) = (frame.evaluator.poses().clone(), frame.evaluator.fitness().clone());

        frame.recorder.fill("sharpness", &sharpness, 0)?;
        for layer in 0..iterations {
            if layer > 0 {
                frame.recorder.copy("keep", (&positions, 0), (&previous, 0), previous.size())?;
            }
            let bindings = layer_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                previous: &previous,
                cumulated: &cumulated,
                positions: &positions,
            };
            let noise = self.noise_of(layer, iterations);
            let push = layer_comp::Push { particles: extent.candidates, dofs: extent.dofs, layer: layer as u32, noise };
            frame.recorder.run(bindings.dispatch(push, extent.block_groups(frame.recorder.device())))?;
            frame.evaluate(extent.candidates)?;
            let bindings = weigh_comp::Bindings {
                fitness: &fitness,
                outcome: &memory.outcome,
                particles: &positions,
                weights: &weights,
                cumulated: &cumulated,
                sharpness: &sharpness,
            };
            let survival = self.survival;
            let push = weigh_comp::Push { count: extent.candidates, dofs: extent.dofs, survival };
            frame.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        }
        frame.estimate_mean(&positions, &weights, extent.candidates)
    }
}
