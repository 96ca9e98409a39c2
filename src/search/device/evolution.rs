//! MA-ES on the device.

use anyhow::{Result, bail};

use super::behind::LEARN;
use super::frame::{DeviceForm, FrameRecording};
use crate::gpu::{Buffer, Device, Groups, Memory};
use crate::search::kinds::{Rates, generations};
use crate::search::shaders::{
    LEARN_DOFS, LEARN_SAMPLES, SEARCH_GROUP, SUM_LANES, begin_comp, choose_comp, follow_comp, layout, learn_comp,
    rank_comp, sample_comp, settle_comp, turn_comp,
};
use crate::search::{MatrixSettings, SearchSpace};

/// What an evolution keeps between its stages.
struct Evolution {
    /// Step size, mean, path and limits, and their next: the same memory where every stage has a pass of its own.
    state: [Buffer; 2],
    /// Workgroups of what comes behind the drawing where that is one pass.
    together: Option<u32>,
    /// The matrix and its next.
    matrix: [Buffer; 2],
    normals: Buffer,
    steps: Buffer,
    /// Of a generation's samples.
    weights: Buffer,
    /// Of ranks, for every size that generations have.
    ranked: Buffer,
    /// Generations of so many samples, where their weights begin in `ranked`, and what they teach.
    rates: Vec<(u32, u32, Rates)>,
}

impl DeviceForm for MatrixSettings {
    fn largest_workgroup(&self) -> u32 {
        SEARCH_GROUP.max(SUM_LANES)
    }

    /// Records a frame of the evolution: its generations, then the mean of the last and its own evaluation.
    fn record(&self, frame: &mut FrameRecording, _: &SearchSpace, iterations: usize) -> Result<()> {
        let (extent, memory) = (frame.extent, frame.memory);
        let dofs = extent.dofs;
        let MatrixSettings { sigma, generation } = *self;
        let evolution = frame.evolution_memory(generation)?;
        let each = Groups::Count([dofs.div_ceil(SEARCH_GROUP), dofs, 1]);
        let bindings = begin_comp::Bindings {
            frame: &memory.frame.buffer,
            outcome: &memory.outcome,
            evolution: &evolution.state[0],
            matrix: &evolution.matrix[0],
        };
        frame.recorder.run(bindings.dispatch(begin_comp::Push { dofs, sigma }, each))?;
        let mut done = 0;
        for iteration in 0..iterations as u32 {
            for range in generations(extent.candidates as usize, generation) {
                frame.generation(&evolution, iteration, [range.start as u32, range.len() as u32], done)?;
                done += 1;
            }
        }
        let (state, matrix) = (&evolution.state[done % 2], &evolution.matrix[done % 2]);
        let bindings =
            settle_comp::Bindings { frame: &memory.frame.buffer, outcome: &memory.outcome, evolution: state, matrix };
        let groups = Groups::Count([dofs.div_ceil(SEARCH_GROUP), 1, 1]);
        frame.recorder.run(bindings.dispatch(settle_comp::Push { dofs }, groups))?;
        frame.evaluate_mean()?;
        let (fitness, sums) = (frame.evaluator.fitness().clone(), frame.evaluator.sums().clone());
        let bindings =
            choose_comp::Bindings { fitness: &fitness, outcome: &memory.outcome, sums: &sums, best_sums: &memory.sums };
        let push = choose_comp::Push { dofs, views: frame.evaluator.views() as u32 };
        frame.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        frame.recorder.fill("no estimate", &memory.fitness, 0)?;
        frame.recorder.fill("no history", &memory.history, 0)
    }
}

