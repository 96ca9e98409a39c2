//! Buffers that the host fills: its end, the device's own memory, and the pass between.

use anyhow::Result;
use bytemuck::Pod;

use super::buffer::Buffer;
use super::device::Device;
use super::memory::Memory;
use super::recorder::Recorder;
use super::timing::Timing;

/// A buffer in the device's own memory, and the host's end of what goes there.
#[derive(Debug)]
pub struct StagedBuffer {
    /// What the host writes.
    pub staging: Buffer,
    /// What stages read, as large, once [`Self::record_upload`] has run.
    pub buffer: Buffer,
}

impl StagedBuffer {
    /// Room for `len` elements of `T`.
    ///
    /// # Errors
    /// As [`Device::buffer`].
    pub fn new<T: Pod>(device: &Device, name: &str, len: usize) -> Result<Self> {
        Ok(Self {
            staging: device.buffer::<T>(&format!("{name} staging"), len, Memory::Upload)?,
            buffer: device.buffer::<T>(name, len, Memory::Device)?,
        })
    }

    /// Room for as many values, with them in the staging buffer.
    ///
    /// # Errors
    /// As [`Device::buffer`].
    pub fn of<T: Pod>(device: &Device, name: &str, values: &[T]) -> Result<Self> {
        let staged = Self::new::<T>(device, name, values.len())?;
        staged.staging.write(0, values)?;
        Ok(staged)
    }

    /// Records the copy of the whole staging buffer, a pass called `upload`.
    ///
    /// # Errors
    /// As [`Recorder::copy`].
    pub fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        recorder.copy("upload", (&self.staging, 0), (&self.buffer, 0), self.buffer.size())
    }
}

impl Device {
    /// A buffer in the device's own memory with these values, which are brought there at once.
    ///
    /// # Errors
    /// As [`Self::buffer`]; and when the device fails.
    pub fn uploaded<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer> {
        let staged = StagedBuffer::of(self, name, values)?;
        let mut recorder = self.recorder(Timing::Off)?;
        staged.record_upload(&mut recorder)?;
        recorder.finish()?.run()?;
        Ok(staged.buffer)
    }
}
