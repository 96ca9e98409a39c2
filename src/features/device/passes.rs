//! The passes of a frame on the device, in order. Each gives what its twin on the processor gives, bit by bit: most are whole
//! numbers, and the rest adds, multiplies, divides and takes roots (`glsl/arithmetic/rounding.glsl`) in the same order, nothing
//! fused.

use anyhow::Result;

use super::bounds::bounds;
use super::cleaning::clean;
use super::edges::{edges, smooth};
use super::foreground::{difference, mixture, probable, probable_every, ratios};
use super::likely::{LikelyView, likelihoods};
use super::morphology::{Operation, morphology};
use super::view::{Brings, DeviceView, Input, Plane, copy_whole};
use crate::features::held::HeldView;
use crate::features::shaders::{
    METRIC_CHESSBOARD, METRIC_CITY_BLOCK, METRIC_EUCLIDEAN, METRIC_QUASI_EUCLIDEAN, RATIO_STEPS, distance_comp,
    ignore_comp, layout, pack_comp, reach_comp,
};
use crate::features::{FeatureSettings, ForegroundKind, Metric};
use crate::gpu::{Buffer, Groups, Recorder};

/// Records a frame, from what the host fills to what is `packed`, one a view: `brings` says what views bring with them, `proximity` holds the 7-bit value of every code of a map. What is `likely` is made where views are given for it.
pub(super) fn record_frame(
    recorder: &mut Recorder,
    (views, likely): (&[DeviceView], &[LikelyView]),
    (inputs, brings): (&[Input], &[Brings]),
    settings: &FeatureSettings,
    proximity: &Buffer,
    packed: &[HeldView],
) -> Result<()> {
    let all: Vec<&DeviceView> = views.iter().collect();
    let of = |wanted: &dyn Fn(&DeviceView, bool) -> bool| -> Vec<&DeviceView> {
        views.iter().zip(brings).filter(|&(view, brings)| wanted(view, brings.mask)).map(|(view, _)| view).collect()
    };
    // By their likelihood silhouettes are found beside it.
    let finds_otherwise = !likely.is_empty() && settings.foreground == ForegroundKind::Likelihood;
    let segmented = of(&|_, masked| !masked && !finds_otherwise);
    let with_plate = of(&|view, masked| !masked && !finds_otherwise && view.plate().is_some());
    // Where likelihoods are made mixtures have made their step before.
    let with_mixture = of(&|view, masked| !masked && likely.is_empty() && view.plate().is_none());
    for ((view, input), brings) in views.iter().zip(inputs).zip(brings) {
        copy_whole(recorder, "upload", &input.colours, &view.colours)?;
        if brings.mask {
            copy_whole(recorder, "upload", &input.mask, view.plane(Plane::Silhouette))?;
        }
        if brings.ignored {
            copy_whole(recorder, "upload", &input.ignored, view.plane(Plane::Ignored))?;
        }
    }
    if !likely.is_empty() {
        let held: Vec<_> = packed.iter().filter_map(|view| view.likelihood.as_ref()).collect();
        likelihoods(recorder, (views, likely), (inputs, brings), &held, settings)?;
    }
    if settings.plate.gain {
        ratios(recorder, &with_plate)?;
    } else {
        with_plate.iter().try_for_each(|view| recorder.fill("gain", &view.light.gains, RATIO_STEPS))?;
    }
    difference(recorder, &with_plate, &settings.plate, &settings.shadow)?;
    let of_mixture = |&((view, _), brings): &((&DeviceView, &Input), &Brings)| {
        !brings.mask && likely.is_empty() && view.plate().is_none()
    };
    let learning = views.iter().zip(inputs).zip(brings).filter(of_mixture);
    let rates: Vec<&Buffer> = learning.map(|((_, input), _)| &input.rates).collect();
    record_mixture(recorder, &with_mixture, &rates, settings)?;
    clean(recorder, &segmented, &with_plate, settings)?;
    bounds(recorder, &all, Plane::Silhouette)?;
    smooth(recorder, &all, settings.edges.smooth)?;
    let near = [Plane::Silhouette, Plane::Near];
    morphology(recorder, &all, Operation::Dilate, settings.dilation(), near)?;
    edges(recorder, &all, &settings.edges)?;
    let ignoring = views.iter().zip(brings).filter(|(_, brings)| brings.ignored);
    recorder.run_all(ignoring.map(|(view, _)| {
        ignore_comp::Bindings {
            ignored: view.plane(Plane::Ignored),
            silhouette: view.plane(Plane::Silhouette),
            edges: view.plane(Plane::Edges),
        }
        .dispatch(layout::Ignore { words: view.words() }, view.every_word())
    }))?;
    record_distance(recorder, &all, settings.distance.metric)?;
    recorder.run_all(all.iter().zip(packed).zip(brings).map(|((view, packed), brings)| {
        let constants = pack_comp::Constants { ignores: brings.ignored };
        pack_comp::Bindings {
            silhouette: view.plane(Plane::Silhouette),
            ignored: view.plane(Plane::Ignored),
            codes: &view.codes,
            proximity,
            pixels: &packed.pixels,
            planes: &packed.planes,
        }
        .dispatch(constants, view.picture, Groups::Flat(view.picture.width.div_ceil(32) * view.picture.height))
    }))
}

/// Records the step of the mixtures of views whose background the likelihoods have from there, from what the host fills, and what the host
/// is told of that: whether there is any such view.
pub(super) fn record_learning(
    recorder: &mut Recorder,
    (views, likely): (&[DeviceView], &[LikelyView]),
    (inputs, brings): (&[Input], &[Brings]),
    settings: &FeatureSettings,
) -> Result<bool> {
    let each = views.iter().zip(inputs).zip(likely).zip(brings);
    let learning: Vec<_> = each
        .filter(|(_, brings)| !brings.mask)
        .filter_map(|(((view, input), likely), _)| Some((view, input, likely.learnt()?)))
        .collect();
    for (view, input, _) in &learning {
        copy_whole(recorder, "upload", &input.colours, &view.colours)?;
    }
    let rates: Vec<&Buffer> = learning.iter().map(|(_, input, _)| &input.rates).collect();
    let of_learning: Vec<&DeviceView> = learning.iter().map(|(view, ..)| *view).collect();
    record_mixture(recorder, &of_learning, &rates, settings)?;
    let colours: Vec<&Buffer> = learning.iter().map(|(.., learnt)| &learnt.colours).collect();
    probable_every(recorder, (&of_learning, &colours), 1, &settings.mixture)?;
    for (.., learnt) in &learning {
        copy_whole(recorder, "readback", &learnt.colours, &learnt.out)?;
    }
    Ok(!learning.is_empty())
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
