//! Drawing with the graphics pipeline and comparing in its framebuffer, in tiles as large as candidates need.

use anyhow::{Result, ensure};

use super::compare::Comparing;
use super::drawn::Drawn;
use super::evidence::GraphicsEvidence;
use super::readback::FramebufferCopy;
use super::segments::GraphicsSegments;
use super::settings::{Comparison, Gathering, GraphicsSettings, Packing, Projection, Tiling};
use super::target::Target;
use super::tiles::{first_tiles, fitted_tiles};
use crate::body::{Body, Mesh};
use crate::evaluate::device::backend::DeviceBackend;
use crate::evaluate::device::evidence::DeviceEvidence;
use crate::evaluate::device::host_buffers::HostCounts;
use crate::evaluate::device::open::open_device;
use crate::evaluate::device::passes::pose_and_project_stages;
use crate::evaluate::device::rasteriser::Rasteriser;
use crate::evaluate::device::resources::Resources;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::stage_groups::StageGroups;
use crate::evaluate::device::summed::Summed;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::evaluator::Footprint;
use crate::evaluate::mesh_projection::{MeshProjector, bound_to_its_body};
use crate::evaluate::raster::CandidateImage;
use crate::evaluate::shaders::{layout, objective_comp, place_comp, pose_comp};
use crate::features::{Observation, SeenView};
use crate::geometry::Camera;
use crate::gpu::{Device, DeviceKind, Recorder};

/// The evaluator that draws with the graphics pipeline of a Vulkan device.
pub type Graphics = DeviceBackend<GraphicsRasteriser>;

/// Draws into a framebuffer and compares there, or on the host.
#[derive(Debug)]
pub struct GraphicsRasteriser {
    settings: GraphicsSettings,
    drawn: Drawn,
    comparing: Comparing,
    /// What segments are compared with, where the newest observations have them.
    segments: Option<GraphicsSegments>,
    /// What evidence is looked up in, where the newest observations carry it.
    evidence: Option<GraphicsEvidence>,
    target: Target,
    /// Tile sizes of the views, pixels: those of the framebuffer, and those that are better.
    tiles: Vec<[u32; 2]>,
    better_tiles: Vec<[u32; 2]>,
    /// Whether they were measured on candidates.
    is_measured: bool,
    /// Whether they stay as they are.
    is_fixed: bool,
    /// Kept for the comparison on the host.
    observations: Vec<Observation>,
}

impl Graphics {
    /// For a body and its cameras at working size, with the default settings, on the device of [`open_device`].
    ///
    /// # Errors
    /// As [`open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_device()?, body, cameras, GraphicsSettings::default())
    }

    /// On a device. What it does not have of the settings is replaced: subgroup shuffles by an exchange through shared memory, transform
    /// feedback by a compute stage, a geometry stage by vertices alone, blending by the largest value by depths and write masks.
    ///
    /// # Errors
    /// When a picture has no pixel or is too large, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera], settings: GraphicsSettings) -> Result<Self> {
        Self::with_groups(device, body, cameras, settings, StageGroups::default())
    }

    /// As [`Self::on`], by workgroups of other sizes.
    pub(crate) fn with_groups(
        device: &Device,
        body: &Body,
        cameras: &[Camera],
        settings: GraphicsSettings,
        groups: StageGroups,
    ) -> Result<Self> {
        ensure!(
            body.parts.len() <= 127,
            "the body has {} parts, and the backend graphics tells at most 127 apart",
            body.parts.len()
        );
        let settings = settings.on(device.capabilities());
        Self::with(DeviceScene::new(device, body, cameras)?.with_groups(groups)?, |scene| {
            let drawn = Drawn::flat(scene, &settings)?;
            GraphicsRasteriser::new(scene, drawn, settings)
        })
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
        let settings = settings.of_mesh().on(device.capabilities());
        Self::with(DeviceScene::new(device, body, cameras)?, |scene| {
            let drawn = Drawn::mesh(scene, &MeshProjector::new(body, mesh, cameras)?, &settings)?;
            GraphicsRasteriser::new(scene, drawn, settings)
        })
    }

    /// How it works: as asked for, but for what the device does not have.
    pub fn settings(&self) -> GraphicsSettings {
        self.rasteriser.settings
    }

    /// Tile sizes of the views, [width, height] in pixels, and candidates a batch.
    pub fn tiles(&self) -> (&[[u32; 2]], u32) {
        (&self.rasteriser.tiles, self.rasteriser.batch(&self.resources.workspace))
    }

    #[cfg(test)]
    pub(super) fn set_tiles(&mut self, tiles: Vec<[u32; 2]>) -> Result<()> {
        self.rasteriser.better_tiles = tiles;
        self.refit().map(|_| ())
    }
}

