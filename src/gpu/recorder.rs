//! The one way to run anything: passes are recorded with their label, breadcrumb, timestamps and the barriers they need.

use std::collections::HashMap;
use std::ffi::CString;
use std::ops::Range;

use anyhow::{Result, bail, ensure};
use ash::vk;
use ash::vk::Handle as _;

use super::buffer::Buffer;
use super::device::Device;
use super::hazards::{Hazards, Use};
use super::image::{Image, whole};
use super::memory::Memory;
use super::pipeline::{Pipeline, descriptor_type};
use super::recording::{Recording, RecordingParts};
use super::shader::{Access, Binding, BindingKind, Bound};
use super::timing::Timing;

/// Most passes of a recording: its queries and breadcrumbs are made for so many.
const MOST_PASSES: usize = 4096;
/// Descriptor sets of a pool; a recording takes another pool when one is used up.
const SETS_A_POOL: u32 = 128;

/// How many workgroups are run.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// So many in x, y, z.
    Count([u32; 3]),
    /// Three words of a buffer, from this byte on.
    Indirect(&'a Buffer, u64),
}

/// One run of a compute pipeline.
#[derive(Clone, Copy, Debug)]
pub struct Dispatch<'a> {
    /// The pipeline.
    pub pipeline: &'a Pipeline,
    /// What its descriptors point to.
    pub bindings: &'a [Binding<'a>],
    /// Its push constants.
    pub push: &'a [u8],
    /// Its workgroups.
    pub groups: Groups<'a>,
}

/// Part of a target in pixels, and the range that depths 0 to 1 are mapped to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left, top, width, height, pixels.
    pub area: [f32; 4],
    /// Nearest and farthest depth.
    pub depth: [f32; 2],
}

/// One draw of a graphics pipeline.
#[derive(Clone, Debug)]
pub struct Draw<'a> {
    /// The pipeline.
    pub pipeline: &'a Pipeline,
    /// What its descriptors point to.
    pub bindings: &'a [Binding<'a>],
    /// Its push constants.
    pub push: &'a [u8],
    /// Where clip coordinates land.
    pub viewport: Viewport,
    /// Left, top, width, height of what may be touched, pixels.
    pub scissor: [u32; 4],
    /// Vertex numbers, or places in the index buffer.
    pub vertices: Range<u32>,
    /// Instance numbers.
    pub instances: Range<u32>,
    /// A buffer of 32-bit vertex numbers.
    pub indices: Option<&'a Buffer>,
    /// Four words of a buffer, from this byte on, that an earlier pass wrote, instead of `vertices` and `instances`: how many
    /// vertices, how many instances, the first vertex, and 0. Not together with `indices`.
    pub indirect: Option<(&'a Buffer, u64)>,
}

/// What becomes of a target's contents before it is drawn into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clear {
    /// They stay.
    Keep,
    /// They may be anything.
    Discard,
    /// The area is set to a colour; of a depth target, to the first number.
    Value([f32; 4]),
}

/// What a pass draws into.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// The colour image.
    pub colour: (&'a Image, Clear),
    /// The depth image.
    pub depth: Option<(&'a Image, Clear)>,
    /// Left, top, width, height of what is cleared and drawn, pixels.
    pub area: [u32; 4],
}

/// Where transform feedback writes: everything behind an offset, in bytes.
#[derive(Clone, Copy, Debug)]
pub struct Feedback<'a> {
    /// The buffer.
    pub buffer: &'a Buffer,
    /// First byte.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
}

/// A sequence of passes being recorded.
pub struct Recorder {
    device: Device,
    parts: RecordingParts,
    timing: Timing,
    hazards: Hazards,
    /// Layouts of images that are not in GENERAL.
    layouts: HashMap<u64, (Image, vk::ImageLayout)>,
    /// Descriptor sets written so far, by layout and what is bound.
    sets: HashMap<(vk::DescriptorSetLayout, Vec<(u32, u64)>), vk::DescriptorSet>,
    sets_left: u32,
    kept: std::collections::HashSet<u64>,
}

impl std::fmt::Debug for Recorder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recorder").field("passes", &self.parts.passes).finish_non_exhaustive()
    }
}

