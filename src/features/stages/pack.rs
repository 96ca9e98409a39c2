//! Proximity and silhouette, packed: the twin of the observation's packing.

use anyhow::Result;

use super::generated::pack_comp;
use super::{flat_groups, record_views};
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{Buffer, ComputeStage, Device, Memory, Recorder, Stage};

/// The stage, with the proximity of every distance on the device.
#[derive(Debug)]
pub(in crate::features) struct PackStage {
    stage: ComputeStage,
    proximity: Buffer,
}

impl PackStage {
    /// Compiles it; `proximity` holds the 7-bit value of every code of a map.
    pub(in crate::features) fn new(device: &Device, proximity: &[u8]) -> Result<Self> {
        let table = device.buffer::<u32>("proximity table", proximity.len().div_ceil(4), Memory::Upload)?;
        table.write(0, proximity)?;
        let stage = Stage { shader: &pack_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "pack", stage)?, proximity: table })
    }

    /// Records it: `silhouette` and `codes` to `packed`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        let proximity = &self.proximity;
        record_views(recorder, &self.stage, views, |view| {
            let bindings = pack_comp::Bindings {
                silhouette: view.plane(Plane::Silhouette),
                codes: &view.codes,
                proximity,
                packed: &view.packed,
            };
            let words = (view.picture.width * view.picture.height).div_ceil(4);
            (bindings.bound(), view.picture, flat_groups(words))
        })
    }
}
