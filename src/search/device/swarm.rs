//! The particle swarm on the device.

use anyhow::Result;

use super::FrameRecording;
use crate::search::SearchSettings;
use crate::search::stages::{
    BestStage, MoveStage, Pull, ScatterStage, SpreadStage, best_comp, move_comp, scatter_comp, spread_comp,
};

impl FrameRecording<'_> {
    /// Records all iterations of a swarm.
    pub(super) fn swarm(&mut self, settings: &SearchSettings) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let device = self.evaluator.device().clone();
        let scatter = ScatterStage::new(&device)?;
        let best_stage = BestStage::new(&device)?;
        let advance = MoveStage::new(&device)?;
        let spread = SpreadStage::new(&device)?;
        let velocities = self.values("velocities", extent.candidates, extent.dofs)?;
        let best = self.values("best positions", extent.candidates, extent.dofs)?;
        let own = self.values("particles' best", extent.candidates, 2)?;
        let weights = self.values("equal weights", extent.candidates, 1)?;
        // Positions live where the evaluator takes them from.
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let views = self.evaluator.views() as u32;

        self.recorder.fill("weights", &weights, 1.0_f32.to_bits())?;
        let bindings = scatter_comp::Bindings {
            frame: &memory.frame,
            positions: &positions,
            velocities: &velocities,
            best: &best,
        };
        scatter.record(self.recorder, &bindings, extent)?;
        for iteration in 0..settings.iterations {
            self.evaluate(extent.candidates)?;
            let bindings = best_comp::Bindings {
                fitness: &fitness,
                outcome: &memory.outcome,
                positions: &positions,
                own: &own,
                history: &memory.history,
                sums: &sums,
                best_sums: &memory.sums,
            };
            best_stage.record(self.recorder, &bindings, extent, views, iteration as u32)?;
            let next = iteration + 1;
            let pull = (next < settings.iterations).then(|| Pull {
                iteration: next as u32,
                inertia: settings.pso.inertia_of(next, settings.iterations),
                cognitive: settings.pso.cognitive,
                social: settings.pso.social,
            });
            let bindings = move_comp::Bindings {
                frame: &memory.frame,
                outcome: &memory.outcome,
                positions: &positions,
                velocities: &velocities,
                best: &best,
                own: &own,
            };
            advance.record(self.recorder, &bindings, extent, pull)?;
        }
        let bindings =
            spread_comp::Bindings { frame: &memory.frame, outcome: &memory.outcome, rows: &best, weights: &weights };
        spread.record(self.recorder, &bindings, extent)?;
        self.recorder.fill("no estimate", &memory.fitness, 0)
    }
}
