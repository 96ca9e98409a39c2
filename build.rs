//! Compiles every shader under `glsl/` and writes the Rust that the rooms include: `OUT_DIR/<room>_stages.rs`.

#![allow(unreachable_pub, reason = "the files below are modules of the library too, which shows them")]

#[path = "src/gpu/shaders/compile.rs"]
mod compile;
#[path = "src/gpu/shaders/constants.rs"]
mod constants;
#[path = "src/gpu/shaders/generate.rs"]
mod generate;
#[path = "src/gpu/interface.rs"]
mod interface;
#[path = "src/gpu/shaders/layouts.rs"]
mod layouts;
#[path = "src/gpu/shaders/reflect.rs"]
mod reflect;

use anyhow::{Context, Result};
use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<()> {
    // A folder stands for every file in it, so includes and new stages count.
    println!("cargo:rerun-if-changed=glsl");
    println!("cargo:rerun-if-changed=src/gpu/shaders");
    println!("cargo:rerun-if-changed=src/gpu/interface.rs");
    println!("cargo:rerun-if-changed=build.rs");
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("glsl");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    for room in generate::rooms(&root)? {
        let text = generate::generate(&root, &room)?;
        let path = out.join(format!("{room}_stages.rs"));
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}
