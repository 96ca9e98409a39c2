//! Pictures of a material drawn by a device, with the processor's bits.

#[cfg(test)]
mod tests;

use anyhow::Result;
use rayon::prelude::*;

use super::materials::{Displacement, Material};
use super::noise::{NoiseMaker, TABLE, VOLUME_SIDE};
use super::picture::{Heights, Picture, Seen, View, sample_place};
use super::shaders::{
    DISPLACES_EXTREMES, DISPLACES_SCALING, DISPLACES_SIDES, DISPLACES_SQUARES, SHOWS_COLOURS, SHOWS_HEIGHTS,
    SHOWS_RAYS, displace_comp, layout, material_comp,
};
use crate::gpu::{Buffer, Device, Format, Groups, Image, ImageUse, Memory, Recorder, Recording, Timing};

/// Samples of a run: a picture is drawn in runs, so that any size of it takes little of the device's memory, and none is long.
const SAMPLES_OF_A_RUN: u32 = 1 << 19;
/// What stands for the cosine of a ray that misses.
const MISSES: f32 = -2.0;

/// A material on a device.
#[derive(Debug)]
pub(super) struct DeviceMaterial {
    device: Device,
    material: Buffer,
    tables: Buffer,
    noise_tables: Image,
    noise_volume: Image,
    kind: u32,
    way: u32,
}

/// A picture to draw.
#[derive(Clone, Copy)]
struct Job {
    shows: u32,
    size: [u32; 2],
    /// Along each axis of a pixel.
    samples: u32,
    offset: [f32; 3],
    pixel: f32,
}

/// What one run reads and writes; two take turns, so that the device works while the host hands out rays and takes pixels.
struct Slot {
    request: Buffer,
    rays: Buffer,
    words: Buffer,
    recording: Recording,
    /// Pixels that are being drawn: the first, and how many.
    drawn: Option<(u32, u32)>,
}

impl DeviceMaterial {
    /// Brings its numbers and tables to a device.
    ///
    /// # Errors
    /// When the device has no memory for them, or fails.
    pub(super) fn new(device: &Device, material: &Material) -> Result<Self> {
        let (numbers, bands, surface) = material.for_stages();
        let noise_tables = device.image("noise tables", Format::R32Uint, [TABLE as u32, 2], ImageUse::Sampled)?;
        // Vulkan wants an image where the stage has one.
        let side = if matches!(material.source(), NoiseMaker::Volume(_)) { VOLUME_SIDE as u32 } else { 1 };
        let noise_volume = device.volume("noise volume", Format::R32Float, [side; 3])?;
        let way = match material.source() {
            NoiseMaker::Arithmetic => 0,
            NoiseMaker::Tables(entries) => {
                let words: Vec<u32> = entries.order.iter().chain(&entries.words).copied().collect();
                fill(device, &noise_tables, &words)?;
                1
            }
            NoiseMaker::Volume(volume) => {
                fill(device, &noise_volume, volume.samples())?;
                2
            }
        };
        Ok(Self {
            device: device.clone(),
            material: device.uploaded("material", &[layout::Materials { material: numbers }])?,
            tables: tables(device, &bands, surface.as_ref())?,
            noise_tables,
            noise_volume,
            kind: numbers.kind,
            way,
        })
    }

    /// The material on a plane, of so many samples along each axis of a pixel.
    ///
    /// # Errors
    /// When the device fails, as in all that draw.
    pub(super) fn flat(&self, view: &View, samples: u32) -> Result<Picture> {
        self.coloured(Job::of_view(SHOWS_COLOURS, view, samples), None)
    }

    /// Its heights.
    pub(super) fn heights(&self, view: &View, samples: u32) -> Result<Heights> {
        let job = Job::of_view(SHOWS_HEIGHTS, view, samples);
        let mut heights = vec![0; job.pixels() as usize];
        self.draw(job, None, |first, words| {
            heights[first..][..words.len()]
                .par_iter_mut()
                .zip(words)
                .for_each(|(height, word)| *height = word[0] as u16);
        })?;
        Ok(Heights::from_raw(view.size[0], view.size[1], heights).unwrap_or_default())
    }

