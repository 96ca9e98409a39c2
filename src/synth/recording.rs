//! What the cameras record: shutters that stay open, gains, frames that are dropped or late; written as pictures or videos.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, bail};
use glam::DVec3;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use super::chroma::with_half_chroma;
use super::device::DevicePainter;
use super::figure::Figure;
use super::hash::hash;
use super::noise::Sensor;
use super::performance::Performance;
use super::render::{Cast, Light, View};
use super::scene::{CameraSettings, LightSettings, PictureForm, Scene};
use crate::files::{OutputFolder, listed, shortened};
use crate::geometry::Camera;
use crate::sequence::VideoEncoder;

/// Told the number of frames that are drawn, from any thread. Its error ends the work.
pub type Advance<'a> = dyn Fn(usize) -> Result<()> + Sync + 'a;

/// Frames that are drawn at once before they go to the videos' encoders in order.
const BATCH: usize = 16;

/// How a camera records.
#[derive(Clone, Debug)]
pub(super) struct Shutter {
    sensor: Sensor,
    /// Seconds that it stays open around a frame's time.
    open: f64,
    sub_frames: usize,
    /// Seconds by which its frames are late.
    late: f64,
    /// The frame that each frame shows: an earlier one where it was dropped.
    shown: Vec<usize>,
}

/// Seconds are compared to the nanosecond: only what is really another time is drawn again.
fn same_time(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// The shutters of a scene's cameras.
///
/// # Errors
/// When a `[[camera]]` is none of the cameras, or is there twice.
pub(super) fn shutters(scene: &Scene, cameras: &[Camera]) -> Result<Vec<Shutter>> {
    for (index, settings) in scene.camera.iter().enumerate() {
        if !cameras.iter().any(|camera| camera.name == settings.name) {
            let known: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
            bail!("[[camera]] names `{}`, expected one of {}", shortened(&settings.name), listed(&known));
        }
        if scene.camera[..index].iter().any(|other| other.name == settings.name) {
            bail!("[[camera]] `{}` is there twice, expected once", settings.name);
        }
    }
    let shutter = |(index, camera): (usize, &Camera)| {
        let own = scene.camera.iter().find(|settings| settings.name == camera.name).cloned().unwrap_or_default();
        let exposure = own.exposure.unwrap_or(scene.sensor.exposure) / 1000.0;
        if exposure > 1.0 / scene.fps {
            bail!(
                "camera `{}`: exposure is {} ms, expected at most the time from frame to frame",
                own.name,
                exposure * 1000.0
            );
        }
        let sensor = Sensor::new(own.noise.unwrap_or(scene.sensor.noise), scene.seed)
            .with_gain(own.gain.unwrap_or(scene.sensor.gain))
            .grey(scene.sensor.grey);
        Ok(Shutter {
            sensor,
            open: exposure,
            sub_frames: if exposure > 0.0 { scene.sensor.sub_frames } else { 1 },
            late: own.shift.unwrap_or(0.0) / scene.fps,
            shown: shown(&own, scene, index),
        })
    };
    cameras.iter().enumerate().map(shutter).collect()
}

/// Which frame each frame shows.
fn shown(camera: &CameraSettings, scene: &Scene, index: usize) -> Vec<usize> {
    let rate = camera.drop_rate.unwrap_or(0.0);
    let mut last = 0;
    (0..scene.frames)
        .map(|frame| {
            let counter = scene.seed ^ ((index as u64) << 40) ^ ((frame as u64) << 8) ^ 0xd5;
            let by_chance = f64::from(hash(counter)) < rate * 4_294_967_296.0;
            if frame == 0 || !(by_chance || camera.dropped.contains(&frame)) {
                last = frame;
            }
            last
        })
        .collect()
}

impl Shutter {
    /// Frames that were dropped.
    pub(super) fn dropped(&self) -> impl Iterator<Item = usize> + '_ {
        self.shown.iter().enumerate().filter(|(frame, shown)| *frame != **shown).map(|(frame, _)| frame)
    }

    /// The times at which the picture of a frame is taken, seconds.
    fn times(&self, frame: usize, fps: f64) -> Vec<f64> {
        let middle = self.shown[frame] as f64 / fps + self.late;
        (0..self.sub_frames).map(|i| middle + self.open * ((i as f64 + 0.5) / self.sub_frames as f64 - 0.5)).collect()
    }
}

