//! Passes of the graphics pipeline: into a target, or into a buffer by transform feedback.

use anyhow::{Result, bail, ensure};
use ash::vk;

use super::buffer::Buffer;
use super::hazards::{Stages, Use};
use super::image::Image;
use super::pass::{Clear, Draw, Feedback, Target};
use super::pipeline::{Resource, uses, with_counters};
use super::recorder::{Recorder, check_push, readable};
use super::shader::Binding;

impl Recorder {
    /// A pass that draws into a target, in the order of the draws.
    ///
    /// # Errors
    /// As [`Self::compute`]; also when the area leaves the target.
    pub fn draw(&mut self, name: &str, target: &Target<'_>, draws: &[Draw<'_>]) -> Result<()> {
        let (colour, _) = target.colour;
        let [left, top, width, height] = target.area;
        for image in std::iter::once(colour).chain(target.depth.map(|(image, _)| image)) {
            let [w, h] = image.size();
            ensure!(
                left.saturating_add(width) <= w && top.saturating_add(height) <= h,
                "the pass {name} draws into {width}x{height} pixels from {left}, {top}, and {} has {w}x{h}",
                image.name()
            );
        }
        self.begin(name)?;
        let counters = self.counters_of(draws)?;
        let bindings = bindings_of(draws, &counters);
        let resources = resources_of(name, draws, &bindings)?;
        let mut all = self.uses_of(draws, &resources);
        let mut layouts: Vec<(Image, vk::ImageLayout)> = resources.iter().flat_map(|own| readable(own)).collect();
        all.push(Use { resource: colour.id(), writes: true });
        layouts.push((colour.clone(), vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL));
        self.keep_image(colour);
        if let Some((depth, _)) = target.depth {
            all.push(Use { resource: depth.id(), writes: true });
            layouts.push((depth.clone(), vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL));
            self.keep_image(depth);
        }
        self.wait_for(&all, &layouts, Stages::GRAPHICS);
        let sets = self.prepare(name, draws, &resources)?;
        let attachment = |image: &Image, clear: Clear, layout, is_depth: bool| {
            let info = vk::RenderingAttachmentInfo::default()
                .image_view(image.shared.view)
                .image_layout(layout)
                .store_op(vk::AttachmentStoreOp::STORE);
            match clear {
                Clear::Keep => info.load_op(vk::AttachmentLoadOp::LOAD),
                Clear::Discard => info.load_op(vk::AttachmentLoadOp::DONT_CARE),
                Clear::Value(value) => info.load_op(vk::AttachmentLoadOp::CLEAR).clear_value(if is_depth {
                    vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: value[0], stencil: 0 } }
                } else {
                    vk::ClearValue { color: vk::ClearColorValue { float32: value } }
                }),
            }
        };
        let colours = [attachment(colour, target.colour.1, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, false)];
        let depth = target
            .depth
            .map(|(image, clear)| attachment(image, clear, vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, true));
        let mut info =
            vk::RenderingInfo::default().render_area(rectangle(target.area)).layer_count(1).color_attachments(&colours);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: recording; images are in the layouts named and live as long as the recording.
        unsafe { self.device.shared.raw.cmd_begin_rendering(self.parts.commands, &info) };
        for (draw, sets) in draws.iter().zip(&sets) {
            self.record_draw(draw, sets);
        }
        // SAFETY: rendering was begun above.
        unsafe { self.device.shared.raw.cmd_end_rendering(self.parts.commands) };
        self.end();
        Ok(())
    }

    /// A pass whose vertex stages write to a buffer, and that draws nothing: pipelines without a colour format.
    ///
    /// # Errors
    /// As [`Self::compute`]; also when the device has no transform feedback, or the range leaves the buffer.
    pub fn feedback(&mut self, name: &str, target: &Feedback<'_>, draws: &[Draw<'_>]) -> Result<()> {
        let Some(functions) = self.device.shared.feedback else {
            bail!("the pass {name} needs transform feedback, which this device does not have");
        };
        let buffer = target.buffer;
        ensure!(
            target.offset.is_multiple_of(4) && target.offset.saturating_add(target.size) <= buffer.size(),
            "the pass {name} writes {} bytes from byte {} of {}, which has {}",
            target.size,
            target.offset,
            buffer.name(),
            buffer.size()
        );
        self.begin(name)?;
        let counters = self.counters_of(draws)?;
        let bindings = bindings_of(draws, &counters);
        let resources = resources_of(name, draws, &bindings)?;
        let mut all = self.uses_of(draws, &resources);
        all.push(Use { resource: buffer.id(), writes: true });
        self.keep_buffer(buffer);
        let layouts: Vec<_> = resources.iter().flat_map(|own| readable(own)).collect();
        self.wait_for(&all, &layouts, Stages::GRAPHICS);
        let sets = self.prepare(name, draws, &resources)?;
        let info = vk::RenderingInfo::default().render_area(rectangle([0, 0, 1, 1])).layer_count(1);
        let commands = self.parts.commands;
        // SAFETY: recording; the extension is enabled and the range lies inside of the buffer.
        unsafe {
            self.device.shared.raw.cmd_begin_rendering(commands, &info);
            (functions.bind_buffers)(commands, 0, 1, &buffer.shared.handle, &target.offset, &target.size);
        }
        for (draw, sets) in draws.iter().zip(&sets) {
            self.bind_draw(draw, sets);
            // SAFETY: as above; the pipeline has a vertex stage that declares its outputs.
            unsafe { (functions.begin)(commands, 0, 0, std::ptr::null(), std::ptr::null()) };
            self.record_vertices(draw);
            // SAFETY: begun above.
            unsafe { (functions.end)(commands, 0, 0, std::ptr::null(), std::ptr::null()) };
        }
        // SAFETY: rendering was begun above.
        unsafe { self.device.shared.raw.cmd_end_rendering(commands) };
        self.end();
        Ok(())
    }

    fn counters_of(&mut self, draws: &[Draw<'_>]) -> Result<Vec<Option<Buffer>>> {
        draws.iter().map(|draw| self.counters(draw.pipeline)).collect()
    }

    fn uses_of(&mut self, draws: &[Draw<'_>], resources: &[Vec<Resource<'_>>]) -> Vec<Use> {
        let mut all = Vec::new();
        for (draw, resources) in draws.iter().zip(resources) {
            all.extend(uses(resources));
            if let Some(indices) = draw.indices {
                all.push(Use { resource: indices.id(), writes: false });
                self.keep_buffer(indices);
            }
            if let Some((counts, _)) = draw.indirect {
                all.push(Use { resource: counts.id(), writes: false });
                self.keep_buffer(counts);
            }
        }
        all
    }

    /// Descriptor sets of all draws, written before rendering begins.
    fn prepare(
        &mut self,
        name: &str,
        draws: &[Draw<'_>],
        resources: &[Vec<Resource<'_>>],
    ) -> Result<Vec<Vec<vk::DescriptorSet>>> {
        draws
            .iter()
            .zip(resources)
            .map(|(draw, resources)| {
                check_push(name, draw.pipeline, draw.push)?;
                if let Some((counts, offset)) = draw.indirect {
                    ensure!(
                        offset % 4 == 0 && offset + 16 <= counts.size() && draw.indices.is_none(),
                        "the pass {name} reads its vertex count at byte {offset} of {}, which has {}, expected four words and no \
                         indices",
                        counts.name(),
                        counts.size()
                    );
                }
                self.keep_pipeline(draw.pipeline);
                self.descriptor_sets(draw.pipeline, resources)
            })
            .collect()
    }

    fn record_draw(&self, draw: &Draw<'_>, sets: &[vk::DescriptorSet]) {
        self.bind_draw(draw, sets);
        self.record_vertices(draw);
    }

    fn bind_draw(&self, draw: &Draw<'_>, sets: &[vk::DescriptorSet]) {
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        self.bind_sets(draw.pipeline, sets, draw.push);
        let [x, y, width, height] = draw.viewport.area;
        let [min_depth, max_depth] = draw.viewport.depth;
        let viewport = [vk::Viewport { x, y, width, height, min_depth, max_depth }];
        // SAFETY: recording, inside of rendering; the states are dynamic in every graphics pipeline.
        unsafe {
            raw.cmd_set_viewport(commands, 0, &viewport);
            raw.cmd_set_scissor(commands, 0, &[rectangle(draw.scissor)]);
            if let Some(indices) = draw.indices {
                raw.cmd_bind_index_buffer(commands, indices.shared.handle, 0, vk::IndexType::UINT32);
            }
        }
    }

    fn record_vertices(&self, draw: &Draw<'_>) {
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        let (vertices, instances) = (draw.vertices.len() as u32, draw.instances.len() as u32);
        // SAFETY: recording, with everything bound; the four words of an indirect draw lie inside of their buffer.
        unsafe {
            if let Some((counts, offset)) = draw.indirect {
                raw.cmd_draw_indirect(commands, counts.shared.handle, offset, 1, 0);
            } else if draw.indices.is_some() {
                raw.cmd_draw_indexed(commands, vertices, instances, draw.vertices.start, 0, draw.instances.start);
            } else {
                raw.cmd_draw(commands, vertices, instances, draw.vertices.start, draw.instances.start);
            }
        }
    }
}

fn bindings_of<'a>(draws: &[Draw<'a>], counters: &'a [Option<Buffer>]) -> Vec<Vec<Binding<'a>>> {
    draws.iter().zip(counters).map(|(draw, counters)| with_counters(draw.bindings, counters.as_ref())).collect()
}

fn resources_of<'a>(name: &str, draws: &[Draw<'_>], bindings: &[Vec<Binding<'a>>]) -> Result<Vec<Vec<Resource<'a>>>> {
    draws.iter().zip(bindings).map(|(draw, bindings)| draw.pipeline.resources(name, bindings)).collect()
}

fn rectangle([x, y, width, height]: [u32; 4]) -> vk::Rect2D {
    vk::Rect2D { offset: vk::Offset2D { x: x as i32, y: y as i32 }, extent: vk::Extent2D { width, height } }
}
