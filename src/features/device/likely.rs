//! How likely each pixel is as background, and the silhouette of what is not: the twin of [`crate::features::likelihood`]. Logarithms
//! come from the processor: of the plate once, of what a picture's noise makes of every slope whenever that changes.

use anyhow::{Context, Result, bail};
use image::RgbImage;

use super::bounds::bounds_of;
use super::cleaning::join;
use super::view::{Brings, DeviceView, Input, Plane, copy_whole};
use crate::features::held::HeldLikelihood;
use crate::features::likelihood::BackgroundColours;
use crate::features::shaders::{RATIO_GRID, layout, likely_comp, masked_comp, shadowed_comp, unlikely_comp};
use crate::features::{FeatureSettings, ForegroundKind};
use crate::gpu::{Buffer, Device, Groups, Memory, Recorder, StagedBuffer, Timing};

/// What the device keeps of a view to judge its pixels by.
#[derive(Debug)]
pub(super) struct LikelyView {
    /// Of the background's colours what takes logarithms and roots.
    logarithms: StagedBuffer,
    slopes: StagedBuffer,
    light: Buffer,
    /// Pixels in shadow and pixels that look like background.
    counted: Buffer,
    /// Of a view without a plate.
    learnt: Option<Learnt>,
}

/// The background of a view as its mixture knows it: what it is on the device, told to the host, and brought back as a plate.
#[derive(Debug)]
pub(super) struct Learnt {
    /// Red, green, blue, a word a pixel.
    pub(super) colours: Buffer,
    pub(super) out: Buffer,
    plate: StagedBuffer,
}

impl LikelyView {
    /// For a view of that size with a plate of these colours, or with a background that is learnt or not needed.
    pub(super) fn new(device: &Device, view: &DeviceView, colours: Option<&BackgroundColours>) -> Result<Self> {
        let pixels = view.picture.width as usize * view.picture.height as usize;
        let learnt = || -> Result<Learnt> {
            Ok(Learnt {
                colours: device.buffer::<u32>("learnt colours", pixels, Memory::Device)?,
                out: device.buffer::<u32>("learnt colours readback", pixels, Memory::Readback)?,
                plate: StagedBuffer::new::<u32>(device, "learnt plate", (3 * pixels).div_ceil(4))?,
            })
        };
        let own = Self {
            logarithms: StagedBuffer::new::<f32>(device, "background's logarithms", pixels)?,
            slopes: StagedBuffer::new::<u32>(device, "background's slopes", pixels.div_ceil(4))?,
            light: device.buffer::<layout::LightTable>("light", 1, Memory::Device)?,
            counted: device.buffer::<u32>("shadows", 2, Memory::Device)?,
            learnt: colours.is_none().then(learnt).transpose()?,
        };
        if let Some(colours) = colours {
            own.write(colours)?;
            let mut recorder = device.recorder(Timing::Off)?;
            own.record_upload(&mut recorder)?;
            recorder.finish()?.run()?;
        }
        Ok(own)
    }

    fn write(&self, colours: &BackgroundColours) -> Result<()> {
        let (logarithms, slopes) = colours.planes();
        self.logarithms.staging.write(0, logarithms)?;
        self.slopes.staging.write(0, slopes)
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.logarithms.record_upload(recorder)?;
        self.slopes.record_upload(recorder)?;
        self.learnt.as_ref().map_or(Ok(()), |learnt| learnt.plate.record_upload(recorder))
    }

    /// How its background is learnt, where it has no plate.
    pub(super) fn learnt(&self) -> Option<&Learnt> {
        self.learnt.as_ref()
    }

    /// Takes what was learnt, and its colours, for the plate of a frame.
    pub(super) fn take(&self, learnt: &RgbImage, colours: &BackgroundColours) -> Result<()> {
        self.write(colours)?;
        self.learnt.as_ref().map_or(Ok(()), |own| own.plate.staging.write(0, learnt.as_raw().as_slice()))
    }
}

impl Learnt {
    /// What the device has learnt of a background of that size.
    pub(super) fn read(&self, view: &DeviceView) -> Result<RgbImage> {
        let (width, height) = (view.picture.width, view.picture.height);
        let mut words = vec![0_u32; width as usize * height as usize];
        self.out.read(0, &mut words)?;
        let bytes = words.into_iter().flat_map(|word| {
            let [red, green, blue, _] = word.to_le_bytes();
            [red, green, blue]
        });
        RgbImage::from_raw(width, height, bytes.collect()).context("a learnt background has not its view's size")
    }
}

/// A view whose pixels are judged in a frame.
#[derive(Clone, Copy)]
struct Judged<'a> {
    view: &'a DeviceView,
    likely: &'a LikelyView,
    plate: &'a Buffer,
    held: &'a HeldLikelihood,
}

