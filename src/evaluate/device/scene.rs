//! Body, cameras and observations on the device.

use anyhow::{Result, ensure};
use rayon::prelude::*;

use super::stage_groups::StageGroups;
use crate::body::Body;
use crate::evaluate::batch::{check_observations, check_scene};
use crate::evaluate::bit_planes::{WORD_PIXELS, bit_planes};
use crate::evaluate::rig::{Rig, RigCamera, RigLens};
use crate::evaluate::shaders::{PROJECT_GROUP, layout};
use crate::features::{Observation, SeenView};
use crate::geometry::Camera;
use crate::gpu::{Buffer, Device, Recorder, StagedBuffer};

/// Most parts of a body: a workgroup holds all parts of an image.
pub(crate) const MOST_PARTS: usize = PROJECT_GROUP as usize;

/// How many of everything a candidate has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) views: u32,
    pub(crate) bones: u32,
    pub(crate) parts: u32,
    pub(crate) dofs: u32,
}

/// Which candidates of a run a recorded pass works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Share {
    /// The first one.
    pub(crate) first: u32,
    /// How many.
    pub(crate) candidates: u32,
}

/// The pixels that are not ignored.
#[derive(Debug)]
pub(super) struct Counted {
    /// A bit a pixel, a word for 32 of a row, in the order of the scene's planes.
    pub(super) planes: StagedBuffer,
    /// 0xff a pixel, in the order of the scene's packed bytes.
    pub(super) pixels: StagedBuffer,
}

impl Counted {
    /// Takes which pixels of a view count, by column and row.
    fn take(&self, camera: &layout::Camera, counts: impl Fn(u32, u32) -> bool) -> Result<()> {
        let (mut planes, mut pixels) = (Vec::new(), Vec::new());
        for row in 0..camera.size[1] {
            let counts: Vec<u8> =
                (0..camera.size[0]).map(|column| if counts(column, row) { 0xff } else { 0 }).collect();
            planes.extend(counts.chunks(WORD_PIXELS).map(|pixels| bit_planes(pixels)[0]));
            pixels.extend(packed(&counts));
        }
        self.planes.staging.write(camera.first_plane_word as usize, &planes)?;
        self.pixels.staging.write(camera.first_pixel_word as usize, &pixels)
    }
}

/// Body, cameras and observations on the device. The host's side is written at once; the device sees it when the passes of
/// [`Self::record_upload`] have run.
#[derive(Debug)]
pub(crate) struct DeviceScene {
    pub(crate) device: Device,
    pub(crate) counts: Counts,
    /// Picture sizes of the views, pixels.
    pub(crate) sizes: Vec<[u32; 2]>,
    /// Labels of the parts in the body's order.
    pub(crate) labels: Vec<u8>,
    pub(crate) bones: StagedBuffer,
    pub(crate) parts: StagedBuffer,
    pub(crate) cameras: StagedBuffer,
    /// Bit planes of the observations, eight words together: planes 0..=6 the proximity bits, plane 7 the silhouette, of 32
    /// pixels of a row. A view's begin at its camera's `first_plane_word` groups.
    pub(crate) planes: StagedBuffer,
    /// The packed bytes of the observations, four pixels a word, rows padded to whole words. A view's begin at its camera's
    /// `first_pixel_word`.
    pub(crate) pixels: StagedBuffer,
    /// Which pixels count, once some did not.
    pub(super) counted: Option<Counted>,
    /// Whether the observations are handed over on the device, and not uploaded.
    is_handed: bool,
    /// How large workgroups of its stages are.
    pub(super) groups: StageGroups,
    camera_rows: Vec<layout::Camera>,
}

