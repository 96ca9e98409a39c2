//! What a stage wants bound and how its blocks lie in memory, read from SPIR-V.
//!
//! spirq reads names, types and offsets of any stage. naga then reads the module again: it validates it, and it finds
//! what the code really does to each resource. Where naga cannot read a stage (geometry shaders, transform feedback,
//! some subgroup and atomic operations), the access is what the GLSL declares: `readonly`, `writeonly`, otherwise both.

use super::compile::Compiled;
use super::interface::{Access, BindingKind, ShaderKind};
use anyhow::{Result, anyhow, bail, ensure};
use spirq::ty::{AccessType, DescriptorType, MatrixAxisOrder, ScalarType, StructType, Type};
use spirq::var::Variable;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The interface of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    /// Invocations of a workgroup; 1, 1, 1 outside compute.
    pub workgroup_size: [u32; 3],
    /// The push-constant block.
    pub push: Option<Struct>,
    /// Resources that the stage uses, by set and binding.
    pub resources: Vec<Resource>,
    /// Specialisation constants, by number.
    pub constants: Vec<Constant>,
    /// Why naga could not read the stage, if so: the accesses are then those declared.
    pub unread: Option<String>,
}

/// A descriptor.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// Name of the variable, or of the block when it has no instance name.
    pub name: String,
    /// Descriptor set.
    pub set: u32,
    /// Binding in the set.
    pub binding: u32,
    /// What is bound.
    pub kind: BindingKind,
    /// What the stage does to it.
    pub access: Access,
    /// Layout of a buffer's block.
    pub block: Option<Struct>,
}

/// A specialisation constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// GLSL name.
    pub name: String,
    /// `constant_id`.
    pub id: u32,
    /// Rust name of its type.
    pub ty: &'static str,
    /// Bits of the default.
    pub default: u32,
}

/// A structure in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Struct {
    /// GLSL name.
    pub name: String,
    /// Members by offset.
    pub members: Vec<Member>,
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// GLSL name.
    pub name: String,
    /// Bytes from the structure's start.
    pub offset: u32,
    /// Type.
    pub layout: Layout,
}

