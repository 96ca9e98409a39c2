//! The ways to draw the flat model in compute.

use std::fmt::{self, Display, Formatter};

use serde::{Deserialize, Serialize};

/// A way to draw the flat model in compute. All give the same integers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kernel", rename_all = "snake_case")]
pub enum RasterKernel {
    /// A workgroup an image, an invocation a row.
    #[default]
    Rows,
    /// Spans of all parts and rows first, then the pixels, 32 an invocation.
    Spans {
        /// Invocations of a workgroup.
        group: u32,
        /// Workgroups of an image.
        workgroups: u32,
    },
}

impl RasterKernel {
    /// Invocations of a workgroup and workgroups of an image that are measured.
    const SPANS: [[u32; 2]; 6] = [[32, 2], [64, 1], [64, 2], [64, 4], [128, 1], [128, 4]];

    /// All that are measured: those whose workgroups a device of this limit allows.
    pub(super) fn all(most: u32) -> Vec<Self> {
        let spans = Self::SPANS.into_iter().filter(|[group, _]| *group <= most);
        let spans = spans.map(|[group, workgroups]| Self::Spans { group, workgroups });
        std::iter::once(Self::Rows).chain(spans).collect()
    }
}

impl Display for RasterKernel {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rows => write!(formatter, "row by row"),
            Self::Spans { group, workgroups } => {
                write!(formatter, "spans first ({workgroups} x {group} an image)")
            }
        }
    }
}
