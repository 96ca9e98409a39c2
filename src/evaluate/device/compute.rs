//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use std::sync::Arc;

use anyhow::{Result, ensure};

use super::device_evaluator::DeviceEvaluator;
use super::host_buffers::HostBuffers;
use super::objective::ObjectiveStage;
use super::open::open_device;
use super::pose::PoseStage;
use super::project::ProjectStage;
use super::raster::RasterStage;
use super::raster_segments::RasterSegmentsStage;
use super::runs::Runs;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::batch::{check_batch, check_scene};
use crate::evaluate::rig::Rig;
use crate::evaluate::segments::{check_segment_batch, segments_of};
use crate::evaluate::{Components, Evaluator, Footprint, Objective, Projector, SegmentSums};
use crate::features::{Observation, Segments};
use crate::geometry::Camera;
use crate::gpu::{Buffer, Device, DeviceFacts, DevicePass, PassTiming, Recorder, Recording, Timing};

/// The evaluator that draws in compute, on a Vulkan device.
#[derive(Debug)]
pub struct Compute {
    model: DeviceScene,
    pose: PoseStage,
    project: ProjectStage,
    raster: RasterStage,
    objective: ObjectiveStage,
    /// Where the newest observations have them.
    segments: Option<DeviceSegments>,
    /// Compiled when the first segments are seen.
    raster_segments: Option<RasterSegmentsStage>,
    room: Room,
    runs: Runs,
    /// Whether a search has recorded itself with these segments, and whether they are others since.
    is_recorded: bool,
    is_outgrown: bool,
}

/// Buffers for a number of candidates.
#[derive(Debug)]
struct Room {
    workspace: Workspace,
    ends: HostBuffers,
}

impl Room {
    fn new(model: &DeviceScene, candidates: u32) -> Result<Self> {
        // The workspace last: it takes what is left.
        let ends = HostBuffers::new(model, candidates)?;
        Ok(Self { ends, workspace: Workspace::new(&model.device, model.counts, candidates)? })
    }
}

impl Compute {
    /// For a body and its cameras at working size, on the device of [`open_device`].
    ///
    /// # Errors
    /// As [`open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_device()?, body, cameras)
    }

    /// On a device.
    ///
    /// # Errors
    /// When a picture has no pixel or more than 16384 a side, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera]) -> Result<Self> {
        check_scene(body, cameras)?;
        let labels = body.parts.iter().map(|part| part.label).collect();
        let model = DeviceScene::new(device, &Projector::new(body, cameras), labels)?;
        let mut recorder = device.recorder(Timing::Off)?;
        model.record_upload(&mut recorder)?;
        let (raster, others) = rayon::join(
            || RasterStage::new(device),
            || anyhow::Ok((PoseStage::new(device)?, ProjectStage::new(device)?, ObjectiveStage::new(device)?)),
        );
        let (pose, project, objective) = others?;
        Ok(Self {
            pose,
            project,
            raster: raster?,
            objective,
            room: Room::new(&model, 1)?,
            segments: None,
            raster_segments: None,
            runs: Runs::new(recorder.finish()?),
            is_recorded: false,
            is_outgrown: false,
            model,
        })
    }

    /// The device it works on.
    pub fn facts(&self) -> &DeviceFacts {
        self.model.device.facts()
    }

    /// Has every evaluation from now on timed by stage ([`Self::timings`]).
    pub fn time_stages(&mut self, timing: Timing) {
        self.runs.time_stages(timing);
    }

    /// The times of the last evaluation's passes.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        self.runs.timings()
    }

    /// Exchanges the body for another one of as many bones, parts and degrees of freedom; what was observed stays.
    ///
    /// # Errors
    /// When their numbers differ.
    pub fn set_body(&mut self, body: &Body) -> Result<()> {
        self.model.set_rig(&Rig::new(body))?;
        self.runs.outdate_upload();
        Ok(())
    }

    /// Everything from the poses to the sums, in as many batches as the workspace needs.
    fn record_sums(&self, recorder: &mut Recorder, candidates: u32) -> Result<()> {
        let workspace = &self.room.workspace;
        ensure!(
            candidates <= workspace.candidates,
            "there is room for {} candidates, and {candidates} were asked for",
            workspace.candidates
        );
        for first in (0..candidates).step_by(workspace.batch as usize) {
            let share = Share { first, candidates: workspace.batch.min(candidates - first) };
            self.pose.record(recorder, &self.model, workspace, share)?;
            self.project.record(recorder, &self.model, workspace, share)?;
            match self.segments.as_ref().zip(self.raster_segments.as_ref()) {
                None => self.raster.record(recorder, &self.model, workspace, share)?,
                Some((segments, raster)) => {
                    // The list is not read.
                    let list = &self.model.cameras;
                    segments.record_sums(recorder, raster, (&self.model, workspace), list, share)?;
                }
            }
        }
        Ok(())
    }

    /// Host to host: upload of the poses, all stages, readback of the fitness or of the sums.
    fn record_run(&self, objective: Option<&Objective>, candidates: u32) -> Result<Vec<Recording>> {
        let Room { workspace, ends } = &self.room;
        let mut recorder = self.model.device.recorder(self.runs.timing())?;
        ends.record_poses(&mut recorder, (&self.model, workspace), candidates)?;
        match objective {
            Some(objective) => {
                self.record(&mut recorder, objective, candidates)?;
                ends.record_fitness(&mut recorder, candidates)?;
            }
            None => {
                self.record_sums(&mut recorder, candidates)?;
                ends.record_sums(&mut recorder, (&self.model, workspace), candidates)?;
                if let Some(segments) = &self.segments {
                    segments.record_readback(&mut recorder)?;
                }
            }
        }
        Ok(vec![recorder.finish()?])
    }

    fn make_room(&mut self, candidates: u32) -> Result<()> {
        if candidates > self.room.workspace.candidates {
            // Recordings hold the old room; without them it is free before the new one is taken.
            self.runs.forget();
            self.room = Room::new(&self.model, candidates)?;
            if let Some(segments) = &mut self.segments {
                segments.reserve(&self.model, candidates)?;
            }
        }
        Ok(())
    }

    /// Compares by these segments from now on; by whole silhouettes without.
    fn set_segments(&mut self, segments: Option<&Arc<Segments>>) -> Result<()> {
        if self.segments.as_ref().map(DeviceSegments::segments) == segments {
            return Ok(());
        }
        self.runs.forget();
        let candidates = self.room.workspace.candidates;
        if segments.is_some() && self.raster_segments.is_none() {
            self.raster_segments = Some(RasterSegmentsStage::new(&self.model.device, false)?);
        }
        self.segments = segments.map(|segments| DeviceSegments::new(&self.model, segments, candidates)).transpose()?;
        let mut recorder = self.model.device.recorder(Timing::Off)?;
        self.record_upload(&mut recorder)?;
        self.runs.set_upload(recorder.finish()?);
        self.is_outgrown = self.is_recorded;
        Ok(())
    }

    /// Runs poses through the device; the results then lie in the readback buffers.
    fn run(&mut self, poses: &[f32], objective: Option<&Objective>) -> Result<()> {
        let candidates = u32::try_from(poses.len() / self.dof_count())?;
        self.make_room(candidates)?;
        self.room.ends.poses_in.write(0, poses)?;
        let key = (candidates, objective.copied());
        if !self.runs.select(key) {
            let mut recorded = self.record_run(objective, candidates);
            if self.runs.gave_way_to(&recorded) {
                recorded = self.record_run(objective, candidates);
            }
            self.runs.add(key, recorded?);
        }
        self.runs.run(&self.model, |_| Ok(()))
    }
}

