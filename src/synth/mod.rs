//! Synthetic sequences with exact truth: an actor, a room, cameras, noise.
//!
//! [`Scene`] says what to show, [`SyntheticSequence`] makes it: a [gait](gait::Gait) moves the bones, an
//! [actor](actor::Actor) of ellipsoids and capsules hangs on them, [render](render::View) draws it before the
//! [room](room::Room) for each camera of the [rig], the [sensor](noise::Sensor) adds its noise.

pub mod actor;
pub mod gait;
mod hash;
pub mod noise;
pub mod render;
pub mod rig;
pub mod room;
mod scene;
mod sequence;
pub mod shadow;
pub mod solid;

pub use scene::Scene;
pub use sequence::SyntheticSequence;