    /// The material where rays meet an object.
    pub(super) fn shown(
        &self,
        size: [u32; 2],
        samples: u32,
        ray: impl Fn(f32, f32) -> Option<Seen> + Sync,
    ) -> Result<Picture> {
        let job = Job { shows: SHOWS_RAYS, size, samples, offset: [0.0; 3], pixel: 0.0 };
        self.coloured(job, Some(&ray))
    }

    fn coloured(&self, job: Job, ray: Option<&RayOf<'_>>) -> Result<Picture> {
        let mut channels = vec![0; 3 * job.pixels() as usize];
        self.draw(job, ray, |first, words| {
            let pixels = channels[3 * first..][..3 * words.len()].par_chunks_mut(3);
            pixels.zip(words).for_each(|(pixel, [low, high])| {
                pixel.copy_from_slice(&[*low as u16, (*low >> 16) as u16, *high as u16]);
            });
        })?;
        Ok(Picture::from_raw(job.size[0], job.size[1], channels).unwrap_or_default())
    }

    /// Draws a picture run by run and hands on the words of each with the number of its first pixel.
    fn draw(&self, job: Job, ray: Option<&RayOf<'_>>, mut take: impl FnMut(usize, &[[u32; 2]])) -> Result<()> {
        let square = job.samples * job.samples;
        let most = (SAMPLES_OF_A_RUN / square).max(1).min(job.pixels());
        let is_one_run = most == job.pixels();
        let mut slots = Vec::new();
        for _ in 0..if is_one_run { 1 } else { 2 } {
            slots.push(self.slot(job, most)?);
        }
        let mut words = vec![[0_u32; 2]; most as usize];
        let mut finish = |slot: &mut Slot| -> Result<()> {
            let Some((first, pixels)) = slot.drawn.take() else { return Ok(()) };
            slot.recording.wait()?;
            self.device.validation_log().check()?;
            let words = &mut words[..pixels as usize];
            slot.words.read(0, words)?;
            take(first as usize, words);
            Ok(())
        };
        let count = slots.len();
        let mut turn = 0;
        for first in (0..job.pixels()).step_by(most as usize) {
            let slot = &mut slots[turn % count];
            finish(slot)?;
            let pixels = most.min(job.pixels() - first);
            if let Some(ray) = ray {
                slot.rays.write(0, &job.rays(first, pixels, ray))?;
            }
            let Job { size, samples, offset, pixel, .. } = job;
            slot.request.write(
                0,
                &[layout::PictureRequest {
                    size,
                    first,
                    pixels,
                    offset,
                    pixel,
                    samples,
                    ..bytemuck::Zeroable::zeroed()
                }],
            )?;
            slot.recording.submit()?;
            slot.drawn = Some((first, pixels));
            turn += 1;
        }
        for later in 0..count {
            finish(&mut slots[(turn + later) % count])?;
        }
        Ok(())
    }

    fn slot(&self, job: Job, pixels: u32) -> Result<Slot> {
        let device = &self.device;
        let rays = if job.shows == SHOWS_RAYS { pixels as usize * (job.samples * job.samples) as usize } else { 1 };
        let request = device.buffer::<layout::PictureRequest>("request", 1, Memory::Upload)?;
        let rays = device.buffer::<[f32; 4]>("rays", rays, Memory::Upload)?;
        let words = device.buffer::<[u32; 2]>("pixels", pixels as usize, Memory::Readback)?;
        let bindings = material_comp::Bindings {
            materials: &self.material,
            tables: &self.tables,
            noise_tables: &self.noise_tables,
            noise_volume: &self.noise_volume,
            all_requests: &request,
            rays: &rays,
            words: &words,
        };
        let constants = material_comp::Constants { kind: self.kind, way: self.way, shows: job.shows };
        let mut recorder = device.recorder(Timing::Off)?;
        recorder.run(bindings.dispatch(constants, Groups::Over([pixels, 1, 1])))?;
        let recording = recorder.finish()?;
        Ok(Slot { request, rays, words, recording, drawn: None })
    }
}

