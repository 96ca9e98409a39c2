//! GLSL to SPIR-V 1.3 for Vulkan 1.1, through shaderc.

use super::interface::ShaderKind;
use anyhow::{Context, Result, anyhow, bail};
use std::cell::RefCell;
use std::fs;
use std::path::Path;

/// The stage that a file of this name holds, told from its extension; none for includes and other files.
pub fn kind_of(name: &str) -> Option<ShaderKind> {
    match name.rsplit_once('.')?.1 {
        "comp" => Some(ShaderKind::Compute),
        "vert" => Some(ShaderKind::Vertex),
        "geom" => Some(ShaderKind::Geometry),
        "frag" => Some(ShaderKind::Fragment),
        _ => None,
    }
}

fn shaderc_kind(kind: ShaderKind) -> shaderc::ShaderKind {
    match kind {
        ShaderKind::Compute => shaderc::ShaderKind::Compute,
        ShaderKind::Vertex => shaderc::ShaderKind::Vertex,
        ShaderKind::Geometry => shaderc::ShaderKind::Geometry,
        ShaderKind::Fragment => shaderc::ShaderKind::Fragment,
    }
}

/// A compiled stage.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// Place in the pipeline.
    pub kind: ShaderKind,
    /// Optimised words for the device.
    pub spirv: Vec<u32>,
    /// The same without optimisation, for reflection: it still has the names.
    pub named: Vec<u32>,
}

/// Compiles `name`, a path under the folder `root` such as `evaluate/project.comp`. `#include "evaluate/camera.glsl"`
/// is looked up under `root` too, and a file is included once a stage however many paths lead to it.
///
/// # Errors
/// One sentence that begins with file and line, for a missing file, an include that leads back to itself, or what the
/// compiler says.
pub fn compile(root: &Path, name: &str) -> Result<Compiled> {
    let kind = kind_of(name).ok_or_else(|| anyhow!("{name}: a stage's file ends in .comp, .vert, .geom or .frag"))?;
    let path = root.join(name);
    let source = fs::read_to_string(&path).with_context(|| format!("cannot read the shader {}", path.display()))?;
    let compiler = shaderc::Compiler::new().map_err(|error| anyhow!("the shader compiler does not start: {error}"))?;
    let build = |level: shaderc::OptimizationLevel| -> Result<Vec<u32>> {
        let options = options(root, name, level)?;
        match compiler.compile_into_spirv(&source, shaderc_kind(kind), name, "main", Some(&options)) {
            Ok(artifact) => Ok(artifact.as_binary().to_vec()),
            Err(error) => bail!("{}", sentence(name, &error)),
        }
    };
    Ok(Compiled {
        kind,
        named: build(shaderc::OptimizationLevel::Zero)?,
        spirv: build(shaderc::OptimizationLevel::Performance)?,
    })
}

fn options<'a>(
    root: &'a Path,
    name: &'a str,
    level: shaderc::OptimizationLevel,
) -> Result<shaderc::CompileOptions<'a>> {
    let mut options =
        shaderc::CompileOptions::new().map_err(|error| anyhow!("the shader compiler does not start: {error}"))?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_1 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_3);
    options.set_warnings_as_errors();
    options.set_optimization_level(level);
    // Files between the stage and the directive being resolved: entry `depth - 1` holds the directive.
    let chain = RefCell::new(vec![name.to_string()]);
    options.set_include_callback(move |requested, _, requesting, depth| {
        let mut chain = chain.borrow_mut();
        chain.truncate(depth);
        if chain.iter().any(|file| file == requested) {
            return Err(format!("the include leads back to itself: {} -> {requested}", chain.join(" -> ")));
        }
        let content = included(root, requested, requesting)?;
        chain.push(requested.to_string());
        Ok(shaderc::ResolvedInclude { resolved_name: requested.to_string(), content })
    });
    Ok(options)
}

/// The text of an included file, wrapped so that it counts once a stage, with its own line numbers.
fn included(root: &Path, requested: &str, requesting: &str) -> Result<String, String> {
    let plain = requested.split('/').all(|part| !matches!(part, "" | "." | ".."));
    if !plain || !requested.ends_with(".glsl") {
        return Err(format!(
            "an include names a .glsl file from the shader folder on, such as evaluate/camera.glsl, not {requested}"
        ));
    }
    let text = fs::read_to_string(root.join(requested)).map_err(|error| {
        format!("{requesting} includes {requested}, which cannot be read from {}: {error}", root.display())
    })?;
    let guard: String =
        requested.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect();
    Ok(format!("#ifndef INCLUDED_{guard}\n#define INCLUDED_{guard}\n#line 1\n{text}\n#endif\n"))
}

/// The compiler's first complaint on one line, and how many more there are.
fn sentence(name: &str, error: &shaderc::Error) -> String {
    let text = match error {
        shaderc::Error::CompilationError(_, text) => text.clone(),
        other => other.to_string(),
    };
    let complaints: Vec<&str> =
        text.lines().map(str::trim).filter(|line| line.contains("error:") || line.contains("warning:")).collect();
    let Some(first) = complaints.first() else { return format!("{name}: {}", text.trim().replace('\n', "; ")) };
    match complaints.len() {
        1 => (*first).to_string(),
        more => format!("{first} (and {} more)", more - 1),
    }
}
