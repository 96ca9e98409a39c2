//! Where poses come from and results go to on the host.

use anyhow::Result;

use super::scene::DeviceScene;
use super::workspace::Workspace;
use crate::evaluate::shaders::layout;
use crate::evaluate::{Components, SegmentSums};
use crate::gpu::{Buffer, Memory, Recorder};

/// What the host itself compared of a run.
#[derive(Debug, Default)]
pub(crate) struct HostCounts {
    /// `[candidate][view]`, none for images that the device scored.
    pub(super) sums: Vec<Option<layout::Sums>>,
    /// `[candidate][view][segment]`, where there are segments.
    pub(super) segments: Vec<SegmentSums>,
    /// `[candidate][view]`, where evidence was asked for.
    pub(super) evidence: Vec<i32>,
}

/// The fitness of a number of candidates, and the host's buffers for poses, fitness and sums.
#[derive(Debug)]
pub(super) struct HostBuffers {
    pub(super) fitness: Buffer,
    pub(super) poses_in: Buffer,
    pub(super) fitness_out: Buffer,
    sums_out: Buffer,
}

impl HostBuffers {
    /// For so many candidates.
    pub(super) fn new(scene: &DeviceScene, candidates: u32) -> Result<Self> {
        let (device, counts) = (&scene.device, scene.counts);
        let count = candidates as usize;
        let images = count * counts.views as usize;
        Ok(Self {
            fitness: device.buffer::<f32>("fitness", count, Memory::Device)?,
            poses_in: device.buffer::<f32>("poses staging", count * counts.dofs as usize, Memory::Upload)?,
            fitness_out: device.buffer::<f32>("fitness readback", count, Memory::Readback)?,
            sums_out: device.buffer::<layout::Sums>("sums readback", images, Memory::Readback)?,
        })
    }

    /// Records the copy of the poses to the workspace.
    pub(super) fn record_poses(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        candidates: u32,
    ) -> Result<()> {
        let bytes = u64::from(candidates) * u64::from(scene.counts.dofs) * size_of::<f32>() as u64;
        recorder.copy("upload poses", (&self.poses_in, 0), (&workspace.poses, 0), bytes)
    }

    /// Records the copy of the fitness to the host.
    pub(super) fn record_fitness(&self, recorder: &mut Recorder, candidates: u32) -> Result<()> {
        let bytes = u64::from(candidates) * size_of::<f32>() as u64;
        recorder.copy("read fitness", (&self.fitness, 0), (&self.fitness_out, 0), bytes)
    }

    /// Records the copy of the workspace's sums to the host.
    pub(super) fn record_sums(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        candidates: u32,
    ) -> Result<()> {
        let bytes = u64::from(candidates) * u64::from(scene.counts.views) * size_of::<layout::Sums>() as u64;
        recorder.copy("read sums", (&workspace.sums, 0), (&self.sums_out, 0), bytes)
    }

    /// The components of a finished run; what the host itself counted stands for the device's sums.
    pub(super) fn read_components(
        &self,
        scene: &DeviceScene,
        counts: &HostCounts,
        components: &mut [Components],
    ) -> Result<()> {
        let mut sums: Vec<layout::Sums> = bytemuck::zeroed_vec(components.len());
        self.sums_out.read(0, &mut sums)?;
        let areas: Vec<u32> = scene.observed_areas().collect();
        for (index, (components, sums)) in components.iter_mut().zip(&sums).enumerate() {
            let layout::Sums { area_model, overlap, edges, proximity } =
                counts.sums.get(index).copied().flatten().unwrap_or(*sums);
            *components = Components { area_obs: areas[index % areas.len()], area_model, overlap, edges, proximity };
        }
        Ok(())
    }
}
