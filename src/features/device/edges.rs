//! Edges near the silhouette: the twin of [`crate::features::edges::EdgeDetector`].

use anyhow::Result;

use super::components::{Keep, components};
use super::view::{DeviceView, Plane};
use crate::features::edges::Detector;
use crate::features::shaders::{
    MAGNITUDE_EXACT, MAGNITUDE_MAX, MAGNITUDE_SUM, canny_comp, edges_comp, layout::Picture, smooth_comp,
};
use crate::features::{EdgeSettings, Magnitude};
use crate::gpu::Recorder;

/// Records the step from colour to grey, smoothed or not: `colours` to `smoothed`.
pub(super) fn smooth(recorder: &mut Recorder, views: &[&DeviceView], is_smooth: bool) -> Result<()> {
    let constants = smooth_comp::Constants { smooth: u32::from(is_smooth) };
    recorder.run_all(views.iter().map(|view| {
        smooth_comp::Bindings { colours: &view.colours, smoothed: &view.smoothed }.dispatch(
            constants,
            view.picture,
            view.every_pixel(),
        )
    }))
}

/// Records it: `smoothed`, where the near plane is set, to the edges plane; the work and strong planes are written over.
pub(super) fn edges(recorder: &mut Recorder, views: &[&DeviceView], settings: &EdgeSettings) -> Result<()> {
    let magnitude = match settings.magnitude {
        Magnitude::Exact => MAGNITUDE_EXACT,
        Magnitude::Sum => MAGNITUDE_SUM,
        Magnitude::Max => MAGNITUDE_MAX,
    };
    let picture = |view: &DeviceView| Picture {
        amount: i32::from(settings.threshold),
        low: i32::from(settings.low),
        ..view.picture
    };
    let (Detector::Gradient(_, masks) | Detector::ZeroCrossings(_, masks)) = settings.operator.detector() else {
        // Thinned gradients of at least `low` and of at least `threshold`, then hysteresis.
        recorder.run_all(views.iter().map(|view| {
            canny_comp::Bindings {
                smoothed: &view.smoothed,
                near: view.plane(Plane::Near),
                weak: view.plane(Plane::WorkA),
                strong: view.plane(Plane::Strong),
            }
            .dispatch(canny_comp::Constants { magnitude }, picture(view), view.every_pixel())
        }))?;
        return components(recorder, views, Keep::Touched, Plane::Strong, [Plane::WorkA, Plane::Edges]);
    };
    let [corner, side, middle] = masks.weights.map(i32::from);
    let constants = edges_comp::Constants { form: masks.form, magnitude, corner, side, middle };
    recorder.run_all(views.iter().map(|view| {
        edges_comp::Bindings {
            smoothed: &view.smoothed,
            near: view.plane(Plane::Near),
            edges: view.plane(Plane::Edges),
        }
        .dispatch(constants, picture(view), view.every_pixel())
    }))
}
