//! Procedural textures (METHOD B): noise, materials cut out of space, pictures of them, synthesis from an example.

pub mod device;
pub mod example;
pub mod materials;
pub mod noise;
pub mod picture;
mod shaders;
