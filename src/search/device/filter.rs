//! The particle filter on the device.

use anyhow::Result;

use super::FrameRecording;
use crate::search::SearchSettings;
use crate::search::stages::{Extent, PropagateStage, SpreadStage, WeighStage, propagate_comp, spread_comp, weigh_comp};

impl FrameRecording<'_> {
    /// Records a frame of the filter: all batches, the weights, the mean and its own evaluation.
    pub(super) fn filter(&mut self, settings: &SearchSettings) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let device = self.evaluator.device().clone();
        let propagate = PropagateStage::new(&device)?;
        let weigh = WeighStage::new(&device)?;
        let spread = SpreadStage::new(&device)?;
        // `check_room` has seen to it that this fits.
        let count = extent.candidates * settings.iterations as u32;
        let all = Extent { candidates: count, ..extent };
        let particles = self.values("particles", count, extent.dofs)?;
        let previous = self.values("previous particles", count, extent.dofs)?;
        let all_fitness = self.values("fitness of all particles", count, 1)?;
        let weights = self.values("weights", count, 1)?;
        let cumulated = self.values("sums of weights", count, 2)?;
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();

        self.recorder.copy("keep", (&particles, 0), (&previous, 0), particles.size())?;
        for batch in 0..settings.iterations as u32 {
            let first = batch * extent.candidates;
            let bindings = propagate_comp::Bindings {
                frame: &memory.frame,
                outcome: &memory.outcome,
                previous: &previous,
                cumulated: &cumulated,
                particles: &particles,
                positions: &positions,
            };
            propagate.record(self.recorder, &bindings, extent, [first, count])?;
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
        };
        weigh.record(self.recorder, &bindings, all, settings.filter.sharpness())?;
        let bindings = spread_comp::Bindings {
            frame: &memory.frame,
            outcome: &memory.outcome,
            rows: &particles,
            weights: &weights,
        };
        spread.record(self.recorder, &bindings, all)?;
        let row = 4 * u64::from(extent.dofs);
        let mean = 4 * memory.places.values as u64 + 2 * row;
        self.recorder.copy("estimate", (&memory.outcome, mean), (&positions, 0), row)?;
        self.evaluate(1)?;
        self.recorder.copy("gather", (&fitness, 0), (&memory.fitness, 0), 4)?;
        self.recorder.copy("gather", (&sums, 0), (&memory.sums, 0), memory.sums.size())?;
        self.recorder.fill("no history", &memory.history, 0)
    }
}