impl Device {
    /// Begins a recording.
    ///
    /// # Errors
    /// When the device is lost or out of memory.
    pub fn recorder(&self, timing: Timing) -> Result<Recorder> {
        self.shared.check_alive()?;
        let (device, raw) = (&self.shared, &self.shared.raw);
        let capabilities = self.capabilities();
        let timing = match timing {
            Timing::Statistics if !capabilities.pipeline_statistics => Timing::Stamps,
            timing => timing,
        };
        let timing = if capabilities.timestamps { timing } else { Timing::Off };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(device.facts.queue_family);
        // SAFETY: the device is open; so for all calls below.
        let pool = unsafe { raw.create_command_pool(&info, None) }
            .map_err(|result| device.failure(result, "make a command pool", || None))?;
        let mut parts = RecordingParts {
            device: device.clone(),
            pool,
            commands: vk::CommandBuffer::null(),
            descriptor_pools: Vec::new(),
            stamps: None,
            statistics: None,
            breadcrumbs: None,
            passes: Vec::new(),
            buffers: Vec::new(),
            images: Vec::new(),
            pipelines: Vec::new(),
        };
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: the pool was just made.
        let commands = unsafe { raw.allocate_command_buffers(&info) }
            .map_err(|result| device.failure(result, "make a command buffer", || None))?;
        parts.commands = commands[0];
        let query_pool = |kind, count: usize| {
            let info =
                vk::QueryPoolCreateInfo::default().query_type(kind).query_count(count as u32).pipeline_statistics(
                    vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS
                        | vk::QueryPipelineStatisticFlags::CLIPPING_PRIMITIVES
                        | vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS
                        | vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS,
                );
            // SAFETY: the statistics are asked for only where the feature is on.
            unsafe { raw.create_query_pool(&info, None) }
                .map_err(|result| device.failure(result, "make queries", || None))
        };
        if timing != Timing::Off {
            parts.stamps = Some(query_pool(vk::QueryType::TIMESTAMP, 2 * MOST_PASSES)?);
        }
        if timing == Timing::Statistics {
            parts.statistics = Some(query_pool(vk::QueryType::PIPELINE_STATISTICS, MOST_PASSES)?);
        }
        if device.settings.breadcrumbs {
            parts.breadcrumbs = Some(self.buffer::<u32>("breadcrumbs", MOST_PASSES, Memory::Readback)?);
        }
        // SAFETY: the command buffer is new.
        unsafe { raw.begin_command_buffer(parts.commands, &vk::CommandBufferBeginInfo::default()) }
            .map_err(|result| device.failure(result, "begin a command buffer", || None))?;
        // SAFETY: recording; the pools have as many queries.
        unsafe {
            if let Some(stamps) = parts.stamps {
                raw.cmd_reset_query_pool(parts.commands, stamps, 0, 2 * MOST_PASSES as u32);
            }
            if let Some(statistics) = parts.statistics {
                raw.cmd_reset_query_pool(parts.commands, statistics, 0, MOST_PASSES as u32);
            }
        }
        let recorder = Recorder {
            device: self.clone(),
            parts,
            timing,
            hazards: Hazards::default(),
            layouts: HashMap::new(),
            sets: HashMap::new(),
            sets_left: 0,
            kept: std::collections::HashSet::new(),
        };
        // What ran before, this recording's own last run included, comes first.
        recorder.barrier(&[]);
        Ok(recorder)
    }

