//! Barriers of a recording: what a pass waits for, and the layouts that images go through.

use ash::vk;

use super::hazards::{Barrier, Stages, Use};
use super::image::{Image, whole};
use super::recorder::Recorder;

impl Recorder {
    /// Inserts the barrier that a pass of these uses in these stages needs, if any, and brings images into the layouts it wants. The
    /// pass's breadcrumb stands behind it.
    pub(super) fn wait_for(&mut self, uses: &[Use], layouts: &[(Image, vk::ImageLayout)], stages: Stages) {
        let mut transitions = Vec::new();
        for (image, wanted) in layouts {
            let id = image.id();
            let now = self.layouts.get(&id).map_or(vk::ImageLayout::GENERAL, |(_, layout)| *layout);
            if now != *wanted {
                transitions.push(self.transition(image, now, *wanted));
                self.layouts.insert(id, (image.clone(), *wanted));
            }
        }
        if !transitions.is_empty() {
            self.hazards.clear();
            self.hazards.must_wait(uses, stages);
            self.full_barrier(&transitions);
        } else if let Some(Barrier { ahead, behind }) = self.hazards.must_wait(uses, stages) {
            let (source, written, _) = ahead.scopes();
            let (destination, _, touched) = behind.scopes();
            let memory = vk::MemoryBarrier2::default()
                .src_stage_mask(source)
                .src_access_mask(written)
                .dst_stage_mask(destination)
                .dst_access_mask(touched);
            self.depend(memory, &[]);
            #[cfg(test)]
            {
                self.barriers += 1;
            }
        }
        self.mark();
    }

    pub(super) fn transition(
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

    /// Everything before happens before everything after.
    pub(super) fn full_barrier(&self, images: &[vk::ImageMemoryBarrier2<'static>]) {
        let memory = vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE);
        self.depend(memory, images);
    }

    /// One memory barrier and those of images.
    pub(super) fn depend(&self, memory: vk::MemoryBarrier2<'static>, images: &[vk::ImageMemoryBarrier2<'static>]) {
        let memory = [memory];
        let info = vk::DependencyInfo::default().memory_barriers(&memory).image_memory_barriers(images);
        // SAFETY: recording, outside of rendering; the images live as long as the recording.
        unsafe { self.device.shared.raw.cmd_pipeline_barrier2(self.parts.commands, &info) };
    }
}
