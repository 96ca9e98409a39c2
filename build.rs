//! Sees to it that the compiled shaders under `glsl/compiled/`, which the rooms include, are those of the sources beside them. With the
//! feature `reload` and `PANTIN_WRITE_SHADERS` set it compiles them anew: `make shaders`.

#![allow(unreachable_pub, reason = "the files below are modules of the library too, which shows them")]

#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/compile.rs"]
mod compile;
#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/constants.rs"]
mod constants;
#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/generate.rs"]
mod generate;
#[cfg(feature = "reload")]
#[path = "src/gpu/interface.rs"]
mod interface;
#[path = "src/gpu/shaders/kept.rs"]
mod kept;
#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/layouts.rs"]
mod layouts;
#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/reflect.rs"]
mod reflect;
#[cfg(feature = "reload")]
#[path = "src/gpu/shaders/write.rs"]
mod write;

use anyhow::Result;
use std::env;
use std::path::PathBuf;

fn main() -> Result<()> {
    // A folder stands for every file in it, so includes and new stages count.
    for path in ["glsl", "src/gpu/shaders", "src/gpu/interface.rs", "build.rs"] {
        println!("cargo:rerun-if-changed={path}");
    }
    println!("cargo:rerun-if-env-changed=PANTIN_WRITE_SHADERS");
    let base = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    if env::var_os("PANTIN_WRITE_SHADERS").is_some() {
        #[cfg(feature = "reload")]
        write::write(&base)?;
        #[cfg(not(feature = "reload"))]
        anyhow::bail!(
            "PANTIN_WRITE_SHADERS is set, and only a build with the feature reload can compile shaders: run `make shaders`"
        );
    }
    kept::check(&base)
}
