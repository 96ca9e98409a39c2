//! How well every placement in an example fits, measured by a device with the bits of [`super::matching`].

use std::sync::{Mutex, PoisonError};

use anyhow::{Result, ensure};

use super::colour::{Known, Weighted};
use crate::gpu::{Buffer, Device, Groups, Memory, Recording, Timing};
use crate::texture::shaders::{layout, matching_comp};

/// An example on the device, and the recorded measurement.
#[derive(Debug)]
pub(super) struct DeviceMatching {
    device: Device,
    width: usize,
    known: Buffer,
    weights: Buffer,
    request: Buffer,
    errors: Buffer,
    recording: Mutex<Recording>,
}

impl DeviceMatching {
    /// Compiles and records it for an example of columns and rows with these colours.
    ///
    /// # Errors
    /// When the device has no memory for it.
    pub(super) fn new(device: &Device, [width, height]: [usize; 2], colours: &[Weighted]) -> Result<Self> {
        let area = width * height;
        let rows: Vec<[f32; 4]> = colours.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
        let example = device.buffer::<[f32; 4]>("example", area, Memory::Upload)?;
        example.write(0, &rows)?;
        let known = device.buffer::<[f32; 4]>("known pixels", area, Memory::Upload)?;
        let weights = device.buffer::<f32>("weights", area, Memory::Upload)?;
        let request = device.buffer::<layout::Request>("request", 1, Memory::Upload)?;
        let errors = device.buffer::<f32>("errors", area, Memory::Readback)?;
        let bindings = matching_comp::Bindings {
            example: &example,
            known_pixels: &known,
            known_weights: &weights,
            request: &request,
            errors: &errors,
        };
        let mut recorder = device.recorder(Timing::Off)?;
        recorder.run(bindings.dispatch(Groups::Indirect(&request, 0)))?;
        let recording = Mutex::new(recorder.finish()?);
        Ok(Self { device: device.clone(), width, known, weights, request, errors, recording })
    }

    /// The sums of squared errors over the known pixels of a region, for each of so many columns and rows of placements.
    ///
    /// # Errors
    /// When more pixels are known than the example has, or the device fails.
    pub(super) fn errors(&self, [columns, rows]: [usize; 2], known: &[Known]) -> Result<Vec<f32>> {
        ensure!(
            known.len() as u64 * 16 <= self.known.size(),
            "{} known pixels, expected no more than the example has",
            known.len()
        );
        let pixel = |pixel: &Known| {
            let [r, g, b] = pixel.colour;
            [f32::from_bits((pixel.y * self.width + pixel.x) as u32), r, g, b]
        };
        let placements = (columns * rows) as u32;
        let mut recording = self.recording.lock().unwrap_or_else(PoisonError::into_inner);
        self.known.write(0, &known.iter().map(pixel).collect::<Vec<_>>())?;
        self.weights.write(0, &known.iter().map(|pixel| pixel.weight).collect::<Vec<_>>())?;
        let groups = placements.div_ceil(matching_comp::SHADER.workgroup_size[0]);
        self.request.write(
            0,
            &[layout::Request {
                groups: [groups, 1, 1],
                width: self.width as u32,
                columns: columns as u32,
                placements,
                known_count: known.len() as u32,
            }],
        )?;
        recording.run()?;
        self.device.validation_log().check()?;
        let mut errors = vec![0.0; columns * rows];
        self.errors.read(0, &mut errors)?;
        Ok(errors)
    }
}