/// Everything that is drawn.
pub(super) struct Studio<'a> {
    pub(super) scene: &'a Scene,
    pub(super) figures: &'a [Figure],
    pub(super) performances: &'a [Performance],
    pub(super) views: &'a [View],
    pub(super) shutters: &'a [Shutter],
    /// What draws; the processor where there is none.
    pub(super) painter: Option<DevicePainter>,
}

/// One camera's picture of one frame, and where the tracked person is in it.
pub(super) struct Shot {
    pub(super) bytes: Vec<u8>,
    /// 255 where at least half of the pixel shows the tracked person, on average over the exposure.
    pub(super) mask: Vec<u8>,
}

/// How much light there is at a time, as a factor.
fn brightness(light: &LightSettings, time: f64) -> f32 {
    (1.0 + light.swing * (std::f64::consts::TAU * time / light.period).sin()) as f32
}

impl Studio<'_> {
    /// The pictures of one frame that are asked for, by index of the camera.
    pub(super) fn shots(&self, frame: usize, asked: &[usize]) -> Result<Vec<Shot>> {
        let times: Vec<Vec<f64>> = asked.iter().map(|&view| self.shutters[view].times(frame, self.scene.fps)).collect();
        let mut sums: Vec<(Light, Vec<u16>)> = Vec::with_capacity(asked.len());
        for &view in asked {
            let pixels = self.views[view].plate().len();
            sums.push((vec![[0.0; 3]; pixels], vec![0; pixels]));
        }
        // Each instant is posed once for all cameras that see it.
        let mut instants: Vec<f64> = Vec::new();
        for time in times.iter().flatten() {
            if !instants.iter().any(|other| same_time(*other, *time)) {
                instants.push(*time);
            }
        }
        let light = &self.scene.light;
        let lamps: Vec<DVec3> = light.position.iter().chain(&light.lamps).map(|at| DVec3::from(*at)).collect();
        for instant in instants {
            let poses = self.performances.iter().map(|performance| performance.pose(instant));
            let poses: Vec<Vec<f64>> = poses.collect::<Result<_>>()?;
            let figures = self.figures.iter().zip(&poses).map(|(figure, pose)| figure.place(pose));
            let figures: Vec<_> = figures.collect::<Result<_>>()?;
            let cast = Cast::lit(&figures, &lamps, light.softness)?;
            let bright = brightness(&self.scene.light, instant);
            let mut is_wanted = vec![false; self.views.len()];
            for (&view, times) in asked.iter().zip(&times) {
                is_wanted[view] = times.iter().any(|time| same_time(*time, instant));
            }
            let pictures = self.pictures(&cast, &is_wanted)?;
            for ((&view, times), (sum, covered)) in asked.iter().zip(&times).zip(&mut sums) {
                if !is_wanted[view] {
                    continue;
                }
                let share = bright / times.len() as f32;
                let (light, coverage) = &pictures[view];
                for (sum, light) in sum.iter_mut().zip(light) {
                    for (sum, value) in sum.iter_mut().zip(light) {
                        *sum += value * share;
                    }
                }
                covered.iter_mut().zip(coverage).for_each(|(sum, quarters)| *sum += u16::from(*quarters));
            }
        }
        let mut shots = Vec::with_capacity(asked.len());
        for ((&view, times), (light, covered)) in asked.iter().zip(&times).zip(sums) {
            let shutter = &self.shutters[view];
            let half = 2 * times.len() as u16;
            // A dropped frame is the same picture once more, noise and all.
            let mut bytes = shutter.sensor.expose(&light, view, shutter.shown[frame]);
            if self.scene.output.half_chroma {
                with_half_chroma(&mut bytes, self.views[view].camera().size);
            }
            shots.push(Shot {
                bytes,
                mask: covered.iter().map(|&quarters| if quarters >= half { 255 } else { 0 }).collect(),
            });
        }
        Ok(shots)
    }

    /// The pictures of the views that are wanted, empty ones of the others.
    fn pictures(&self, cast: &Cast<'_>, is_wanted: &[bool]) -> Result<Vec<(Light, Vec<u8>)>> {
        if let Some(painter) = &self.painter {
            return painter.pictures(cast, self.views, is_wanted);
        }
        let picture =
            |(view, &is_wanted): (&View, &bool)| if is_wanted { view.picture(cast) } else { Default::default() };
        Ok(self.views.iter().zip(is_wanted).map(picture).collect())
    }

    /// The camera's picture of the empty room, without noise.
    pub(super) fn plate(&self, view: usize) -> Vec<u8> {
        self.shutters[view].sensor.expose_clean(self.views[view].plate())
    }

    /// Draws all frames into `folder`. With `resume` pictures and videos that are there are kept.
    pub(super) fn record(&self, folder: &OutputFolder, resume: bool, progress: &Advance<'_>) -> Result<()> {
        let output = &self.scene.output;
        let is_video = output.pictures == PictureForm::Video;
        folder.file(if is_video { "videos/x" } else { "frames/x" })?;
        if output.masks {
            folder.file("masks/x")?;
        }
        let path = |name: String| folder.path().join(name);
        let done = AtomicUsize::new(0);
        let mut encoders = Vec::new();
        if is_video {
            for (index, view) in self.views.iter().enumerate() {
                let camera = view.camera();
                let file = path(source_of(camera, output.pictures));
                if !(resume && file.exists()) {
                    encoders.push((
                        index,
                        VideoEncoder::create(&file, camera.size, self.scene.fps, self.scene.sensor.grey, output.crf)?,
                    ));
                }
            }
        }
        let encoded: Vec<usize> = encoders.iter().map(|(index, _)| *index).collect();
        let frames: Vec<usize> = (0..self.scene.frames).collect();
        for batch in frames.chunks(BATCH) {
            let drawn: Vec<Vec<Shot>> = batch
                .par_iter()
                .map(|&frame| -> Result<Vec<Shot>> {
                    let files = |view: usize| {
                        let name = &self.views[view].camera().name;
                        let picture = (!is_video)
                            .then(|| path(numbered(&source_of(self.views[view].camera(), output.pictures), frame)));
                        let mask = output.masks.then(|| path(format!("masks/{name}_{frame:04}.png")));
                        (picture, mask)
                    };
                    let is_missing =
                        |file: &Option<PathBuf>| file.as_ref().is_some_and(|file| !(resume && file.exists()));
                    let asked: Vec<usize> = (0..self.views.len())
                        .filter(|view| {
                            let (picture, mask) = files(*view);
                            encoded.contains(view) || is_missing(&picture) || is_missing(&mask)
                        })
                        .collect();
                    let shots = if asked.is_empty() { Vec::new() } else { self.shots(frame, &asked)? };
                    for (&view, shot) in asked.iter().zip(&shots) {
                        let size = self.views[view].camera().size;
                        let (picture, mask) = files(view);
                        if let Some(file) = picture {
                            write_picture(&file, size, &shot.bytes, output.quality)?;
                        }
                        if let Some(file) = mask {
                            write_picture(&file, size, &shot.mask, output.quality)?;
                        }
                    }
                    progress(done.fetch_add(1, Ordering::Relaxed) + 1)?;
                    let to_encode = asked.into_iter().zip(shots).filter(|(view, _)| encoded.contains(view));
                    Ok(to_encode.map(|(_, shot)| shot).collect())
                })
                .collect::<Result<_>>()?;
            for shots in drawn {
                for ((_, encoder), shot) in encoders.iter_mut().zip(shots) {
                    encoder.write(&shot.bytes)?;
                }
            }
        }
        encoders.into_iter().try_for_each(|(_, encoder)| encoder.finish())
    }
}

