//! Proximity and silhouette, packed: the twin of the observation's packing.

use anyhow::Result;

use super::generated::pack_comp;
use super::{ROW_GROUP, record_views};
use crate::features::device::DeviceView;
use crate::gpu::{Buffer, Device, Memory, Pipeline, Recorder, Stage};

/// Most workgroups in one direction that every device runs.
const MOST_GROUPS: u32 = 65535;

/// The stage, with the proximity of every distance on the device.
#[derive(Debug)]
pub(in crate::features) struct PackStage {
    pipeline: Pipeline,
    proximity: Buffer,
}

impl PackStage {
    /// Compiles it; `proximity` holds the 7-bit value of every code of a map.
    pub(in crate::features) fn new(device: &Device, proximity: &[u8]) -> Result<Self> {
        let table = device.buffer::<u32>("proximity table", proximity.len().div_ceil(4), Memory::Upload)?;
        table.write(0, proximity)?;
        let stage = Stage { shader: &pack_comp::SHADER, constants: &[] };
        Ok(Self { pipeline: device.compute_pipeline(stage)?, proximity: table })
    }

    /// Records it: `silhouette` and `codes` to `packed`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[DeviceView]) -> Result<()> {
        let proximity = &self.proximity;
        record_views(recorder, "pack", &self.pipeline, views, |view| {
            let bindings = pack_comp::Bindings {
                silhouette: &view.silhouette,
                codes: &view.codes,
                proximity,
                packed: &view.packed,
            };
            let groups = (view.picture.width * view.picture.height).div_ceil(4 * ROW_GROUP);
            (bindings.bound(), view.picture, [groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1])
        })
    }
}
