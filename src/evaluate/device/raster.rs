//! Drawing and comparison without any framebuffer, in the reference's integers (docs/RASTER.md, SPEC A6).

use anyhow::Result;

use super::scene::{DeviceScene, Share};
use super::workspace::Workspace;
use crate::evaluate::shaders::{RASTER_GROUP, RASTER_WORDS, raster_comp, raster_shared_comp};
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct RasterStage {
    /// For all images of a batch.
    all: ComputeStage,
    /// For the images of a list.
    listed: ComputeStage,
    has_subgroups: bool,
}

impl RasterStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "raster";

    /// Columns and rows that a workgroup works on at once: words of bits of a row, a row an invocation.
    pub(crate) const TILE: [u32; 2] = [32 * RASTER_WORDS, RASTER_GROUP];

    /// Compiles it, with sums over subgroups where the device has them.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        let has_subgroups = device.capabilities().subgroup_arithmetic;
        let shader = if has_subgroups { &raster_comp::SHADER } else { &raster_shared_comp::SHADER };
        let compile = |listed: u32| ComputeStage::new(device, Self::NAME, Stage { shader, constants: &[(0, listed)] });
        // Drivers take a tenth of a second for each.
        let (all, listed) = rayon::join(|| compile(0), || compile(1));
        Ok(Self { all: all?, listed: listed?, has_subgroups })
    }

    /// `subgroup` or `shared`: how it sums.
    pub(crate) fn variant(&self) -> &'static str {
        if self.has_subgroups { "subgroup" } else { "shared" }
    }

    /// Records it: `workspace.quads` and `bounds` to `workspace.sums`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        share: Share,
    ) -> Result<()> {
        let images = share.candidates * model.counts.views;
        // The list is not read.
        self.dispatch(recorder, &self.all, (model, workspace, share), &model.cameras, Groups::Count([images, 1, 1]))
    }

    /// Records it for some images of the share alone: `list` holds how many there are, 1, 1, and their numbers,
    /// (candidate - first) * views + view.
    pub(crate) fn record_listed(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        share: Share,
        list: &Buffer,
    ) -> Result<()> {
        self.dispatch(recorder, &self.listed, (model, workspace, share), list, Groups::Indirect(list, 0))
    }

    fn dispatch(
        &self,
        recorder: &mut Recorder,
        stage: &ComputeStage,
        (model, workspace, share): (&DeviceScene, &Workspace, Share),
        list: &Buffer,
        groups: Groups<'_>,
    ) -> Result<()> {
        let push: raster_comp::Push = model.batch(share);
        // Both variants have the same bindings.
        let bindings = raster_comp::Bindings {
            cameras: &model.cameras,
            quads: &workspace.quads,
            all_bounds: &workspace.bounds,
            planes: &model.planes,
            list,
            all_sums: &workspace.sums,
        };
        stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
