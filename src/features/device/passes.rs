//! The passes of a frame on the device, in order. Each gives what its twin on the processor gives, bit by bit: most are whole
//! numbers, and the rest adds, multiplies, divides and takes roots (`glsl/arithmetic/rounding.glsl`) in the same order, nothing
//! fused.

use anyhow::Result;

use super::bounds::bounds;
use super::components::{Keep, components};
use super::edges::{edges, smooth};
use super::foreground::{bridge, difference, mixture, probable, ratios};
use super::morphology::{Operation, closing, morphology, opening};
use super::view::{DeviceView, Input, Plane, copy_whole};
use crate::features::held::HeldView;
use crate::features::shaders::{
    METRIC_CHESSBOARD, METRIC_CITY_BLOCK, METRIC_EUCLIDEAN, METRIC_QUASI_EUCLIDEAN, RATIO_STEPS, distance_comp,
    pack_comp, reach_comp,
};
use crate::features::{FeatureSettings, Metric};
use crate::gpu::{Buffer, Groups, Recorder};

/// Records a frame, from what the host fills to what is `packed`, one a view: `masked` says which views bring their silhouette with
/// them, `proximity` holds the 7-bit value of every code of a map.
pub(super) fn record_frame(
    recorder: &mut Recorder,
    views: &[DeviceView],
    (inputs, masked): (&[Input], &[bool]),
    settings: &FeatureSettings,
    proximity: &Buffer,
    packed: &[HeldView],
) -> Result<()> {
    let all: Vec<&DeviceView> = views.iter().collect();
    let of = |wanted: &dyn Fn(&DeviceView, bool) -> bool| -> Vec<&DeviceView> {
        views.iter().zip(masked).filter(|&(view, &masked)| wanted(view, masked)).map(|(view, _)| view).collect()
    };
    let segmented = of(&|_, masked| !masked);
    let with_plate = of(&|view, masked| !masked && view.plate().is_some());
    let with_mixture = of(&|view, masked| !masked && view.plate().is_none());
    for ((view, input), masked) in views.iter().zip(inputs).zip(masked) {
        copy_whole(recorder, "upload", &input.colours, &view.colours)?;
        if *masked {
            copy_whole(recorder, "upload", &input.mask, view.plane(Plane::Silhouette))?;
        }
    }
    if settings.plate.gain {
        ratios(recorder, &with_plate)?;
    } else {
        with_plate.iter().try_for_each(|view| recorder.fill("gain", &view.light.gains, RATIO_STEPS))?;
    }
    difference(recorder, &with_plate, &settings.plate, &settings.shadow)?;
    let of_mixture = |&((view, _), masked): &((&DeviceView, &Input), &bool)| !masked && view.plate().is_none();
    let learning = views.iter().zip(inputs).zip(masked).filter(of_mixture);
    let rates: Vec<&Buffer> = learning.map(|((_, input), _)| &input.rates).collect();
    record_mixture(recorder, &with_mixture, &rates, settings)?;
    record_cleaning(recorder, &segmented, &with_plate, settings)?;
    bounds(recorder, &all, Plane::Silhouette)?;
    smooth(recorder, &all, settings.edges.smooth)?;
    let near = [Plane::Silhouette, Plane::Near];
    morphology(recorder, &all, Operation::Dilate, settings.dilation(), near)?;
    edges(recorder, &all, &settings.edges)?;
    record_distance(recorder, &all, settings.distance.metric)?;
    recorder.run_all(all.iter().zip(packed).map(|(view, packed)| {
        pack_comp::Bindings {
            silhouette: view.plane(Plane::Silhouette),
            codes: &view.codes,
            proximity,
            pixels: &packed.pixels,
            planes: &packed.planes,
        }
        .dispatch(view.picture, Groups::Flat(view.picture.width.div_ceil(32) * view.picture.height))
    }))
}

/// Records what views without a plate, each with what the host fills, learn from a frame of the empty scene.
pub(super) fn record_priming(
    recorder: &mut Recorder,
    views: &[(&DeviceView, &Input)],
    settings: &FeatureSettings,
) -> Result<()> {
    for (view, input) in views {
        copy_whole(recorder, "upload", &input.colours, &view.colours)?;
    }
    let (views, rates): (Vec<_>, Vec<_>) = views.iter().map(|(view, input)| (*view, &input.rates)).unzip();
    record_mixture(recorder, &views, &rates, settings)
}

fn record_mixture(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    rates: &[&Buffer],
    settings: &FeatureSettings,
) -> Result<()> {
    if settings.mixture.gain {
        probable(recorder, views, &settings.mixture)?;
        ratios(recorder, views)?;
    }
    mixture(recorder, views, rates, &settings.mixture, &settings.shadow)
}

/// From foreground to silhouette; those with a plate have their hysteresis and bridges.
fn record_cleaning(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    with_plate: &[&DeviceView],
    settings: &FeatureSettings,
) -> Result<()> {
    use Plane::{Foreground, Silhouette, Strong, WorkA, WorkB, WorkC};
    let holes = Keep::Holes(settings.silhouette.max_hole);
    opening(recorder, views, settings.opening(), [Foreground, WorkA, WorkB])?;
    components(recorder, with_plate, Keep::Touched, Strong, [WorkB, WorkA])?;
    closing(recorder, with_plate, settings.bridge(), [WorkA, WorkB, WorkC])?;
    bridge(recorder, with_plate, [WorkA, WorkC, WorkB])?;
    closing(recorder, views, settings.closing(), [WorkB, WorkA, WorkC])?;
    components(recorder, views, Keep::largest(&settings.silhouette), Strong, [WorkC, WorkA])?;
    components(recorder, views, holes, Strong, [WorkA, Silhouette])
}

/// The twin of [`crate::features::DistanceMap::measure`]: vertical distances to the nearest edge, then distances from them.
fn record_distance(recorder: &mut Recorder, views: &[&DeviceView], metric: Metric) -> Result<()> {
    let metric = match metric {
        Metric::Chessboard => METRIC_CHESSBOARD,
        Metric::CityBlock => METRIC_CITY_BLOCK,
        Metric::Euclidean => METRIC_EUCLIDEAN,
        Metric::QuasiEuclidean => METRIC_QUASI_EUCLIDEAN,
    };
    recorder.run_all(views.iter().map(|view| {
        reach_comp::Bindings { edges: view.plane(Plane::Edges), reach: &view.reach }
            .dispatch(view.picture, view.every_pixel())
    }))?;
    recorder.run_all(views.iter().map(|view| {
        distance_comp::Bindings { reach: &view.reach, codes: &view.codes }.dispatch(
            distance_comp::Constants { metric },
            view.picture,
            view.every_pixel(),
        )
    }))
}
