//! The annealed particle filter on the device.

use anyhow::Result;

use super::FrameRecording;
use crate::gpu::Groups;
use crate::search::SearchSettings;
use crate::search::shaders::{layer_comp, weigh_comp};

impl FrameRecording<'_> {
    /// Records a frame of the annealed filter: its layers, each with its weights, then the mean of the last and its own
    /// evaluation.
    pub(super) fn annealed(&mut self, settings: &SearchSettings) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let previous = self.values("previous particles", extent.candidates, extent.dofs)?;
        let weights = self.values("weights", extent.candidates, 1)?;
        let cumulated = self.values("sums of weights", extent.candidates, 2)?;
        let sharpness = self.values("sharpness", 1, 1)?;
        // Particles live where the evaluator takes them from.
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());

        self.recorder.fill("sharpness", &sharpness, 0)?;
        for layer in 0..settings.iterations {
            if layer > 0 {
                self.recorder.copy("keep", (&positions, 0), (&previous, 0), previous.size())?;
            }
            let bindings = layer_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                previous: &previous,
                cumulated: &cumulated,
                positions: &positions,
            };
            let noise = settings.annealing.noise_of(layer, settings.iterations);
            let push = layer_comp::Push { particles: extent.candidates, dofs: extent.dofs, layer: layer as u32, noise };
            self.recorder.run(bindings.dispatch(push, extent.block_groups(self.recorder.device())))?;
            self.evaluate(extent.candidates)?;
            let bindings = weigh_comp::Bindings {
                fitness: &fitness,
                outcome: &memory.outcome,
                particles: &positions,
                weights: &weights,
                cumulated: &cumulated,
                sharpness: &sharpness,
            };
            let survival = settings.annealing.survival;
            let push = weigh_comp::Push { count: extent.candidates, dofs: extent.dofs, survival };
            self.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        }
        self.estimate_mean(&positions, &weights, extent.candidates)
    }
}