/// A type in memory; strides in bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// One number, by its Rust name and bytes.
    Scalar(&'static str, u32),
    /// Numbers side by side.
    Vector(&'static str, u32, u32),
    /// Columns, each a vector and perhaps padding.
    Matrix {
        /// Rust name of the numbers.
        scalar: &'static str,
        /// Bytes of a number.
        bytes: u32,
        /// Columns.
        columns: u32,
        /// Bytes from column to column.
        stride: u32,
    },
    /// Elements; no count at run-time length.
    Array {
        /// Element.
        element: Box<Layout>,
        /// Elements.
        count: Option<u32>,
        /// Bytes from element to element.
        stride: u32,
    },
    /// A structure.
    Struct(Struct),
}

impl Layout {
    /// Bytes from the first to behind the last, and the alignment that GLSL's std430 gives the type.
    pub fn size_and_alignment(&self) -> (u32, u32) {
        match self {
            Self::Scalar(_, bytes) => (*bytes, *bytes),
            Self::Vector(_, bytes, count) => (bytes * count, if *count == 2 { 2 * bytes } else { 4 * bytes }),
            Self::Matrix { columns, stride, .. } => (columns * stride, *stride),
            Self::Array { element, count, stride } => (count.unwrap_or(0) * stride, element.size_and_alignment().1),
            Self::Struct(structure) => (structure.size(), structure.alignment()),
        }
    }
}

impl Struct {
    /// Bytes with padding behind the last member; a run-time array counts nothing.
    pub fn size(&self) -> u32 {
        let end = self.members.last().map_or(0, |member| member.offset + member.layout.size_and_alignment().0);
        end.next_multiple_of(self.alignment())
    }

    fn alignment(&self) -> u32 {
        self.members.iter().map(|member| member.layout.size_and_alignment().1).max().unwrap_or(1)
    }
}

/// Reads the interface of the stage `name`: of what it declares, the part that the optimised words still use.
///
/// # Errors
/// One sentence with the stage and the resource for what the generator has no Rust type for: samplers, descriptor
/// arrays, row-major matrices, several push blocks.
pub fn reflect(name: &str, compiled: &Compiled) -> Result<Reflection> {
    // spirq's own search for what an entry point uses misses image atomics.
    let entries = spirq::ReflectConfig::new()
        .spv(compiled.named.as_slice())
        .ref_all_rscs(true)
        .reflect()
        .map_err(|error| anyhow!("{name}: its SPIR-V cannot be reflected: {error}"))?;
    let [entry] = entries.as_slice() else { bail!("{name}: {} entry points where one was expected", entries.len()) };
    let (named, shipped) = (Scan::new(&compiled.named), Scan::new(&compiled.spirv));
    let places = shipped.places();
    let (accesses, unread) = match accesses(&compiled.named) {
        Ok(accesses) => (accesses, None),
        Err(why) => (HashMap::new(), Some(why)),
    };
    let mut push = None;
    let mut resources = Vec::new();
    for variable in &entry.vars {
        match variable {
            Variable::PushConstant { ty, .. } if shipped.pushes => {
                ensure!(push.is_none(), "{name}: it has several push-constant blocks, and a stage may have one");
                push = Some(structure(name, ty)?);
            }
            Variable::Descriptor { name: own, desc_bind, desc_ty, ty, nbind } => {
                let (set, binding) = desc_bind.into_inner();
                if !places.contains(&(set, binding)) {
                    continue;
                }
                let at = format!("{name}: set {set}, binding {binding}");
                ensure!(*nbind == 1, "{at}: arrays of resources are not supported; use one buffer or an array texture");
                let (kind, declared) =
                    kind(desc_ty).map_err(|found| anyhow!("{at}: {found} is not supported; {ADVICE}"))?;
                let block = match ty {
                    Type::Struct(_) => Some(structure(name, ty)?),
                    _ => None,
                };
                let own = own.clone().filter(|own| !own.is_empty());
                let own = own.or_else(|| block.as_ref().map(|block| block.name.clone())).unwrap_or_default();
                ensure!(!own.is_empty(), "{at}: the resource has no name");
                let access = *accesses.get(&(set, binding)).unwrap_or(&declared);
                resources.push(Resource { name: own, set, binding, kind, access, block });
            }
            _ => {}
        }
    }
    // The name settles the order of two that share a place, so that the sentence is the same each time.
    resources.sort_by(|a, b| (a.set, a.binding, &a.name).cmp(&(b.set, b.binding, &b.name)));
    for pair in resources.windows(2) {
        let [a, b] = pair else { continue };
        let twice = (a.set, a.binding) == (b.set, b.binding);
        ensure!(!twice, "{name}: {} and {} share set {}, binding {}", a.name, b.name, a.set, a.binding);
    }
    Ok(Reflection {
        workgroup_size: if compiled.kind == ShaderKind::Compute { named.workgroup_size } else { [1; 3] },
        push,
        resources,
        constants: named.constants(name)?,
        unread,
    })
}

const ADVICE: &str = "use a storage buffer, a uniform block, a texture2D without sampler, or an image2D";

fn kind(descriptor: &DescriptorType) -> Result<(BindingKind, Access), &'static str> {
    let access = |access: &AccessType| match access {
        AccessType::ReadOnly => Access::Read,
        AccessType::WriteOnly => Access::Write,
        AccessType::ReadWrite => Access::ReadWrite,
    };
    match descriptor {
        DescriptorType::StorageBuffer(declared) => Ok((BindingKind::StorageBuffer, access(declared))),
        DescriptorType::UniformBuffer() => Ok((BindingKind::UniformBuffer, Access::Read)),
        DescriptorType::SampledImage() => Ok((BindingKind::SampledImage, Access::Read)),
        DescriptorType::StorageImage(declared) => Ok((BindingKind::StorageImage, access(declared))),
        DescriptorType::Sampler() | DescriptorType::CombinedImageSampler() => Err("a sampler"),
        DescriptorType::UniformTexelBuffer() | DescriptorType::StorageTexelBuffer(_) => Err("a texel buffer"),
        DescriptorType::InputAttachment(_) => Err("an input attachment"),
        DescriptorType::AccelStruct() => Err("an acceleration structure"),
    }
}