impl Judged<'_> {
    fn push(&self, is_again: bool) -> layout::Likely {
        layout::Likely {
            width: self.view.picture.width,
            height: self.view.picture.height,
            motion: self.held.motion,
            again: u32::from(is_again),
        }
    }
}

/// Records the likelihoods of a frame's views, to what is `held` of them: `brings` says which views bring their silhouette with them, which
/// is there already. Where silhouettes are found by likelihood, they are left as the views' own.
///
/// # Errors
/// As [`Recorder::run`].
pub(super) fn likelihoods(
    recorder: &mut Recorder,
    (views, likely): (&[DeviceView], &[LikelyView]),
    (inputs, brings): (&[Input], &[Brings]),
    held: &[&HeldLikelihood],
    settings: &FeatureSettings,
) -> Result<()> {
    let (mut judged, mut with_mask) = (Vec::new(), Vec::new());
    for ((((view, likely), input), brings), held) in views.iter().zip(likely).zip(inputs).zip(brings).zip(held) {
        if brings.mask {
            with_mask.push((view, *held));
            continue;
        }
        let plate = match &likely.learnt {
            Some(learnt) => {
                likely.record_upload(recorder)?;
                Some(&learnt.plate.buffer)
            }
            None => view.plate(),
        };
        let (Some(plate), Some(light)) = (plate, &input.light) else { bail!("a view has no background to judge by") };
        copy_whole(recorder, "upload", &light.staging, &likely.light)?;
        recorder.fill("shadows", &likely.counted, 0)?;
        judged.push(Judged { view, likely, plate, held });
    }
    recorder.run_all(with_mask.iter().map(|(view, held)| {
        let mask = view.plane(Plane::Silhouette);
        masked_comp::Bindings { colours: &view.colours, mask, seen: &held.seen }
            .dispatch(view.picture, view.every_pixel())
    }))?;
    let sides: Vec<_> = with_mask.iter().map(|(view, held)| (*view, &held.sides)).collect();
    bounds_of(recorder, &sides, Plane::Silhouette)?;
    let [foreground, silhouette] = planes(settings);
    // First as if shadows were as frequent everywhere, then round the person with those counted there.
    for is_again in [false, true] {
        if is_again {
            count_shadows(recorder, &judged)?;
        }
        judge(recorder, &judged, is_again)?;
        recorder.run_all(judged.iter().map(|Judged { view, held, .. }| {
            unlikely_comp::Bindings { seen: &held.seen, foreground: view.plane(foreground) }
                .dispatch(view.picture, view.every_word())
        }))?;
        let of_judged: Vec<&DeviceView> = judged.iter().map(|judged| judged.view).collect();
        join(recorder, &of_judged, settings, [foreground, silhouette])?;
        let sides: Vec<_> = judged.iter().map(|judged| (judged.view, &judged.held.sides)).collect();
        bounds_of(recorder, &sides, silhouette)?;
    }
    Ok(())
}

/// Where what does not look like background is left, and the silhouette made of it.
fn planes(settings: &FeatureSettings) -> [Plane; 2] {
    match settings.foreground {
        ForegroundKind::Likelihood => [Plane::Foreground, Plane::Silhouette],
        ForegroundKind::Difference => [Plane::LikelyForeground, Plane::LikelySilhouette],
    }
}

fn judge(recorder: &mut Recorder, judged: &[Judged<'_>], is_again: bool) -> Result<()> {
    if !is_again {
        // Read by nobody yet, and bound all the same.
        judged.iter().try_for_each(|judged| recorder.fill("bounds", &judged.held.sides, 0))?;
    }
    recorder.run_all(judged.iter().map(|judged| {
        let &Judged { view, likely, plate, held } = judged;
        likely_comp::Bindings {
            colours: &view.colours,
            plate,
            logarithms: &likely.logarithms.buffer,
            slopes: &likely.slopes.buffer,
            light: &likely.light,
            sides: &held.sides,
            counted: &likely.counted,
            seen: &held.seen,
        }
        .dispatch(judged.push(is_again), view.every_pixel())
    }))
}

fn count_shadows(recorder: &mut Recorder, judged: &[Judged<'_>]) -> Result<()> {
    recorder.run_all(judged.iter().map(|judged| {
        let &Judged { view, likely, plate, held } = judged;
        let [columns, rows] = [view.picture.width, view.picture.height].map(|side| side.div_ceil(RATIO_GRID / 2));
        shadowed_comp::Bindings {
            colours: &view.colours,
            plate,
            logarithms: &likely.logarithms.buffer,
            slopes: &likely.slopes.buffer,
            light: &likely.light,
            sides: &held.sides,
            counted: &likely.counted,
        }
        .dispatch(judged.push(true), Groups::Flat(columns * rows))
    }))
}
