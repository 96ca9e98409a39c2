//! What is measured: a stage by workgroups of one size, in one way.

use anyhow::Result;

use super::super::scene::Scene;
use crate::evaluate::Evaluator;
use crate::evaluate::device::{
    Comparison, Compute, Gathering, Graphics, GraphicsSettings, RasterKernel, RowWay, StageGroups,
};
use crate::gpu::Device;

/// A stage with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Point {
    /// The projection of parts.
    Project(u32),
    /// Drawing and comparison without a framebuffer.
    Raster(RasterKernel),
    /// The comparison of a framebuffer, drawn in the usual way.
    Compare(Gathering, u32),
}

/// Invocations of a workgroup of each stage: those that a device allows are measured.
const PROJECT: [u32; 4] = [16, 32, 64, 128];
const ROWS: [u32; 5] = [8, 16, 32, 64, 128];
/// Those of workgroups that keep edges.
const KEPT: [u32; 4] = [32, 64, 128, 256];
const WORDS: [u32; 4] = [1, 2, 3, 4];
const SPANS: [u32; 5] = [16, 32, 64, 128, 256];
const WORKGROUPS: [u32; 3] = [1, 2, 4];
const COMPARE: [u32; 3] = [64, 128, 256];

impl Point {
    /// All, a stage after the other.
    pub(super) fn all() -> Vec<Self> {
        let by_row = |group, words, keeps_edges| RasterKernel::Rows(RowWay { group, words, keeps_edges });
        let rows = WORDS.into_iter().flat_map(|words| ROWS.map(|group| by_row(group, words, false)));
        let kept = WORDS.into_iter().flat_map(|words| KEPT.map(|group| by_row(group, words, true)));
        let spans =
            WORKGROUPS.into_iter().flat_map(|workgroups| SPANS.map(|group| RasterKernel::Spans { group, workgroups }));
        let compare =
            Gathering::ALL.into_iter().flat_map(|gathering| COMPARE.map(|group| Self::Compare(gathering, group)));
        let project = PROJECT.map(Self::Project).into_iter();
        project.chain(rows.chain(kept).chain(spans).map(Self::Raster)).chain(compare).collect()
    }

    /// Whether a pass of this name is it: where posing and projection are one pass, that is timed.
    pub(super) fn is_timed_by(self, pass: &str) -> bool {
        pass == self.stage() || matches!(self, Self::Project(_)) && pass == "pose_project"
    }

    /// The name of the stage that it is.
    pub(super) fn stage(self) -> &'static str {
        match self {
            Self::Project(_) => "project",
            Self::Raster(RasterKernel::Rows(_)) => "raster",
            Self::Raster(RasterKernel::Spans { .. }) => "raster_spans",
            Self::Compare(..) => "compare",
        }
    }

    /// Its constants besides the workgroup's size.
    pub(super) fn way(self) -> String {
        match self {
            Self::Project(_) => String::new(),
            Self::Raster(RasterKernel::Rows(RowWay { words, keeps_edges, .. })) => {
                format!("{words} words{}", if keeps_edges { ", edges kept" } else { "" })
            }
            Self::Raster(RasterKernel::Spans { workgroups, .. }) => format!("{workgroups} workgroups an image"),
            Self::Compare(gathering, _) => gathering.name().to_string(),
        }
    }

    /// Invocations of a workgroup.
    pub(super) fn group(self) -> u32 {
        match self {
            Self::Project(group) | Self::Compare(_, group) => group,
            Self::Raster(RasterKernel::Rows(RowWay { group, .. }) | RasterKernel::Spans { group, .. }) => group,
        }
    }

    /// Whether it is what is taken unasked, before anything is measured, where that is `rasteriser` for drawing.
    pub(super) fn is_usual(self, rasteriser: RasterKernel) -> bool {
        let StageGroups { project, compare } = StageGroups::default();
        match self {
            Self::Project(group) => group == project,
            Self::Raster(kernel) => kernel == rasteriser,
            Self::Compare(gathering, group) => (gathering, group) == (Gathering::Texels, compare),
        }
    }

    /// An evaluator of the scene's observations that runs the stage so.
    ///
    /// # Errors
    /// When the device cannot.
    pub(super) fn build(self, scene: &Scene, device: &Device) -> Result<Box<dyn Evaluator>> {
        let Scene { body, cameras, .. } = scene;
        let usual = StageGroups::default();
        let mut evaluator: Box<dyn Evaluator> = match self {
            Self::Project(project) => {
                let groups = StageGroups { project, ..usual };
                Box::new(Compute::with_groups(device, body, cameras, groups)?)
            }
            Self::Raster(kernel) => Box::new(Compute::with_kernel(device, body, cameras, kernel)?),
            Self::Compare(gathering, compare) => {
                gathering.check(device.capabilities())?;
                let comparison = Comparison::Device(gathering);
                let settings = GraphicsSettings { comparison, ..GraphicsSettings::default() };
                let groups = StageGroups { compare, ..usual };
                Box::new(Graphics::with_groups(device, body, cameras, settings, groups)?)
            }
        };
        evaluator.observe(&scene.observations)?;
        Ok(evaluator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_is_measured_as_it_is_taken_unasked_and_otherwise() {
        let all = Point::all();
        for stage in ["project", "raster", "compare"] {
            let own = || all.iter().filter(|point| point.stage() == stage);
            for rasteriser in [RasterKernel::ROWS, RasterKernel::Rows(RowWay::OF_CARDS)] {
                assert_eq!(own().filter(|point| point.is_usual(rasteriser)).count(), 1, "{stage}");
            }
            assert!(own().count() > 3, "{stage}");
        }
        assert!(Point::Project(32).is_timed_by("pose_project") && !Point::Project(32).is_timed_by("pose"));
        assert!(!Point::Raster(RasterKernel::ROWS).is_timed_by("pose_project"));
        assert!(all.iter().enumerate().all(|(place, point)| !all[..place].contains(point)));
    }
}