impl FrameRecording<'_> {
    /// Records the samples `first..first + samples` of an iteration after `done` generations of the frame.
    fn generation(
        &mut self,
        evolution: &Evolution,
        iteration: u32,
        [first, samples]: [u32; 2],
        done: usize,
    ) -> Result<()> {
        let (dofs, memory) = (self.extent.dofs, self.memory);
        let Evolution { state, together, matrix, normals, steps, weights, ranked, rates } = evolution;
        let Some((_, first_weight, rates)) = rates.iter().find(|(count, ..)| *count == samples) else {
            bail!("generations of {samples} samples have no weights")
        };
        let [old, next] = [done % 2, (done + 1) % 2].map(|side| &matrix[side]);
        let [state, next_state] = [done % 2, (done + 1) % 2].map(|side| &state[side]);
        let (positions, fitness) = (self.evaluator.poses().clone(), self.evaluator.fitness().clone());
        let sums = self.evaluator.sums().clone();
        let frame = &memory.frame.buffer;
        let bindings =
            sample_comp::Bindings { frame, evolution: state, matrix: old, normals, steps, positions: &positions };
        let push = sample_comp::Push { samples, dofs, iteration, first };
        let row = samples.min(self.recorder.device().capabilities().max_groups);
        self.recorder.run(bindings.dispatch(push, Groups::Count([row, 1, samples.div_ceil(row)])))?;
        let parents = rates.weights.len() as u32;
        let ([path_kept, path_gain], [sigma_gain, sigma_loss], [kept, of_path, of_samples]) =
            (rates.path, rates.sigma, rates.matrix);
        if let Some(groups) = together {
            let bindings = learn_comp::Bindings {
                all_sums: &sums,
                fitness: &fitness,
                outcome: &memory.outcome,
                evolution: state,
                next_evolution: next_state,
                ranked,
                normals,
                steps,
                matrix: old,
                next,
                positions: &positions,
                best_sums: &memory.sums,
            };
            let push = |scoring| layout::Learn {
                scoring,
                dofs,
                first_weight: *first_weight,
                parents,
                path_kept,
                path_gain,
                sigma_gain,
                sigma_loss,
                kept,
                of_path,
                of_samples,
            };
            return self.run_behind(&LEARN, samples, &bindings.bound(), push, *groups);
        }
        self.evaluate(samples)?;
        let bindings = rank_comp::Bindings { evolution: state, fitness: &fitness, ranked, weights };
        let push = rank_comp::Push { samples, first_weight: *first_weight, parents };
        self.recorder.run(bindings.dispatch(push, Groups::Over([samples, 1, 1])))?;
        let bindings = follow_comp::Bindings {
            outcome: &memory.outcome,
            evolution: state,
            fitness: &fitness,
            weights,
            normals,
            steps,
            positions: &positions,
            sums: &sums,
            best_sums: &memory.sums,
        };
        let views = self.evaluator.views() as u32;
        let push = follow_comp::Push { samples, dofs, views, path_kept, path_gain, sigma_gain, sigma_loss };
        self.recorder.run(bindings.dispatch(push, Groups::Count([1; 3])))?;
        let bindings =
            turn_comp::Bindings { evolution: state, fitness: &fitness, weights, normals, steps, matrix: old, next };
        let push = turn_comp::Push { samples, dofs, kept, of_path, of_samples };
        self.recorder.run(bindings.dispatch(push, Groups::Count([dofs.div_ceil(SEARCH_GROUP), dofs, 1])))
    }

    fn evolution_memory(&self, generation: usize) -> Result<Evolution> {
        let (extent, device) = (self.extent, self.evaluator.device());
        let mut rates: Vec<(u32, u32, Rates)> = Vec::new();
        let mut ranked = Vec::new();
        for range in generations(extent.candidates as usize, generation) {
            let count = range.len() as u32;
            if rates.iter().any(|(known, ..)| *known == count) {
                continue;
            }
            let found = Rates::new(extent.dofs as usize, range.len());
            let first = ranked.len() as u32;
            ranked.extend_from_slice(&found.weights);
            rates.push((count, first, found));
        }
        let most = rates.iter().map(|(count, ..)| *count).max().unwrap_or(0);
        let by_rank = device.buffer::<f32>("weights of ranks", ranked.len(), Memory::Upload)?;
        by_rank.write(0, &ranked)?;
        // The step size and the best sample, four rows.
        let state = || self.values("evolution", 2 + 4 * extent.dofs, 1);
        let together = learnt_together(device, most, extent.dofs);
        let first = state()?;
        let next = if together.is_some() { state()? } else { first.clone() };
        let matrix = || self.values("matrix", extent.dofs, extent.dofs);
        Ok(Evolution {
            state: [first, next],
            together,
            matrix: [matrix()?, matrix()?],
            normals: self.values("normal numbers", most, extent.dofs)?,
            steps: self.values("steps", most, extent.dofs)?,
            weights: self.values("weights", most, 1)?,
            ranked: by_rank,
            rates,
        })
    }
}

/// The workgroups of what comes behind the drawing of a generation, where the device has room for it in one pass.
fn learnt_together(device: &Device, samples: u32, dofs: u32) -> Option<u32> {
    let fits = samples <= LEARN_SAMPLES && dofs <= LEARN_DOFS && LEARN.fits(device);
    // An entry of the matrix an invocation, on a device that runs many workgroups at a time.
    fits.then(|| if device.capabilities().wide { (dofs * dofs).div_ceil(SUM_LANES) } else { 1 })
}
