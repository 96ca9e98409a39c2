//! Particle swarms on the device.

use anyhow::Result;

use super::FrameRecording;
use crate::gpu::Memory;
use crate::search::SearchSettings;
use crate::search::hierarchical::SwarmStage;
use crate::search::stages::{
    BestStage, MoveStage, Pull, ScatterStage, SpreadStage, best_comp, move_comp, scatter_comp, spread_comp,
};

impl FrameRecording<'_> {
    /// Records a swarm after the other, each around the best pose of those before.
    pub(super) fn swarm(&mut self, settings: &SearchSettings, stages: &[SwarmStage]) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let device = self.evaluator.device().clone();
        let scatter = ScatterStage::new(&device)?;
        let best_stage = BestStage::new(&device)?;
        let advance = MoveStage::new(&device)?;
        let spread = SpreadStage::new(&device)?;
        let velocities = self.values("velocities", extent.candidates, extent.dofs)?;
        let best = self.values("best positions", extent.candidates, extent.dofs)?;
        let own = self.values("particles' best", extent.candidates, 2)?;
        let weights = self.ones("equal weights", extent.candidates)?;
        let rows: Vec<f32> = stages.iter().flat_map(|stage| stage.factors.iter().copied()).collect();
        let factors = device.buffer::<f32>("stages' factors on the spread", rows.len(), Memory::Upload)?;
        factors.write(0, &rows)?;
        // Positions live where the evaluator takes them from.
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let views = self.evaluator.views() as u32;

        let mut iteration = 0;
        for (index, stage) in stages.iter().enumerate() {
            let bindings = scatter_comp::Bindings {
                frame: &memory.frame,
                outcome: &memory.outcome,
                positions: &positions,
                velocities: &velocities,
                best: &best,
                factors: &factors,
            };
            scatter.record(self.recorder, &bindings, extent, index as u32, iteration)?;
            for done in 0..stage.iterations {
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
                best_stage.record(self.recorder, &bindings, extent, views, iteration, done == 0)?;
                iteration += 1;
                let pull = (done + 1 < stage.iterations).then(|| Pull {
                    iteration,
                    inertia: settings.pso.inertia_of(done + 1, stage.iterations),
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
            let bindings = spread_comp::Bindings {
                frame: &memory.frame,
                outcome: &memory.outcome,
                rows: &best,
                weights: &weights,
                factors: &factors,
            };
            spread.record(self.recorder, &bindings, extent, index as u32)?;
        }
        self.recorder.fill("no estimate", &memory.fitness, 0)
    }
}