impl DeviceScene {
    /// For a body and its cameras. Observations are of nothing at first.
    ///
    /// # Errors
    /// When a picture has no pixel or is too large, the body has no part or more than a workgroup takes, or the device has no room.
    pub(crate) fn new(device: &Device, body: &Body, cameras: &[Camera]) -> Result<Self> {
        check_scene(body, cameras)?;
        let rig = &Rig::new(body);
        let labels: Vec<u8> = body.parts.iter().map(|part| part.label).collect();
        let cameras: Vec<RigCamera> = cameras.iter().map(RigCamera::new).collect();
        ensure!(!rig.parts.is_empty(), "the body has no parts, expected at least one to draw");
        ensure!(
            rig.parts.len() <= MOST_PARTS,
            "the body has {} parts, and the Vulkan backends draw at most {MOST_PARTS}",
            rig.parts.len()
        );
        let counts = Counts {
            views: cameras.len() as u32,
            bones: rig.bones.len() as u32,
            parts: rig.parts.len() as u32,
            dofs: rig.dof_count as u32,
        };
        let mut camera_rows = Vec::new();
        let (mut planes, mut pixels) = (0, 0);
        for camera in &cameras {
            let [width, height] = camera.size;
            camera_rows.push(camera_row(camera, planes, pixels));
            planes += width.div_ceil(32) * height;
            pixels += width.div_ceil(4) * height;
        }
        Ok(Self {
            device: device.clone(),
            counts,
            sizes: cameras.iter().map(|camera| camera.size).collect(),
            bones: StagedBuffer::of(device, "bones", &bone_rows(rig))?,
            parts: StagedBuffer::of(device, "parts", &part_rows(rig, &labels))?,
            cameras: StagedBuffer::of(device, "cameras", &camera_rows)?,
            planes: StagedBuffer::of(device, "observed planes", &vec![0_u32; 8 * planes as usize])?,
            pixels: StagedBuffer::of(device, "observed pixels", &vec![0_u32; pixels as usize])?,
            labels,
            counted: None,
            is_handed: false,
            groups: StageGroups::default(),
            camera_rows,
        })
    }

    /// With workgroups of these sizes.
    ///
    /// # Errors
    /// When the body or the device does not take them.
    pub(super) fn with_groups(self, groups: StageGroups) -> Result<Self> {
        groups.check(self.counts.parts, self.device.capabilities().max_workgroup)?;
        Ok(Self { groups, ..self })
    }

    /// Has room for the pixels that observations ignore, from now on; whether it had none.
    pub(super) fn reserve_ignored(&mut self) -> Result<bool> {
        if self.counted.is_some() {
            return Ok(false);
        }
        // The scene has eight planes a group.
        let groups = self.planes.buffer.size() as usize / size_of::<[u32; 8]>();
        let words = self.pixels.buffer.size() as usize / size_of::<u32>();
        self.counted = Some(Counted {
            planes: StagedBuffer::of(&self.device, "counted planes", &vec![u32::MAX; groups])?,
            pixels: StagedBuffer::of(&self.device, "counted pixels", &vec![u32::MAX; words])?,
        });
        Ok(true)
    }

    /// The planes of what counts, for stages to bind; any buffer where everything does, since it is not read then.
    pub(super) fn counted_planes(&self) -> &Buffer {
        self.counted.as_ref().map_or(&self.planes.buffer, |counted| &counted.planes.buffer)
    }

    /// Takes another body of as many bones, parts and degrees of freedom.
    pub(crate) fn set_body(&mut self, body: &Body) -> Result<()> {
        let rig = &Rig::new(body);
        let found = (rig.bones.len() as u32, rig.parts.len() as u32, rig.dof_count as u32);
        ensure!(
            found == (self.counts.bones, self.counts.parts, self.counts.dofs),
            "a body of {} bones, {} parts and {} degrees of freedom cannot take the place of one of {}, {} and {}",
            found.0,
            found.1,
            found.2,
            self.counts.bones,
            self.counts.parts,
            self.counts.dofs
        );
        self.bones.staging.write(0, &bone_rows(rig))?;
        self.parts.staging.write(0, &part_rows(rig, &self.labels))
    }

    /// Takes observations from the host from now on, or has them handed over; whether that is new, and what was recorded is not.
    pub(super) fn set_handed(&mut self, is_handed: bool) -> bool {
        std::mem::replace(&mut self.is_handed, is_handed) != is_handed
    }

    /// Whether the observations are handed over on the device.
    pub(super) fn is_handed(&self) -> bool {
        self.is_handed
    }

    /// Takes what is to be known of observations that are handed over, one a view.
    pub(super) fn observe_handed(&mut self, views: &[SeenView<'_>]) -> Result<()> {
        let (found, cameras) = (views.len(), self.sizes.len());
        ensure!(found == cameras, "a device made observations of {found} views, and there are {cameras} cameras");
        for ((view, size), camera) in views.iter().zip(&self.sizes).zip(&mut self.camera_rows) {
            let found = view.size();
            ensure!(found == *size, "a device made an observation of {found:?} pixels, and its camera has {size:?}");
            camera.area_obs = view.area();
        }
        if let Some(counted) = &self.counted {
            for (view, camera) in views.iter().zip(&self.camera_rows) {
                counted.take(camera, |column, row| !view.ignores((row * camera.size[0] + column) as usize))?;
            }
        }
        self.cameras.staging.write(0, &self.camera_rows)
    }

    /// Takes the observations of a frame, one a view.
    pub(crate) fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        check_observations(observations, self.sizes.iter().copied())?;
        let (planes, pixels, counted) = (&self.planes, &self.pixels, self.counted.as_ref());
        let camera_rows = &mut self.camera_rows;
        observations.par_iter().zip(camera_rows.par_iter_mut()).try_for_each(|(observation, camera)| {
            camera.area_obs = observation.area();
            let rows = || observation.bytes.chunks_exact(observation.width as usize);
            let words: Vec<[u32; 8]> = rows().flat_map(|row| row.chunks(WORD_PIXELS)).map(bit_planes).collect();
            planes.staging.write(camera.first_plane_word as usize, &words)?;
            let words: Vec<u32> = rows().flat_map(packed).collect();
            pixels.staging.write(camera.first_pixel_word as usize, &words)?;
            let Some(counted) = counted else { return Ok(()) };
            counted.take(camera, |column, row| observation.counts(column, row) != 0)
        })?;
        self.cameras.staging.write(0, &self.camera_rows)
    }

