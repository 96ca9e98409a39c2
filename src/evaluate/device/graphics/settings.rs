//! The choices of the graphics backend: each is a row of the benchmark.

use std::collections::HashMap;
use std::sync::LazyLock;

use anyhow::{Result, ensure};
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

    /// Says so where a device cannot.
    pub(crate) fn check(self, capabilities: &Capabilities) -> Result<()> {
        ensure!(self.works_on(capabilities), "the device has no shuffles over subgroups of 4 or more");
        Ok(())
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

choices! {
    /// What makes the primitives that are drawn.
    #[derive(Default)]
    "primitives" pub enum Primitives {
        /// Vertices alone: parts by an index buffer, a mesh's silhouette edges listed by a compute stage (the default).
        "vertices" #[default] Vertices,
        /// A geometry stage: parts from points, a mesh's silhouette edges from triangles with their neighbours.
        "geometry" Geometry,
    }
}

choices! {
    /// When the four channels of a tile are drawn, where they share it by depth.
    #[derive(Default)]
    "order of the channels" pub enum Channels {
        /// A channel after the other, each through its write mask (the default).
        "in-turn" #[default] InTurn,
        /// All fills in one pass, then all edges, the largest value staying: wrong where parts or candidates overlap, kept to measure
        /// against.
        "at-once" AtOnce,
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
    /// What makes primitives.
    pub primitives: Primitives,
    /// When channels that share a tile by depth are drawn.
    pub channels: Channels,
}

impl Default for GraphicsSettings {
    fn default() -> Self {
        Self {
            packing: Packing::default(),
            coverage: Coverage::default(),
            comparison: Comparison::Device(Gathering::Texels),
            tiling: Tiling::default(),
            projection: Projection::default(),
            primitives: Primitives::default(),
            channels: Channels::default(),
        }
    }
}

impl GraphicsSettings {
    /// All that differ, in the order of their lists.
    pub fn all() -> impl Iterator<Item = Self> {
        let usual = std::iter::once(Self::default());
        usual
            .flat_map(|each| Packing::ALL.map(|packing| Self { packing, ..each }))
            .flat_map(|each| Coverage::ALL.map(|coverage| Self { coverage, ..each }))
            .flat_map(|each| Comparison::all().map(move |comparison| Self { comparison, ..each }))
            .flat_map(|each| Tiling::ALL.map(|tiling| Self { tiling, ..each }))
            .flat_map(|each| Projection::ALL.map(|projection| Self { projection, ..each }))
            .flat_map(|each| Primitives::ALL.map(|primitives| Self { primitives, ..each }))
            .flat_map(|each| Channels::ALL.map(|channels| Self { channels, ..each }))
    }

    /// Whether poses may be tracked so: not in ways that are kept to measure against.
    pub fn is_for_tracking(&self) -> bool {
        self.tiling == Tiling::default() && self.channels == Channels::default()
    }

    /// How a mesh is drawn where it is asked to be drawn so: it has a depth a pixel, and the device's own triangles cover the pixels.
    pub fn of_mesh(self) -> Self {
        Self { packing: Packing::Depth, coverage: Coverage::Hardware, channels: Channels::InTurn, ..self }
    }

    /// What a device can do of it, with what stands in for the rest: blending by the largest value becomes depths and write masks,
    /// subgroup shuffles an exchange through shared memory, transform feedback a compute stage, a geometry stage vertices alone.
    pub(crate) fn on(mut self, capabilities: &Capabilities) -> Self {
        if !capabilities.max_blend {
            (self.packing, self.channels) = (Packing::Depth, Channels::InTurn);
        }
        if self.packing != Packing::Depth {
            self.channels = Channels::InTurn;
        }
        if let Comparison::Device(gathering) = &mut self.comparison
            && !gathering.works_on(capabilities)
        {
            *gathering = Gathering::Shared;
        }
        if !capabilities.transform_feedback {
            self.projection = Projection::Compute;
        }
        if !capabilities.geometry_shader {
            self.primitives = Primitives::Vertices;
        }
        self
    }

    /// The name of its rows in tables: packing, who covers where that is not the usual one, how it is compared, or that tiles are
    /// pictures, and where they are not the usual ones what projects, what makes primitives, and when channels are drawn.
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
        if self.primitives != Primitives::default() {
            more(self.primitives.name());
        }
        if self.channels != Channels::default() {
            more(self.channels.name());
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
        assert_eq!(names.len(), 2 * 2 * 5 * 2 * 2 * 2 * 2);
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
        let points = GraphicsSettings { primitives: Primitives::Geometry, ..usual };
        assert_eq!((points.name(), points.is_for_tracking()), ("max-texels-geometry", true));
        let once = GraphicsSettings { packing: Packing::Depth, channels: Channels::AtOnce, ..usual };
        assert_eq!((once.name(), once.is_for_tracking()), ("depth-texels-at-once", false));
    }

    #[test]
    fn comparisons_are_one_list() {
        let listed: Vec<Comparison> = Comparison::CHOICES.iter().map(|(comparison, ..)| *comparison).collect();
        assert_eq!(listed, Comparison::all().collect::<Vec<_>>());
        assert!(Comparison::CHOICES.iter().all(|(comparison, name, _)| comparison.name() == *name));
    }
}
