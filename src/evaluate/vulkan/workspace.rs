//! Memory that a batch of candidates works in.

use anyhow::{Result, ensure};

use crate::evaluate::stages::layout;
use crate::gpu::{Buffer, Device, Memory};

use super::Counts;

/// Memory that a batch of candidates works in, and the poses and results of a whole run.
#[derive(Debug)]
pub(crate) struct Workspace {
    /// Most candidates of a run: the room in `poses` and `sums`.
    pub(crate) candidates: u32,
    /// Most candidates of a batch: the room everywhere else.
    pub(crate) batch: u32,
    /// Poses, `[candidate][dof]`, mm and radians.
    pub(crate) poses: Buffer,
    /// Bone matrices, `[candidate][bone][row]` vec4.
    pub(crate) world: Buffer,
    /// Parts as they are drawn, `[candidate][view][place from the nearest on]`.
    pub(crate) quads: Buffer,
    /// What each image may touch, `[candidate][view]`.
    pub(crate) bounds: Buffer,
    /// Components without the observed area, `[candidate][view]`, of the whole run.
    pub(crate) sums: Buffer,
}

impl Workspace {
    /// For runs of `candidates`, in batches as large as the device allows.
    ///
    /// # Errors
    /// When not even one candidate fits.
    pub(crate) fn new(device: &Device, counts: Counts, candidates: u32) -> Result<Self> {
        let (candidates, images) = (candidates.max(1), counts.views as usize);
        let Counts { bones, parts, dofs, .. } = counts;
        let world = bones as usize * 3;
        let quads = images * parts as usize;
        let limit = device.capabilities().max_storage;
        let most = [world * size_of::<[f32; 4]>(), quads * size_of::<layout::Quad>()]
            .iter()
            .map(|&bytes| limit / bytes.max(1) as u64)
            .min()
            .unwrap_or(0)
            .min(u64::from(device.capabilities().max_groups / counts.views.max(1)));
        ensure!(most > 0, "not even one candidate fits the {limit} bytes that this device binds at once");
        let batch = u64::from(candidates).min(most) as u32;
        let one = batch as usize;
        Ok(Self {
            candidates,
            batch,
            poses: device.buffer::<f32>("poses", candidates as usize * dofs as usize, Memory::Device)?,
            world: device.buffer::<[f32; 4]>("world", one * world, Memory::Device)?,
            quads: device.buffer::<layout::Quad>("quads", one * quads, Memory::Device)?,
            bounds: device.buffer::<layout::Bounds>("bounds", one * images, Memory::Device)?,
            sums: device.buffer::<layout::Sums>("sums", candidates as usize * images, Memory::Device)?,
        })
    }
}