    /// Pixels of the observed silhouettes, one a view.
    pub(crate) fn observed_areas(&self) -> impl Iterator<Item = u32> + '_ {
        self.camera_rows.iter().map(|camera| camera.area_obs)
    }

    /// Where the views' bit planes begin, in groups of 32 pixels of a row.
    pub(super) fn first_plane_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.camera_rows.iter().map(|camera| camera.first_plane_word)
    }

    /// Where the views' packed bytes begin, in words.
    pub(super) fn first_pixel_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.camera_rows.iter().map(|camera| camera.first_pixel_word)
    }

    /// Records the copies of everything to the device's own memory, but for observations that are handed over.
    pub(crate) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        let Self { bones, parts, cameras, planes, pixels, is_handed, .. } = self;
        let counted = self.counted.iter().flat_map(|counted| [&counted.planes, &counted.pixels]);
        let observed = [planes, pixels].into_iter().filter(|_| !is_handed);
        let all = [bones, parts, cameras].into_iter().chain(observed).chain(counted);
        all.into_iter().try_for_each(|staged| staged.record_upload(recorder))
    }

    /// The push constants of a share of the candidates.
    pub(crate) fn batch(&self, share: Share) -> layout::Batch {
        let Counts { views, bones, parts, dofs } = self.counts;
        layout::Batch { candidates: share.candidates, views, bones, parts, dofs, first: share.first }
    }
}

/// The bytes of a row of pixels, four a word, the last one filled up with nothing.
pub(super) fn packed(row: &[u8]) -> impl Iterator<Item = u32> + '_ {
    row.chunks(4).map(|chunk| {
        let mut bytes = [0; 4];
        bytes[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(bytes)
    })
}

fn bone_rows(rig: &Rig) -> Vec<layout::Bone> {
    rig.bones
        .iter()
        .map(|bone| layout::Bone {
            offset: bone.offset,
            parity: bone.parity,
            parent: bone.parent.map_or(-1, |parent| parent as i32),
            axes: bone.axes.iter().enumerate().map(|(place, &axis)| (axis as u32) << (2 * place)).sum(),
            slots: bone.slots.map(|slot| slot.map_or(-1, |slot| slot as i32)),
        })
        .collect()
}

fn part_rows(rig: &Rig, labels: &[u8]) -> Vec<layout::Part> {
    rig.parts
        .iter()
        .zip(labels)
        .map(|(part, &label)| layout::Part {
            a: part.a,
            radius_a: part.radius_a,
            b: part.b,
            radius_b: part.radius_b,
            bone: part.bone as u32,
            label: u32::from(label),
            pad0: 0,
            pad1: 0,
        })
        .collect()
}

fn camera_row(camera: &RigCamera, first_plane_word: u32, first_pixel_word: u32) -> layout::Camera {
    let m = &camera.camera_from_world;
    let common = layout::Camera {
        camera_from_world: [0, 1, 2].map(|row| [m[4 * row], m[4 * row + 1], m[4 * row + 2], m[4 * row + 3]]),
        centre: camera.centre,
        lens: 0,
        focal: [0.0; 2],
        principal: [0.0; 2],
        radial: [0.0; 3],
        max_radius_squared: 0.0,
        tangential: [0.0; 2],
        size: camera.size,
        words: camera.size[0].div_ceil(32),
        first_plane_word,
        first_pixel_word,
        area_obs: 0,
    };
    match camera.lens {
        RigLens::Tsai { kappa, focal, centre } => {
            layout::Camera { lens: 0, focal, principal: centre, radial: [kappa, 0.0, 0.0], ..common }
        }
        RigLens::BrownConrady { focal, centre, radial, tangential, max_radius_squared } => {
            layout::Camera { lens: 1, focal, principal: centre, radial, tangential, max_radius_squared, ..common }
        }
    }
}
