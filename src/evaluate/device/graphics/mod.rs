//! The backend that draws with the graphics pipeline: four candidates of a view a tile of one large framebuffer, compared there
//! with the observations (METHOD A9).

mod byte_numbers;
mod compare;
mod draw;
mod draw_mesh;
mod drawn;
mod evidence;
mod framebuffer;
#[cfg(test)]
mod mesh_tests;
mod outlines;
mod passes;
mod pictures;
mod rasteriser;
mod readback;
mod segments;
#[cfg(test)]
mod segments_tests;
mod settings;
mod target;
#[cfg(test)]
mod tests;
mod tiles;
#[cfg(test)]
mod ways_tests;

pub use rasteriser::Graphics;
pub use settings::{
    Channels, Comparison, Coverage, Gathering, GraphicsSettings, HostComparison, Packing, Primitives, Projection,
    Tiling,
};
