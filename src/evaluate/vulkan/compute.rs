//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use std::time::Instant;

use anyhow::{Result, ensure};

use crate::body::Body;
use crate::evaluate::batch::check_batch;
use crate::evaluate::rig::Rig;
use crate::evaluate::stages::{ObjectiveStage, PoseStage, ProjectStage, RasterStage, Share, layout};
use crate::evaluate::{Components, Evaluator, Footprint, Objective, Projector};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::gpu::{
    Buffer, Device, DeviceFacts, DevicePass, Memory, OutOfMemory, PassTiming, Recorder, Recording, Timing,
};

use super::{DeviceEvaluator, DeviceModel, Workspace, open_device};

/// Recordings kept: a search asks for a few numbers of candidates over and over.
const MOST_RECORDINGS: usize = 16;

/// The evaluator that draws in compute, on a Vulkan device.
#[derive(Debug)]
pub struct Compute {
    model: DeviceModel,
    pose: PoseStage,
    project: ProjectStage,
    raster: RasterStage,
    objective: ObjectiveStage,
    room: Room,
    /// Brings body, cameras and observations to the device.
    upload: Recording,
    is_uploaded: bool,
    /// What was recorded for a number of candidates, and for an objective or for the components; the latest last.
    recordings: Vec<((u32, Option<Objective>), Recording)>,
    timing: Timing,
    /// What ran since it was last asked for, once it is to be measured.
    passes: Option<Vec<DevicePass>>,
}

/// Buffers for a number of candidates.
#[derive(Debug)]
struct Room {
    workspace: Workspace,
    fitness: Buffer,
    /// The host's ends of poses, fitness and sums.
    poses_in: Buffer,
    fitness_out: Buffer,
    sums_out: Buffer,
}

impl Room {
    fn new(model: &DeviceModel, candidates: u32) -> Result<Self> {
        let (device, counts) = (&model.device, model.counts);
        let count = candidates as usize;
        // The workspace last: it takes what is left.
        Ok(Self {
            fitness: device.buffer::<f32>("fitness", count, Memory::Device)?,
            poses_in: device.buffer::<f32>("poses staging", count * counts.dofs as usize, Memory::Upload)?,
            fitness_out: device.buffer::<f32>("fitness readback", count, Memory::Readback)?,
            sums_out: device.buffer::<layout::Sums>(
                "sums readback",
                count * counts.views as usize,
                Memory::Readback,
            )?,
            workspace: Workspace::new(device, counts, candidates)?,
        })
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
        ensure!(!cameras.is_empty(), "there are no cameras, expected at least one to compare poses with");
        ensure!(body.dof_count() > 0, "the body has no degree of freedom, expected at least one to search over");
        for camera in cameras {
            let [width, height] = camera.size;
            ensure!(
                (1..=16384).contains(&width) && (1..=16384).contains(&height),
                "camera {} has pictures of {width}x{height}, expected 1 to 16384 pixels a side",
                camera.name
            );
        }
        let labels = body.parts.iter().map(|part| part.label).collect();
        let model = DeviceModel::new(device, &Projector::new(body, cameras), labels)?;
        let mut recorder = device.recorder(Timing::Off)?;
        model.record_upload(&mut recorder)?;
        Ok(Self {
            pose: PoseStage::new(device)?,
            project: ProjectStage::new(device)?,
            raster: RasterStage::new(device)?,
            objective: ObjectiveStage::new(device)?,
            room: Room::new(&model, 1)?,
            upload: recorder.finish()?,
            is_uploaded: false,
            recordings: Vec::new(),
            timing: Timing::Off,
            passes: None,
            model,
        })
    }

    /// The device it works on.
    pub fn facts(&self) -> &DeviceFacts {
        self.model.device.facts()
    }

    /// Has every evaluation from now on timed by stage ([`Self::timings`]).
    pub fn time_stages(&mut self, timing: Timing) {
        self.timing = timing;
        self.recordings.clear();
    }

