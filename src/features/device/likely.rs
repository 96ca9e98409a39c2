//! How likely each pixel is as background, and the silhouette of what is not: the twin of [`crate::features::likelihood`]. Logarithms
//! come from the processor: of the plate once, of what a picture's noise makes of every slope whenever that changes.

use anyhow::{Result, bail};

use super::bounds::bounds_of;
use super::cleaning::join;
use super::light_input::LightInput;
use super::view::{Brings, DeviceView, Input, Plane, copy_whole};
use crate::features::held::HeldLikelihood;
use crate::features::likelihood::BackgroundColours;
use crate::features::shaders::{RATIO_GRID, layout, likely_comp, masked_comp, shadowed_comp, unlikely_comp};
use crate::features::{FeatureSettings, ForegroundKind};
use crate::gpu::{Buffer, Device, Groups, Memory, Recorder};

/// What the device keeps of a view to judge its pixels by.
#[derive(Debug)]
pub(super) struct LikelyView {
    /// None of a view without a plate, whose pixels ready masks tell about.
    known: Option<KnownColours>,
}

/// Of a plate's colours what takes logarithms and roots, and a picture's light.
#[derive(Debug)]
struct KnownColours {
    logarithms: Buffer,
    slopes: Buffer,
    light: Buffer,
    /// Pixels in shadow and pixels that look like background.
    counted: Buffer,
}

impl LikelyView {
    pub(super) fn new(device: &Device, colours: Option<&BackgroundColours>) -> Result<Self> {
        let known = |colours: &BackgroundColours| -> Result<KnownColours> {
            let (logarithms, slopes) = colours.planes();
            let mut slopes = slopes.to_vec();
            slopes.resize(slopes.len().next_multiple_of(4), 0);
            Ok(KnownColours {
                logarithms: device.uploaded("plate's logarithms", logarithms)?,
                slopes: device.uploaded("plate's slopes", &slopes)?,
                light: device.buffer::<layout::LightTable>("light", 1, Memory::Device)?,
                counted: device.buffer::<u32>("shadows", 2, Memory::Device)?,
            })
        };
        Ok(Self { known: colours.map(known).transpose()? })
    }

    /// What the host fills of it for a frame.
    pub(super) fn input(&self, device: &Device) -> Result<Option<LightInput>> {
        self.known.as_ref().map(|_| LightInput::new(device)).transpose()
    }
}

/// A view whose pixels are judged in a frame.
#[derive(Clone, Copy)]
struct Judged<'a> {
    view: &'a DeviceView,
    known: &'a KnownColours,
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
/// When a view has neither a plate nor a mask; as [`Recorder::run`].
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
        let (Some(known), Some(plate), Some(light)) = (&likely.known, view.plate(), &input.light) else {
            bail!("a view has neither a plate nor a mask, and its likelihoods are to be made on a device");
        };
        copy_whole(recorder, "upload", &light.staging, &known.light)?;
        recorder.fill("shadows", &known.counted, 0)?;
        judged.push(Judged { view, known, plate, held });
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
        let &Judged { view, known, plate, held } = judged;
        likely_comp::Bindings {
            colours: &view.colours,
            plate,
            logarithms: &known.logarithms,
            slopes: &known.slopes,
            light: &known.light,
            sides: &held.sides,
            counted: &known.counted,
            seen: &held.seen,
        }
        .dispatch(judged.push(is_again), view.every_pixel())
    }))
}

fn count_shadows(recorder: &mut Recorder, judged: &[Judged<'_>]) -> Result<()> {
    recorder.run_all(judged.iter().map(|judged| {
        let &Judged { view, known, plate, held } = judged;
        let [columns, rows] = [view.picture.width, view.picture.height].map(|side| side.div_ceil(RATIO_GRID / 2));
        shadowed_comp::Bindings {
            colours: &view.colours,
            plate,
            logarithms: &known.logarithms,
            slopes: &known.slopes,
            light: &known.light,
            sides: &held.sides,
            counted: &known.counted,
        }
        .dispatch(judged.push(true), Groups::Flat(columns * rows))
    }))
}
