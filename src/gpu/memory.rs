//! Memory of resources, within the device's budget.

use std::sync::atomic::Ordering;

use anyhow::{Result, anyhow};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::device_shared::DeviceShared;
use super::lock::lock;
use super::loss::OutOfMemory;

/// Where a buffer lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// With the device; the host cannot see it.
    Device,
    /// Written by the host, read by the device.
    Upload,
    /// Written by the device, read by the host.
    Readback,
}

impl Memory {
    fn location(self) -> MemoryLocation {
        match self {
            Self::Device => MemoryLocation::GpuOnly,
            Self::Upload => MemoryLocation::CpuToGpu,
            Self::Readback => MemoryLocation::GpuToCpu,
        }
    }
}

impl DeviceShared {
    /// As [`super::Device::memory_available`].
    pub(super) fn memory_available(&self) -> u64 {
        let own = self.facts.capabilities.memory.saturating_sub(self.memory_used.load(Ordering::Relaxed));
        if !self.facts.has_memory_budget {
            return own;
        }
        let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
        let mut properties = vk::PhysicalDeviceMemoryProperties2::default().push_next(&mut budget);
        // SAFETY: the handle belongs to the instance, and the device has the extension.
        unsafe {
            self.instance.shared.raw.get_physical_device_memory_properties2(self.facts.handle, &mut properties);
        }
        let memory = properties.memory_properties;
        let free = (0..memory.memory_heap_count as usize)
            .filter(|&heap| memory.memory_heaps[heap].flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
            .map(|heap| budget.heap_budget[heap].saturating_sub(budget.heap_usage[heap]))
            .max()
            .unwrap_or(own);
        own.min(free)
    }

    /// Memory for a resource called `name`.
    pub(super) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        memory: Memory,
        linear: bool,
    ) -> Result<Allocation> {
        let (asked, available) = (requirements.size, self.memory_available());
        let too_much = || OutOfMemory { resource: name.to_string(), asked, available: available.min(asked / 2) };
        if asked > available {
            return Err(OutOfMemory { resource: name.to_string(), asked, available }.into());
        }
        let mut allocator = lock(&self.allocator);
        let Some(allocator) = allocator.as_mut() else { return Err(anyhow!("the device is being closed")) };
        let allocation = allocator
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location: memory.location(),
                linear,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|error| match error {
                gpu_allocator::AllocationError::OutOfMemory => anyhow::Error::from(too_much()),
                error => anyhow!("no memory for {name} on the Vulkan device ({error})"),
            })?;
        self.memory_used.fetch_add(allocation.size(), Ordering::Relaxed);
        Ok(allocation)
    }

    pub(super) fn free(&self, allocation: Allocation) {
        self.memory_used.fetch_sub(allocation.size(), Ordering::Relaxed);
        if let Some(allocator) = lock(&self.allocator).as_mut() {
            // Freeing what this allocator has given out does not fail.
            let _ = allocator.free(allocation);
        }
    }
}
