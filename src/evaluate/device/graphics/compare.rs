//! The framebuffer against the observations, whole and segment by segment (METHOD A6, A9, docs/RASTER.md).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::{Gathering, Packing};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    compare_shared_comp, compare_shared_segments_comp, compare_subgroup_comp, compare_subgroup_segments_comp,
    compare_texels_comp, compare_texels_segments_comp,
};
use crate::gpu::{Buffer, Groups, Recorder, Shader, ShaderStage};

/// How a framebuffer is drawn and compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparing {
    pub(super) packing: Packing,
    pub(super) gathering: Gathering,
    /// Workgroups a tile, each of which takes every nth row.
    pub(super) bands: u32,
    /// Invocations of a workgroup.
    pub(super) group: u32,
}

/// What a framebuffer is compared with segment by segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObservedSegments<'a> {
    pub(super) segments: &'a DeviceSegments,
    /// The number of every observed pixel, in the order of the scene's packed bytes.
    pub(super) numbers: &'a Buffer,
    /// Codes of parts, labels or ranks, that a picture may hold.
    pub(super) codes: u32,
    /// Whether edges and proximity are counted too.
    pub(super) edges: bool,
}

impl Gathering {
    /// The shader that compares whole silhouettes.
    fn shader(self) -> &'static Shader {
        match self {
            Self::Texels => &compare_texels_comp::SHADER,
            Self::Subgroup => &compare_subgroup_comp::SHADER,
            Self::Shared => &compare_shared_comp::SHADER,
        }
    }

    /// The shader that compares segment by segment.
    fn segments_shader(self) -> &'static Shader {
        match self {
            Self::Texels => &compare_texels_segments_comp::SHADER,
            Self::Subgroup => &compare_subgroup_segments_comp::SHADER,
            Self::Shared => &compare_shared_segments_comp::SHADER,
        }
    }
}

impl Comparing {
    /// The workgroups of a stage that takes the tiles of a share.
    pub(super) fn groups(self, scene: &DeviceScene, share: Share) -> Groups<'static> {
        Groups::Count([share.candidates.div_ceil(4) * scene.counts.views, self.bands, 1])
    }

    fn constants(self, ignores: bool) -> compare_texels_comp::Constants {
        compare_texels_comp::Constants { edge_bit: self.packing.edge_bit(), ignores, local_size_x: self.group }
    }

    fn segments_constants(
        self,
        [codes, segments]: [u32; 2],
        ignores: bool,
        segment_edges: bool,
    ) -> compare_texels_segments_comp::Constants {
        let edge_bit = self.packing.edge_bit();
        compare_texels_segments_comp::Constants {
            edge_bit,
            ignores,
            codes,
            segments,
            segment_edges,
            local_size_x: self.group,
        }
    }

    /// What compares whole silhouettes.
    pub(super) fn stage(self) -> ShaderStage {
        let stage = compare_texels_comp::stage(self.constants(false));
        ShaderStage { shader: self.gathering.shader(), ..stage }
    }

    /// What compares a number of segments, told apart by so many codes.
    pub(super) fn segments_stage(self, codes: u32, segments: u32) -> ShaderStage {
        let stage = compare_texels_segments_comp::stage(self.segments_constants([codes, segments], false, false));
        ShaderStage { shader: self.gathering.segments_shader(), ..stage }
    }

    /// Records the comparison of a share: the framebuffer and the packed observations to `workspace.sums` and, added to what is
    /// there, the segments' sums.
    pub(super) fn record(
        self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        observed: Option<ObservedSegments<'_>>,
        share: Share,
    ) -> Result<()> {
        let push = scene.batch(share);
        let groups = self.groups(scene, share);
        let (placements, tiles, framebuffer) = (&framebuffer.placements, &framebuffer.tiles, &framebuffer.words);
        let (cameras, pixels, all_sums) = (&scene.cameras.buffer, &scene.pixels.buffer, &workspace.sums);
        let ignores = scene.counted.is_some();
        // Not read where everything counts.
        let counted = scene.counted.as_ref().map_or(pixels, |counted| &counted.pixels.buffer);
        let Some(ObservedSegments { segments, numbers, codes, edges }) = observed else {
            let bindings =
                compare_texels_comp::Bindings { placements, tiles, cameras, pixels, all_sums, framebuffer, counted };
            let dispatch = bindings.dispatch(self.constants(ignores), push, groups).by(self.gathering.shader());
            return recorder.compute("compare", &[dispatch]);
        };
        let bindings = compare_texels_segments_comp::Bindings {
            placements,
            tiles,
            cameras,
            pixels,
            all_sums,
            framebuffer,
            table: &segments.table.buffer,
            quads: &workspace.quads,
            segment_pixels: numbers,
            all_segment_sums: &segments.sums,
            counted,
        };
        let count = segments.segments().as_slice().len() as u32;
        let constants = self.segments_constants([codes, count], ignores, edges);
        let dispatch = bindings.dispatch(constants, push, groups).by(self.gathering.segments_shader());
        recorder.compute("compare_segments", &[dispatch])
    }
}
