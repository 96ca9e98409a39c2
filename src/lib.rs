//! Markerless full-body 3D motion from a few calibrated cameras, by analysis through synthesis: hundreds of candidate
//! poses a frame are drawn into every camera, compared with the observed silhouette and edges, and a particle swarm
//! climbs to the best one.
//!
//! The crate is a house of rooms (see `docs/ARCHITECTURE.md`); an import runs down the floors, never up:
//! [`command`] → [`study`] → [`track`] → [`search`], [`bench`], [`check`], [`live`] → [`evaluate`], [`synth`], [`report`],
//! [`observe`] → [`features`], [`body`], [`sequence`], [`texture`], [`matrix`], [`calibrate`] → [`gpu`], [`motion`], [`geometry`] → [`files`],
//! `arithmetic`.
//!
//! Lengths are millimetres, angles radians (degrees only in files people edit), images row-major with the origin in the
//! centre of the top-left pixel. The world frame is right-handed with z up.

mod arithmetic;
pub mod bench;
pub mod body;
pub mod calibrate;
pub mod check;
pub mod command;
pub mod evaluate;
pub mod features;
pub mod files;
pub mod geometry;
pub mod gpu;
pub mod live;
pub mod matrix;
pub mod motion;
pub mod observe;
pub mod report;
pub mod search;
pub mod sequence;
pub mod study;
pub mod synth;
pub mod texture;
pub mod track;

/// The README's code is compiled as the documentation's is.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
