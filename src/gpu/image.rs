//! Named images of two dimensions, targets to draw into and what stages read by texel, and of three, which stages read.

use std::sync::Arc;

use anyhow::{Result, ensure};
use ash::vk;
use ash::vk::Handle as _;
use gpu_allocator::vulkan::Allocation;

use super::device_shared::DeviceShared;
use super::memory::Memory;

/// How a texel is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Four bytes, as fractions of 255.
    Rgba8,
    /// Four unsigned bytes.
    Rgba8Uint,
    /// An unsigned byte.
    R8Uint,
    /// A 32-bit unsigned integer.
    R32Uint,
    /// A 32-bit float.
    R32Float,
    /// Depth, a 32-bit float.
    Depth32,
}

impl Format {
    pub(super) fn vulkan(self) -> vk::Format {
        match self {
            Self::Rgba8 => vk::Format::R8G8B8A8_UNORM,
            Self::Rgba8Uint => vk::Format::R8G8B8A8_UINT,
            Self::R8Uint => vk::Format::R8_UINT,
            Self::R32Uint => vk::Format::R32_UINT,
            Self::R32Float => vk::Format::R32_SFLOAT,
            Self::Depth32 => vk::Format::D32_SFLOAT,
        }
    }

    pub(super) fn aspect(self) -> vk::ImageAspectFlags {
        if self == Self::Depth32 { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
    }

    /// Bytes of a texel.
    pub fn bytes(self) -> u64 {
        if self == Self::R8Uint { 1 } else { 4 }
    }
}

/// What an image is for, besides being copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageUse {
    /// Drawn into, then read by texel.
    Target,
    /// Read by texel.
    Sampled,
    /// Read and written by texel.
    Storage,
}

/// An image of the device; clones are the same image.
#[derive(Clone)]
pub struct Image {
    pub(super) shared: Arc<ImageShared>,
    /// Whether stages read it as words.
    as_words: bool,
}

pub(super) struct ImageShared {
    device: Arc<DeviceShared>,
    pub(super) name: String,
    pub(super) handle: vk::Image,
    pub(super) view: vk::ImageView,
    /// Its texels as 32-bit words, of RGBA8 targets.
    words: Option<vk::ImageView>,
    pub(super) format: Format,
    pub(super) size: [u32; 2],
    /// Slices; none of an image of two dimensions.
    slices: Option<u32>,
    allocation: Option<Allocation>,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Image")
            .field("name", &self.shared.name)
            .field("size", &self.shared.size)
            .finish_non_exhaustive()
    }
}

