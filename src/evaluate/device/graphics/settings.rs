//! The choices of the graphics backend: each is a row of the benchmark.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::evaluate::shaders::{PACK_DEPTH, PACK_MAX};
use crate::files::choices;
use crate::gpu::Capabilities;

choices! {
    /// How four candidates share a framebuffer.
    #[derive(Default)]
    "packing" pub enum Packing => pub(crate) constant: u32 {
        /// A pixel is 2 rank + edge of its part, the largest value stays: no depth buffer, any order (the default).
        "max" #[default] Max => PACK_MAX,
        /// A pixel is a label with bit 7 on edges; a depth buffer split in four ranges, a channel drawn after the other. What
        /// parts with a depth of their own at every pixel need.
        "depth" Depth => PACK_DEPTH,
    }
}

choices! {
    /// Who decides which pixels a part covers.
    #[derive(Default)]
    "coverage" pub enum Coverage {
        /// The fragment stage, by the exact rule of docs/RASTER.md: the same integers on every device (the default).
        "exact" #[default] Exact,
        /// The device's own triangles and lines.
        "hardware" Hardware,
    }
}

impl Packing {
    /// The bit of a pixel's byte that says edge.
    pub(crate) fn edge_bit(self) -> u32 {
        match self {
            Self::Max => 0,
            Self::Depth => 7,
        }
    }
}

choices! {
    /// How the four bytes of a texel become four pixels of a candidate.
    "gathering" pub enum Gathering {
        /// Every invocation reads four texels and takes all four candidates.
        "texels" Texels,
        /// Four invocations exchange theirs by subgroup shuffles.
        "subgroup" Subgroup,
        /// Four invocations exchange theirs through shared memory.
        "shared" Shared,
    }
}

impl Gathering {
    /// Whether a device can.
    pub(crate) fn works_on(self, capabilities: &Capabilities) -> bool {
        let exchanges = capabilities.subgroup_shuffle && capabilities.subgroup_arithmetic;
        self != Self::Subgroup || (exchanges && capabilities.subgroup_size >= 4)
    }
}

choices! {
    /// How the host compares.
    "comparison on the host" pub enum HostComparison {
        /// A pixel after the other.
        "readback" Scalar,
        /// Rows in the widest vectors of the processor.
        "readback-simd" Simd,
    }
}

/// Where the framebuffer is compared with the observations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// On the device.
    Device(Gathering),
    /// On the host, after the framebuffer was copied there.
    Host(HostComparison),
}

impl Comparison {
    /// On the device, then on the host, each in the order of its list.
    pub fn all() -> impl Iterator<Item = Self> {
        Gathering::ALL.into_iter().map(Self::Device).chain(HostComparison::ALL.into_iter().map(Self::Host))
    }

    /// The name of its choice.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Device(gathering) => gathering.name(),
            Self::Host(comparison) => comparison.name(),
        }
    }
}

choices! {
    /// What a tile shows.
    #[derive(Default)]
    "tiling" pub enum Tiling {
        /// The region that the candidates of a view touch, as recent ones told (the default).
        "regions" #[default] Regions,
        /// The whole picture: what one writes first, kept to measure against.
        "pictures" Pictures,
    }
}

choices! {
    /// What projects the candidates' parts.
    #[derive(Default)]
    "projection" pub enum Projection {
        /// A compute stage (the default).
        "compute" #[default] Compute,
        /// Vertices captured by transform feedback.
        "feedback" Feedback,
    }
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
        type Key = (Packing, Coverage, Comparison, Tiling);
        // Put together once: a name lasts as long as the program.
        static NAMES: LazyLock<HashMap<Key, String>> = LazyLock::new(|| {
            let mut names = HashMap::new();
            for packing in Packing::ALL {
                for coverage in Coverage::ALL {
                    for comparison in Comparison::all() {
                        let how = comparison.name();
                        let name = match coverage {
                            Coverage::Exact => format!("{packing}-{how}"),
                            Coverage::Hardware => format!("{packing}-{coverage}-{how}"),
                        };
                        names.insert((packing, coverage, comparison, Tiling::Regions), name);
                        let pictures = Tiling::Pictures;
                        names.insert((packing, coverage, comparison, pictures), format!("{packing}-{pictures}"));
                    }
                }
            }
            names
        });
        &NAMES[&(self.packing, self.coverage, self.comparison, self.tiling)]
    }
}
