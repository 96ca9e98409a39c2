//! Edges near the silhouette: the twin of [`crate::features::edges::EdgeDetector`], Canny's left out.

use anyhow::{Result, bail};

use super::generated::{self, edges_comp};
use super::{Picture, record_views, rows};
use crate::features::device::DeviceView;
use crate::features::{EdgeSettings, Magnitude, Operator};
use crate::gpu::{Device, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct EdgesStage {
    pipeline: Pipeline,
    threshold: i32,
}

impl EdgesStage {
    /// Compiles it.
    ///
    /// # Errors
    /// When the operator is Canny's, which follows chains of pixels as long as they are.
    pub(in crate::features) fn new(device: &Device, settings: &EdgeSettings) -> Result<Self> {
        let operator = match settings.operator {
            Operator::Sobel => generated::EDGES_SOBEL,
            Operator::Prewitt => generated::EDGES_PREWITT,
            Operator::Roberts => generated::EDGES_ROBERTS,
            Operator::LaplaceFour => generated::EDGES_LAPLACE_FOUR,
            Operator::LaplaceEight => generated::EDGES_LAPLACE_EIGHT,
            Operator::LaplaceProduct => generated::EDGES_LAPLACE_PRODUCT,
            Operator::Canny => {
                bail!("[features] edges.operator is \"canny\", which a device does not do, expected one of the others")
            }
        };
        let magnitude = match settings.magnitude {
            Magnitude::Exact => generated::MAGNITUDE_EXACT,
            Magnitude::Sum => generated::MAGNITUDE_SUM,
            Magnitude::Max => generated::MAGNITUDE_MAX,
        };
        use edges_comp::constants as id;
        let constants = [(id::OPERATOR, operator), (id::MAGNITUDE, magnitude)];
        let stage = Stage { shader: &edges_comp::SHADER, constants: &constants };
        Ok(Self { pipeline: device.compute_pipeline(stage)?, threshold: i32::from(settings.threshold) })
    }

    /// Records it: `smoothed`, where `near` is set, to `edges`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[DeviceView]) -> Result<()> {
        record_views(recorder, "edges", &self.pipeline, views, |view| {
            let bindings = edges_comp::Bindings { smoothed: &view.smoothed, near: &view.near, edges: &view.edges };
            (bindings.bound(), Picture { amount: self.threshold, ..view.picture }, rows(&view.picture))
        })
    }
}
