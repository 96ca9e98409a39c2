//! The framebuffer against the observations: components of every image (SPEC A6, A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::Gathering;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{compare_shared_comp, compare_subgroup_comp, compare_texels_comp};
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Shader, Stage};

impl Gathering {
    /// The stage that compares whole silhouettes.
    fn shader(self) -> &'static Shader {
        match self {
            Self::Texels => &compare_texels_comp::SHADER,
            Self::Subgroup => &compare_subgroup_comp::SHADER,
            Self::Shared => &compare_shared_comp::SHADER,
        }
    }
}

/// The stage.
#[derive(Debug)]
pub(crate) struct CompareStage {
    stage: ComputeStage,
    /// Workgroups a tile, each of which takes every nth row.
    bands: u32,
}

impl CompareStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "compare";

    /// Compiles it; `edge_bit` is the bit of a pixel's byte that says edge, `bands` the number of workgroups a tile.
    pub(crate) fn new(device: &Device, gathering: Gathering, edge_bit: u32, bands: u32) -> Result<Self> {
        let shader = gathering.shader();
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader, constants: &[(0, edge_bit)] })?;
        Ok(Self { stage, bands })
    }

    /// Records it: the framebuffer and the packed observations to `workspace.sums`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        let push: compare_texels_comp::Push = model.batch(share);
        // All variants have the same bindings.
        let bindings = compare_texels_comp::Bindings {
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
            cameras: &model.cameras,
            pixels: &model.pixels,
            all_sums: &workspace.sums,
            framebuffer: &framebuffer.words,
        };
        self.stage.record(
            recorder,
            &bindings.bound(),
            &push,
            Groups::Count([share.candidates.div_ceil(4) * model.counts.views, self.bands, 1]),
        )
    }
}