fn structure(stage: &str, ty: &Type) -> Result<Struct> {
    match layout(stage, ty)? {
        Layout::Struct(structure) => Ok(structure),
        _ => bail!("{stage}: a block that is no structure"),
    }
}

fn layout(stage: &str, ty: &Type) -> Result<Layout> {
    Ok(match ty {
        Type::Scalar(scalar) => {
            let (name, bytes) = number(stage, scalar)?;
            Layout::Scalar(name, bytes)
        }
        Type::Vector(vector) => {
            let (name, bytes) = number(stage, &vector.scalar_ty)?;
            Layout::Vector(name, bytes, vector.nscalar)
        }
        Type::Matrix(matrix) => {
            let row_major = matrix.axis_order == Some(MatrixAxisOrder::RowMajor);
            ensure!(!row_major, "{stage}: a row_major matrix has no Rust type here; use column_major");
            let (scalar, bytes) = number(stage, &matrix.vector_ty.scalar_ty)?;
            Layout::Matrix {
                scalar,
                bytes,
                columns: matrix.nvector,
                stride: step(stage, matrix.stride, matrix.nvector)?,
            }
        }
        Type::Array(array) => Layout::Array {
            element: Box::new(layout(stage, &array.element_ty)?),
            count: array.nelement,
            stride: step(stage, array.stride, array.nelement.unwrap_or(1))?,
        },
        Type::Struct(StructType { name, members }) => {
            let name = name.clone().unwrap_or_default();
            let mut read = Vec::new();
            for member in members {
                let own = member.name.clone().unwrap_or_default();
                ensure!(!own.is_empty(), "{stage}: a member of {name} has no name");
                read.push(Member {
                    name: own,
                    offset: bytes_of(stage, member.offset)?,
                    layout: layout(stage, &member.ty)?,
                });
            }
            read.sort_by_key(|member| member.offset);
            Layout::Struct(Struct { name, members: read })
        }
        other => bail!("{stage}: a block holds {other}, which has no Rust type here"),
    })
}

/// No block is larger: sums of sizes then stay far from overflow.
const LARGEST: usize = 1 << 30;

fn bytes_of(stage: &str, bytes: Option<usize>) -> Result<u32> {
    let bytes = bytes.ok_or_else(|| anyhow!("{stage}: a block's layout is incomplete"))?;
    ensure!(bytes <= LARGEST, "{stage}: a member lies {bytes} bytes into its block, and {LARGEST} are the most");
    Ok(u32::try_from(bytes)?)
}

/// Bytes from one element to the next, of `count`.
fn step(stage: &str, stride: Option<usize>, count: u32) -> Result<u32> {
    let step = bytes_of(stage, stride)?;
    ensure!(step > 0, "{stage}: a block's layout is incomplete");
    let total = u64::from(step) * u64::from(count);
    ensure!(total <= LARGEST as u64, "{stage}: an array takes {total} bytes, and {LARGEST} are the most");
    Ok(step)
}

fn number(stage: &str, scalar: &ScalarType) -> Result<(&'static str, u32)> {
    Ok(match scalar {
        ScalarType::Integer { bits: 8, is_signed: false } => ("u8", 1),
        ScalarType::Integer { bits: 16, is_signed: false } => ("u16", 2),
        ScalarType::Integer { bits: 32, is_signed: false } => ("u32", 4),
        ScalarType::Integer { bits: 64, is_signed: false } => ("u64", 8),
        ScalarType::Integer { bits: 8, is_signed: true } => ("i8", 1),
        ScalarType::Integer { bits: 16, is_signed: true } => ("i16", 2),
        ScalarType::Integer { bits: 32, is_signed: true } => ("i32", 4),
        ScalarType::Integer { bits: 64, is_signed: true } => ("i64", 8),
        ScalarType::Float { bits: 32 } => ("f32", 4),
        ScalarType::Float { bits: 64 } => ("f64", 8),
        other => bail!("{stage}: a block holds {other}, which has no Rust type here"),
    })
}

