//! Descriptor sets of a recording: written once for the same resources, out of pools that grow.

use std::collections::HashMap;

use anyhow::Result;
use ash::vk;

use super::pipeline::{Pipeline, Resource, descriptor_type};
use super::recording::RecordingParts;
use super::shader::Bound;

/// Descriptor sets of a pool; a recording takes another pool when one is used up.
const SETS_A_POOL: u32 = 128;
/// Descriptors of each type that a pool holds for each of its sets: what the largest stage needs.
const DESCRIPTORS_A_SET: [(vk::DescriptorType, u32); 4] = [
    (vk::DescriptorType::STORAGE_BUFFER, 12),
    (vk::DescriptorType::UNIFORM_BUFFER, 2),
    (vk::DescriptorType::SAMPLED_IMAGE, 4),
    (vk::DescriptorType::STORAGE_IMAGE, 4),
];

/// The sets written so far. Their pools belong to the recording's parts, which outlive its run.
#[derive(Default)]
pub(super) struct Descriptors {
    /// By layout and what is bound.
    sets: HashMap<(vk::DescriptorSetLayout, Vec<(u32, u64)>), vk::DescriptorSet>,
    /// How many the newest pool still has.
    left: u32,
}

impl Descriptors {
    /// The sets of a pipeline with these resources, which the caller keeps alive; the same ones for the same resources.
    pub(super) fn of(
        &mut self,
        parts: &mut RecordingParts,
        pipeline: &Pipeline,
        resources: &[Resource<'_>],
    ) -> Result<Vec<vk::DescriptorSet>> {
        let mut sets = Vec::new();
        for (number, &layout) in (0..).zip(&pipeline.shared.set_layouts) {
            let of_set: Vec<_> = resources.iter().filter(|(slot, _)| slot.set == number).collect();
            let key = (layout, of_set.iter().map(|(slot, bound)| (slot.binding, bound.id())).collect());
            let set = match self.sets.get(&key) {
                Some(&set) => set,
                None => {
                    let set = self.allocate(parts, layout)?;
                    write(parts, set, &of_set);
                    self.sets.insert(key, set);
                    set
                }
            };
            sets.push(set);
        }
        Ok(sets)
    }

    fn allocate(&mut self, parts: &mut RecordingParts, layout: vk::DescriptorSetLayout) -> Result<vk::DescriptorSet> {
        let device = parts.device.clone();
        if self.left == 0 {
            let sizes = DESCRIPTORS_A_SET
                .map(|(ty, a_set)| vk::DescriptorPoolSize { ty, descriptor_count: a_set * SETS_A_POOL });
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(SETS_A_POOL).pool_sizes(&sizes);
            // SAFETY: the device is open.
            let pool = unsafe { device.raw.create_descriptor_pool(&info, None) }
                .map_err(|result| device.failure(result, "make descriptors", || None))?;
            parts.descriptor_pools.push(pool);
            self.left = SETS_A_POOL;
        }
        let layouts = [layout];
        let pool = parts.descriptor_pools.last().copied().unwrap_or_default();
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool has a set left, and descriptors for the largest stage.
        let sets = unsafe { device.raw.allocate_descriptor_sets(&info) }
            .map_err(|result| device.failure(result, "make a descriptor set", || None))?;
        self.left -= 1;
        Ok(sets[0])
    }
}

/// Points a new set to its resources.
fn write(parts: &RecordingParts, set: vk::DescriptorSet, resources: &[&Resource<'_>]) {
    for (slot, bound) in resources {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(slot.binding)
            .descriptor_type(descriptor_type(slot.kind));
        let (buffer, image);
        let write = match bound {
            Bound::Buffer(bound) => {
                buffer = [vk::DescriptorBufferInfo { buffer: bound.shared.handle, offset: 0, range: vk::WHOLE_SIZE }];
                write.buffer_info(&buffer)
            }
            Bound::Image(bound) => {
                image = [vk::DescriptorImageInfo {
                    image_view: bound.read_view(),
                    image_layout: vk::ImageLayout::GENERAL,
                    ..Default::default()
                }];
                write.image_info(&image)
            }
        };
        // SAFETY: the set is new and of the layout; what is bound lives as long as the recording.
        unsafe { parts.device.raw.update_descriptor_sets(&[write], &[]) };
    }
}
