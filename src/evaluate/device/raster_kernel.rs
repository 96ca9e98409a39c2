//! The ways to draw the flat model in compute.

use std::fmt::{self, Display, Formatter};

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use crate::evaluate::shaders::{
    MOST_RASTER_GROUP, MOST_RASTER_WORDS, MOST_SEGMENTS, RASTER_GROUP, RASTER_PARTS, RASTER_WORDS,
};
use crate::gpu::Capabilities;

/// How the flat model is drawn row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RowWay {
    /// Invocations of a workgroup, a row each: a power of two.
    pub group: u32,
    /// Words of 32 pixels of a row that are drawn at once.
    pub words: u32,
    /// Whether the workgroup keeps what an edge of a part costs once, so that no row finds it again.
    pub keeps_edges: bool,
}

/// A way to draw the flat model in compute. All give the same integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kernel", rename_all = "snake_case")]
pub enum RasterKernel {
    /// A workgroup an image, an invocation a row.
    Rows(RowWay),
    /// Spans of all parts and rows first, then the pixels, 32 an invocation.
    Spans {
        /// Invocations of a workgroup.
        group: u32,
        /// Workgroups of an image.
        workgroups: u32,
    },
}

impl RowWay {
    /// Of a device that the processor computes.
    pub const USUAL: Self = Self { group: RASTER_GROUP, words: RASTER_WORDS, keeps_edges: false };
    /// Of a card: docs/PERFORMANCE.md.
    pub const OF_CARDS: Self = Self { group: 128, words: RASTER_WORDS, keeps_edges: true };

    /// The stages' constant of the edges that a workgroup keeps.
    pub(super) fn edges_kept(self) -> u32 {
        if self.keeps_edges { RASTER_PARTS } else { 1 }
    }

    /// What is drawn by on a device before anything is measured.
    pub(super) fn usual(capabilities: &Capabilities) -> Self {
        let fits = capabilities.max_workgroup >= Self::OF_CARDS.group;
        if capabilities.wide && fits { Self::OF_CARDS } else { Self::USUAL }
    }
}

impl Default for RasterKernel {
    fn default() -> Self {
        Self::ROWS
    }
}

impl RasterKernel {
    /// Row by row, as software devices are fastest before anything is measured.
    pub const ROWS: Self = Self::Rows(RowWay::USUAL);

    /// Row by row, each finding the edges it meets, besides [`Self::ROWS`]: invocations of a workgroup and words at once that are measured.
    const MORE_ROWS: [[u32; 2]; 4] = [[32, 2], [32, 4], [64, 2], [64, 4]];
    /// The same by workgroups that keep edges, besides [`RowWay::OF_CARDS`].
    const KEPT: [[u32; 2]; 4] = [[64, 3], [128, 4], [256, 3], [256, 4]];
    /// Invocations of a workgroup and workgroups of an image that are measured.
    const SPANS: [[u32; 2]; 6] = [[32, 2], [64, 1], [64, 2], [64, 4], [128, 1], [128, 4]];

    /// What is drawn by on a device before anything is measured.
    pub(crate) fn usual(capabilities: &Capabilities) -> Self {
        Self::Rows(RowWay::usual(capabilities))
    }

    /// All that are measured where a way is chosen: those whose workgroups the device allows. Edges are kept on cards alone: a processor
    /// takes 1.5 times as long so.
    pub(super) fn all(capabilities: &Capabilities) -> Vec<Self> {
        let rows = |ways: [[u32; 2]; 4], keeps_edges| {
            ways.map(|[group, words]| Self::Rows(RowWay { group, words, keeps_edges }))
        };
        let kept = std::iter::once(Self::Rows(RowWay::OF_CARDS)).chain(rows(Self::KEPT, true));
        let rows = rows(Self::MORE_ROWS, false).into_iter().chain(kept.filter(|_| capabilities.wide));
        let spans = Self::SPANS.map(|[group, workgroups]| Self::Spans { group, workgroups });
        let all = std::iter::once(Self::ROWS).chain(rows).chain(spans);
        all.filter(|kernel| kernel.check(capabilities.max_workgroup).is_ok()).collect()
    }

    /// Holds it to what its stages do on a device of workgroups of `most` invocations.
    pub(super) fn check(self, most: u32) -> Result<()> {
        let (Self::Rows(RowWay { group, .. }) | Self::Spans { group, .. }) = self;
        ensure!((1..=most).contains(&group), "{self}: this device has workgroups of 1 to {most} invocations");
        match self {
            Self::Rows(RowWay { group, words, .. }) => {
                ensure!(
                    group.is_power_of_two() && (MOST_SEGMENTS..=MOST_RASTER_GROUP).contains(&group),
                    "{self}: a workgroup has {group} rows, expected a power of two from {MOST_SEGMENTS} to {MOST_RASTER_GROUP}"
                );
                ensure!(
                    (1..=MOST_RASTER_WORDS).contains(&words),
                    "{self}: {words} words at once, expected 1 to {MOST_RASTER_WORDS}"
                );
            }
            Self::Spans { workgroups, .. } => {
                ensure!(workgroups > 0, "{self}: no workgroup draws an image, expected at least one");
            }
        }
        Ok(())
    }

    /// Columns and rows that a workgroup works on at once.
    pub(super) fn tile(self) -> [u32; 2] {
        match self {
            Self::Rows(RowWay { group, words, .. }) => [32 * words, group],
            // 32 pixels an invocation, in one row of a strip or more.
            Self::Spans { group, .. } => [32 * group, 1],
        }
    }
}

impl Display for RasterKernel {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ROWS => write!(formatter, "row by row"),
            Self::Rows(RowWay { group, words, keeps_edges }) => {
                let kept = if keeps_edges { ", edges kept" } else { "" };
                write!(formatter, "row by row ({group} rows a workgroup, {words} words at once{kept})")
            }
            Self::Spans { group, workgroups } => {
                write!(formatter, "spans first ({workgroups} x {group} an image)")
            }
        }
    }
}
