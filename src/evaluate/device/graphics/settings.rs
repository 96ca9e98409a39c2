//! The choices of the graphics backend: each is a row of the benchmark.

use std::collections::HashMap;
use std::sync::LazyLock;

use clap::builder::ValueParserFactory;

use crate::evaluate::shaders::{PACK_DEPTH, PACK_MAX};
use crate::files::{Choice, ChoiceParser, choices};
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

    const fn device(at: usize) -> (Self, &'static str, &'static str) {
        let (gathering, name, help) = Gathering::CHOICES[at];
        (Self::Device(gathering), name, help)
    }

    const fn host(at: usize) -> (Self, &'static str, &'static str) {
        let (comparison, name, help) = HostComparison::CHOICES[at];
        (Self::Host(comparison), name, help)
    }
}

/// One list for users, of both.
impl Choice for Comparison {
    const WHAT: &'static str = "comparison";
    const CHOICES: &'static [(Self, &'static str, &'static str)] =
        &[Self::device(0), Self::device(1), Self::device(2), Self::host(0), Self::host(1)];
}

impl ValueParserFactory for Comparison {
    type Parser = ChoiceParser<Self>;

    fn value_parser() -> Self::Parser {
        ChoiceParser::new()
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
    /// All that differ, in the order of their lists.
    pub fn all() -> impl Iterator<Item = Self> {
        Packing::ALL.into_iter().flat_map(|packing| {
            Coverage::ALL.into_iter().flat_map(move |coverage| {
                Comparison::all().flat_map(move |comparison| {
                    Tiling::ALL.into_iter().flat_map(move |tiling| {
                        let of = move |projection| Self { packing, coverage, comparison, tiling, projection };
                        Projection::ALL.into_iter().map(of)
                    })
                })
            })
        })
    }

    /// The name of its rows in tables: packing, who covers where that is not the usual one, how it is compared, or that tiles are
    /// pictures, what projects where that is not the usual one.
    pub fn name(&self) -> &'static str {
        // Put together once: a name lasts as long as the program.
        static NAMES: LazyLock<HashMap<GraphicsSettings, String>> =
            LazyLock::new(|| GraphicsSettings::all().map(|settings| (settings, settings.composed())).collect());
        &NAMES[self]
    }

    fn composed(&self) -> String {
        let mut name = self.packing.name().to_string();
        let mut more = |word: &str| name.extend(["-", word]);
        if self.tiling == Tiling::Pictures {
            more(self.tiling.name());
        }
        if self.coverage != Coverage::default() {
            more(self.coverage.name());
        }
        if self.tiling != Tiling::Pictures || self.comparison != Self::default().comparison {
            more(self.comparison.name());
        }
        if self.projection != Projection::default() {
            more(self.projection.name());
        }
        name
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn every_way_has_a_name_of_its_own() {
        let names: HashSet<&str> = GraphicsSettings::all().map(|settings| settings.name()).collect();
        assert_eq!(names.len(), 2 * 2 * 5 * 2 * 2);
        let usual = GraphicsSettings::default();
        assert_eq!(usual.name(), "max-texels");
        let pictures = GraphicsSettings { packing: Packing::Depth, tiling: Tiling::Pictures, ..usual };
        assert_eq!(pictures.name(), "depth-pictures");
        let all = GraphicsSettings {
            coverage: Coverage::Hardware,
            comparison: Comparison::Host(HostComparison::Simd),
            projection: Projection::Feedback,
            ..usual
        };
        assert_eq!(all.name(), "max-hardware-readback-simd-feedback");
    }

    #[test]
    fn comparisons_are_one_list() {
        let listed: Vec<Comparison> = Comparison::CHOICES.iter().map(|(comparison, ..)| *comparison).collect();
        assert_eq!(listed, Comparison::all().collect::<Vec<_>>());
        assert!(Comparison::CHOICES.iter().all(|(comparison, name, _)| comparison.name() == *name));
    }
}