/// What the code does to each resource it touches, by set and binding; or why naga cannot say.
fn accesses(words: &[u32]) -> Result<HashMap<(u32, u32), Access>, String> {
    // naga is made for WebGPU's shaders and may panic on others.
    catch_unwind(AssertUnwindSafe(|| naga_accesses(words))).unwrap_or_else(|_| Err("naga panicked".to_string()))
}

fn naga_accesses(words: &[u32]) -> Result<HashMap<(u32, u32), Access>, String> {
    use naga::valid::{Capabilities, GlobalUse, ShaderStages, SubgroupOperationSet, ValidationFlags, Validator};
    let options = naga::front::spv::Options { adjust_coordinate_space: false, ..Default::default() };
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let module = naga::front::spv::parse_u8_slice(&bytes, &options).map_err(|error| one_line(&error.to_string()))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .subgroup_stages(ShaderStages::all())
        .subgroup_operations(SubgroupOperationSet::all())
        .validate(&module)
        .map_err(|error| one_line(&format!("{:#}", anyhow::Error::new(error.into_inner()))))?;
    let mut found = HashMap::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding else { continue };
        let uses = info.get_entry_point(0)[handle];
        let access = match (uses.contains(GlobalUse::READ), uses.contains(GlobalUse::WRITE)) {
            _ if uses.contains(GlobalUse::ATOMIC) => Access::ReadWrite,
            (true, true) => Access::ReadWrite,
            (false, true) => Access::Write,
            (true, false) => Access::Read,
            // Its length or size alone is asked for.
            (false, false) if !uses.is_empty() => Access::Read,
            (false, false) => continue,
        };
        found.insert((binding.group, binding.binding), access);
    }
    Ok(found)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What is read from the words themselves: neither reader gives defaults of specialisation constants, nor a workgroup
/// size that depends on one, nor what of the named words the optimised ones still have.
#[derive(Default)]
struct Scan {
    names: HashMap<u32, String>,
    spec_ids: BTreeMap<u32, u32>,
    /// Rust names of the types of numbers.
    numbers: HashMap<u32, &'static str>,
    /// Type and words of every constant.
    values: HashMap<u32, (u32, Vec<u32>)>,
    sets: HashMap<u32, u32>,
    bindings: HashMap<u32, u32>,
    pushes: bool,
    workgroup_size: [u32; 3],
}

