//! GLSL under `glsl/` to typed Rust: compiled by shaderc, reflected by spirq and naga, written out as source text.
//!
//! `make shaders` runs this code, in `build.rs`, and keeps what it makes in `glsl/compiled/`. The feature `reload` has it in the
//! library as well, to compile an edited stage while the program runs.

pub mod compile;
pub mod constants;
pub mod generate;
pub mod kept;
pub mod layouts;
pub mod reflect;
pub mod write;

use super::interface;
use super::shader::Shader;
use anyhow::{Result, ensure};
use std::path::Path;

/// Compiles the file of `shader` under the folder `root` again and returns its words.
///
/// # Errors
/// What [`compile::compile`] finds wrong, or that the stage's workgroup, bindings, push constants or specialisation
/// constants are no longer those that the program was built with.
pub fn reload(shader: &Shader, root: &Path) -> Result<Vec<u32>> {
    let compiled = compile::compile(root, shader.name)?;
    let now = reflect::reflect(shader.name, &compiled)?;
    let same_size = now.workgroup_size == shader.workgroup_size;
    let push = now.push.as_ref().map_or(0, reflect::Struct::size);
    let bindings = shader.bindings.iter().map(|b| (b.name.to_string(), b.set, b.binding, b.kind, b.access));
    let same_bindings = bindings.eq(now.resources.iter().map(|r| (r.name.clone(), r.set, r.binding, r.kind, r.access)));
    let constants = shader.constants.iter().map(|c| (c.name.to_string(), c.id));
    let same_constants = constants.eq(now.constants.iter().map(|c| (c.name.clone(), c.id)));
    for (same, what) in [
        (same_size, "workgroup size"),
        (push == shader.push_size, "push constants"),
        (same_bindings, "bindings"),
        (same_constants, "specialisation constants"),
    ] {
        ensure!(same, "{}: its {what} changed since the program was built; build it again", shader.name);
    }
    Ok(compiled.spirv)
}

#[cfg(test)]
mod tests {
    use super::super::generated::double_comp;
    use super::*;

    #[test]
    fn a_stage_compiles_again_and_a_changed_interface_is_refused() {
        let glsl = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl"));
        assert_eq!(reload(&double_comp::SHADER, glsl).unwrap(), double_comp::SHADER.spirv);
        let edited = tempfile::tempdir().unwrap();
        let folder = edited.path().join("gpu");
        std::fs::create_dir(&folder).unwrap();
        std::fs::copy(glsl.join("gpu/constants.glsl"), folder.join("constants.glsl")).unwrap();
        let text = std::fs::read_to_string(glsl.join("gpu/double.comp")).unwrap();
        let with = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            std::fs::write(folder.join("double.comp"), text.replace(from, to)).unwrap();
            reload(&double_comp::SHADER, edited.path()).map_err(|error| error.to_string())
        };
        assert_ne!(with("push.factor *", "2.0 * push.factor *").unwrap(), double_comp::SHADER.spirv);
        for (from, to, what) in [
            ("= DOUBLE_WORKGROUP", "= 32", "workgroup size"),
            ("float factor;", "float factor; float more;", "push constants"),
            ("binding = 1", "binding = 2", "bindings"),
            ("void main", "layout(constant_id = 0) const uint N = 1u; void main", "specialisation constants"),
        ] {
            let expected = format!("gpu/double.comp: its {what} changed since the program was built; build it again");
            assert_eq!(with(from, to).unwrap_err(), expected);
        }
    }
}
