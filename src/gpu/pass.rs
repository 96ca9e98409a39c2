//! What a pass is told: its pipelines, what they are given, and where they write.

use std::ops::Range;

use super::buffer::Buffer;
use super::image::Image;
use super::pipeline::Pipeline;
use super::shader::Binding;

/// How many workgroups are run.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// So many in x, y, z.
    Count([u32; 3]),
    /// Three words of a buffer, from this byte on.
    Indirect(&'a Buffer, u64),
}

/// One run of a compute pipeline.
#[derive(Clone, Copy, Debug)]
pub struct Dispatch<'a> {
    /// The pipeline.
    pub pipeline: &'a Pipeline,
    /// What its descriptors point to.
    pub bindings: &'a [Binding<'a>],
    /// Its push constants.
    pub push: &'a [u8],
    /// Its workgroups.
    pub groups: Groups<'a>,
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