/// Where a ray meets an object, as [`super::picture::shown`] takes it.
type RayOf<'a> = dyn Fn(f32, f32) -> Option<Seen> + Sync + 'a;

impl Job {
    fn of_view(shows: u32, view: &View, samples: u32) -> Self {
        Self { shows, size: view.size, samples, offset: view.offset, pixel: view.pixel() }
    }

    fn pixels(&self) -> u32 {
        self.size[0] * self.size[1]
    }

    /// The rays of some pixels' samples: points, and cosines or [`MISSES`].
    fn rays(&self, first: u32, pixels: u32, ray: &RayOf<'_>) -> Vec<[f32; 4]> {
        let square = self.samples * self.samples;
        let ray = |sample: u32| {
            let pixel = first + sample / square;
            let (x, y) = (pixel % self.size[0], pixel / self.size[0]);
            let [u, v] = sample_place(self.size, self.samples, x, y, sample % square);
            ray(u, v).map_or([0.0, 0.0, 0.0, MISSES], |Seen { point: [x, y, z], cosine }| [x, y, z, cosine])
        };
        (0..pixels * square).into_par_iter().map(ray).collect()
    }
}

/// Bands of colour, and behind them the heights of a surface, which is displaced here.
fn tables(device: &Device, bands: &[f32], surface: Option<&Displacement>) -> Result<Buffer> {
    let points = surface.map_or(0, |surface| (surface.side * surface.side) as usize);
    // A device has no empty buffers.
    let tables = device.buffer::<f32>("material's tables", (bands.len() + points).max(1), Memory::Device)?;
    let mut recorder = device.recorder(Timing::Off)?;
    recorder.fill("fill", &tables, 0)?;
    if !bands.is_empty() {
        let staged = device.buffer::<f32>("bands", bands.len(), Memory::Upload)?;
        staged.write(0, bands)?;
        recorder.copy("upload", (&staged, 0), (&tables, 0), staged.size())?;
    }
    if let Some(surface) = surface {
        displace(&mut recorder, &tables, bands.len() as u32, surface)?;
    }
    recorder.finish()?.run()?;
    device.validation_log().check()?;
    Ok(tables)
}

/// Records a surface: two passes a level, then its range and all of it over that. Its heights begin at `first` and are 0.
fn displace(recorder: &mut Recorder, tables: &Buffer, first: u32, surface: &Displacement) -> Result<()> {
    let extremes = recorder.device().buffer::<u32>("extremes", 2, Memory::Device)?;
    recorder.fill("fill", &extremes, 0)?;
    let bindings = displace_comp::Bindings { surface: tables, extremes: &extremes };
    let &Displacement { side, seed, .. } = surface;
    let mut run = |displaces: u32, halved: u32, amplitude: f32, over: [u32; 2]| {
        let push = layout::Displace { first, side, halved, seed, amplitude };
        let over = Groups::Over([over[0], over[1], 1]);
        recorder.run(bindings.dispatch(displace_comp::Constants { displaces }, push, over))
    };
    for (level, &[of_squares, of_sides]) in surface.levels.iter().enumerate() {
        let halved = side >> (level + 1);
        let squares = 1 << level;
        run(DISPLACES_SQUARES, halved, of_squares, [squares, squares])?;
        run(DISPLACES_SIDES, halved, of_sides, [squares, 2 * squares])?;
    }
    run(DISPLACES_EXTREMES, 1, 0.0, [side, side])?;
    run(DISPLACES_SCALING, 1, 0.0, [side, side])
}

/// Sets every texel of an image.
fn fill<T: bytemuck::Pod>(device: &Device, image: &Image, texels: &[T]) -> Result<()> {
    let buffer = device.buffer::<T>("texels", texels.len(), Memory::Upload)?;
    buffer.write(0, texels)?;
    let [width, height] = image.size();
    let mut recorder = device.recorder(Timing::Off)?;
    recorder.write_image("fill", image, [0, 0, width, height], (&buffer, 0))?;
    recorder.finish()?.run()
}
