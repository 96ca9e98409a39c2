//! The choices of the graphics backend: each is a row of the benchmark.

use crate::evaluate::shaders::{PACK_DEPTH, PACK_MAX};
use crate::gpu::Capabilities;

/// How four candidates share a framebuffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Packing {
    /// A pixel is 2 rank + edge of its part, the largest value stays: no depth buffer, any order.
    #[default]
    Max,
    /// A pixel is a label with bit 7 on edges; a depth buffer split in four ranges, a channel drawn after the other. What parts
    /// with a depth of their own at every pixel need.
    Depth,
}

/// Who decides which pixels a part covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coverage {
    /// The fragment stage, by the exact rule of docs/RASTER.md: the same integers on every device.
    #[default]
    Exact,
    /// The device's own triangles and lines.
    Hardware,
}

impl Packing {
    /// The bit of a pixel's byte that says edge.
    pub(crate) fn edge_bit(self) -> u32 {
        match self {
            Self::Max => 0,
            Self::Depth => 7,
        }
    }

    /// The number that the stages know it by.
    pub(crate) fn constant(self) -> u32 {
        match self {
            Self::Max => PACK_MAX,
            Self::Depth => PACK_DEPTH,
        }
    }
}

/// How the four bytes of a texel become four pixels of a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gathering {
    /// Every invocation reads four texels and takes all four candidates.
    Texels,
    /// Four invocations exchange theirs by subgroup shuffles.
    Subgroup,
    /// Four invocations exchange theirs through shared memory.
    Shared,
}

impl Gathering {
    /// Whether a device can.
    pub(crate) fn works_on(self, capabilities: &Capabilities) -> bool {
        self != Self::Subgroup || (capabilities.subgroup_shuffle && capabilities.subgroup_size >= 4)
    }
}

/// How the host compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HostComparison {
    /// A pixel after the other.
    Scalar,
    /// Rows in the widest vectors of the processor.
    Simd,
}

/// Where the framebuffer is compared with the observations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// On the device.
    Device(Gathering),
    /// On the host, after the framebuffer was copied there.
    Host(HostComparison),
}

/// What a tile shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tiling {
    /// The region that the candidates of a view touch, as recent ones told.
    #[default]
    Regions,
    /// The whole picture: what one writes first, kept to measure against.
    Pictures,
}

/// What projects the candidates' parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// A compute stage.
    #[default]
    Compute,
    /// Vertices captured by transform feedback.
    Feedback,
}

/// How the backend works.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GraphicsSettings {
    /// How four candidates share a texel.
    pub packing: Packing,
    /// Who decides which pixels a part covers.
    pub coverage: Coverage,
    /// Where and how pictures are compared.
    pub comparison: Comparison,
    /// What a tile shows.
    pub tiling: Tiling,
    /// What projects.
    pub projection: Projection,
}

impl Default for GraphicsSettings {
    fn default() -> Self {
        Self {
            packing: Packing::default(),
            coverage: Coverage::default(),
            comparison: Comparison::Device(Gathering::Texels),
            tiling: Tiling::default(),
            projection: Projection::default(),
        }
    }
}

impl GraphicsSettings {
    /// The name of its rows in tables: packing, who covers, how it is compared; or packing and that tiles are pictures.
    pub fn name(&self) -> &'static str {
        const NAMES: [[[&str; 5]; 2]; 2] = [
            [
                ["max-texels", "max-subgroup", "max-shared", "max-readback", "max-readback-simd"],
                [
                    "max-hardware-texels",
                    "max-hardware-subgroup",
                    "max-hardware-shared",
                    "max-hardware-readback",
                    "max-hardware-readback-simd",
                ],
            ],
            [
                ["depth-texels", "depth-subgroup", "depth-shared", "depth-readback", "depth-readback-simd"],
                [
                    "depth-hardware-texels",
                    "depth-hardware-subgroup",
                    "depth-hardware-shared",
                    "depth-hardware-readback",
                    "depth-hardware-readback-simd",
                ],
            ],
        ];
        if self.tiling == Tiling::Pictures {
            return if self.packing == Packing::Depth { "depth-pictures" } else { "max-pictures" };
        }
        let comparison = match self.comparison {
            Comparison::Device(Gathering::Texels) => 0,
            Comparison::Device(Gathering::Subgroup) => 1,
            Comparison::Device(Gathering::Shared) => 2,
            Comparison::Host(HostComparison::Scalar) => 3,
            Comparison::Host(HostComparison::Simd) => 4,
        };
        NAMES[usize::from(self.packing == Packing::Depth)][usize::from(self.coverage == Coverage::Hardware)][comparison]
    }
}
