//! A compiled shader stage and what it wants bound, as the build generates them from the files under `glsl/`.

use super::{Buffer, Image};

/// One compiled stage, generated from a file under `glsl/`.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// Path under `glsl/`, such as `evaluate/project.comp`; also the debug label.
    pub name: &'static str,
    /// Place in the pipeline.
    pub kind: ShaderKind,
    /// SPIR-V 1.3 words; the entry point is `main`.
    pub spirv: &'static [u32],
    /// Invocations of a workgroup; 1, 1, 1 outside compute.
    pub workgroup_size: [u32; 3],
    /// Bytes of push constants; 0 without.
    pub push_size: u32,
    /// Resources that the stage uses, by set and binding.
    pub bindings: &'static [BindingLayout],
    /// Specialisation constants, by number.
    pub constants: &'static [SpecConstant],
}

/// A stage's place in the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShaderKind {
    /// Workgroups.
    Compute,
    /// Corners.
    Vertex,
    /// Primitives.
    Geometry,
    /// Pixels.
    Fragment,
}

/// One resource that a stage uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BindingLayout {
    /// GLSL name of the variable, or of the block when it has no instance name.
    pub name: &'static str,
    /// Descriptor set.
    pub set: u32,
    /// Binding in the set.
    pub binding: u32,
    /// What is bound.
    pub kind: BindingKind,
    /// What the stage does to it.
    pub access: Access,
}

/// What is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A buffer block.
    StorageBuffer,
    /// A uniform block.
    UniformBuffer,
    /// A texture read with `texelFetch`, without a sampler.
    SampledImage,
    /// An image read and written by pixel.
    StorageImage,
}

/// What a stage does to a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// It only reads.
    Read,
    /// It only writes.
    Write,
    /// It reads and writes, or updates atomically.
    ReadWrite,
}

/// A constant that is set when the pipeline is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    /// GLSL name.
    pub name: &'static str,
    /// `constant_id`.
    pub id: u32,
    /// Bits of the default value.
    pub default: u32,
}

/// What the caller binds.
#[derive(Clone, Copy, Debug)]
pub enum Bound<'a> {
    /// A storage or uniform buffer.
    Buffer(&'a Buffer),
    /// A texture or storage image.
    Image(&'a Image),
}

/// A resource and where it goes.
#[derive(Clone, Copy, Debug)]
pub struct Binding<'a> {
    /// Where.
    pub layout: &'static BindingLayout,
    /// What.
    pub bound: Bound<'a>,
}
