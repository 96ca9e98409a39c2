//! Drawing on a device. A stage is one file here beside one shader of the same name under `glsl/synth/`.

mod occlude;
mod picture;
mod soften;

#[allow(clippy::unreadable_literal, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/synth_stages.rs"));
}

pub(super) use generated::{
    LOOK_FACE, LOOK_HAIR, LOOK_SHIRT, LOOK_SHOE, LOOK_SKIN, LOOK_TROUSERS, MEMBER_SHIFT, SHADOW_CELL, SHADOW_SIDE,
    TILE_SIDE, layout, occlude_comp, picture_comp, soften_comp,
};
pub(super) use occlude::OccludeStage;
pub(super) use picture::PictureStage;
pub(super) use soften::SoftenStage;

/// Workgroups that cover the grids of shadow of so many people.
fn shadow_groups(members: u32) -> [u32; 3] {
    let side = SHADOW_SIDE.div_ceil(soften_comp::SHADER.workgroup_size[0]);
    [side, side, members]
}
