//! What differs from a plate or from what is known of the background: the twins of [`crate::features::plate::Plate`], of
//! [`crate::features::mixture::Mixture`], which stays on the device, and of the ratios of `features::light`.

use anyhow::Result;

use super::view::{Band, DeviceView, Plane};
use crate::features::shaders::{
    ADAPTATION_DENSITY, ADAPTATION_WEIGHT, RATIO_GRID, bridge_comp, difference_comp, gain_comp, layout, mixture_comp,
    probable_comp, ratios_comp,
};
use crate::features::{Adaptation, MixtureSettings, PlateSettings, ShadowSettings};
use crate::gpu::{Buffer, Groups, Recorder};

/// Pixels of the grid that an invocation of `ratios.comp` counts.
const PIXELS_EACH: u32 = 16;

/// Records how much brighter pictures are than their background, channel by channel: `colours` against the light's `grid` to its
/// `gains`.
pub(super) fn ratios(recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
    for view in views {
        recorder.fill("ratios", &view.light.counts, 0)?;
    }
    recorder.run_all(views.iter().map(|view| {
        let (width, height) = (view.picture.width, view.picture.height);
        let pixels = width.div_ceil(RATIO_GRID) * height.div_ceil(RATIO_GRID);
        ratios_comp::Bindings { colours: &view.colours, background: &view.light.grid, counts: &view.light.counts }
            .dispatch(layout::Ratios { width, height }, Groups::Flat(pixels.div_ceil(PIXELS_EACH)))
    }))?;
    recorder.run_all(views.iter().map(|view| {
        gain_comp::Bindings { counts: &view.light.counts, gains: &view.light.gains }.dispatch(Groups::Count([1; 3]))
    }))
}

/// Records it for views with a plate: `colours` against the plate in the light's `gains` to three planes.
pub(super) fn difference(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    settings: &PlateSettings,
    shadow: &ShadowSettings,
) -> Result<()> {
    recorder.run_all(views.iter().map(|view| {
        let push = layout::Difference {
            width: view.picture.width,
            stride: view.picture.stride,
            weak_squared: settings.weak * settings.weak,
            strong_squared: settings.strong * settings.strong,
            faint_squared: settings.faint * settings.faint,
            suppress: u32::from(shadow.suppress),
            darkest: shadow.darkest,
            brightest: shadow.brightest,
            chroma_squared: shadow.chroma * shadow.chroma,
        };
        difference_comp::Bindings {
            colours: &view.colours,
            // A view without a plate is not asked for its differences; its own colours would be none.
            plate: view.plate().unwrap_or(&view.colours),
            gains: &view.light.gains,
            weak: view.plane(Plane::Foreground),
            strong: view.plane(Plane::Strong),
            faint: view.plane(Plane::Faint),
        }
        .dispatch(push, view.every_pixel())
    }))
}

/// Records what a closing adds to a silhouette where the picture differs faintly from the plate: a silhouette and its closing to
/// another plane.
pub(super) fn bridge(recorder: &mut Recorder, views: &[&DeviceView], [from, closed, to]: [Plane; 3]) -> Result<()> {
    recorder.run_all(views.iter().map(|view| {
        bridge_comp::Bindings {
            before: view.plane(from),
            closed: view.plane(closed),
            faint: view.plane(Plane::Faint),
            after: view.plane(to),
        }
        .dispatch(layout::Bridge { words: view.words() }, view.every_word())
    }))
}

/// Records the colours of the most probable components, on the light's `grid`.
pub(super) fn probable(recorder: &mut Recorder, views: &[&DeviceView], settings: &MixtureSettings) -> Result<()> {
    let grids: Vec<&Buffer> = views.iter().map(|view| &view.light.grid).collect();
    probable_every(recorder, (views, &grids), RATIO_GRID, settings)
}

/// Records the same of `every` so many rows and columns, to a buffer beside each view.
pub(super) fn probable_every(
    recorder: &mut Recorder,
    (views, to): (&[&DeviceView], &[&Buffer]),
    every: u32,
    settings: &MixtureSettings,
) -> Result<()> {
    let constants = probable_comp::Constants { components: settings.components as u32 };
    for_each_band(views, |of_band| {
        recorder.run_all(of_band.iter().map(|(at, view, band)| {
            let width = view.picture.width;
            let push = layout::Probable { width, rows: band.rows, first_row: band.first_row, every };
            probable_comp::Bindings { state: &band.state, background: to[*at] }.dispatch(
                constants,
                push,
                Groups::Over([width.div_ceil(every), band.rows.div_ceil(every), 1]),
            )
        }))
    })
}

/// Records a mixture's step: `colours` at a view's `rates`, one beside each view, into its bands, what they do not explain to the
/// foreground.
pub(super) fn mixture(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    rates: &[&Buffer],
    settings: &MixtureSettings,
    shadow: &ShadowSettings,
) -> Result<()> {
    let constants = mixture_comp::Constants {
        components: settings.components as u32,
        adaptation: match settings.adaptation {
            Adaptation::Weight => ADAPTATION_WEIGHT,
            Adaptation::Density => ADAPTATION_DENSITY,
        },
        gain: u32::from(settings.gain),
    };
    for_each_band(views, |of_band| {
        recorder.run_all(of_band.iter().map(|(at, view, band)| {
            let push = layout::Mixture {
                width: view.picture.width,
                rows: band.rows,
                first_row: band.first_row,
                stride: view.picture.stride,
                match_squared: settings.match_sigma * settings.match_sigma,
                background_weight: settings.background_weight,
                initial_variance: settings.initial_sigma * settings.initial_sigma,
                initial_weight: settings.initial_weight,
                least_variance: settings.min_sigma * settings.min_sigma,
                suppress: u32::from(shadow.suppress),
                darkest: shadow.darkest,
                brightest: shadow.brightest,
                chroma_squared: shadow.chroma * shadow.chroma,
            };
            mixture_comp::Bindings {
                colours: &view.colours,
                gains: &view.light.gains,
                rates: rates[*at],
                state: &band.state,
                foreground: view.plane(Plane::Foreground),
            }
            .dispatch(constants, push, Groups::Over([push.width, band.rows, 1]))
        }))
    })
}

/// Takes the first bands of all views, each with the place of its view, then the second ones of those that have more, and so on.
fn for_each_band<'a>(
    views: &[&'a DeviceView],
    mut record: impl FnMut(&[(usize, &'a DeviceView, &'a Band)]) -> Result<()>,
) -> Result<()> {
    let most = views.iter().map(|view| view.bands().len()).max().unwrap_or(0);
    (0..most).try_for_each(|nth| {
        let band = |(at, view): (usize, &&'a DeviceView)| Some((at, *view, view.bands().get(nth)?));
        let of_band: Vec<_> = views.iter().enumerate().filter_map(band).collect();
        record(&of_band)
    })
}
