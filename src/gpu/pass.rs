//! What a pass is told: its pipelines, what they are given, and where they write.

use std::ops::Range;

use super::buffer::Buffer;
use super::image::Image;
use super::pipeline::Pipeline;
use super::shader::{Binding, Shader, ShaderStage};

/// How many workgroups are run.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// So many in x, y, z.
    Count([u32; 3]),
    /// As many as make so many invocations in x, y, z: the shader leaves out those beyond.
    Over([u32; 3]),
    /// As many as make so many invocations of a one-dimensional stage, in rows of [`Self::ROW`] workgroups: where x is not enough,
    /// y counts the rows.
    Flat(u32),
    /// Three words of a buffer, from this byte on.
    Indirect(&'a Buffer, u64),
}

impl Groups<'_> {
    /// Most workgroups in one direction that every device runs.
    pub const ROW: u32 = 65535;

    /// Their number in x, y, z for workgroups of this size; none where the device alone knows.
    pub(super) fn count(self, size: [u32; 3]) -> Option<[u32; 3]> {
        match self {
            Self::Count(count) => Some(count),
            Self::Over([x, y, z]) => Some([x.div_ceil(size[0]), y.div_ceil(size[1]), z.div_ceil(size[2])]),
            Self::Flat(invocations) => {
                let groups = invocations.div_ceil(size[0]);
                Some([groups.min(Self::ROW), groups.div_ceil(Self::ROW), 1])
            }
            Self::Indirect(..) => None,
        }
    }
}

/// One run of a compute stage: what the build's `Bindings::dispatch` makes.
#[derive(Clone, Debug)]
pub struct Dispatch<'a> {
    /// What runs.
    pub stage: ShaderStage,
    /// What its descriptors point to.
    pub bindings: Vec<Binding<'a>>,
    /// Its push constants.
    pub push: Vec<u8>,
    /// Its workgroups.
    pub groups: Groups<'a>,
}

impl Dispatch<'_> {
    /// The same run of a shader with the same bindings, push constants and specialisation constants, which may read and write
    /// otherwise: another way to compute the same.
    pub fn by(mut self, variant: &'static Shader) -> Self {
        self.stage.shader = variant;
        self
    }
}

/// Part of a target in pixels, and the range that depths 0 to 1 are mapped to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left, top, width, height, pixels.
    pub area: [f32; 4],
    /// Nearest and farthest depth.
    pub depth: [f32; 2],
}

/// One draw of a graphics pipeline.
#[derive(Clone, Debug)]
pub struct Draw<'a> {
    /// The pipeline.
    pub pipeline: &'a Pipeline,
    /// What its descriptors point to.
    pub bindings: &'a [Binding<'a>],
    /// Its push constants.
    pub push: &'a [u8],
    /// Where clip coordinates land.
    pub viewport: Viewport,
    /// Left, top, width, height of what may be touched, pixels.
    pub scissor: [u32; 4],
    /// Vertex numbers, or places in the index buffer.
    pub vertices: Range<u32>,
    /// Instance numbers.
    pub instances: Range<u32>,
    /// A buffer of 32-bit vertex numbers.
    pub indices: Option<&'a Buffer>,
    /// Four words of a buffer, from this byte on, that an earlier pass wrote, instead of `vertices` and `instances`: how many
    /// vertices, how many instances, the first vertex, and 0. Not together with `indices`.
    pub indirect: Option<(&'a Buffer, u64)>,
}

/// What becomes of a target's contents before it is drawn into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clear {
    /// They stay.
    Keep,
    /// They may be anything.
    Discard,
    /// The area is set to a colour; of a depth target, to the first number.
    Value([f32; 4]),
}

/// What a pass draws into.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// The colour image.
    pub colour: (&'a Image, Clear),
    /// The depth image.
    pub depth: Option<(&'a Image, Clear)>,
    /// Left, top, width, height of what is cleared and drawn, pixels.
    pub area: [u32; 4],
}

/// Where transform feedback writes: everything behind an offset, in bytes.
#[derive(Clone, Copy, Debug)]
pub struct Feedback<'a> {
    /// The buffer.
    pub buffer: &'a Buffer,
    /// First byte.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
}
