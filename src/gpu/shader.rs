//! What the build knows of a shader stage: generated from GLSL by `make shaders`, so that a binding has one source.

use super::interface::{Access, BindingKind, ShaderKind};
use super::{Buffer, Image};

/// One compiled stage: generated from a file under `glsl/`.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// Path under `glsl/`, as in `evaluate/project.comp`.
    pub name: &'static str,
    /// Pipeline stage.
    pub kind: ShaderKind,
    /// The code, SPIR-V 1.3.
    pub spirv: &'static [u32],
    /// Invocations of a workgroup in x, y, z; ones outside of compute.
    pub workgroup_size: [u32; 3],
    /// Bytes of push constants, 0 without.
    pub push_size: u32,
    /// Everything the stage reads or writes through a descriptor.
    pub bindings: &'static [BindingLayout],
    /// Its specialisation constants.
    pub constants: &'static [SpecConstant],
}

/// A stage's words from the bytes of its file, in which the lowest byte of a word comes first.
///
/// # Panics
/// When the file is not that long: while compiling, since it is called for statics.
#[allow(clippy::panic, reason = "a build stops there, no program does")]
pub(crate) const fn words<const WORDS: usize, const BYTES: usize>(bytes: &[u8; BYTES]) -> [u32; WORDS] {
    assert!(BYTES == 4 * WORDS, "a stage's file is as long as the words that were written");
    let mut words = [0; WORDS];
    let mut index = 0;
    while index < WORDS {
        let at = 4 * index;
        words[index] = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        index += 1;
    }
    words
}

impl Shader {
    /// Name of its file without folder and ending: the name of its passes, in captures and in rows of timings.
    pub fn label(&self) -> &'static str {
        let file = self.name.rsplit('/').next().unwrap_or(self.name);
        file.split('.').next().unwrap_or(file)
    }
}

/// A shader with the values of its specialisation constants: what a pipeline is compiled from.
#[derive(Clone, Debug)]
pub struct ShaderStage {
    /// The shader.
    pub shader: &'static Shader,
    /// `constant_id` and the bits of its value; constants left out keep their defaults.
    pub constants: Vec<(u32, u32)>,
}

impl ShaderStage {
    /// Invocations of a workgroup in x, y, z, with the values of the constants that they are.
    pub fn workgroup_size(&self) -> [u32; 3] {
        let mut size = self.shader.workgroup_size;
        for (place, name) in size.iter_mut().zip(["local_size_x", "local_size_y", "local_size_z"]) {
            let id = self.shader.constants.iter().find(|constant| constant.name == name).map(|constant| constant.id);
            let value = self.constants.iter().find(|(given, _)| Some(*given) == id);
            *place = value.map_or(*place, |(_, value)| *value);
        }
        size
    }
}

impl PartialEq for ShaderStage {
    /// A shader is known by its path.
    fn eq(&self, other: &Self) -> bool {
        self.shader.name == other.shader.name && self.constants == other.constants
    }
}

/// A descriptor of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BindingLayout {
    /// Name of the variable in GLSL.
    pub name: &'static str,
    /// Descriptor set.
    pub set: u32,
    /// Binding in the set.
    pub binding: u32,
    /// What is bound.
    pub kind: BindingKind,
    /// What the stage really does with it.
    pub access: Access,
}

impl Access {
    /// Whether it writes.
    pub fn writes(self) -> bool {
        self != Self::Read
    }

    /// Whether it reads.
    pub fn reads(self) -> bool {
        self != Self::Write
    }

    /// What two stages do together.
    pub(super) fn and(self, other: Self) -> Self {
        if self == other { self } else { Self::ReadWrite }
    }
}

/// A specialisation constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    /// Name in GLSL.
    pub name: &'static str,
    /// Its `constant_id`.
    pub id: u32,
    /// The bits of its default.
    pub default: u32,
}

/// A resource at a descriptor.
#[derive(Clone, Copy, Debug)]
pub enum Bound<'a> {
    /// A whole buffer.
    Buffer(&'a Buffer),
    /// A whole image.
    Image(&'a Image),
}

impl Bound<'_> {
    /// The number that tells it from every other resource.
    pub(super) fn id(&self) -> u64 {
        match self {
            Self::Buffer(buffer) => buffer.id(),
            Self::Image(image) => image.id(),
        }
    }
}

/// A descriptor of a stage and what is bound there.
#[derive(Clone, Copy, Debug)]
pub struct Binding<'a> {
    /// The descriptor.
    pub layout: &'static BindingLayout,
    /// The resource.
    pub bound: Bound<'a>,
}