    /// The times of the last evaluation's passes.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        self.recordings.last().map_or_else(|| Ok(Vec::new()), |(_, recording)| recording.timings())
    }

    /// Exchanges the body for another one of as many bones, parts and degrees of freedom; what was observed stays.
    ///
    /// # Errors
    /// When their numbers differ.
    pub fn set_body(&mut self, body: &Body) -> Result<()> {
        self.model.set_rig(&Rig::new(body))?;
        self.is_uploaded = false;
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
            self.raster.record(recorder, &self.model, workspace, share)?;
        }
        Ok(())
    }

    /// Host to host: upload of the poses, all stages, readback of the fitness or of the sums.
    fn record_run(&self, objective: Option<&Objective>, candidates: u32) -> Result<Recording> {
        let Room { workspace, fitness, poses_in, fitness_out, sums_out } = &self.room;
        let count = u64::from(candidates);
        let mut recorder = self.model.device.recorder(self.timing)?;
        let bytes = count * u64::from(self.model.counts.dofs) * size_of::<f32>() as u64;
        recorder.copy("upload poses", (poses_in, 0), (&workspace.poses, 0), bytes)?;
        match objective {
            Some(objective) => {
                self.record(&mut recorder, objective, candidates)?;
                recorder.copy("read fitness", (fitness, 0), (fitness_out, 0), count * size_of::<f32>() as u64)?;
            }
            None => {
                self.record_sums(&mut recorder, candidates)?;
                let bytes = count * u64::from(self.model.counts.views) * size_of::<layout::Sums>() as u64;
                recorder.copy("read sums", (&workspace.sums, 0), (sums_out, 0), bytes)?;
            }
        }
        recorder.finish()
    }

    /// Runs poses through the device; the results then lie in the readback buffers.
    fn run(&mut self, poses: &[f32], objective: Option<&Objective>) -> Result<()> {
        let candidates = u32::try_from(poses.len() / self.dof_count())?;
        self.reserve(candidates)?;
        self.room.poses_in.write(0, poses)?;
        let key = (candidates, objective.copied());
        match self.recordings.iter().position(|(known, _)| *known == key) {
            Some(place) => self.recordings[place..].rotate_left(1),
            None => {
                if self.recordings.len() == MOST_RECORDINGS {
                    self.recordings.remove(0);
                }
                let recording = match self.record_run(objective, candidates) {
                    Err(error) if error.is::<OutOfMemory>() && !self.recordings.is_empty() => {
                        // The others give theirs up.
                        self.recordings.clear();
                        self.record_run(objective, candidates)
                    }
                    done => done,
                }?;
                self.recordings.push((key, recording));
            }
        }
        if !self.is_uploaded {
            // The run that follows waits for it on the device.
            self.upload.submit()?;
            self.is_uploaded = true;
        }
        if let Some((_, recording)) = self.recordings.last_mut() {
            recording.run()?;
            if let Some(passes) = &mut self.passes {
                passes.extend(recording.passes_run(Instant::now())?);
            }
        }
        self.model.device.validation_log().check()?;
        Ok(())
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
        self.model.observe(observations)?;
        self.is_uploaded = false;
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        check_batch(poses, self.dof_count(), components.len(), self.view_count())?;
        if components.is_empty() {
            return Ok(());
        }
        self.run(poses, None)?;
        let mut sums: Vec<layout::Sums> = bytemuck::zeroed_vec(components.len());
        self.room.sums_out.read(0, &mut sums)?;
        let areas = self.model.observed_areas().collect::<Vec<_>>();
        for (index, (components, sums)) in components.iter_mut().zip(&sums).enumerate() {
            let layout::Sums { area_model, overlap, edges, proximity } = *sums;
            *components = Components { area_obs: areas[index % areas.len()], area_model, overlap, edges, proximity };
        }
        Ok(())
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        if fitness.is_empty() {
            return Ok(());
        }
        self.run(poses, Some(objective))?;
        self.room.fitness_out.read(0, fitness)
    }

    fn on_device(&mut self) -> Option<&mut dyn DeviceEvaluator> {
        Some(self)
    }

    fn measure_passes(&mut self, measured: bool) -> Result<()> {
        if measured != self.passes.is_some() {
            self.passes = measured.then(Vec::new);
            self.time_stages(if measured { Timing::Statistics } else { Timing::Off });
        }
        Ok(())
    }

    fn device_passes(&mut self) -> Vec<DevicePass> {
        self.passes.as_mut().map(std::mem::take).unwrap_or_default()
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
        &self.room.fitness
    }

    fn views(&self) -> usize {
        self.model.counts.views as usize
    }

    fn sums(&self) -> &Buffer {
        &self.room.workspace.sums
    }

    fn reserve(&mut self, candidates: u32) -> Result<()> {
        if candidates > self.room.workspace.candidates {
            // Recordings hold the old room; without them it is free before the new one is taken.
            self.recordings.clear();
            self.room = Room::new(&self.model, candidates)?;
        }
        Ok(())
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.model.record_upload(recorder)
    }

    fn record(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        self.record_sums(recorder, candidates)?;
        let Room { workspace, fitness, .. } = &self.room;
        self.objective.record(recorder, &self.model, workspace, objective, candidates, fitness)
    }
}
