//! Procedural textures (SPEC B): noise, materials cut out of space, pictures of them.

pub mod materials;
pub mod noise;
pub mod picture;
