//! The one way to run anything: passes are recorded with their label, breadcrumb, timestamps and the barriers they need.

use std::collections::{HashMap, HashSet};
use std::ffi::CString;
use std::sync::atomic::Ordering;

use anyhow::{Result, bail, ensure};
use ash::vk;

use super::buffer::Buffer;
use super::descriptors::Descriptors;
use super::device::Device;
use super::hazards::{Hazards, Stages, Use};
use super::image::Image;
use super::lanes::MAIN;
use super::marks::Marks;
use super::memory::Memory;
use super::pass::{Dispatch, Groups};
use super::pipeline::{Pipeline, Resource, uses, with_counters};
use super::recording::{Counters, Recording, RecordingParts};
use super::shader::Bound;
use super::timing::Timing;

/// Most passes of a recording: its queries and breadcrumbs are made for so many.
pub(super) const MOST_PASSES: usize = 16_384;

/// A sequence of passes being recorded.
pub struct Recorder {
    pub(super) device: Device,
    pub(super) parts: RecordingParts,
    timing: Timing,
    pub(super) hazards: Hazards,
    /// First pass of the submission that is being recorded.
    first_pass: usize,
    /// Whether the pass that is being recorded has left its mark.
    is_marked: bool,
    /// Layouts of images that are not in GENERAL.
    pub(super) layouts: HashMap<u64, (Image, vk::ImageLayout)>,
    descriptors: Descriptors,
    kept: HashSet<u64>,
    /// Barriers between passes so far.
    #[cfg(test)]
    pub(super) barriers: usize,
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
        let own = device.lanes.of(self.lane);
        let timing = match timing {
            // Queues of other families may be of other kinds.
            Timing::Statistics if self.lane != MAIN => Timing::Stamps,
            timing => timing,
        };
        let has_stamps = capabilities.timestamps && own.timestamp_bits >= capabilities.timestamp_bits;
        let timing = if has_stamps { timing } else { Timing::Off };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(own.family);
        // SAFETY: the device is open; so for all calls below.
        let pool = unsafe { raw.create_command_pool(&info, None) }
            .map_err(|result| device.failure(result, "make a command pool", || None))?;
        let mut parts = RecordingParts {
            device: device.clone(),
            number: device.recordings.fetch_add(1, Ordering::Relaxed),
            pool,
            commands: vk::CommandBuffer::null(),
            ended: Vec::new(),
            descriptor_pools: Vec::new(),
            stamps: None,
            statistics: None,
            breadcrumbs: None,
            passes: Vec::new(),
            counters: Vec::new(),
            buffers: Vec::new(),
            images: Vec::new(),
            pipelines: Vec::new(),
        };
        let counted = if capabilities.graphics {
            vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS
                | vk::QueryPipelineStatisticFlags::CLIPPING_PRIMITIVES
                | vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS
                | vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS
        } else {
            vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS
        };
        let query_pool = |kind, count: usize| {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(kind)
                .query_count(count as u32)
                .pipeline_statistics(counted);
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
        if device.leaves_breadcrumbs() {
            parts.breadcrumbs = Some(self.buffer::<u32>("breadcrumbs", MOST_PASSES, Memory::Readback)?);
        }
        parts.begin_commands()?;
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
            first_pass: 0,
            is_marked: false,
            layouts: HashMap::new(),
            descriptors: Descriptors::default(),
            kept: HashSet::new(),
            #[cfg(test)]
            barriers: 0,
        };
        // What ran before, this recording's own last run included, comes first.
        recorder.full_barrier(&[]);
        Ok(recorder)
    }

    /// Brings a new image into the layout that recordings expect.
    pub(super) fn settle(&self, image: &Image) -> Result<()> {
        let mut recorder = self.recorder(Timing::Off)?;
        let transition = recorder.transition(image, vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
        recorder.full_barrier(&[transition]);
        recorder.keep_image(image);
        recorder.finish()?.run()
    }
}

impl Recorder {
    /// A pass that runs a compute stage once, named like its shader.
    ///
    /// # Errors
    /// As [`Self::compute`].
    pub fn run(&mut self, dispatch: Dispatch<'_>) -> Result<()> {
        self.run_all([dispatch])
    }

