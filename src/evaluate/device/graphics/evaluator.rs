//! The graphics backend as an evaluator, and as what a search on the device records.

use std::sync::Arc;

use anyhow::Result;

use super::Graphics;
use super::segments::GraphicsSegments;
use super::settings::{Comparison, Packing};
use crate::evaluate::batch::check_batch;
use crate::evaluate::device::device_evaluator::DeviceEvaluator;
use crate::evaluate::segments::{check_segment_batch, segments_of};
use crate::evaluate::{CandidateImage, Components, Evaluator, Footprint, Objective, SegmentSums};
use crate::features::{Observation, Segments};
use crate::gpu::{Buffer, Device, DevicePass, Recorder};

impl Evaluator for Graphics {
    fn name(&self) -> &'static str {
        "graphics"
    }

    fn variant(&self) -> &'static str {
        self.settings.name()
    }

    fn view_count(&self) -> usize {
        self.model.counts.views as usize
    }

    fn dof_count(&self) -> usize {
        self.model.counts.dofs as usize
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        let segments = segments_of(observations)?;
        self.model.observe(observations)?;
        self.set_segments(segments.as_ref())?;
        if let Some(segments) = &mut self.segments {
            segments.observe(&self.model, observations)?;
        }
        self.runs.outdate_upload();
        if matches!(self.settings.comparison, Comparison::Host(_)) {
            self.observations = observations.to_vec();
        }
        // Until candidates have told, they are taken to be about as large as what is seen.
        if !self.is_measured && !self.is_fixed {
            let seen: Vec<[u32; 2]> = observations.iter().map(first_tile).collect();
            let outgrows = |(seen, tile): (&[u32; 2], &[u32; 2])| seen[0] > tile[0] || seen[1] > tile[1];
            if self.is_recorded && seen.iter().zip(&self.tiles).any(outgrows) {
                // With room to grow into, so that this does not happen in every frame of an approach.
                let grown = seen
                    .iter()
                    .zip(&self.model.sizes)
                    .map(|(seen, size)| [0, 1].map(|axis| (seen[axis] + seen[axis] / 4).min(size[axis])));
                self.set_tiles(grown.collect())?;
                self.is_outgrown = true;
            } else if !self.is_recorded {
                self.set_tiles(seen)?;
            }
        }
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        check_batch(poses, self.dof_count(), components.len(), self.view_count())?;
        if components.is_empty() {
            return Ok(());
        }
        let counted = self.run(poses, None)?;
        self.room.ends.read_components(&self.model, &counted.sums, components)
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.segments.as_ref().map(GraphicsSegments::segments)
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        check_segment_batch(self, poses, sums.len())?;
        if sums.is_empty() {
            return Ok(());
        }
        let counted = self.run(poses, None)?;
        self.read_segments(&counted, sums)
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        if fitness.is_empty() {
            return Ok(());
        }
        if let Comparison::Host(_) = self.settings.comparison {
            let views = self.view_count();
            let mut components = vec![Components::default(); fitness.len() * views];
            let counted = self.run(poses, None)?;
            self.room.ends.read_components(&self.model, &counted.sums, &mut components)?;
            let rows = components.chunks_exact(views);
            let Some(segments) = &self.segments else {
                fitness.iter_mut().zip(rows).for_each(|(value, row)| *value = objective.fitness(row));
                return Ok(());
            };
            let a_pose = views * segments.segments().as_slice().len();
            let mut sums = vec![SegmentSums::default(); fitness.len() * a_pose];
            self.read_segments(&counted, &mut sums)?;
            for ((value, row), sums) in fitness.iter_mut().zip(rows).zip(sums.chunks_exact(a_pose)) {
                *value = objective.segmented_fitness(row, segments.segments(), sums);
            }
            return Ok(());
        }
        self.run(poses, Some(objective))?;
        // The tiles may have been fitted since; the room's ends stay.
        self.room.ends.fitness_out.read(0, fitness)
    }

    fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        self.draw(pose, view).map(Some)
    }

    fn on_device(&mut self) -> Option<&mut dyn DeviceEvaluator> {
        match self.settings.comparison {
            Comparison::Device(_) => Some(self),
            Comparison::Host(_) => None,
        }
    }

    fn measure_passes(&mut self, measured: bool) -> Result<()> {
        self.runs.measure_passes(measured);
        Ok(())
    }

    fn device_passes(&mut self) -> Vec<DevicePass> {
        self.runs.take_passes()
    }

    fn footprint(&self) -> Option<Footprint> {
        let tile = [0, 1].map(|axis| self.tiles.iter().map(|tile| tile[axis]).max().unwrap_or(0));
        // A channel of a texel, and a quarter of its depth.
        let bytes_per_pixel = if self.settings.packing == Packing::Depth { 2.0 } else { 1.0 };
        Some(Footprint { tile, bytes_per_pixel })
    }
}

impl DeviceEvaluator for Graphics {
    fn device(&self) -> &Device {
        &self.model.device
    }

    fn poses(&self) -> &Buffer {
        &self.room.workspace.poses
    }

    fn fitness(&self) -> &Buffer {
        &self.room.ends.fitness
    }

    fn views(&self) -> usize {
        self.view_count()
    }

    fn sums(&self) -> &Buffer {
        &self.room.workspace.sums
    }

    fn has_outgrown_its_recording(&self) -> bool {
        self.is_outgrown
    }

    fn reserve(&mut self, candidates: u32) -> Result<()> {
        (self.is_recorded, self.is_outgrown) = (true, false);
        if !self.drawn.scores_what_fits_no_tile() && !self.is_fixed {
            // Nobody looks between what is recorded here: every image must fit.
            self.set_tiles(self.model.sizes.clone())?;
            self.is_fixed = true;
        }
        self.make_room(candidates)
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.model.record_upload(recorder)?;
        self.segments.as_ref().map_or(Ok(()), |segments| segments.record_upload(recorder))?;
        self.drawn.record_upload(recorder)
    }

    /// With tiles of the size that the newest observations or candidates told; images that outgrow them later are still scored,
    /// the slower way. The comparison is on the device, whatever the settings say.
    fn record(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        self.record_start(recorder)?;
        for share in self.shares(candidates)? {
            self.record_share(recorder, share, None)?;
        }
        self.record_objective(recorder, objective, candidates)
    }
}

/// The tile of a view of which only the observation is known: its silhouette, a quarter larger; the picture when there is none.
fn first_tile(observation: &Observation) -> [u32; 2] {
    let picture = [observation.width, observation.height];
    observation.silhouette().bounds().map_or(picture, |seen| {
        let sides = [seen.x1 - seen.x0, seen.y1 - seen.y0];
        [0, 1].map(|axis| (sides[axis] + sides[axis] / 4 + 16).min(picture[axis]))
    })
}
