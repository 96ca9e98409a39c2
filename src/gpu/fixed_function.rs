//! The fixed part of graphics pipelines: what vertices form, and how fragments meet what is there.

use ash::vk;

use super::device_shared::DeviceShared;
use super::executables::flags;
use super::image::Format;

/// What the driver gives for pipelines: those made, or those it got to and why it went no further.
pub(super) type Made = Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>;

/// What the vertices of a draw form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topology {
    /// Points.
    Points,
    /// Every two vertices a line.
    Lines,
    /// Every three vertices a triangle.
    Triangles,
    /// Every six vertices a triangle and its neighbours, for a geometry stage: a corner, the third vertex of the neighbour across the
    /// side that begins there, the next corner.
    TrianglesWithNeighbours,
}

/// How a fragment meets what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// It replaces it.
    Replace,
    /// In each channel the larger value stays.
    Max,
}

/// The fixed part of a graphics pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawing {
    /// What vertices form.
    pub topology: Topology,
    /// Format of the colour target; none where only transform feedback is wanted.
    pub colour: Option<Format>,
    /// Whether there is a depth target of [`Format::Depth32`], tested less or equal.
    pub depth_test: bool,
    /// Whether the depth is written where the test passes.
    pub depth_write: bool,
    /// Whether triangles whose corners run clockwise in the picture are left out.
    pub cull_clockwise: bool,
    /// How colours meet.
    pub blend: Blend,
    /// Which channels are written: bit 0 red to bit 3 alpha.
    pub channels: u8,
}

impl Default for Drawing {
    /// Triangles whose fragments replace what is there, all channels; no targets yet.
    fn default() -> Self {
        Self {
            topology: Topology::Triangles,
            colour: None,
            depth_test: false,
            depth_write: false,
            cull_clockwise: false,
            blend: Blend::Replace,
            channels: 15,
        }
    }
}

impl Drawing {
    /// Makes a pipeline of this and these stages, without vertex buffers.
    pub(super) fn create(
        &self,
        device: &DeviceShared,
        layout: vk::PipelineLayout,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    ) -> Made {
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(match self.topology {
            Topology::Points => vk::PrimitiveTopology::POINT_LIST,
            Topology::Lines => vk::PrimitiveTopology::LINE_LIST,
            Topology::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
            Topology::TrianglesWithNeighbours => vk::PrimitiveTopology::TRIANGLE_LIST_WITH_ADJACENCY,
        });
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .rasterizer_discard_enable(self.colour.is_none())
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(if self.cull_clockwise { vk::CullModeFlags::BACK } else { vk::CullModeFlags::NONE })
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self.depth_test)
            .depth_write_enable(self.depth_write)
            .depth_compare_op(vk::CompareOp::LESS_OR_EQUAL);
        let attachment = [vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(self.blend == Blend::Max)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE)
            .color_blend_op(vk::BlendOp::MAX)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE)
            .alpha_blend_op(vk::BlendOp::MAX)
            .color_write_mask(vk::ColorComponentFlags::from_raw(u32::from(self.channels & 15)))];
        let formats: Vec<_> = self.colour.iter().map(|format| format.vulkan()).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachment[..formats.len()]);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
        if self.depth_test {
            rendering = rendering.depth_attachment_format(Format::Depth32.vulkan());
        }
        let info = [vk::GraphicsPipelineCreateInfo::default()
            .flags(flags(device))
            .stages(stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering)];
        // SAFETY: everything `info` points to lives through the call.
        unsafe { device.raw.create_graphics_pipelines(device.pipelines, &info, None) }
    }
}