    /// A pass that runs a compute stage side by side on several sets of resources, named like its shader; none for no dispatch.
    ///
    /// # Errors
    /// As [`Self::compute`].
    pub fn run_all<'a>(&mut self, dispatches: impl IntoIterator<Item = Dispatch<'a>>) -> Result<()> {
        let dispatches: Vec<_> = dispatches.into_iter().collect();
        dispatches.first().map_or(Ok(()), |first| self.compute(first.stage.shader.label(), &dispatches))
    }

    /// A pass of compute work under a name of its own. Its dispatches run side by side unless one needs another's results.
    ///
    /// # Errors
    /// When a stage does not compile, a binding is missing or of the wrong kind, the push constants have another size, there are
    /// more workgroups than the device allows, or it is out of descriptors.
    pub fn compute(&mut self, name: &str, dispatches: &[Dispatch<'_>]) -> Result<()> {
        self.begin(name)?;
        for dispatch in dispatches {
            self.dispatch(name, dispatch)?;
        }
        self.end();
        Ok(())
    }

    fn dispatch(&mut self, name: &str, dispatch: &Dispatch<'_>) -> Result<()> {
        let pipeline = self.device.compute_pipeline(&dispatch.stage)?;
        let counters = self.counters(&pipeline)?;
        let bindings = with_counters(&dispatch.bindings, counters.as_ref());
        let resources = pipeline.resources(name, &bindings)?;
        check_push(name, &pipeline, &dispatch.push)?;
        let mut uses: Vec<_> = uses(&resources).collect();
        let mut stages = Stages::COMPUTE;
        if let Groups::Indirect(buffer, _) = dispatch.groups {
            uses.push(Use { resource: buffer.id(), writes: false });
            self.keep_buffer(buffer);
            stages |= Stages::INDIRECT;
        }
        self.wait_for(&uses, &readable(&resources), stages);
        self.keep_pipeline(&pipeline);
        let sets = self.descriptor_sets(&pipeline, &resources)?;
        self.bind_sets(&pipeline, &sets, &dispatch.push);
        let raw = &self.device.shared.raw;
        match (dispatch.groups, dispatch.groups.count(dispatch.stage.workgroup_size())) {
            (_, Some([x, y, z])) => {
                let limit = self.device.capabilities().max_groups;
                ensure!(
                    x <= limit && y <= Groups::ROW && z <= Groups::ROW,
                    "the pass {name} wants {x} x {y} x {z} workgroups, and this device allows {limit} x {row} x {row}",
                    row = Groups::ROW
                );
                // SAFETY: recording, with a pipeline, its sets and push constants bound.
                unsafe { raw.cmd_dispatch(self.parts.commands, x, y, z) };
            }
            (Groups::Indirect(buffer, offset), _) => {
                ensure!(
                    offset % 4 == 0 && offset + 12 <= buffer.size(),
                    "the pass {name} reads its workgroup count at byte {offset} of {}, which has {}",
                    buffer.name(),
                    buffer.size()
                );
                // SAFETY: as above; the three words lie inside of the buffer.
                unsafe { raw.cmd_dispatch_indirect(self.parts.commands, buffer.shared.handle, offset) };
            }
            (_, None) => {}
        }
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// When the driver fails to finish it, or it uses an image and is for a second queue.
    pub fn finish(self) -> Result<Recording> {
        if let Some(image) = self.parts.images.first().filter(|_| self.device.lane != MAIN) {
            bail!(
                "the image {} stays with the device's first queue, and a pass is recorded for the second",
                image.name()
            );
        }
        // Images go back to where the next recording, or the next run of this one, expects them.
        let back: Vec<_> = self
            .layouts
            .values()
            .filter(|(_, layout)| *layout != vk::ImageLayout::GENERAL)
            .map(|(image, layout)| self.transition(image, *layout, vk::ImageLayout::GENERAL))
            .collect();
        if !back.is_empty() {
            self.full_barrier(&back);
        }
        // The host may read what was written once the run is over.
        let memory = vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ);
        self.depend(memory, &[]);
        self.parts.end_commands()?;
        Ok(Recording {
            device: self.device,
            parts: Some(self.parts),
            submitted: 0,
            #[cfg(test)]
            barriers: self.barriers,
        })
    }

    pub(super) fn begin(&mut self, name: &str) -> Result<()> {
        let pass = self.parts.passes.len();
        ensure!(pass < MOST_PASSES, "a recording holds at most {MOST_PASSES} passes");
        if pass >= self.first_pass + self.device.shared.passes_a_submission() {
            // Barriers hold over submissions of a queue too, so nothing else changes.
            self.parts.end_commands()?;
            self.parts.ended.push(self.parts.commands);
            self.parts.begin_commands()?;
            self.first_pass = pass;
        }
        self.parts.passes.push(name.to_string());
        self.is_marked = false;
        let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
        if let Some(debug) = &self.device.shared.debug
            && let Ok(label) = CString::new(name)
        {
            // SAFETY: recording; the label lives through the call.
            unsafe {
                debug.cmd_begin_debug_utils_label(commands, &vk::DebugUtilsLabelEXT::default().label_name(&label));
            }
        }
        // SAFETY: recording; the pools have queries for every pass.
        unsafe {
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

    pub(super) fn end(&mut self) {
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

    /// Leaves the breadcrumb of the pass that is being recorded, once.
    pub(super) fn mark(&mut self) {
        if std::mem::replace(&mut self.is_marked, true) {
            return;
        }
        let pass = self.parts.passes.len() - 1;
        let (device, commands) = (&self.device.shared, self.parts.commands);
        if let Some(marks) = &device.marks {
            marks.set_checkpoint(commands, self.parts.number, pass);
        }
        let Some(breadcrumbs) = &self.parts.breadcrumbs else { return };
        let (buffer, place) = (breadcrumbs.shared.handle, 4 * pass as u64);
        // SAFETY: recording, outside of rendering; the buffer has a word for every pass.
        unsafe {
            match &device.marks {
                Some(Marks::Words(functions)) => {
                    functions.cmd_write_buffer_marker(commands, vk::PipelineStageFlags::TOP_OF_PIPE, buffer, place, 1);
                }
                _ => device.raw.cmd_fill_buffer(commands, buffer, place, 4, 1),
            }
        }
    }

    /// The descriptor sets of a pipeline with these resources, which are kept alive.
    pub(super) fn descriptor_sets(
        &mut self,
        pipeline: &Pipeline,
        resources: &[Resource<'_>],
    ) -> Result<Vec<vk::DescriptorSet>> {
        for (_, bound) in resources {
            match bound {
                Bound::Buffer(buffer) => self.keep_buffer(buffer),
                Bound::Image(image) => self.keep_image(image),
            }
        }
        self.descriptors.of(&mut self.parts, pipeline, resources)
    }

    pub(super) fn bind_sets(&self, pipeline: &Pipeline, sets: &[vk::DescriptorSet], push: &[u8]) {
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

    /// The counters of a pipeline in the pass that is being recorded; none where it does not count.
    pub(super) fn counters(&mut self, pipeline: &Pipeline) -> Result<Option<Buffer>> {
        let blocks = pipeline.shared.blocks.len();
        if blocks == 0 {
            return Ok(None);
        }
        let pass = self.parts.passes.len() - 1;
        let is_it = |one: &&Counters| one.pass == pass && one.pipeline.shared.handle == pipeline.shared.handle;
        if let Some(known) = self.parts.counters.iter().rev().find(is_it) {
            return Ok(Some(known.buffer.clone()));
        }
        let buffer = self.device.buffer::<u64>("counters", blocks, Memory::Readback)?;
        self.parts.counters.push(Counters { pass, pipeline: pipeline.clone(), buffer: buffer.clone() });
        Ok(Some(buffer))
    }

    pub(super) fn keep_buffer(&mut self, buffer: &Buffer) {
        if self.kept.insert(buffer.id()) {
            self.parts.buffers.push(buffer.clone());
        }
    }

    pub(super) fn keep_image(&mut self, image: &Image) {
        if self.kept.insert(image.id()) {
            self.parts.images.push(image.clone());
        }
    }

    pub(super) fn keep_pipeline(&mut self, pipeline: &Pipeline) {
        if !self.parts.pipelines.iter().any(|kept| kept.shared.handle == pipeline.shared.handle) {
            self.parts.pipelines.push(pipeline.clone());
        }
    }

    /// Loses track of what was written, so that a test can plant a hazard.
    #[cfg(test)]
    pub(super) fn forget_hazards(&mut self) {
        self.hazards.clear();
    }

    /// The device it is for.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// What this recording measures, as far as the device can.
    pub fn timing(&self) -> Timing {
        self.timing
    }
}

pub(super) fn check_push(name: &str, pipeline: &Pipeline, push: &[u8]) -> Result<()> {
    ensure!(
        push.len() as u32 == pipeline.shared.push_size,
        "the pass {name} pushes {} bytes, and {} takes {}",
        push.len(),
        pipeline.name(),
        pipeline.shared.push_size
    );
    Ok(())
}

/// The images among `resources`, in the layout that stages read and write them in.
pub(super) fn readable(resources: &[Resource<'_>]) -> Vec<(Image, vk::ImageLayout)> {
    resources
        .iter()
        .filter_map(|(_, bound)| match bound {
            Bound::Image(image) => Some(((*image).clone(), vk::ImageLayout::GENERAL)),
            Bound::Buffer(_) => None,
        })
        .collect()
}
