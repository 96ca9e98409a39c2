//! Passes that move bytes: between buffers, and between buffers and images.

use anyhow::{Result, ensure};
use ash::vk;

use super::buffer::Buffer;
use super::hazards::{Stages, Use};
use super::image::Image;
use super::recorder::Recorder;

impl Recorder {
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
        let uses = [Use { resource: from.0.id(), writes: false }, Use { resource: to.0.id(), writes: true }];
        self.wait_for(&uses, &[], Stages::TRANSFER);
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

    /// A pass that copies whole buffers into one, side by side: each to its place there, bytes, none over another.
    ///
    /// # Errors
    /// When one leaves the buffer or begins inside of the one before it.
    pub fn gather(&mut self, name: &str, from: &[(&Buffer, u64)], to: &Buffer) -> Result<()> {
        let mut end = 0;
        for (buffer, place) in from {
            ensure!(
                *place >= end && place.saturating_add(buffer.size()) <= to.size(),
                "the pass {name} copies {} of {} bytes to byte {place} of {}, which has {} and is filled up to {end}",
                buffer.name(),
                buffer.size(),
                to.name(),
                to.size()
            );
            end = place + buffer.size();
        }
        self.begin(name)?;
        let mut uses = vec![Use { resource: to.id(), writes: true }];
        uses.extend(from.iter().map(|(buffer, _)| Use { resource: buffer.id(), writes: false }));
        self.wait_for(&uses, &[], Stages::TRANSFER);
        self.keep_buffer(to);
        for (buffer, place) in from {
            self.keep_buffer(buffer);
            let region = [vk::BufferCopy { src_offset: 0, dst_offset: *place, size: buffer.size() }];
            let (raw, commands) = (&self.device.shared.raw, self.parts.commands);
            // SAFETY: recording; the range lies inside of the buffer, as checked above.
            unsafe { raw.cmd_copy_buffer(commands, buffer.shared.handle, to.shared.handle, &region) };
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
        self.wait_for(&[Use { resource: buffer.id(), writes: true }], &[], Stages::TRANSFER);
        self.keep_buffer(buffer);
        // SAFETY: recording; the whole buffer is a multiple of four bytes long.
        unsafe {
            self.device.shared.raw.cmd_fill_buffer(self.parts.commands, buffer.shared.handle, 0, vk::WHOLE_SIZE, word);
        }
        self.end();
        Ok(())
    }

    /// A pass that copies part of an image (left, top, width, height) to a buffer, rows one after the other; of an image of three
    /// dimensions that part of each slice.
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
        let depth = image.depth();
        let bytes = u64::from(width) * u64::from(height) * u64::from(depth) * image.format().bytes();
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
        let uses = [Use { resource: image.id(), writes: !reads }, Use { resource: buffer.id(), writes: reads }];
        let layout = if reads { vk::ImageLayout::TRANSFER_SRC_OPTIMAL } else { vk::ImageLayout::TRANSFER_DST_OPTIMAL };
        self.wait_for(&uses, &[(image.clone(), layout)], Stages::TRANSFER);
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
            image_extent: vk::Extent3D { width, height, depth },
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
}