impl Evaluator for Compute {
    fn name(&self) -> &'static str {
        "compute"
    }

    fn variant(&self) -> &'static str {
        self.raster.variant()
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
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        check_batch(poses, self.dof_count(), components.len(), self.view_count())?;
        if components.is_empty() {
            return Ok(());
        }
        self.run(poses, None)?;
        self.room.ends.read_components(&self.model, &[], components)
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.segments.as_ref().map(DeviceSegments::segments)
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        check_segment_batch(self, poses, sums.len())?;
        if sums.is_empty() {
            return Ok(());
        }
        self.run(poses, None)?;
        match &self.segments {
            Some(segments) => segments.read(sums),
            None => Ok(()),
        }
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        if fitness.is_empty() {
            return Ok(());
        }
        self.run(poses, Some(objective))?;
        self.room.ends.fitness_out.read(0, fitness)
    }

    fn on_device(&mut self) -> Option<&mut dyn DeviceEvaluator> {
        Some(self)
    }

    fn measure_passes(&mut self, measured: bool) -> Result<()> {
        self.runs.measure_passes(measured);
        Ok(())
    }

    fn device_passes(&mut self) -> Vec<DevicePass> {
        self.runs.take_passes()
    }

    fn footprint(&self) -> Option<Footprint> {
        // Bits in registers: no pixel of a candidate is written to memory.
        Some(Footprint { tile: RasterStage::TILE, bytes_per_pixel: 0.0 })
    }
}

impl DeviceEvaluator for Compute {
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
        self.model.counts.views as usize
    }

    fn sums(&self) -> &Buffer {
        &self.room.workspace.sums
    }

    fn has_outgrown_its_recording(&self) -> bool {
        self.is_outgrown
    }

    fn reserve(&mut self, candidates: u32) -> Result<()> {
        (self.is_recorded, self.is_outgrown) = (true, false);
        self.make_room(candidates)
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.model.record_upload(recorder)?;
        self.segments.as_ref().map_or(Ok(()), |segments| segments.record_upload(recorder))
    }

    fn record(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        self.record_sums(recorder, candidates)?;
        let Room { workspace, ends } = &self.room;
        let fitness = &ends.fitness;
        match &self.segments {
            None => self.objective.record(recorder, &self.model, workspace, objective, candidates, fitness),
            Some(segments) => {
                segments.record_objective(recorder, (&self.model, workspace), (objective, candidates), fitness)
            }
        }
    }
}
