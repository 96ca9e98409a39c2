//! The ways to draw the flat model in compute.

use std::fmt::{self, Display, Formatter};

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use crate::evaluate::shaders::{MOST_RASTER_GROUP, MOST_RASTER_WORDS, MOST_SEGMENTS, RASTER_GROUP, RASTER_WORDS};

/// A way to draw the flat model in compute. All give the same integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kernel", rename_all = "snake_case")]
pub enum RasterKernel {
    /// A workgroup an image, an invocation a row.
    Rows {
        /// Invocations of a workgroup, a power of two.
        group: u32,
        /// Words of 32 pixels of a row that are drawn at once.
        words: u32,
    },
    /// Spans of all parts and rows first, then the pixels, 32 an invocation.
    Spans {
        /// Invocations of a workgroup.
        group: u32,
        /// Workgroups of an image.
        workgroups: u32,
    },
}

impl Default for RasterKernel {
    fn default() -> Self {
        Self::ROWS
    }
}

impl RasterKernel {
    /// What is drawn by before anything is measured.
    pub const ROWS: Self = Self::Rows { group: RASTER_GROUP, words: RASTER_WORDS };

    /// Invocations of a workgroup and words at once that are measured, besides [`Self::ROWS`].
    const MORE_ROWS: [[u32; 2]; 4] = [[32, 2], [32, 4], [64, 2], [64, 4]];
    /// Invocations of a workgroup and workgroups of an image that are measured.
    const SPANS: [[u32; 2]; 6] = [[32, 2], [64, 1], [64, 2], [64, 4], [128, 1], [128, 4]];

    /// All that are measured where a way is chosen, the usual one first: those whose workgroups a device of this limit allows.
    pub(super) fn all(most: u32) -> Vec<Self> {
        let rows = Self::MORE_ROWS.map(|[group, words]| Self::Rows { group, words });
        let spans = Self::SPANS.map(|[group, workgroups]| Self::Spans { group, workgroups });
        let all = std::iter::once(Self::ROWS).chain(rows).chain(spans);
        all.filter(|kernel| kernel.check(most).is_ok()).collect()
    }

    /// Holds it to what its stages do on a device of workgroups of `most` invocations.
    pub(super) fn check(self, most: u32) -> Result<()> {
        let (Self::Rows { group, .. } | Self::Spans { group, .. }) = self;
        ensure!((1..=most).contains(&group), "{self}: this device has workgroups of 1 to {most} invocations");
        match self {
            Self::Rows { group, words } => {
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
            Self::Rows { group, words } => [32 * words, group],
            // 32 pixels an invocation, in one row of a strip or more.
            Self::Spans { group, .. } => [32 * group, 1],
        }
    }
}

impl Display for RasterKernel {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ROWS => write!(formatter, "row by row"),
            Self::Rows { group, words } => {
                write!(formatter, "row by row ({group} rows a workgroup, {words} words at once)")
            }
            Self::Spans { group, workgroups } => {
                write!(formatter, "spans first ({workgroups} x {group} an image)")
            }
        }
    }
}
