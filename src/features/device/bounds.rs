//! The rectangle round a silhouette: the twin of [`crate::features::BitImage::bounds`].

use anyhow::Result;

use super::view::{DeviceView, Plane};
use crate::features::Region;
use crate::features::shaders::{bounds_comp, layout};
use crate::gpu::{Buffer, Recorder};

/// Records it: a plane to the views' own `sides`.
pub(super) fn bounds(recorder: &mut Recorder, views: &[&DeviceView], image: Plane) -> Result<()> {
    bounds_of(recorder, &views.iter().map(|view| (*view, &view.sides)).collect::<Vec<_>>(), image)
}

/// Records it: a plane to the sides beside each view.
pub(super) fn bounds_of(recorder: &mut Recorder, views: &[(&DeviceView, &Buffer)], image: Plane) -> Result<()> {
    for (_, sides) in views {
        recorder.fill("bounds", sides, 0)?;
    }
    recorder.run_all(views.iter().map(|(view, sides)| {
        let (width, height, stride) = (view.picture.width, view.picture.height, view.picture.stride);
        let bindings = bounds_comp::Bindings { image: view.plane(image), sides };
        bindings.dispatch(layout::Bounds { width, height, stride }, view.every_word())
    }))
}

/// The region that the numbers in `sides` stand for; none where nothing is set.
pub(super) fn region(sides: [u32; 4], width: u32, height: u32) -> Option<Region> {
    let [from_right, from_bottom, x1, y1] = sides;
    (x1 > 0).then(|| Region { x0: width.saturating_sub(from_right), y0: height.saturating_sub(from_bottom), x1, y1 })
}
