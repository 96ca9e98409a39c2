//! Named buffers.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Result, anyhow, ensure};
use ash::vk;
use ash::vk::Handle as _;
use bytemuck::Pod;
use gpu_allocator::vulkan::Allocation;

use super::device_shared::DeviceShared;
use super::lanes::LastUse;
use super::memory::Memory;

/// A buffer of the device; clones are the same buffer. Its memory is freed when the last clone and the last recording that
/// uses it are gone.
#[derive(Clone)]
pub struct Buffer {
    pub(super) shared: Arc<BufferShared>,
}

pub(super) struct BufferShared {
    device: Arc<DeviceShared>,
    pub(super) name: String,
    pub(super) handle: vk::Buffer,
    size: u64,
    memory: Memory,
    allocation: Option<Allocation>,
    /// The last submissions that use it.
    pub(super) last_use: LastUse,
}

impl std::fmt::Debug for Buffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Buffer")
            .field("name", &self.shared.name)
            .field("size", &self.shared.size)
            .finish_non_exhaustive()
    }
}

impl Buffer {
    /// Makes one of `size` bytes.
    pub(super) fn new(device: &Arc<DeviceShared>, name: &str, size: u64, memory: Memory) -> Result<Self> {
        let limit = device.facts.capabilities.max_storage;
        ensure!(size > 0, "the buffer {name} would be empty");
        ensure!(
            size <= limit,
            "the buffer {name} would have {size} bytes, more than the {limit} that this device binds at once"
        );
        let mut usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::UNIFORM_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::INDEX_BUFFER;
        if device.feedback.is_some() {
            usage |= vk::BufferUsageFlags::TRANSFORM_FEEDBACK_BUFFER_EXT;
        }
        // A multiple of 4, as fills and copies of whole buffers want it.
        let mut info = vk::BufferCreateInfo::default().size(size.next_multiple_of(4)).usage(usage);
        let families = device.lanes.families();
        if families.len() > 1 {
            // Both families use it, and no device is known to gain by giving it from one to the other.
            info = info.sharing_mode(vk::SharingMode::CONCURRENT).queue_family_indices(&families);
        }
        let raw = &device.raw;
        // SAFETY: the device is open; so for the calls below.
        let handle = unsafe { raw.create_buffer(&info, None) }
            .map_err(|result| device.failure(result, &format!("make the buffer {name}"), || None))?;
        // SAFETY: the handle was just made.
        let requirements = unsafe { raw.get_buffer_memory_requirements(handle) };
        let bound = device.allocate(name, requirements, memory, true).and_then(|allocation| {
            // SAFETY: the memory fits the buffer's requirements and nothing else is bound to its range.
            match unsafe { raw.bind_buffer_memory(handle, allocation.memory(), allocation.offset()) } {
                Ok(()) => Ok(allocation),
                Err(result) => {
                    device.free(allocation);
                    Err(device.failure(result, &format!("bind memory to the buffer {name}"), || None))
                }
            }
        });
        let allocation = match bound {
            Ok(allocation) => allocation,
            Err(error) => {
                // SAFETY: nothing uses it.
                unsafe { raw.destroy_buffer(handle, None) };
                return Err(error);
            }
        };
        device.name(handle, name);
        Ok(Self {
            shared: Arc::new(BufferShared {
                device: device.clone(),
                name: name.to_string(),
                handle,
                size,
                memory,
                allocation: Some(allocation),
                last_use: LastUse::default(),
            }),
        })
    }

    /// The number that tells it from every other resource: handles of buffers and images may have the same value, and the last
    /// bit tells the two apart.
    pub(super) fn id(&self) -> u64 {
        self.shared.handle.as_raw() << 1
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// Its size in bytes.
    pub fn size(&self) -> u64 {
        self.shared.size
    }

    /// Where it lies.
    pub fn memory(&self) -> Memory {
        self.shared.memory
    }

    /// Whether it is the same buffer.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }

    /// Writes `values` from element `first` on.
    ///
    /// # Errors
    /// When the host cannot see the buffer, the values do not fit, or the device is at work with it.
    pub fn write<T: Pod>(&self, first: usize, values: &[T]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let place = self.place(first * size_of::<T>(), bytes.len())?;
        // SAFETY: `place` is mapped memory of that many bytes that the device is not using, and a host slice is elsewhere.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), place, bytes.len()) };
        Ok(())
    }

    /// Reads into `values` from element `first` on.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn read<T: Pod>(&self, first: usize, values: &mut [T]) -> Result<()> {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
        let place = self.place(first * size_of::<T>(), bytes.len())?;
        // SAFETY: as in `write`, the other way round; any bytes are a valid `T`.
        unsafe { std::ptr::copy_nonoverlapping(place, bytes.as_mut_ptr(), bytes.len()) };
        Ok(())
    }

    /// A word of a buffer that the host sees, as it is just now; the device may be writing to it.
    pub(super) fn glance(&self, word: usize) -> Option<u32> {
        let place = self.mapped().ok()?.wrapping_add(4 * word);
        // SAFETY: a mapped word inside of the buffer, aligned as buffers are, that the host only ever writes while the device
        // does not use it; an atomic load puts up with the device's stores.
        (4 * (word as u64 + 1) <= self.size())
            .then(|| unsafe { AtomicU32::from_ptr(place.cast()) }.load(Ordering::Relaxed))
    }

    /// The mapped address of a range that the device is not using.
    fn place(&self, offset: usize, length: usize) -> Result<*mut u8> {
        let shared = &self.shared;
        let end = offset.checked_add(length).filter(|&end| end as u64 <= shared.size);
        ensure!(
            end.is_some(),
            "the buffer {} has {} bytes, and bytes {offset} to {} were meant",
            shared.name,
            shared.size,
            offset.saturating_add(length)
        );
        ensure!(shared.device.has_done_all(&shared.last_use), "the device is still using the buffer {}", shared.name);
        // SAFETY: the offset lies inside of the mapped range, as checked above.
        Ok(unsafe { self.mapped()?.add(offset) })
    }

    /// The mapped address of its first byte.
    fn mapped(&self) -> Result<*mut u8> {
        let shared = &self.shared;
        let mapped =
            shared.allocation.as_ref().filter(|_| shared.memory != Memory::Device).and_then(Allocation::mapped_ptr);
        let mapped = mapped.ok_or_else(|| anyhow!("the host cannot see the buffer {}", shared.name))?;
        Ok(mapped.as_ptr().cast())
    }
}

impl Drop for BufferShared {
    fn drop(&mut self) {
        // SAFETY: recordings hold what they use until the device is done, so nothing uses the buffer any more.
        unsafe { self.device.raw.destroy_buffer(self.handle, None) };
        if let Some(allocation) = self.allocation.take() {
            self.device.free(allocation);
        }
    }
}