    /// Brings a new image into the layout that recordings expect.
    pub(super) fn settle(&self, image: &Image) -> Result<()> {
        let mut recorder = self.recorder(Timing::Off)?;
        let transition = recorder.transition(image, vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
        recorder.barrier(&[transition]);
        recorder.keep_image(image);
        recorder.finish()?.run()
    }
}

impl Recorder {
    /// A pass of compute work. Its dispatches run side by side unless one needs another's results.
    ///
    /// # Errors
    /// When a binding is missing or of the wrong kind, the push constants have another size, there are more workgroups than
    /// the device allows, or it is out of descriptors.
    pub fn compute(&mut self, name: &str, dispatches: &[Dispatch<'_>]) -> Result<()> {
        self.begin(name)?;
        for dispatch in dispatches {
            self.dispatch(name, dispatch)?;
        }
        self.end();
        Ok(())
    }

    fn dispatch(&mut self, name: &str, dispatch: &Dispatch<'_>) -> Result<()> {
        let mut uses = uses(dispatch.bindings);
        if let Groups::Indirect(buffer, _) = dispatch.groups {
            uses.push(Use { resource: buffer_id(buffer), writes: false });
            self.keep_buffer(buffer);
        }
        self.wait_for(&uses, &self.readable(dispatch.bindings));
        self.bind(name, dispatch.pipeline, dispatch.bindings, dispatch.push)?;
        let raw = &self.device.shared.raw;
        match dispatch.groups {
            Groups::Count([x, y, z]) => {
                let limit = self.device.capabilities().max_groups;
                ensure!(
                    x <= limit && y <= 65535 && z <= 65535,
                    "the pass {name} wants {x} x {y} x {z} workgroups, and this device allows {limit} x 65535 x 65535"
                );
                // SAFETY: recording, with a pipeline, its sets and push constants bound.
                unsafe { raw.cmd_dispatch(self.parts.commands, x, y, z) };
            }
            Groups::Indirect(buffer, offset) => {
                ensure!(
                    offset % 4 == 0 && offset + 12 <= buffer.size(),
                    "the pass {name} reads its workgroup count at byte {offset} of {}, which has {}",
                    buffer.name(),
                    buffer.size()
                );
                // SAFETY: as above; the three words lie inside of the buffer.
                unsafe { raw.cmd_dispatch_indirect(self.parts.commands, buffer.shared.handle, offset) };
            }
        }
        Ok(())
    }

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
        let mut all = self.uses_of(draws);
        let mut layouts: Vec<(Image, vk::ImageLayout)> = Vec::new();
        for draw in draws {
            layouts.extend(self.readable(draw.bindings));
        }
        all.push(Use { resource: image_id(colour), writes: true });
        layouts.push((colour.clone(), vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL));
        self.keep_image(colour);
        if let Some((depth, _)) = target.depth {
            all.push(Use { resource: image_id(depth), writes: true });
            layouts.push((depth.clone(), vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL));
            self.keep_image(depth);
        }
        self.wait_for(&all, &layouts);
        let sets = self.prepare(name, draws)?;
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
        let mut all = self.uses_of(draws);
        all.push(Use { resource: buffer_id(buffer), writes: true });
        self.keep_buffer(buffer);
        let layouts: Vec<_> = draws.iter().flat_map(|draw| self.readable(draw.bindings)).collect();
        self.wait_for(&all, &layouts);
        let sets = self.prepare(name, draws)?;
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

    /// A pass that copies bytes between buffers.
    ///
    /// # Errors
    /// When a range leaves its buffer.
    pub fn copy(&mut self, name: &str, from: (&Buffer, u64), to: (&Buffer, u64), bytes: u64) -> Result<()> {
        for (buffer, offset) in [from, to] {
            ensure!(
                offset.saturating_add(bytes) <= buffer.size(),
                "the pass {name} copies {bytes} bytes from byte {offset} of {}, which has {}",
                buffer.name(),
                buffer.size()
            );
        }
        self.begin(name)?;
        let uses =
            [Use { resource: buffer_id(from.0), writes: false }, Use { resource: buffer_id(to.0), writes: true }];
        self.wait_for(&uses, &[]);
        self.keep_buffer(from.0);
        self.keep_buffer(to.0);
        let region = [vk::BufferCopy { src_offset: from.1, dst_offset: to.1, size: bytes }];
        // SAFETY: recording; both ranges lie inside of their buffers.
        unsafe {
            self.device.shared.raw.cmd_copy_buffer(
                self.parts.commands,
                from.0.shared.handle,
                to.0.shared.handle,
                &region,
            );
        }
        self.end();
        Ok(())
    }

    /// A pass that sets every word of a buffer.
    ///
    /// # Errors
    /// None of its own; those of beginning a pass.
    pub fn fill(&mut self, name: &str, buffer: &Buffer, word: u32) -> Result<()> {
        self.begin(name)?;
        self.wait_for(&[Use { resource: buffer_id(buffer), writes: true }], &[]);
        self.keep_buffer(buffer);
        // SAFETY: recording; the whole buffer is a multiple of four bytes long.
        unsafe {
            self.device.shared.raw.cmd_fill_buffer(self.parts.commands, buffer.shared.handle, 0, vk::WHOLE_SIZE, word);
        }
        self.end();
        Ok(())
    }

    /// A pass that copies part of an image (left, top, width, height) to a buffer, rows one after the other.
    ///
    /// # Errors
    /// When the part leaves the image, or does not fit the buffer.
    pub fn read_image(&mut self, name: &str, image: &Image, area: [u32; 4], to: (&Buffer, u64)) -> Result<()> {
        self.copy_image(name, image, area, to, true)
    }

    /// A pass that copies rows of a buffer to part of an image (left, top, width, height).
    ///
    /// # Errors
    /// As [`Self::read_image`].
    pub fn write_image(&mut self, name: &str, image: &Image, area: [u32; 4], from: (&Buffer, u64)) -> Result<()> {
        self.copy_image(name, image, area, from, false)
    }

    fn copy_image(
        &mut self,
        name: &str,
        image: &Image,
        area: [u32; 4],
        (buffer, offset): (&Buffer, u64),
        reads: bool,
    ) -> Result<()> {
        let [left, top, width, height] = area;
        let [w, h] = image.size();
        let bytes = u64::from(width) * u64::from(height) * image.format().bytes();
        ensure!(
            left.saturating_add(width) <= w && top.saturating_add(height) <= h && width > 0 && height > 0,
            "the pass {name} copies {width}x{height} pixels at {left}, {top} of {}, which has {w}x{h}",
            image.name()
        );
        ensure!(
            offset % 4 == 0 && offset.saturating_add(bytes) <= buffer.size(),
            "the pass {name} copies {bytes} bytes at byte {offset} of {}, which has {}",
            buffer.name(),
            buffer.size()
        );
        self.begin(name)?;
        let uses =
            [Use { resource: image_id(image), writes: !reads }, Use { resource: buffer_id(buffer), writes: reads }];
        let layout = if reads { vk::ImageLayout::TRANSFER_SRC_OPTIMAL } else { vk::ImageLayout::TRANSFER_DST_OPTIMAL };
        self.wait_for(&uses, &[(image.clone(), layout)]);
        self.keep_buffer(buffer);
        self.keep_image(image);
        let region = [vk::BufferImageCopy {
            buffer_offset: offset,
            image_subresource: vk::ImageSubresourceLayers {
                aspect_mask: image.format().aspect(),
                layer_count: 1,
                ..Default::default()
            },
            image_offset: vk::Offset3D { x: left as i32, y: top as i32, z: 0 },
            image_extent: vk::Extent3D { width, height, depth: 1 },
            ..Default::default()
        }];
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        // SAFETY: recording; the region lies inside of the image and the buffer, and the image is in the layout named.
        unsafe {
            if reads {
                raw.cmd_copy_image_to_buffer(commands, image.shared.handle, layout, buffer.shared.handle, &region);
            } else {
                raw.cmd_copy_buffer_to_image(commands, buffer.shared.handle, image.shared.handle, layout, &region);
            }
        }
        self.end();
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// When the driver fails to finish it.
    pub fn finish(self) -> Result<Recording> {
        // Images go back to where the next recording, or the next run of this one, expects them.
        let back: Vec<_> = self
            .layouts
            .values()
            .filter(|(_, layout)| *layout != vk::ImageLayout::GENERAL)
            .map(|(image, layout)| self.transition(image, *layout, vk::ImageLayout::GENERAL))
            .collect();
        // The host may read what was written once the run is over.
        self.barrier(&back);
        // SAFETY: recording.
        unsafe { self.device.shared.raw.end_command_buffer(self.parts.commands) }
            .map_err(|result| self.device.shared.failure(result, "finish a command buffer", || None))?;
        Ok(Recording { device: self.device, parts: Some(self.parts), submitted: 0 })
    }

    fn begin(&mut self, name: &str) -> Result<()> {
        let pass = self.parts.passes.len();
        ensure!(pass < MOST_PASSES, "a recording holds at most {MOST_PASSES} passes");
        self.parts.passes.push(name.to_string());
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        if let Some(debug) = &self.device.shared.debug
            && let Ok(label) = CString::new(name)
        {
            // SAFETY: recording; the label lives through the call.
            unsafe {
                debug.cmd_begin_debug_utils_label(commands, &vk::DebugUtilsLabelEXT::default().label_name(&label));
            }
        }
        // SAFETY: recording; the buffer has a word and the pools have queries for every pass.
        unsafe {
            if let Some(breadcrumbs) = &self.parts.breadcrumbs {
                raw.cmd_fill_buffer(commands, breadcrumbs.shared.handle, 4 * pass as u64, 4, 1);
            }
            if let Some(stamps) = self.parts.stamps {
                let all = vk::PipelineStageFlags2::ALL_COMMANDS;
                raw.cmd_write_timestamp2(commands, all, stamps, 2 * pass as u32);
            }
            if let Some(statistics) = self.parts.statistics {
                raw.cmd_begin_query(commands, statistics, pass as u32, vk::QueryControlFlags::empty());
            }
        }
        Ok(())
    }

    fn end(&mut self) {
        let pass = self.parts.passes.len() as u32 - 1;
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        // SAFETY: as in `begin`, which began the query and the label.
        unsafe {
            if let Some(statistics) = self.parts.statistics {
                raw.cmd_end_query(commands, statistics, pass);
            }
            if let Some(stamps) = self.parts.stamps {
                let all = vk::PipelineStageFlags2::ALL_COMMANDS;
                raw.cmd_write_timestamp2(commands, all, stamps, 2 * pass + 1);
            }
            if let Some(debug) = &self.device.shared.debug {
                debug.cmd_end_debug_utils_label(commands);
            }
        }
    }

    /// Inserts the barrier that a pass of these uses needs, if any, and brings images into the layouts it wants.
    fn wait_for(&mut self, uses: &[Use], layouts: &[(Image, vk::ImageLayout)]) {
        let mut transitions = Vec::new();
        for (image, wanted) in layouts {
            let id = image_id(image);
            let now = self.layouts.get(&id).map_or(vk::ImageLayout::GENERAL, |(_, layout)| *layout);
            if now != *wanted {
                transitions.push(self.transition(image, now, *wanted));
                self.layouts.insert(id, (image.clone(), *wanted));
            }
        }
        let conflict = self.hazards.must_wait(uses);
        if conflict || !transitions.is_empty() {
            if !conflict {
                self.hazards.clear();
                self.hazards.must_wait(uses);
            }
            self.barrier(&transitions);
        }
    }

    fn transition(
        &self,
        image: &Image,
        from: vk::ImageLayout,
        to: vk::ImageLayout,
    ) -> vk::ImageMemoryBarrier2<'static> {
        vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image.shared.handle)
            .subresource_range(whole(image.format()))
    }

