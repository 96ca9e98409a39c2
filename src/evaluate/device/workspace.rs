//! Memory that a batch of candidates works in.

use anyhow::{Result, ensure};

use super::scene::Counts;
use crate::evaluate::shaders::layout;
use crate::gpu::{Buffer, Device, Memory, OutOfMemory};

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
    /// For runs of `candidates`, in batches as large as the device allows and has memory for.
    ///
    /// # Errors
    /// When not even one candidate fits.
    pub(crate) fn new(device: &Device, counts: Counts, candidates: u32) -> Result<Self> {
        let candidates = candidates.max(1);
        let Counts { views, bones, parts, .. } = counts;
        let limit = device.capabilities().max_storage;
        let one = [
            u64::from(bones) * 3 * size_of::<[f32; 4]>() as u64,
            u64::from(views) * u64::from(parts) * size_of::<layout::Quad>() as u64,
        ];
        let most = one.iter().map(|bytes| limit / bytes.max(&1)).min().unwrap_or(0);
        let most = most.min(u64::from(device.capabilities().max_groups / views.max(1)));
        ensure!(most > 0, "not even one candidate fits the {limit} bytes that this device binds at once");
        let available = device.memory_available();
        // The recordings to come want an eighth.
        let fitting = (available - available / 8).saturating_sub(Self::bytes(counts, candidates, 0))
            / Self::bytes(counts, 0, 1).max(1);
        let mut batch = u64::from(candidates).min(most).min(fitting.max(1)) as u32;
        loop {
            match Self::with_batch(device, counts, candidates, batch) {
                Err(error) if batch > 1 && error.is::<OutOfMemory>() => batch = batch.div_ceil(2),
                done => return done,
            }
        }
    }

    /// Bytes for a run and a batch of so many candidates.
    fn bytes(counts: Counts, candidates: u32, batch: u32) -> u64 {
        let Counts { views, bones, parts, dofs } = counts;
        let run = dofs as usize * size_of::<f32>() + views as usize * size_of::<layout::Sums>();
        let image = parts as usize * size_of::<layout::Quad>() + size_of::<layout::Bounds>();
        let one = bones as usize * 3 * size_of::<[f32; 4]>() + views as usize * image;
        u64::from(candidates) * run as u64 + u64::from(batch) * one as u64
    }

    fn with_batch(device: &Device, counts: Counts, candidates: u32, batch: u32) -> Result<Self> {
        let Counts { views, bones, parts, dofs } = counts;
        let (run, images) = (candidates as usize, batch as usize * views as usize);
        Ok(Self {
            candidates,
            batch,
            poses: device.buffer::<f32>("poses", run * dofs as usize, Memory::Device)?,
            world: device.buffer::<[f32; 4]>("world", batch as usize * bones as usize * 3, Memory::Device)?,
            quads: device.buffer::<layout::Quad>("quads", images * parts as usize, Memory::Device)?,
            bounds: device.buffer::<layout::Bounds>("bounds", images, Memory::Device)?,
            sums: device.buffer::<layout::Sums>("sums", run * views as usize, Memory::Device)?,
        })
    }
}
