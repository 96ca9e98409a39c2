//! What draws pictures of a material: the processor, or a device with the same bits.

use anyhow::Result;

use super::device_material::DeviceMaterial;
use super::materials::Material;
use super::picture::{self, Heights, Picture, Seen, View};
use crate::gpu::Device;

/// A material and what draws it.
#[derive(Debug)]
pub struct Painter<'a> {
    material: &'a Material,
    device: Option<DeviceMaterial>,
}

impl<'a> Painter<'a> {
    /// By a device where there is one, else by the processor.
    ///
    /// # Errors
    /// When the device has no memory for the material's tables.
    pub fn new(material: &'a Material, device: Option<&Device>) -> Result<Self> {
        let device = device.map(|device| DeviceMaterial::new(device, material)).transpose()?;
        Ok(Self { material, device })
    }

    /// What is drawn.
    pub fn material(&self) -> &Material {
        self.material
    }

    /// The material on a plane, of a checked view; where pixels are coarser than its detail, its mean over each.
    ///
    /// # Errors
    /// When the device fails.
    pub fn flat(&self, view: &View) -> Result<Picture> {
        match &self.device {
            None => Ok(picture::flat(self.material, view)),
            Some(device) => device.flat(view, self.material.samples(view.pixel(), 1)),
        }
    }

    /// Its heights.
    ///
    /// # Errors
    /// When the device fails.
    pub fn heights(&self, view: &View) -> Result<Heights> {
        match &self.device {
            None => Ok(picture::heights(self.material, view)),
            Some(device) => device.heights(view, self.material.samples(view.pixel(), 1)),
        }
    }

    /// The material where rays meet an object, none where they miss it. A ray's u and v are from -1 to 1 over the shorter side, to
    /// the right and up; `samples` rays a pixel along each axis.
    ///
    /// # Errors
    /// When the device fails.
    pub fn shown(
        &self,
        size: [u32; 2],
        samples: u32,
        ray: impl Fn(f32, f32) -> Option<Seen> + Sync,
    ) -> Result<Picture> {
        match &self.device {
            None => Ok(picture::shown(self.material, size, samples, ray)),
            Some(device) => device.shown(size, samples, ray),
        }
    }
}