impl GraphicsRasteriser {
    fn new(scene: &DeviceScene, drawn: Drawn, settings: GraphicsSettings) -> Result<Self> {
        let device = &scene.device;
        let gathering = match settings.comparison {
            Comparison::Device(gathering) => gathering,
            Comparison::Host(_) => Gathering::Texels,
        };
        // A real device has room for more workgroups than there are tiles; for a processor each is work.
        let bands = if device.facts().kind == DeviceKind::Cpu { 1 } else { 4 };
        let comparing = Comparing { packing: settings.packing, gathering, bands, group: scene.groups.compare };
        let mut stages = vec![place_comp::stage(), comparing.stage(), objective_comp::stage()];
        if drawn.scores_what_fits_no_tile() && settings.projection == Projection::Compute {
            stages.extend(pose_and_project_stages(scene));
        } else {
            stages.push(pose_comp::stage());
        }
        device.compile(&stages)?;
        let tiles = scene.sizes.clone();
        Ok(Self {
            drawn,
            comparing,
            segments: None,
            evidence: None,
            target: Target::new(scene, &settings, &tiles, 1)?,
            better_tiles: tiles.clone(),
            tiles,
            is_measured: false,
            is_fixed: settings.tiling == Tiling::Pictures,
            observations: scene.sizes.iter().map(|&[width, height]| Observation::empty(width, height)).collect(),
            settings,
        })
    }

    pub(super) fn settings(&self) -> GraphicsSettings {
        self.settings
    }

    pub(super) fn drawn(&self) -> &Drawn {
        &self.drawn
    }

    /// Bone matrices to the sums of a share; with a copy, to that, and the sums of the images that fit no tile.
    fn record_comparison(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        (summed, share): (Summed<'_>, Share),
        copy: Option<&FramebufferCopy>,
    ) -> Result<()> {
        let scene = (&resources.scene, &resources.workspace);
        let framebuffer = &self.target.framebuffer;
        // Batches add to it.
        match summed {
            Summed::Segments(segments, _) if share.first == 0 => recorder.fill("clear segments", &segments.sums, 0)?,
            Summed::Evidence(evidence) if share.first == 0 => recorder.fill("clear evidence", &evidence.sums, 0)?,
            _ => (),
        }
        self.drawn.record(recorder, scene, framebuffer, share)?;
        let segments = match summed {
            Summed::Segments(segments, edges) => self.segments.as_ref().map(|own| (own, segments, edges)),
            _ => None,
        };
        let evidence = match summed {
            Summed::Evidence(evidence) => self.evidence.as_ref().map(|own| (own, evidence)),
            _ => None,
        };
        match copy {
            None => {
                let observed = segments.map(|(own, segments, edges)| own.observed(segments, edges));
                self.comparing.record(recorder, scene, framebuffer, observed, share)?;
                if let Some((own, evidence)) = evidence {
                    own.record(recorder, scene, (framebuffer, evidence), share)?;
                }
            }
            Some(copy) => {
                copy.record(recorder, framebuffer)?;
                let orders = segments.map(|(own, ..)| &own.orders).or(evidence.map(|(own, _)| &own.orders));
                orders.map_or(Ok(()), |orders| orders.record(recorder, scene, share))?;
            }
        }
        // What fits no tile is scored without a framebuffer.
        self.drawn.record_unplaced(recorder, scene, summed, framebuffer, share)
    }
}

impl Rasteriser for GraphicsRasteriser {
    const NAME: &'static str = "graphics";

