//! Procedural textures (METHOD B): noise, materials cut out of space, pictures of them, synthesis from an example.

pub mod device;
mod device_material;
pub mod example;
pub mod materials;
pub mod noise;
pub mod painter;
pub mod palette;
pub mod picture;
pub mod relief;
mod shaders;
pub mod sheet;
pub mod solids;
