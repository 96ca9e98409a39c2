//! The backend that draws with the graphics pipeline: four candidates of a view a tile of one large framebuffer, compared there
//! with the observations (SPEC A9).

mod compare;
mod compare_segments;
mod draw;
mod draw_mesh;
mod drawn;
mod evaluator;
mod framebuffer;
mod mesh;
#[cfg(test)]
mod mesh_tests;
mod place;
mod project_feedback;
mod readback;
mod room;
mod segments;
#[cfg(test)]
mod segments_tests;
mod settings;
mod skin;
#[cfg(test)]
mod tests;
mod tiles;

pub use settings::{Comparison, Coverage, Gathering, GraphicsSettings, HostComparison, Packing, Projection, Tiling};

use std::sync::Arc;

use anyhow::{Result, ensure};

use self::compare::CompareStage;
use self::drawn::Drawn;
use self::framebuffer::Framebuffer;
use self::place::PlaceStage;
use self::project_feedback::ProjectFeedbackStage;
use self::readback::FramebufferCopy;
use self::room::{Room, make_framebuffer};
use self::segments::{Comparing, GraphicsSegments};
use self::tiles::{fitting_tile, next_tile};
use crate::body::{Body, Mesh};
use crate::evaluate::batch::{check_batch, check_scene};
use crate::evaluate::device::device_evaluator::DeviceEvaluator;
use crate::evaluate::device::generated::layout;
use crate::evaluate::device::objective::ObjectiveStage;
use crate::evaluate::device::open::open_device;
use crate::evaluate::device::pose::PoseStage;
use crate::evaluate::device::runs::Runs;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::rig::Rig;
use crate::evaluate::{CandidateImage, Evaluator, MeshProjector, Objective, Projector, SegmentSums};
use crate::features::{Observation, Segments};
use crate::geometry::Camera;
use crate::gpu::{Device, DeviceFacts, DeviceKind, Memory, PassTiming, Recorder, Recording, Timing};

/// The evaluator that draws with the graphics pipeline of a Vulkan device.
#[derive(Debug)]
pub struct Graphics {
    settings: GraphicsSettings,
    model: DeviceScene,
    drawn: Drawn,
    stages: Stages,
    /// Where the newest observations have them.
    segments: Option<GraphicsSegments>,
    room: Room,
    /// Tile sizes of the views, pixels.
    tiles: Vec<[u32; 2]>,
    /// Whether `tiles` was measured on candidates.
    is_measured: bool,
    /// Whether `tiles` stays as it is.
    is_fixed: bool,
    /// Kept for the comparison on the host.
    observations: Vec<Observation>,
    runs: Runs,
    /// Whether a search has recorded itself with these tiles and segments, and whether the newest observations have outgrown the
    /// ones or have others since.
    is_recorded: bool,
    is_outgrown: bool,
}

#[derive(Debug)]
struct Stages {
    pose: PoseStage,
    feedback: Option<ProjectFeedbackStage>,
    place: PlaceStage,
    compare: CompareStage,
    objective: ObjectiveStage,
    gathering: Gathering,
    /// Workgroups that compare a tile.
    bands: u32,
}

/// What the host compared of a run.
#[derive(Debug, Default)]
struct Counted {
    /// `[candidate][view]`, none for images that the device scored.
    sums: Vec<Option<layout::Sums>>,
    /// `[candidate][view][segment]`, where there are segments.
    segments: Vec<SegmentSums>,
}