impl Scan {
    fn new(words: &[u32]) -> Self {
        const NAME: u32 = 5;
        const EXECUTION_MODE: u32 = 16;
        const TYPE_BOOL: u32 = 20;
        const TYPE_INT: u32 = 21;
        const TYPE_FLOAT: u32 = 22;
        const CONSTANT: u32 = 43;
        const CONSTANT_COMPOSITE: u32 = 44;
        const SPEC_CONSTANT_TRUE: u32 = 48;
        const SPEC_CONSTANT_FALSE: u32 = 49;
        const SPEC_CONSTANT: u32 = 50;
        const SPEC_CONSTANT_COMPOSITE: u32 = 51;
        const VARIABLE: u32 = 59;
        const DECORATE: u32 = 71;
        const LOCAL_SIZE: u32 = 17;
        const SPEC_ID: u32 = 1;
        const BUILT_IN: u32 = 11;
        const WORKGROUP_SIZE: u32 = 25;
        const BINDING: u32 = 33;
        const DESCRIPTOR_SET: u32 = 34;
        const PUSH_CONSTANT: u32 = 9;
        let mut scan = Self { workgroup_size: [1; 3], ..Self::default() };
        let mut composites: HashMap<u32, Vec<u32>> = HashMap::new();
        let mut size_id = None;
        let mut rest = words.get(5..).unwrap_or_default();
        while let Some(first) = rest.first() {
            let (length, operation) = ((first >> 16) as usize, first & 0xffff);
            let Some((instruction, after)) = rest.split_at_checked(length.max(1)) else { break };
            rest = after;
            match (operation, &instruction[1..]) {
                (NAME, [id, text @ ..]) => {
                    let bytes: Vec<u8> =
                        text.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
                    scan.names.insert(*id, String::from_utf8_lossy(&bytes).into_owned());
                }
                (EXECUTION_MODE, [_, LOCAL_SIZE, x, y, z]) => scan.workgroup_size = [*x, *y, *z],
                (DECORATE, [id, SPEC_ID, number]) => {
                    scan.spec_ids.insert(*number, *id);
                }
                (DECORATE, [id, BINDING, number]) => {
                    scan.bindings.insert(*id, *number);
                }
                (DECORATE, [id, DESCRIPTOR_SET, number]) => {
                    scan.sets.insert(*id, *number);
                }
                (VARIABLE, [_, _, PUSH_CONSTANT, ..]) => scan.pushes = true,
                (DECORATE, [id, BUILT_IN, WORKGROUP_SIZE]) => size_id = Some(*id),
                (TYPE_BOOL, [id]) => {
                    scan.numbers.insert(*id, "bool");
                }
                (TYPE_INT, [id, 32, signed]) => {
                    scan.numbers.insert(*id, if *signed == 0 { "u32" } else { "i32" });
                }
                (TYPE_FLOAT, [id, 32, ..]) => {
                    scan.numbers.insert(*id, "f32");
                }
                (CONSTANT | SPEC_CONSTANT, [ty, id, value @ ..]) => {
                    scan.values.insert(*id, (*ty, value.to_vec()));
                }
                (SPEC_CONSTANT_TRUE | SPEC_CONSTANT_FALSE, [ty, id]) => {
                    scan.values.insert(*id, (*ty, vec![u32::from(operation == SPEC_CONSTANT_TRUE)]));
                }
                (CONSTANT_COMPOSITE | SPEC_CONSTANT_COMPOSITE, [_, id, parts @ ..]) => {
                    composites.insert(*id, parts.to_vec());
                }
                _ => {}
            }
        }
        // `local_size_x_id`: the size is a vector of constants, and its decoration goes before LocalSize.
        if let Some(parts) = size_id.and_then(|id| composites.get(&id)) {
            for ((size, part), axis) in scan.workgroup_size.iter_mut().zip(parts).zip(["x", "y", "z"]) {
                if let Some([value]) = scan.values.get(part).map(|(_, value)| value.as_slice()) {
                    *size = *value;
                }
                let unnamed = scan.names.get(part).is_none_or(String::is_empty);
                if unnamed && scan.spec_ids.values().any(|id| id == part) {
                    scan.names.insert(*part, format!("local_size_{axis}"));
                }
            }
        }
        scan
    }

    /// Set and binding of every resource in the module.
    fn places(&self) -> HashSet<(u32, u32)> {
        self.bindings.iter().map(|(id, binding)| (self.sets.get(id).copied().unwrap_or(0), *binding)).collect()
    }

    fn constants(&self, stage: &str) -> Result<Vec<Constant>> {
        let mut constants = Vec::new();
        for (number, id) in &self.spec_ids {
            let name = self.names.get(id).filter(|name| !name.is_empty());
            let name =
                name.ok_or_else(|| anyhow!("{stage}: the constant of constant_id {number} has no name"))?.clone();
            let value = self.values.get(id).map(|(ty, value)| (self.numbers.get(ty), value.as_slice()));
            let Some((Some(ty), [default])) = value else {
                bail!("{stage}: the constant {name} is wider than 32 bits, which is not supported");
            };
            constants.push(Constant { name, id: *number, ty, default: *default });
        }
        Ok(constants)
    }
}
