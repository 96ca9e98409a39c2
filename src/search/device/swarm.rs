//! Particle swarms on the device.

use anyhow::Result;

use super::frame::{DeviceForm, Extent, FrameRecording};
use crate::gpu::{Groups, Memory};
use crate::search::kinds::{SwarmHierarchy, SwarmLevel};
use crate::search::shaders::{best_comp, move_comp, scatter_comp, spread_comp};
use crate::search::{PsoSettings, SearchSpace};

impl DeviceForm for PsoSettings {
    fn record(&self, frame: &mut FrameRecording, space: &SearchSpace, iterations: usize) -> Result<()> {
        frame.swarms(self, &[SwarmLevel::whole(space, iterations)])
    }
}

impl DeviceForm for SwarmHierarchy {
    fn record(&self, frame: &mut FrameRecording, space: &SearchSpace, iterations: usize) -> Result<()> {
        frame.swarms(&self.swarm, &self.hierarchy.levels(space, iterations))
    }
}

impl FrameRecording<'_> {
    /// Records a swarm after the other, each around the best pose of those before.
    fn swarms(&mut self, settings: &PsoSettings, levels: &[SwarmLevel]) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let Extent { candidates: particles, dofs } = extent;
        let device = self.evaluator.device().clone();
        let velocities = self.values("velocities", extent.candidates, extent.dofs)?;
        let best = self.values("best positions", extent.candidates, extent.dofs)?;
        let own = self.values("particles' best", extent.candidates, 2)?;
        let weights = self.ones("equal weights", extent.candidates)?;
        let rows: Vec<f32> = levels.iter().flat_map(|level| level.factors.iter().copied()).collect();
        let factors = device.buffer::<f32>("levels' factors on the spread", rows.len(), Memory::Upload)?;
        factors.write(0, &rows)?;
        // Positions live where the evaluator takes them from.
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let views = self.evaluator.views() as u32;
        let blocks = extent.block_groups(&device);

        let mut iteration = 0;
        for (index, level) in levels.iter().enumerate() {
            let bindings = scatter_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                positions: &positions,
                velocities: &velocities,
                best: &best,
                factors: &factors,
            };
            let push = scatter_comp::Push { particles, dofs, level: index as u32, iteration };
            self.recorder.run(bindings.dispatch(push, blocks))?;
            for done in 0..level.iterations {
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
                // At a swarm's first iteration what was found before is forgotten.
                let push = best_comp::Push { particles, dofs, views, iteration, is_first: u32::from(done == 0) };
                self.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
                iteration += 1;
                // After the last iteration particles only take note.
                let mut push =
                    move_comp::Push { particles, dofs, iteration: 0, inertia: 0.0, cognitive: 0.0, social: 0.0 };
                if done + 1 < level.iterations {
                    let inertia = settings.inertia_of(done + 1, level.iterations);
                    let (cognitive, social) = (settings.cognitive, settings.social);
                    push = move_comp::Push { iteration, inertia, cognitive, social, ..push };
                }
                let bindings = move_comp::Bindings {
                    frame: &memory.frame.buffer,
                    outcome: &memory.outcome,
                    positions: &positions,
                    velocities: &velocities,
                    best: &best,
                    own: &own,
                };
                self.recorder.run(bindings.dispatch(push, blocks))?;
            }
            let bindings = spread_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                rows: &best,
                weights: &weights,
                factors: &factors,
            };
            let push = spread_comp::Push { count: particles, dofs, level: index as u32 };
            self.recorder.run(bindings.dispatch(push, Groups::Count([dofs, 1, 1])))?;
        }
        self.recorder.fill("no estimate", &memory.fitness, 0)
    }
}