impl Graphics {
    /// For a body and its cameras at working size, with the default settings, on the device of [`open_device`].
    ///
    /// # Errors
    /// As [`open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_device()?, body, cameras, GraphicsSettings::default())
    }

    /// On a device. Subgroup shuffles that it does not have become an exchange through shared memory, transform feedback a compute
    /// stage.
    ///
    /// # Errors
    /// When a picture has no pixel or more than 16384 a side, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera], settings: GraphicsSettings) -> Result<Self> {
        Self::of(device, body, None, cameras, settings)
    }

    /// The mesh model of a body, drawn from `mesh`, which is bound to this body. It has a depth a pixel: whatever the settings say,
    /// candidates are packed by depth and the device's own triangles cover the pixels.
    ///
    /// # Errors
    /// As [`Self::on`]; also when the mesh is bound to another number of bones, or a picture is larger than a framebuffer may be.
    pub fn of_mesh(
        device: &Device,
        body: &Body,
        mesh: Mesh,
        cameras: &[Camera],
        settings: GraphicsSettings,
    ) -> Result<Self> {
        let most = device.capabilities().max_image / 4 * 4;
        for camera in cameras {
            let [width, height] = camera.size;
            ensure!(
                width <= most && height <= most,
                "camera {} has pictures of {width}x{height}, and this device draws at most {most} pixels a side",
                camera.name
            );
        }
        let settings = GraphicsSettings {
            packing: Packing::Depth,
            coverage: Coverage::Hardware,
            projection: Projection::Compute,
            ..settings
        };
        Self::of(device, body, Some(mesh), cameras, settings)
    }

    fn of(
        device: &Device,
        body: &Body,
        mesh: Option<Mesh>,
        cameras: &[Camera],
        settings: GraphicsSettings,
    ) -> Result<Self> {
        check_scene(body, cameras)?;
        ensure!(
            body.parts.len() <= 127,
            "the body has {} parts, and the backend graphics tells at most 127 apart",
            body.parts.len()
        );
        let mut settings = settings;
        let gathering = match &mut settings.comparison {
            Comparison::Device(gathering) => {
                if !gathering.works_on(device.capabilities()) {
                    *gathering = Gathering::Shared;
                }
                *gathering
            }
            Comparison::Host(_) => Gathering::Texels,
        };
        if !device.capabilities().transform_feedback {
            settings.projection = Projection::Compute;
        }
        let labels = body.parts.iter().map(|part| part.label).collect();
        let model = DeviceScene::new(device, &Projector::new(body, cameras), labels)?;
        let mut drawn = match mesh {
            None => Drawn::flat(device, model.counts.parts, settings.packing, settings.coverage)?,
            Some(mesh) => Drawn::mesh(device, &model, &MeshProjector::new(body, mesh, cameras)?)?,
        };
        let mut recorder = device.recorder(Timing::Off)?;
        model.record_upload(&mut recorder)?;
        drawn.record_upload(&mut recorder)?;
        // A real device has room for more workgroups than there are tiles; for a processor each is work.
        let bands = if device.facts().kind == DeviceKind::Cpu { 1 } else { 4 };
        let stages = Stages {
            pose: PoseStage::new(device)?,
            feedback: match settings.projection {
                Projection::Compute => None,
                Projection::Feedback => Some(ProjectFeedbackStage::new(device)?),
            },
            place: PlaceStage::new(device)?,
            compare: CompareStage::new(device, gathering, settings.packing.edge_bit(), bands)?,
            objective: ObjectiveStage::new(device)?,
            gathering,
            bands,
        };
        let tiles = model.sizes.clone();
        Ok(Self {
            room: Room::new(&model, &mut drawn, &settings, &tiles, 1)?,
            drawn,
            settings,
            stages,
            segments: None,
            tiles,
            is_measured: false,
            is_fixed: settings.tiling == Tiling::Pictures,
            is_recorded: false,
            is_outgrown: false,
            observations: cameras.iter().map(|camera| Observation::empty(camera.size[0], camera.size[1])).collect(),
            runs: Runs::new(recorder.finish()?),
            model,
        })
    }

    /// The device it works on.
    pub fn facts(&self) -> &DeviceFacts {
        self.model.device.facts()
    }

    /// How it works: as asked for, but for what the device does not have.
    pub fn settings(&self) -> GraphicsSettings {
        self.settings
    }

    /// Tile sizes of the views, [width, height] in pixels, and candidates a batch.
    pub fn tiles(&self) -> (&[[u32; 2]], u32) {
        (&self.tiles, self.room.batch)
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
    /// When their numbers differ, or a mesh is drawn, which belongs to its body.
    pub fn set_body(&mut self, body: &Body) -> Result<()> {
        ensure!(
            matches!(self.drawn, Drawn::Flat { .. }),
            "a mesh is bound to the body it was made with: another body needs an evaluator of its own"
        );
        self.model.set_rig(&Rig::new(body))?;
        self.runs.outdate_upload();
        Ok(())
    }

    /// One pose in one view as the device draws it, for looking and for tests.
    ///
    /// # Errors
    /// When the pose has another length, there is no such view, its picture is larger than a framebuffer may be, or the device
    /// fails.
    pub fn draw(&mut self, pose: &[f32], view: usize) -> Result<CandidateImage> {
        let (views, parts) = (self.view_count(), self.model.counts.parts as usize);
        check_batch(pose, self.dof_count(), 1, 1)?;
        ensure!(view < views, "there are {views} views, and view {view} was asked for");
        let device = self.model.device.clone();
        let workspace = Workspace::new(&device, self.model.counts, 1)?;
        let settings = GraphicsSettings { comparison: Comparison::Host(HostComparison::Scalar), ..self.settings };
        let (framebuffer, copy) = make_framebuffer(&device, &settings, &self.model.sizes, 1)?;
        let [width, height] = self.model.sizes[view];
        let held = framebuffer.layout.views[view].size;
        ensure!(
            held[0] >= width && held[1] >= height,
            "a picture of {width}x{height} is larger than the {}x{} that this device draws at once",
            held[0],
            held[1]
        );
        let staging = device.buffer::<f32>("pose staging", pose.len(), Memory::Upload)?;
        staging.write(0, pose)?;
        let quads_out = device.buffer::<layout::Quad>("quads readback", views * parts, Memory::Readback)?;
        let share = Share { first: 0, candidates: 1 };
        let mut recorder = device.recorder(Timing::Off)?;
        self.record_upload(&mut recorder)?;
        recorder.copy("upload poses", (&staging, 0), (&workspace.poses, 0), staging.size())?;
        self.record_drawing(&mut recorder, &workspace, &framebuffer, share)?;
        recorder.copy("read quads", (&workspace.quads, 0), (&quads_out, 0), quads_out.size())?;
        let copy = match copy {
            Some(copy) => copy,
            None => FramebufferCopy::new(&device, &framebuffer)?,
        };
        copy.record(&mut recorder, &framebuffer)?;
        recorder.finish()?.run()?;
        let mut quads: Vec<layout::Quad> = bytemuck::zeroed_vec(views * parts);
        quads_out.read(0, &mut quads)?;
        let drawn = copy.read(&framebuffer, 1)?.image(0, view, [width, height]);
        let labels = &quads[view * parts..][..parts];
        let bytes = match self.settings.packing {
            Packing::Depth => drawn,
            // 2 rank + edge, ranks counted from the farthest part on, 1 the farthest.
            Packing::Max => drawn
                .iter()
                .map(|&byte| match usize::from(byte >> 1) {
                    0 => 0,
                    rank => labels[parts - rank.min(parts)].label as u8 | byte << 7,
                })
                .collect(),
        };
        Ok(CandidateImage { width, height, bytes })
    }

    /// Poses to pictures.
    fn record_drawing(
        &self,
        recorder: &mut Recorder,
        workspace: &Workspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        self.stages.pose.record(recorder, &self.model, workspace, share)?;
        let feedback = self.stages.feedback.as_ref().zip(self.room.captured.as_ref());
        self.drawn.record(recorder, (&self.model, workspace), feedback, (&self.stages.place, framebuffer), share)
    }

    /// Everything from the poses to the sums of a share; with the comparison on the host, to the framebuffer's copy, and the sums
    /// of the images that fit no tile.
    fn record_share(&self, recorder: &mut Recorder, share: Share, copy: Option<&FramebufferCopy>) -> Result<()> {
        let Room { workspace, framebuffer, .. } = &self.room;
        let scene = (&self.model, workspace);
        self.record_drawing(recorder, workspace, framebuffer, share)?;
        // What fits no tile is scored without a framebuffer.
        let Some(segments) = &self.segments else {
            match copy {
                Some(copy) => copy.record(recorder, framebuffer)?,
                None => self.stages.compare.record(recorder, &self.model, workspace, framebuffer, share)?,
            }
            return self.drawn.record_unplaced(recorder, scene, framebuffer, share);
        };
        match copy {
            Some(copy) => {
                copy.record(recorder, framebuffer)?;
                segments.record_orders(recorder, scene, share)?;
            }
            None => segments.record_comparison(recorder, scene, framebuffer, share)?,
        }
        segments.record_unplaced(recorder, scene, framebuffer, share)
    }

    /// What comes before the first share.
    fn record_start(&self, recorder: &mut Recorder) -> Result<()> {
        self.segments.as_ref().map_or(Ok(()), |segments| segments.record_start(recorder))
    }

    fn shares(&self, candidates: u32) -> Result<Vec<Share>> {
        let Room { workspace, batch, .. } = &self.room;
        ensure!(
            candidates <= workspace.candidates,
            "there is room for {} candidates, and {candidates} were asked for",
            workspace.candidates
        );
        let firsts = (0..candidates).step_by(*batch as usize);
        Ok(firsts.map(|first| Share { first, candidates: (*batch).min(candidates - first) }).collect())
    }

    /// Host to host: the poses, all stages, fitness or sums, bounds. One recording, or with the comparison on the host one a
    /// batch.
    fn record_run(&self, objective: Option<&Objective>, candidates: u32) -> Result<Vec<Recording>> {
        let Room { workspace, ends, bounds_out, copy, .. } = &self.room;
        let views = u64::from(self.model.counts.views);
        let mut recorder = self.model.device.recorder(self.runs.timing())?;
        ends.record_poses(&mut recorder, (&self.model, workspace), candidates)?;
        self.record_start(&mut recorder)?;
        let mut recordings = Vec::new();
        let shares = self.shares(candidates)?;
        for (place, share) in shares.iter().enumerate() {
            self.record_share(&mut recorder, *share, copy.as_ref())?;
            let image = size_of::<layout::Bounds>() as u64;
            let (from, bytes) = (u64::from(share.first) * views * image, u64::from(share.candidates) * views * image);
            recorder.copy("read bounds", (&workspace.bounds, 0), (bounds_out, from), bytes)?;
            if copy.is_some() && place + 1 < shares.len() {
                let next = self.model.device.recorder(self.runs.timing())?;
                recordings.push(std::mem::replace(&mut recorder, next));
            }
        }
        match objective.filter(|_| copy.is_none()) {
            Some(objective) => {
                self.record_objective(&mut recorder, objective, candidates)?;
                ends.record_fitness(&mut recorder, candidates)?;
            }
            None => {
                ends.record_sums(&mut recorder, (&self.model, workspace), candidates)?;
                if let Some(segments) = &self.segments {
                    segments.record_readback(&mut recorder)?;
                }
            }
        }
        recordings.push(recorder);
        recordings.into_iter().map(Recorder::finish).collect()
    }

    fn record_objective(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        let Room { workspace, ends, .. } = &self.room;
        let fitness = &ends.fitness;
        match &self.segments {
            None => self.stages.objective.record(recorder, &self.model, workspace, objective, candidates, fitness),
            Some(segments) => {
                segments.record_objective(recorder, (&self.model, workspace), (objective, candidates), fitness)
            }
        }
    }

    /// Compares by these segments from now on; by whole silhouettes without.
    fn set_segments(&mut self, segments: Option<&Arc<Segments>>) -> Result<()> {
        if self.segments.as_ref().map(GraphicsSegments::segments) == segments {
            return Ok(());
        }
        // Recordings hold the old ones.
        self.runs.forget();
        let how = Comparing {
            packing: self.settings.packing,
            gathering: self.stages.gathering,
            bands: self.stages.bands,
            on_host: matches!(self.settings.comparison, Comparison::Host(_)),
        };
        let scene = (&self.model, &self.room.workspace);
        self.segments =
            segments.map(|segments| GraphicsSegments::new(scene, &self.drawn, segments, how)).transpose()?;
        let mut recorder = self.model.device.recorder(Timing::Off)?;
        self.record_upload(&mut recorder)?;
        self.runs.set_upload(recorder.finish()?);
        self.is_outgrown = self.is_recorded;
        Ok(())
    }

    /// The sums of the segments of a finished run.
    fn read_segments(&self, counted: &Counted, sums: &mut [SegmentSums]) -> Result<()> {
        let Some(segments) = &self.segments else { return Ok(()) };
        segments.read(sums)?;
        let count = segments.segments().as_slice().len();
        let rows = sums.chunks_exact_mut(count).zip(counted.segments.chunks_exact(count));
        for (_, (sums, found)) in counted.sums.iter().zip(rows).filter(|(whole, _)| whole.is_some()) {
            for (sums, found) in sums.iter_mut().zip(found) {
                *sums = SegmentSums { area_obs: sums.area_obs, ..*found };
            }
        }
        Ok(())
    }

    /// Runs poses through the device. The results then lie in the readback buffers; with the comparison on the host, what it
    /// counted comes back.
    fn run(&mut self, poses: &[f32], objective: Option<&Objective>) -> Result<Counted> {
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
        let shares = self.shares(candidates)?;
        let mut counted = Counted::default();
        self.runs.run(&self.model, |batch| {
            if let (Some(copy), Comparison::Host(how)) = (&self.room.copy, self.settings.comparison) {
                let pictures = copy.read(&self.room.framebuffer, shares[batch].candidates)?;
                counted.sums.extend(pictures.compare(&self.observations, self.settings.packing.edge_bit(), how));
                if let Some(segments) = &self.segments {
                    counted.segments.extend(segments.count(&self.model, &pictures, &self.observations, how)?);
                }
            }
            Ok(())
        })?;
        if self.measure(candidates)? && !self.drawn.scores_what_fits_no_tile() {
            // Tiles grow up to the pictures, which everything fits.
            return self.run(poses, objective);
        }
        Ok(counted)
    }

    /// Fits the tiles to what the images of the last run touched. What was recorded before then goes on with the old ones.
    /// Whether a tile was too small, with those spared that are scored without one.
    fn measure(&mut self, candidates: u32) -> Result<bool> {
        if self.is_fixed {
            return Ok(false);
        }
        let spare = if self.drawn.scores_what_fits_no_tile() { 50 } else { usize::MAX };
        let views = self.view_count();
        let mut bounds: Vec<layout::Bounds> = bytemuck::zeroed_vec(candidates as usize * views);
        self.room.bounds_out.read(0, &mut bounds)?;
        let mut tiles = self.tiles.clone();
        let mut outgrown = false;
        for (view, tile) in tiles.iter_mut().enumerate() {
            let mut extents: Vec<[u32; 2]> = bounds
                .iter()
                .skip(view)
                .step_by(views)
                .filter(|bounds| bounds.low[0] < bounds.high[0] && bounds.low[1] < bounds.high[1])
                .map(|bounds| {
                    let side = |axis: usize, low: i32| (bounds.high[axis] - low).unsigned_abs();
                    [side(0, bounds.low[0] & !3), side(1, bounds.low[1])]
                })
                .collect();
            if let Some(needed) = fitting_tile(&mut extents, spare) {
                outgrown |= needed[0] > tile[0].next_multiple_of(4) || needed[1] > tile[1];
                *tile = next_tile(*tile, needed, self.model.sizes[view]);
            }
        }
        self.is_measured = true;
        self.set_tiles(tiles)?;
        Ok(outgrown)
    }
}