/// The source of a view in sequence.toml.
pub(super) fn source_of(camera: &Camera, pictures: PictureForm) -> String {
    let [folder, number, extension] = pictures.place();
    format!("{folder}/{}{number}.{extension}", camera.name)
}

fn numbered(pattern: &str, frame: usize) -> String {
    pattern.replace("%04d", &format!("{frame:04}"))
}

/// Writes a grey or colour picture as its name says, PNG or JPEG. Pictures are many and can be made again: they are
/// renamed when complete, so that a resumed run can trust them, but not waited for to reach the disk.
pub(super) fn write_picture(path: &Path, size: [u32; 2], bytes: &[u8], quality: u8) -> Result<()> {
    let format =
        if bytes.len() == (size[0] * size[1]) as usize { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let mut file = Vec::with_capacity(bytes.len());
    let encoded = if path.extension().is_some_and(|extension| extension == "jpg") {
        JpegEncoder::new_with_quality(&mut file, quality).write_image(bytes, size[0], size[1], format)
    } else {
        PngEncoder::new_with_quality(&mut file, CompressionType::Fast, FilterType::Sub)
            .write_image(bytes, size[0], size[1], format)
    };
    let temporary = path.with_extension("tmp");
    encoded
        .and_then(|()| Ok(fs::write(&temporary, &file).and_then(|()| fs::rename(&temporary, path))?))
        .with_context(|| format!("cannot write {}", path.display()))
}
