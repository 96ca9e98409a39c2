//! Procedural textures (SPEC B).

pub mod noise;