impl Image {
    /// Makes one, in no layout yet.
    pub(super) fn new(
        device: &Arc<DeviceShared>,
        name: &str,
        format: Format,
        size: [u32; 2],
        slices: Option<u32>,
        purpose: ImageUse,
    ) -> Result<Self> {
        // Vulkan promises this many texels along each of three axes.
        let limit = slices.map_or(device.facts.capabilities.max_image, |_| 256);
        let ([width, height], depth) = (size, slices.unwrap_or(1));
        let further = slices.map_or(String::new(), |slices| format!("x{slices}"));
        ensure!(
            [width, height, depth].iter().all(|side| (1..=limit).contains(side)),
            "the image {name} would be {width}x{height}{further}, and this device allows 1 to {limit} pixels a side"
        );
        let (image_type, view_type) = match slices {
            None => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D),
            Some(_) => (vk::ImageType::TYPE_3D, vk::ImageViewType::TYPE_3D),
        };
        let copied = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        let usage = copied
            | match (purpose, format) {
                (ImageUse::Target, Format::Depth32) => {
                    vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED
                }
                (ImageUse::Target, _) => vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
                (ImageUse::Sampled, _) => vk::ImageUsageFlags::SAMPLED,
                (ImageUse::Storage, _) => vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED,
            };
        let has_words = (purpose, format) == (ImageUse::Target, Format::Rgba8);
        let flags = if has_words { vk::ImageCreateFlags::MUTABLE_FORMAT } else { vk::ImageCreateFlags::empty() };
        let vulkan = &device.instance.shared.raw;
        // SAFETY: the handle belongs to the instance.
        let supported = unsafe {
            vulkan.get_physical_device_image_format_properties(
                device.facts.handle,
                format.vulkan(),
                image_type,
                vk::ImageTiling::OPTIMAL,
                usage,
                flags,
            )
        };
        ensure!(supported.is_ok(), "this device has no images of format {format:?} to use as {purpose:?} ({name})");
        // Naming the views' formats lets drivers keep their compression.
        let formats = [format.vulkan(), Format::R32Uint.vulkan()];
        let mut list = vk::ImageFormatListCreateInfo::default().view_formats(&formats);
        let mut info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(image_type)
            .format(format.vulkan())
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        if has_words {
            info = info.push_next(&mut list);
        }
        let raw = &device.raw;
        // SAFETY: the device is open and has such images.
        let handle = unsafe { raw.create_image(&info, None) }
            .map_err(|result| device.failure(result, &format!("make the image {name}"), || None))?;
        // SAFETY: the handle was just made.
        let requirements = unsafe { raw.get_image_memory_requirements(handle) };
        let made = device.allocate(name, requirements, Memory::Device, false).and_then(|allocation| {
            let view = |format: Format| {
                let info = vk::ImageViewCreateInfo::default()
                    .image(handle)
                    .view_type(view_type)
                    .format(format.vulkan())
                    .subresource_range(whole(format));
                // SAFETY: memory is bound before this is called; the format is the image's own or listed for it.
                unsafe { raw.create_image_view(&info, None) }
            };
            // SAFETY: the memory fits the image's requirements and nothing else is bound to its range.
            let bound = unsafe { raw.bind_image_memory(handle, allocation.memory(), allocation.offset()) };
            let views = bound.and_then(|()| view(format)).and_then(|own| {
                if !has_words {
                    return Ok((own, None));
                }
                view(Format::R32Uint).map(|words| (own, Some(words))).inspect_err(|_| {
                    // SAFETY: nothing uses it.
                    unsafe { raw.destroy_image_view(own, None) };
                })
            });
            match views {
                Ok(views) => Ok((views, allocation)),
                Err(result) => {
                    device.free(allocation);
                    Err(device.failure(result, &format!("bind memory to the image {name}"), || None))
                }
            }
        });
        let ((view, words), allocation) = match made {
            Ok(made) => made,
            Err(error) => {
                // SAFETY: nothing uses it.
                unsafe { raw.destroy_image(handle, None) };
                return Err(error);
            }
        };
        device.name(handle, name);
        Ok(Self {
            shared: Arc::new(ImageShared {
                device: device.clone(),
                name: name.to_string(),
                handle,
                view,
                words,
                format,
                size,
                slices,
                allocation: Some(allocation),
            }),
            as_words: false,
        })
    }

    /// As [`super::Buffer::id`].
    pub(super) fn id(&self) -> u64 {
        self.shared.handle.as_raw() << 1 | 1
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// The same image, an RGBA8 target, for stages that read its texels as 32-bit words, red in the low byte; any other image as
    /// it is.
    pub fn words(&self) -> Self {
        Self { shared: self.shared.clone(), as_words: true }
    }

    /// The view that stages read it through.
    pub(super) fn read_view(&self) -> vk::ImageView {
        self.shared.words.filter(|_| self.as_words).unwrap_or(self.shared.view)
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.shared.size
    }

    /// How many pictures of its size lie behind each other.
    pub fn depth(&self) -> u32 {
        self.shared.slices.unwrap_or(1)
    }

    /// How its texels are stored.
    pub fn format(&self) -> Format {
        self.shared.format
    }
}

impl Drop for ImageShared {
    fn drop(&mut self) {
        // SAFETY: recordings hold what they use until the device is done, so nothing uses the image any more.
        unsafe {
            for view in std::iter::once(self.view).chain(self.words) {
                self.device.raw.destroy_image_view(view, None);
            }
            self.device.raw.destroy_image(self.handle, None);
        }
        if let Some(allocation) = self.allocation.take() {
            self.device.free(allocation);
        }
    }
}

/// All of an image, as ranges name it.
pub(super) fn whole(format: Format) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange { aspect_mask: format.aspect(), level_count: 1, layer_count: 1, ..Default::default() }
}
