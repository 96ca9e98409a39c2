//! Distances from vertical distances: with [`super::ReachStage`] the twin of [`crate::features::DistanceMap::measure`].

use anyhow::Result;

use super::generated::{self, distance_comp};
use super::{record_views, rows};
use crate::features::Metric;
use crate::features::device::DeviceView;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct DistanceStage {
    stage: ComputeStage,
}

impl DistanceStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device, metric: Metric) -> Result<Self> {
        let metric = match metric {
            Metric::Chessboard => generated::METRIC_CHESSBOARD,
            Metric::CityBlock => generated::METRIC_CITY_BLOCK,
            Metric::Euclidean => generated::METRIC_EUCLIDEAN,
            Metric::QuasiEuclidean => generated::METRIC_QUASI_EUCLIDEAN,
        };
        let constants = [(distance_comp::constants::METRIC, metric)];
        let stage = Stage { shader: &distance_comp::SHADER, constants: &constants };
        Ok(Self { stage: ComputeStage::new(device, "distance", stage)? })
    }

    /// Records it: `reach` to `codes`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = distance_comp::Bindings { reach: &view.reach, codes: &view.codes };
            (bindings.bound(), view.picture, rows(&view.picture))
        })
    }
}