    fn variant(&self) -> &'static str {
        self.settings.name()
    }

    fn footprint(&self) -> Footprint {
        let tile = [0, 1].map(|axis| self.tiles.iter().map(|tile| tile[axis]).max().unwrap_or(0));
        // A channel of a texel, and a quarter of its depth.
        let bytes_per_pixel = if self.settings.packing == Packing::Depth { 2.0 } else { 1.0 };
        Footprint { tile, bytes_per_pixel }
    }

    fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        self.drawn.reserve(scene, candidates)?;
        self.target = Target::new(scene, &self.settings, &self.tiles, candidates)?;
        Ok(())
    }

    fn set_workspace(&mut self, scene: &DeviceScene, workspace: &Workspace) -> Result<()> {
        self.drawn.set_workspace(scene, workspace)?;
        let segments = self.segments.as_mut().map(|segments| &mut segments.orders);
        let orders = segments.into_iter().chain(self.evidence.as_mut().map(|evidence| &mut evidence.orders));
        orders.into_iter().try_for_each(|orders| orders.reserve(scene, workspace))
    }

    fn batch(&self, workspace: &Workspace) -> u32 {
        workspace.batch.min(self.target.framebuffer.layout.candidates).min(self.drawn.most())
    }

    fn set_segments(
        &mut self,
        scene: &DeviceScene,
        workspace: &Workspace,
        segments: Option<&DeviceSegments>,
    ) -> Result<()> {
        let how = (self.comparing, self.compares_on_host());
        let scene = (scene, workspace);
        self.segments =
            segments.map(|own| GraphicsSegments::new(scene, &self.drawn, own.segments(), how)).transpose()?;
        Ok(())
    }

    fn set_evidence(
        &mut self,
        scene: &DeviceScene,
        workspace: &Workspace,
        evidence: Option<&DeviceEvidence>,
    ) -> Result<()> {
        let how = (self.comparing, self.compares_on_host());
        let scene = (scene, workspace);
        self.evidence = evidence.map(|_| GraphicsEvidence::new(scene, &self.drawn, how)).transpose()?;
        Ok(())
    }

    fn observe(&mut self, scene: &DeviceScene, observations: &[Observation], is_recorded: bool) -> Result<()> {
        if let Some(segments) = &mut self.segments {
            segments.observe(scene, observations)?;
        }
        if let Some(evidence) = &self.evidence {
            evidence.observe(scene, observations)?;
        }
        if self.compares_on_host() {
            self.observations = observations.to_vec();
        }
        // Until candidates have told, they are taken to be about as large as what is seen.
        if !self.is_measured && !self.is_fixed {
            self.better_tiles = first_tiles(&SeenView::all(observations), is_recorded.then_some(&self.tiles));
        }
        Ok(())
    }

    fn observe_handed(&mut self, views: &[SeenView<'_>], is_recorded: bool) {
        if !self.is_measured && !self.is_fixed {
            self.better_tiles = first_tiles(views, is_recorded.then_some(&self.tiles));
        }
    }

    fn record_upload(&self, recorder: &mut Recorder, is_handed: bool) -> Result<()> {
        self.segments.as_ref().map_or(Ok(()), |segments| segments.record_upload(recorder))?;
        let evidence = self.evidence.as_ref().filter(|_| !is_handed);
        evidence.map_or(Ok(()), |evidence| evidence.record_upload(recorder))?;
        self.drawn.record_upload(recorder)
    }

    fn record_evidence(&self, recorder: &mut Recorder, scene: &DeviceScene, evidence: &DeviceEvidence) -> Result<()> {
        self.evidence.as_ref().map_or(Ok(()), |own| own.record_made(recorder, scene, evidence))
    }

    /// With tiles of the size that the newest observations or candidates told; images that outgrow them later are still scored,
    /// the slower way. The comparison is on the device, whatever the settings say.
    fn record_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        self.record_comparison(recorder, resources, (summed, share), None)
    }

    fn record_host_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        self.record_comparison(recorder, resources, (summed, share), self.target.copy.as_ref())?;
        let a_candidate = u64::from(resources.scene.counts.views) * size_of::<layout::Bounds>() as u64;
        let (from, bytes) = (u64::from(share.first) * a_candidate, u64::from(share.candidates) * a_candidate);
        recorder.copy("read bounds", (&resources.workspace.bounds, 0), (&self.target.bounds_out, from), bytes)
    }

    fn compares_on_host(&self) -> bool {
        matches!(self.settings.comparison, Comparison::Host(_))
    }

    fn count(&self, resources: &Resources, summed: Summed<'_>, share: Share, counts: &mut HostCounts) -> Result<()> {
        let (Some(copy), Comparison::Host(how)) = (&self.target.copy, self.settings.comparison) else { return Ok(()) };
        let pictures = copy.read(&self.target.framebuffer, share.candidates)?;
        counts.sums.extend(pictures.compare(&self.observations, self.settings.packing.edge_bit(), how));
        let parts = resources.scene.counts.parts as usize;
        match (summed, &self.segments, &self.evidence) {
            (Summed::Segments(scored, edges), Some(segments), _) => {
                let scored = (&**scored.segments(), edges);
                counts.segments.extend(segments.count(scored, parts, &pictures, &self.observations, how)?);
            }
            (Summed::Evidence(_), _, Some(evidence)) => {
                counts.evidence.extend(evidence.sum(parts, &pictures, &self.observations)?);
            }
            _ => (),
        }
        Ok(())
    }

    /// Fits the tiles to what the images of the last run touched. The run is repeated where a tile was too small and what fits none
    /// is not scored: tiles grow up to the pictures, which everything fits.
    fn learn(&mut self, scene: &DeviceScene, candidates: u32) -> Result<bool> {
        if self.is_fixed {
            return Ok(false);
        }
        let is_spared = self.drawn.scores_what_fits_no_tile();
        let spare = if is_spared { 50 } else { usize::MAX };
        let mut bounds: Vec<layout::Bounds> = bytemuck::zeroed_vec(candidates as usize * scene.sizes.len());
        self.target.bounds_out.read(0, &mut bounds)?;
        let (tiles, is_outgrown) = fitted_tiles(&self.tiles, &bounds, &scene.sizes, spare);
        self.better_tiles = tiles;
        self.is_measured = true;
        Ok(is_outgrown && !is_spared)
    }

    fn prepare_search(&mut self, scene: &DeviceScene) {
        if !self.drawn.scores_what_fits_no_tile() && !self.is_fixed {
            // Nobody looks between what is recorded: every image must fit.
            self.better_tiles.clone_from(&scene.sizes);
            self.is_fixed = true;
        }
    }

    fn is_outgrown(&self) -> bool {
        self.better_tiles != self.tiles
    }

    fn refit(&mut self, resources: &Resources) -> Result<()> {
        let Resources { scene, workspace, .. } = resources;
        self.target.refit(&scene.device, &self.settings, &self.better_tiles, workspace.candidates)?;
        self.tiles.clone_from(&self.better_tiles);
        Ok(())
    }

    fn draw(&self, resources: &Resources, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        Ok(self.pictures(resources, pose, view..view + 1)?.pop())
    }

    fn check_exchange(&self) -> Result<()> {
        if self.drawn.scores_what_fits_no_tile() { Ok(()) } else { Err(bound_to_its_body()) }
    }
}
