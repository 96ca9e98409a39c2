//! A room's stages as Rust source text: a module a stage, the memory layouts they share, the constants of
//! `constants.glsl`; and their words, which that text takes in as files.

use super::compile::{Compiled, compile, kind_of};
use super::constants::constants;
use super::interface::{Access, BindingKind, ShaderKind};
use super::kept::FOLDER;
use super::layouts::{Layouts, camel_case, identifier};
use super::reflect::{Constant, Reflection, reflect};
use anyhow::{Context, Result, ensure};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Names of the folders under `root` that hold stages, in alphabetical order.
///
/// # Errors
/// When a folder cannot be listed.
pub fn rooms(root: &Path) -> Result<Vec<String>> {
    let mut rooms = Vec::new();
    for name in listed(root)? {
        if root.join(&name).is_dir() && listed(&root.join(&name))?.iter().any(|file| kind_of(file).is_some()) {
            rooms.push(name);
        }
    }
    Ok(rooms)
}

fn listed(folder: &Path) -> Result<Vec<String>> {
    let cannot = || format!("cannot list {}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).with_context(cannot)? {
        names.push(entry.with_context(cannot)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// What a room's stages become.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Generated {
    /// Rust source, to be included as the content of a module of this crate.
    pub source: String,
    /// Each stage's path under the shader folder, as in `evaluate/project.comp`, and its words.
    pub words: Vec<(String, Vec<u32>)>,
}

/// Every stage in the folder `room` under `root`.
///
/// # Errors
/// One sentence with the file, and the line where there is one, for whatever does not compile, has no Rust type, or is
/// laid out in two ways under one name.
pub fn generate(root: &Path, room: &str) -> Result<Generated> {
    let mut layouts = Layouts::default();
    let mut modules = String::new();
    let mut statics = Vec::new();
    let mut words = Vec::new();
    for file in listed(&root.join(room))?.iter().filter(|file| kind_of(file).is_some()) {
        let name = format!("{room}/{file}");
        let compiled = compile(root, &name)?;
        let reflection = reflect(&name, &compiled)?;
        let module = identifier(file);
        ensure!(!statics.contains(&module), "{name}: another stage of the folder has the module name {module}");
        modules += &stage(&name, &module, &compiled, &reflection, &mut layouts)?;
        statics.push(module);
        words.push((name, compiled.spirv));
    }
    let mut text = String::new();
    let shared = root.join(room).join("constants.glsl");
    if shared.exists() {
        text += &constants(&format!("{room}/constants.glsl"), &fs::read_to_string(&shared)?)?;
    }
    text += &modules;
    text += &layouts.source();
    let list: Vec<String> = statics.iter().map(|module| format!("&{module}::SHADER")).collect();
    writeln!(text, "/// Every stage of the folder, for tests that try them all.")?;
    writeln!(text, "#[cfg(test)]\n#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]")?;
    writeln!(text, "pub static SHADERS: &[&crate::gpu::Shader] = &[{}];", list.join(", "))?;
    Ok(Generated { source: text, words })
}

fn stage(
    name: &str,
    module: &str,
    compiled: &Compiled,
    reflection: &Reflection,
    layouts: &mut Layouts,
) -> Result<String> {
    let mut text = String::new();
    let mut push_size = 0;
    let mut push_type = None;
    if let Some(push) = &reflection.push {
        // A block of its own name is shared by every stage that includes it; one called `Push` belongs to its stage, and
        // stages of one pipeline share it: `fill.vert` and `fill.frag` have `FillPush`.
        let file = name.rsplit('/').next().unwrap_or(name);
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        let own = match push.name.as_str() {
            "Push" | "" => format!("{}Push", camel_case(stem)),
            shared => camel_case(shared),
        };
        push_size = layouts.block(name, &own, push)?;
        push_type = Some(own);
    }
    let mut fields: Vec<String> = Vec::new();
    for resource in &reflection.resources {
        let field = identifier(&resource.name);
        let (set, binding) = (resource.set, resource.binding);
        ensure!(
            !fields.contains(&field),
            "{name}: two resources are called {field}; rename that of set {set}, binding {binding}"
        );
        fields.push(field);
        if let Some(block) = &resource.block {
            layouts.block(name, &camel_case(&block.name), block)?;
        }
    }
    let kind = compiled.kind;
    writeln!(text, "/// The stage `{name}`.")?;
    writeln!(
        text,
        "#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = \"written by the build, of use or not\")]"
    )?;
    writeln!(text, "pub mod {module} {{")?;
    if let Some(why) = &reflection.unread {
        writeln!(text, "    // Accesses are as declared: naga cannot read this stage ({why}).")?;
    }
    writeln!(text, "    /// The compiled stage.")?;
    writeln!(text, "    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {{")?;
    writeln!(text, "        name: {name:?},\n        kind: crate::gpu::ShaderKind::{kind:?},")?;
    writeln!(text, "        spirv: &crate::gpu::words::<{}, _>(include_bytes!(concat!(", compiled.spirv.len())?;
    writeln!(text, "            env!(\"CARGO_MANIFEST_DIR\"), {:?}))),", format!("/glsl/{FOLDER}/{name}.spv"))?;
    writeln!(text, "        workgroup_size: {:?},\n        push_size: {push_size},", reflection.workgroup_size)?;
    writeln!(text, "        bindings: &[")?;
    for resource in &reflection.resources {
        let (set, binding, kind, access) = (resource.set, resource.binding, resource.kind, resource.access);
        writeln!(
            text,
            "            crate::gpu::BindingLayout {{ name: {:?}, set: {set}, binding: {binding}, \
             kind: crate::gpu::BindingKind::{kind:?}, access: crate::gpu::Access::{access:?} }},",
            resource.name
        )?;
    }
    writeln!(text, "        ],\n        constants: &[")?;
    for constant in &reflection.constants {
        let (own, id, default) = (&constant.name, constant.id, constant.default);
        writeln!(text, "            crate::gpu::SpecConstant {{ name: {own:?}, id: {id}, default: {default} }},")?;
    }
    writeln!(text, "        ],\n    }};")?;
    text += &constants_of(name, reflection)?;
    if let Some(own) = &push_type {
        writeln!(text, "    /// Push constants.\n    pub type Push = super::layout::{own};")?;
    }
    if !fields.is_empty() {
        text += &bindings(reflection, &fields)?;
        if kind == ShaderKind::Compute {
            text += &dispatch(push_type.is_some(), !reflection.constants.is_empty())?;
        }
    }
    writeln!(text, "}}")?;
    Ok(text)
}

/// The struct of a stage's specialisation constants, where it has any, and the function that gives the stage with them.
fn constants_of(name: &str, reflection: &Reflection) -> Result<String> {
    let mut text = String::new();
    let (mut fields, mut defaults, mut values) = (String::new(), String::new(), String::new());
    let mut names = Vec::new();
    for Constant { name: glsl, id, ty, default } in &reflection.constants {
        let field = identifier(&glsl.to_ascii_lowercase());
        ensure!(!names.contains(&field), "{name}: two specialisation constants are called {field}");
        let (value, bits) = match *ty {
            "bool" => ((*default != 0).to_string(), format!("u32::from(constants.{field})")),
            "i32" => (default.cast_signed().to_string(), format!("constants.{field}.cast_unsigned()")),
            "f32" => (format!("f32::from_bits({default})"), format!("constants.{field}.to_bits()")),
            _ => (default.to_string(), format!("constants.{field}")),
        };
        writeln!(fields, "        /// `{glsl}`, {value} by default.\n        pub {field}: {ty},")?;
        write!(defaults, "{field}: {value}, ")?;
        write!(values, "({id}, {bits}), ")?;
        names.push(field);
    }
    if !names.is_empty() {
        writeln!(text, "    /// Specialisation constants.\n    #[derive(Clone, Copy, Debug, PartialEq)]")?;
        writeln!(text, "    pub struct Constants {{\n{fields}    }}\n    impl Default for Constants {{")?;
        writeln!(text, "        fn default() -> Self {{ Self {{ {defaults}}} }}\n    }}")?;
    }
    let parameter = if names.is_empty() { "" } else { "constants: Constants" };
    writeln!(text, "    /// What a pipeline is compiled from.")?;
    writeln!(text, "    pub fn stage({parameter}) -> crate::gpu::ShaderStage {{")?;
    writeln!(text, "        crate::gpu::ShaderStage {{ shader: &SHADER, constants: vec![{values}] }}\n    }}")?;
    Ok(text)
}

/// The function that makes a run of a compute stage from what it works on.
fn dispatch(has_push: bool, has_constants: bool) -> Result<String> {
    let mut text = String::new();
    let (constants, stage) =
        if has_constants { ("constants: Constants, ", "stage(constants)") } else { ("", "stage()") };
    let (push, bytes) =
        if has_push { ("push: Push, ", "bytemuck::bytes_of(&push).to_vec()") } else { ("", "Vec::new()") };
    writeln!(text, "    impl<'a> Bindings<'a> {{\n        /// A run on them.")?;
    writeln!(text, "        pub fn dispatch(self, {constants}{push}groups: crate::gpu::Groups<'a>)")?;
    writeln!(text, "            -> crate::gpu::Dispatch<'a> {{")?;
    writeln!(text, "            let bindings = self.bound().to_vec();")?;
    writeln!(text, "            crate::gpu::Dispatch {{ stage: {stage}, bindings, push: {bytes}, groups }}")?;
    writeln!(text, "        }}\n    }}")?;
    Ok(text)
}

/// The struct that names a stage's resources, and its list of bindings.
fn bindings(reflection: &Reflection, fields: &[String]) -> Result<String> {
    let mut text = String::new();
    writeln!(
        text,
        "    /// What the stage works on.\n    #[derive(Clone, Copy, Debug)]\n    pub struct Bindings<'a> {{"
    )?;
    let image = |kind: BindingKind| matches!(kind, BindingKind::SampledImage | BindingKind::StorageImage);
    for (resource, field) in reflection.resources.iter().zip(fields) {
        let what = match resource.kind {
            BindingKind::StorageBuffer => "Storage buffer",
            BindingKind::UniformBuffer => "Uniform buffer",
            BindingKind::SampledImage => "Texture",
            BindingKind::StorageImage => "Storage image",
        };
        let how = match resource.access {
            Access::Read => "read",
            Access::Write => "written",
            Access::ReadWrite => "read and written",
        };
        let block = resource.block.as_ref().map(|block| format!(" `{}`", block.name)).unwrap_or_default();
        let ty = if image(resource.kind) { "Image" } else { "Buffer" };
        writeln!(text, "        /// {what}{block}, {how}; set {}, binding {}.", resource.set, resource.binding)?;
        writeln!(text, "        pub {field}: &'a crate::gpu::{ty},")?;
    }
    let count = fields.len();
    writeln!(text, "    }}\n    impl<'a> Bindings<'a> {{\n        /// Each resource with the place it goes to.")?;
    writeln!(text, "        pub fn bound(&self) -> [crate::gpu::Binding<'a>; {count}] {{\n            [")?;
    for (index, (resource, field)) in reflection.resources.iter().zip(fields).enumerate() {
        let variant = if image(resource.kind) { "Image" } else { "Buffer" };
        writeln!(
            text,
            "                crate::gpu::Binding {{ layout: &SHADER.bindings[{index}], \
             bound: crate::gpu::Bound::{variant}(self.{field}) }},"
        )?;
    }
    writeln!(text, "            ]\n        }}\n    }}")?;
    Ok(text)
}
