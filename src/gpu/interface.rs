//! The words for what a stage is and what it binds, the same in the build, which reflects them, and in the library.

/// A pipeline stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShaderKind {
    /// Compute.
    Compute,
    /// Vertex.
    Vertex,
    /// Geometry.
    Geometry,
    /// Fragment.
    Fragment,
}

/// What a descriptor points to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A buffer of any size, read or written.
    StorageBuffer,
    /// A small buffer, read.
    UniformBuffer,
    /// An image read by texel, without a sampler.
    SampledImage,
    /// An image read or written by texel.
    StorageImage,
}

/// What a stage does with a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Reads only.
    Read,
    /// Writes only.
    Write,
    /// Both, or atomics.
    ReadWrite,
}