    /// One global barrier: everything before happens before everything after, the host's reads after the run included.
    fn barrier(&self, images: &[vk::ImageMemoryBarrier2<'static>]) {
        let memory = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(
                vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE | vk::AccessFlags2::HOST_READ,
            )];
        let info = vk::DependencyInfo::default().memory_barriers(&memory).image_memory_barriers(images);
        // SAFETY: recording, outside of rendering; the images live as long as the recording.
        unsafe { self.device.shared.raw.cmd_pipeline_barrier2(self.parts.commands, &info) };
    }

    /// The images among `bindings`, in the layout that stages read and write them in.
    fn readable(&self, bindings: &[Binding<'_>]) -> Vec<(Image, vk::ImageLayout)> {
        bindings
            .iter()
            .filter_map(|binding| match binding.bound {
                Bound::Image(image) => Some((image.clone(), vk::ImageLayout::GENERAL)),
                Bound::Buffer(_) => None,
            })
            .collect()
    }

    fn uses_of(&mut self, draws: &[Draw<'_>]) -> Vec<Use> {
        let mut all = Vec::new();
        for draw in draws {
            all.extend(uses(draw.bindings));
            if let Some(indices) = draw.indices {
                all.push(Use { resource: buffer_id(indices), writes: false });
                self.keep_buffer(indices);
            }
            if let Some((counts, _)) = draw.indirect {
                all.push(Use { resource: buffer_id(counts), writes: false });
                self.keep_buffer(counts);
            }
        }
        all
    }

    /// Descriptor sets of all draws, written before rendering begins.
    fn prepare(&mut self, name: &str, draws: &[Draw<'_>]) -> Result<Vec<Vec<vk::DescriptorSet>>> {
        draws
            .iter()
            .map(|draw| {
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
                self.descriptor_sets(name, draw.pipeline, draw.bindings)
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

    fn bind(&mut self, name: &str, pipeline: &Pipeline, bindings: &[Binding<'_>], push: &[u8]) -> Result<()> {
        check_push(name, pipeline, push)?;
        self.keep_pipeline(pipeline);
        let sets = self.descriptor_sets(name, pipeline, bindings)?;
        self.bind_sets(pipeline, &sets, push);
        Ok(())
    }

    fn bind_sets(&self, pipeline: &Pipeline, sets: &[vk::DescriptorSet], push: &[u8]) {
        let (raw, commands, pipeline) = (&self.device.shared.raw, self.parts.commands, &pipeline.shared);
        // SAFETY: recording; the sets were made for the pipeline's layouts and the push constants have its size.
        unsafe {
            raw.cmd_bind_pipeline(commands, pipeline.bind_point, pipeline.handle);
            if !sets.is_empty() {
                raw.cmd_bind_descriptor_sets(commands, pipeline.bind_point, pipeline.layout, 0, sets, &[]);
            }
            if !push.is_empty() {
                raw.cmd_push_constants(commands, pipeline.layout, pipeline.push_stages, 0, push);
            }
        }
    }

    /// The descriptor sets of a pipeline with these bindings; the same ones for the same resources.
    fn descriptor_sets(
        &mut self,
        name: &str,
        pipeline: &Pipeline,
        bindings: &[Binding<'_>],
    ) -> Result<Vec<vk::DescriptorSet>> {
        let mut sets = Vec::new();
        for (number, &layout) in pipeline.shared.set_layouts.iter().enumerate() {
            let mut bound = Vec::new();
            for &(set, slot, kind, variable) in &pipeline.shared.slots {
                if set as usize != number {
                    continue;
                }
                let Some(binding) =
                    bindings.iter().find(|binding| (binding.layout.set, binding.layout.binding) == (set, slot))
                else {
                    bail!("the pass {name} binds nothing to {variable} of {}", pipeline.name());
                };
                let is_buffer = matches!(kind, BindingKind::StorageBuffer | BindingKind::UniformBuffer);
                ensure!(
                    is_buffer == matches!(binding.bound, Bound::Buffer(_)),
                    "the pass {name} binds the wrong kind of resource to {variable} of {}",
                    pipeline.name()
                );
                bound.push((slot, kind, binding.bound));
            }
            let key = (layout, bound.iter().map(|(slot, _, bound)| (*slot, id(bound))).collect());
            for (_, _, bound) in &bound {
                match bound {
                    Bound::Buffer(buffer) => self.keep_buffer(buffer),
                    Bound::Image(image) => self.keep_image(image),
                }
            }
            if let Some(&set) = self.sets.get(&key) {
                sets.push(set);
                continue;
            }
            let set = self.new_set(layout)?;
            for &(slot, kind, bound) in &bound {
                let buffer = match bound {
                    Bound::Buffer(buffer) => {
                        [vk::DescriptorBufferInfo { buffer: buffer.shared.handle, offset: 0, range: vk::WHOLE_SIZE }]
                    }
                    Bound::Image(_) => [vk::DescriptorBufferInfo::default()],
                };
                let image = match bound {
                    Bound::Image(image) => [vk::DescriptorImageInfo {
                        image_view: image.read_view(),
                        image_layout: vk::ImageLayout::GENERAL,
                        ..Default::default()
                    }],
                    Bound::Buffer(_) => [vk::DescriptorImageInfo::default()],
                };
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(slot)
                    .descriptor_type(descriptor_type(kind));
                let write = match bound {
                    Bound::Buffer(_) => write.buffer_info(&buffer),
                    Bound::Image(_) => write.image_info(&image),
                };
                // SAFETY: the set is new and of the layout; what is bound lives as long as the recording.
                unsafe { self.device.shared.raw.update_descriptor_sets(&[write], &[]) };
            }
            self.sets.insert(key, set);
            sets.push(set);
        }
        Ok(sets)
    }

    fn new_set(&mut self, layout: vk::DescriptorSetLayout) -> Result<vk::DescriptorSet> {
        let device = self.device.shared.clone();
        if self.sets_left == 0 {
            let sizes = [
                (vk::DescriptorType::STORAGE_BUFFER, 12),
                (vk::DescriptorType::UNIFORM_BUFFER, 2),
                (vk::DescriptorType::SAMPLED_IMAGE, 4),
                (vk::DescriptorType::STORAGE_IMAGE, 4),
            ]
            .map(|(ty, a_set)| vk::DescriptorPoolSize { ty, descriptor_count: a_set * SETS_A_POOL });
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(SETS_A_POOL).pool_sizes(&sizes);
            // SAFETY: the device is open.
            let pool = unsafe { device.raw.create_descriptor_pool(&info, None) }
                .map_err(|result| device.failure(result, "make descriptors", || None))?;
            self.parts.descriptor_pools.push(pool);
            self.sets_left = SETS_A_POOL;
        }
        let layouts = [layout];
        let pool = self.parts.descriptor_pools.last().copied().unwrap_or_default();
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool has a set left, and descriptors for the largest stage.
        let sets = unsafe { device.raw.allocate_descriptor_sets(&info) }
            .map_err(|result| device.failure(result, "make a descriptor set", || None))?;
        self.sets_left -= 1;
        Ok(sets[0])
    }

    fn keep_buffer(&mut self, buffer: &Buffer) {
        if self.kept.insert(buffer_id(buffer)) {
            self.parts.buffers.push(buffer.clone());
        }
    }

    fn keep_image(&mut self, image: &Image) {
        if self.kept.insert(image_id(image)) {
            self.parts.images.push(image.clone());
        }
    }

    fn keep_pipeline(&mut self, pipeline: &Pipeline) {
        if !self.parts.pipelines.iter().any(|kept| kept.shared.handle == pipeline.shared.handle) {
            self.parts.pipelines.push(pipeline.clone());
        }
    }

    /// Loses track of what was written, so that a test can plant a hazard.
    #[cfg(test)]
    pub(super) fn forget_hazards(&mut self) {
        self.hazards.clear();
    }

    /// What this recording measures, as far as the device can.
    pub fn timing(&self) -> Timing {
        self.timing
    }
}

fn check_push(name: &str, pipeline: &Pipeline, push: &[u8]) -> Result<()> {
    ensure!(
        push.len() as u32 == pipeline.shared.push_size,
        "the pass {name} pushes {} bytes, and {} takes {}",
        push.len(),
        pipeline.name(),
        pipeline.shared.push_size
    );
    Ok(())
}

fn uses(bindings: &[Binding<'_>]) -> Vec<Use> {
    bindings
        .iter()
        .map(|binding| Use { resource: id(&binding.bound), writes: binding.layout.access != Access::Read })
        .collect()
}

fn id(bound: &Bound<'_>) -> u64 {
    match bound {
        Bound::Buffer(buffer) => buffer_id(buffer),
        Bound::Image(image) => image_id(image),
    }
}

/// Handles of buffers and images may have the same value; their last bit tells the two apart.
fn buffer_id(buffer: &Buffer) -> u64 {
    buffer.shared.handle.as_raw() << 1
}

fn image_id(image: &Image) -> u64 {
    image.shared.handle.as_raw() << 1 | 1
}

fn rectangle([x, y, width, height]: [u32; 4]) -> vk::Rect2D {
    vk::Rect2D { offset: vk::Offset2D { x: x as i32, y: y as i32 }, extent: vk::Extent2D { width, height } }
}
