//! The rectangle round a silhouette: the twin of [`crate::features::BitImage::bounds`].

use anyhow::Result;

use super::generated::{bounds_comp, layout};
use super::{flat_groups, record_views};
use crate::features::Region;
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct BoundsStage {
    stage: ComputeStage,
}

impl BoundsStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &bounds_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "bounds", stage)? })
    }

    /// Records it: a plane to `sides`.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        image: Plane,
    ) -> Result<()> {
        for view in views {
            recorder.fill("bounds", &view.sides, 0)?;
        }
        record_views(recorder, &self.stage, views, |view| {
            let bindings = bounds_comp::Bindings { image: view.plane(image), sides: &view.sides };
            let (width, height, stride) = (view.picture.width, view.picture.height, view.picture.stride);
            (bindings.bound(), layout::Bounds { width, height, stride }, flat_groups(view.words()))
        })
    }

    /// The region that the numbers in `sides` stand for; none where nothing is set.
    pub(in crate::features) fn region(sides: [u32; 4], width: u32, height: u32) -> Option<Region> {
        let [from_right, from_bottom, x1, y1] = sides;
        (x1 > 0).then(|| Region {
            x0: width.saturating_sub(from_right),
            y0: height.saturating_sub(from_bottom),
            x1,
            y1,
        })
    }
}
