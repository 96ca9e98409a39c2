//! From raw foreground to a silhouette: the twin of what follows segmentation in [`crate::features::foreground`].

use anyhow::Result;

use super::components::{Keep, components};
use super::foreground::bridge;
use super::morphology::{closing, opening};
use super::view::{DeviceView, Plane};
use crate::features::FeatureSettings;
use crate::gpu::Recorder;

/// Records the way from foreground to silhouette; those with a plate have their hysteresis and bridges.
pub(super) fn clean(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    with_plate: &[&DeviceView],
    settings: &FeatureSettings,
) -> Result<()> {
    use Plane::{Foreground, Silhouette, Strong, WorkA, WorkB, WorkC};
    opening(recorder, views, settings.opening(), [Foreground, WorkA, WorkB])?;
    components(recorder, with_plate, Keep::Touched, Strong, [WorkB, WorkA])?;
    closing(recorder, with_plate, settings.bridge(), [WorkA, WorkB, WorkC])?;
    bridge(recorder, with_plate, [WorkA, WorkC, WorkB])?;
    join(recorder, views, settings, [WorkB, Silhouette])
}

/// Records the rest of it, as [`crate::features::foreground::clean`]: what belongs together is joined, the largest blobs are kept and their
/// holes filled. The first plane may be `WorkB`; `WorkA` and `WorkC` are written over.
pub(super) fn join(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    settings: &FeatureSettings,
    [from, to]: [Plane; 2],
) -> Result<()> {
    use Plane::{Strong, WorkA, WorkC};
    let holes = Keep::Holes(settings.silhouette.max_hole);
    closing(recorder, views, settings.closing(), [from, WorkA, WorkC])?;
    components(recorder, views, Keep::largest(&settings.silhouette), Strong, [WorkC, WorkA])?;
    components(recorder, views, holes, Strong, [WorkA, to])
}
