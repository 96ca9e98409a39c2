//! Edges near the silhouette, by gradients or zero crossings: the twin of [`crate::features::edges::EdgeDetector`] with those operators.

use anyhow::Result;

use super::generated::{self, edges_comp};
use super::{CannyStage, ComponentsStages, Keep, Picture, magnitude, record_views, rows};
use crate::features::device::{DeviceView, Plane};
use crate::features::{EdgeSettings, Operator};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// What finds the edges.
#[derive(Debug)]
pub(in crate::features) enum EdgesStage {
    /// One pass.
    Local {
        /// The pass.
        stage: ComputeStage,
        /// The weakest edge.
        threshold: i32,
    },
    /// Thinning, then hysteresis.
    Canny(Box<(CannyStage, ComponentsStages)>),
}

impl EdgesStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device, settings: &EdgeSettings) -> Result<Self> {
        let operator = match settings.operator {
            Operator::Sobel => generated::EDGES_SOBEL,
            Operator::Prewitt => generated::EDGES_PREWITT,
            Operator::Roberts => generated::EDGES_ROBERTS,
            Operator::LaplaceFour => generated::EDGES_LAPLACE_FOUR,
            Operator::LaplaceEight => generated::EDGES_LAPLACE_EIGHT,
            Operator::LaplaceProduct => generated::EDGES_LAPLACE_PRODUCT,
            Operator::Canny => {
                let thinning = CannyStage::new(device, settings)?;
                return Ok(Self::Canny(Box::new((thinning, ComponentsStages::new(device, Keep::Touched)?))));
            }
        };
        use edges_comp::constants as id;
        let constants = [(id::OPERATOR, operator), (id::MAGNITUDE, magnitude(settings.magnitude))];
        let stage = Stage { shader: &edges_comp::SHADER, constants: &constants };
        Ok(Self::Local { stage: ComputeStage::new(device, "edges", stage)?, threshold: i32::from(settings.threshold) })
    }

    /// Records it: `smoothed`, where the near plane is set, to the edges plane; the work and strong planes are written over.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        match self {
            Self::Local { stage, threshold } => record_views(recorder, stage, views, |view| {
                let bindings = edges_comp::Bindings {
                    smoothed: &view.smoothed,
                    near: view.plane(Plane::Near),
                    edges: view.plane(Plane::Edges),
                };
                (bindings.bound(), Picture { amount: *threshold, ..view.picture }, rows(&view.picture))
            }),
            Self::Canny(stages) => {
                let (thinning, hysteresis) = stages.as_ref();
                thinning.record(recorder, views, [Plane::WorkA, Plane::Strong])?;
                hysteresis.record(recorder, views, Plane::Strong, [Plane::WorkA, Plane::Edges])
            }
        }
    }
}
