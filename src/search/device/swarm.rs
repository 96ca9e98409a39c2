//! Particle swarms on the device.

use anyhow::Result;

use super::behind::ADVANCE;
use super::frame::{DeviceForm, Extent, FrameRecording};
use crate::gpu::{Buffer, Groups, Memory};
use crate::search::kinds::{SwarmHierarchy, SwarmLevel};
use crate::search::shaders::{advance_comp, best_comp, layout, move_comp, scatter_comp, spread_comp};
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

/// What particles keep between iterations.
struct Swarm {
    velocities: Buffer,
    /// The best position of each, and its fitness.
    best: Buffer,
    own: Buffer,
    /// Where an iteration behind its drawing is one pass.
    sides: Option<Sides>,
}

/// What all particles of such an iteration read, twice.
struct Sides {
    positions: Buffer,
    /// The swarm's best.
    lead: Buffer,
    groups: u32,
}

impl FrameRecording<'_> {
    /// Records a swarm after the other, each around the best pose of those before.
    fn swarms(&mut self, settings: &PsoSettings, levels: &[SwarmLevel]) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let Extent { candidates: particles, dofs } = extent;
        let device = self.evaluator.device().clone();
        let swarm = Swarm {
            velocities: self.values("velocities", particles, dofs)?,
            best: self.values("best positions", particles, dofs)?,
            own: self.values("particles' best", particles, 2)?,
            sides: self.sides()?,
        };
        let weights = self.ones("equal weights", particles)?;
        let rows: Vec<f32> = levels.iter().flat_map(|level| level.factors.iter().copied()).collect();
        let factors = device.buffer::<f32>("levels' factors on the spread", rows.len(), Memory::Upload)?;
        factors.write(0, &rows)?;
        // Positions live where the evaluator takes them from.
        let positions = self.evaluator.poses().clone();

        let mut iteration = 0;
        for (index, level) in levels.iter().enumerate() {
            let bindings = scatter_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                positions: &positions,
                velocities: &swarm.velocities,
                best: &swarm.best,
                factors: &factors,
            };
            let push = scatter_comp::Push { particles, dofs, level: index as u32, iteration };
            self.recorder.run(bindings.dispatch(push, extent.block_groups(&device)))?;
            if let Some(Sides { positions: both, .. }) = &swarm.sides {
                let side = both.size() / 2;
                self.recorder.copy("keep", (&positions, 0), (both, u64::from(iteration % 2) * side), side)?;
            }
            for done in 0..level.iterations {
                // After the last iteration particles only take note.
                let mut step =
                    move_comp::Push { particles, dofs, iteration: 0, inertia: 0.0, cognitive: 0.0, social: 0.0 };
                if done + 1 < level.iterations {
                    let inertia = settings.inertia_of(done + 1, level.iterations);
                    let (cognitive, social) = (settings.cognitive, settings.social);
                    step = move_comp::Push { iteration: iteration + 1, inertia, cognitive, social, ..step };
                }
                // At a swarm's first iteration what was found before is forgotten.
                let is_first = u32::from(done == 0);
                match &swarm.sides {
                    Some(sides) => self.advance(&swarm, sides, [iteration, is_first], step)?,
                    None => self.iterate(&swarm, [iteration, is_first], step)?,
                }
                iteration += 1;
            }
            let bindings = spread_comp::Bindings {
                frame: &memory.frame.buffer,
                outcome: &memory.outcome,
                rows: &swarm.best,
                weights: &weights,
                factors: &factors,
            };
            let push = spread_comp::Push { count: particles, dofs, level: index as u32 };
            self.recorder.run(bindings.dispatch(push, Groups::Count([dofs, 1, 1])))?;
        }
        self.recorder.fill("no estimate", &memory.fitness, 0)
    }

    /// Memory for iterations that are one pass behind their drawing, where the device has room for such.
    fn sides(&self) -> Result<Option<Sides>> {
        /// Particles of a workgroup, on a device that runs many at a time.
        const SHARE: u32 = 32;
        let Extent { candidates, dofs } = self.extent;
        let device = self.evaluator.device();
        let bytes = 8 * u64::from(candidates) * u64::from(dofs);
        if !ADVANCE.fits(device) || bytes > device.capabilities().max_storage {
            return Ok(None);
        }
        Ok(Some(Sides {
            positions: self.values("positions on both sides", 2 * candidates, dofs)?,
            lead: self.values("the swarm's best on both sides", 2, dofs + 1)?,
            groups: if device.capabilities().wide { candidates.div_ceil(SHARE) } else { 1 },
        }))
    }

    /// Records an iteration that is one pass behind its drawing.
    fn advance(
        &mut self,
        swarm: &Swarm,
        sides: &Sides,
        [done, is_first]: [u32; 2],
        step: move_comp::Push,
    ) -> Result<()> {
        let memory = self.memory;
        let (poses, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let bindings = advance_comp::Bindings {
            all_sums: &sums,
            fitness: &fitness,
            frame: &memory.frame.buffer,
            outcome: &memory.outcome,
            poses: &poses,
            positions: &sides.positions,
            velocities: &swarm.velocities,
            best: &swarm.best,
            own: &swarm.own,
            history: &memory.history,
            best_sums: &memory.sums,
            lead: &sides.lead,
        };
        let move_comp::Push { particles, dofs, iteration, inertia, cognitive, social } = step;
        let push = |scoring| layout::Advance {
            scoring,
            dofs,
            done,
            is_first,
            side: done % 2,
            iteration,
            inertia,
            cognitive,
            social,
        };
        self.run_behind(&ADVANCE, particles, &bindings.bound(), push, sides.groups)
    }

    /// Records an iteration with a pass for each of what comes behind its drawing.
    fn iterate(&mut self, swarm: &Swarm, [iteration, is_first]: [u32; 2], step: move_comp::Push) -> Result<()> {
        let (Extent { candidates: particles, dofs }, memory) = (self.extent, self.memory);
        self.evaluate(particles)?;
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let bindings = best_comp::Bindings {
            fitness: &fitness,
            outcome: &memory.outcome,
            positions: &positions,
            own: &swarm.own,
            history: &memory.history,
            sums: &sums,
            best_sums: &memory.sums,
        };
        let views = self.evaluator.views() as u32;
        let push = best_comp::Push { particles, dofs, views, iteration, is_first };
        self.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        let bindings = move_comp::Bindings {
            frame: &memory.frame.buffer,
            outcome: &memory.outcome,
            positions: &positions,
            velocities: &swarm.velocities,
            best: &swarm.best,
            own: &swarm.own,
        };
        let groups = self.extent.block_groups(self.recorder.device());
        self.recorder.run(bindings.dispatch(step, groups))
    }
}
